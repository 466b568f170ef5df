//! Convex hull of points in space: quickhull with exact predicates.
//!
//! Barber, Dobkin and Huhdanpaa (1996). A point is outside of a face when it is strictly above its plane, decided
//! exactly, so that no tolerance is needed: a point in the plane of a face that sees its neighbour makes a face in the
//! same plane, and no face is ever degenerate or folded.

use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, Sign, are_collinear, orient3d};

/// No face on the other side of an edge.
const UNSET: u32 = u32::MAX;

/// A face of the hull.
#[derive(Debug, Clone)]
struct HullFace {
    /// Counter-clockwise seen from outside.
    corners: [u32; 3],
    /// The face across the edge from each corner to the next.
    neighbours: [u32; 3],
    /// Points above it that no earlier face has.
    above: Vec<u32>,
    is_alive: bool,
}

/// Faces of the hull of `points`, counter-clockwise seen from outside. Empty when all points are in one plane.
pub(super) fn hull(points: &[DVec3], budget: &Budget) -> Result<Vec<[u32; 3]>, Stopped> {
    let Some(first) = first_tetrahedron(points) else { return Ok(Vec::new()) };
    let mut growing = Growing { points, faces: Vec::new() };
    growing.start(first);
    // Faces are only added; each is visited once while it has points above it.
    let mut next = 0;
    while next < growing.faces.len() {
        budget.spend(1)?;
        if growing.faces[next].is_alive && !growing.faces[next].above.is_empty() {
            growing.add(next as u32, budget)?;
        }
        next += 1;
    }
    Ok(growing.faces.into_iter().filter(|face| face.is_alive).map(|face| face.corners).collect())
}

/// Four points that are in no plane, the last below the first three.
fn first_tetrahedron(points: &[DVec3]) -> Option<[u32; 4]> {
    let farthest = |distance: &dyn Fn(DVec3) -> f64| {
        let best = (0..points.len())
            .max_by(|&a, &b| distance(points[a]).total_cmp(&distance(points[b])).then(b.cmp(&a)));
        best.map(|best| best as u32)
    };
    let at = |i: u32| points[i as usize];
    let a = farthest(&|p| -p.x)?;
    let b = farthest(&|p| p.distance_squared(at(a)))?;
    let along = at(b) - at(a);
    let mut c = farthest(&|p| (p - at(a)).cross(along).length_squared())?;
    if are_collinear(at(a), at(b), at(c)) {
        c = (0..points.len() as u32).find(|&c| !are_collinear(at(a), at(b), at(c)))?;
    }
    let normal = along.cross(at(c) - at(a));
    let is_off = |d: u32| !orient3d(at(a), at(b), at(c), at(d)).is_zero();
    let mut d = farthest(&|p| (p - at(a)).dot(normal).abs())?;
    if !is_off(d) {
        d = (0..points.len() as u32).find(|&d| is_off(d))?;
    }
    let is_above = is_above(points, [a, b, c], d);
    Some(if is_above { [a, c, b, d] } else { [a, b, c, d] })
}

/// True when the point is strictly on the side from which the corners run counter-clockwise.
fn is_above(points: &[DVec3], corners: [u32; 3], point: u32) -> bool {
    let [a, b, c] = corners.map(|v| points[v as usize]);
    orient3d(a, b, c, points[point as usize]) == Sign::Positive
}

struct Growing<'p> {
    points: &'p [DVec3],
    faces: Vec<HullFace>,
}

