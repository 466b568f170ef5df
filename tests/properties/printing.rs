//! Measures for printing against brute force, on random solids.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::distance::{Areas, Surface};
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::printing::{BuildDirection, Limit, Printing, PrintingPolicy, measure};
use std::f64::consts::{PI, TAU};

/// A sphere with dents, anywhere.
fn dented_sphere(random: &mut Random) -> Soup {
    let (columns, rows) = (random.between(4, 12) as u32, random.between(3, 8) as u32);
    let origin = DVec3::new(random.unit(), random.unit(), random.unit()) * 20.0;
    let squash = DVec3::new(1.0 + random.unit() * 3.0, 1.0, 0.3 + random.unit());
    let mut at = |column: u32, row: u32| {
        let (a, b) = (TAU * f64::from(column) / f64::from(columns), PI * f64::from(row) / f64::from(rows));
        let radius = 5.0 * (1.0 + 0.4 * random.unit());
        DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos()) * squash * radius + origin
    };
    let mut positions = vec![at(0, 0), at(0, rows)];
    for row in 1..rows {
        positions.extend((0..columns).map(|column| at(column, row)));
    }
    let id = |column: u32, row: u32| match row {
        0 => 0,
        _ if row == rows => 1,
        _ => 2 + (row - 1) * columns + column % columns,
    };
    let quads = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|(column, row)| {
            let [a, b] = [id(column, row), id(column + 1, row)];
            let [c, d] = [id(column, row + 1), id(column + 1, row + 1)];
            [[a, c, d], [a, d, b]]
        })
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

fn measured(soup: &Soup, policy: &PrintingPolicy) -> Printing {
    measure(soup, policy, true, 8, &Budget::unlimited()).unwrap().unwrap()
}

fn corners(soup: &Soup) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    soup.triangles.iter().map(|t| t.map(|v| soup.positions[v as usize]))
}

fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize()
}

/// The distance at which a ray meets a triangle (Möller and Trumbore 1997).
fn met(from: DVec3, along: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (u, v, to) = (b - a, c - a, from - a);
    let p = along.cross(v);
    let scale = 1.0 / u.dot(p);
    let (s, q) = (to.dot(p) * scale, to.cross(u));
    let t = along.dot(q) * scale;
    let distance = v.dot(q) * scale;
    (s >= 0.0 && t >= 0.0 && s + t <= 1.0 && distance > 0.0).then_some(distance)
}

#[test]
fn walls_by_rays_are_those_that_looking_at_every_triangle_finds() {
    for seed in 0..cases(12, 200) {
        let soup = dented_sphere(&mut Random::new(seed as u64));
        let walls = measured(&soup, &PrintingPolicy::default()).figures.walls;
        let surface = Surface { positions: &soup.positions, triangles: &soup.triangles };
        let areas = Areas::of(surface, &Budget::unlimited()).unwrap();
        let all: Vec<[DVec3; 3]> = corners(&soup).collect();
        let count = walls.samples as usize;
        let mut found: Vec<f64> = (0..count)
            .filter_map(|k| {
                let sample = areas.sample(surface, k, count);
                let inward = -normal(all[sample.triangle as usize]);
                let others = all.iter().enumerate().filter(|&(t, _)| t as u32 != sample.triangle);
                let exits = others.filter(|(_, corners)| normal(**corners).dot(inward) > 0.0);
                let hits = exits.filter_map(|(_, &c)| Some((met(sample.place, inward, c)?, normal(c))));
                let (distance, wall) = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
                (wall.dot(inward) >= 30f64.to_radians().cos()).then_some(distance)
            })
            .collect();
        found.sort_by(f64::total_cmp);
        assert!((walls.ray.measured_share - found.len() as f64 / count as f64).abs() < 0.002, "seed {seed}");
        let median = found[found.len() / 2];
        assert!(
            (walls.ray.median.unwrap() - median).abs() < 1e-2 * median,
            "seed {seed}: {walls:?} {median}"
        );
        // The middles of triangles may have thinner walls than the samples.
        assert!(walls.ray.min.unwrap() <= found[0] * (1.0 + 1e-9), "seed {seed}");
        assert!(walls.sphere.min.unwrap() <= walls.ray.min.unwrap() * (1.0 + 1e-9), "seed {seed}");
    }
}

