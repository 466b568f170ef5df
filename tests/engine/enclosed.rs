//! Bodies whose triangles turn as it happened, with walls inside: what they enclose becomes solid, and nothing visible is lost.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::repair::{answer, coarse, repaired};
use crate::solids::cuboid;
use meshmend::pipeline::{Answer, Fidelity, Outcome};
use std::f64::consts::TAU;

const SIDE: f64 = 10.0;

/// Faces of three or more corners.
#[derive(Default)]
struct Faces {
    positions: Vec<[f64; 3]>,
    faces: Vec<Vec<u32>>,
}

impl Faces {
    /// Each face turned by chance, and a tetrahedron that passes through what is at `top`, so that triangles meet.
    fn turned_by_chance(mut self, seed: u64, top: f64) -> Self {
        let mut random = Random::new(seed);
        for face in &mut self.faces {
            if random.one_in(2) {
                face.reverse();
            }
        }
        let first = self.positions.len() as u32;
        self.positions.extend([
            [3.0, 3.0, 5.0],
            [9.0, 4.0, top + 6.0],
            [2.0, 9.0, top + 7.0],
            [8.0, 8.0, top + 8.0],
        ]);
        let sides = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        self.faces.extend(sides.map(|t: [u32; 3]| t.map(|v| first + v).to_vec()));
        self
    }

    /// Each face as triangles at its first corner.
    fn split(mut self) -> Self {
        let triangles = |face: &Vec<u32>| -> Vec<Vec<u32>> {
            face[1..].windows(2).map(|pair| vec![face[0], pair[0], pair[1]]).collect()
        };
        self.faces = self.faces.iter().flat_map(triangles).collect();
        self
    }

    fn soup(self) -> RawSoup {
        let triangles = self.split();
        let corners = triangles.faces.iter().map(|face| [face[0], face[1], face[2]]);
        RawSoup { positions: triangles.positions.clone(), triangles: corners.collect() }
    }

    fn obj(&self) -> String {
        let vertices = self.positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let corners = |face: &Vec<u32>| face.iter().map(|v| format!(" {}", v + 1)).collect::<String>();
        vertices.chain(self.faces.iter().map(|face| format!("f{}\n", corners(face)))).collect()
    }
}

/// The squares of a block of `n` cells along each axis with all walls between them.
fn walls(n: usize) -> Faces {
    let number = |[x, y, z]: [usize; 3]| ((x * (n + 1) + y) * (n + 1) + z) as u32;
    let mut all = Faces::default();
    for place in 0..(n + 1).pow(3) {
        let at = [place / (n + 1) / (n + 1), place / (n + 1) % (n + 1), place % (n + 1)];
        all.positions.push(at.map(|k| SIDE * k as f64));
    }
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for wall in 0..(n + 1) * n * n {
            let mut low = [0; 3];
            (low[axis], low[u], low[v]) = (wall / n / n, wall / n % n, wall % n);
            let corner = |along_u: usize, along_v: usize| {
                let mut at = low;
                at[u] += along_u;
                at[v] += along_v;
                number(at)
            };
            all.faces.push(vec![corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        }
    }
    all
}

/// A block of `n` cells along each axis with all walls between them, every triangle turned by chance, and a tetrahedron that passes
/// through its top.
fn cells(n: usize, seed: u64) -> RawSoup {
    walls(n).split().turned_by_chance(seed, SIDE * n as f64).soup()
}

/// The faces of a cylinder of two slices in height and `n` around, with all walls between them.
fn cylinder(n: u32) -> Faces {
    let mut all = Faces::default();
    // Layer for layer: the middle, then around.
    for layer in 0..3 {
        let z = SIDE * f64::from(layer);
        all.positions.push([5.0, 5.0, z]);
        all.positions.extend((0..n).map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            [5.0 + RADIUS * cos, 5.0 + RADIUS * sin, z]
        }));
        for k in 0..n {
            let [middle, low, high] = [0, 1 + k, 1 + (k + 1) % n].map(|v| layer * (n + 1) + v);
            all.faces.push(vec![middle, low, high]);
            if layer < 2 {
                all.faces.push(vec![low, high, high + n + 1, low + n + 1]);
                all.faces.push(vec![middle, low, low + n + 1, middle + n + 1]);
            }
        }
    }
    all
}

