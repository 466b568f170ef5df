//! Single repair steps on random soups of points with small whole coordinates, where lines and planes are common.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::repair::{Draft, collinear, degenerate, orient, weld};
use std::collections::BTreeMap;

type Point = [i64; 3];

/// Triangles between lattice points of a box that is flat more often than not; welded, without repeated corners.
fn random_draft(random: &mut Random) -> Draft {
    let size = [4, random.pick(&[0, 0, 2]), random.pick(&[0, 1])];
    let point_count = 4 + random.below(8);
    let positions: Vec<DVec3> =
        (0..point_count).map(|_| DVec3::from_array(size.map(|s| f64::from(random.between(0, s))))).collect();
    let triangles: Vec<[u32; 3]> = (0..3 + random.below(12))
        .map(|_| std::array::from_fn(|_| random.below(point_count) as u32))
        .collect();
    let mut draft = Draft {
        vertex_origin: (0..point_count as u32).collect(),
        positions,
        triangle_origin: (0..triangles.len() as u32).collect(),
        triangles,
        two_sided: Vec::new(),
        blends: Default::default(),
        polygons: Default::default(),
    };
    weld::weld(&mut draft, &Budget::unlimited()).unwrap();
    degenerate::drop_degenerate(&mut draft);
    draft
}

fn corners(draft: &Draft, t: usize) -> [Point; 3] {
    draft.corners(t).map(|p| p.to_array().map(|x| x as i64))
}

fn cross([a, b, c]: [Point; 3]) -> Point {
    let (u, v): (Point, Point) = (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
    std::array::from_fn(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// For each piece of an edge between neighbouring lattice points, whether an odd number of triangles has it: the
/// boundary of the surface as a point set.
fn boundary(draft: &Draft) -> Vec<(Point, Point)> {
    let mut is_odd: BTreeMap<(Point, Point), bool> = BTreeMap::new();
    for t in 0..draft.triangles.len() {
        let [a, b, c] = corners(draft, t);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (from.min(to), from.max(to));
            let step: Point = std::array::from_fn(|k| to[k] - from[k]);
            let pieces = step.iter().fold(0, |g, s| gcd(g, s.abs()));
            let at = |i: i64| std::array::from_fn(|k| from[k] + step[k] / pieces * i);
            for i in 0..pieces {
                *is_odd.entry((at(i), at(i + 1))).or_default() ^= true;
            }
        }
    }
    is_odd.into_iter().filter(|&(_, odd)| odd).map(|(piece, _)| piece).collect()
}

fn area(draft: &Draft) -> f64 {
    (0..draft.triangles.len())
        .map(|t| (cross(corners(draft, t)).iter().map(|x| x * x).sum::<i64>() as f64).sqrt() / 2.0)
        .sum()
}

#[test]
fn removing_collinear_triangles_opens_nothing_and_keeps_the_area() {
    let mut random = Random::new(4);
    let mut removed = 0;
    for case in 0..cases(20_000, 400_000) {
        let mut draft = random_draft(&mut random);
        let before = draft.clone();
        let changes = collinear::split_collinear(&mut draft, &Budget::unlimited()).unwrap();
        removed += changes.count("triangles_dropped");
        assert_eq!(draft.check(), Vec::<String>::new(), "case {case}");
        assert_eq!(boundary(&draft), boundary(&before), "case {case}: {before:?}");
        assert!((area(&draft) - area(&before)).abs() < 1e-9, "case {case}: {before:?}");
        for t in 0..draft.triangles.len() {
            assert_ne!(cross(corners(&draft, t)), [0; 3], "case {case}: {before:?} became {draft:?}");
        }
    }
    assert!(removed > 10_000, "only {removed} triangles were collinear");
}

/// A closed band of five to nine triangles, each turned around by chance, and some triangles that hang on it. With an odd
/// number of triangles it is a Möbius band.
fn random_band(random: &mut Random) -> Draft {
    let n = 5 + random.below(5) as u32;
    let mut triangles: Vec<[u32; 3]> = (0..n).map(|i| [i, (i + 1) % n, (i + 2) % n]).collect();
    triangles.extend((0..random.below(4)).map(|_| std::array::from_fn(|_| random.below(12) as u32)));
    for t in &mut triangles {
        if random.one_in(2) {
            t.swap(0, 1);
        }
    }
    let mut draft = Draft {
        positions: (0..12).map(|v| DVec3::new(f64::from(v), f64::from(v * v), 0.0)).collect(),
        vertex_origin: (0..12).collect(),
        triangle_origin: (0..triangles.len() as u32).collect(),
        triangles,
        two_sided: Vec::new(),
        blends: Default::default(),
        polygons: Default::default(),
    };
    degenerate::drop_degenerate(&mut draft);
    draft
}

#[test]
fn only_edges_counted_as_conflicts_have_two_triangles_in_one_direction_after_orienting() {
    let mut random = Random::new(5);
    let (mut conflicts, mut peaceful) = (0, 0);
    for case in 0..cases(5_000, 100_000) {
        let mut draft = random_band(&mut random);
        let before = draft.clone();
        let counted = orient::orient(&mut draft, &Budget::unlimited()).unwrap().count("edges_in_conflict");
        let mut edges: BTreeMap<(u32, u32), Vec<bool>> = BTreeMap::new();
        for &[a, b, c] in &draft.triangles {
            for (u, v) in [(a, b), (b, c), (c, a)] {
                edges.entry((u.min(v), u.max(v))).or_default().push(u < v);
            }
        }
        let same_way = edges.values().filter(|e| e.len() == 2 && e[0] == e[1]).count() as u64;
        assert_eq!(same_way, counted, "case {case}: {before:?}");
        conflicts += counted;
        peaceful += u64::from(counted == 0);
    }
    assert!(conflicts > 1_000 && peaceful > 1_000, "{conflicts} conflicts, {peaceful} soups without");
}