impl Growing<'_> {
    fn start(&mut self, [a, b, c, d]: [u32; 4]) {
        for (corners, neighbours) in
            [([a, b, c], [1, 2, 3]), ([b, a, d], [0, 3, 2]), ([c, b, d], [0, 1, 3]), ([a, c, d], [0, 2, 1])]
        {
            self.faces.push(HullFace { corners, neighbours, above: Vec::new(), is_alive: true });
        }
        let others = (0..self.points.len() as u32).filter(|v| ![a, b, c, d].contains(v)).collect();
        self.hand_out(others, 0);
    }

    /// Gives each point to the first of the faces from `first` on that it is above; others are inside for good.
    fn hand_out(&mut self, points: Vec<u32>, first: usize) {
        for point in points {
            let above =
                (first..self.faces.len()).find(|&f| is_above(self.points, self.faces[f].corners, point));
            if let Some(face) = above {
                self.faces[face].above.push(point);
            }
        }
    }

    /// Makes the farthest point above `face` a corner of the hull.
    fn add(&mut self, face: u32, budget: &Budget) -> Result<(), Stopped> {
        let Some(eye) = self.farthest_above(face) else { return Ok(()) };
        let (horizon, orphans) = self.remove_seen(face, eye, budget)?;
        budget.spend(orphans.len() as u64)?;
        let first = self.faces.len();
        for (i, &HorizonEdge { edge: [from, to], behind }) in horizon.iter().enumerate() {
            let id = (first + i) as u32;
            self.faces.push(HullFace {
                corners: [from, to, eye],
                neighbours: [behind, UNSET, UNSET],
                above: Vec::new(),
                is_alive: true,
            });
            let neighbour = &mut self.faces[behind as usize];
            for side in 0..3 {
                if neighbour.corners[side] == to && neighbour.corners[(side + 1) % 3] == from {
                    neighbour.neighbours[side] = id;
                }
            }
        }
        self.join_around(first, &horizon);
        let others = orphans.into_iter().filter(|&point| point != eye).collect();
        self.hand_out(others, first);
        Ok(())
    }

    fn farthest_above(&self, face: u32) -> Option<u32> {
        let HullFace { corners, above, .. } = &self.faces[face as usize];
        let [a, b, c] = corners.map(|v| self.points[v as usize]);
        let normal = (b - a).cross(c - a);
        let height = |v: u32| (self.points[v as usize] - a).dot(normal);
        above.iter().copied().max_by(|&v, &w| height(v).total_cmp(&height(w)).then(w.cmp(&v)))
    }

    /// Removes the faces that `eye` sees; gives the edges around them and the points that were above them.
    fn remove_seen(
        &mut self,
        first: u32,
        eye: u32,
        budget: &Budget,
    ) -> Result<(Vec<HorizonEdge>, Vec<u32>), Stopped> {
        let (mut horizon, mut orphans, mut stack) = (Vec::new(), Vec::new(), vec![first]);
        self.faces[first as usize].is_alive = false;
        while let Some(face) = stack.pop() {
            budget.spend(1)?;
            orphans.append(&mut self.faces[face as usize].above);
            let HullFace { corners, neighbours, .. } = self.faces[face as usize].clone();
            for side in 0..3 {
                let behind = neighbours[side];
                if self.faces.get(behind as usize).is_none_or(|face| !face.is_alive) {
                    continue;
                }
                if is_above(self.points, self.faces[behind as usize].corners, eye) {
                    self.faces[behind as usize].is_alive = false;
                    stack.push(behind);
                } else {
                    horizon.push(HorizonEdge { edge: [corners[side], corners[(side + 1) % 3]], behind });
                }
            }
        }
        Ok((horizon, orphans))
    }

    /// Joins the new faces, one for each edge of the horizon, along the edges at the new corner.
    fn join_around(&mut self, first: usize, horizon: &[HorizonEdge]) {
        let mut by_start: Vec<(u32, usize)> =
            horizon.iter().enumerate().map(|(i, rim)| (rim.edge[0], first + i)).collect();
        by_start.sort_unstable();
        for (i, rim) in horizon.iter().enumerate() {
            let found = by_start.binary_search_by_key(&rim.edge[1], |&(start, _)| start);
            if let Ok(place) = found {
                let after = by_start[place].1;
                self.faces[first + i].neighbours[1] = after as u32;
                self.faces[after].neighbours[2] = (first + i) as u32;
            }
        }
    }
}

/// An edge of the horizon, as the face that was removed ran through it, and the face that stays behind it.
#[derive(Debug, Clone, Copy)]
struct HorizonEdge {
    edge: [u32; 2],
    behind: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u32);

    impl Random {
        fn below(&mut self, n: u32) -> u32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) % n
        }
    }

    fn check(points: &[DVec3]) -> Vec<[u32; 3]> {
        let faces = hull(points, &Budget::unlimited()).unwrap();
        for &face in &faces {
            assert!((0..points.len() as u32).all(|p| !is_above(points, face, p)), "{face:?}");
        }
        let mut edges: Vec<[u32; 2]> = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        edges.sort_unstable();
        let count = edges.len();
        edges.dedup();
        assert_eq!(edges.len(), count, "an edge in one direction once");
        assert!(edges.iter().all(|&[a, b]| edges.binary_search(&[b, a]).is_ok()), "closed");
        faces
    }

    #[test]
    fn no_point_of_random_sets_is_above_a_face_and_the_hull_is_closed() {
        let mut random = Random(7);
        for round in 0..300 {
            // Few coordinates: many points in one plane, on one line, or at one place.
            let spread = 2 + round % 9;
            let count = 4 + random.below(40);
            let mut at = || f64::from(random.below(spread));
            let points: Vec<DVec3> = (0..count).map(|_| DVec3::new(at(), at(), at())).collect();
            let faces = check(&points);
            let is_flat = (0..count).all(|d| {
                first_tetrahedron(&points).is_none_or(|[a, b, c, _]| {
                    let [a, b, c] = [a, b, c].map(|v| points[v as usize]);
                    orient3d(a, b, c, points[d as usize]).is_zero()
                })
            });
            assert_eq!(faces.is_empty(), is_flat, "{points:?}");
        }
    }

    #[test]
    fn a_cube_with_points_inside_and_on_it_has_its_eight_corners() {
        let points: Vec<DVec3> =
            (0..27).map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9))).collect();
        let faces = check(&points);
        let mut used: Vec<u32> = faces.into_iter().flatten().collect();
        used.sort_unstable();
        used.dedup();
        for corner in [0, 2, 6, 8, 18, 20, 24, 26] {
            assert!(used.contains(&corner));
        }
        assert!(!used.contains(&13), "the middle is inside");
    }

    #[test]
    fn points_in_one_plane_or_on_one_line_have_no_hull_in_space() {
        let plane: Vec<DVec3> = (0..9).map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3), 0.5)).collect();
        assert!(hull(&plane, &Budget::unlimited()).unwrap().is_empty());
        assert!(hull(&[DVec3::X; 5], &Budget::unlimited()).unwrap().is_empty());
        assert!(hull(&[], &Budget::unlimited()).unwrap().is_empty());
    }
}
