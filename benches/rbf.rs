//! Fields of 100 to 20,000 constraints around a round hole in a sphere: the fit, and values with gradients.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::{Aabb, DVec3};
use meshmend::implicit::{Band, BandSurroundings, RbfOptions, fit, march, mesh_surface};
use std::f64::consts::TAU;
use std::hint::black_box;

/// A rim of `count` points and two rings around it, half a radian from the pole of the unit sphere.
fn band(count: usize) -> Band {
    let mut points = Vec::new();
    for ring in 0..3 {
        let arc = 0.5 + TAU * 0.5 / count as f64 * f64::from(ring);
        for i in 0..count {
            let turn = TAU * (i as f64 + 0.5 * f64::from(ring % 2)) / count as f64;
            let across = libm::sin(arc);
            points.push(DVec3::new(across * libm::cos(turn), across * libm::sin(turn), libm::cos(arc)));
        }
    }
    Band { normals: points.clone(), points }
}

fn benches(c: &mut Criterion) {
    let (budget, options) = (Budget::unlimited(), RbfOptions::default());
    let around = BandSurroundings { surface: None, mesh_box: Aabb::EMPTY };
    for constraints in [100, 1_000, 3_000, 20_000] {
        let band = band(constraints / 9);
        let fitted = || fit(&band, &around, &options, &budget).expect("nothing stops it").expect("a field");
        let mut group = c.benchmark_group("rbf");
        group.sample_size(10);
        group.bench_function(BenchmarkId::new("fit", constraints), |b| b.iter(|| black_box(fitted())));
        let field = fitted();
        group.bench_function(BenchmarkId::new("value and gradient", constraints), |b| {
            b.iter(|| black_box(field.value_and_gradient(black_box(DVec3::new(0.1, 0.2, 0.95)))));
        });
        if constraints == 1_000 {
            let rim = [band.points[..constraints / 9].to_vec()];
            let edge = rim[0][0].distance(rim[0][1]);
            group.bench_function("march", |b| b.iter(|| black_box(march(&field, &rim, edge, &budget))));
            group.bench_function("mesh", |b| b.iter(|| black_box(mesh_surface(&field, &rim, edge, &budget))));
        }
        group.finish();
    }
}

criterion_group!(rbf, benches);
criterion_main!(rbf);
