//! Plans: what is proposed, what an edited plan changes, and steps that run again.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::repair::{coarse, without};
use crate::solids::{cube, cuboid};
use crate::support::corpus_files;
use meshmend::analysis::DefectCode;
use meshmend::budget::Budget;
use meshmend::formats::Encoding;
use meshmend::pipeline::{
    Answer, ChosenPlan, ChosenRemedy, CutStitchChoices, Failure, FidelityLimits, Operation, Options, Outcome,
    PlanMismatch, Proposal, Refusal, Remedy, Require, SimplifyChoices, Step, run,
};
use meshmend::repair::nest::NestingPolicy;
use meshmend::simplify::Target;
use std::fs;

fn repair(bytes: &[u8], options: &Options) -> Result<Answer, Failure> {
    run(Operation::Repair, bytes, options, &Budget::unlimited())
}

/// The returned bytes.
fn bytes_of<'a>(answer: &'a Answer, input: &'a [u8]) -> Option<&'a [u8]> {
    answer.output.as_ref().map(|output| output.bytes.as_deref().unwrap_or(input))
}

fn with_plan(plan: ChosenPlan, require: Option<Require>) -> Options {
    Options { plan: Some(plan), require, ..coarse() }
}

fn chosen(code: DefectCode, remedy: Option<Remedy>, elements: &[(u32, Remedy)]) -> ChosenPlan {
    let finding = ChosenRemedy { code, remedy, elements: elements.to_vec(), holes: Vec::new() };
    ChosenPlan { findings: vec![finding], ..ChosenPlan::default() }
}

/// A cuboid without two faces that lie apart: two holes.
fn with_two_holes() -> Vec<u8> {
    encode(&without(cuboid([3.0, 4.0, 5.0]), &[0, 2]), Encoding::Off)
}

fn loops(answer: &Answer) -> u64 {
    answer.report.after.as_ref().unwrap().counts.boundary_loops
}

#[test]
fn a_plan_without_steps_gives_an_invalid_file_back_only_where_no_solid_is_asked_for() {
    let (open, solid) = (with_two_holes(), encode(&cube(), Encoding::Off));
    let nothing = || ChosenPlan { steps: Some(Vec::new()), ..ChosenPlan::default() };
    for require in [None, Some(Require::Printable), Some(Require::Faithful)] {
        let refused = repair(&open, &with_plan(nothing(), require)).unwrap();
        assert!(refused.output.is_none(), "{require:?}");
        assert!(matches!(refused.report.refusal, Some(Refusal::NotRepairable { witness: Some(_) })));
        let kept = repair(&solid, &with_plan(nothing(), require)).unwrap();
        assert_eq!(
            (bytes_of(&kept, &solid), kept.report.outcome),
            (Some(&solid[..]), Some(Outcome::Identical))
        );
    }
    let kept = repair(&open, &with_plan(nothing(), Some(Require::None))).unwrap();
    assert_eq!((bytes_of(&kept, &open), kept.report.outcome), (Some(&open[..]), Some(Outcome::Partial)));
}

#[test]
fn a_plan_names_each_defect_with_a_remedy_its_choices_and_how_sure_it_is() {
    let bytes = with_two_holes();
    let answer = run(Operation::Plan, &bytes, &Options::default(), &Budget::unlimited()).unwrap();
    assert!(answer.output.is_none());
    let plan = answer.report.plan.as_ref().unwrap();
    assert_eq!((plan.input_sha256, &plan.steps), (answer.report.input.sha256, &None));
    let [holes] = &plan.findings[..] else { panic!("{plan:?}") };
    assert_eq!((holes.code, holes.count, holes.remedy), (DefectCode::BoundaryLoop, 2, Remedy::Fill));
    assert_eq!(holes.choices, [Remedy::Fill, Remedy::Thicken, Remedy::Keep]);
    assert_eq!(holes.elements.len(), 2);
    let all = || holes.elements.iter().map(|hole| hole.confidence).chain([holes.confidence]);
    assert!(all().all(|confidence| (0.0..=1.0).contains(&confidence)));
}

