//! The second word of a verdict.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use meshmend::budget::Budget;
use meshmend::formats::{self, Encoding, Format, ReadOptions};
use meshmend::geom::{DVec3, closest_point_on_triangle};
use meshmend::pipeline::{
    Answer, ChangeKind, Fidelity, FidelityLimits, Operation, Options, Outcome, Refusal, Require,
    SimplifyChoices, run,
};
use meshmend::simplify::Target;
use std::f64::consts::PI;

fn answer(operation: Operation, soup: &RawSoup, options: &Options) -> Answer {
    run(operation, encode(soup, Encoding::Obj), options, &Budget::unlimited()).unwrap()
}

fn word(answer: &Answer) -> Fidelity {
    answer.report.fidelity.as_ref().unwrap().word
}

fn open_cube() -> RawSoup {
    let mut soup = cube();
    soup.triangles.truncate(10);
    soup
}

#[test]
fn a_valid_file_and_one_whose_faces_are_turned_are_exact() {
    assert_eq!(word(&answer(Operation::Repair, &cube(), &Options::default())), Fidelity::Exact);
    let mut turned = cube();
    turned.triangles[0].swap(0, 1);
    let turned = answer(Operation::Repair, &turned, &Options::default());
    assert_eq!((turned.report.outcome, word(&turned)), (Some(Outcome::Repaired), Fidelity::Exact));
}

#[test]
fn bodies_that_are_inside_out_are_exact_once_they_are_turned() {
    let inside_out = || cube().inside_out();
    let apart = inside_out().moved([5.0; 3]);
    for soup in [inside_out(), inside_out().with(&apart), cube().with(&apart)] {
        let limits = FidelityLimits { volume_change_max: Some(1e-6), ..FidelityLimits::default() };
        let options = Options { require: Some(Require::Faithful), limits, ..Options::default() };
        let turned = answer(Operation::Repair, &soup, &options);
        assert_eq!((turned.report.outcome, word(&turned)), (Some(Outcome::Repaired), Fidelity::Exact));
    }
}

#[test]
fn a_face_there_twice_goes_and_the_rest_is_exact() {
    let mut twice = cube();
    twice.triangles.push(twice.triangles[3]);
    for operation in [Operation::Repair, Operation::CutStitch] {
        assert_eq!(word(&answer(operation, &twice, &Options::default())), Fidelity::Exact, "{operation:?}");
    }
}

#[test]
fn a_missing_side_is_invented_and_refused_where_the_result_must_be_faithful() {
    let closed = answer(Operation::Repair, &open_cube(), &Options::default());
    let verdict = closed.report.fidelity.unwrap();
    assert_eq!(verdict.word, Fidelity::Changed);
    let invented = verdict.changes.iter().find(|change| change.kind == ChangeKind::Invented).unwrap();
    assert!((invented.measured - 1.0 / 6.0).abs() < 0.01, "{}", invented.measured);
    let faithful = Options { require: Some(Require::Faithful), ..Options::default() };
    let refused = answer(Operation::Repair, &open_cube(), &faithful);
    assert_eq!(refused.report.outcome, Some(Outcome::Refused));
    assert!(matches!(refused.report.refusal, Some(Refusal::NotFaithful { .. })) && refused.output.is_none());
    assert_eq!(answer(Operation::Repair, &cube(), &faithful).report.outcome, Some(Outcome::Identical));
}

/// A box of 10 each way without a lid, and a cube in the middle of it that does not touch it.
fn cup_with_a_cube(size: f64) -> RawSoup {
    let mut cup = cuboid([10.0; 3]);
    cup.triangles.truncate(10);
    let low = (10.0 - size) / 2.0;
    cup.with(&cuboid([size; 3]).moved([low; 3]))
}

#[test]
fn what_a_patch_over_an_opening_covers_is_told_as_lost() {
    let report = answer(Operation::Repair, &cup_with_a_cube(2.0), &Options::default()).report;
    let losses = report.losses.unwrap();
    // The cube had 24 of 524, all of which could be seen through the opening.
    assert!((losses.visible_loss - 24.0 / 524.0).abs() < 0.01, "{losses:?}");
    assert_eq!((losses.bodies_lost, report.fidelity.unwrap().word), (1, Fidelity::Changed));
}

