//! Steps of plans in any order, with any parameters, on broken solids.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::{ENCODINGS, encode};
use crate::repair_pipeline::broken;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::mesh::{ChosenEdges, StitchValidity};
use meshmend::pipeline::{ChosenPlan, Failure, Operation, Options, Outcome, Require, Step, run};
use meshmend::repair::Selection;
use meshmend::repair::cut::CutOptions;
use meshmend::repair::duplicates::OppositePairs;
use meshmend::repair::fill::{FillOptions, Method};
use meshmend::repair::nest::{NestOptions, NestingPolicy, ShellFate};
use meshmend::repair::pair_sheets::Across;
use meshmend::repair::polygons::DegenerateFaces;
use meshmend::repair::snap::SnapOptions;
use meshmend::repair::thin_faces::ThinFaces;

/// One of all steps but those that make a new mesh.
fn any_step(random: &mut Random, soup: &RawSoup) -> Step {
    let numbers = |random: &mut Random, end: usize| {
        let mut list: Vec<u32> = (0..random.below(4)).map(|_| random.below(end + 2) as u32).collect();
        list.sort_unstable();
        list
    };
    let count = soup.triangles.len();
    let length = random.pick(&[0.0, 1e-3, 0.3, 1.0, 1e300]);
    match random.below(25) {
        0 => Step::SplitPolygons(random.pick(&[DegenerateFaces::Split, DegenerateFaces::Drop])),
        1 => [Step::ClearNoise, Step::JoinOverNoise, Step::TurnToBridge, Step::CloseChordalGaps]
            [random.below(4)]
        .clone(),
        2 => Step::RoundToF32,
        3 => Step::Weld,
        4 => Step::DropDegenerate,
        5 => Step::SplitCollinear,
        6 => Step::SplitTVertices,
        7 => Step::RemoveParts(numbers(random, count)),
        8 => Step::DropDuplicates(random.pick(&[OppositePairs::Cancel, OppositePairs::KeepFirst])),
        9 => Step::RemoveCrossing { rings: random.below(4) as u32 },
        10 => Step::Orient,
        11 => Step::Cut(CutOptions::default()),
        12 => Step::Pinch(ChosenEdges::default(), StitchValidity::Exact),
        13 => Step::Snap(SnapOptions { epsilon: Some(length), ..SnapOptions::default() }),
        14 => {
            let holes = match random.one_in(2) {
                true => Selection::AllBut(numbers(random, count * 3)),
                false => Selection::Only(numbers(random, count * 3)),
            };
            let method = random.pick(&[Method::Auto, Method::Flat, Method::Minimal, Method::Smooth]);
            let (refines, bridges) = (random.one_in(2), random.one_in(2));
            Step::FillHoles(FillOptions { holes, method, refines, bridges, ..FillOptions::default() })
        }
        15 => Step::MendThinFaces(ThinFaces { needles: true, caps: random.one_in(2), folds: true }),
        16 => Step::Thicken { wall: length },
        17 => Step::OpenContacts,
        18 => Step::JoinContacts { size: length },
        19 => Step::PairSheets(random.pick(&[Across::Solid, Across::Void])),
        21 => [Step::Unite, Step::UniteAndCopyBare, Step::Enclose, Step::EncloseAndCopyBare][random.below(4)]
            .clone(),
        22 => {
            if random.one_in(2) {
                [Step::SpanRims, Step::SpanOddEdges][random.below(2)].clone()
            } else {
                Step::RoundWhereItMatters
            }
        }
        23 => Step::BoreContacts { steps: 16 },
        20 => Step::DropNearDuplicates { epsilon: length },
        _ => match random.one_in(2) {
            true => Step::JoinCopies,
            false => {
                let fate = random.pick(&[ShellFate::Stays, ShellFate::Turns, ShellFate::Goes]);
                let chosen = numbers(random, count).into_iter().map(|t| (t, fate)).collect();
                let policy =
                    random.pick(&[NestingPolicy::AsOriented, NestingPolicy::Alternate, NestingPolicy::Fill]);
                Step::Nest(NestOptions { policy, is_embedded: false, chosen })
            }
        },
    }
}

#[test]
fn any_list_of_steps_ends_in_a_certified_mesh_a_partial_one_or_a_typed_refusal() {
    let mut random = Random::new(61);
    let (mut certified, mut partial, mut refused, mut mismatched) = (0, 0, 0, 0);
    let count = cases(1_500, 100_000);
    for case in 0..count {
        let soup = broken(&mut random);
        let bytes = encode(&soup, random.pick(&ENCODINGS));
        let steps: Vec<Step> = (0..1 + random.below(9)).map(|_| any_step(&mut random, &soup)).collect();
        let plan = ChosenPlan { steps: Some(steps.clone()), ..ChosenPlan::default() };
        let options = Options { plan: Some(plan), require: Some(Require::BestEffort), ..Options::default() };
        match run(Operation::Repair, &bytes, &options, &Budget::unlimited()) {
            Ok(answer) => match answer.report.outcome {
                Some(Outcome::Repaired | Outcome::Identical | Outcome::Converted) => {
                    assert!(answer.report.certificate.unwrap().is_printable(), "case {case}: {steps:?}");
                    certified += 1;
                }
                Some(Outcome::Partial) => {
                    assert!(answer.output.is_some(), "case {case}: {steps:?}");
                    partial += 1;
                }
                Some(Outcome::Refused) => refused += 1,
                other => panic!("case {case}: {other:?} of {steps:?}"),
            },
            Err(Failure::PlanMismatch(_)) => mismatched += 1,
            Err(other) => panic!("case {case}: {other:?} of {steps:?}"),
        }
    }
    assert!(certified > count / 50 && partial > count / 4 && mismatched > 0);
    println!(
        "| random lists of steps | {count} | {certified} certified, {partial} partial, {refused} refused, {mismatched} not for the file |"
    );
}
