//! Contacts of triangles against all pairs in rational arithmetic.
//!
//! The truth clips one triangle, a convex polygon, by the plane and the three edge planes of the other. Nothing in it
//! resembles the engine's sign tests.

use crate::random::Random;
use crate::rational::{Point, cross, dot, is_zero, minus, point, sign};
use crate::support::cases;
use dashu_ratio::RBig;
use meshmend::budget::Budget;
use meshmend::geom::{ContactKind, DVec3, Sign, are_collinear};
use meshmend::par;
use meshmend::spatial::{Bvh, Contacts, Search, Terrains, TriangleContact, self_contacts};

struct Soup {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// Triangles on the points of a small grid, without degenerate ones. Equal points have equal indices.
    fn on_grid(random: &mut Random, triangle_count: usize, side: [i32; 3], hub_share: f64) -> Self {
        let [nx, ny, nz] = side.map(|n| n + 1);
        let positions = (0..nx * ny * nz)
            .map(|i| DVec3::new(f64::from(i % nx), f64::from(i / nx % ny), f64::from(i / nx / ny)))
            .collect::<Vec<_>>();
        let mut triangles = Vec::new();
        while triangles.len() < triangle_count {
            let mut corners = [0; 3].map(|_| random.below(positions.len()) as u32);
            if random.unit() < hub_share {
                corners[0] = 0;
            }
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            if !are_collinear(a, b, c) {
                triangles.push(corners);
            }
        }
        Self { positions, triangles }
    }

    fn scaled(mut self, factor: f64, offset: DVec3) -> Self {
        for p in &mut self.positions {
            *p = *p * factor + offset;
        }
        self
    }

    fn search(&self, search: Search) -> Contacts {
        let budget = Budget::unlimited();
        let bvh = Bvh::build(&self.positions, &self.triangles, None, &budget).unwrap();
        self_contacts(&self.positions, &self.triangles, &bvh, None, search, &budget).unwrap()
    }

    /// A closed double cone with its corners moved about, equal positions welded, degenerate triangles among the others.
    fn crumpled(random: &mut Random) -> Self {
        let rim = 3 + random.below(5) as u32;
        let ring = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(rim);
            DVec3::new((4.0 * angle.cos()).round(), (4.0 * angle.sin()).round(), 0.0)
        };
        let mut positions: Vec<DVec3> =
            (0..rim).map(ring).chain([DVec3::Z * 2.0, DVec3::NEG_Z * 2.0]).collect();
        for p in &mut positions {
            if random.one_in(2) {
                *p += DVec3::from_array([0; 3].map(|_| f64::from(random.between(-2, 2))));
            }
        }
        let next = |i: u32| (i + 1) % rim;
        let sides = (0..rim).flat_map(|i| [[i, next(i), rim], [next(i), i, rim + 1]]);
        let first = |v: u32| positions.iter().position(|p| *p == positions[v as usize]).unwrap() as u32;
        let triangles = sides.map(|t| t.map(first)).collect();
        Self { positions, triangles }
    }

    /// The ends of the edges without exactly two triangles, one in each direction.
    fn open_vertices(&self) -> Vec<u32> {
        let sides: Vec<[u32; 2]> =
            self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let count = |side: [u32; 2]| sides.iter().filter(|&&other| other == side).count();
        let is_open = |&[a, b]: &[u32; 2]| [count([a, b]), count([b, a])] != [1, 1];
        sides.iter().copied().filter(is_open).flatten().collect()
    }

    /// The truth, for every pair.
    fn all_pairs(&self) -> Vec<TriangleContact> {
        let corners: Vec<[Point; 3]> =
            self.triangles.iter().map(|t| t.map(|v| point(self.positions[v as usize]))).collect();
        let mut contacts = Vec::new();
        for b in 0..corners.len() {
            for a in 0..b {
                if let Some(kind) = kind(&corners[a], &corners[b]) {
                    contacts.push(TriangleContact { a: a as u32, b: b as u32, kind });
                }
            }
        }
        contacts.sort_unstable();
        contacts
    }
}

