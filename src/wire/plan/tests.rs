//! Plans go out and come back as they were.

use super::*;
use crate::implicit::RbfOptions;
use crate::repair::fill::{FillOptions, HoleChoice};
use crate::wire::plan_fault::PlanFault;
use crate::wire::proposal::Plan;
use serde_json::json;

fn all_steps() -> Vec<Step> {
    let degenerate = repair::polygons::DegenerateFaces::Split;
    vec![
        Step::SplitPolygons(degenerate),
        Step::JoinOverNoise,
        Step::ClearNoise,
        Step::RoundToF32,
        Step::RoundWhereItMatters,
        Step::Weld,
        Step::DropDegenerate,
        Step::SplitCollinear,
        Step::SplitTVertices,
        Step::RemoveParts(vec![3, 7]),
        Step::DropDuplicates(repair::duplicates::OppositePairs::KeepFirst),
        Step::DropNearDuplicates { epsilon: 0.25 },
        Step::RemoveCrossing { rings: 2 },
        Step::Orient,
        Step::PairSheets(repair::pair_sheets::Across::Void),
        Step::JoinContacts { size: 0.5 },
        Step::Cut(CutOptions::default()),
        Step::Pinch(mesh::ChosenEdges::default(), mesh::StitchValidity::Exact),
        Step::Snap(SnapOptions {
            epsilon: Some(0.5),
            keeps_winding: true,
            by_edge: true,
            ..SnapOptions::default()
        }),
        Step::MendThinFaces(ThinFaces { needles: true, caps: false, folds: true }),
        Step::CloseChordalGaps,
        Step::TurnToBridge,
        Step::FillHoles(FillOptions::plain(Selection::Only(vec![5]))),
        Step::FillHoles(FillOptions {
            method: repair::fill::Method::Smooth,
            band_rings: 3,
            rbf: RbfOptions { lambda: Some(0.25), share: 0.5, ..RbfOptions::default() },
            choices: vec![HoleChoice {
                half_edge: 7,
                method: Some(repair::fill::Method::Rbf),
                band_rings: Some(1),
            }],
            ..FillOptions::default()
        }),
        Step::Thicken { wall: 0.25 },
        Step::Unite,
        Step::UniteAndCopyBare,
        Step::Enclose,
        Step::EncloseAndCopyBare,
        Step::BoreContacts { steps: 64 },
        Step::RoundToCoarser { steps: 16 },
        Step::SpanRims,
        Step::SpanOddEdges,
        Step::OpenContacts,
        Step::JoinCopies,
        Step::Nest(NestOptions {
            policy: repair::nest::NestingPolicy::Fill,
            is_embedded: false,
            chosen: vec![(4, repair::nest::ShellFate::Goes)],
        }),
        Step::Rebuild,
        Step::Simplify,
    ]
}

#[test]
fn every_step_comes_back_from_json_as_it_was_under_the_name_of_its_action() {
    for step in all_steps() {
        let value = serde_json::to_value(PlanStep::from(&step)).unwrap();
        assert_eq!(value["step"], step.name(), "{value}");
        let back: PlanStep = serde_json::from_value(value).unwrap();
        assert_eq!(back.to_engine(), step);
    }
}

#[test]
fn a_plan_that_was_answered_can_be_given_back_as_it_is() {
    let plan = pipeline::Plan {
        input_sha256: [0xab; 32],
        findings: vec![pipeline::Proposal {
            code: crate::analysis::DefectCode::BoundaryLoop,
            count: 2,
            remedy: pipeline::Remedy::Fill,
            choices: &[pipeline::Remedy::Fill, pipeline::Remedy::Keep],
            confidence: 0.5,
            reason: "because",
            elements: vec![pipeline::ElementProposal {
                number: 1,
                remedy: pipeline::Remedy::Keep,
                confidence: 0.5,
            }],
        }],
        steps: Some(all_steps()),
    };
    let text = serde_json::to_string(&Plan::from(&plan)).unwrap();
    let back = PlanRequest::from_json(&text).unwrap().to_engine();
    assert_eq!(back.input_sha256, Some([0xab; 32]));
    assert_eq!(back.steps, plan.steps);
    assert_eq!(back.findings[0].remedy, Some(pipeline::Remedy::Fill));
    assert_eq!(back.findings[0].elements, [(1, pipeline::Remedy::Keep)]);
}