#[test]
fn a_hole_that_is_to_stay_stays_and_the_other_is_filled() {
    let bytes = with_two_holes();
    for kept in [0, 1] {
        let plan = chosen(DefectCode::BoundaryLoop, None, &[(kept, Remedy::Keep)]);
        let answer = repair(&bytes, &with_plan(plan, Some(Require::BestEffort))).unwrap();
        assert_eq!((answer.report.outcome, loops(&answer)), (Some(Outcome::Partial), 1));
        let before = &answer.report.before.as_ref().unwrap().findings[0].witnesses[kept as usize];
        let after = &answer.report.after.as_ref().unwrap().findings[0].witnesses[0];
        assert_eq!(before.figures, after.figures, "the one that was to stay");
        let only = chosen(DefectCode::BoundaryLoop, Some(Remedy::Keep), &[(1 - kept, Remedy::Fill)]);
        let same = repair(&bytes, &with_plan(only, Some(Require::BestEffort))).unwrap();
        assert_eq!(bytes_of(&same, &bytes), bytes_of(&answer, &bytes));
    }
    // What is to stay is not rebuilt away either.
    let plan = chosen(DefectCode::BoundaryLoop, Some(Remedy::Keep), &[]);
    let refused = repair(&bytes, &with_plan(plan, None)).unwrap();
    assert_eq!(refused.report.outcome, Some(Outcome::Refused));
}

#[test]
fn shells_are_turned_kept_or_removed_one_by_one() {
    let inverted = |x: f64| cube().moved([x, 0.0, 0.0]).inside_out();
    let bytes = encode(&cube().with(&inverted(2.0)).with(&inverted(4.0)), Encoding::Obj);
    let shells = |answer: &Answer| answer.report.certificate.as_ref().unwrap().shells.len();
    let all = repair(&bytes, &coarse()).unwrap();
    assert_eq!(shells(&all), 3);
    let one = chosen(DefectCode::InvertedShell, None, &[(1, Remedy::Remove)]);
    let two = repair(&bytes, &with_plan(one, None)).unwrap();
    assert_eq!((two.report.outcome, shells(&two)), (Some(Outcome::Repaired), 2));
    let bounds = two.report.after.as_ref().unwrap().measures.bounds.unwrap();
    assert_eq!(bounds.max.x, 3.0, "the last of three went");
    let none = chosen(DefectCode::InvertedShell, Some(Remedy::Remove), &[]);
    assert_eq!(shells(&repair(&bytes, &with_plan(none, None)).unwrap()), 1);
    let kept = chosen(DefectCode::InvertedShell, Some(Remedy::Keep), &[(0, Remedy::Turn)]);
    let partial = repair(&bytes, &with_plan(kept, Some(Require::BestEffort))).unwrap();
    assert_eq!(partial.report.outcome, Some(Outcome::Partial));
}

#[test]
fn a_shell_in_a_shell_becomes_a_cavity_where_the_caller_says_so() {
    let bytes = encode(&cuboid([3.0; 3]).with(&cube().moved([1.0; 3])), Encoding::Obj);
    let volume = |options: &Options| {
        let answer = repair(&bytes, options).unwrap();
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
        answer.report.after.unwrap().measures.volume.unwrap()
    };
    let with = |nesting: NestingPolicy| Options { nesting, ..coarse() };
    assert_eq!(volume(&with(NestingPolicy::AsOriented)), 27.0);
    assert_eq!(volume(&with(NestingPolicy::Alternate)), 26.0);
    assert_eq!(volume(&with(NestingPolicy::Fill)), 27.0);
    let turn = chosen(DefectCode::MisnestedShell, None, &[(0, Remedy::Turn)]);
    assert_eq!(volume(&with_plan(turn, None)), 26.0);
}

