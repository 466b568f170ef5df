//! Describing a mesh of a million triangles: everything but the search for self-intersections, and with it.

use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::analysis::{AnalyzeOptions, analyze};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::spatial::Contacts;
use std::f64::consts::TAU;
use std::hint::black_box;

/// A torus with waves, of `2 n n` triangles, as an indexed file gives it.
fn torus(n: u32) -> Soup {
    let position = |i: u32| {
        let [around, across] = [i / n, i % n].map(|k| TAU * f64::from(k) / f64::from(n));
        let radius = 20.0 + (1.0 + 0.1 * (9.0 * around).cos()) * 8.0 * across.cos();
        DVec3::new(radius * around.cos(), radius * around.sin(), 8.0 * across.sin())
    };
    let vertex = |row: u32, column: u32| (row % n) * n + column % n;
    let quads = (0..n * n).map(|i| (i / n, i % n));
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|(row, column)| {
            let [a, b] = [vertex(row, column), vertex(row + 1, column)];
            let [c, d] = [vertex(row + 1, column + 1), vertex(row, column + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    Soup {
        positions: (0..n * n).map(position).collect(),
        face_count: triangles.len() as u32,
        triangles,
        ..Soup::default()
    }
}

fn benches(c: &mut Criterion) {
    let mesh = torus(724);
    let (options, none) = (AnalyzeOptions::default(), Contacts::default());
    let mut group = c.benchmark_group("analysis of 1.05 M triangles");
    group.sample_size(10);
    group.bench_function("contacts known", |b| {
        b.iter(|| analyze(black_box(&mesh), Some(&none), &options, &Budget::unlimited()));
    });
    group.bench_function("contacts searched", |b| {
        b.iter(|| analyze(black_box(&mesh), None, &options, &Budget::unlimited()));
    });
    group.finish();
}

criterion_group!(analysis, benches);
criterion_main!(analysis);
