//! A picture of a dented sphere of 100,000 triangles as a thumbnail, and of a million in the usual size, each with its PNG.

use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::render::{Camera, Edges, Frame, Model, Projection, Scene, Shade, Style, View, draw, picture};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

const PALETTE: [[u8; 3]; 1] = [[185, 194, 203]];

/// A sphere of `2 * columns * (rows - 1)` triangles, moved in and out along its radius.
fn dented_sphere(columns: u32, rows: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
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
    (positions, triangles.collect())
}

fn png(mesh: &(Vec<DVec3>, Vec<[u32; 3]>), width: u32, height: u32) -> Vec<u8> {
    let budget = Budget::unlimited();
    let scene = Scene { positions: &mesh.0, triangles: &mesh.1, palette: &PALETTE, ..Scene::default() };
    let frame = Frame::around([scene.bounds()]);
    let model = Model::of(scene, frame, Shade::Smooth, &budget).expect("no limit");
    let aspect = f64::from(width) / f64::from(height);
    let camera = Camera::at(&[&model], View::Iso.direction(), Projection::Orthographic, aspect, &budget)
        .expect("no limit");
    let style = Style { edges: Edges::Creases, background: [255; 3], back: Some([207, 63, 54]) };
    picture(&draw(&model, &camera, width, height, &style, &budget).expect("no limit"))
}

fn benches(criterion: &mut Criterion) {
    let (small, large) = (dented_sphere(320, 158), dented_sphere(1000, 501));
    let mut group = criterion.benchmark_group("render");
    group.sample_size(20);
    group.bench_function("thumbnail of 0.1 M triangles", |b| b.iter(|| png(black_box(&small), 480, 360)));
    group.bench_function("picture of 1 M triangles", |b| b.iter(|| png(black_box(&large), 640, 480)));
    group.finish();
}

criterion_group!(render, benches);
criterion_main!(render);