#[test]
fn where_much_is_behind_patches_open_parts_become_walls() {
    let report = answer(Operation::Repair, &cup_with_a_cube(6.0), &Options::default()).report;
    let losses = report.losses.unwrap();
    assert!(losses.visible_loss < 1e-3 && losses.bodies_lost == 0, "{losses:?}");
    assert!(report.actions.iter().any(|action| action.step == "thicken"), "{:?}", report.tried);
    // A body through a wall of the cup besides, so that they have to be united.
    let bar = cuboid([4.0, 4.0, 9.0]).moved([3.0, 3.0, 5.0]);
    let mut cup = cuboid([10.0; 3]);
    cup.triangles.truncate(10);
    let losses = answer(Operation::Repair, &cup.with(&bar), &Options::default()).report.losses.unwrap();
    assert!(losses.visible_loss < 1e-3, "{losses:?}");
}

#[test]
fn a_limit_of_the_deviation_is_kept_by_what_patches_cover() {
    let limits = FidelityLimits { deviation_max: Some(1.0), ..FidelityLimits::default() };
    let options = Options { limits, require: Some(Require::Printable), ..Options::default() };
    let answer = answer(Operation::Repair, &cup_with_a_cube(2.0), &options);
    let distance = answer.report.distance;
    assert!(answer.output.is_none() || distance.unwrap().upper() <= 1.0, "{distance:?}");
}

#[test]
fn a_corner_that_lies_far_away_makes_no_damage_small() {
    let mut file = ball(6).scaled(10.0).map(|place| place.map(|x| f64::from(x as f32)));
    let sum = |p: &[f64; 3]| p.iter().sum::<f64>();
    let lowest = file.positions.iter_mut().min_by(|a, b| sum(a).total_cmp(&sum(b))).unwrap();
    *lowest = [1e13; 3];
    let report = answer(Operation::Repair, &file, &Options::default()).report;
    assert_eq!(report.outcome, Some(Outcome::Repaired));
    let changes = report.fidelity.unwrap().changes;
    assert!(changes.iter().any(|change| change.kind == ChangeKind::Moved), "{changes:?}");
}

#[test]
fn a_conversion_that_rounds_is_faithful() {
    let options = Options { output_format: Some(Format::Stl), ..Options::default() };
    let rounded = answer(Operation::Convert, &cuboid([0.1, 0.2, 0.3]), &options);
    assert_eq!(word(&rounded), Fidelity::Faithful);
    assert_eq!(word(&answer(Operation::Convert, &cuboid([1.0, 2.0, 3.0]), &options)), Fidelity::Exact);
}

#[test]
fn each_level_of_a_simplification_has_its_own_word() {
    let simplify =
        SimplifyChoices { targets: vec![Target::Ratio(1.0), Target::Faces(4)], ..SimplifyChoices::default() };
    for operation in [Operation::Simplify, Operation::Repair] {
        let options = Options { simplify: simplify.clone(), ..Options::default() };
        let levels = answer(operation, &cube(), &options).report.levels;
        let words: Vec<_> = levels.iter().map(|level| level.fidelity.as_ref().unwrap().word).collect();
        assert_eq!(words, [Fidelity::Exact, Fidelity::Changed], "{operation:?}");
    }
    let all = Options { simplify, require: Some(Require::Faithful), ..Options::default() };
    let refused = answer(Operation::Simplify, &cube(), &all).report;
    assert!(matches!(refused.refusal, Some(Refusal::NotFaithful { .. })), "{:?}", refused.refusal);
}

/// A ball of radius 1 in `n` rows of `2 n` squares.
pub(crate) fn ball(n: u32) -> RawSoup {
    let place = |row: u32, column: u32| {
        let [polar, around] = [row, column].map(|step| f64::from(step) / f64::from(n) * PI);
        [polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos()]
    };
    let columns = 2 * n;
    let id = |row: u32, column: u32| match row {
        0 => 0,
        row if row == n => 1,
        row => 2 + (row - 1) * columns + column % columns,
    };
    let mut soup = RawSoup { positions: vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], ..RawSoup::default() };
    soup.positions.extend((1..n).flat_map(|row| (0..columns).map(move |column| place(row, column))));
    for (row, column) in (0..n).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let [a, b, c, d] =
            [id(row, column), id(row + 1, column), id(row + 1, column + 1), id(row, column + 1)];
        soup.triangles
            .extend([[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a));
    }
    soup
}

