//! Rims that lie side by side are joined by a repair that is not told how far apart they are.

use crate::repair::answer;
use meshmend::pipeline::{CutStitchChoices, Fidelity, Options, Outcome};
use std::fmt::Write as _;

type Face = Vec<[f64; 3]>;

/// The squares of a cube of side 10, outward, each of so many by so many.
fn cube(cells: u32) -> Vec<Face> {
    let side = 10.0 / f64::from(cells);
    let mut faces = Vec::new();
    for axis in 0..3 {
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            for is_far in [false, true] {
                let mut face: Face = [(0, 0), (1, 0), (1, 1), (0, 1)]
                    .map(|(a, b)| {
                        let mut p = [0.0; 3];
                        p[axis] = if is_far { 10.0 } else { 0.0 };
                        p[(axis + 1) % 3] = f64::from(i + a) * side;
                        p[(axis + 2) % 3] = f64::from(j + b) * side;
                        p
                    })
                    .to_vec();
                if !is_far {
                    face.reverse();
                }
                faces.push(face);
            }
        }
    }
    faces
}

/// Each square as two triangles.
fn triangles(squares: &[Face]) -> Vec<Face> {
    squares.iter().flat_map(|q| [vec![q[0], q[1], q[2]], vec![q[0], q[2], q[3]]]).collect()
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

/// A cup of `sides` sides without a lip: the outside of radius 10, and the inside so much narrower and higher.
fn cup(sides: u32, wall: f64) -> Vec<Face> {
    let ring = |radius: f64, z: f64| -> Face {
        (0..sides)
            .map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(sides))
            .map(|angle| [radius * angle.cos(), radius * angle.sin(), z])
            .collect()
    };
    let shell = |radius: f64, floor: f64| -> Vec<Face> {
        let (low, high) = (ring(radius, floor), ring(radius, 20.0));
        let next = |i: usize| (i + 1) % sides as usize;
        let mut faces: Vec<Face> =
            (0..sides as usize).map(|i| vec![low[i], low[next(i)], high[next(i)], high[i]]).collect();
        faces.push(low.into_iter().rev().collect());
        faces
    };
    let mut inside = shell(10.0 - wall, wall);
    inside.iter_mut().for_each(|face| face.reverse());
    [shell(10.0, 0.0), inside].concat()
}

#[test]
fn the_inside_and_the_outside_of_a_cup_are_not_pulled_together_at_the_lip() {
    for wall in [0.003, 0.03, 0.3] {
        let report = answer(apart(&cup(16, wall), 0.0).as_bytes(), &Options::default()).report;
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
