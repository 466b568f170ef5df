//! Rims that lie side by side are joined by a repair that is not told how far apart they are.

use crate::repair::answer;
use meshmend::pipeline::{CutStitchChoices, Fidelity, Options, Outcome};
use std::fmt::Write as _;

type Face = Vec<[f64; 3]>;

/// The squares of a cube of side 10, outward, each of so many by so many.
fn cube(cells: u32) -> Vec<Face> {
    sides([[cells; 2]; 6]).concat()
}

/// The six sides of a cube of side 10, outward, each of so many by so many rectangles.
fn sides(cells: [[u32; 2]; 6]) -> Vec<Vec<Face>> {
    let side = |(number, [n, m]): (usize, [u32; 2])| {
        let (axis, is_far) = (number / 2, number % 2 == 1);
        let face = |(i, j): (u32, u32)| {
            let corner = |(a, b): (u32, u32)| {
                let mut p = [0.0; 3];
                p[axis] = if is_far { 10.0 } else { 0.0 };
                p[(axis + 1) % 3] = f64::from(i + a) * 10.0 / f64::from(n);
                p[(axis + 2) % 3] = f64::from(j + b) * 10.0 / f64::from(m);
                p
            };
            let mut face: Face = [(0, 0), (1, 0), (1, 1), (0, 1)].map(corner).to_vec();
            if !is_far {
                face.reverse();
            }
            face
        };
        (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).map(face).collect()
    };
    cells.into_iter().enumerate().map(side).collect()
}

/// Each convex polygon as a fan of triangles.
fn triangles(polygons: &[Face]) -> Vec<Face> {
    let fan = |p: &Face| (2..p.len()).map(|k| vec![p[0], p[k - 1], p[k]]).collect::<Vec<_>>();
    polygons.iter().flat_map(fan).collect()
}

/// An OBJ of faces without common vertices, every corner up to `gap` / 2 from its place along each axis.
fn apart(faces: &[Face], gap: f64) -> String {
    let mut state = 7u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) - 0.5
    };
    let (mut text, mut count) = (String::new(), 0);
    for face in faces {
        for p in face {
            let [x, y, z] = p.map(|x| x + gap * random());
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        let numbers: Vec<String> = (0..face.len()).map(|k| (count + k + 1).to_string()).collect();
        let _ = writeln!(text, "f {}", numbers.join(" "));
        count += face.len();
    }
    text
}

/// Gaps as shares of the diagonal of the cube, and these in its unit.
fn gaps() -> impl Iterator<Item = (f64, f64)> {
    [1e-9, 1e-7, 1e-5, 1e-3].into_iter().map(|share| (share, share * 300f64.sqrt() / 2.0))
}

#[track_caller]
fn assert_is_the_cube(text: &str, options: &Options, what: &str) {
    let answer = answer(text.as_bytes(), options);
    let report = &answer.report;
    assert_eq!(report.outcome, Some(Outcome::Repaired), "{what}: {:?}", report.refusal);
    assert_eq!(report.tried, ["as-drawn"], "{what}");
    let fidelity = report.fidelity.as_ref().unwrap();
    assert_eq!(fidelity.word, Fidelity::Faithful, "{what}: {fidelity:?}");
    let after = report.after.as_ref().unwrap();
    assert_eq!(after.counts.components, 1, "{what}");
    assert!((after.measures.volume.unwrap() - 1000.0).abs() < 10.0, "{what}: {:?}", after.measures.volume);
}

#[test]
fn triangles_whose_corners_differ_a_little_are_one_body() {
    for (share, gap) in gaps() {
        for cells in [1, 4] {
            let text = apart(&triangles(&cube(cells)), gap);
            assert_is_the_cube(&text, &Options::default(), &format!("{cells} cells, {share:e}"));
        }
    }
}

#[test]
fn squares_are_joined_as_triangles_are() {
    for (share, gap) in gaps() {
        assert_is_the_cube(&apart(&cube(3), gap), &Options::default(), &format!("{share:e}"));
    }
}

#[test]
fn faces_are_turned_to_be_joined() {
    let mut faces = triangles(&cube(2));
    faces.iter_mut().step_by(3).for_each(|face| face.reverse());
    for (share, gap) in gaps() {
        assert_is_the_cube(&apart(&faces, gap), &Options::default(), &format!("{share:e}"));
    }
}

#[test]
fn a_crack_is_closed_and_not_both_of_its_sides() {
    for (share, gap) in gaps() {
        let mut squares = cube(4);
        // What is above the middle lies a little higher.
        for face in &mut squares {
            if face.iter().all(|p| p[2] >= 5.0) {
                face.iter_mut().for_each(|p| p[2] += gap);
            }
        }
        assert_is_the_cube(&apart(&squares, 0.0), &Options::default(), &format!("{share:e}"));
    }
}

