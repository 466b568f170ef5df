//! The operations around repair: what they return, what they refuse, what they tell on the way.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid, prism};
use meshmend::budget::{Budget, ProgressEvent, Stage, StopFlag, Stopped};
use meshmend::formats::{Encoding, Format};
use meshmend::pipeline::{
    Answer, Failure, Operation, Options, Outcome, Refusal, Require, Units, WrapChoices, run,
};
use std::sync::{Arc, Mutex};

fn answer(operation: Operation, bytes: &[u8], options: &Options) -> Answer {
    run(operation, bytes, options, &Budget::unlimited()).unwrap()
}

fn open_cube() -> RawSoup {
    let mut soup = cube();
    soup.triangles.truncate(10);
    soup
}

#[test]
fn analyze_and_verify_return_no_file_and_no_outcome() {
    let bytes = encode(&open_cube(), Encoding::Off);
    for operation in [Operation::Analyze, Operation::Verify] {
        let Answer { report, output, levels, picture } = answer(operation, &bytes, &Options::default());
        assert_eq!((report.operation, report.outcome, report.refusal, output), (operation, None, None, None));
        assert_eq!((levels, picture), (vec![], None));
        assert!(!report.input_certificate.is_printable());
        assert_eq!(report.before.is_some(), operation == Operation::Analyze);
        assert_eq!(report.input.bytes, bytes.len() as u64);
    }
}

#[test]
fn units_are_stated_or_assumed_to_be_millimetres() {
    let bytes = encode(&cube(), Encoding::Off);
    let facts =
        |units| answer(Operation::Verify, &bytes, &Options { units, ..Options::default() }).report.input;
    assert_eq!((facts(None).units, facts(None).units_are_stated), (Units::Millimetre, false));
    let inch = facts(Some(Units::Inch));
    assert_eq!((inch.units, inch.units_are_stated), (Units::Inch, true));
}

#[test]
fn convert_to_the_format_of_the_file_returns_its_bytes() {
    for (soup, outcome) in [(cube(), Outcome::Identical), (open_cube(), Outcome::Partial)] {
        let bytes = encode(&soup, Encoding::StlAscii);
        let options = Options { output_format: Some(Format::Stl), ..Options::default() };
        let answer = answer(Operation::Convert, &bytes, &options);
        assert_eq!(answer.report.outcome, Some(outcome));
        let output = answer.output.unwrap();
        assert_eq!((output.bytes, output.encoding), (None, Encoding::StlAscii));
    }
}

#[test]
fn convert_keeps_every_triangle_of_a_broken_mesh_and_says_what_holds() {
    let bytes = encode(&open_cube(), Encoding::Obj);
    for format in [Format::Stl, Format::Off, Format::Ply] {
        let options = Options { output_format: Some(format), ..Options::default() };
        let answer = answer(Operation::Convert, &bytes, &options);
        assert_eq!(answer.report.outcome, Some(Outcome::Partial));
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
        assert_eq!(answer.report.after.as_ref().unwrap().counts.triangles, 10);
        assert!(!answer.report.certificate.unwrap().is_printable());
        assert_eq!(answer.output.unwrap().encoding, format.default_encoding());
    }
}

#[test]
fn convert_refuses_a_broken_mesh_when_it_must_be_printable() {
    for output_format in [None, Some(Format::Stl)] {
        let options = Options { output_format, require: Some(Require::Printable), ..Options::default() };
        let answer = answer(Operation::Convert, &encode(&open_cube(), Encoding::Obj), &options);
        assert!(matches!(answer.report.refusal, Some(Refusal::NotRepairable { witness: Some(_) })));
        assert!(answer.output.is_none());
    }
}

#[test]
fn a_coordinate_beyond_float32_cannot_become_stl() {
    let bytes = encode(&cube().scaled(1e200), Encoding::Obj);
    for operation in [Operation::Convert, Operation::Repair] {
        let options = Options { output_format: Some(Format::Stl), ..Options::default() };
        let answer = answer(operation, &bytes, &options);
        assert_eq!(answer.report.outcome, Some(Outcome::Refused));
        assert!(matches!(answer.report.refusal, Some(Refusal::NotRepresentable { .. })));
    }
}

