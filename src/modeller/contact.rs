//! Whether an edge meets a face beyond what they share, and which pairs are near enough to ask.

use super::point::{AxisView, Point, PointLocation};
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::geom::Aabb;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use num_bigint::BigInt;
use std::cmp::Ordering;

/// Whether two segments of one plane meet in more than a common end.
pub(super) fn do_segments_meet(solid: &Solid, view: AxisView, g: [VertexId; 2], h: [VertexId; 2]) -> bool {
    let [a, b] = g.map(|v| solid.point(v));
    let [c, d] = h.map(|v| solid.point(v));
    let shared = g.iter().filter(|v| h.contains(v)).count();
    if shared == 2 {
        return true;
    }
    if shared == 1 {
        // The two others: do they lie on one ray from the common end?
        let common = if h.contains(&g[0]) { g[0] } else { g[1] };
        let others = [g, h].map(|s| if s[0] == common { s[1] } else { s[0] });
        let [p, q, r] = [common, others[0], others[1]].map(|v| solid.point(v));
        let is_opposite = || view.is_between(p, q, r);
        return view.turn(p, q, r) == Ordering::Equal && !is_opposite();
    }
    let turns = [view.turn(a, b, c), view.turn(a, b, d), view.turn(c, d, a), view.turn(c, d, b)];
    let is_on = [(c, a, b), (d, a, b), (a, c, d), (b, c, d)]
        .into_iter()
        .zip(turns)
        .any(|((p, q, r), turn)| turn == Ordering::Equal && view.is_between(p, q, r));
    let is_crossing =
        turns.iter().all(|&t| t != Ordering::Equal) && turns[0] != turns[1] && turns[2] != turns[3];
    is_on || is_crossing
}

/// Whether the edge of `h` meets face `f`, which is not beside it, in more than common vertices.
pub(super) fn meets_beyond_shared(solid: &Solid, h: HalfEdgeId, f: FaceId) -> bool {
    let topology = &solid.topology;
    let ends = [topology.origin(h), topology.destination(h)];
    let is_corner = ends.map(|v| topology.faces_around(v).any(|g| g == f));
    let plane = solid.plane(f);
    let side = |k: usize| if is_corner[k] { Ordering::Equal } else { plane.side(solid.point(ends[k])) };
    let sides = [side(0), side(1)];
    match sides {
        [Ordering::Equal, Ordering::Equal] => meets_in_plane(solid, ends, is_corner, f),
        [Ordering::Equal, _] => {
            !is_corner[0] && solid.locate(f, solid.point(ends[0])) != PointLocation::Outside
        }
        [_, Ordering::Equal] => {
            !is_corner[1] && solid.locate(f, solid.point(ends[1])) != PointLocation::Outside
        }
        [a, b] if a == b => false,
        _ => solid.locate(f, &crossing(solid, h, f)) != PointLocation::Outside,
    }
}

/// Where the line of the edge of `h` crosses the plane of `f`, on which neither end lies.
fn crossing(solid: &Solid, h: HalfEdgeId, f: FaceId) -> Point {
    let (normal, offset) = solid.plane(f).row();
    let [a, b] = solid.ends(h);
    let height = |p: &Point| super::exact::dot(&normal, &p.x) - &offset * &p.w;
    // A point at height i over w has the true height i / w: weights cross-multiplied.
    let (i, j) = (height(a), height(b));
    let (i, j) = if i < BigInt::ZERO { (-i, j) } else { (i, -j) };
    let x = std::array::from_fn(|k| &a.x[k] * &j + &b.x[k] * &i);
    Point::new(x, &a.w * &j + &b.w * &i)
}

/// The case of an edge in the plane of the face.
fn meets_in_plane(solid: &Solid, ends: [VertexId; 2], is_corner: [bool; 2], f: FaceId) -> bool {
    let topology = &solid.topology;
    let view = solid.view(f);
    let sides = || topology.sides(f).map(|h| [topology.origin(h), topology.destination(h)]);
    if sides().any(|side| do_segments_meet(solid, view, ends, side)) {
        return true;
    }
    let witness = match is_corner {
        [false, _] => solid.point(ends[0]).clone(),
        [_, false] => solid.point(ends[1]).clone(),
        _ => middle(solid.point(ends[0]), solid.point(ends[1])),
    };
    solid.locate(f, &witness) != PointLocation::Outside
}

