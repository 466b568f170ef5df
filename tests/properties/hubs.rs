//! Vertices with very many triangles: what is found there by directions against all pairs, and how much is looked at.

use crate::near;
use crate::random::Random;
use crate::support::{cases, on_all_cores};
use meshmend::analysis::{AnalyzeOptions, NearSearch, analyze};
use meshmend::budget::Budget;
use meshmend::geom::{DVec3, Shared, ThreePointPlane, are_collinear, contact};
use meshmend::mesh::Soup;
use meshmend::spatial::{Bvh, NearestSearch, Search, TriangleContact, self_contacts};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Adds triangles by the positions of their corners, equal ones with equal numbers, without degenerate ones and repeats.
#[derive(Default)]
struct Builder {
    numbers: BTreeMap<[u64; 3], u32>,
    seen: BTreeSet<BTreeSet<u32>>,
    soup: Soup,
}

impl Builder {
    fn add(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners;
        if are_collinear(a, b, c) {
            return;
        }
        let corners = corners.map(|p| {
            // No negative zeros.
            let p = p + DVec3::ZERO;
            *self.numbers.entry(p.to_array().map(f64::to_bits)).or_insert_with(|| {
                self.soup.positions.push(p);
                self.soup.positions.len() as u32 - 1
            })
        });
        if self.seen.insert(BTreeSet::from(corners)) {
            self.soup.triangles.push(corners);
        }
    }

    fn fan(&mut self, hub: DVec3, rim: &[DVec3]) {
        rim.windows(2).for_each(|ends| self.add([hub, ends[0], ends[1]]));
    }

    fn done(mut self) -> Soup {
        self.soup.face_count = self.soup.triangles.len() as u32;
        self.soup
    }
}

/// Fans of more than 64 triangles that are folded, lie on one another, or go through each other, on the points of a grid.
fn fans_on_a_grid(random: &mut Random) -> Soup {
    let kind = random.below(4);
    let reach = random.between(2, 9);
    let point = |random: &mut Random| {
        let [x, y, z] = [(); 3].map(|()| f64::from(random.between(-reach, reach)));
        // In a plane, many directions are the same.
        DVec3::new(x, y, if kind == 0 { 0.0 } else { z })
    };
    let is_plain = kind == 1 && random.one_in(2);
    let mut mesh = Builder::default();
    for fan in 0..if is_plain { 1 } else { 1 + random.below(2) } {
        // The second hub is anywhere: on a face or an edge of the first fan, or far away.
        let hub = if fan == 0 { DVec3::ZERO } else { point(random) };
        let count = 90 + random.below(30);
        let rim: Vec<DVec3> = match kind {
            // Around once, with a few places out of order.
            1 => {
                let mut rim: Vec<DVec3> = (0..=count)
                    .map(|i| {
                        let angle = TAU * i as f64 / count as f64;
                        let [x, y] = [angle.cos(), angle.sin()].map(|x| (x * 4096.0).round());
                        hub + DVec3::new(x, y, f64::from(random.between(-1, 1)) * 512.0)
                    })
                    .collect();
                for _ in 0..if is_plain { 0 } else { random.below(4) } {
                    let (i, j) = (random.below(count), random.below(count));
                    rim.swap(i, j);
                }
                rim
            }
            _ => (0..=count).map(|_| point(random)).collect(),
        };
        mesh.fan(hub, &rim);
    }
    for _ in 0..if is_plain { 0 } else { random.below(20) } {
        mesh.add([(); 3].map(|()| point(random)));
    }
    mesh.done()
}

fn all_pairs(Soup { positions, triangles, .. }: &Soup) -> Vec<TriangleContact> {
    let corners = |t: usize| triangles[t].map(|v| positions[v as usize]);
    let mut found = Vec::new();
    for a in 0..triangles.len() {
        let plane = ThreePointPlane::through(corners(a));
        for b in a + 1..triangles.len() {
            let shared = Shared::between(triangles[a], triangles[b]);
            if let Some(kind) = contact(&plane, corners(b).each_ref(), shared) {
                found.push(TriangleContact { a: a as u32, b: b as u32, kind });
            }
        }
    }
    found
}

