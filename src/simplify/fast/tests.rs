//! Parts and rounds on small meshes, cut much finer than outside of tests.

use super::{Settings, by_criterion};
use crate::budget::{Budget, StopFlag};
use crate::geom::{Aabb, DVec3};
use crate::mesh::corner_table::CornerTable;
use crate::mesh::{EdgeGroups, UnionFind};
use crate::par::with_threads;
use crate::simplify::{CriterionKind, Simplified, SimplifyError, SimplifyInput, SimplifyOptions, Target};
use crate::spatial::{Bvh, Search, self_contacts};

type Triangles = Vec<[u32; 3]>;

struct Numbers(u64);

impl Numbers {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / f64::from(1 << 24)
    }
}

/// A torus of `2 n n` triangles with bumps, float32 exact; moved by `by`.
fn torus(n: u32, tube: f64, bump: f64, by: DVec3) -> (Vec<DVec3>, Triangles) {
    let mut numbers = Numbers(u64::from(n));
    // Rational points of the circle.
    let circle = |k: u32| {
        let quarter = 4.0 * f64::from(k % n) / f64::from(n);
        let t = quarter.fract();
        let (c, s) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        [(c, s), (-s, c), (-c, -s), (s, -c)][quarter as usize]
    };
    let position = |i: u32| {
        let ((c, s), (across, up)) = (circle(i / n), circle(i % n));
        let r = tube * (1.0 + bump * (numbers.unit() - 0.5));
        let p = DVec3::new(c * (3.0 + r * across), s * (3.0 + r * across), r * up) + by;
        p.as_vec3().as_dvec3()
    };
    let vertex = |row: u32, column: u32| (row % n) * n + column % n;
    let square = |i: u32| {
        let (row, column) = (i / n, i % n);
        let [a, b] = [vertex(row, column), vertex(row + 1, column)];
        let [c, d] = [vertex(row + 1, column + 1), vertex(row, column + 1)];
        [[a, b, c], [a, c, d]]
    };
    ((0..n * n).map(position).collect(), (0..n * n).flat_map(square).collect())
}

fn joined(parts: &[(Vec<DVec3>, Triangles)]) -> (Vec<DVec3>, Triangles) {
    let mut all = (Vec::new(), Vec::new());
    for (positions, triangles) in parts {
        let first = all.0.len() as u32;
        all.0.extend(positions);
        all.1.extend(triangles.iter().map(|t| t.map(|v| v + first)));
    }
    all
}

/// Euler characteristic, edges with one triangle, components; fails unless it is a manifold.
fn topology(mesh: &Simplified) -> (i64, usize, u32) {
    let budget = Budget::unlimited();
    CornerTable::build(&mesh.triangles, mesh.positions.len(), &budget).unwrap();
    let edges = EdgeGroups::build(&mesh.triangles, mesh.positions.len(), &budget).unwrap();
    let mut parts = UnionFind::new(mesh.positions.len());
    for &[a, b, c] in &mesh.triangles {
        parts.unite(a, b);
        parts.unite(b, c);
    }
    let euler = mesh.positions.len() as i64 - edges.len() as i64 + mesh.triangles.len() as i64;
    (euler, edges.iter().filter(|edge| edge.len() == 1).count(), parts.into_components().count)
}

fn contacts(mesh: &Simplified) -> u64 {
    let budget = Budget::unlimited();
    let bvh = Bvh::build(&mesh.positions, &mesh.triangles, None, &budget).unwrap();
    let all = Search::All { keep: 0 };
    self_contacts(&mesh.positions, &mesh.triangles, &bvh, None, all, &budget).unwrap().count
}

fn run(
    (positions, triangles): &(Vec<DVec3>, Triangles),
    targets: &[Target],
    settings: Settings,
) -> Vec<Simplified> {
    let input = SimplifyInput::new(positions, triangles);
    let options = SimplifyOptions { targets: targets.to_vec(), ..SimplifyOptions::default() };
    by_criterion(&input, &options, settings, &Budget::unlimited()).unwrap()
}

const FAST: Settings = Settings { is_guarded: false, part_len: 48 };
const GUARDED: Settings = Settings { is_guarded: true, part_len: 48 };

