//! Ten large holes in a torus of 102,400 triangles by each method, and ten thousand small ones in a finer torus.

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::repair::Draft;
use meshmend::repair::fill::{FillOptions, Method, fill};
use std::hint::black_box;

/// A torus of `2 around across` triangles without those that `is_out`.
fn torus(around: u32, across: u32, is_out: impl Fn(u32, DVec3) -> bool) -> Soup {
    let vertex = |i: u32, k: u32| (i % around) * across + k % across;
    let turn = |i: u32, n: u32| f64::from(i) * std::f64::consts::TAU / f64::from(n);
    let cells = (0..around * across).map(|i| (i / across, i % across));
    let place = |(i, k): (u32, u32)| {
        let (a, b) = (turn(i, around), turn(k, across));
        let r = 1.0 + 0.4 * b.cos();
        DVec3::new(r * a.cos(), r * a.sin(), 0.4 * b.sin()).as_vec3().as_dvec3()
    };
    let positions: Vec<DVec3> = cells.clone().map(place).collect();
    let quads = cells.map(|(i, k)| [vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), vertex(i, k + 1)]);
    let mut triangles: Vec<[u32; 3]> = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    triangles.retain(|t| !t.iter().any(|&v| is_out(v, positions[v as usize])));
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

fn benches(c: &mut Criterion) {
    let budget = Budget::unlimited();
    let is_in_a_ball = |p: DVec3| {
        (0..10).any(|k| {
            let turn = f64::from(k) * std::f64::consts::TAU / 10.0;
            p.distance(DVec3::new(turn.cos(), turn.sin(), 0.0) * 1.4) < 0.25
        })
    };
    let large = torus(320, 160, |_, p| is_in_a_ball(p));
    // Every 16th vertex of every 4th ring.
    let small = torus(1_600, 400, |v, _| (v / 400) % 4 == 0 && v % 16 == 0);
    let mut measure = |name: &str, soup: &Soup, methods: &[Method]| {
        let mut group = c.benchmark_group(name);
        group.sample_size(10);
        for &method in methods {
            let options = FillOptions { method, ..FillOptions::default() };
            group.bench_function(BenchmarkId::from_parameter(format!("{method:?}")), |b| {
                let run = |mut draft: Draft| fill(&mut draft, black_box(soup), &options, &budget);
                b.iter_batched(|| Draft::from_soup(soup).0, run, BatchSize::LargeInput);
            });
        }
        group.finish();
    };
    let all = [Method::Flat, Method::Minimal, Method::Smooth, Method::Rbf, Method::Auto];
    measure("ten large holes of 102,400 triangles", &large, &all);
    measure("10,000 small holes", &small, &[Method::Flat, Method::Minimal, Method::Smooth]);
}

criterion_group!(filling, benches);
criterion_main!(filling);