#[test]
fn contacts_around_hubs_are_those_of_all_pairs_at_every_scale() {
    let rounds = cases(400, 20_000);
    let counts = on_all_cores(rounds, |round| {
        let mut random = Random::of_round(90, round);
        let mut mesh = fans_on_a_grid(&mut random);
        // Powers of two near 1e-30 and 1e30: the same mesh.
        let factor = 2f64.powi(random.pick(&[0, 0, -100, 100, 7]));
        let away = f64::from(random.pick(&[0, 0, 1 << 20]));
        mesh.positions.iter_mut().for_each(|p| *p = (*p + away) * factor);
        let budget = Budget::unlimited();
        let bvh = Bvh::build(&mesh.positions, &mesh.triangles, None, &budget).unwrap();
        let search =
            |search| self_contacts(&mesh.positions, &mesh.triangles, &bvh, None, search, &budget).unwrap();
        let truth = all_pairs(&mesh);
        assert_eq!(search(Search::All { keep: usize::MAX / 4 }).list, truth, "round {round}");
        let first = search(Search::First);
        assert_eq!(first.list.is_empty(), truth.is_empty(), "round {round}");
        assert!(first.list.iter().all(|contact| truth.contains(contact)), "round {round}");
        truth.len()
    });
    let (none, sum) = (counts.iter().filter(|n| **n == 0).count(), counts.iter().sum::<usize>());
    println!("| contacts around hubs against all pairs | {rounds} meshes | {sum}, none in {none} |");
    assert!(none > 0 && sum > 100 * rounds);
}

/// A fan whose rim is near itself in many places, and perhaps another one at nearly the same hub.
fn crowded_fans(random: &mut Random) -> Soup {
    let small =
        |random: &mut Random, size: f64| DVec3::from_array([(); 3].map(|()| (random.unit() - 0.5) * size));
    let mut mesh = Builder::default();
    let hubs = 1 + random.below(2);
    let apart = random.pick(&[1.0, 0.03, 1e-9]);
    for fan in 0..hubs {
        let hub = small(random, apart) * fan as f64;
        let ways: Vec<DVec3> = (0..12).map(|_| small(random, 2.0)).collect();
        let mut rim = Vec::new();
        for i in 0..80 {
            let share = if random.one_in(3) { random.unit() } else { 1.0 };
            rim.push(match random.below(3) {
                // About a step of the reach apart, along a circle.
                0 => DVec3::new((0.05 * f64::from(i)).cos(), (0.05 * f64::from(i)).sin(), 0.0),
                _ => random.pick(&ways) * share + small(random, 0.08),
            });
        }
        mesh.fan(hub, &rim);
    }
    mesh.done()
}

#[test]
fn what_is_near_around_hubs_is_what_all_pairs_of_features_give() {
    let rounds = cases(60, 5_000);
    let counts = on_all_cores(rounds, |round| {
        let mesh = crowded_fans(&mut Random::of_round(91, round));
        let told = near::told(&mesh);
        assert_eq!(told, near::expected(&mesh), "round {round}");
        told.len()
    });
    let sum = counts.iter().sum::<usize>();
    println!("| near features around hubs against all pairs | {rounds} meshes | {sum} |");
    assert!(sum > 20 * rounds, "{sum}");
}

#[test]
fn the_closest_point_of_a_fan_is_what_looking_at_every_triangle_gives() {
    on_all_cores(cases(300, 20_000), |round| {
        let mut random = Random::of_round(92, round);
        let mut mesh = if random.one_in(2) { crowded_fans(&mut random) } else { fans_on_a_grid(&mut random) };
        let factor = random.pick(&[1.0, 1e-30, 1e30, 1e6]);
        let away = random.pick(&[0.0, 0.0, 1e3, -1e6]);
        mesh.positions.iter_mut().for_each(|p| *p = (*p + away) * factor);
        let budget = Budget::unlimited();
        let search = NearestSearch::build(&mesh.positions, &mesh.triangles, &budget).unwrap();
        for i in 0..60 {
            let corners = search.corners(random.below(mesh.triangles.len()) as u32);
            let [s, t] = [random.unit(), random.unit() * 0.5];
            let on = corners[0] + (corners[1] - corners[0]) * s + (corners[2] - corners[0]) * t;
            let off = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
            let p = match i % 4 {
                0 => on,
                1 => on + off * (1e-3 * factor),
                2 => corners[random.below(3)],
                _ => (off * 30.0 + away) * factor,
            };
            let hint = random.one_in(2).then(|| random.below(mesh.triangles.len()) as u32);
            let found = search.find(p, hint, &budget).unwrap().unwrap();
            let of_all = (0..mesh.triangles.len() as u32).map(|t| search.on_triangle(p, t).distance);
            assert_eq!(found.distance, of_all.fold(f64::INFINITY, f64::min), "round {round}, {i}");
        }
    });
}

