//! Splitting a vertex whose planes stop to meet in one point: which faces become neighbours just after.
//!
//! The faces around a vertex of degree `k` are the corners of a polygon, its edges are the polygon's sides. A split is a
//! set of diagonals that do not cross: each cell is a new vertex, each diagonal a new edge. At time 0 all new edges have
//! length 0, so a split is chosen for the time after it, and another one for the opposite motion. A split is good when
//! the planes of every cell stay concurrent, every new edge has a length just after, around every new vertex the faces
//! do not cross, and no edge at one new vertex meets a face at another ([`Cone`]). Of several good splits the first in a fixed order is taken.

use super::cone::{Cone, Side};
use super::exact::{Vector, cross, dot, is_zero, negative, sign};
use super::motion::{Motion, MovingPoint};
use super::point::Point;
use super::solid::Solid;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Degree up to which every split is tried: an octagon has 903.
const DEGREE_OF_ALL_SPLITS_MAX: usize = 8;

/// Cells as ascending corners, and the diagonals between them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Split {
    cells: Vec<Vec<usize>>,
    diagonals: Vec<[usize; 2]>,
}

/// A vertex and the faces around it, clockwise, with the directions of its edges: edge `i` is between the faces `i` and
/// `i + 1`.
struct Star {
    faces: Vec<FaceId>,
    rays: Vec<Vector>,
    /// How the points of cells move, by the set of their corners; many splits have the same cells.
    speeds: RefCell<BTreeMap<u32, Option<MovingPoint>>>,
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
    let star = Star {
        faces: solid.topology.around(h).map(|h| solid.topology.face(h)).collect(),
        rays: solid.topology.around(h).map(|h| solid.direction(h)).collect(),
        speeds: RefCell::default(),
    };
    let degree = star.faces.len();
    let is_good = |split: &Split| star.is_good(solid, motion, split);
    let split = if degree <= DEGREE_OF_ALL_SPLITS_MAX {
        let corners: Vec<usize> = (0..degree).collect();
        let may_be = |cell: &[usize]| star.speed(solid, motion, cell).is_some();
        all_splits(&corners, &may_be).into_iter().find(is_good)
    } else {
        let mut moving = (0..degree).filter(|&i| motion.rate(star.faces[i]).is_some());
        match (moving.next(), moving.next()) {
            (Some(face), None) => splits_around(face, degree).find(is_good),
            _ => None,
        }
    }?;
    Some(split.diagonals.iter().map(|d| d.map(|i| star.faces[i])).collect())
}

