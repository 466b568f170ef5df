//! Rims that face each other get one patch between them where one for each would invent more: bodies without a band of their surface,
//! skins without a lip, plates without sides.

use meshmend::budget::Budget;
use meshmend::pipeline::{Answer, Operation, Options, Outcome, run};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Polygons, each by its corners.
pub(crate) type Polygons = Vec<Vec<[f64; 3]>>;

/// As OBJ, turned about two axes and moved, so that no face is parallel to an axis; each polygon has vertices of its own.
pub(crate) fn obj(polygons: &Polygons) -> String {
    let mut text = String::new();
    for [x, y, z] in polygons.iter().flatten() {
        let ([sin, cos], [sin2, cos2]) = (sin_cos(0.37), sin_cos(0.71));
        let [x, y] = [x * cos - y * sin, x * sin + y * cos];
        let [y, z] = [y * cos2 - z * sin2, y * sin2 + z * cos2];
        writeln!(text, "v {:.6} {:.6} {:.6}", x + 3.1, y - 2.2, z + 5.5).unwrap();
    }
    let mut first = 1;
    for polygon in polygons {
        let corners = (first..first + polygon.len()).map(|v| v.to_string()).collect::<Vec<_>>();
        writeln!(text, "f {}", corners.join(" ")).unwrap();
        first += polygon.len();
    }
    text
}

fn sin_cos(angle: f64) -> [f64; 2] {
    [angle.sin(), angle.cos()]
}

pub(crate) fn turned(polygons: &Polygons) -> Polygons {
    polygons.iter().map(|polygon| polygon.iter().rev().copied().collect()).collect()
}

fn square([low, high]: [f64; 2], z: f64) -> Vec<[f64; 3]> {
    vec![[low, low, z], [high, low, z], [high, high, z], [low, high, z]]
}

/// The four sides of a box between two heights.
fn sides(side: f64, [low, high]: [f64; 2]) -> Polygons {
    let corners = square([0.0, side], 0.0);
    let at = |i: usize, z: f64| [corners[i % 4][0], corners[i % 4][1], z];
    (0..4).map(|i| vec![at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)]).collect()
}

const SIDES: u32 = 32;

fn ring(radius: f64, z: f64) -> Vec<[f64; 3]> {
    let angle = |i: u32| f64::from(i) * TAU / f64::from(SIDES);
    (0..SIDES).map(|i| [radius * angle(i).cos(), radius * angle(i).sin(), z]).collect()
}

/// The wall of a cylinder.
fn wall(radius: f64, [low, high]: [f64; 2]) -> Polygons {
    let (a, b) = (ring(radius, low), ring(radius, high));
    let next = |i: usize| (i + 1) % a.len();
    (0..a.len()).map(|i| vec![a[i], a[next(i)], b[next(i)], b[i]]).collect()
}

/// A disc of triangles around its middle, which looks up.
fn disc(radius: f64, z: f64) -> Polygons {
    let rim = ring(radius, z);
    (0..rim.len()).map(|i| vec![[0.0, 0.0, z], rim[i], rim[(i + 1) % rim.len()]]).collect()
}

/// Area of a polygon of [`SIDES`] sides.
fn area(radius: f64) -> f64 {
    f64::from(SIDES) / 2.0 * (TAU / f64::from(SIDES)).sin() * radius * radius
}

/// Volume between two similar faces of these areas.
fn frustum(a: f64, b: f64, height: f64) -> f64 {
    height / 3.0 * (a + b + (a * b).sqrt())
}

