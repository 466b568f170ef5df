//! Splitting a vertex whose planes stop to meet in one point: which faces become neighbours just after.
//!
//! The faces around a vertex of degree `k` are the corners of a polygon, its edges are the polygon's sides. A split is a
//! set of diagonals that do not cross: each cell is a new vertex, each diagonal a new edge. At time 0 all new edges have
//! length 0, so a split is chosen for the time after it, and another one for the opposite motion. A split is good when
//! the planes of every cell stay concurrent, every new edge has a length just after, around every new vertex the faces
//! do not cross, and no edge at one new vertex meets a face at another ([`Cone`]). Of several good splits the first in a fixed order is taken.

use super::cone::{Cone, ConePlane};
use super::direction::{Direction, is_link_simple};
use super::exact::{IntegerVector, cross, dot, negative};
use super::motion::Motion;
use super::point::Point;
use super::solid::Solid;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// Degree up to which every split is tried: an octagon has 903.
const DEGREE_OF_ALL_SPLITS_MAX: usize = 8;

/// Cells as ascending corners, and the diagonals between them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct PolygonSplit {
    cells: Vec<Vec<usize>>,
    diagonals: Vec<[usize; 2]>,
}

/// How a point moves: by `speed / w` in a unit of time, with a positive `w`.
struct Velocity {
    speed: IntegerVector,
    w: BigInt,
}

/// A vertex and the faces around it, clockwise, with the directions of its edges: edge `i` is between the faces `i` and
/// `i + 1`. What many splits ask for is kept.
struct VertexStar<'s> {
    solid: &'s Solid,
    faces: Vec<FaceId>,
    normals: Vec<Direction>,
    /// How the offsets of the faces grow that move.
    rates: Vec<Option<&'s BigInt>>,
    rays: Vec<Direction>,
    lines: RefCell<BTreeMap<[usize; 2], Rc<Direction>>>,
    /// By the faces of the cell.
    velocities: RefCell<BTreeMap<u32, Option<Rc<Velocity>>>>,
    /// By the faces of both cells.
    apart: RefCell<BTreeMap<[u32; 2], Option<Rc<Direction>>>>,
}

/// Splits `v` for the time just after 0. Returns the new edges; `None`, with nothing changed, when no split is good.
pub(super) fn split(solid: &mut Solid, motion: &Motion, v: VertexId) -> Option<Vec<HalfEdgeId>> {
    let diagonals = good_split(solid, motion, v)?;
    let mut edges = Vec::new();
    let mut vertices = vec![v];
    for [left, right] in diagonals {
        let has_both = |&w: &VertexId| {
            let faces: Vec<FaceId> = solid.topology.faces_around(w).collect();
            faces.contains(&left) && faces.contains(&right)
        };
        let at = *vertices.iter().find(|w| has_both(w))?;
        let h = solid.topology.split_vertex(at, left, right).ok()?;
        solid.points.push(Arc::clone(&solid.points[v.index()]));
        vertices.push(solid.topology.destination(h));
        edges.push(h);
    }
    Some(edges)
}

/// The diagonals of the split, as pairs of faces that become neighbours.
fn good_split(solid: &Solid, motion: &Motion, v: VertexId) -> Option<Vec<[FaceId; 2]>> {
    let h = solid.topology.leaving(v)?;
    let star = VertexStar::new(solid, motion, h);
    let degree = star.faces.len();
    let is_good = |split: &PolygonSplit| star.is_good(split);
    let split = if degree <= DEGREE_OF_ALL_SPLITS_MAX {
        let corners: Vec<usize> = (0..degree).collect();
        let may_be = |cell: &[usize]| star.velocity(cell).is_some();
        all_splits(&corners, &may_be).into_iter().find(is_good)
    } else {
        let mut moving = (0..degree).filter(|&i| star.rates[i].is_some());
        match (moving.next(), moving.next()) {
            (Some(face), None) => splits_around(face, degree).find(is_good),
            _ => None,
        }
    }?;
    Some(split.diagonals.iter().map(|d| d.map(|i| star.faces[i])).collect())
}

