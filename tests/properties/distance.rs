//! The enclosed distance against dense sampling with every triangle looked at.

use crate::random::Random;
use meshmend::budget::Budget;
use meshmend::distance::{DistanceOptions, Surface, surface_distance};
use meshmend::geom::{DVec3, closest_point_on_triangle};
use meshmend::par::with_threads;

struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    fn surface(&self) -> Surface<'_> {
        Surface { positions: &self.positions, triangles: &self.triangles }
    }

    fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|v| self.positions[v as usize]))
    }

    fn distance(&self, p: DVec3) -> f64 {
        self.corners().map(|t| closest_point_on_triangle(p, t).distance(p)).fold(f64::INFINITY, f64::min)
    }

    /// The largest distance of a grid of points on each triangle, `n` to an edge, and its mean over the area.
    fn sampled(&self, to: &Self, n: u32) -> (f64, f64) {
        let (mut largest, mut sum, mut area) = (0f64, 0.0, 0.0);
        for [a, b, c] in self.corners() {
            let weight = (b - a).cross(c - a).length();
            let places = (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j)));
            let mut count = 0;
            let mut total = 0.0;
            for (i, j) in places {
                let share = |k: u32| f64::from(k) / f64::from(n - 1);
                let distance = to.distance(a + (b - a) * share(i) + (c - a) * share(j));
                largest = largest.max(distance);
                total += distance;
                count += 1;
            }
            sum += weight * total / f64::from(count);
            area += weight;
        }
        (largest, sum / area)
    }
}

