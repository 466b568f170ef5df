//! What is near each other against all pairs of features, and whether the answer depends on how the mesh is written.

use crate::random::Random;
use crate::support::{cases, on_all_cores};
use meshmend::analysis::{AnalyzeOptions, DefectCode, NearSearch, ProximityTest, analyze};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::par;
use meshmend::spatial::Contacts;
use std::collections::{BTreeMap, BTreeSet};

const EPSILON: f64 = 0.05;

/// A test and the vertices of both features.
pub(crate) type Told = (ProximityTest, Vec<u32>);

/// A few triangles between points that are mostly near others, near segments between them or near triangles.
fn random_mesh(random: &mut Random) -> Soup {
    let mut positions: Vec<DVec3> = Vec::new();
    let small = |random: &mut Random| {
        DVec3::from_array(std::array::from_fn(|_| (random.unit() - 0.5) * 1.5 * EPSILON))
    };
    for _ in 0..6 + random.below(18) {
        let old = |random: &mut Random, positions: &[DVec3]| positions[random.below(positions.len())];
        let place = if positions.len() < 3 || random.one_in(4) {
            DVec3::new(random.unit(), random.unit(), random.unit())
        } else {
            let corners = [0; 3].map(|_| old(random, &positions));
            let share = if random.one_in(3) { 0.0 } else { random.unit() };
            let other = if random.one_in(2) { 0.0 } else { random.unit() * (1.0 - share) };
            corners[0] + (corners[1] - corners[0]) * share + (corners[2] - corners[0]) * other + small(random)
        };
        positions.push(place);
    }
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut seen = BTreeSet::new();
    for _ in 0..2 + random.below(10) {
        let corners = [0; 3].map(|_| random.below(positions.len()) as u32);
        let set = BTreeSet::from(corners);
        if set.len() == 3 && seen.insert(set) {
            triangles.push(corners);
        }
    }
    if let Some(&corners) = triangles.first().filter(|_| random.one_in(4)) {
        // The same triangle nearly once more.
        triangles.push(corners.map(|v| {
            positions.push(positions[v as usize] + small(random) * 0.3);
            positions.len() as u32 - 1
        }));
    }
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

pub(crate) fn told(mesh: &Soup) -> BTreeMap<Told, usize> {
    let near = NearSearch::Within(EPSILON);
    let options = AnalyzeOptions { samples: 100_000, near, ..AnalyzeOptions::default() };
    let told = analyze(mesh, Some(&Contacts::default()), &options, &Budget::unlimited()).unwrap();
    let mut pairs = BTreeMap::new();
    let finding = told.findings.iter().find(|f| f.code == DefectCode::Near);
    for witness in finding.into_iter().flat_map(|f| &f.witnesses) {
        let mut vertices: Vec<u32> = witness.vertices.iter().map(|v| v.index).collect();
        vertices.sort_unstable();
        *pairs.entry((witness.test.unwrap(), vertices)).or_default() += 1;
    }
    let counts = told.proximity.map_or([0; 6], |proximity| proximity.near);
    assert_eq!(counts.iter().sum::<u64>(), finding.map_or(0, |f| f.count));
    pairs
}

/// Every pair of features, from the definitions.
struct Naive<'m> {
    positions: &'m [DVec3],
    reach: BTreeMap<u32, f64>,
}

impl Naive<'_> {
    fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    /// Whether two features (convex hulls of vertices) are within the reach of all their vertices.
    fn are_within(&self, a: &[u32], b: &[u32]) -> bool {
        let reach = a.iter().chain(b).map(|v| self.reach[v]).fold(f64::INFINITY, f64::min);
        let [p, q] = [a, b].map(|f| f.iter().map(|&v| self.at(v)).collect::<Vec<_>>());
        distance(&p, &q) <= reach
    }

    /// Near, and no smaller features of both are.
    fn is_told(&self, a: &[u32], b: &[u32]) -> bool {
        let is_derived = subsets(a).iter().any(|x| {
            subsets(b).iter().any(|y| x.len() + y.len() < a.len() + b.len() && self.are_within(x, y))
        });
        self.are_within(a, b) && !is_derived
    }
}

/// The features that a feature consists of, itself included.
fn subsets(of: &[u32]) -> Vec<Vec<u32>> {
    (1u32..1 << of.len())
        .map(|bits| (0..of.len()).filter(|&i| bits >> i & 1 == 1).map(|i| of[i]).collect())
        .collect()
}

/// The distance of the hulls of two to four points in all, or of a point and a triangle: the smallest of the distances of
/// the flats through all subsets where these are met inside.
fn distance(p: &[DVec3], q: &[DVec3]) -> f64 {
    match (p, q) {
        ([p], [q]) => (*p - *q).length(),
        ([p], [a, b]) | ([a, b], [p]) => to_segment(*p, *a, *b),
        ([p], [a, b, c]) | ([a, b, c], [p]) => to_triangle(*p, [*a, *b, *c]),
        ([a, b], [c, d]) => {
            let ends = [
                to_segment(*a, *c, *d),
                to_segment(*b, *c, *d),
                to_segment(*c, *a, *b),
                to_segment(*d, *a, *b),
            ];
            let normal = (*b - *a).cross(*d - *c);
            // Seen along the common normal the segments cross, or an end is nearest.
            let side = |from: DVec3, to: DVec3, p: DVec3| normal.dot((to - from).cross(p - from));
            let is_crossed =
                side(*a, *b, *c) * side(*a, *b, *d) < 0.0 && side(*c, *d, *a) * side(*c, *d, *b) < 0.0;
            let between = (normal.normalize().dot(*c - *a)).abs();
            ends.into_iter().fold(if is_crossed { between } else { f64::INFINITY }, f64::min)
        }
        _ => f64::INFINITY,
    }
}