/// All splits of a polygon into cells that may be, those with the largest first cells first.
fn all_splits(corners: &[usize], may_be: &impl Fn(&[usize]) -> bool) -> Vec<PolygonSplit> {
    if corners.len() < 3 {
        return vec![PolygonSplit::default()];
    }
    let (first, last) = (corners[0], corners[corners.len() - 1]);
    let middle = &corners[1..corners.len() - 1];
    let mut splits = Vec::new();
    // The cell at the side from the last corner to the first has some of the corners between.
    for mask in (1u32..1 << middle.len()).rev() {
        let chosen = middle.iter().enumerate().filter(|(i, _)| mask >> i & 1 == 1).map(|(_, &c)| c);
        let cell: Vec<usize> = std::iter::once(first).chain(chosen).chain([last]).collect();
        if !may_be(&cell) {
            continue;
        }
        let mut partial = vec![PolygonSplit { cells: vec![cell.clone()], diagonals: vec![] }];
        for pair in cell.windows(2) {
            let beyond: Vec<usize> =
                corners.iter().copied().filter(|c| (pair[0]..=pair[1]).contains(c)).collect();
            if beyond.len() < 3 {
                continue;
            }
            let parts = all_splits(&beyond, may_be);
            partial = partial
                .iter()
                .flat_map(|whole| {
                    parts.iter().map(|part| PolygonSplit {
                        cells: [&whole.cells[..], &part.cells].concat(),
                        diagonals: [&whole.diagonals[..], &[[pair[0], pair[1]]], &part.diagonals].concat(),
                    })
                })
                .collect();
        }
        splits.extend(partial);
    }
    splits
}

/// The splits of a vertex where one face moves and all others stay: the moving face becomes a neighbour of all, or of
/// all but those between two of them, whose planes keep meeting in the old point.
fn splits_around(face: usize, degree: usize) -> impl Iterator<Item = PolygonSplit> {
    let others: Vec<usize> = (1..degree).map(|k| (face + k) % degree).collect();
    let count = others.len();
    let sorted = |mut cell: Vec<usize>| {
        cell.sort_unstable();
        cell
    };
    let build = move |gap: Option<(usize, usize)>| {
        let mut split = PolygonSplit::default();
        let mut k = 0;
        while k + 1 < count {
            let to = match gap {
                Some((from, to)) if from == k => {
                    split.cells.push(sorted(others[from..=to].to_vec()));
                    split.diagonals.push([others[from], others[to]]);
                    to
                }
                _ => k + 1,
            };
            split.cells.push(sorted(vec![face, others[k], others[to]]));
            if to + 1 < count {
                split.diagonals.push([face, others[to]]);
            }
            k = to;
        }
        split
    };
    let gaps = (0..count).flat_map(move |i| (i + 2..count).rev().map(move |j| Some((i, j))));
    std::iter::once(None).chain(gaps).map(build)
}

impl<'s> VertexStar<'s> {
    fn new(solid: &'s Solid, motion: &'s Motion, h: HalfEdgeId) -> Self {
        let faces: Vec<FaceId> = solid.topology.around(h).map(|h| solid.topology.face(h)).collect();
        Self {
            normals: faces.iter().map(|&f| Direction::new(solid.plane(f).normal.clone())).collect(),
            rates: faces.iter().map(|&f| motion.rate(f)).collect(),
            rays: solid.topology.around(h).map(|h| Direction::new(solid.direction(h))).collect(),
            solid,
            faces,
            lines: RefCell::default(),
            velocities: RefCell::default(),
            apart: RefCell::default(),
        }
    }

    /// The cross product of the normals of two faces.
    fn line(&self, i: usize, j: usize) -> Rc<Direction> {
        let new = || Rc::new(Direction::new(cross(&self.normals[i].exact, &self.normals[j].exact)));
        if self.faces.len() > DEGREE_OF_ALL_SPLITS_MAX {
            return new();
        }
        Rc::clone(self.lines.borrow_mut().entry([i, j]).or_insert_with(new))
    }

    /// How the point of a cell moves; none when its planes do not stay concurrent, or have no single point.
    fn velocity(&self, cell: &[usize]) -> Option<Rc<Velocity>> {
        let new = || self.new_velocity(cell).map(Rc::new);
        match self.key(cell) {
            None => new(),
            Some(key) => self.velocities.borrow_mut().entry(key).or_insert_with(new).clone(),
        }
    }

    /// A cell as a number; none for vertices of so many faces that few of their cells are asked for twice.
    fn key(&self, cell: &[usize]) -> Option<u32> {
        let is_small = self.faces.len() <= DEGREE_OF_ALL_SPLITS_MAX;
        is_small.then(|| cell.iter().fold(0, |key, i| key | 1 << i))
    }

