//! Simplification from bytes to bytes: targets, colours, what is cut first, and what the report says.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use meshmend::budget::Budget;
use meshmend::formats::{self, Encoding, Format, ReadOptions};
use meshmend::mesh::{Color, Soup};
use meshmend::pipeline::{
    Answer, Operation, Options, Outcome, Output, Refusal, Require, SimplifyChoices, run,
};
use meshmend::simplify::{Mode, Target};

/// A cube whose faces are grids of `n` by `n` squares.
fn grid_cube(n: u32) -> RawSoup {
    let id = |axis: u32, side: u32, i: u32, j: u32| ((axis * 2 + side) * (n + 1) + i) * (n + 1) + j;
    let mut soup = RawSoup::default();
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
        for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            let mut p = [0.0; 3];
            p[axis as usize] = f64::from(side);
            p[(axis as usize + 1) % 3] = f64::from(i) / f64::from(n);
            p[(axis as usize + 2) % 3] = f64::from(j) / f64::from(n);
            soup.positions.push(p);
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| id(axis, side, i, j));
            let outward = [[a, b, c], [a, c, d]];
            soup.triangles.extend(if side == 1 { outward } else { outward.map(|[a, b, c]| [a, c, b]) });
        }
    }
    soup
}

fn simplified(bytes: &[u8], choices: SimplifyChoices) -> Answer {
    let options = Options { simplify: choices, ..Options::default() };
    run(Operation::Simplify, bytes, &options, &Budget::unlimited()).unwrap()
}

fn to(targets: &[Target], mode: Mode) -> SimplifyChoices {
    SimplifyChoices { targets: targets.to_vec(), mode: Some(mode), ..SimplifyChoices::default() }
}

fn read(output: &Output) -> Soup {
    let bytes = output.bytes.as_ref().unwrap();
    formats::read(bytes, output.encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

const MODES: [Mode; 3] = [Mode::Strict, Mode::Fast, Mode::Guarded];

#[test]
fn a_cube_of_many_triangles_becomes_one_of_twelve_and_stays_where_it_is() {
    for mode in MODES {
        let answer = simplified(&encode(&grid_cube(8), Encoding::StlBinary), to(&[Target::Faces(12)], mode));
        let report = &answer.report;
        assert_eq!(report.outcome, Some(Outcome::Simplified), "{mode:?}");
        assert!(report.certificate.as_ref().unwrap().is_printable(), "{mode:?}");
        assert_eq!(read(answer.output.as_ref().unwrap()).triangles.len(), 12, "{mode:?}");
        let [level] = report.levels.as_slice() else { panic!("one level") };
        assert_eq!((level.simplified.faces_before, level.simplified.faces_after), (768, 12));
        assert!(level.simplified.is_reached && level.simplified.collapses == 378);
        assert!(report.distance.unwrap().upper() < 1e-5, "{mode:?}: {:?}", report.distance);
    }
}

#[test]
fn several_targets_give_a_file_each_in_the_order_asked() {
    let bytes = encode(&grid_cube(8), Encoding::Off);
    for mode in MODES {
        let targets = [Target::Ratio(0.125), Target::Faces(400), Target::Error(1e-3)];
        let answer = simplified(&bytes, to(&targets[..2], mode));
        let faces: Vec<usize> = answer.report.levels.iter().map(|l| l.simplified.faces_after).collect();
        assert!(faces[0] <= 96 && (380..=400).contains(&faces[1]), "{mode:?}: {faces:?}");
        let outputs: Vec<usize> =
            answer.output.iter().chain(&answer.levels).map(|output| read(output).triangles.len()).collect();
        assert_eq!(outputs, faces, "{mode:?}");
        let by_error = simplified(&bytes, to(&targets[2..], mode));
        assert!(by_error.report.levels[0].simplified.faces_after < 100, "{mode:?}: flat faces cost nothing");
    }
}

#[test]
fn what_is_no_manifold_is_cut_first_and_the_certificate_says_what_holds() {
    let bytes = encode(&grid_cube(4).with(&grid_cube(4).moved([1.0, 1.0, 0.0])), Encoding::Off);
    for mode in MODES {
        let answer = simplified(&bytes, to(&[Target::Faces(24)], mode));
        let actions = &answer.report.actions;
        let cut = actions.iter().find(|action| action.step == "cut-singular").unwrap();
        assert!(cut.changes.iter().any(|&(name, count)| name == "singular_edges" && count == 4), "{cut:?}");
        assert_eq!(answer.report.outcome, Some(Outcome::Simplified));
        assert!(!answer.report.certificate.unwrap().is_printable(), "readers weld the common edge");
        let options = Options { require: Some(Require::Printable), ..Options::default() };
        let refused = run(Operation::Simplify, &bytes, &options, &Budget::unlimited()).unwrap();
        assert!(matches!(refused.report.refusal, Some(Refusal::NotRepairable { witness: Some(_) })));
    }
}

#[test]
fn face_colours_keep_their_borders() {
    let mut soup = grid_cube(6);
    let text = String::from_utf8(encode(&soup, Encoding::Off)).unwrap();
    let head = text.lines().take(2 + soup.positions.len());
    let red = |t: usize| if t < soup.triangles.len() / 2 { "255 0 0" } else { "0 0 255" };
    let faces =
        text.lines().skip(2 + soup.positions.len()).enumerate().map(|(t, line)| format!("{line} {}", red(t)));
    let colored: Vec<String> = head.map(str::to_owned).chain(faces).collect();
    soup.triangles.clear();
    let area = |output: &Output| {
        let read = read(output);
        let of = |t: usize| {
            let [a, b, c] = read.corners(t as u32);
            (b - a).cross(c - a).length() / 2.0
        };
        let is_red = |t: &usize| matches!(read.face_colors[*t], Some(Color::Bytes([255, 0, 0], _)));
        (0..read.triangles.len()).filter(is_red).map(of).sum::<f64>()
    };
    for mode in MODES {
        let answer = simplified(colored.join("\n").as_bytes(), to(&[Target::Faces(12)], mode));
        assert!((area(answer.output.as_ref().unwrap()) - 3.0).abs() < 1e-9, "{mode:?}");
    }
}

#[test]
fn a_repair_with_a_target_ends_with_a_simplification_that_stays_certified() {
    let mut soup = grid_cube(6);
    soup.triangles.pop();
    let simplify = SimplifyChoices { targets: vec![Target::Faces(12)], ..SimplifyChoices::default() };
    let options = Options { simplify, output_format: Some(Format::Stl), ..Options::default() };
    let answer =
        run(Operation::Repair, &encode(&soup, Encoding::Off), &options, &Budget::unlimited()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    assert_eq!(answer.report.actions.last().unwrap().step, "simplify");
    assert_eq!(read(answer.output.as_ref().unwrap()).triangles.len(), 12);
    let whole =
        run(Operation::Repair, &encode(&cube(), Encoding::Off), &Options::default(), &Budget::unlimited());
    assert_eq!(
        whole.unwrap().report.outcome,
        Some(Outcome::Identical),
        "without a target nothing is simplified"
    );
}

#[test]
fn a_target_that_cannot_be_reached_is_told_with_the_reasons() {
    let bytes = encode(&cuboid([1.0, 2.0, 3.0]), Encoding::Off);
    for mode in MODES {
        let answer = simplified(&bytes, to(&[Target::Faces(2)], mode));
        let level = &answer.report.levels[0].simplified;
        assert!(!level.is_reached && level.faces_after >= 4, "{mode:?}: {level:?}");
        assert!(level.refusals.total() > 0, "{mode:?}");
    }
}