fn middle(a: &Point, b: &Point) -> Point {
    Point::new(std::array::from_fn(|k| &a.x[k] * &b.w + &b.x[k] * &a.w), (&a.w * &b.w) << 1)
}

/// Boxes of faces and edges, a little larger than rounding could make them too small.
pub(super) struct Boxes {
    faces: Vec<Aabb>,
    edges: Vec<(HalfEdgeId, Aabb, [FaceId; 2])>,
}

/// The box of points given by rounded coordinates, grown by what rounding may have taken.
pub(super) fn grown(b: Aabb) -> Aabb {
    let margin = b.min.abs().max(b.max.abs()) * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE;
    Aabb { min: b.min - margin, max: b.max + margin }
}

pub(super) fn do_meet(a: &Aabb, b: &Aabb) -> bool {
    (0..3).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
}

impl Boxes {
    pub(super) fn of(solid: &Solid, budget: &Budget) -> Result<Self, Stopped> {
        let topology = &solid.topology;
        budget.spend(topology.half_edge_bound() as u64)?;
        let near = |v: VertexId| solid.point(v).near;
        let face = |f| {
            grown(Aabb::of(topology.loop_of(topology.loops(f).exterior).map(|h| near(topology.origin(h)))))
        };
        let edge = |h| {
            let bounds = grown(Aabb::of([near(topology.origin(h)), near(topology.destination(h))]));
            (h, bounds, [topology.face(h), topology.face(topology.opposite(h))])
        };
        Ok(Self { faces: topology.faces().map(face).collect(), edges: topology.edges().map(edge).collect() })
    }

    /// Calls `visit` with every face and every edge not beside it whose boxes meet, one of them changed, until it is
    /// false. An edge is changed when a face beside it is.
    pub(super) fn each_pair(
        &self,
        is_changed: &[bool],
        budget: &Budget,
        mut visit: impl FnMut(FaceId, HalfEdgeId) -> bool,
    ) -> Result<(), Stopped> {
        // Sweep along x: faces and edges in the order of their lower ends, each compared with those still open.
        let is_edge_changed = |faces: &[FaceId; 2]| faces.iter().any(|f| is_changed[f.index()]);
        let mut order: Vec<(f64, u32, bool)> = Vec::with_capacity(self.faces.len() + self.edges.len());
        order.extend(self.faces.iter().enumerate().map(|(i, b)| (b.min.x, i as u32, true)));
        order.extend(self.edges.iter().enumerate().map(|(i, e)| (e.1.min.x, i as u32, false)));
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.2, a.1).cmp(&(b.2, b.1))));
        let (mut open_faces, mut open_edges): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        for (x, i, is_face) in order {
            budget.spend(1 + if is_face { open_edges.len() } else { open_faces.len() } as u64 / 64)?;
            let mut pairs: Vec<(u32, u32)> = Vec::new();
            if is_face {
                open_edges.retain(|&e| self.edges[e as usize].1.max.x >= x);
                pairs.extend(open_edges.iter().map(|&e| (i, e)));
                open_faces.push(i);
            } else {
                open_faces.retain(|&f| self.faces[f as usize].max.x >= x);
                pairs.extend(open_faces.iter().map(|&f| (f, i)));
                open_edges.push(i);
            }
            for (f, e) in pairs {
                let (h, bounds, beside) = &self.edges[e as usize];
                let f = FaceId::new(f as usize);
                if !beside.contains(&f)
                    && do_meet(&self.faces[f.index()], bounds)
                    && (is_changed[f.index()] || is_edge_changed(beside))
                    && !visit(f, *h)
                {
                    return Ok(());
                }
            }
        }
        Ok(())
    }
}