#[test]
fn many_parts_keep_the_topology_and_reach_every_target_exactly() {
    let two = joined(&[torus(40, 1.0, 0.1, DVec3::ZERO), torus(24, 1.0, 0.0, DVec3::X * 10.0)]);
    let mut open = torus(40, 1.0, 0.1, DVec3::ZERO);
    open.1.drain(320..400);
    for mesh in [two, open] {
        let start = run(&mesh, &[Target::Ratio(1.0)], FAST).remove(0);
        assert_eq!((start.triangles.len(), start.report.collapses), (mesh.1.len(), 0));
        let (euler, border, components) = topology(&start);
        for settings in [FAST, GUARDED, Settings { part_len: 9, ..FAST }, Settings { part_len: 700, ..FAST }]
        {
            let targets = [0.6, 0.3, 0.1].map(Target::Ratio);
            for (level, share) in run(&mesh, &targets, settings).iter().zip([0.6, 0.3, 0.1]) {
                let wanted = (mesh.1.len() as f64 * share) as usize;
                let is = topology(level);
                assert_eq!((is.0, is.2, is.1 > 0), (euler, components, border > 0), "{settings:?}");
                assert!(level.report.is_reached, "{settings:?}: {:?}", level.report);
                assert!((wanted - 1..=wanted).contains(&level.triangles.len()), "{settings:?} {share}");
                assert!(level.triangle_origin.is_sorted());
                assert_eq!(level.report.faces_after, level.triangles.len());
                if border == 0 {
                    let gone = mesh.1.len() - level.triangles.len();
                    assert_eq!(level.report.collapses, gone as u64 / 2, "{settings:?}");
                }
            }
        }
    }
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let mesh = joined(&[torus(50, 1.0, 0.3, DVec3::ZERO), torus(40, 0.9, 0.2, DVec3::ZERO)]);
    for settings in [FAST, GUARDED] {
        let [one, two, eight] = [1, 2, 8].map(|threads| {
            with_threads(threads, || run(&mesh, &[Target::Ratio(0.3), Target::Ratio(0.07)], settings))
        });
        assert!(one == two && one == eight, "{settings:?}");
    }
}

#[test]
fn a_tube_close_inside_another_meets_it_in_the_fast_mode_and_not_in_the_guarded_one() {
    let mut inner = torus(36, 0.9, 0.0, DVec3::ZERO);
    inner.1.iter_mut().for_each(|t| t.swap(1, 2));
    let mesh = joined(&[torus(50, 1.0, 0.01, DVec3::ZERO), inner]);
    let target = [Target::Ratio(0.05)];
    assert_eq!(contacts(&run(&mesh, &[Target::Ratio(1.0)], FAST)[0]), 0);
    assert!(contacts(&run(&mesh, &target, FAST)[0]) > 10);
    for part_len in [48, 100, 300, 10_000] {
        let level = run(&mesh, &target, Settings { part_len, ..GUARDED }).remove(0);
        assert_eq!(contacts(&level), 0, "{part_len}: {:?}", level.report);
        assert!(level.triangles.len() < mesh.1.len() / 5, "{part_len}: {:?}", level.report);
    }
}

#[test]
fn where_the_input_meets_itself_the_guarded_mode_leaves_it_and_simplifies_the_rest() {
    let mesh = joined(&[torus(50, 1.0, 0.0, DVec3::ZERO), torus(40, 1.0, 0.0, DVec3::X * 4.9)]);
    let start = run(&mesh, &[Target::Ratio(1.0)], FAST).remove(0);
    let before = contacts(&start);
    assert!(before > 10);
    let level = run(&mesh, &[Target::Ratio(0.3)], GUARDED).remove(0);
    assert_eq!(contacts(&level), before);
    assert!(level.triangles.len() < mesh.1.len() / 2, "{:?}", level.report);
}