fn kind(a: &[Point; 3], b: &[Point; 3]) -> Option<ContactKind> {
    let common: Vec<&Point> = a.iter().filter(|p| b.contains(p)).collect();
    let meeting = clip(a, b);
    if common.len() == 3 || meeting.iter().all(|p| is_in_simplex(p, &common)) {
        return None;
    }
    // The mean of the corners is inside the meeting, and the insides of two convex sets meet there if they meet.
    let count = RBig::from(meeting.len());
    let mean: Point =
        [0, 1, 2].map(|k| meeting.iter().map(|p| &p[k]).fold(RBig::ZERO, |s, x| s + x) / &count);
    if !(is_strictly_inside(&mean, a) && is_strictly_inside(&mean, b)) {
        return Some(ContactKind::Touch);
    }
    let (n, m) = (normal(a), normal(b));
    Some(if is_zero(&cross(&n, &m)) { ContactKind::Overlap } else { ContactKind::Cross })
}

fn normal([a, b, c]: &[Point; 3]) -> Point {
    cross(&minus(b, a), &minus(c, a))
}

/// The directions that point into the triangle, in its plane, square to each edge.
fn inward(corners: &[Point; 3]) -> [Point; 3] {
    let n = normal(corners);
    [0, 1, 2].map(|k| cross(&n, &minus(&corners[(k + 1) % 3], &corners[k])))
}

fn is_strictly_inside(p: &Point, corners: &[Point; 3]) -> bool {
    let directions = inward(corners);
    (0..3).all(|k| sign(&dot(&directions[k], &minus(p, &corners[k]))) == Sign::Positive)
}

/// In the convex hull of at most two points.
fn is_in_simplex(p: &Point, simplex: &[&Point]) -> bool {
    match simplex {
        [q] => p == *q,
        [q, r] => {
            let (u, v) = (minus(r, q), minus(p, q));
            let along = dot(&u, &v);
            is_zero(&cross(&u, &v)) && along >= RBig::ZERO && along <= dot(&u, &u)
        }
        _ => false,
    }
}

/// The corners (perhaps repeated) of what both closed triangles have in common.
fn clip(a: &[Point; 3], b: &[Point; 3]) -> Vec<Point> {
    let n = normal(b);
    let opposite = n.clone().map(|x| -x);
    let directions = inward(b);
    let mut polygon = a.to_vec();
    for (direction, through) in [(&n, &b[0]), (&opposite, &b[0])].into_iter().chain(directions.iter().zip(b))
    {
        polygon = clip_by(&polygon, direction, through);
    }
    polygon
}

/// The part of a convex polygon, perhaps flat, where `direction . (p - through) >= 0` (Sutherland and Hodgman 1974).
fn clip_by(polygon: &[Point], direction: &Point, through: &Point) -> Vec<Point> {
    let heights: Vec<RBig> = polygon.iter().map(|p| dot(direction, &minus(p, through))).collect();
    let mut kept = Vec::new();
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if heights[i] >= RBig::ZERO {
            kept.push(polygon[i].clone());
        }
        if sign(&heights[i]) * sign(&heights[j]) == Sign::Negative {
            let t = &heights[i] / (&heights[i] - &heights[j]);
            kept.push([0, 1, 2].map(|k| &polygon[i][k] + &t * (&polygon[j][k] - &polygon[i][k])));
        }
    }
    kept
}

#[test]
fn contacts_are_those_of_all_pairs_in_rational_arithmetic() {
    let mut seen = std::collections::BTreeMap::new();
    for case in 0..cases(1_500, 100_000) {
        let mut random = Random::new(case as u64);
        let side = random.pick(&[[1, 1, 1], [2, 2, 0], [3, 2, 1], [2, 2, 2], [4, 4, 4]]);
        let count = 2 + random.below(12);
        let hub_share = random.pick(&[0.0, 0.5, 1.0]);
        let soup = Soup::on_grid(&mut random, count, side, hub_share);
        // The same combinatorics at sizes where filters fail and where they must not be trusted.
        let soup = match random.below(4) {
            0 => soup.scaled(2f64.powi(-700), DVec3::ZERO),
            1 => soup.scaled(2f64.powi(700), DVec3::ZERO),
            2 => soup.scaled(2f64.powi(-20), DVec3::new(1e5, -3e7, 0.0)),
            _ => soup,
        };
        let expected = soup.all_pairs();
        let found = soup.search(Search::All { keep: usize::MAX });
        assert_eq!(found.list, expected, "case {case}: {:?} {:?}", soup.triangles, soup.positions);
        assert_eq!(found.count, expected.len() as u64);
        assert_eq!(soup.search(Search::First).count > 0, !expected.is_empty(), "case {case}");
        for contact in expected {
            *seen.entry(contact.kind).or_insert(0) += 1;
        }
    }
    assert!(
        seen.len() == 3 && seen.values().all(|&n| n > 100),
        "too few of a kind to mean anything: {seen:?}"
    );
}