fn to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let share = ((p - a).dot(b - a) / (b - a).dot(b - a)).clamp(0.0, 1.0);
    (p - a.lerp(b, share)).length()
}

fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a).normalize();
    let is_left = |from: DVec3, to: DVec3| normal.dot((to - from).cross(p - from)) >= 0.0;
    let rim = to_segment(p, a, b).min(to_segment(p, b, c)).min(to_segment(p, c, a));
    if is_left(a, b) && is_left(b, c) && is_left(c, a) { normal.dot(p - a).abs().min(rim) } else { rim }
}

pub(crate) fn expected(mesh: &Soup) -> BTreeMap<Told, usize> {
    let mut reach: BTreeMap<u32, f64> = BTreeMap::new();
    let mut features: BTreeSet<Vec<u32>> = BTreeSet::new();
    let mut faces: BTreeSet<BTreeSet<u32>> = BTreeSet::new();
    for &t in &mesh.triangles {
        let mut sorted = t.to_vec();
        sorted.sort_unstable();
        faces.insert(BTreeSet::from(t));
        features.extend(subsets(&sorted));
        for [u, v] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
            let half = (mesh.positions[u as usize] - mesh.positions[v as usize]).length() / 2.0;
            for v in [u, v] {
                let reach = reach.entry(v).or_insert(EPSILON);
                *reach = reach.min(half);
            }
        }
    }
    let naive = Naive { positions: &mesh.positions, reach };
    let mut pairs = BTreeMap::new();
    for a in &features {
        for b in features.iter().filter(|b| a.len() < b.len() || (a.len() == b.len() && a < b)) {
            let all: BTreeSet<u32> = a.iter().chain(b).copied().collect();
            let is_joined = all.len() < a.len() + b.len() || faces.iter().any(|face| all.is_subset(face));
            let test = match (a.len(), b.len()) {
                (1, 1) => ProximityTest::VertexVertex,
                (1, 2) => ProximityTest::VertexEdge,
                (1, 3) => ProximityTest::VertexFace,
                (2, 2) => ProximityTest::EdgeEdge,
                (3, 3) => ProximityTest::FaceFace,
                _ => continue,
            };
            let is_told = if test == ProximityTest::FaceFace {
                let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
                let is_near = |i: usize, j: usize| naive.are_within(&[a[i]], &[b[j]]);
                orders.iter().any(|order| (0..3).all(|i| is_near(i, order[i])))
            } else {
                naive.is_told(a, b)
            };
            if !is_joined && is_told {
                *pairs.entry((test, all.into_iter().collect())).or_default() += 1;
            }
        }
    }
    pairs
}

#[test]
fn analysis_of_what_is_near_is_what_all_pairs_of_features_give() {
    let rounds = cases(3_000, 100_000);
    let counts = on_all_cores(rounds, |round| {
        let mesh = random_mesh(&mut Random::new(round as u64 + 31));
        let (told, expected) = (told(&mesh), expected(&mesh));
        assert_eq!(told, expected, "round {round}: {mesh:?}");
        let mut counts: BTreeMap<ProximityTest, usize> = BTreeMap::new();
        for ((test, _), count) in told {
            *counts.entry(test).or_default() += count;
        }
        counts
    });
    let mut sums: BTreeMap<ProximityTest, usize> = BTreeMap::new();
    counts.into_iter().flatten().for_each(|(test, count)| *sums.entry(test).or_default() += count);
    println!("| near features against all pairs | {rounds} meshes | {sums:?} |");
    assert_eq!(sums.len(), 5, "each test is met: {sums:?}");
    assert!(sums.values().all(|&count| count > rounds / 100), "{sums:?}");
}

#[test]
fn analysis_of_what_is_near_does_not_depend_on_numbers_or_axes_or_threads() {
    on_all_cores(cases(1_000, 30_000), |round| {
        let mut random = Random::new(round as u64 + 77_000);
        let mesh = random_mesh(&mut random);
        let mut tests: Vec<ProximityTest> = Vec::new();
        told(&mesh).into_iter().for_each(|((test, _), n)| tests.extend(std::iter::repeat_n(test, n)));
        let mut changed = mesh.clone();
        for p in &mut changed.positions {
            *p = DVec3::new(-p.y, p.z, -p.x);
        }
        for i in (1..changed.triangles.len()).rev() {
            changed.triangles.swap(i, random.below(i + 1));
        }
        let n = changed.positions.len() as u32;
        changed.positions.reverse();
        for t in &mut changed.triangles {
            *t = t.map(|v| n - 1 - v);
            t.rotate_left(random.below(3));
        }
        let mut again: Vec<ProximityTest> = Vec::new();
        told(&changed).into_iter().for_each(|((test, _), n)| again.extend(std::iter::repeat_n(test, n)));
        assert_eq!(tests, again, "round {round}: {mesh:?}");
    });
    let mut many = Soup::default();
    let mut random = Random::new(4);
    for i in 0..2_000 {
        let mesh = random_mesh(&mut random);
        let first = many.positions.len() as u32;
        let offset = DVec3::new(f64::from(i % 50) * 0.7, f64::from(i / 50) * 0.7, 0.0);
        many.positions.extend(mesh.positions.iter().map(|&p| p + offset));
        many.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    many.face_count = many.triangles.len() as u32;
    let [one, two, eight] = [1, 2, 8].map(|threads| par::with_threads(threads, || told(&many)));
    assert!(one == two && one == eight && one.len() > 1_000, "{}", one.len());
}