#[test]
fn a_cavity_of_a_valid_solid_is_filled_only_when_that_is_asked() {
    let hollow = cuboid([3.0; 3]).with(&cube().moved([1.0; 3]).inside_out());
    let bytes = encode(&hollow, Encoding::Obj);
    for nesting in [NestingPolicy::AsOriented, NestingPolicy::Alternate] {
        let answer = repair(&bytes, &Options { nesting, ..coarse() }).unwrap();
        assert_eq!(answer.report.outcome, Some(Outcome::Identical));
    }
    let answer = repair(&bytes, &Options { nesting: NestingPolicy::Fill, ..coarse() }).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    assert_eq!(answer.report.certificate.as_ref().unwrap().shells.len(), 1);
    assert_eq!(answer.report.after.unwrap().measures.volume, Some(27.0));
}

#[test]
fn what_lies_inside_is_filled_also_behind_an_opening_and_where_bodies_meet() {
    let outer = || cuboid([10.0; 3]);
    let room = |at: [f64; 3]| cuboid([4.0; 3]).moved(at).inside_out();
    let mut open = outer().with(&room([3.0; 3]));
    open.triangles.drain(..2);
    let rooms_meet = outer().with(&room([2.0; 3])).with(&room([4.0; 3]));
    let bodies_meet = outer().with(&room([3.0; 3])).with(&outer().moved([7.0, 1.0, 1.0]));
    for (file, expected) in [(open, 1000.0), (rooms_meet, 1000.0), (bodies_meet, 2000.0 - 243.0)] {
        let options = Options { nesting: NestingPolicy::Fill, ..coarse() };
        let answer = repair(&encode(&file, Encoding::Obj), &options).unwrap();
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{expected}");
        assert_eq!(answer.report.certificate.as_ref().unwrap().shells.len(), 1);
        let volume = answer.report.after.unwrap().measures.volume.unwrap();
        assert!((volume - expected).abs() < 1e-6, "{volume} {expected}");
    }
}

#[test]
fn a_cavity_that_may_not_be_filled_is_not_rebuilt_instead() {
    let hollow = cuboid([10.0; 3]).with(&cuboid([4.0; 3]).moved([3.0; 3]).inside_out());
    let limits = FidelityLimits { volume_change_max: Some(0.01), ..FidelityLimits::default() };
    let options = Options { nesting: NestingPolicy::Fill, limits, ..coarse() };
    let answer = repair(&encode(&hollow, Encoding::Obj), &options).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Refused));
    let refusal = answer.report.refusal.unwrap();
    assert!(matches!(refusal, Refusal::VolumeChangeBeyondLimit { .. }), "{refusal:?}");
}

#[test]
fn a_tiny_part_of_a_valid_file_goes_only_when_that_is_asked_and_is_listed() {
    let crumb = cube().scaled(1e-3).moved([20.0, 0.0, 0.0]);
    let bytes = encode(&cuboid([10.0; 3]).with(&crumb), Encoding::Obj);
    assert_eq!(repair(&bytes, &coarse()).unwrap().report.outcome, Some(Outcome::Identical));
    for plan in [
        chosen(DefectCode::NoiseShell, Some(Remedy::Remove), &[]),
        chosen(DefectCode::NoiseShell, None, &[(0, Remedy::Remove)]),
    ] {
        let answer = repair(&bytes, &with_plan(plan, None)).unwrap();
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
        assert_eq!(answer.report.certificate.as_ref().unwrap().shells.len(), 1);
        let removed = answer.report.actions.iter().find(|action| action.step == "remove-parts").unwrap();
        assert!(removed.reason.contains("those with faces 12"), "{}", removed.reason);
    }
}

