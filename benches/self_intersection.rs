//! The search structures on a dented sphere of about a million triangles, without self-intersections: weld, tree,
//! self-contacts; and self-contacts of a closed fan, whose boxes all meet.

#[path = "support/dented_sphere.rs"]
mod dented_sphere;

use self::dented_sphere::dented_sphere;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::spatial::{Bvh, Search, coincident_f32, self_contacts};
use std::f64::consts::TAU;
use std::hint::black_box;

struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// The dented sphere as an STL file would hold it.
fn sphere(columns: u32, rows: u32) -> Mesh {
    let (positions, triangles) = dented_sphere(columns, rows);
    Mesh { positions: positions.into_iter().map(|p| p.as_vec3().as_dvec3()).collect(), triangles }
}

fn double_cone(count: u32) -> Mesh {
    let rim = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(count);
        DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let positions = (0..count).map(rim).chain([DVec3::Z, DVec3::ZERO]).collect();
    let next = |i: u32| (i + 1) % count;
    let triangles = (0..count).flat_map(|i| [[i, next(i), count], [next(i), i, count + 1]]).collect();
    Mesh { positions, triangles }
}

fn tree(mesh: &Mesh) -> Bvh {
    Bvh::build(&mesh.positions, &mesh.triangles, None, &Budget::unlimited()).expect("no limit")
}

fn contacts(mesh: &Mesh, bvh: &Bvh) -> u64 {
    let all = Search::All { keep: 100 };
    let found = self_contacts(&mesh.positions, &mesh.triangles, bvh, None, all, &Budget::unlimited());
    found.expect("no limit").count
}

fn benches(criterion: &mut Criterion) {
    let sphere = sphere(1000, 520);
    let corners: Vec<[f32; 3]> = sphere
        .triangles
        .iter()
        .flatten()
        .map(|&v| sphere.positions[v as usize].to_array().map(|x| x as f32))
        .collect();
    let bvh = tree(&sphere);
    assert_eq!(contacts(&sphere, &bvh), 0, "the sphere is embedded");
    let mut group = criterion.benchmark_group("sphere");
    group.sample_size(10).throughput(Throughput::Elements(sphere.triangles.len() as u64));
    group.bench_function("weld", |b| {
        b.iter(|| {
            let mut group = vec![0; corners.len()];
            coincident_f32(|i| corners[i], &mut group, &Budget::unlimited()).expect("no limit").len()
        });
    });
    group.bench_function("tree", |b| b.iter_with_large_drop(|| tree(&sphere)));
    group.bench_function("contacts", |b| b.iter(|| contacts(black_box(&sphere), &bvh)));
    group.finish();

    let cones = double_cone(1 << 16);
    let bvh = tree(&cones);
    let mut group = criterion.benchmark_group("closed fan");
    group.sample_size(10).throughput(Throughput::Elements(cones.triangles.len() as u64));
    group.bench_function("contacts", |b| b.iter(|| contacts(black_box(&cones), &bvh)));
    group.finish();
}

criterion_group!(all, benches);
criterion_main!(all);