#[test]
fn with_fewer_triangles_volumes_are_compared_where_they_are_defined() {
    let (upright, apart) = (ball(24), ball(24).inside_out().moved([5.0; 3]));
    let fewer = SimplifyChoices { targets: vec![Target::Ratio(0.5)], ..SimplifyChoices::default() };
    let options = Options { simplify: fewer, require: Some(Require::Faithful), ..Options::default() };
    for soup in [
        &upright,
        &apart,
        &upright.clone().with(&apart),
        &upright.clone().with(&upright.clone().moved([0.5, 0.0, 0.0])),
    ] {
        let repaired = answer(Operation::Repair, soup, &options);
        assert_eq!(word(&repaired), Fidelity::Faithful, "{:?}", repaired.report.fidelity);
    }
    for soup in [&upright, &apart] {
        let simplified = answer(Operation::Simplify, soup, &Options { require: None, ..options.clone() });
        assert_eq!(word(&simplified), Fidelity::Faithful, "{:?}", simplified.report.fidelity);
    }
}

#[test]
fn a_body_inside_another_that_turns_the_same_way_counts_for_no_volume() {
    let soup = cuboid([30.0; 3]).with(&ball(8).moved([15.0; 3]));
    let limits = FidelityLimits { volume_change_max: Some(1e-6), ..FidelityLimits::default() };
    let repaired = answer(Operation::Repair, &soup, &Options { limits, ..Options::default() });
    assert_eq!(repaired.report.outcome, Some(Outcome::Repaired), "{:?}", repaired.report.refusal);
    assert_ne!(word(&repaired), Fidelity::Changed, "{:?}", repaired.report.fidelity);
}

#[test]
fn what_is_only_looked_at_has_no_word() {
    for operation in [Operation::Analyze, Operation::Plan, Operation::Verify] {
        assert_eq!(answer(operation, &cube(), &Options::default()).report.fidelity, None);
    }
}

/// A box of 10 each way with `n` by `n` squares on each side, open at the top or not, in which two vertices are one.
fn folded_box(n: usize, is_open: bool, [kept, gone]: [u32; 2]) -> RawSoup {
    let mut soup = RawSoup::default();
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, n)]) {
        if is_open && (axis, side) == (2, n) {
            continue;
        }
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut corner = |along_u: usize, along_v: usize| {
                let mut at = [side; 3];
                (at[u], at[v]) = (i + along_u, j + along_v);
                let place = at.map(|k| 10.0 * k as f64 / n as f64);
                soup.positions.iter().position(|&known| known == place).unwrap_or_else(|| {
                    soup.positions.push(place);
                    soup.positions.len() - 1
                }) as u32
            };
            let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if side == 0 {
                square.reverse();
            }
            let [a, b, c, d] = square;
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    for v in soup.triangles.iter_mut().flatten().filter(|v| **v == gone) {
        *v = kept;
    }
    soup.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    soup
}

#[test]
fn nothing_that_walls_bury_is_farther_than_the_report_says() {
    let cases = [
        (2, false, [15, 6]),
        (2, false, [13, 24]),
        (2, true, [12, 22]),
        (3, true, [21, 43]),
        (3, true, [1, 17]),
        (3, false, [30, 54]),
    ];
    let mut walls = 0;
    for case @ (n, is_open, merged) in cases {
        let soup = folded_box(n, is_open, merged);
        let Answer { report, output, .. } = answer(Operation::Repair, &soup, &Options::default());
        walls += u32::from(report.actions.iter().any(|action| action.step == "thicken"));
        let budget = Budget::unlimited();
        let output = output.unwrap();
        let bytes = output.bytes.unwrap();
        let result = formats::read(&bytes, output.encoding, &ReadOptions::default(), &budget).unwrap();
        let nearest = |place: DVec3| {
            let to = |t: u32| closest_point_on_triangle(place, result.corners(t)).distance(place);
            (0..result.triangles.len() as u32).map(to).fold(f64::INFINITY, f64::min)
        };
        let mut sampled: f64 = 0.0;
        for triangle in &soup.triangles {
            let [a, b, c] = triangle.map(|v| DVec3::from(soup.positions[v as usize]));
            for (i, j) in (0..=8u8).flat_map(|i| (0..=8 - i).map(move |j| (i, j))) {
                let [i, j] = [i, j].map(|k| f64::from(k) / 8.0);
                sampled = sampled.max(nearest(a + (b - a) * i + (c - a) * j));
            }
        }
        let told = report.distance.unwrap().forward.upper;
        assert!(told >= sampled * (1.0 - 1e-9), "{case:?}: {told} is told, and a place is at {sampled}");
    }
    assert!(walls >= 3, "{walls} of the results have walls");
}
