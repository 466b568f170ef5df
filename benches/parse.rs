//! Time to read and to write a torus of a million triangles in each encoding: `cargo bench --bench parse`. Where
//! `node tests/meshopt_files/make.mjs target/meshopt torus` has written one, also to read it with meshopt compression.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, ReadOptions, read, write};
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use std::f64::consts::TAU;
use std::hint::black_box;

const ENCODINGS: [Encoding; 10] = [
    Encoding::StlBinary,
    Encoding::StlAscii,
    Encoding::Obj,
    Encoding::Off,
    Encoding::OffBinary,
    Encoding::PlyAscii,
    Encoding::PlyBinaryLittleEndian,
    Encoding::PlyBinaryBigEndian,
    Encoding::Glb,
    Encoding::Gltf,
];

/// A torus of `2 * rings * segments` triangles with float32 coordinates.
fn torus(rings: u32, segments: u32) -> Soup {
    let at = |ring: u32, segment: u32| {
        let (u, v) =
            (TAU * f64::from(ring) / f64::from(rings), TAU * f64::from(segment) / f64::from(segments));
        let distance = 50.0 + 20.0 * v.cos();
        DVec3::new(distance * u.cos(), distance * u.sin(), 20.0 * v.sin())
    };
    let to_f32 = |p: DVec3| DVec3::from(p.to_array().map(|c| f64::from(c as f32)));
    let id = |ring: u32, segment: u32| ring % rings * segments + segment % segments;
    let cells = || (0..rings).flat_map(|r| (0..segments).map(move |s| (r, s)));
    let split = |(r, s)| {
        let [a, b, c, d] = [id(r, s), id(r + 1, s), id(r + 1, s + 1), id(r, s + 1)];
        [[a, b, c], [a, c, d]]
    };
    Soup {
        positions: cells().map(|(r, s)| to_f32(at(r, s))).collect(),
        triangles: cells().flat_map(split).collect(),
        face_count: 2 * rings * segments,
        is_f32_exact: true,
        ..Soup::default()
    }
}

fn parse(criterion: &mut Criterion) {
    let soup = torus(1000, 500);
    let budget = Budget::unlimited();
    for encoding in ENCODINGS {
        let bytes = write(&soup, encoding, &budget).expect("written");
        let mut group = criterion.benchmark_group(encoding.name());
        group.sample_size(10).throughput(Throughput::Elements(soup.triangles.len() as u64));
        group.bench_function(BenchmarkId::from_parameter("read"), |bench| {
            bench.iter(|| read(black_box(&bytes), encoding, &ReadOptions::default(), &budget).expect("read"));
        });
        group.bench_function(BenchmarkId::from_parameter("write"), |bench| {
            bench.iter(|| write(black_box(&soup), encoding, &budget).expect("written"));
        });
        group.finish();
    }
}

fn meshopt(criterion: &mut Criterion) {
    let budget = Budget::unlimited();
    let mut group = criterion.benchmark_group("meshopt");
    group.sample_size(10).throughput(Throughput::Elements(1_000_000));
    for name in ["torus", "torus-ext", "torus-khr", "quantized", "quantized-ext", "quantized-khr"] {
        let Ok(bytes) = std::fs::read(format!("target/meshopt/{name}.glb")) else { continue };
        group.bench_function(BenchmarkId::from_parameter(name), |bench| {
            bench.iter(|| {
                read(black_box(&bytes), Encoding::Glb, &ReadOptions::default(), &budget).expect("read")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, parse, meshopt);
criterion_main!(benches);
