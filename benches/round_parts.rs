//! Measures for printing, and the distance of a slightly smaller copy, on shapes with ties: each must take time in proportion
//! to its triangles, whatever the shape. On the cones and the cylinder thousands of faces meet at one vertex, which the
//! whole analysis and a simplification meet too.

#[path = "support/shapes.rs"]
mod shapes;

use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::analysis::{AnalyzeOptions, NearSearch, analyze};
use meshmend::budget::Budget;
use meshmend::distance::{DistanceOptions, Surface, surface_distance};
use meshmend::printing::{PrintingPolicy, measure};
use meshmend::simplify::{SimplifyInput, SimplifyOptions, Target, simplify_guarded};
use std::hint::black_box;

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("round parts");
    group.sample_size(10);
    for (name, soup) in shapes::all(100_000) {
        group.bench_function(format!("printing: {name}"), |b| {
            b.iter(|| measure(black_box(&soup), &PrintingPolicy::default(), true, 16, &Budget::unlimited()));
        });
        group.bench_function(format!("analysis: {name}"), |b| {
            let options = AnalyzeOptions { near: NearSearch::ByDiagonal, ..AnalyzeOptions::default() };
            b.iter(|| analyze(black_box(&soup), None, &options, &Budget::unlimited()));
        });
        group.bench_function(format!("simplify: {name}"), |b| {
            let input = SimplifyInput::new(&soup.positions, &soup.triangles);
            let options = SimplifyOptions { targets: vec![Target::Ratio(0.1)], ..SimplifyOptions::default() };
            b.iter(|| simplify_guarded(black_box(&input), &options, &Budget::unlimited()));
        });
        let smaller: Vec<_> = soup.positions.iter().map(|&p| p * 0.999).collect();
        // As many refinements as a simplification allows itself.
        let options = DistanceOptions { refinements_max: (1 << 18) + 25_000, ..DistanceOptions::default() };
        group.bench_function(format!("distance: {name}"), |b| {
            b.iter(|| {
                let from = Surface { positions: &soup.positions, triangles: &soup.triangles };
                let to = Surface { positions: &smaller, triangles: &soup.triangles };
                surface_distance(black_box(from), to, &options, &Budget::unlimited())
            });
        });
    }
    group.finish();
}

criterion_group!(round_parts, benches);
criterion_main!(round_parts);