#[test]
fn vertices_in_held_boxes_stay_and_others_go() {
    let torus = torus(40, 1.0, 0.1, DVec3::ZERO);
    let held = [Aabb { min: DVec3::splat(-9.0), max: DVec3::new(-1.0, 9.0, 9.0) }];
    let input = SimplifyInput::new(&torus.0, &torus.1);
    let targets = vec![Target::Ratio(0.05)];
    let options = SimplifyOptions { targets, held: &held, ..SimplifyOptions::default() };
    let in_box = |positions: &[DVec3]| -> Vec<[u64; 3]> {
        let inside = positions.iter().filter(|p| p.x <= -1.0);
        let mut bits: Vec<_> = inside.map(|p| p.to_array().map(f64::to_bits)).collect();
        bits.sort_unstable();
        bits
    };
    for settings in [FAST, GUARDED] {
        let results = by_criterion(&input, &options, settings, &Budget::unlimited()).unwrap();
        let left = &results[0].positions;
        let (before, after) = (in_box(&torus.0), in_box(left));
        assert!(before.iter().all(|p| after.binary_search(p).is_ok()), "{settings:?}");
        assert!(left.len() < torus.0.len() * 3 / 4, "{settings:?}: {} of {}", left.len(), torus.0.len());
    }
}

#[test]
fn an_error_target_holds_in_parts_and_goes_on_with_a_larger_one() {
    let mesh = torus(60, 1.0, 0.0, DVec3::ZERO);
    for criterion in [CriterionKind::Quadric, CriterionKind::Memoryless, CriterionKind::Length] {
        let limits = [0.003, 0.03, 0.3];
        let options = SimplifyOptions {
            targets: limits.map(Target::Error).to_vec(),
            criterion,
            ..SimplifyOptions::default()
        };
        let input = SimplifyInput::new(&mesh.0, &mesh.1);
        let levels = by_criterion(&input, &options, FAST, &Budget::unlimited()).unwrap();
        for (level, limit) in levels.iter().zip(limits) {
            assert!(level.report.is_reached && level.report.error_max <= limit, "{:?}", level.report);
        }
        let counts: Vec<usize> = levels.iter().map(|level| level.triangles.len()).collect();
        assert!(counts.is_sorted_by(|a, b| a >= b) && counts[2] < counts[0], "{criterion:?}: {counts:?}");
    }
}

#[test]
fn what_is_no_manifold_is_refused_wherever_it_is_cut() {
    let good = torus(24, 1.0, 0.0, DVec3::ZERO);
    for t in (0..good.1.len()).step_by(97) {
        let mut bad = good.clone();
        let again = bad.1[t];
        bad.1.push(again);
        let input = SimplifyInput::new(&bad.0, &bad.1);
        let options = SimplifyOptions::default();
        let refused = by_criterion(&input, &options, FAST, &Budget::unlimited());
        assert!(matches!(refused, Err(SimplifyError::NotManifold(_))), "{t}");
    }
}

#[test]
fn two_fans_at_a_vertex_are_refused_wherever_it_is_cut() {
    let good = torus(24, 1.0, 0.0, DVec3::ZERO);
    for v in (0..good.0.len() as u32).step_by(17) {
        let mut bad = joined(&[good.clone(), torus(12, 0.5, 0.0, DVec3::X * 9.0)]);
        let other = good.0.len() as u32 + v % 100;
        bad.1.as_flattened_mut().iter_mut().filter(|u| **u == other).for_each(|u| *u = v);
        let input = SimplifyInput::new(&bad.0, &bad.1);
        for settings in [FAST, GUARDED, Settings { part_len: 6144, ..FAST }] {
            let options = SimplifyOptions::default();
            let refused = by_criterion(&input, &options, settings, &Budget::unlimited());
            assert!(matches!(refused, Err(SimplifyError::NotManifold(_))), "{v}");
        }
    }
}

#[test]
fn a_raised_stop_flag_and_a_small_memory_limit_end_the_run() {
    let mesh = torus(24, 1.0, 0.0, DVec3::ZERO);
    let input = SimplifyInput::new(&mesh.0, &mesh.1);
    let options = SimplifyOptions::default();
    let stop = StopFlag::default();
    stop.cancel();
    for budget in [Budget::new(stop, u64::MAX, u64::MAX), Budget::new(StopFlag::default(), u64::MAX, 1000)] {
        let stopped = by_criterion(&input, &options, GUARDED, &budget);
        assert!(matches!(stopped, Err(SimplifyError::Stopped(_))));
    }
}