/// Numbers of rectangles of which no side divides its edges as its neighbours do.
const UNLIKE: [[u32; 2]; 6] = [[2, 3], [5, 4], [7, 6], [1, 8], [3, 5], [4, 7]];

/// Turned about two axes, so that no edge is along an axis and rounding takes vertices off edges, with six digits.
fn turned(faces: &[Face]) -> Vec<Face> {
    let turn = |[x, y, z]: [f64; 3]| {
        let [x, y] = [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y];
        [x, 12.0 / 13.0 * y - 5.0 / 13.0 * z, 5.0 / 13.0 * y + 12.0 / 13.0 * z]
            .map(|c| (c * 1e6).round() / 1e6)
    };
    faces.iter().map(|face| face.iter().map(|&p| turn(p)).collect()).collect()
}

#[test]
fn sides_that_divide_their_common_edges_differently_are_joined() {
    let rectangles = turned(&sides(UNLIKE).concat());
    assert_is_the_cube(&apart(&rectangles, 0.0), &Options::default(), "rectangles");
    let mut faces = triangles(&rectangles);
    assert_is_the_cube(&apart(&faces, 0.0), &Options::default(), "triangles");
    for (share, gap) in gaps() {
        assert_is_the_cube(&apart(&faces, gap), &Options::default(), &format!("{share:e}"));
    }
    faces.iter_mut().for_each(|face| face.reverse());
    assert_is_the_cube(&apart(&faces, 0.0), &Options::default(), "inside out");
}

#[test]
fn sides_that_divide_their_common_edges_differently_are_turned_to_be_joined() {
    let mut sides = sides(UNLIKE);
    sides.iter_mut().step_by(2).flatten().for_each(|face| face.reverse());
    let faces = turned(&triangles(&sides.concat()));
    assert_is_the_cube(&apart(&faces, 0.0), &Options::default(), "every other side");
}

/// The corners of a regular polygon around the z axis.
fn ring(sides: u32, radius: f64, z: f64) -> Face {
    (0..sides)
        .map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(sides))
        .map(|angle| [radius * angle.cos(), radius * angle.sin(), z])
        .collect()
}

/// The rectangles between two such polygons of as many sides, outward.
fn band(low: &Face, high: &Face) -> Vec<Face> {
    let next = |i: usize| (i + 1) % low.len();
    (0..low.len()).map(|i| vec![low[i], low[next(i)], high[next(i)], high[i]]).collect()
}

/// Two cylinders of radius 5 and height 4 on each other, of so many sides, each with a polygon at one end.
fn stack(sides: [u32; 2]) -> Vec<Face> {
    let wall = |sides: u32, z: f64| band(&ring(sides, 5.0, z), &ring(sides, 5.0, z + 4.0));
    let floor = ring(sides[0], 5.0, 0.0).into_iter().rev().collect();
    [wall(sides[0], 0.0), wall(sides[1], 4.0), vec![floor, ring(sides[1], 5.0, 8.0)]].concat()
}

#[test]
fn round_parts_of_different_numbers_of_sides_are_joined() {
    for sides in [[48, 36], [36, 48], [50, 64]] {
        for faces in [stack(sides), triangles(&stack(sides))] {
            let report = answer(apart(&faces, 0.0).as_bytes(), &Options::default()).report;
            let what = format!("{sides:?}: {:?}", report.tried);
            assert_eq!(report.fidelity.unwrap().word, Fidelity::Faithful, "{what}");
            let after = report.after.unwrap();
            assert_eq!(after.counts.components, 1, "{what}");
            let area = |n: u32| 12.5 * f64::from(n) * (std::f64::consts::TAU / f64::from(n)).sin();
            let truth = 4.0 * (area(sides[0]) + area(sides[1]));
            let volume = after.measures.volume.unwrap();
            assert!((volume / truth - 1.0).abs() < 0.005, "{what}: {volume} instead of {truth}");
        }
    }
}

#[test]
fn a_slit_is_closed_between_the_triangles_that_are_there() {
    // One vertex a little beside the middle of an edge: the slit has a rim of its own.
    let text = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nv 4.5 0.0001 -0.0001\n\
                f 1 5 4\nf 5 2 4\nf 1 3 2\nf 1 4 3\nf 2 3 4\n";
    let report = answer(text.as_bytes(), &Options::default()).report;
    assert_eq!(report.outcome, Some(Outcome::Repaired), "{:?}", report.refusal);
    assert!(report.actions.iter().flat_map(|a| &a.changes).all(|c| c.0 != "edges_divided" || c.1 == 0));
    assert_eq!(report.after.unwrap().counts.triangles, 6, "those of the file and one in the slit");
}