/// A few triangles anywhere, some degenerate.
fn loose(random: &mut Random) -> Mesh {
    let count = 1 + random.below(6);
    let mut positions: Vec<DVec3> = (0..3 * count).map(|_| point(random)).collect();
    if random.one_in(4) {
        positions[1] = positions[0];
    }
    if random.one_in(4) {
        positions[2] = positions[0].lerp(positions[1], 0.4);
    }
    Mesh { positions, triangles: (0..count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect() }
}

/// A square of `n` by `n` cells over the unit square, moved up and down by at most `height`.
fn sheet(random: &mut Random, n: u32, height: f64) -> Mesh {
    let positions = (0..(n + 1) * (n + 1)).map(|i| {
        let [x, y] = [i % (n + 1), i / (n + 1)].map(|k| f64::from(k) / f64::from(n));
        DVec3::new(x, y, height * random.unit())
    });
    let triangles = (0..n * n).flat_map(|i| {
        let a = i / n * (n + 1) + i % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    });
    Mesh { positions: positions.collect(), triangles: triangles.collect() }
}

fn point(random: &mut Random) -> DVec3 {
    DVec3::new(random.unit(), random.unit(), random.unit())
}

fn pair(random: &mut Random) -> [Mesh; 2] {
    match random.below(4) {
        0 => [loose(random), loose(random)],
        1 => {
            let n = 1 + random.below(4) as u32;
            [sheet(random, n, 0.3), sheet(random, 2, 0.3)]
        }
        2 => [sheet(random, 4, 0.001), sheet(random, 3, 0.0)],
        _ => {
            // The same surface but for one vertex.
            let mut meshes = [(); 2].map(|()| sheet(&mut Random::new(7), 3, 0.2));
            let moved = random.below(meshes[1].positions.len());
            meshes[1].positions[moved] += (point(random) - 0.5) * 0.1;
            meshes
        }
    }
}

const OPTIONS: DistanceOptions = DistanceOptions {
    lost_beyond: None,
    tolerance_relative: 0.01,
    tolerance_of_diagonal: 1e-6,
    samples: 4_000,
    refinements_max: 1 << 22,
    refining_work_max: u64::MAX,
};

#[test]
fn the_bounds_enclose_what_dense_sampling_finds_and_are_as_close_as_asked() {
    for seed in 0..2_000 {
        let [a, b] = pair(&mut Random::new(seed));
        let found =
            surface_distance(a.surface(), b.surface(), &OPTIONS, &Budget::unlimited()).unwrap().unwrap();
        for (of, from, to) in [(found.forward, &a, &b), (found.backward, &b, &a)] {
            let (sampled, _) = from.sampled(to, 11);
            assert!(of.upper >= sampled, "{seed}: {} < {sampled}", of.upper);
            assert!(of.lower >= 0.8 * sampled - 1e-6, "{seed}: lower bound {} of {sampled}", of.lower);
            let tolerance = (0.01 * of.lower).max(4e-6) + 1e-12;
            assert!(of.upper - of.lower <= tolerance, "{seed}: {} to {}", of.lower, of.upper);
            // The lower bound is a distance, at the place that is named.
            let far = of.farthest;
            assert!((to.distance(far.place) - of.lower).abs() <= 1e-12, "{seed}");
            assert!((far.closest.distance(far.place) - of.lower).abs() <= 1e-12, "{seed}");
            let on = |mesh: &Mesh, t: u32, p: DVec3| {
                let t = mesh.triangles[t as usize].map(|v| mesh.positions[v as usize]);
                closest_point_on_triangle(p, t).distance(p)
            };
            assert!(on(from, far.triangle, far.place) <= 1e-12, "{seed}");
            assert!(on(to, far.closest_triangle, far.closest) <= 1e-12, "{seed}");
        }
    }
}

#[test]
fn the_mean_is_that_of_dense_sampling() {
    for seed in 0..100 {
        let random = &mut Random::new(seed);
        let [a, b] = [sheet(random, 3, 0.3), sheet(random, 2, 0.3)];
        let found =
            surface_distance(a.surface(), b.surface(), &OPTIONS, &Budget::unlimited()).unwrap().unwrap();
        let (mean, (_, sampled)) = (found.forward.mean.unwrap(), a.sampled(&b, 40));
        assert!((mean - sampled).abs() < 0.05 * sampled, "{seed}: {mean} is not {sampled}");
        assert!(found.forward.root_mean_square.unwrap() >= mean && mean <= found.forward.upper);
    }
}

#[test]
fn known_distances_come_out_at_every_scale_and_far_from_the_origin() {
    for (scale, origin) in [(1.0, 0.0), (1e-200, 0.0), (1e200, 0.0), (1e-3, 1e3), (1.0, -1e6)] {
        let at = |x: f64, y: f64, z: f64| (DVec3::new(x, y, z) + origin) * scale;
        let triangles = vec![[0, 1, 2], [0, 2, 3]];
        let square = |side: f64, z: f64| Mesh {
            positions: vec![at(0.0, 0.0, z), at(side, 0.0, z), at(side, side, z), at(0.0, side, z)],
            triangles: triangles.clone(),
        };
        let [a, b] = [square(2.0, 0.0), square(1.0, 0.5)];
        let found =
            surface_distance(a.surface(), b.surface(), &OPTIONS, &Budget::unlimited()).unwrap().unwrap();
        let corner = DVec3::new(1.0, 1.0, 0.5).length() * scale;
        let is_about = |x: f64, y: f64| (x - y).abs() <= 0.0101 * y;
        assert!(is_about(found.upper(), corner) && is_about(found.lower(), corner), "{scale}: {found:?}");
        assert!(found.upper() >= corner);
        assert!(is_about(found.backward.upper, 0.5 * scale) && is_about(found.backward.lower, 0.5 * scale));
        assert!(is_about(found.backward.mean.unwrap(), 0.5 * scale), "{found:?}");
        assert!((found.forward.farthest.place - at(2.0, 2.0, 0.0)).length() <= 1e-9 * scale);
    }
}

#[test]
fn the_same_surface_has_no_distance_and_an_absent_one_has_none() {
    let mesh = sheet(&mut Random::new(3), 20, 0.4);
    let unlimited = Budget::unlimited();
    let found = surface_distance(mesh.surface(), mesh.surface(), &OPTIONS, &unlimited).unwrap().unwrap();
    assert!(found.upper() < 1e-13 && found.lower() < 1e-15, "{found:?}");
    let absent = Surface { positions: &[], triangles: &[] };
    assert_eq!(surface_distance(mesh.surface(), absent, &OPTIONS, &unlimited), Ok(None));
    assert_eq!(surface_distance(absent, mesh.surface(), &OPTIONS, &unlimited), Ok(None));
}

#[test]
fn the_bounds_are_the_same_with_1_2_and_8_threads_and_hold_without_refinement() {
    let random = &mut Random::new(11);
    let [a, b] = [sheet(random, 90, 0.02), sheet(random, 31, 0.02)];
    let measure = |options: &DistanceOptions| {
        surface_distance(a.surface(), b.surface(), options, &Budget::unlimited()).unwrap().unwrap()
    };
    let [one, two, eight] = [1, 2, 8].map(|threads| with_threads(threads, || measure(&OPTIONS)));
    assert!(one == two && one == eight, "{one:?} {two:?} {eight:?}");
    let rough = measure(&DistanceOptions { refinements_max: 0, ..OPTIONS });
    assert!(rough.upper() >= one.lower() && rough.lower() <= one.upper(), "{rough:?}");
}

/// A ball of `rows` rows of squares, of which the poles are points.
fn ball(rows: u32) -> Mesh {
    let columns = 2 * rows;
    let place = |row: u32, column: u32| {
        let turn = |n: u32, of: u32| std::f64::consts::TAU * f64::from(n) / f64::from(of);
        let (up, out) = (libm::cos(turn(row, 2 * rows)), libm::sin(turn(row, 2 * rows)));
        DVec3::new(out * libm::cos(turn(column, columns)), out * libm::sin(turn(column, columns)), up)
    };
    let rings = (1..rows).flat_map(|row| (0..columns).map(move |column| place(row, column)));
    let positions = rings.chain([DVec3::Z, -DVec3::Z]).collect();
    let id = |row: u32, column: u32| match row {
        0 => (rows - 1) * columns,
        row if row == rows => (rows - 1) * columns + 1,
        row => (row - 1) * columns + column % columns,
    };
    let square = |row: u32, column: u32| {
        let [a, b] = [id(row, column), id(row, column + 1)];
        let [c, d] = [id(row + 1, column), id(row + 1, column + 1)];
        [[a, c, d], [a, d, b]]
    };
    let squares = (0..rows).flat_map(|row| (0..columns).flat_map(move |column| square(row, column)));
    Mesh { positions, triangles: squares.filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]).collect() }
}