/// Radius of the cylinder.
const RADIUS: f64 = 12.0;

#[test]
fn a_block_of_cells_turned_by_chance_stays_whole() {
    for (n, seed) in [(2, 1), (2, 2), (2, 3), (3, 1), (3, 2)] {
        let block = (SIDE * n as f64).powi(3);
        assert_whole(&repaired(&cells(n, seed)), block, &format!("{n} {seed}"));
    }
}

#[test]
fn a_block_of_squares_turned_by_chance_stays_whole() {
    for (n, seed) in [(2, 1), (2, 2), (3, 1)] {
        let file = walls(n).turned_by_chance(seed, SIDE * n as f64).obj();
        let block = (SIDE * n as f64).powi(3);
        assert_whole(&answer(file.as_bytes(), &coarse()), block, &format!("{n} {seed}"));
    }
}

#[test]
fn a_cylinder_of_slices_turned_by_chance_stays_whole() {
    for (n, seed) in [(16, 1), (16, 2), (48, 3)] {
        let soup = cylinder(n).split().turned_by_chance(seed, 2.0 * SIDE).soup();
        let base = f64::from(n) / 2.0 * (TAU / f64::from(n)).sin() * RADIUS * RADIUS;
        assert_whole(&repaired(&soup), base * 2.0 * SIDE, &format!("{n} {seed}"));
    }
}

/// Nothing visible is lost, and all of a body of this volume is solid; the tetrahedron adds less than its own volume.
fn assert_whole(answer: &Answer, body: f64, which: &str) {
    let report = &answer.report;
    assert_eq!(report.outcome, Some(Outcome::Repaired), "{which}: {:?}", report.refusal);
    let losses = report.losses.unwrap();
    assert!(losses.visible_loss < 1e-3 && losses.bodies_lost == 0, "{which}: {losses:?}");
    let volume = report.after.as_ref().unwrap().measures.volume.unwrap();
    let is_whole = volume > body * (1.0 - 1e-6) && volume < body + 300.0;
    assert!(is_whole, "{which}: {volume} instead of {body} and a little");
}

#[test]
fn a_cone_turned_by_chance_and_a_body_through_it_are_faithful() {
    let mut cone = Faces { positions: vec![[0.0, 0.0, 10.0], [0.0; 3]], ..Faces::default() };
    let n = 60;
    for k in 0..n {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        cone.positions.push([RADIUS * cos, RADIUS * sin, 0.0]);
        let [low, high] = [2 + k, 2 + (k + 1) % n];
        cone.faces.extend([vec![0, low, high], vec![1, high, low]]);
    }
    let report = repaired(&cone.turned_by_chance(4, 2.0).soup()).report;
    let fidelity = report.fidelity.unwrap();
    assert_eq!(fidelity.word, Fidelity::Faithful, "{:?}", fidelity.changes);
    let distance = report.distance.unwrap();
    assert!(distance.upper() < 1e-3, "{distance:?}");
}

#[test]
fn a_cavity_in_a_block_of_cells_stays() {
    // In one of the cells: nothing connects it with their walls.
    let soup = cells(2, 2).with(&cuboid([4.0; 3]).moved([13.0, 13.0, 3.0]).inside_out());
    let report = repaired(&soup).report;
    let volume = report.after.unwrap().measures.volume.unwrap();
    let expected = (2.0 * SIDE).powi(3) - 64.0;
    assert!(volume > expected && volume < expected + 300.0, "{volume} instead of {expected} and a little");
}
