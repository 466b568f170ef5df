//! The search structures on a dented sphere of about a million triangles, without self-intersections: weld, tree,
//! self-contacts; and self-contacts of a closed fan, whose boxes all meet.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::spatial::{Bvh, Search, coincident_f32, self_contacts};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// A sphere of `2 * columns * (rows - 1)` triangles, moved in and out along its radius, so still embedded.
fn dented_sphere(columns: u32, rows: u32) -> Mesh {
    let at = |column: u32, row: u32| {
        let (a, b) = (TAU * f64::from(column) / f64::from(columns), PI * f64::from(row) / f64::from(rows));
        let radius = 1.0 + 0.05 * (17.0 * a).sin() * (13.0 * b).sin().powi(2);
        let p = DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos()) * radius;
        // As an STL file would hold it.
        DVec3::from_array(p.to_array().map(|x| f64::from(x as f32)))
    };
    let rings = (1..rows).flat_map(|row| (0..columns).map(move |column| at(column, row)));
    let positions: Vec<DVec3> = [at(0, 0), at(0, rows)].into_iter().chain(rings).collect();
    let id = |column: u32, row: u32| match row {
        0 => 0,
        _ if row == rows => 1,
        _ => 2 + (row - 1) * columns + column % columns,
    };
    let triangles = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .flat_map(|(row, column)| {
            let [a, b] = [id(column, row), id(column + 1, row)];
            let [c, d] = [id(column, row + 1), id(column + 1, row + 1)];
            [[a, c, d], [a, d, b]]
        })
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    Mesh { positions, triangles }
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
    let sphere = dented_sphere(1000, 520);
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
