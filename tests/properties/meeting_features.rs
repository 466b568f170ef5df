//! The vertices, edges and faces in which a mesh meets itself exactly, against every pair of features in integers.

use crate::random::Random;
use crate::support::{cases, on_all_cores};
use meshmend::analysis::{AnalyzeOptions, NearSearch, TestCounts, analyze};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::{Polygons, Soup};
use std::collections::BTreeSet;

type Point = [i64; 3];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Point, b: Point) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Six times the volume of a tetrahedron.
fn volume([a, b, c, d]: [Point; 4]) -> i64 {
    dot(cross(minus(b, a), minus(c, a)), minus(d, a))
}

fn is_between(p: Point, [a, b]: [Point; 2]) -> bool {
    cross(minus(b, a), minus(p, a)) == [0; 3] && dot(minus(a, p), minus(b, p)) < 0
}

/// Strictly inside a triangle and in its plane.
fn is_inside(p: Point, [a, b, c]: [Point; 3]) -> bool {
    let normal = cross(minus(b, a), minus(c, a));
    let turn = |from: Point, to: Point| dot(normal, cross(minus(to, from), minus(p, from)));
    dot(normal, minus(p, a)) == 0 && turn(a, b) > 0 && turn(b, c) > 0 && turn(c, a) > 0
}