#[test]
fn the_caller_says_how_far_or_that_nothing_is_to_be_joined() {
    let (_, gap) = gaps().nth(2).unwrap();
    let text = apart(&triangles(&cube(4)), gap);
    let options = |epsilon| Options {
        cut_stitch: CutStitchChoices { epsilon: Some(epsilon), ..CutStitchChoices::default() },
        ..Options::default()
    };
    assert_is_the_cube(&text, &options(3.0 * gap), "far enough");
    for epsilon in [0.0, gap / 100.0] {
        let report = answer(text.as_bytes(), &options(epsilon)).report;
        assert_ne!(report.fidelity.map(|fidelity| fidelity.word), Some(Fidelity::Faithful), "{epsilon:e}");
    }
}

/// A cup of so many sides outside and inside without a lip: the outside of radius 10, and the inside so much narrower and higher.
fn cup(sides: [u32; 2], wall: f64) -> Vec<Face> {
    let shell = |sides: u32, radius: f64, floor: f64| -> Vec<Face> {
        let low = ring(sides, radius, floor);
        let mut faces = band(&low, &ring(sides, radius, 20.0));
        faces.push(low.into_iter().rev().collect());
        faces
    };
    let mut inside = shell(sides[1], 10.0 - wall, wall);
    inside.iter_mut().for_each(|face| face.reverse());
    [shell(sides[0], 10.0, 0.0), inside].concat()
}

#[test]
fn the_inside_and_the_outside_of_a_cup_are_not_pulled_together_at_the_lip() {
    for wall in [0.003, 0.03, 0.3] {
        let report = answer(apart(&cup([16; 2], wall), 0.0).as_bytes(), &Options::default()).report;
        assert_eq!(report.outcome, Some(Outcome::Repaired), "{wall}: {:?}", report.refusal);
        assert!(report.actions.iter().all(|action| action.move_max == 0.0), "{wall}");
        let after = report.after.unwrap();
        assert_eq!(after.counts.components, 1, "{wall}");
        // The area of a regular polygon of 16 sides with a radius of 1.
        let area = 8.0 * (std::f64::consts::TAU / 16.0).sin();
        let inside = 10.0 - wall;
        let truth = area * (100.0 * 20.0 - inside * inside * (20.0 - wall));
        let volume = after.measures.volume.unwrap();
        assert!((volume / truth - 1.0).abs() < 0.01, "{wall}: {volume} instead of {truth}");
    }
}

#[test]
fn nor_where_the_inside_has_other_vertices_than_the_outside() {
    // The inside stays within the outside, whose sides are 0.003 nearer to the middle than its corners.
    for wall in [0.01, 0.03] {
        let report = answer(apart(&cup([128, 64], wall), 0.0).as_bytes(), &Options::default()).report;
        assert_eq!(report.outcome, Some(Outcome::Repaired), "{wall}: {:?}", report.refusal);
        let divided = report.actions.iter().flat_map(|a| &a.changes).filter(|c| c.0 == "edges_divided");
        assert_eq!(divided.map(|c| c.1).sum::<u64>(), 0, "{wall}");
        let volume = report.after.unwrap().measures.volume.unwrap();
        let area = |n: f64| n / 2.0 * (std::f64::consts::TAU / n).sin();
        let inside = 10.0 - wall;
        let truth = area(128.0) * 2000.0 - area(64.0) * inside * inside * (20.0 - wall);
        assert!((volume / truth - 1.0).abs() < 0.01, "{wall}: {volume} instead of {truth}");
    }
}

#[test]
fn a_thin_plate_with_a_missing_side_keeps_its_thickness() {
    // 40 by 60 by 0.1, turned, with vertices in the middle of edges, of which two triangles of the sides are missing.
    let text = "v 0 0 0\nv -13.0659552 24.8200741 -53.0400276\nv -5.96858263 61.1170158 -37.803257\n\
                v 7.09737253 36.2969437 15.2367725\nv 0.0959737003 -0.00739007769 -0.0271004811\n\
                v -12.9699821 24.812685 -53.067131\nv -5.87260914 61.1096268 -37.8303566\n\
                v 7.1933465 36.2895546 15.209672\nv -9.32614136 43.9459991 -45.0113258\n\
                v -8.17359161 15.7014666 -33.5966301\nv -8.18622017 49.2775002 -42.7972603\n\
                f 3 9 4\nf 4 2 1\nf 5 10 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 3 4 8\nf 3 8 7\nf 4 1 5\n\
                f 4 5 8\nf 9 2 4\nf 10 6 7\n";
    let answer = answer(text.as_bytes(), &Options::default());
    assert!(answer.report.tried.contains(&"rims-apart"), "{:?}", answer.report.tried);
    assert_ne!(answer.report.fidelity.as_ref().unwrap().word, Fidelity::Changed);
    let volume = answer.report.after.unwrap().measures.volume.unwrap();
    assert!((volume - 240.0).abs() < 0.01, "{volume}");
}