#[test]
fn round_surfaces_are_enclosed_with_work_in_proportion_to_their_triangles() {
    let (fine, coarse) = (ball(60), ball(19));
    let triangles = (fine.triangles.len() + coarse.triangles.len()) as u64;
    for (a, b) in [(&fine, &coarse), (&coarse, &fine)] {
        let budget = Budget::unlimited();
        let options = DistanceOptions { samples: 1 << 10, ..DistanceOptions::default() };
        let found = surface_distance(a.surface(), b.surface(), &options, &budget).unwrap().unwrap();
        assert!(found.is_within_tolerance() && found.upper() <= 1.02 * found.lower(), "{found:?}");
        assert!(budget.work_used() < 2_000 * triangles, "{} for {triangles}", budget.work_used());
        // What ends early says so, and its bounds hold.
        let hasty = DistanceOptions { refinements_max: 0, tolerance_relative: 1e-6, ..options };
        let hasty =
            surface_distance(a.surface(), b.surface(), &hasty, &Budget::unlimited()).unwrap().unwrap();
        assert!(!hasty.is_within_tolerance(), "{hasty:?}");
        assert!(hasty.upper() >= found.lower() && hasty.lower() <= found.upper());
        assert!(hasty.upper() <= 1.5 * found.upper(), "what covers a piece bounds it well: {hasty:?}");
    }
}
