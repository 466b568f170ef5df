//! All measures for printing of a dented sphere of about a million triangles; most of the time is that of walls and gaps.

use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::printing::{Policy, Printing, measure};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

/// A sphere of `2 * columns * (rows - 1)` triangles, moved in and out along its radius.
fn dented_sphere(columns: u32, rows: u32) -> Soup {
    let at = |column: u32, row: u32| {
        let (a, b) = (TAU * f64::from(column) / f64::from(columns), PI * f64::from(row) / f64::from(rows));
        let radius = 50.0 * (1.0 + 0.05 * (17.0 * a).sin() * (13.0 * b).sin().powi(2));
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
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|(row, column)| {
            let [a, b] = [id(column, row), id(column + 1, row)];
            let [c, d] = [id(column, row + 1), id(column + 1, row + 1)];
            [[a, c, d], [a, d, b]]
        })
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

fn measured(soup: &Soup) -> Printing {
    let found = measure(soup, &Policy::default(), true, 16, &Budget::unlimited());
    found.expect("no limit").expect("there are triangles")
}

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("printing");
    group.sample_size(10);
    for (name, columns, rows) in [("0.1 M triangles", 320, 160), ("1.04 M triangles", 1000, 520)] {
        let soup = dented_sphere(columns, rows);
        group.bench_function(name, |b| b.iter(|| measured(black_box(&soup))));
    }
    group.finish();
}

criterion_group!(printing, benches);
criterion_main!(printing);