/// A square slab whose top has a strip of this width, of two triangles.
fn with_strip(width: f64) -> RawSoup {
    let top = |x: f64| [[x, 0.0, 1.0], [x, 1.0, 1.0]];
    let points: Vec<[f64; 3]> = [0.0, 1.0, 1.0 + width, 2.0].into_iter().flat_map(top).collect();
    let positions = [points, vec![[1.0, 0.5, -1.0]]].concat();
    let strip = |i: u32| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]];
    let rim = [0, 2, 4, 6, 7, 5, 3, 1];
    let sides = (0..8).map(|i| [rim[(i + 1) % 8], rim[i], 8]);
    RawSoup { positions, triangles: (0..3).flat_map(strip).chain(sides).collect() }
}

#[test]
fn needles_of_a_valid_file_go_only_when_that_is_asked() {
    let bytes = encode(&with_strip(1e-4), Encoding::Obj);
    assert_eq!(repair(&bytes, &coarse()).unwrap().report.outcome, Some(Outcome::Identical));
    let plan = chosen(DefectCode::Needle, Some(Remedy::Collapse), &[]);
    let answer = repair(&bytes, &with_plan(plan, None)).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    let after = answer.report.after.as_ref().unwrap();
    assert_eq!(after.findings.iter().filter(|finding| finding.code == DefectCode::Needle).count(), 0);
    assert!(answer.report.distance.unwrap().upper() <= 1.01e-4);
}

#[test]
fn rims_that_are_close_are_joined_when_the_caller_says_how_far() {
    // The lid of a cube, a little off.
    let lid = without(cube(), &[0, 1, 4, 5, 6, 7, 8, 9, 10, 11]).moved([0.0, 0.0, 1e-6]);
    let bytes = encode(&without(cube(), &[2, 3]).with(&lid), Encoding::Obj);
    let choices = CutStitchChoices { epsilon: Some(1e-5), ..CutStitchChoices::default() };
    let answer = repair(&bytes, &Options { cut_stitch: choices, ..coarse() }).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    assert_eq!(answer.report.after.as_ref().unwrap().counts.triangles, 12);
    let snap = answer.report.actions.iter().find(|action| action.step == "snap").unwrap();
    assert!((0.9e-6..1.1e-6).contains(&snap.move_max), "{}", snap.move_max);
}

#[test]
fn a_plan_that_is_not_for_the_file_is_told() {
    let bytes = with_two_holes();
    let mismatch = |plan: ChosenPlan| match repair(&bytes, &with_plan(plan, None)) {
        Err(Failure::PlanMismatch(mismatch)) => mismatch,
        other => panic!("{other:?}"),
    };
    let other = ChosenPlan { input_sha256: Some([0; 32]), ..ChosenPlan::default() };
    assert_eq!(mismatch(other), PlanMismatch::OtherFile);
    assert_eq!(
        mismatch(chosen(DefectCode::Overlap, None, &[])),
        PlanMismatch::NoSuchDefect(DefectCode::Overlap)
    );
    assert_eq!(
        mismatch(chosen(DefectCode::BoundaryLoop, None, &[(2, Remedy::Keep)])),
        PlanMismatch::NoSuchElement(DefectCode::BoundaryLoop, 2)
    );
    assert_eq!(
        mismatch(chosen(DefectCode::BoundaryLoop, Some(Remedy::Turn), &[])),
        PlanMismatch::NoSuchRemedy(DefectCode::BoundaryLoop, Remedy::Turn)
    );
}

/// The steps that made the result of `answer`, to be run again.
fn log_of(answer: &Answer) -> ChosenPlan {
    let plan = answer.report.plan.as_ref().unwrap();
    ChosenPlan { input_sha256: Some(plan.input_sha256), steps: plan.steps.clone(), ..ChosenPlan::default() }
}