/// All splits of a polygon into cells that may be, those with the largest first cells first.
fn all_splits(corners: &[usize], may_be: &impl Fn(&[usize]) -> bool) -> Vec<Split> {
    if corners.len() < 3 {
        return vec![Split::default()];
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
        let mut partial = vec![Split { cells: vec![cell.clone()], diagonals: vec![] }];
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
                    parts.iter().map(|part| Split {
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
fn splits_around(face: usize, degree: usize) -> impl Iterator<Item = Split> {
    let others: Vec<usize> = (1..degree).map(|k| (face + k) % degree).collect();
    let count = others.len();
    let sorted = |mut cell: Vec<usize>| {
        cell.sort_unstable();
        cell
    };
    let build = move |gap: Option<(usize, usize)>| {
        let mut split = Split::default();
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

impl Star {
    /// How the point of a cell moves; none when its planes do not stay concurrent, or have no single point.
    fn speed(&self, solid: &Solid, motion: &Motion, cell: &[usize]) -> Option<MovingPoint> {
        if self.faces.len() > DEGREE_OF_ALL_SPLITS_MAX {
            return self.new_speed(solid, motion, cell);
        }
        let key = cell.iter().fold(0, |key, i| key | 1 << i);
        if let Some(known) = self.speeds.borrow().get(&key) {
            return known.clone();
        }
        let speed = self.new_speed(solid, motion, cell);
        self.speeds.borrow_mut().insert(key, speed.clone());
        speed
    }

    fn new_speed(&self, solid: &Solid, motion: &Motion, cell: &[usize]) -> Option<MovingPoint> {
        let faces: Vec<FaceId> = cell.iter().map(|&i| self.faces[i]).collect();
        let point = MovingPoint::of(solid, motion, solid.defining_faces(&faces)?);
        faces.iter().all(|&f| point.stays_on(solid, motion, f)).then_some(point)
    }

    fn is_good(&self, solid: &Solid, motion: &Motion, split: &Split) -> bool {
        let speeds: Option<Vec<MovingPoint>> =
            split.cells.iter().map(|c| self.speed(solid, motion, c)).collect();
        let Some(speeds) = speeds else { return false };
        let relative = |from: usize, to: usize| -> Vector {
            let (a, b) = (&speeds[from], &speeds[to]);
            std::array::from_fn(|k| &b.speed[k] * &a.w - &a.speed[k] * &b.w)
        };
        let cell_beyond = |cell: usize, [i, j]: [usize; 2]| {
            (0..split.cells.len())
                .find(|&c| c != cell && split.cells[c].contains(&i) && split.cells[c].contains(&j))
        };
        let are_links_simple = (0..split.cells.len()).all(|c| {
            let cell = &split.cells[c];
            let mut rays = Vec::with_capacity(cell.len());
            for k in 0..cell.len() {
                let (i, j) = (cell[k], cell[(k + 1) % cell.len()]);
                if (i + 1) % self.faces.len() == j {
                    rays.push(self.rays[i].clone());
                    continue;
                }
                let Some(beyond) = cell_beyond(c, [i, j]) else { return false };
                let ray = relative(c, beyond);
                if is_zero(&ray) {
                    return false;
                }
                rays.push(ray);
            }
            let normals: Vec<&Vector> = cell.iter().map(|&i| &solid.plane(self.faces[i]).normal).collect();
            is_link_simple(&normals, &rays)
        });
        are_links_simple && self.is_embedded(solid, motion, split, speeds)
    }

    /// Whether all edges and faces of the split meet in what they share only.
    fn is_embedded(&self, solid: &Solid, motion: &Motion, split: &Split, speeds: Vec<MovingPoint>) -> bool {
        let side = |&f: &FaceId| Side {
            normal: &solid.plane(f).normal,
            unit: solid.plane(f).unit,
            rate: motion.rate_or_zero(f),
        };
        let sides: Vec<Side<'_>> = self.faces.iter().map(side).collect();
        let vertices = speeds.into_iter().map(|p| Point::new(p.speed, p.w)).collect();
        Cone::of(&sides, &self.rays, vertices, &split.cells).is_some_and(|cone| cone.is_embedded())
    }
}

/// Whether the faces around a vertex meet in their common edges only. Face `i` has the normal `i` and takes the angle
/// counter-clockwise from ray `i` to ray `i - 1`.
pub(super) fn is_link_simple(normals: &[&Vector], rays: &[Vector]) -> bool {
    let count = normals.len();
    let sector = |i: usize| (normals[i], &rays[i], &rays[(i + count - 1) % count]);
    for i in 0..count {
        let (n, a, b) = sector(i);
        if is_same_direction(a, b) {
            return false;
        }
        for j in 0..i {
            let (m, c, d) = sector(j);
            let line = cross(n, m);
            let witnesses = if is_zero(&line) {
                // One plane: the angles overlap when a ray of one is inside the other.
                vec![a.clone(), b.clone(), c.clone(), d.clone()]
            } else {
                vec![negative(&line), line]
            };
            for x in &witnesses {
                let is_common_ray = [a, b].iter().any(|r| is_same_direction(r, x))
                    && [c, d].iter().any(|r| is_same_direction(r, x));
                if !is_common_ray && is_in_sector(n, a, b, x) && is_in_sector(m, c, d, x) {
                    return false;
                }
                // In one plane a common ray is no common edge unless the two are neighbours, which cannot be coplanar.
                if is_common_ray && is_zero(&cross(n, m)) {
                    return false;
                }
                let are_neighbours = (i + 1) % count == j || (j + 1) % count == i;
                if is_common_ray && !are_neighbours {
                    return false;
                }
            }
        }
    }
    true
}

fn is_same_direction(a: &Vector, b: &Vector) -> bool {
    is_zero(&cross(a, b)) && sign(&dot(a, b)) == Ordering::Greater
}

/// Whether direction `x`, perpendicular to `n`, is in the closed angle counter-clockwise from `a` to `b`.
pub(super) fn is_in_sector(n: &Vector, a: &Vector, b: &Vector, x: &Vector) -> bool {
    if is_same_direction(a, x) || is_same_direction(b, x) {
        return true;
    }
    let turn = |p: &Vector, q: &Vector| sign(&dot(&cross(p, q), n));
    let (whole, from, to) = (turn(a, b), turn(a, x), turn(x, b));
    match whole {
        Ordering::Greater => from == Ordering::Greater && to == Ordering::Greater,
        Ordering::Equal => from == Ordering::Greater,
        Ordering::Less => from == Ordering::Greater || to == Ordering::Greater,
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
