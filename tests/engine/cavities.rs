//! Cavities that reach the surface of their body from within, lids that lie loose, and faces that are there twice: what people draw
//! where a hole in the surface would be right.

use crate::oracle::{RawSoup, weld};
use crate::raw_files::encode;
use crate::repair::repaired;
use crate::solids::cuboid;
use meshmend::budget::Budget;
use meshmend::formats::Encoding;
use meshmend::pipeline::{Answer, Operation, Options, Outcome, Require, run};

/// A closed cylinder around the z axis with `n` sides; the discs at its ends have a vertex in their middle.
fn cylinder(n: u32, radius: f64, [low, high]: [f64; 2]) -> RawSoup {
    let angle = |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(n);
    let ring = |z: f64| (0..n).map(move |i| [radius * angle(i).cos(), radius * angle(i).sin(), z]);
    let positions = ring(low).chain(ring(high)).chain([[0.0, 0.0, low], [0.0, 0.0, high]]).collect();
    let sides = (0..n).flat_map(|i| {
        let j = (i + 1) % n;
        [[i, j, n + j], [i, n + j, n + i], [j, i, 2 * n], [n + i, n + j, 2 * n + 1]]
    });
    RawSoup { positions, triangles: sides.collect() }
}

/// Volume of such a cylinder.
fn volume(n: u32, radius: f64, height: f64) -> f64 {
    let n = f64::from(n);
    n / 2.0 * (std::f64::consts::TAU / n).sin() * radius * radius * height
}

/// Shells and volume of the result.
fn figures(answer: &Answer) -> (usize, f64) {
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
    let shells = answer.report.certificate.as_ref().unwrap().shells.len();
    (shells, answer.report.after.as_ref().unwrap().measures.volume.unwrap())
}

fn assert_faithful(answer: &Answer) {
    let fidelity = answer.report.fidelity.as_ref().unwrap();
    assert!(fidelity.changes.is_empty(), "{:?}", fidelity.changes);
}

/// The surface that is gone is told, and why.
fn assert_open_cavity(answer: &Answer, lost_area: f64) {
    let losses = answer.report.losses.as_ref().unwrap();
    let area = answer.report.before.as_ref().unwrap().measures.area;
    assert!((losses.visible_loss * area - lost_area).abs() < 0.1 * lost_area, "{losses:?}");
    let fidelity = answer.report.fidelity.as_ref().unwrap();
    assert!(!fidelity.changes.is_empty());
    let reasons: Vec<&str> = answer.report.actions.iter().map(|action| action.reason.as_str()).collect();
    assert!(reasons.iter().any(|why| why.contains("stays open there")), "{reasons:?}");
}

#[test]
fn a_tube_of_two_cylinders_whose_ends_are_flush_is_open_at_both() {
    let (outer, inner) = (cylinder(32, 10.0, [0.0, 20.0]), cylinder(32, 6.0, [0.0, 20.0]).inside_out());
    let answer = repaired(&outer.with(&inner));
    let (shells, found) = figures(&answer);
    let expected = volume(32, 10.0, 20.0) - volume(32, 6.0, 20.0);
    assert!(
        shells == 1 && (found - expected).abs() < 1e-3 * expected,
        "{shells} shells of {found}, not {expected}"
    );
    // The discs of both, at both ends.
    assert_open_cavity(&answer, 4.0 * volume(32, 6.0, 1.0));
}

#[test]
fn a_low_ring_is_open_and_filled_where_a_faithful_result_is_demanded() {
    let ring = cylinder(32, 10.0, [0.0, 4.0]).with(&cylinder(32, 6.0, [0.0, 4.0]).inside_out());
    let answer = repaired(&ring);
    let (_, found) = figures(&answer);
    let expected = volume(32, 10.0, 4.0) - volume(32, 6.0, 4.0);
    assert!((found - expected).abs() < 1e-3 * expected, "{found}, not {expected}");
    let options = Options { require: Some(Require::Faithful), ..Options::default() };
    let bytes = encode(&ring, Encoding::StlBinary);
    let (_, found) = figures(&run(Operation::Repair, bytes, &options, &Budget::unlimited()).unwrap());
    assert!((found - volume(32, 10.0, 4.0)).abs() < 1e-3 * expected, "{found}");
}

#[test]
fn a_cup_of_two_cylinders_whose_tops_are_flush_is_open_there() {
    let (outer, inner) = (cylinder(32, 10.0, [0.0, 20.0]), cylinder(24, 8.0, [2.0, 20.0]).inside_out());
    let answer = repaired(&outer.with(&inner));
    let (shells, found) = figures(&answer);
    let expected = volume(32, 10.0, 20.0) - volume(24, 8.0, 18.0);
    assert!(
        shells == 1 && (found - expected).abs() < 1e-3 * expected,
        "{shells} shells of {found}, not {expected}"
    );
    assert_open_cavity(&answer, 2.0 * volume(24, 8.0, 1.0));
}