/// Everything as `plan` proposes, said once more.
fn as_proposed(bytes: &[u8], options: &Options) -> ChosenPlan {
    let answer = run(Operation::Plan, bytes, options, &Budget::unlimited()).unwrap();
    let plan = answer.report.plan.unwrap();
    let chosen = |proposal: &Proposal| ChosenRemedy {
        code: proposal.code,
        remedy: Some(proposal.remedy),
        elements: proposal.elements.iter().map(|element| (element.number, element.remedy)).collect(),
        holes: Vec::new(),
    };
    let findings = plan.findings.iter().map(chosen).collect();
    ChosenPlan { input_sha256: Some(plan.input_sha256), findings, steps: None }
}

/// Runs the steps of a repair again: the same bytes, outcome and steps. So does the plan given back as it is.
fn assert_replays(bytes: &[u8], options: &Options, name: &str) -> Option<Outcome> {
    let first = repair(bytes, options).ok()?;
    let outcome = first.report.outcome;
    let plain = Options { plan: Some(as_proposed(bytes, options)), ..options.clone() };
    let same = repair(bytes, &plain).unwrap_or_else(|failure| panic!("{name}: {failure:?}"));
    assert_eq!(bytes_of(&same, bytes), bytes_of(&first, bytes), "{name}, as proposed");
    assert_eq!(same.report.outcome, outcome, "{name}, as proposed");
    if outcome == Some(Outcome::Refused) {
        assert_eq!(first.report.plan.as_ref().unwrap().steps, None);
        return outcome;
    }
    let again = repair(bytes, &Options { plan: Some(log_of(&first)), ..options.clone() }).unwrap();
    assert_eq!(bytes_of(&again, bytes), bytes_of(&first, bytes), "{name}");
    assert_eq!(again.report.outcome, outcome, "{name}");
    let steps =
        |answer: &Answer| answer.report.plan.as_ref().and_then(|plan| plan.steps.as_ref().map(Vec::len));
    assert_eq!(steps(&again), steps(&first), "{name}");
    outcome
}

#[test]
fn the_steps_of_a_repair_give_the_same_bytes_when_they_run_again() {
    let mut outcomes = Vec::new();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    for folder in fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir())
    {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.extension().is_none_or(|extension| extension == "json") {
                continue;
            }
            let bytes = fs::read(&path).unwrap();
            let name = path.display().to_string();
            let best = Options { require: Some(Require::BestEffort), ..coarse() };
            let none = Options { require: Some(Require::None), ..coarse() };
            let fewer = SimplifyChoices { targets: vec![Target::Ratio(0.5)], ..SimplifyChoices::default() };
            for options in [coarse(), best, none, Options { simplify: fewer, ..coarse() }] {
                outcomes.extend(assert_replays(&bytes, &options, &name));
            }
        }
    }
    for outcome in [Outcome::Identical, Outcome::Repaired, Outcome::Rebuilt, Outcome::Partial] {
        assert!(outcomes.contains(&outcome), "{outcome:?} is among them");
    }
}

#[test]
fn the_steps_of_repairs_of_real_files_give_the_same_bytes_when_they_run_again() {
    let Some(files) = corpus_files(&["stl", "obj", "off", "ply"]) else { return };
    let small = |path: &std::path::PathBuf| fs::metadata(path).is_ok_and(|file| file.len() < 100_000);
    let mut repaired = 0;
    for path in files.into_iter().filter(small).step_by(3) {
        let outcome = assert_replays(&fs::read(&path).unwrap(), &coarse(), &path.display().to_string());
        repaired += u32::from(outcome == Some(Outcome::Repaired));
    }
    assert!(repaired > 3, "{repaired}");
}

