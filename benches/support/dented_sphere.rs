//! A large closed surface without a flat place.

use meshmend::geom::DVec3;
use std::f64::consts::{PI, TAU};

/// A sphere of `2 * columns * (rows - 1)` triangles, of radius 1, moved in and out along its radius by a twentieth.
pub(crate) fn dented_sphere(columns: u32, rows: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let at = |column: u32, row: u32| {
        let (a, b) = (TAU * f64::from(column) / f64::from(columns), PI * f64::from(row) / f64::from(rows));
        let radius = 1.0 + 0.05 * (17.0 * a).sin() * (13.0 * b).sin().powi(2);
        DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos()) * radius
    };
    let rings = (1..rows).flat_map(|row| (0..columns).map(move |column| at(column, row)));
    let positions: Vec<DVec3> = [at(0, 0), at(0, rows)].into_iter().chain(rings).collect();
    let id = |column: u32, row: u32| match row {
        0 => 0,
        _ if row == rows => 1,
        _ => 2 + (row - 1) * columns + column % columns,
    };
    let quads = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let triangles = quads
        .flat_map(|(row, column)| {
            let [a, b] = [id(column, row), id(column + 1, row)];
            let [c, d] = [id(column, row + 1), id(column + 1, row + 1)];
            [[a, c, d], [a, d, b]]
        })
        .filter(|[a, b, c]| a != b && b != c && c != a);
    (positions, triangles.collect())
}