    fn new_velocity(&self, cell: &[usize]) -> Option<Velocity> {
        let (&i, rest) = cell.split_first()?;
        let &j = rest.iter().find(|&&j| !self.normals[i].is_parallel(&self.normals[j]))?;
        let line = self.line(i, j);
        let &k = rest.iter().find(|&&k| line.dot_sign(&self.normals[k]) != Ordering::Equal)?;
        if cell.iter().all(|&i| self.rates[i].is_none()) {
            return Some(Velocity { speed: Default::default(), w: BigInt::one() });
        }
        let w = dot(&line.exact, &self.normals[k].exact);
        let mut speed = IntegerVector::default();
        for (moved, [p, q]) in [(i, [j, k]), (j, [k, i]), (k, [i, j])] {
            let Some(rate) = self.rates[moved] else { continue };
            let line = self.line(p, q);
            speed.iter_mut().zip(&line.exact).for_each(|(sum, x)| *sum += rate * x);
        }
        let velocity =
            if w.is_negative() { Velocity { speed: negative(&speed), w: -w } } else { Velocity { speed, w } };
        let stays_on = |&f: &usize| {
            let rise = dot(&self.normals[f].exact, &velocity.speed);
            [i, j, k].contains(&f)
                || self.rates[f].map_or_else(|| rise.is_zero(), |r| rise == r * &velocity.w)
        };
        cell.iter().all(stays_on).then_some(velocity)
    }

    /// Where the vertex of one cell sees that of another; none when they stay together.
    fn apart(&self, from: &[usize], to: &[usize]) -> Option<Rc<Direction>> {
        let new = || {
            let (a, b) = (self.velocity(from)?, self.velocity(to)?);
            let ray = Direction::new(std::array::from_fn(|k| &b.speed[k] * &a.w - &a.speed[k] * &b.w));
            (!ray.is_zero()).then(|| Rc::new(ray))
        };
        match (self.key(from), self.key(to)) {
            (Some(from), Some(to)) => self.apart.borrow_mut().entry([from, to]).or_insert_with(new).clone(),
            _ => new(),
        }
    }

    fn is_good(&self, split: &PolygonSplit) -> bool {
        let velocities: Option<Vec<Rc<Velocity>>> = split.cells.iter().map(|c| self.velocity(c)).collect();
        let Some(velocities) = velocities else { return false };
        (0..split.cells.len()).all(|c| self.has_simple_link(split, c)) && self.is_embedded(split, &velocities)
    }

    /// Whether the faces around the vertex of a cell meet in their common edges only.
    fn has_simple_link(&self, split: &PolygonSplit, c: usize) -> bool {
        let cell = &split.cells[c];
        let mut new_rays: Vec<Option<Rc<Direction>>> = Vec::with_capacity(cell.len());
        for k in 0..cell.len() {
            let ends = [cell[k], cell[(k + 1) % cell.len()]];
            if self.are_neighbours(ends) {
                new_rays.push(None);
                continue;
            }
            let is_beyond = |d: &usize| *d != c && ends.iter().all(|i| split.cells[*d].contains(i));
            let Some(beyond) = (0..split.cells.len()).find(is_beyond) else { return false };
            let Some(ray) = self.apart(cell, &split.cells[beyond]) else { return false };
            new_rays.push(Some(ray));
        }
        let rays: Vec<&Direction> =
            new_rays.iter().zip(cell).map(|(ray, &i)| ray.as_deref().unwrap_or(&self.rays[i])).collect();
        let normals: Vec<&Direction> = cell.iter().map(|&i| &self.normals[i]).collect();
        is_link_simple(&normals, &rays, &|i, j| self.line(cell[i], cell[j]))
    }

    /// Whether the second face follows the first around the vertex.
    fn are_neighbours(&self, [i, j]: [usize; 2]) -> bool {
        (i + 1) % self.faces.len() == j
    }

    /// Whether all edges and faces of the split meet in what they share only.
    fn is_embedded(&self, split: &PolygonSplit, velocities: &[Rc<Velocity>]) -> bool {
        let side = |i: usize| ConePlane {
            normal: &self.normals[i],
            unit: self.solid.plane(self.faces[i]).unit,
            rate: self.rates[i].cloned().unwrap_or_default(),
        };
        let sides: Vec<ConePlane<'_>> = (0..self.faces.len()).map(side).collect();
        let vertices = velocities.iter().map(|v| Point::new(v.speed.clone(), v.w.clone())).collect();
        Cone::of(&sides, &self.rays, vertices, &split.cells).is_some_and(|cone| cone.is_embedded())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_octagon_has_903_splits_and_a_square_three() {
        for (corners, count) in [(3, 1), (4, 3), (5, 11), (6, 45), (7, 197), (8, 903)] {
            let corners: Vec<usize> = (0..corners).collect();
            let splits = all_splits(&corners, &|_| true);
            assert_eq!(splits.len(), count);
            assert!(splits.iter().all(|s| s.cells.len() == s.diagonals.len() + 1));
        }
    }

    #[test]
    fn splits_around_a_face_have_a_cell_for_every_new_vertex() {
        for degree in 4..12 {
            for split in splits_around(2, degree) {
                assert_eq!(split.cells.len(), split.diagonals.len() + 1, "{split:?}");
                let sides: usize = split.cells.iter().map(Vec::len).sum();
                assert_eq!(sides, degree + 2 * split.diagonals.len(), "{split:?}");
            }
        }
    }
}
