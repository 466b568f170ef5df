//! The local and the global cut of a sheet of 500,000 triangles, at more and more singular vertices, and of sheets of more
//! and more triangles with a fixed number of them: the first grows with the singular vertices, the second with the edges.

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::mesh::{ChosenEdges, CutMarks, CutMethod, EdgeGroups, cut};
use std::hint::black_box;

/// A grid of `2 n n` triangles over `(n + 1)²` vertices, in which `fins` vertices inside, evenly spread, have one more
/// triangle that shares only them.
fn sheet(n: u32, fins: u32) -> (Vec<[u32; 3]>, usize) {
    let vertex = |row: u32, column: u32| row * (n + 1) + column;
    let quads = (0..n * n).map(|i| (i / n, i % n));
    let mut triangles: Vec<[u32; 3]> = quads
        .flat_map(|(r, c)| {
            let [a, b] = [vertex(r, c), vertex(r, c + 1)];
            let [d, e] = [vertex(r + 1, c), vertex(r + 1, c + 1)];
            [[a, b, e], [a, e, d]]
        })
        .collect();
    let mut count = (n + 1) * (n + 1);
    let inside = (n - 1) * (n - 1);
    for i in 0..fins.min(inside) {
        let place = (u64::from(i) * u64::from(inside) / u64::from(fins)) as u32;
        triangles.push([vertex(1 + place / (n - 1), 1 + place % (n - 1)), count, count + 1]);
        count += 2;
    }
    (triangles, count as usize)
}

fn benches(c: &mut Criterion) {
    let budget = Budget::unlimited();
    let mut measure = |group: &str, label: String, n: u32, fins: u32| {
        let (triangles, count) = sheet(n, fins);
        let groups = EdgeGroups::build(&triangles, count, &budget).expect("no budget to stop it");
        let marks = CutMarks::find(&triangles, count, &groups, &ChosenEdges::default(), &budget)
            .expect("no budget to stop it");
        assert_eq!(marks.vertices().len() as u32, fins);
        let mut group = c.benchmark_group(group);
        group.sample_size(10);
        for method in [CutMethod::Local, CutMethod::Global] {
            group.bench_function(BenchmarkId::new(format!("{method:?}"), &label), |b| {
                let run = |mut mesh: Vec<[u32; 3]>| {
                    let copies = cut(black_box(&mut mesh), count, &marks, method, &budget);
                    (mesh, copies)
                };
                b.iter_batched(|| triangles.clone(), run, BatchSize::LargeInput);
            });
        }
        group.finish();
    };
    for fins in [100, 1_000, 10_000, 50_000, 100_000, 200_000] {
        measure("cut of 500,000 triangles by singular vertices", fins.to_string(), 500, fins);
    }
    for n in [125, 250, 500, 1_000] {
        measure("cut at 1,000 singular vertices by triangles", (2 * n * n).to_string(), n, 1_000);
    }
}

criterion_group!(cutting, benches);
criterion_main!(cutting);