#[test]
fn what_is_no_plan_is_not_taken() {
    assert!(PlanRequest::from_json("{}").is_some());
    let elements: Vec<_> = (0..=ELEMENTS_MAX).map(|n| json!({"number": n, "remedy": "keep"})).collect();
    for wrong in [
        json!([]),
        json!({"findings": [["boundary-loop"]]}),
        json!({"input_sha256": "ab"}),
        json!({"findings": [{"code": "no-such"}]}),
        json!({"findings": [{"code": "boundary-loop", "remedy": "burn"}]}),
        json!({"findings": [{"code": "boundary-loop", "elements": elements}]}),
        json!({"findings": [{"code": "boundary-loop", "elements": [{"number": 1.5, "remedy": "keep"}]}]}),
        json!({"steps": [{"step": "weld", "strength": 3}]}),
        json!({"steps": [{"step": "remove-crossing", "rings": 11}]}),
        json!({"steps": [{"step": "remove-crossing"}]}),
        json!({"stepps": []}),
        json!({"findings": [{"code": "boundary-loop", "elements": [
            {"number": 0, "remedy": "fill", "method": "best"}]}]}),
        json!({"findings": [{"code": "boundary-loop", "elements": [
            {"number": 0, "remedy": "fill", "band_rings": 9}]}]}),
        json!({"findings": [{"code": "boundary-loop", "elements": [
            {"number": 0, "remedy": "fill", "method": "flat", "band_rings": 1}]}]}),
        json!({"steps": [{"step": "fill-holes", "all": true, "except": [], "how": {"band_rings": 9}}]}),
        json!({"steps": [{"step": "fill-holes", "all": true, "except": [], "how": {"bridge": true}}]}),
    ] {
        assert_eq!(PlanRequest::from_json(&wrong.to_string()), None, "{wrong}");
    }
}

fn fault(plan: &serde_json::Value) -> String {
    PlanFault::of(&plan.to_string()).map_or_else(String::new, |fault| fault.told)
}

#[test]
fn a_wrong_word_of_a_plan_is_named_with_its_place_and_what_is_allowed() {
    let steps = json!({"steps": [{"step": "weld"}, {"step": "wold"}, {"step": "snap", "epsilon": 1}]});
    let told = fault(&steps);
    assert!(told.starts_with("`plan`, step 2: `step` cannot be `wold`; expected split-polygons, "), "{told}");
    assert!(told.ends_with("; did you mean `weld`?") && !told.contains("epsilon"), "{told}");
    let findings =
        json!({"findings": [{"code": "boundary-loop"}, {"code": "boundary-loop", "remedy": "burn"}]});
    let told = fault(&findings);
    assert!(told.starts_with("`plan`, finding 2: `remedy` cannot be `burn`; expected "), "{told}");
    assert!(told.contains("fill") && !told.contains("boundary-loop"), "{told}");
    let elements =
        json!([{"number": 0, "remedy": "fill"}, {"number": 1, "remedy": "fill", "method": "best"}]);
    let told = fault(&json!({"findings": [{"code": "boundary-loop", "elements": elements}]}));
    assert!(told.starts_with("`plan`, finding 1, element 2: `method` cannot be `best`; expected "), "{told}");
}

#[test]
fn other_faults_of_a_plan_are_told_with_their_place() {
    let how = |how: serde_json::Value| json!({"steps": [{"step": "fill-holes", "all": true, "except": [], "how": how}]});
    for (plan, want) in [
        (json!([]), "`plan` is no object"),
        (
            json!({"stepps": []}),
            "`plan` has no member `stepps`; expected input_sha256, findings, steps; did you mean `steps`?",
        ),
        (json!({"input_sha256": "ab"}), "`plan`: `input_sha256` is not 64 hexadecimal digits"),
        (json!({"steps": 7}), "`plan`: `steps` is no list"),
        (json!({"steps": ["weld"]}), "`plan`, step 1 is no object: `\"weld\"`"),
        (
            json!({"steps": [{"step": "weld", "strength": 3}]}),
            "`plan`, step 1 has no member `strength`; expected none",
        ),
        (json!({"steps": [{"step": "remove-crossing"}]}), "`plan`, step 1 lacks the member `rings`"),
        (json!({"steps": [{"rings": 2}]}), "`plan`, step 1 lacks the member `step`"),
        (
            json!({"steps": [{"step": "remove-crossing", "rings": 11}]}),
            "`plan`, step 1: a number is out of range, or a list has more than 10000 items",
        ),
        (
            json!({"steps": [{"step": "snap", "epsilon": "wide"}]}),
            "`plan`, step 1: `epsilon` cannot be `wide`: expected a number",
        ),
        (
            json!({"steps": [{"step": "remove-crossing", "rings": 1.5}]}),
            "`plan`, step 1: `rings` cannot be `1.5`: not a whole number",
        ),
        (
            json!({"findings": [{"code": "boundary-loop", "elements": [
                {"number": 0, "remedy": "fill", "method": "rbf", "band_rings": 1},
                {"number": 1, "remedy": "fill", "method": "smooth", "band_rings": 1}]}]}),
            "`plan`, finding 1, element 2: `band_rings` needs the method rbf or auto",
        ),
        (json!({"steps": [{"step": "unite"}, {"step": "weld"}]}), ""),
    ] {
        assert_eq!(fault(&plan), want);
    }
    assert!(PlanFault::of("{").unwrap().told.starts_with("`plan` is no JSON: "));
    let told = fault(&how(json!({"bridge": true})));
    assert!(
        told.starts_with("`plan`, step 1, `how` has no member `bridge`; expected method, band_rings, "),
        "{told}"
    );
}