#[test]
fn no_box_turned_at_random_is_smaller_and_every_point_is_inside() {
    for seed in 0..cases(30, 400) {
        let mut random = Random::new(seed as u64);
        let soup = dented_sphere(&mut random);
        let found = measured(&soup, &PrintingPolicy::default()).figures.quote.oriented_box;
        for &p in &soup.positions {
            for k in 0..3 {
                let off = (p - found.centre).dot(found.axes[k]).abs();
                assert!(off <= found.size[k] / 2.0 * (1.0 + 1e-9), "seed {seed}");
            }
        }
        for _ in 0..2_000 {
            let axis = DVec3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
            let Some(axis) = axis.try_normalize() else { continue };
            let (u, v) = axis.any_orthonormal_pair();
            let turn = random.unit() * TAU;
            let axes = [axis, u * turn.cos() + v * turn.sin(), v * turn.cos() - u * turn.sin()];
            let extent = |d: DVec3| {
                let along = soup.positions.iter().map(|p| p.dot(d));
                along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
            };
            let volume: f64 = axes.into_iter().map(extent).product();
            assert!(volume >= found.volume() * (1.0 - 1e-9), "seed {seed}: {volume} {}", found.volume());
        }
    }
}

#[test]
fn shadow_and_support_are_what_points_and_faces_one_by_one_give() {
    for seed in 0..cases(12, 200) {
        let mut random = Random::new(seed as u64);
        let soup = dented_sphere(&mut random);
        let axis = random.below(3);
        let direction = BuildDirection::ALL[2 * axis + random.below(2)];
        let sign = if direction == BuildDirection::ALL[2 * axis] { 1.0 } else { -1.0 };
        let limit = Limit { warning: Some(20.0 + 40.0 * random.unit()), error: None };
        let policy =
            PrintingPolicy { overhang: limit, build_direction: direction, ..PrintingPolicy::default() };
        let of = measured(&soup, &policy).figures;
        let view = |p: DVec3| [p[(axis + 1) % 3], p[(axis + 2) % 3]];
        let (low, high) = (view(of.quote.bounds.min), view(of.quote.bounds.max));
        let cells = 160;
        let cell = [0, 1].map(|k| (high[k] - low[k]) / f64::from(cells));
        let is_covered = |x: f64, y: f64| {
            corners(&soup).any(|c| {
                let [a, b, c] = c.map(view);
                let turn = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
                let turns = [turn(a, b), turn(b, c), turn(c, a)];
                turns.iter().all(|&t| t >= 0.0) || turns.iter().all(|&t| t <= 0.0)
            })
        };
        let middles =
            (0..cells).flat_map(|i| (0..cells).map(move |j| (f64::from(i) + 0.5, f64::from(j) + 0.5)));
        let covered =
            middles.filter(|&(i, j)| is_covered(low[0] + i * cell[0], low[1] + j * cell[1])).count();
        let shadow = covered as f64 * cell[0] * cell[1];
        assert!(
            (of.quote.shadow_area - shadow).abs() < 0.01 * shadow,
            "seed {seed}: {} {shadow}",
            of.quote.shadow_area
        );
        let cosine = limit.warning.unwrap().to_radians().cos();
        let support: f64 = corners(&soup)
            .map(|c| (-normal(c)[axis] * sign, c))
            .filter(|&(down, _)| down > cosine)
            .map(|(down, [a, b, c])| down * (b - a).cross(c - a).length() / 2.0)
            .sum();
        let placed = of.overhangs.iter().find(|o| o.direction == direction).unwrap();
        assert!((placed.support_area - support).abs() < 1e-9 * (1.0 + support), "seed {seed}");
    }
}
