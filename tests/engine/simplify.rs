//! Simplification from bytes to bytes: targets, colours, what is cut first, and what the report says.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use meshmend::budget::Budget;
use meshmend::formats::{self, Encoding, Format, ReadOptions};
use meshmend::mesh::{Color, Soup};
use meshmend::pipeline::{
    Answer, FidelityLimits, Operation, Options, Outcome, Output, Refusal, Require, SimplifyChoices,
    VertexColors, run,
};
use meshmend::simplify::{Mode, Placement, Target};

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
fn the_distance_is_that_of_the_written_file_whose_coordinates_are_rounded() {
    // Three million from the origin, float32 has places a quarter apart.
    let mut cube = grid_cube(8);
    let low = 3e6 + 0.1;
    cube.positions.iter_mut().flatten().for_each(|x| *x = low + 20.0 * *x);
    let bytes = encode(&cube, Encoding::Off);
    for mode in MODES {
        let options = Options {
            simplify: to(&[Target::Faces(12)], mode),
            output_format: Some(Format::Stl),
            ..Options::default()
        };
        let answer = run(Operation::Simplify, &bytes, &options, &Budget::unlimited()).unwrap();
        let written = read(answer.output.as_ref().unwrap());
        // Both are cubes: each plane moved by as much as its corners.
        let offset = written.positions.iter().map(|p| (p.x - low).abs().min((p.x - low - 20.0).abs()));
        let offset = offset.fold(0.0, f64::max);
        let distance = answer.report.distance.unwrap();
        assert!(offset > 0.05 && distance.lower() >= 0.99 * offset, "{mode:?}: {offset} {distance:?}");
        let of_level = answer.report.levels[0].distance.unwrap();
        assert_eq!(of_level, distance);
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
        let cut = actions.iter().find(|action| action.step == "cut").unwrap();
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
        run(Operation::Repair, encode(&soup, Encoding::Off), &options, &Budget::unlimited()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    assert_eq!(answer.report.actions.last().unwrap().step, "simplify");
    assert_eq!(read(answer.output.as_ref().unwrap()).triangles.len(), 12);
    let whole =
        run(Operation::Repair, encode(&cube(), Encoding::Off), &Options::default(), &Budget::unlimited());
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

#[test]
fn a_repair_with_several_targets_gives_a_certified_file_for_each() {
    let whole = grid_cube(8);
    let mut holed = whole.clone();
    holed.triangles.truncate(holed.triangles.len() - 1);
    for (soup, outcome) in [(whole, Outcome::Simplified), (holed, Outcome::Repaired)] {
        let targets = vec![Target::Faces(12), Target::Faces(400), Target::Ratio(0.25)];
        let simplify = SimplifyChoices { targets, ..SimplifyChoices::default() };
        let options = Options { simplify, ..Options::default() };
        let bytes = encode(&soup, Encoding::StlBinary);
        let answer = run(Operation::Repair, &bytes, &options, &Budget::unlimited()).unwrap();
        assert_eq!(answer.report.outcome, Some(outcome));
        let faces: Vec<usize> = answer.report.levels.iter().map(|l| l.simplified.faces_after).collect();
        assert_eq!((faces.len(), faces[0]), (3, 12));
        assert!(answer.report.levels.iter().all(|level| level.certificate.is_printable()));
        let outputs: Vec<usize> =
            answer.output.iter().chain(&answer.levels).map(|output| read(output).triangles.len()).collect();
        assert_eq!(outputs, faces);
        assert!(answer.report.actions.iter().filter(|action| action.step == "simplify").count() == 1);
    }
}

/// A ball of 768 triangles.
fn ball() -> RawSoup {
    grid_cube(8).map(|p| {
        let q = p.map(|x| x - 0.5);
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.map(|x| x / length)
    })
}

#[test]
fn an_error_is_kept_beside_a_count_that_goes_past_it() {
    for mode in [Mode::Fast, Mode::Strict, Mode::Guarded] {
        let levels = |targets: Vec<Target>| {
            let simplify = SimplifyChoices { targets, mode: Some(mode), ..SimplifyChoices::default() };
            let options = Options { simplify, ..Options::default() };
            let answer =
                run(Operation::Simplify, encode(&ball(), Encoding::Off), &options, &Budget::unlimited());
            answer.unwrap().report.levels.iter().map(|l| l.simplified.faces_after).collect::<Vec<_>>()
        };
        let alone = levels(vec![Target::Error(0.005)]);
        assert!(alone[0] > 40, "{mode:?}: {alone:?}");
        let both = levels(vec![Target::Faces(40), Target::Error(0.005)]);
        assert_eq!(both[1], alone[0], "{mode:?}: {both:?}");
    }
}

#[test]
fn a_simplified_repair_says_how_far_it_is_and_keeps_the_limits_of_the_caller() {
    let bytes = encode(&ball(), Encoding::Off);
    let repaired = |targets: &[usize], limit| {
        let targets = targets.iter().map(|&count| Target::Faces(count)).collect();
        let simplify = SimplifyChoices { targets, ..SimplifyChoices::default() };
        let limits = FidelityLimits { deviation_max: limit, ..FidelityLimits::default() };
        let options = Options { simplify, limits, ..Options::default() };
        run(Operation::Repair, &bytes, &options, &Budget::unlimited()).unwrap()
    };
    let far = |answer: &Answer| answer.report.distance.unwrap().upper();
    let (fine, coarse) = (repaired(&[300], None), repaired(&[40], None));
    assert_eq!(coarse.report.outcome, Some(Outcome::Repaired), "sides share no vertex");
    assert!(far(&fine) > 0.001 && far(&coarse) > 2.0 * far(&fine), "{} {}", far(&fine), far(&coarse));
    assert!(coarse.report.losses.unwrap().visible_loss > 0.5);
    let between = Some((far(&fine) + far(&coarse)) / 2.0);
    assert!(repaired(&[300], between).output.is_some());
    for targets in [&[40][..], &[300, 40]] {
        let answer = repaired(targets, between);
        assert!(matches!(answer.report.refusal, Some(Refusal::DeviationBeyondLimit { .. })), "{targets:?}");
        assert!(answer.output.is_none() && answer.levels.is_empty() && answer.report.levels.is_empty());
    }
}

/// The OBJ text of a cube of grids, each side a chart of its own: its points are where the corners are on the side.
fn textured_cube(n: u32) -> (String, impl Fn(&Soup, usize, usize) -> [f64; 2]) {
    let soup = grid_cube(n);
    let per_side = soup.positions.len() / 6;
    let point = |side: usize, p: [f64; 3]| [p[(side / 2 + 1) % 3] + 2.0 * side as f64, p[(side / 2 + 2) % 3]];
    let mut text = String::new();
    for (i, p) in soup.positions.iter().enumerate() {
        let [u, v] = point(i / per_side, *p);
        text += &format!("v {} {} {}\nvt {u} {v}\n", p[0], p[1], p[2]);
    }
    for t in &soup.triangles {
        let [a, b, c] = t.map(|v| v + 1);
        text += &format!("f {a}/{a} {b}/{b} {c}/{c}\n");
    }
    let want = move |soup: &Soup, t: usize, k: usize| {
        let [a, b, c] = soup.corners(t as u32);
        let normal = (b - a).cross(c - a).to_array();
        let axis = (0..3).find(|&axis| normal[axis].abs() > 1e-9).unwrap();
        point(2 * axis + usize::from(normal[axis] > 0.0), soup.corners(t as u32)[k].to_array())
    };
    (text, want)
}

#[test]
fn texture_coordinates_of_an_obj_are_kept_on_their_side_of_seams() {
    let (text, want) = textured_cube(6);
    let choices = |mode| SimplifyChoices { placement: Placement::OntoEnd, ..to(&[Target::Faces(40)], mode) };
    for mode in MODES {
        let answer = simplified(text.as_bytes(), choices(mode));
        let soup = read(answer.output.as_ref().unwrap());
        assert!((12..=40).contains(&soup.triangles.len()), "{mode:?}");
        assert_eq!(soup.positions.len(), soup.triangles.len() / 2 + 2, "the sides are one surface");
        for t in 0..soup.triangles.len() {
            let points = soup.texture.of_triangle(t).unwrap();
            assert_eq!(points, [0, 1, 2].map(|k| want(&soup, t, k)), "{mode:?}");
        }
    }
    let stl =
        Options { output_format: Some(Format::Stl), simplify: choices(Mode::Fast), ..Options::default() };
    let answer = run(Operation::Simplify, text.as_bytes(), &stl, &Budget::unlimited()).unwrap();
    assert!(read(answer.output.as_ref().unwrap()).texture.is_empty());
    // A repair keeps the points of the triangles that it keeps.
    let repair =
        |text: &str| run(Operation::Repair, text.as_bytes(), &Options::default(), &Budget::unlimited());
    let mended = repair(text.trim_end().rsplit_once('\n').unwrap().0).unwrap();
    let soup = read(mended.output.as_ref().unwrap());
    assert_eq!(soup.triangles.len(), 6 * 6 * 2 * 6);
    let is_kept = |&t: &usize| {
        soup.texture.of_triangle(t).is_some_and(|points| points == [0, 1, 2].map(|k| want(&soup, t, k)))
    };
    let (kept, new): (Vec<usize>, Vec<usize>) = (0..soup.triangles.len()).partition(is_kept);
    assert_eq!(kept.len(), 6 * 6 * 2 * 6 - 1);
    // A seam runs into the new one, which has the points of one side near it: here each side has a picture of its own.
    let points = soup.texture.of_triangle(new[0]).unwrap();
    let side = 2.0 * (points.iter().map(|[u, _]| u).sum::<f64>() / 6.0).floor();
    assert!(points.iter().all(|[u, _]| (side..=side + 1.0).contains(u)), "{points:?}");
}

#[test]
fn priorities_are_colours_from_blue_to_red() {
    let soup = grid_cube(6);
    for (mode, format) in MODES.into_iter().zip([Format::Off, Format::Ply, Format::Off]) {
        let choices = SimplifyChoices {
            vertex_colors: VertexColors::Priority,
            ..to(&[Target::Faces(100), Target::Faces(60)], mode)
        };
        let options = Options { simplify: choices, output_format: Some(format), ..Options::default() };
        let answer =
            run(Operation::Simplify, encode(&soup, Encoding::StlBinary), &options, &Budget::unlimited());
        let answer = answer.unwrap();
        for output in answer.output.iter().chain(&answer.levels) {
            let colors = read(output).vertex_colors;
            let red = |color: &Option<Color>| match color {
                Some(Color::Bytes([r, 0, b], None | Some(255))) if r + b == 255 => *r,
                other => panic!("{mode:?}: {other:?}"),
            };
            let reds: Vec<u8> = colors.iter().map(red).collect();
            assert_eq!(reds.iter().min(), Some(&0), "{mode:?}");
            assert!(reds.iter().max() > Some(&200), "{mode:?}: {reds:?}");
        }
    }
}