/// Strictly inside both.
fn do_cross([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let normal = cross(minus(b, a), minus(d, c));
    let side =
        |from: Point, to: Point, p: Point| dot(normal, cross(minus(to, from), minus(p, from))).signum();
    normal != [0; 3]
        && dot(normal, minus(c, a)) == 0
        && side(a, b, c) * side(a, b, d) < 0
        && side(c, d, a) * side(c, d, b) < 0
}

fn passes_through([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| volume([p, q, from, to]).signum());
    turns[0] != 0
        && turns == [turns[0]; 3]
        && volume([a, b, c, p]).signum() * volume([a, b, c, q]).signum() < 0
}

/// Triangles and parallelograms over points of a small grid, without repeats and without area of 0; the corners of each.
struct Grid {
    points: Vec<Point>,
    faces: Vec<Vec<u32>>,
}

impl Grid {
    fn random(random: &mut Random) -> Self {
        let heights = 1 + random.below(3);
        let mut points: BTreeSet<Point> = BTreeSet::new();
        for _ in 0..5 + random.below(6) {
            points.insert([random.below(4), random.below(4), random.below(heights)].map(|c| c as i64));
        }
        let points: Vec<Point> = points.into_iter().collect();
        let (mut faces, mut seen) = (Vec::new(), BTreeSet::new());
        for _ in 0..2 + random.below(6) {
            let corners = [0; 3].map(|_| random.below(points.len()) as u32);
            let [a, b, c] = corners.map(|v| points[v as usize]);
            if cross(minus(b, a), minus(c, a)) == [0; 3] {
                continue;
            }
            let fourth = points.iter().position(|&d| d == minus(a, minus(b, c)));
            let face = [&corners[..], &fourth.map(|d| d as u32).into_iter().collect::<Vec<_>>()].concat();
            // No two faces have three vertices in common, as repeats are told as such.
            let triples = (0..face.len()).map(|gap| {
                let others = face.iter().enumerate().filter(|&(k, _)| face.len() == 3 || k != gap);
                others.map(|(_, &v)| v).collect::<BTreeSet<u32>>()
            });
            let triples: BTreeSet<BTreeSet<u32>> = triples.collect();
            if triples.is_disjoint(&seen) {
                seen.extend(triples);
                faces.push(face);
            }
        }
        Self { points, faces }
    }

    fn at(&self, v: u32) -> Point {
        self.points[v as usize]
    }

    /// Parallelograms are polygons with a diagonal each.
    fn soup(&self) -> Soup {
        let mut soup = Soup {
            positions: self.points.iter().map(|p| DVec3::from_array(p.map(|c| c as f64))).collect(),
            face_count: self.faces.len() as u32,
            polygons: Polygons { starts: vec![0], ..Polygons::default() },
            ..Soup::default()
        };
        for (corners, f) in self.faces.iter().zip(0..) {
            if corners.len() > 3 {
                soup.polygons.faces.push(f);
                soup.polygons.corners.extend(corners);
                soup.polygons.starts.push(soup.polygons.corners.len() as u32);
                soup.polygons.first_triangles.push(soup.triangles.len() as u32);
            }
            for pair in corners[1..].windows(2) {
                soup.triangles.push([corners[0], pair[0], pair[1]]);
                soup.triangle_face.push(f);
            }
        }
        soup
    }

    /// Pairs of features, each once, that are not of one face and have no common vertex.
    fn expected(&self) -> TestCounts {
        let used: BTreeSet<u32> = self.faces.iter().flatten().copied().collect();
        let sides = |f: &Vec<u32>| {
            let next = |k: usize| f[(k + 1) % f.len()];
            (0..f.len()).map(|k| [f[k].min(next(k)), f[k].max(next(k))]).collect::<Vec<_>>()
        };
        let edges: BTreeSet<[u32; 2]> = self.faces.iter().flat_map(sides).collect();
        let ends = |e: [u32; 2]| e.map(|v| self.at(v));
        let parts = |f: &Vec<u32>| {
            f[1..].windows(2).map(|p| [f[0], p[0], p[1]].map(|v| self.at(v))).collect::<Vec<_>>()
        };
        let diagonals = |f: &Vec<u32>| {
            let own = sides(f);
            let all = f[1..].windows(2).map(|p| [f[0].min(p[1]), f[0].max(p[1])]).collect::<Vec<_>>();
            all.into_iter().filter(|e| !own.contains(e)).collect::<Vec<_>>()
        };
        let mut counts = [0; 6];
        for &v in &used {
            let p = self.at(v);
            counts[1] += edges.iter().filter(|&&e| is_between(p, ends(e))).count() as u64;
            for f in &self.faces {
                let is_in = parts(f).into_iter().any(|t| is_inside(p, t))
                    || diagonals(f).into_iter().any(|e| is_between(p, ends(e)));
                counts[2] += u64::from(is_in && !f.contains(&v));
            }
        }
        for &e in &edges {
            counts[3] += edges.range(e..).filter(|&&h| do_cross(ends(e), ends(h))).count() as u64;
            for f in &self.faces {
                let is_through = parts(f).into_iter().any(|t| passes_through(ends(e), t))
                    || diagonals(f).into_iter().any(|d| {
                        !d.iter().any(|v| e.contains(v))
                            && do_cross(ends(e), ends(d))
                            && parts(f)
                                .iter()
                                .all(|&[a, b, c]| e.iter().any(|&v| volume([a, b, c, self.at(v)]) != 0))
                    });
                counts[4] += u64::from(is_through);
            }
        }
        counts
    }
}

fn told(soup: &Soup) -> [TestCounts; 2] {
    let options = AnalyzeOptions { near: NearSearch::Within(1e-9), ..AnalyzeOptions::default() };
    let told = analyze(soup, None, &options, &Budget::unlimited()).unwrap().proximity.unwrap();
    [told.intersect.unwrap(), told.touch.unwrap()]
}

#[test]
fn analysis_counts_what_meets_by_features_as_all_pairs_of_features_do() {
    let rounds = cases(4_000, 200_000);
    let sums = on_all_cores(rounds, |round| {
        let grid = Grid::random(&mut Random::new(round as u64 + 9_100));
        if grid.faces.is_empty() {
            return [0; 6];
        }
        let [intersect, touch] = told(&grid.soup());
        let sum: TestCounts = std::array::from_fn(|i| intersect[i] + touch[i]);
        assert_eq!(sum, grid.expected(), "round {round}: {:?} {:?}", grid.points, grid.faces);
        sum
    });
    let all: TestCounts = std::array::from_fn(|i| sums.iter().map(|sum| sum[i]).sum());
    println!("| features that meet against all pairs | {rounds} meshes | {all:?} |");
    assert!(all[1..5].iter().all(|&count| count > rounds as u64 / 20), "{all:?}");
}

#[test]
fn a_vertex_on_an_edge_is_one_pair_however_many_faces_show_it() {
    // Two tetrahedra; a tip of one is in the middle of an edge of the other.
    let points: Vec<Point> =
        vec![[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [2, 0, 0], [1, -3, -3], [2, -3, -4], [3, -3, -3]];
    let tetrahedron = |[a, b, c, d]: [u32; 4]| [[a, c, b], [a, b, d], [b, c, d], [c, a, d]].map(Vec::from);
    let faces = [tetrahedron([0, 1, 2, 3]), tetrahedron([4, 5, 6, 7])].concat();
    let soup = Grid { points, faces }.soup();
    assert_eq!(told(&soup), [[0; 6], [0, 1, 0, 0, 0, 0]]);
    let analysis = analyze(&soup, None, &AnalyzeOptions::default(), &Budget::unlimited()).unwrap();
    let touch = analysis.findings.iter().find(|f| f.code == meshmend::analysis::DefectCode::Touch).unwrap();
    for witness in &touch.witnesses {
        let vertices: Vec<u32> = witness.vertices.iter().map(|v| v.index).collect();
        assert_eq!((vertices, witness.position), (vec![4, 0, 1], Some(DVec3::new(2.0, 0.0, 0.0))));
    }
}

#[test]
fn a_diagonal_of_a_polygon_is_inside_its_face() {
    let square = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]];
    for turn in 0..4 {
        let mut face = vec![0, 1, 2, 3];
        face.rotate_left(turn);
        // A triangle stands with a corner on the middle of the square, and one with an edge through it.
        let with = |more: [Point; 3]| {
            let points = square.iter().copied().chain(more).collect();
            told(&Grid { points, faces: vec![face.clone(), vec![4, 5, 6]] }.soup())
        };
        let touching = with([[2, 2, 0], [1, 2, 5], [3, 2, 5]]);
        assert_eq!(touching, [[0; 6], [0, 0, 1, 0, 0, 0]], "start {turn}");
        let through = with([[2, 2, -1], [2, 2, 5], [9, 8, 5]]);
        assert_eq!(through, [[0, 0, 0, 0, 2, 0], [0; 6]], "start {turn}");
    }
}