#[test]
fn the_contacts_of_a_large_star_are_those_of_all_pairs() {
    for case in 0..cases(3, 200) {
        let mut random = Random::new(1_000 + case as u64);
        let side = random.pick(&[[9, 9, 0], [9, 9, 9]]);
        let soup = Soup::on_grid(&mut random, 150, side, 0.8);
        let found = soup.search(Search::All { keep: usize::MAX });
        assert_eq!(found.list, soup.all_pairs(), "case {case}");
    }
}

/// Two cones on one rim of `count` points. The boxes of all triangles of a cone meet at its top, and many boxes of one
/// cone meet many of the other.
fn double_cone(count: u32, bottom: DVec3) -> Soup {
    let rim = |i: u32| {
        let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
        DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let positions = (0..count).map(rim).chain([DVec3::Z, bottom]).collect();
    let next = |i: u32| (i + 1) % count;
    let triangles = (0..count).flat_map(|i| [[i, next(i), count], [next(i), i, count + 1]]).collect();
    Soup { positions, triangles }
}

#[test]
fn contacts_beside_terrains_are_all_contacts() {
    let (mut terrains_seen, mut contacts_seen) = (0, 0);
    for seed in 0..cases(3_000, 100_000) {
        let soup = Soup::crumpled(&mut Random::new(seed as u64));
        let budget = Budget::unlimited();
        let (positions, triangles) = (&soup.positions, &soup.triangles);
        let has_area = |&t: &u32| {
            let [a, b, c] = triangles[t as usize].map(|v| positions[v as usize]);
            !are_collinear(a, b, c)
        };
        let ids: Vec<u32> = (0..triangles.len() as u32).filter(has_area).collect();
        let bvh = Bvh::build(positions, triangles, Some(&ids), &budget).unwrap();
        let terrains = Terrains::find(positions, triangles, &soup.open_vertices(), &budget).unwrap();
        let search = |terrains| {
            let all = Search::All { keep: usize::MAX };
            self_contacts(positions, triangles, &bvh, terrains, all, &budget).unwrap()
        };
        let found = search(Some(&terrains));
        assert_eq!(found, search(None), "seed {seed}");
        terrains_seen += (0..positions.len() as u32).filter(|&v| terrains.holds(v)).count();
        contacts_seen += found.list.len();
    }
    assert!(terrains_seen > 1_000 && contacts_seen > 1_000, "{terrains_seen} {contacts_seen}");
}

#[test]
fn large_fans_are_searched_without_looking_at_their_pairs() {
    let count = 1 << 16;
    for bottom in [DVec3::ZERO, -DVec3::Z] {
        let mut soup = double_cone(count, bottom);
        let search = |soup: &Soup| {
            let budget = Budget::unlimited();
            let bvh = Bvh::build(&soup.positions, &soup.triangles, None, &budget).unwrap();
            let all = Search::All { keep: 10 };
            let found = self_contacts(&soup.positions, &soup.triangles, &bvh, None, all, &budget).unwrap();
            (found, budget.work_used())
        };
        let (found, work) = search(&soup);
        assert_eq!(found, Contacts::default());
        assert!(work < 800 * u64::from(count), "{work} work units");
        // A rim point moved behind its neighbours folds both fans over themselves.
        soup.positions[100] = soup.positions[103] * 0.5 + soup.positions[104] * 0.5;
        let (found, _) = search(&soup);
        assert!(found.count > 0 && found.list.iter().all(|c| (2 * 90..2 * 110).contains(&c.a)), "{found:?}");
    }
}

#[test]
fn the_first_contacts_are_kept_and_all_are_counted() {
    let soup = Soup::on_grid(&mut Random::new(5), 300, [4, 4, 4], 0.3);
    let all = soup.search(Search::All { keep: usize::MAX });
    assert_eq!(all.list.len() as u64, all.count);
    for keep in [0, 1, 7, 1000] {
        let some = soup.search(Search::All { keep });
        assert_eq!(some.count, all.count);
        assert_eq!(some.list, all.list[..keep.min(all.list.len())]);
    }
}

#[test]
fn results_are_the_same_with_1_2_and_8_threads() {
    let soup = Soup::on_grid(&mut Random::new(9), 1_500, [60, 60, 60], 0.1);
    for search in [Search::First, Search::All { keep: 50 }] {
        let [one, two, eight] = [1, 2, 8].map(|threads| par::with_threads(threads, || soup.search(search)));
        assert!(one.count > 0 && one == two && one == eight, "{search:?}");
    }
}
