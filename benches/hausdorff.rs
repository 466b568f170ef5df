//! The enclosed distance between a dented sphere of about a million triangles and one of a tenth of them.

#[path = "support/dented_sphere.rs"]
mod dented_sphere;

use self::dented_sphere::dented_sphere;
use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::distance::{DistanceOptions, Surface, SurfaceDistance, surface_distance};
use meshmend::geom::DVec3;
use std::hint::black_box;

struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

fn mesh((positions, triangles): (Vec<DVec3>, Vec<[u32; 3]>)) -> Mesh {
    Mesh { positions, triangles }
}

fn distance(fine: &Mesh, coarse: &Mesh) -> SurfaceDistance {
    let [a, b] = [fine, coarse].map(|m| Surface { positions: &m.positions, triangles: &m.triangles });
    let found = surface_distance(a, b, &DistanceOptions::default(), &Budget::unlimited());
    found.expect("no limit").expect("both have triangles")
}

fn benches(criterion: &mut Criterion) {
    let (fine, coarse) = (mesh(dented_sphere(1000, 520)), mesh(dented_sphere(320, 160)));
    let mut group = criterion.benchmark_group("distance");
    group.sample_size(10);
    group.bench_function("1.04 M and 0.1 M triangles", |b| b.iter(|| distance(black_box(&fine), &coarse)));
    group.finish();
}

criterion_group!(hausdorff, benches);
criterion_main!(hausdorff);
