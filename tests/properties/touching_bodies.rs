//! Bodies that touch in vertices and edges, as cubes of a grid do: drawn apart or joined, they are certified, and in as
//! many pieces as the grid says.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::encode;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::formats::Encoding;
use meshmend::mesh::UnionFind;
use meshmend::pipeline::{Answer, Contact, Operation, Options, Outcome, WrapChoices, run};
use std::collections::{BTreeMap, BTreeSet};

type Cell = [i32; 3];

/// The cells of a solid inside a box that is free of them at its sides.
#[derive(Debug, Clone)]
struct Grid {
    solid: BTreeSet<Cell>,
}

impl Grid {
    fn random(random: &mut Random) -> Self {
        let size = [0; 3].map(|_| random.between(2, 3));
        let mut solid = BTreeSet::new();
        let one_in = 2 + random.below(3);
        for cell in cells(size.map(|n| n + 1)) {
            let is_inside = (0..3).all(|k| cell[k] >= 1 && cell[k] <= size[k]);
            if is_inside && random.one_in(one_in) {
                solid.insert(cell);
            }
        }
        solid.insert([1; 3]);
        Self { solid }
    }

    /// The squares between a cell of the solid and one that is not, as these two and the corners, counter-clockwise
    /// for whoever looks at the solid.
    fn squares(&self) -> Vec<(Cell, Cell, [Cell; 4])> {
        let mut squares = Vec::new();
        for &cell in &self.solid {
            for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
                let mut beyond = cell;
                beyond[axis] += 2 * side - 1;
                if self.solid.contains(&beyond) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| {
                    let mut p = cell;
                    p[axis] += side;
                    p[u] += i;
                    p[v] += j;
                    p
                });
                if side == 0 {
                    corners.reverse();
                }
                squares.push((cell, beyond, corners));
            }
        }
        squares
    }

    /// Number of surfaces when squares hang together across edges: of four at one edge, the two at one cell that is solid
    /// (or `across_void`, that is not).
    fn surfaces(&self, across_void: bool) -> usize {
        let squares = self.squares();
        let mut at_edges: BTreeMap<[Cell; 2], Vec<usize>> = BTreeMap::new();
        for (i, (.., corners)) in squares.iter().enumerate() {
            for k in 0..4 {
                let (a, b) = (corners[k], corners[(k + 1) % 4]);
                at_edges.entry([a.min(b), a.max(b)]).or_default().push(i);
            }
        }
        let mut sets = UnionFind::new(squares.len());
        let cell = |i: usize| if across_void { squares[i].1 } else { squares[i].0 };
        for at in at_edges.values() {
            for (&i, &j) in at.iter().flat_map(|i| at.iter().map(move |j| (i, j))) {
                if at.len() == 2 || cell(i) == cell(j) {
                    sets.unite(i as u32, j as u32);
                }
            }
        }
        sets.into_components().count as usize
    }

    /// Its surface, welded, the triangles turned outward.
    fn surface(&self) -> RawSoup {
        let mut ids = BTreeMap::new();
        let mut soup = RawSoup { positions: Vec::new(), triangles: Vec::new() };
        for (.., corners) in self.squares() {
            let [a, b, c, d] = corners.map(|p| {
                let next = ids.len() as u32;
                *ids.entry(p).or_insert(next)
            });
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
        soup.positions = vec![[0.0; 3]; ids.len()];
        for (place, id) in ids {
            soup.positions[id as usize] = place.map(f64::from);
        }
        soup
    }
}

fn cells(size: Cell) -> impl Iterator<Item = Cell> {
    let [x, y, z] = size;
    (0..=x).flat_map(move |i| (0..=y).flat_map(move |j| (0..=z).map(move |k| [i, j, k])))
}

fn repaired(soup: &RawSoup, contact: Contact, encoding: Encoding) -> Answer {
    let wrap = WrapChoices { cells: Some(16), ..WrapChoices::default() };
    let options = Options { contact, wrap, ..Options::default() };
    run(Operation::Repair, encode(soup, encoding), &options, &Budget::unlimited()).unwrap()
}

