//! A picture of a dented sphere of 100,000 triangles as a thumbnail, and of a million in the usual size, each with its PNG.

#[path = "support/dented_sphere.rs"]
mod dented_sphere;

use self::dented_sphere::dented_sphere;
use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::render::{
    Camera, DrawnEdges, FramedScene, Projection, Scene, SceneFrame, Shade, Style, View, draw, picture,
};
use std::hint::black_box;

const PALETTE: [[u8; 3]; 1] = [[185, 194, 203]];

fn png(mesh: &(Vec<DVec3>, Vec<[u32; 3]>), width: u32, height: u32) -> Vec<u8> {
    let budget = Budget::unlimited();
    let scene = Scene { positions: &mesh.0, triangles: &mesh.1, palette: &PALETTE, ..Scene::default() };
    let frame = SceneFrame::around([scene.bounds()]);
    let model = FramedScene::of(scene, frame, Shade::Smooth, &budget).expect("no limit");
    let aspect = f64::from(width) / f64::from(height);
    let camera = Camera::at(&[&model], View::Iso.direction(), Projection::Orthographic, aspect, &budget)
        .expect("no limit");
    let style = Style { edges: DrawnEdges::Creases, background: [255; 3], back: Some([207, 63, 54]) };
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