/// Flat in float32: the top is a quarter of a step above the bottom.
fn flat_in_float32() -> RawSoup {
    prism(2f64.powi(-25)).map(|[x, y, z]| [x, y, z + 1.0])
}

#[test]
fn a_solid_that_is_none_in_float32_comes_back_thicker() {
    let wrap = WrapChoices { cells: Some(24), ..WrapChoices::default() };
    let options = Options { wrap, ..Options::default() };
    let answer = answer(Operation::Repair, &encode(&flat_in_float32(), Encoding::Obj), &options);
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    let certificate = answer.report.certificate.unwrap();
    let thickness = certificate.shells[0].volume / (answer.report.after.unwrap().measures.area / 2.0);
    assert!(certificate.is_printable() && thickness > 2f64.powi(-12), "{thickness}");
}

#[test]
fn a_needle_that_rounds_to_nothing_is_dropped_and_the_rounding_is_told() {
    // A sound cube in f64, with a vertex so near to a corner that both are one in float32.
    let mut soup = cuboid([1.0, 1.0, 1.0]);
    let corner = soup.triangles.iter().position(|t| t.contains(&7)).unwrap();
    let [a, b, c] = soup.triangles[corner];
    let inner = std::array::from_fn(|k| {
        let [p, q, r] = [a, b, c].map(|v| soup.positions[v as usize][k]);
        let seven = soup.positions[7][k];
        seven + (p + q + r - 3.0 * seven) * 2f64.powi(-28)
    });
    soup.positions.push(inner);
    soup.triangles[corner] = [a, b, 8];
    soup.triangles.extend([[b, c, 8], [c, a, 8]]);
    let answer = answer(Operation::Repair, &encode(&soup, Encoding::Obj), &Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
    let rounding = answer.report.actions.iter().find(|action| action.step == "round-to-float32").unwrap();
    assert!(rounding.move_max > 0.0 && rounding.move_max < 1e-7);
    assert_eq!(answer.report.after.unwrap().counts.triangles, 12);
}

#[test]
fn rims_that_only_noise_keeps_apart_are_joined() {
    // The cube's lower half has its rim at z = 0, the upper half at z = 1e-17.
    let half = |from: f64, to: f64, open: f64| {
        let mut half = cuboid([1.0, 1.0, to - from]).moved([0.0, 0.0, from]);
        half.triangles.retain(|t| t.iter().any(|&v| half.positions[v as usize][2] != open));
        half
    };
    let soup = half(-1.0, 0.0, 0.0).with(&half(1e-17, 1.0, 1e-17));
    let answer = answer(Operation::Repair, &encode(&soup, Encoding::Obj), &Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
    let joining = answer.report.actions.iter().find(|action| action.step == "join-over-noise").unwrap();
    assert_eq!((joining.changes[0], joining.move_max), (("vertices_moved", 4), 1e-17));
    assert_eq!(answer.report.certificate.unwrap().shells.len(), 1);
}

#[test]
fn every_stage_is_entered_and_left() {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let budget = Budget::unlimited().observed_by(Box::new({
        let heard = Arc::clone(&heard);
        move |event| heard.lock().unwrap().push(event)
    }));
    for operation in [Operation::Repair, Operation::Simplify, Operation::Render] {
        run(operation, encode(&open_cube(), Encoding::Obj), &Options::default(), &budget).unwrap();
    }
    let heard = heard.lock().unwrap();
    for stage in Stage::ALL {
        assert!(heard.contains(&ProgressEvent::Enter(stage)), "{stage:?}");
    }
    let mut open = Vec::new();
    for &event in heard.iter() {
        match event {
            ProgressEvent::Enter(stage) => open.push(stage),
            ProgressEvent::Leave(stage) => assert_eq!(open.pop(), Some(stage)),
            ProgressEvent::Work(_) => {}
        }
    }
    assert!(open.is_empty());
}

#[test]
fn a_stopped_budget_ends_the_run_wherever_it_is() {
    let bytes = encode(&open_cube(), Encoding::Obj);
    let stop = StopFlag::default();
    stop.cancel();
    let cancelled = Budget::new(stop, u64::MAX, u64::MAX);
    let failure = run(Operation::Repair, &bytes, &Options::default(), &cancelled).unwrap_err();
    assert_eq!(failure, Failure::Stopped(Stopped::Cancelled));

    let free = Budget::unlimited();
    let whole = run(Operation::Repair, &bytes, &Options::default(), &free).unwrap();
    let used = usize::try_from(free.work_used()).unwrap();
    // The first ones, when most passes run, and some of all others.
    for work_max in (0..300).chain((300..used).step_by(used / 300 + 1)).map(|work| work as u64) {
        let budget = Budget::new(StopFlag::default(), work_max, u64::MAX);
        let failure = run(Operation::Repair, &bytes, &Options::default(), &budget).unwrap_err();
        assert_eq!(failure, Failure::Stopped(Stopped::Work { limit: work_max }));
    }
    let enough = Budget::new(StopFlag::default(), free.work_used(), u64::MAX);
    assert_eq!(run(Operation::Repair, &bytes, &Options::default(), &enough).unwrap(), whole);
}

#[test]
fn a_file_without_a_mesh_is_a_failure_with_its_place() {
    let failure = run(Operation::Repair, b"", &Options::default(), &Budget::unlimited()).unwrap_err();
    assert!(matches!(failure, Failure::Unreadable(_)));
}

#[test]
fn texture_stays_where_triangles_stay_and_what_is_lost_is_said() {
    // A tetrahedron of which each triangle has its own vertices.
    let points = [
        "0 0 0", "0 4 0", "4 0 0", "0 0 0", "4 0 0", "0 0 4", "4 0 0", "0 4 0", "0 0 4", "0 4 0", "0 0 0",
        "0 0 4",
    ];
    let mut text: String = points.iter().map(|p| format!("v {p}\n")).collect();
    text.push_str("vt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0.5\n");
    for t in 0..4 {
        text.push_str(&format!("f {}/1 {}/2 {}/3\n", 3 * t + 1, 3 * t + 2, 3 * t + 3));
    }
    let options = Options::default();
    let welded = run(Operation::Repair, text.as_bytes(), &options, &Budget::unlimited()).unwrap();
    let output = String::from_utf8(welded.output.unwrap().bytes.unwrap()).unwrap();
    assert_eq!(output.lines().filter(|line| line.starts_with("vt")).count(), 3, "the fourth has no corner");
    assert!(output.lines().filter(|line| line.starts_with('f')).all(|face| face.contains('/')));
    assert!(welded.report.actions.iter().all(|action| action.step != "texture"));

    let options = Options { output_format: Some(Format::Stl), ..Options::default() };
    let plain = run(Operation::Repair, text.as_bytes(), &options, &Budget::unlimited()).unwrap();
    let said = plain.report.actions.iter().find(|action| action.step == "texture").unwrap();
    assert_eq!(said.changes, [("triangles_with_texture", 0), ("triangles_without_texture", 4)]);
}

#[test]
fn materials_stay_with_their_faces_and_what_is_lost_is_said() {
    // A pyramid whose base has its own vertices, so that it is welded, and that has a copy of a side.
    let text = "mtllib wood.mtl\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 2 3\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n\
        usemtl sides\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 1 5\nusemtl base\nf 9 8 7 6\n";
    let answer =
        |options: Options| run(Operation::Repair, text.as_bytes(), &options, &Budget::unlimited()).unwrap();
    let welded = answer(Options::default());
    let output = String::from_utf8(welded.output.unwrap().bytes.unwrap()).unwrap();
    assert!(output.starts_with("mtllib wood.mtl\n"), "{output}");
    let words = |line: &str| line.split(' ').next().unwrap_or_default().to_owned();
    let faces: Vec<String> =
        output.lines().map(words).filter(|word| word == "f" || word == "usemtl").collect();
    assert_eq!(faces, ["usemtl", "f", "f", "f", "f", "usemtl", "f", "f"]);
    assert!(welded.report.actions.iter().all(|action| action.step != "materials"));

    let plain = answer(Options { output_format: Some(Format::Stl), ..Options::default() });
    let said = plain.report.actions.iter().find(|action| action.step == "materials").unwrap();
    assert_eq!(said.changes, [("triangles_with_material", 0), ("triangles_without_material", 6)]);
}