/// What a search looks at on a shape.
type Work<'w> = &'w dyn Fn(&Soup) -> u64;

fn circle(sides: u32, radius: f64, height: f64) -> impl Iterator<Item = DVec3> {
    // Turned, so that no side is along an axis.
    (0..=sides).map(move |i| {
        let angle = TAU * f64::from(i % sides) / f64::from(sides) + 0.3;
        DVec3::new(radius * angle.cos(), radius * angle.sin(), height)
    })
}

/// A cone and a cylinder with `sides` faces around each hub, tilted.
fn round_parts(sides: u32) -> [Soup; 2] {
    let (mut cone, mut cylinder) = (Builder::default(), Builder::default());
    let floor: Vec<DVec3> = circle(sides, 30.0, 0.0).collect();
    let lid: Vec<DVec3> = circle(sides, 30.0, 80.0).collect();
    let back = |rim: &[DVec3]| rim.iter().rev().copied().collect::<Vec<_>>();
    cone.fan(DVec3::Z * 80.0, &floor);
    cone.fan(DVec3::ZERO, &back(&floor));
    cylinder.fan(DVec3::ZERO, &back(&floor));
    cylinder.fan(DVec3::Z * 80.0, &lid);
    for (low, high) in floor.windows(2).zip(lid.windows(2)) {
        cylinder.add([low[0], low[1], high[1]]);
        cylinder.add([low[0], high[1], high[0]]);
    }
    [cone.done(), cylinder.done()].map(|mut soup| {
        let [u, v, w] =
            [DVec3::new(0.6, 0.64, 0.48), DVec3::new(-0.8, 0.48, 0.36), DVec3::new(0.0, -0.6, 0.8)];
        soup.positions.iter_mut().for_each(|p| *p = u * p.x + v * p.y + w * p.z);
        soup
    })
}

#[test]
fn the_work_on_cones_and_cylinders_grows_far_slower_than_the_square_of_their_faces() {
    let contacts = |soup: &Soup| {
        let budget = Budget::unlimited();
        let bvh = Bvh::build(&soup.positions, &soup.triangles, None, &budget).unwrap();
        let search = Search::All { keep: 10 };
        let found = self_contacts(&soup.positions, &soup.triangles, &bvh, None, search, &budget).unwrap();
        assert_eq!(found.count, 0);
        budget.work_used()
    };
    let near = |soup: &Soup| {
        let budget = Budget::unlimited();
        let options = AnalyzeOptions { near: NearSearch::ByDiagonal, ..AnalyzeOptions::default() };
        let none = meshmend::spatial::Contacts::default();
        analyze(soup, Some(&none), &options, &budget).unwrap();
        budget.work_used()
    };
    let closest = |soup: &Soup| {
        let budget = Budget::unlimited();
        let search = NearestSearch::build(&soup.positions, &soup.triangles, &budget).unwrap();
        let mut random = Random::new(8);
        let boxes = (0..soup.triangles.len()).map(|_| {
            let [a, b, c] = search.corners(random.below(soup.triangles.len()) as u32);
            let p = (a + (b - a) * (random.unit() * 0.5) + (c - a) * (random.unit() * 0.5)) * 0.999;
            search.find_roughly(p, None, usize::MAX, &budget).unwrap().unwrap().boxes as u64
        });
        boxes.sum()
    };
    // Closest points only on the cone: the boxes of long thin sides that are askew hold each other's middles, without a hub.
    let searches: [(&str, Work<'_>, usize); 3] =
        [("contacts", &contacts, 2), ("near", &near, 2), ("closest", &closest, 1)];
    for (name, work, shapes) in searches {
        for (shape, (few, many)) in round_parts(500).iter().zip(&round_parts(8_000)).enumerate().take(shapes)
        {
            let [of_few, of_many] = [few, many].map(|soup| work(soup) as f64 / soup.triangles.len() as f64);
            println!("| {name}, shape {shape} | {of_few:.1} and {of_many:.1} for each triangle |");
            // With the square of the faces it would be 16 times as much.
            assert!(of_many < 6.0 * of_few && of_many < 1_600.0, "{name} {shape}: {of_few} {of_many}");
        }
    }
}
