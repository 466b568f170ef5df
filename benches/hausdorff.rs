//! The enclosed distance between a dented sphere of about a million triangles and one of a tenth of them.

use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::distance::{DistanceOptions, Surface, SurfaceDistance, surface_distance};
use meshmend::geom::DVec3;
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// A sphere of `2 * columns * (rows - 1)` triangles, moved in and out along its radius.
fn dented_sphere(columns: u32, rows: u32) -> Mesh {
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
    Mesh { positions, triangles: triangles.collect() }
}

fn distance(fine: &Mesh, coarse: &Mesh) -> SurfaceDistance {
    let [a, b] = [fine, coarse].map(|m| Surface { positions: &m.positions, triangles: &m.triangles });
    let found = surface_distance(a, b, &DistanceOptions::default(), &Budget::unlimited());
    found.expect("no limit").expect("both have triangles")
}

fn benches(criterion: &mut Criterion) {
    let (fine, coarse) = (dented_sphere(1000, 520), dented_sphere(320, 160));
    let mut group = criterion.benchmark_group("distance");
    group.sample_size(10);
    group.bench_function("1.04 M and 0.1 M triangles", |b| b.iter(|| distance(black_box(&fine), &coarse)));
    group.finish();
}

criterion_group!(hausdorff, benches);
criterion_main!(hausdorff);
