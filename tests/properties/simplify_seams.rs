//! Seams of textures under simplification: charts stay apart, none is lost, and corners keep their points.

use crate::random::Random;
use crate::support::{cases, on_all_cores};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::UnionFind;
use meshmend::mesh::half_edge::HalfEdgeMesh;
use meshmend::simplify::{
    CriterionKind, Mode, NO_TEXTURE, Placement, SimplifyInput, SimplifyOptions, Target, simplify,
};
use std::collections::BTreeMap;

type Corners = [[f64; 2]; 3];
/// A triangle and the bits of its points at the two ends of one of its sides.
type Side = (u32, [[u64; 2]; 2]);

/// A bumpy torus of `2 n n` triangles around the z axis.
fn torus(random: &mut Random, n: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let turn = |k: u32| std::f64::consts::TAU * f64::from(k % n) / f64::from(n);
    let positions = (0..n * n).map(|i| {
        let (s, t, r) = (turn(i / n), turn(i % n), 0.8 + 0.4 * random.unit());
        let out = 3.0 + r * t.cos();
        DVec3::new(out * s.cos(), out * s.sin(), r * t.sin()).as_vec3().as_dvec3()
    });
    let at = |i: u32, j: u32| i % n * n + j % n;
    let square = |i: u32| {
        let (i, j) = (i / n, i % n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (positions.collect(), (0..n * n).flat_map(square).collect())
}

/// Number of parts that hang together by edges at whose ends both triangles have the same points.
fn charts(triangles: &[[u32; 3]], texture: &[Corners]) -> u32 {
    let mut sides: BTreeMap<[u32; 2], Vec<Side>> = BTreeMap::new();
    for (t, (corners, points)) in triangles.iter().zip(texture).enumerate() {
        for k in 0..3 {
            let ends = [(corners[k], points[k]), (corners[(k + 1) % 3], points[(k + 1) % 3])];
            let mut ends = ends.map(|(v, p)| (v, p.map(f64::to_bits)));
            ends.sort_unstable();
            sides.entry(ends.map(|end| end.0)).or_default().push((t as u32, ends.map(|end| end.1)));
        }
    }
    let mut parts = UnionFind::new(triangles.len());
    for side in sides.values() {
        if let [a, b] = side[..]
            && a.1 == b.1
        {
            parts.unite(a.0, b.0);
        }
    }
    parts.into_components().count
}

/// Number of parts of each group that hang together by edges.
fn regions(triangles: &[[u32; 3]], groups: &[u32]) -> BTreeMap<u32, u32> {
    let mut sides: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for (t, corners) in (0..).zip(triangles) {
        for k in 0..3 {
            let mut ends = [corners[k], corners[(k + 1) % 3]];
            ends.sort_unstable();
            sides.entry(ends).or_default().push(t);
        }
    }
    let mut parts = UnionFind::new(triangles.len());
    for side in sides.values() {
        if let [a, b] = side[..]
            && groups[a as usize] == groups[b as usize]
        {
            parts.unite(a, b);
        }
    }
    let mut counts = BTreeMap::new();
    for (t, &group) in (0..).zip(groups) {
        *counts.entry(group).or_default() += u32::from(parts.find(t) == t);
    }
    counts
}

#[test]
fn regions_stay_apart_and_none_is_lost_in_any_mode() {
    on_all_cores(cases(100, 2_000), |case| {
        let random = &mut Random::new(5_000 + case as u64);
        let n = 6 + random.below(12) as u32;
        let (positions, mut triangles) = torus(random, n);
        if random.one_in(2) {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        // Halves and quarters of the torus, and single triangles that are regions of their own.
        let mut group_of = |corners: &[u32; 3]| {
            let middle: DVec3 = corners.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / 3.0;
            match random.one_in(40) {
                true => 10 + random.below(3) as u32,
                false => u32::from(middle.x > 0.0) + 2 * u32::from(middle.z > 0.0),
            }
        };
        let groups: Vec<u32> = triangles.iter().map(&mut group_of).collect();
        let input = SimplifyInput { face_groups: &groups, ..SimplifyInput::new(&positions, &triangles) };
        let options = SimplifyOptions {
            targets: [0.5, 0.2, 0.0].map(Target::Ratio).to_vec(),
            criterion: random.pick(&[
                CriterionKind::Quadric,
                CriterionKind::Length,
                CriterionKind::Memoryless,
            ]),
            placement: random.pick(&[Placement::Optimal, Placement::OntoEnd]),
            ..SimplifyOptions::default()
        };
        let budget = Budget::unlimited();
        let want = regions(&triangles, &groups);
        for mode in [Mode::Strict, Mode::Fast, Mode::Guarded] {
            for level in simplify(&input, mode, &options, &budget).unwrap() {
                let of_level: Vec<u32> = level.triangle_origin.iter().map(|&t| groups[t as usize]).collect();
                assert_eq!(regions(&level.triangles, &of_level), want, "{case} {mode:?} {:?}", level.report);
            }
        }
    });
}

#[test]
fn charts_stay_apart_and_none_is_lost_in_any_mode() {
    on_all_cores(cases(200, 5_000), |case| {
        let random = &mut Random::new(case as u64);
        let n = 6 + random.below(14) as u32;
        let (positions, mut triangles) = torus(random, n);
        if random.one_in(3) {
            // Whole rows, so that it stays a manifold.
            triangles.truncate((2 * n * (n - 2)) as usize);
        }
        // Charts of any form: nearest of some centres, and sometimes single triangles of their own.
        let centres: Vec<DVec3> = (0..1 + random.below(9))
            .map(|_| {
                DVec3::new(8.0 * random.unit() - 4.0, 8.0 * random.unit() - 4.0, 2.0 * random.unit() - 1.0)
            })
            .collect();
        let mut chart_of = |corners: &[u32; 3]| {
            if random.one_in(100) {
                return 20 + random.below(5);
            }
            let middle: DVec3 = corners.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / 3.0;
            let distance = |i: &usize| middle.distance_squared(centres[*i]);
            (0..centres.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
        };
        let chart: Vec<usize> = triangles.iter().map(&mut chart_of).collect();
        // The last of the usual charts has no points.
        let points = |(corners, &chart): (&[u32; 3], &usize)| match chart {
            8 => [NO_TEXTURE; 3],
            _ => corners.map(|v| {
                let p = positions[v as usize];
                [p.x + 0.25 * p.z + 100.0 * chart as f64, p.y - 0.125 * p.z]
            }),
        };
        let texture: Vec<Corners> = triangles.iter().zip(&chart).map(points).collect();
        let input = SimplifyInput {
            positions: &positions,
            triangles: &triangles,
            face_groups: &[],
            vertex_colors: &[],
            texture: &texture,
        };
        let placement = random.pick(&[Placement::Optimal, Placement::OntoEnd]);
        let options = SimplifyOptions {
            targets: [0.5, 0.2, 0.0].map(Target::Ratio).to_vec(),
            criterion: random.pick(&[
                CriterionKind::Quadric,
                CriterionKind::Length,
                CriterionKind::Memoryless,
            ]),
            placement,
            ..SimplifyOptions::default()
        };
        let budget = Budget::unlimited();
        let want = charts(&triangles, &texture);
        for mode in [Mode::Strict, Mode::Fast, Mode::Guarded] {
            for level in simplify(&input, mode, &options, &budget).unwrap() {
                HalfEdgeMesh::from_triangles(&level.triangles, level.positions.len(), &budget).unwrap();
                assert_eq!(level.texture.len(), level.triangles.len());
                assert_eq!(
                    charts(&level.triangles, &level.texture),
                    want,
                    "{case} {mode:?} {:?}",
                    level.report
                );
                for ((corners, points), &origin) in
                    level.triangles.iter().zip(&level.texture).zip(&level.triangle_origin)
                {
                    let chart = chart[origin as usize];
                    for (&v, point) in corners.iter().zip(points) {
                        let p = level.positions[v as usize];
                        if chart == 8 {
                            assert_eq!(*point, NO_TEXTURE);
                        } else if placement == Placement::OntoEnd {
                            let want = [p.x + 0.25 * p.z + 100.0 * chart as f64, p.y - 0.125 * p.z];
                            assert_eq!(*point, want, "{case} {mode:?}");
                        } else {
                            assert!((point[0] - 100.0 * chart as f64).abs() < 10.0, "{case} {mode:?}");
                        }
                    }
                }
            }
        }
    });
}