#[test]
fn a_step_that_is_left_out_is_undone_and_without_any_the_file_comes_back() {
    let bytes = with_two_holes();
    let whole = repair(&bytes, &coarse()).unwrap();
    let log = log_of(&whole);
    let steps = log.steps.clone().unwrap();
    let fills = |step: &Step| matches!(step, Step::FillHoles(_));
    assert_eq!(steps.iter().filter(|step| fills(step)).count(), 1);
    let replayed = |steps: Vec<Step>| {
        let plan = ChosenPlan { steps: Some(steps), ..log.clone() };
        repair(&bytes, &with_plan(plan, Some(Require::BestEffort))).unwrap()
    };
    let without_fill = replayed(steps.iter().filter(|step| !fills(step)).cloned().collect());
    assert_eq!((without_fill.report.outcome, loops(&without_fill)), (Some(Outcome::Partial), 2));
    assert_eq!(without_fill.report.identical_triangle_share, Some(1.0));
    let nothing = replayed(Vec::new());
    assert_eq!(bytes_of(&nothing, &bytes), Some(&bytes[..]));
    // Undone from the last step on: each prefix has the holes until they are filled.
    for count in 0..=steps.len() {
        let prefix = &steps[..count];
        let answer = replayed(prefix.to_vec());
        let holes = answer.report.after.as_ref().map_or(2, |mesh| mesh.counts.boundary_loops);
        assert_eq!(holes, if prefix.iter().any(fills) { 0 } else { 2 }, "{count} steps");
    }
}

/// A file of the fixtures.
fn fixture(name: &str) -> Vec<u8> {
    fs::read(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)).unwrap()
}

fn found(answer: &Answer, code: DefectCode) -> u64 {
    let after = answer.report.after.as_ref().unwrap();
    after.findings.iter().filter(|finding| finding.code == code).map(|finding| finding.count).sum()
}

/// What the best effort with `remedy` for all defects of `code` gives.
fn with_remedy(name: &str, code: DefectCode, remedy: Remedy) -> Answer {
    repair(&fixture(name), &with_plan(chosen(code, Some(remedy), &[]), Some(Require::BestEffort))).unwrap()
}

fn has_step(answer: &Answer, name: &str) -> bool {
    answer.report.actions.iter().any(|action| action.step == name)
}

#[test]
fn a_defect_that_is_to_stay_is_left_as_it_is() {
    for (name, code, step) in [
        ("non_manifold/non_manifold_edge.off", DefectCode::NonManifoldEdge, "cut"),
        ("non_manifold/non_manifold_vertex.off", DefectCode::NonManifoldVertex, "cut"),
        ("orientation/orientation_conflict.off", DefectCode::OrientationConflict, "orient"),
        ("degenerate/collinear_face.off", DefectCode::CollinearFace, "split-collinear"),
    ] {
        let kept = with_remedy(name, code, Remedy::Keep);
        assert!(!has_step(&kept, step), "{name}");
        assert!(kept.report.after.is_none() || found(&kept, code) > 0, "{name}");
        let usual = repair(&fixture(name), &coarse()).unwrap();
        assert!(has_step(&usual, step), "{name}");
    }
}

#[test]
fn a_wall_between_two_bodies_goes_or_one_side_of_it_stays() {
    let bytes = encode(&cube().with(&cube().moved([1.0, 0.0, 0.0])), Encoding::Obj);
    let with = |remedy| {
        let plan = chosen(DefectCode::OppositeDuplicateFace, Some(remedy), &[]);
        repair(&bytes, &with_plan(plan, Some(Require::BestEffort))).unwrap().report
    };
    let joined = with(Remedy::DropBoth);
    assert_eq!((joined.outcome, joined.after.unwrap().counts.triangles), (Some(Outcome::Repaired), 20));
    let walled = with(Remedy::DropOne);
    assert_ne!(walled.outcome, Some(Outcome::Repaired), "a wall inside a solid is none");
}