/// Number of shells of a result that was certified without being rebuilt.
fn shells(answer: &Answer) -> Option<usize> {
    let is_local = matches!(answer.report.outcome, Some(Outcome::Repaired | Outcome::Identical));
    let certificate = answer.report.certificate.as_ref().filter(|_| is_local)?;
    assert!(certificate.is_printable());
    Some(certificate.shells.len())
}

/// Moves a vertex by a matrix, so that faces are not along the axes.
fn sheared(soup: &RawSoup, random: &mut Random) -> RawSoup {
    let shear = [0; 3].map(|_| f64::from(random.between(-2, 2)) / 8.0);
    let place = |&[x, y, z]: &[f64; 3]| [x + shear[0] * y, y + shear[1] * z, z + shear[2] * x];
    RawSoup { positions: soup.positions.iter().map(place).collect(), triangles: soup.triangles.clone() }
}

#[test]
fn touching_bodies_of_a_grid_come_apart_into_its_parts() {
    let mut random = Random::new(51);
    let count = cases(200, 20_000);
    for _ in 0..count {
        let grid = Grid::random(&mut random);
        let soup = sheared(&grid.surface(), &mut random);
        let answer = repaired(&soup, Contact::Open, random.pick(&[Encoding::StlBinary, Encoding::Obj]));
        let expected = grid.surfaces(false);
        assert_eq!(shells(&answer), Some(expected), "{grid:?} {:?}", answer.report.actions);
    }
    println!("| random grids of cubes drawn apart | {count} | all certified, in the parts of the grid |");
}

#[test]
fn touching_bodies_of_a_grid_become_one_where_they_meet() {
    let mut random = Random::new(52);
    let count = cases(200, 20_000);
    let (mut whole, mut apart) = (0, 0);
    for _ in 0..count {
        let grid = Grid::random(&mut random);
        let soup = sheared(&grid.surface(), &mut random);
        let answer = repaired(&soup, Contact::Join, random.pick(&[Encoding::StlBinary, Encoding::Obj]));
        let got = shells(&answer);
        assert!(got.is_some(), "{grid:?} {:?}", answer.report.actions);
        let is_whole = got <= Some(grid.surfaces(true));
        whole += u32::from(is_whole);
        apart += u32::from(!is_whole);
    }
    assert!(whole > 4 * apart, "{whole} joined, {apart} drawn apart");
    println!(
        "| random grids of cubes joined | {count} | all certified, {whole} of them joined at all edges |"
    );
}

#[test]
fn two_touching_cubes_become_one_solid_or_two() {
    let pair = |other: Cell| Grid { solid: BTreeSet::from([[1; 3], other]) };
    for other in [[2, 2, 1], [2, 2, 2]] {
        let soup = pair(other).surface();
        for encoding in [Encoding::StlBinary, Encoding::Off] {
            assert_eq!(shells(&repaired(&soup, Contact::Open, encoding)), Some(2), "{other:?}");
            let joined = repaired(&soup, Contact::Join, encoding);
            assert_eq!(shells(&joined), Some(1), "{other:?} {:?}", joined.report.actions);
        }
    }
}

#[test]
fn a_ring_that_touches_itself_along_an_edge_stays_one_body_either_way() {
    // Cubes in a plane, two of which meet in an edge although they hang together around it.
    let solid = BTreeSet::from([[1, 1, 1], [2, 1, 1], [3, 1, 1], [3, 2, 1], [2, 3, 1], [3, 3, 1], [1, 2, 1]]);
    let grid = Grid { solid };
    for contact in [Contact::Open, Contact::Join] {
        let answer = repaired(&grid.surface(), contact, Encoding::StlBinary);
        assert_eq!(shells(&answer), Some(1), "{contact:?} {:?}", answer.report.actions);
    }
}
