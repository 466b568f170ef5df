//! Cylinders whose lids have more sides than the wall, as where each face of a CAD part was divided by itself: the lid covers what is between
//! its arcs and the chords of the wall.

use crate::bridges::{Polygons, obj, repaired, turned};
use std::f64::consts::TAU;

const RADIUS: f64 = 10.0;
const HEIGHT: f64 = 20.0;

fn ring(sides: u32, z: f64) -> Vec<[f64; 3]> {
    let angle = |i: u32| f64::from(i) * TAU / f64::from(sides);
    (0..sides).map(|i| [RADIUS * angle(i).cos(), RADIUS * angle(i).sin(), z]).collect()
}

fn wall(sides: u32) -> Polygons {
    let (a, b) = (ring(sides, 0.0), ring(sides, HEIGHT));
    let next = |i: usize| (i + 1) % a.len();
    (0..a.len()).map(|i| vec![a[i], a[next(i)], b[next(i)], b[i]]).collect()
}

/// A lid as triangles around its middle, or as one polygon.
fn lid(sides: u32, z: f64, is_polygon: bool) -> Polygons {
    let rim = ring(sides, z);
    if is_polygon {
        return vec![rim];
    }
    (0..rim.len()).map(|i| vec![[0.0, 0.0, z], rim[i], rim[(i + 1) % rim.len()]]).collect()
}

fn volume(sides: u32) -> f64 {
    f64::from(sides) / 2.0 * (TAU / f64::from(sides)).sin() * RADIUS * RADIUS * HEIGHT
}

fn assert_trimmed(name: &str, polygons: &Polygons, sides: u32) {
    let report = repaired(&obj(polygons)).report;
    let found = report.after.as_ref().unwrap().measures.volume.unwrap();
    assert!((found - volume(sides)).abs() < 1e-4 * found, "{name}: {found}, not {}", volume(sides));
    assert_eq!(report.certificate.as_ref().unwrap().shells.len(), 1, "{name}");
    let told = report.actions.iter().find(|action| action.step == "close-chordal-gaps");
    let count = |what: &str| told.unwrap().changes.iter().find(|change| change.0 == what).unwrap().1;
    assert_eq!(count("gaps_closed"), 2 * u64::from(sides), "{name}");
    assert!(report.fidelity.unwrap().changes.is_empty(), "{name}: {:?}", report.losses);
}

#[test]
fn a_fine_lid_ends_at_a_coarse_wall() {
    for (sides, fold, is_polygon) in
        [(12, 2, false), (12, 2, true), (16, 2, false), (16, 2, true), (16, 3, false)]
    {
        let lids =
            [turned(&lid(sides * fold, 0.0, is_polygon)), lid(sides * fold, HEIGHT, is_polygon)].concat();
        let part = [wall(sides), lids].concat();
        let name = format!("{sides} sides, {fold} times as many of the lids, polygons {is_polygon}");
        assert_trimmed(&name, &part, sides);
        assert_trimmed(&format!("{name}, inside out"), &turned(&part), sides);
    }
}

#[test]
fn a_coarse_lid_on_a_fine_wall_is_completed_and_all_triangles_stay() {
    let part = [wall(32), turned(&lid(16, 0.0, true)), lid(16, HEIGHT, true)].concat();
    let report = repaired(&obj(&part)).report;
    let found = report.after.unwrap().measures.volume.unwrap();
    assert!((found - volume(32)).abs() < 1e-4 * found, "{found}, not {}", volume(32));
    assert_eq!(report.identical_triangle_share, Some(1.0));
}

#[test]
fn a_coarse_rim_of_a_bore_follows_its_fine_wall() {
    // A block whose faces have a hole of 12 sides and whose bore has 24; the faces lie over what is between.
    let (radius, coarse, fine) = (6.0, 12, 24);
    let at = |i: u32, sides: u32| {
        let angle = (f64::from(i) / f64::from(sides) + 0.125) * TAU;
        [angle.cos(), angle.sin()]
    };
    let corner = |i: u32, z: f64| {
        let [x, y] = at(i, coarse);
        let far = RADIUS / x.abs().max(y.abs());
        [x * far, y * far, z]
    };
    let rim = |i: u32, sides: u32, z: f64| {
        let [x, y] = at(i, sides);
        [x * radius, y * radius, z]
    };
    let face = |z: f64| -> Polygons {
        (0..coarse)
            .map(|i| vec![rim(i, coarse, z), corner(i, z), corner(i + 1, z), rim(i + 1, coarse, z)])
            .collect()
    };
    let outside = (0..coarse)
        .map(|i| vec![corner(i, 0.0), corner(i + 1, 0.0), corner(i + 1, HEIGHT), corner(i, HEIGHT)]);
    let bore = (0..fine).map(|i| {
        vec![rim(i, fine, HEIGHT), rim(i + 1, fine, HEIGHT), rim(i + 1, fine, 0.0), rim(i, fine, 0.0)]
    });
    let block = [face(HEIGHT), turned(&face(0.0)), outside.collect(), bore.collect()].concat();
    let square: f64 = (0..coarse)
        .map(|i| {
            let ([a, b, _], [c, d, _]) = (corner(i, 0.0), corner(i + 1, 0.0));
            (a * d - b * c) / 2.0
        })
        .sum();
    let bored = f64::from(fine) / 2.0 * (TAU / f64::from(fine)).sin() * radius * radius;
    let report = repaired(&obj(&block)).report;
    let found = report.after.unwrap().measures.volume.unwrap();
    let expected = (square - bored) * HEIGHT;
    assert!((found - expected).abs() < 1e-4 * expected, "{found}, not {expected}");
    assert!(report.fidelity.unwrap().changes.is_empty(), "{:?}", report.losses);
    let told = report.actions.iter().find(|action| action.step == "close-chordal-gaps").unwrap();
    assert_eq!(
        told.changes.iter().find(|change| change.0 == "gaps_closed"),
        Some(&("gaps_closed", 2 * u64::from(coarse)))
    );
}