#[test]
fn caps_are_flipped_and_folds_closed_where_that_is_asked() {
    // A pyramid on its tip; on its flat top a vertex lies close to the diagonal.
    let top = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.505, 0.495]];
    let positions = top.map(|[x, y]| [x, y, 1.0]).into_iter().chain([[0.5, 0.5, -1.0]]).collect();
    let triangles = [[0, 1, 4], [1, 2, 4], [2, 0, 4], [0, 2, 3]];
    let sides = (0..4).map(|i| [(i + 1) % 4, i, 5]);
    let capped = RawSoup { positions, triangles: triangles.into_iter().chain(sides).collect() };
    // A slit of next to no width in the ridge of a roof.
    let slit = RawSoup {
        positions: vec![
            [0.0, -1.0, 0.0],
            [0.0, 1.0, 0.0],
            [-5e-5, 0.0, 1.0],
            [5e-5, 0.0, 1.0],
            [-2.0, 0.0, -1.0],
            [2.0, 0.0, -1.0],
            [0.0, 0.0, -3.0],
        ],
        triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 4], [2, 0, 4], [3, 1, 5], [0, 3, 5]]
            .into_iter()
            .chain([[4, 0, 6], [1, 4, 6], [5, 1, 6], [0, 5, 6]])
            .collect(),
    };
    for (bytes, code, remedy, count) in [
        (encode(&capped, Encoding::Off), DefectCode::Cap, Remedy::Flip, "caps_flipped"),
        (encode(&slit, Encoding::Off), DefectCode::FoldedEdge, Remedy::Collapse, "folds_closed"),
    ] {
        let of_step = |answer: &Answer| {
            let changes = answer.report.actions.iter().flat_map(|action| &action.changes);
            changes.filter(|(n, _)| *n == count).map(|(_, count)| count).sum::<u64>()
        };
        let usual = repair(&bytes, &coarse()).unwrap();
        let before = usual.report.before.as_ref().unwrap();
        assert!(before.findings.iter().any(|finding| finding.code == code), "{code:?}");
        assert_eq!(of_step(&usual), 0, "{code:?}");
        let plan = chosen(code, Some(remedy), &[]);
        let mended = repair(&bytes, &with_plan(plan, Some(Require::BestEffort))).unwrap();
        assert!(of_step(&mended) > 0, "{code:?}");
        assert_eq!(found(&mended, code), 0, "{code:?}");
    }
}

#[test]
fn a_face_by_itself_becomes_a_wall_goes_or_stays() {
    let bytes = encode(
        &cube().with(&RawSoup {
            positions: vec![[3.0, 0.0, 0.0], [4.0, 0.0, 0.0], [3.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
        }),
        Encoding::Off,
    );
    let with = |remedy| {
        let plan = chosen(DefectCode::IsolatedFace, Some(remedy), &[]);
        repair(&bytes, &with_plan(plan, Some(Require::BestEffort))).unwrap().report
    };
    let gone = with(Remedy::Remove);
    assert_eq!((gone.outcome, gone.after.unwrap().counts.triangles), (Some(Outcome::Repaired), 12));
    let kept = with(Remedy::Keep);
    assert_eq!((kept.outcome, kept.after.unwrap().counts.triangles), (Some(Outcome::Partial), 13));
    let wall = with(Remedy::Thicken);
    assert_eq!(wall.certificate.unwrap().shells.len(), 2);
}

#[test]
fn a_face_that_floats_close_over_another_goes_when_the_caller_says_how_close() {
    let lid = without(cube(), &[0, 1, 4, 5, 6, 7, 8, 9, 10, 11]).moved([1e-6, 0.0, 1e-6]);
    let bytes = encode(&cube().with(&lid), Encoding::Obj);
    let choices = CutStitchChoices { epsilon: Some(1e-5), ..CutStitchChoices::default() };
    let answer = repair(&bytes, &Options { cut_stitch: choices, ..coarse() }).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    assert_eq!(answer.report.after.as_ref().unwrap().counts.triangles, 12);
    assert_eq!(answer.report.certificate.as_ref().unwrap().shells.len(), 1);
    let dropped = answer.report.actions.iter().find(|action| action.step == "drop-near-duplicates").unwrap();
    assert!(dropped.reason.contains("with faces 12"), "{}", dropped.reason);
}