#[test]
fn a_lid_that_lies_loose_above_its_opening_does_not_make_the_part_hollow() {
    let n = 32;
    let mut part = cylinder(n, 8.0, [0.0, 20.0]);
    // The disc at the top has vertices of its own, a little higher.
    let base = part.positions.len() as u32;
    let lid: Vec<[u32; 3]> = part.triangles.iter().copied().filter(|t| t.contains(&(2 * n + 1))).collect();
    part.triangles.retain(|t| !t.contains(&(2 * n + 1)));
    let raised: Vec<[f64; 3]> = part.positions.iter().map(|&[x, y, z]| [x, y, z + 0.3]).collect();
    part.positions.extend(raised);
    part.triangles.extend(lid.iter().map(|t| t.map(|v| v + base)));
    let (_, found) = figures(&repaired(&part));
    let expected = volume(n, 8.0, 20.0);
    assert!(found > 0.99 * expected && found < 1.05 * expected, "{found}, not about {expected}");
}

#[test]
fn faces_around_a_corner_that_are_there_in_both_directions_stay_once() {
    let solid = weld(&cuboid([10.0; 3]).with(&cuboid([10.0; 3]).moved([20.0, 0.0, 0.0])));
    let corner: Vec<[u32; 3]> = solid
        .triangles
        .iter()
        .copied()
        .filter(|t| t.iter().any(|&v| solid.positions[v as usize] == [10.0, 10.0, 10.0]))
        .map(|[a, b, c]| [a, c, b])
        .collect();
    assert!(corner.len() >= 3);
    let doubled = RawSoup { triangles: [solid.triangles.clone(), corner].concat(), ..solid };
    let answer = repaired(&doubled);
    let (shells, found) = figures(&answer);
    assert!(shells == 2 && (found - 2000.0).abs() < 1e-3, "{shells} shells of {found}");
    assert_faithful(&answer);
    assert!(answer.report.identical_triangle_share.is_some_and(|share| share > 0.6));
}

#[test]
fn a_block_at_the_end_of_an_open_tube_is_not_turned() {
    // Two cuboids at the ends of four walls that share their edges.
    let (low, high) = (cuboid([10.0; 3]), cuboid([10.0; 3]).moved([0.0, 0.0, 30.0]));
    let walls = cuboid([10.0, 10.0, 20.0]).moved([0.0, 0.0, 10.0]);
    let is_wall = |t: &[u32; 3]| {
        let z = t.map(|v| walls.positions[v as usize][2]);
        z.contains(&10.0) && z.contains(&30.0)
    };
    let walls =
        RawSoup { triangles: walls.triangles.iter().copied().filter(is_wall).collect(), ..walls.clone() };
    assert_eq!(walls.triangles.len(), 8);
    let answer = repaired(&weld(&low.with(&high).with(&walls)));
    let (shells, found) = figures(&answer);
    assert!(shells == 1 && (found - 4000.0).abs() < 1.0, "{shells} shells of {found}");
}

#[test]
fn a_sheet_with_two_sides_beside_a_body_and_a_body_drawn_twice_inside_out_are_not_lost() {
    // The two sides of the sheet have different triangles.
    let sheet = RawSoup {
        positions: vec![
            [20.0, 0.0, 5.0],
            [60.0, 0.0, 5.0],
            [60.0, 40.0, 5.0],
            [20.0, 40.0, 5.0],
            [20.0, 0.0, 5.0],
            [60.0, 0.0, 5.0],
            [60.0, 40.0, 5.0],
            [20.0, 40.0, 5.0],
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 7, 5], [5, 7, 6]],
    };
    let answer = repaired(&cuboid([10.0; 3]).with(&sheet));
    assert_eq!(answer.report.losses.as_ref().unwrap().bodies_lost, 0);
    assert!(answer.report.losses.as_ref().unwrap().visible_loss < 0.01, "{:?}", answer.report.losses);

    let body = cuboid([10.0; 3]).moved([20.0, 0.0, 0.0]);
    let turned = body.clone().inside_out();
    let answer = repaired(&cuboid([10.0; 3]).with(&body).with(&turned));
    let (_, found) = figures(&answer);
    assert!((found - 2000.0).abs() < 10.0, "{found}");
}

#[test]
fn two_cavities_with_a_wall_without_thickness_between_them_stay() {
    let room = |x: f64, size: [f64; 3]| cuboid(size).moved([x, 1.0, 1.0]).inside_out();
    let outer = || cuboid([10.0; 3]);
    // The wall is of the same triangles twice, or of a smaller face on a larger one.
    let same = outer().with(&room(1.0, [4.0, 8.0, 8.0])).with(&room(5.0, [4.0, 8.0, 8.0]));
    let smaller = outer().with(&room(1.0, [4.0, 8.0, 8.0])).with(&room(5.0, [4.0, 4.0, 8.0]));
    for (file, expected) in [(same, 1000.0 - 512.0), (smaller, 1000.0 - 384.0)] {
        let (shells, found) = figures(&repaired(&file));
        assert!(shells == 2 && (found - expected).abs() < 1e-6, "{shells} {found}");
    }
}