pub(crate) fn repaired(text: &str) -> Answer {
    let answer = run(Operation::Repair, text.as_bytes(), &Options::default(), &Budget::unlimited()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
    answer
}

/// One body of this volume that keeps all triangles; what was invented is told.
fn assert_bridged(name: &str, text: &str, bodies: usize, volume: f64) {
    let Answer { report, .. } = repaired(text);
    let found = report.after.as_ref().unwrap().measures.volume.unwrap();
    assert!((found - volume).abs() < 1e-4 * volume, "{name}: {found}, not {volume}");
    assert_eq!(report.certificate.as_ref().unwrap().shells.len(), bodies, "{name}");
    let losses = report.losses.unwrap();
    assert!(losses.visible_loss == 0.0 && losses.invented > 0.01, "{name}: {losses:?}");
    assert!(!report.fidelity.unwrap().changes.is_empty(), "{name}");
}

/// Every third face the other way around.
fn partly_turned(polygons: &Polygons) -> Polygons {
    let turns = |i: usize, polygon: &Vec<[f64; 3]>| match i % 3 {
        0 => polygon.iter().rev().copied().collect(),
        _ => polygon.clone(),
    };
    polygons.iter().enumerate().map(|(i, polygon)| turns(i, polygon)).collect()
}

/// As it is, with all or some faces the other way around, and with a body far away.
fn assert_bridged_however_drawn(name: &str, polygons: &Polygons, volume: f64) {
    assert_bridged(name, &obj(polygons), 1, volume);
    assert_bridged(name, &obj(&turned(polygons)), 1, volume);
    assert_bridged(name, &obj(&partly_turned(polygons)), 1, volume);
    let mut away = polygons.clone();
    let [a, b, c, d] = [[99.0; 3], [100.0, 99.0, 99.0], [99.0, 100.0, 99.0], [99.0, 99.0, 100.0]];
    away.extend([vec![a, c, b], vec![a, b, d], vec![a, d, c], vec![b, c, d]]);
    assert_bridged(name, &obj(&away), 2, volume + 1.0 / 6.0);
}

#[test]
fn a_box_or_turned_part_without_chamfers_gets_them() {
    let mut block = sides(20.0, [0.0, 8.0]);
    block.extend([square([2.0, 18.0], 10.0), square([0.0, 20.0], 0.0).into_iter().rev().collect()]);
    assert_bridged_however_drawn("box", &block, 3200.0 + frustum(400.0, 256.0, 2.0));
    for width in [0.5, 1.0, 3.0] {
        let round =
            [turned(&disc(10.0 - width, 0.0)), wall(10.0, [width, 12.0 - width]), disc(10.0 - width, 12.0)];
        let volume = area(10.0) * (12.0 - 2.0 * width) + 2.0 * frustum(area(10.0), area(10.0 - width), width);
        assert_bridged_however_drawn("round", &round.concat(), volume);
    }
}

#[test]
fn a_tube_without_a_band_is_one_body_and_parts_far_from_each_other_are_two() {
    let tube = |gap: f64| {
        let (low, high) = (wall(10.0, [0.0, 15.0]), wall(10.0, [15.0 + gap, 30.0]));
        [turned(&disc(10.0, 0.0)), low, high, disc(10.0, 30.0)].concat()
    };
    assert_bridged_however_drawn("tube", &tube(3.0), area(10.0) * 30.0);
    // A band as long as this has more surface than the two ends.
    let Answer { report, .. } = repaired(&obj(&tube(11.0)));
    assert_eq!(report.certificate.unwrap().shells.len(), 2);
}

#[test]
fn a_pipe_without_a_band_of_its_outside_is_not_closed_to_its_inside() {
    let ends = |z: f64| -> Polygons {
        let (outer, inner) = (ring(10.0, z), ring(7.0, z));
        let next = |i: usize| (i + 1) % outer.len();
        (0..outer.len()).map(|i| vec![outer[i], outer[next(i)], inner[next(i)], inner[i]]).collect()
    };
    let outside = [wall(10.0, [0.0, 15.0]), wall(10.0, [18.0, 30.0])].concat();
    let pipe = [outside, turned(&wall(7.0, [0.0, 30.0])), turned(&ends(0.0)), ends(30.0)].concat();
    assert_bridged_however_drawn("pipe", &pipe, (area(10.0) - area(7.0)) * 30.0);
}

#[test]
fn a_plate_or_disc_without_sides_gets_them_and_keeps_its_holes() {
    let plate = [square([0.0, 30.0], 2.0), square([0.0, 30.0], 0.0).into_iter().rev().collect()];
    assert_bridged_however_drawn("plate", &plate.to_vec(), 1800.0);
    let flat = [disc(10.0, 4.0), turned(&disc(10.0, 0.0))].concat();
    assert_bridged_however_drawn("disc", &flat, area(10.0) * 4.0);
    let washer = |z: f64| -> Polygons {
        let (outer, inner) = (ring(10.0, z), ring(5.0, z));
        let next = |i: usize| (i + 1) % outer.len();
        (0..outer.len()).map(|i| vec![outer[i], outer[next(i)], inner[next(i)], inner[i]]).collect()
    };
    let washers = [washer(2.0), turned(&washer(0.0))].concat();
    assert_bridged_however_drawn("washer", &washers, (area(10.0) - area(5.0)) * 2.0);
}

#[test]
fn the_skins_of_a_cup_are_joined_at_its_lip() {
    let outside = [turned(&disc(10.0, 0.0)), wall(10.0, [0.0, 20.0])].concat();
    let inside = [disc(8.0, 2.0), turned(&wall(8.0, [2.0, 19.5]))].concat();
    // What the lip cuts off: a body between the planes of both rims.
    let hollow = area(8.0) * 17.5 + frustum(area(8.0), area(10.0), 0.5);
    assert_bridged_however_drawn("cup", &[outside, inside].concat(), area(10.0) * 20.0 - hollow);
}

#[test]
fn a_flat_sheet_is_not_closed_by_a_patch_on_it() {
    // Corners that are rounded lie in no plane, so that two triangles would enclose something.
    let Answer { report, .. } = repaired(&obj(&vec![square([0.0, 30.0], 0.0)]));
    let volume = report.after.unwrap().measures.volume.unwrap();
    assert!(volume > 1.0, "{volume}");
    let filled = run(
        Operation::FillHoles,
        obj(&vec![square([0.0, 30.0], 0.0)]).as_bytes(),
        &Options::default(),
        &Budget::unlimited(),
    )
    .unwrap();
    let holes = filled.report.filling.unwrap().holes;
    assert_eq!(holes.len(), 1);
    let reasons: Vec<_> = holes[0].rejected.iter().map(|rejected| rejected.reason).collect();
    assert_eq!(reasons, [meshmend::repair::fill::Rejection::FlatSheet]);
}

/// The upper and the lower side of a plate of 30 by 30 by 2.
fn plate(bottom: f64) -> Polygons {
    vec![square([0.0, 30.0], bottom + 2.0), square([0.0, 30.0], bottom).into_iter().rev().collect()]
}

#[test]
fn plates_are_plates_whatever_the_order_of_their_sides() {
    let sides = [plate(0.0), plate(4.0)].concat();
    for order in [[0, 1, 2, 3], [0, 2, 1, 3], [3, 1, 0, 2], [2, 0, 3, 1]] {
        let polygons = order.map(|i| sides[i].clone()).to_vec();
        assert_bridged(&format!("{order:?}"), &obj(&polygons), 2, 3600.0);
    }
}

#[test]
fn sheets_far_apart_for_their_size_are_walls() {
    let signs = vec![square([0.0, 30.0], 20.0), square([0.0, 30.0], 0.0).into_iter().rev().collect()];
    let Answer { report, .. } = repaired(&obj(&signs));
    assert_eq!(report.certificate.unwrap().shells.len(), 2);
    assert_eq!(report.identical_triangle_share, Some(1.0));
}

#[test]
fn a_sheet_beside_a_body_gets_a_wall_and_the_body_its_patch() {
    let open: Polygons =
        [sides(20.0, [0.0, 10.0]), vec![square([0.0, 20.0], 0.0).into_iter().rev().collect()]].concat();
    for (name, body, volume) in [("box", open, 4000.0), ("plate", plate(0.0), 1800.0)] {
        let sheet: Vec<[f64; 3]> =
            square([0.0, 10.0], 0.0).iter().map(|[x, y, z]| [x + 50.0, *y, *z]).collect();
        let Answer { report, .. } = repaired(&obj(&[body, vec![sheet]].concat()));
        let found = report.after.unwrap().measures.volume.unwrap();
        assert!((volume + 1.0..volume + 40.0).contains(&found), "{name}: {found}");
        assert_eq!(report.certificate.unwrap().shells.len(), 2, "{name}");
        assert_eq!(report.identical_triangle_share, Some(1.0), "{name}");
    }
}
