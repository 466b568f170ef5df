//! Polyhedra of 10,000 faces: the allowed range of one face, and one shift with its check and its way back.

use criterion::{Criterion, criterion_group, criterion_main};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::polyhedron::FaceId;
use meshmend::modeller::{
    EventPolicy, IntervalSide, Operator, Solid, apply, check, face_by_normal, from_polygons, import,
    offset_growth, range, rational,
};
use std::f64::consts::PI;
use std::hint::black_box;

/// A plate with 40 by 50 blocks on it: 10,006 faces, one of which has 2,000 interior loops.
fn plate_of_blocks() -> Solid {
    let (columns, rows) = (40u32, 50u32);
    let mut points = Vec::new();
    let mut boxed = |low: [f64; 3], high: [f64; 3]| {
        let first = points.len() as u32;
        points.extend((0..8).map(|i| {
            DVec3::from_array(std::array::from_fn(|k| if i >> k & 1 == 1 { high[k] } else { low[k] }))
        }));
        first
    };
    let sides = [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
    let of = |first: u32, corners: [u32; 4]| corners.map(|c| c + first).to_vec();
    let plate = boxed([0.0; 3], [f64::from(columns) * 8.0, f64::from(rows) * 8.0, 4.0]);
    let mut faces: Vec<Vec<Vec<u32>>> = vec![vec![of(plate, [0, 2, 3, 1])]];
    faces.extend(sides.map(|side| vec![of(plate, side)]));
    let mut top = vec![of(plate, [4, 5, 7, 6])];
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let (x, y) = (f64::from(i) * 8.0 + 2.0, f64::from(j) * 8.0 + 2.0);
        let block = boxed([x, y, 4.0], [x + 4.0, y + 4.0, 10.0 + f64::from((i * 7 + j * 3) % 11)]);
        faces.extend(sides.map(|side| vec![of(block, side)]));
        faces.push(vec![of(block, [4, 5, 7, 6])]);
        top.push(of(block, [0, 2, 3, 1]));
    }
    faces.push(top);
    from_polygons(&points, &faces).expect("a polyhedron")
}

/// A ball of 10,000 triangles: nearly every vertex has six faces, and splits when one of them moves.
fn ball() -> Solid {
    let (rings, columns) = (50u32, 102u32);
    let mut points = vec![DVec3::Z * 50.0, DVec3::Z * -50.0];
    for (ring, column) in (1..rings).flat_map(|r| (0..columns).map(move |c| (r, c))) {
        let (polar, turn) =
            (PI * f64::from(ring) / f64::from(rings), 2.0 * PI * f64::from(column) / f64::from(columns));
        let across = libm::sin(polar);
        let p = DVec3::new(across * libm::cos(turn), across * libm::sin(turn), libm::cos(polar)) * 50.0;
        points.push(p.as_vec3().as_dvec3());
    }
    let at = |ring: u32, column: u32| 2 + (ring - 1) * columns + column % columns;
    let mut triangles = Vec::new();
    for c in 0..columns {
        triangles.extend([[0, at(1, c), at(1, c + 1)], [1, at(rings - 1, c + 1), at(rings - 1, c)]]);
        for r in 1..rings - 1 {
            let [a, b, d, e] = [at(r, c), at(r, c + 1), at(r + 1, c), at(r + 1, c + 1)];
            triangles.extend([[a, d, e], [a, e, b]]);
        }
    }
    import(&points, &triangles, Some(0.0), &Budget::unlimited())
        .expect("nothing stops it")
        .expect("a ball")
        .solid
}

/// A frustum of 880 sides between two faces that have as many corners.
fn frustum() -> Solid {
    let sides = 880u32;
    let ring = |radius: f64, z: f64| {
        (0..sides).map(move |i| {
            let turn = 2.0 * PI * f64::from(i) / f64::from(sides);
            let p = DVec3::new(libm::cos(turn) * radius, libm::sin(turn) * radius, z);
            p.as_vec3().as_dvec3()
        })
    };
    let points: Vec<DVec3> = ring(50.0, 0.0).chain(ring(30.0, 40.0)).collect();
    let mut triangles = Vec::new();
    for i in 0..sides {
        let j = (i + 1) % sides;
        triangles.extend([[i, j, sides + j], [i, sides + j, sides + i]]);
    }
    for i in 1..sides - 1 {
        triangles.extend([[0, i + 1, i], [sides, sides + i, sides + i + 1]]);
    }
    import(&points, &triangles, None, &Budget::unlimited())
        .expect("nothing stops it")
        .expect("a frustum")
        .solid
}

/// Half of the way to the nearer limit.
fn half_way(solid: &Solid, face: FaceId) -> Operator {
    let sides = range(solid, &[(face, rational(1.0))], &Budget::unlimited()).expect("nothing stops it");
    let limits = sides.iter().filter_map(|side| match side {
        IntervalSide::Limit { limits, .. } => Some(limits[0].1.clone()),
        _ => None,
    });
    let nearest = limits.min_by_key(|t| if *t < rational(0.0) { -t } else { t.clone() });
    let by = nearest.map_or_else(|| offset_growth(solid, face, 0.5), |t| t * rational(0.5));
    Operator::Shift { faces: vec![(face, by)], events: EventPolicy::Refuse }
}

fn benches(c: &mut Criterion) {
    let budget = Budget::unlimited();
    let (blocks, ball, frustum) = (plate_of_blocks(), ball(), frustum());
    let face = |solid: &Solid, normal: DVec3, at: DVec3| face_by_normal(solid, normal, at).expect("a face");
    let cases = [
        ("side of a block", &blocks, face(&blocks, DVec3::X, DVec3::new(166.0, 204.0, 8.0))),
        ("top of a block", &blocks, face(&blocks, DVec3::Z, DVec3::new(164.0, 204.0, 12.0))),
        ("facet of a ball", &ball, face(&ball, DVec3::new(3.0, 2.0, 1.0), DVec3::new(40.0, 27.0, 13.0))),
        ("face of 880 sides", &frustum, face(&frustum, DVec3::Z, DVec3::new(0.0, 0.0, 40.0))),
    ];
    let mut group = c.benchmark_group("modeller, 10,000 faces");
    group.sample_size(20);
    for (name, solid, face) in cases {
        group.bench_function(format!("range, {name}"), |b| {
            b.iter(|| black_box(range(solid, &[(face, rational(1.0))], &budget)));
        });
        let mut edited = solid.clone();
        let shift = half_way(solid, face);
        group.bench_function(format!("shift, checked and taken back, {name}"), |b| {
            b.iter(|| {
                let applied =
                    apply(&mut edited, &shift, &budget).expect("nothing stops it").expect("a shift");
                applied.undo(&mut edited);
            });
        });
    }
    group.sample_size(10);
    for (name, solid) in [("plate of blocks", &blocks), ("ball", &ball)] {
        group.bench_function(format!("check of the whole, {name}"), |b| {
            b.iter(|| black_box(check(solid, &budget)));
        });
    }
    group.finish();
}

criterion_group!(modeller, benches);
criterion_main!(modeller);