/// Boxes of quads as OFF: each its lowest corner, its size, and whether it points inward.
fn boxes(of: &[([i32; 3], [i32; 3], bool)]) -> Vec<u8> {
    const QUADS: [[usize; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut points, mut faces) = (String::new(), String::new());
    for (number, &(low, size, is_inverted)) in of.iter().enumerate() {
        for i in 0..8 {
            let [x, y, z] = [0, 1, 2].map(|k| low[k] + size[k] * (i >> k & 1));
            points += &format!("{x} {y} {z}\n");
        }
        for quad in QUADS {
            let [a, b, c, d] = quad.map(|v| v + 8 * number);
            let quad = if is_inverted { [d, c, b, a] } else { [a, b, c, d] };
            faces += &format!("4 {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
        }
    }
    format!("OFF\n{} {} 0\n{points}{faces}", 8 * of.len(), 6 * of.len()).into_bytes()
}

#[test]
fn stepped_holes_and_drills_that_cross_stay_open_whichever_way_the_file_is_drawn() {
    let body = ([0, 0, 0], [10, 10, 8]);
    for (first, second, expected) in [
        // A pocket under a cup; two drills that cross, the one from above and the other from the side; two cups side by side.
        (([2, 2, 5], [6, 6, 3]), ([4, 4, 2], [2, 2, 3]), 800.0 - 108.0 - 12.0),
        (([4, 4, 2], [2, 2, 6]), ([0, 4, 3], [7, 2, 2]), 800.0 - 24.0 - 28.0 + 8.0),
        (([1, 3, 4], [4, 4, 4]), ([5, 3, 4], [4, 4, 4]), 800.0 - 128.0),
    ] {
        for is_inverted in [false, true] {
            let solid = |(low, size)| (low, size, is_inverted);
            let hollow = |(low, size)| (low, size, !is_inverted);
            let file = boxes(&[solid(body), hollow(first), hollow(second)]);
            let answer = run(Operation::Repair, file, &Options::default(), &Budget::unlimited()).unwrap();
            let (shells, found) = figures(&answer);
            assert!(shells == 1 && (found - expected).abs() < 1e-6, "{shells} {found}, not {expected}");
        }
    }
}

#[test]
fn a_counterbore_of_two_cylinders_stays_open() {
    let block = cuboid([30.0, 30.0, 20.0]).moved([-15.0, -15.0, 0.0]);
    let wide = cylinder(24, 8.0, [12.0, 20.0]);
    let narrow = cylinder(16, 3.0, [0.0, 12.0]);
    let expected = 18_000.0 - volume(24, 8.0, 8.0) - volume(16, 3.0, 12.0);
    let drawn = block.with(&wide.inside_out()).with(&narrow.inside_out());
    for file in [drawn.clone(), drawn.inside_out()] {
        let (shells, found) = figures(&repaired(&file));
        assert!(
            shells == 1 && (found - expected).abs() < 1e-3 * expected,
            "{shells} {found}, not {expected}"
        );
    }
}

#[test]
fn what_is_drawn_inside_out_in_a_cavity_keeps_its_own_cavities() {
    let centred = |half: i32, is_inverted: bool| ([-half; 3], [2 * half; 3], is_inverted);
    // The first two are a body with a cavity; in that there are bodies, of which some are inside out.
    for (inner, expected) in [
        (vec![centred(5, true)], 4904.0),
        (vec![centred(5, true), centred(3, false)], 4688.0),
        (vec![centred(5, true), centred(3, false), centred(1, true)], 4696.0),
        (vec![centred(5, true), centred(3, false), centred(1, false)], 4696.0),
        (vec![([-7; 3], [4; 3], true), ([-6; 3], [2; 3], false), ([2; 3], [4; 3], false)], 4024.0),
    ] {
        for all_turned in [false, true] {
            let drawn = [centred(10, false), centred(8, true)].into_iter().chain(inner.clone());
            let drawn: Vec<_> =
                drawn.map(|(low, size, is_inverted)| (low, size, is_inverted != all_turned)).collect();
            let answer = run(Operation::Repair, boxes(&drawn), &Options::default(), &Budget::unlimited());
            let answer = answer.unwrap();
            assert_eq!(figures(&answer), (drawn.len(), expected));
            assert_faithful(&answer);
        }
    }
    let round = |radius: f64| cylinder(24, radius, [-radius, radius]);
    let drawn = round(10.0).with(&round(8.0).inside_out()).with(&round(5.0).inside_out()).with(&round(3.0));
    for file in [drawn.clone(), drawn.inside_out()] {
        let answer = repaired(&file);
        let (shells, found) = figures(&answer);
        let expected = [(10.0, 1.0), (8.0, -1.0), (5.0, 1.0), (3.0, -1.0)]
            .map(|(radius, sign)| sign * volume(24, radius, 2.0 * radius));
        let expected = expected.iter().sum::<f64>();
        assert!(
            shells == 4 && (found - expected).abs() < 1e-3 * expected,
            "{shells} {found}, not {expected}"
        );
        assert_faithful(&answer);
    }
}
