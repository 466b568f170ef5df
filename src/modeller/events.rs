//! The next time at which moving planes would make a polyhedron invalid.
//!
//! Normals stay, so edges keep their directions and the link of every vertex stays as it is. What can go wrong is then
//! an edge that loses its length, or two elements that do not share a vertex and come to meet. Of the latter the first
//! contact is always one of: a vertex reaches a face (corners and sides of the face included), or two edges cross. All
//! are roots of linear functions of time:
//!
//! - *edge*: the difference of its ends, along its direction;
//! - *vertex and face*: the height of the vertex above the plane;
//! - *two edges*, on planes 1, 2 and 3, 4: the determinant of the four rows `(n, d)`.
//!
//! An edge whose line stays and which only grows touches something with its moving end first, and two edges in one
//! plane with an end of one; so only edges with a moving plane are tried against edges, and only where the four planes
//! are different.

use super::contact::{do_meet, grown};
use super::exact::{Rational, cross, det, dot, to_f64};
use super::index::faces_near;
use super::motion::{Motion, Moving, MovingPoint, root_after_zero};
use super::plane::meeting_point;
use super::point::{Place, Point};
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::One;
use std::borrow::Cow;
use std::cmp::Ordering;

/// Most elements that are told of one event.
const BLOCKING_MAX: usize = 16;

/// Elements that would meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Contact {
    /// An edge loses its length.
    EdgeVanishes {
        /// The faces beside it.
        faces: [FaceId; 2],
        /// Its ends.
        vertices: [VertexId; 2],
    },
    /// A vertex reaches a face that it is not at.
    VertexFace {
        /// The vertex.
        vertex: VertexId,
        /// The face.
        face: FaceId,
    },
    /// Two edges cross.
    EdgeEdge {
        /// The faces beside one.
        first: [FaceId; 2],
        /// The faces beside the other.
        second: [FaceId; 2],
    },
    /// Two loops of one face touch, at this vertex of one of them.
    LoopLoop {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
}

/// What happens next.
#[derive(Debug, Clone)]
pub(super) struct Event {
    /// When, after 0.
    pub(super) at: Rational,
    /// The edges that lose their lengths then.
    pub(super) vanishing: Vec<HalfEdgeId>,
    /// What else comes to meet.
    pub(super) contacts: Vec<Contact>,
}

impl Event {
    /// All elements that meet.
    pub(super) fn blocking(&self, solid: &Solid) -> Vec<Contact> {
        let topology = &solid.topology;
        let vanish = |&h: &HalfEdgeId| Contact::EdgeVanishes {
            faces: [topology.face(h), topology.face(topology.opposite(h))],
            vertices: [topology.origin(h), topology.destination(h)],
        };
        let all = self.vanishing.iter().map(vanish).chain(self.contacts.iter().copied());
        all.take(BLOCKING_MAX).collect()
    }
}

/// The next event of `motion`, or none ever. The motion must keep every vertex on all its planes.
pub(super) fn next_event(
    solid: &Solid,
    motion: &Motion,
    moving: &Moving,
    budget: &Budget,
) -> Result<Option<Event>, Stopped> {
    let (vanish_at, vanishing) = first_vanishing(solid, motion, moving);
    let search = Search::new(solid, motion, moving, vanish_at.as_ref());
    let mut candidates = Vec::new();
    search.vertices_against_faces(budget, &mut candidates)?;
    search.edges_against_edges(budget, &mut candidates)?;
    candidates.retain(|(s, _)| vanish_at.as_ref().is_none_or(|end| s <= end));
    candidates.sort();
    let mut first: Option<Rational> = None;
    let mut contacts = Vec::new();
    for (s, candidate) in candidates {
        budget.spend(1)?;
        if first.as_ref().is_some_and(|f| s > *f) || contacts.len() >= BLOCKING_MAX {
            break;
        }
        let is_explained = || vanish_at.as_ref() == Some(&s) && explains(solid, &vanishing, &candidate);
        if search.do_meet(&candidate, &s) && !is_explained() {
            contacts.push(candidate);
            first = Some(s);
        }
    }
    contacts.dedup();
    Ok(match (first, vanish_at) {
        (None, None) => None,
        (Some(at), Some(end)) if at == end => Some(Event { at, vanishing, contacts: search.told(contacts) }),
        (Some(at), _) => Some(Event { at, vanishing: Vec::new(), contacts: search.told(contacts) }),
        (None, Some(at)) => Some(Event { at, vanishing, contacts }),
    })
}

/// Whether a contact only says that vertices become one because edges between them vanish: the elements share a vertex
/// then.
fn explains(solid: &Solid, vanishing: &[HalfEdgeId], contact: &Contact) -> bool {
    let topology = &solid.topology;
    let joined = |start: Vec<VertexId>| {
        let mut class = start;
        let mut k = 0;
        while k < class.len() {
            for h in vanishing {
                let ends = [topology.origin(*h), topology.destination(*h)];
                for [a, b] in [ends, [ends[1], ends[0]]] {
                    if a == class[k] && !class.contains(&b) {
                        class.push(b);
                    }
                }
            }
            k += 1;
        }
        class
    };
    match *contact {
        Contact::VertexFace { vertex, face } => {
            joined(vec![vertex]).iter().any(|v| topology.faces_around(*v).any(|f| f == face))
        }
        Contact::EdgeEdge { first, second } => {
            let ends = |[f, g]: [FaceId; 2]| -> Vec<VertexId> {
                let sides = topology.sides(f).filter(|h| topology.face(topology.opposite(*h)) == g);
                sides.flat_map(|h| [topology.origin(h), topology.destination(h)]).collect()
            };
            let class = joined(ends(first));
            ends(second).iter().any(|v| class.contains(v))
        }
        Contact::EdgeVanishes { .. } | Contact::LoopLoop { .. } => true,
    }
}

/// The first time at which edges lose their lengths, and which.
fn first_vanishing(solid: &Solid, motion: &Motion, moving: &Moving) -> (Option<Rational>, Vec<HalfEdgeId>) {
    let topology = &solid.topology;
    let (mut first, mut edges): (Option<Rational>, Vec<HalfEdgeId>) = (None, Vec::new());
    let mut all: Vec<HalfEdgeId> = moving
        .vertices
        .iter()
        .filter_map(|(v, _)| topology.leaving(*v))
        .flat_map(|h| topology.around(h))
        .map(|h| h.min(topology.opposite(h)))
        .collect();
    all.sort_unstable();
    all.dedup();
    for h in all {
        let Some(s) = vanishing_time(solid, motion, moving, h) else { continue };
        match first.as_ref().map(|f| s.cmp(f)) {
            Some(Ordering::Greater) => {}
            Some(Ordering::Equal) => edges.push(h),
            _ => (first, edges) = (Some(s), vec![h]),
        }
    }
    (first, edges)
}

/// When the edge of `h` loses its length, if it does after 0.
pub(super) fn vanishing_time(
    solid: &Solid,
    _motion: &Motion,
    moving: &Moving,
    h: HalfEdgeId,
) -> Option<Rational> {
    let topology = &solid.topology;
    let [left, right] = [h, topology.opposite(h)].map(|h| solid.plane(topology.face(h)));
    let along = cross(&left.normal, &right.normal);
    let of = |v: VertexId| moving.get(v).cloned().unwrap_or_else(|| MovingPoint::still(solid.point(v)));
    let (a, b) = (of(topology.origin(h)), of(topology.destination(h)));
    let c0 = dot(&along, &b.start) * &a.w - dot(&along, &a.start) * &b.w;
    let c1 = dot(&along, &b.speed) * &a.w - dot(&along, &a.speed) * &b.w;
    root_after_zero(&c0, &c1)
}

struct Search<'s> {
    solid: &'s Solid,
    motion: &'s Motion,
    moving: &'s Moving,
    /// No later time is asked for; rounded up, infinite when there is no such time.
    end: f64,
    speeds: Vec<DVec3>,
}

type Candidates = Vec<(Rational, Contact)>;

impl<'s> Search<'s> {
    fn new(solid: &'s Solid, motion: &'s Motion, moving: &'s Moving, end: Option<&Rational>) -> Self {
        let speeds = moving.vertices.iter().map(|(_, m)| m.near_speed()).collect();
        let end = end.map_or(f64::INFINITY, |end| to_f64(end) * (1.0 + 1e-12));
        Self { solid, motion, moving, end, speeds }
    }

    fn speed(&self, v: VertexId) -> DVec3 {
        self.moving.vertices.binary_search_by_key(&v, |(w, _)| *w).map_or(DVec3::ZERO, |i| self.speeds[i])
    }

    /// The box that a vertex sweeps until the end; everything when there is no end.
    fn swept(&self, v: VertexId) -> Aabb {
        let (from, speed) = (self.solid.point(v).near, self.speed(v));
        if self.end.is_finite() {
            let to = from + speed * self.end;
            let margin = (from.abs().max(to.abs()) + (speed * self.end).abs()) * 1e-11;
            return Aabb { min: from.min(to) - margin, max: from.max(to) + margin };
        }
        let reach = |low: bool| {
            DVec3::from_array(std::array::from_fn(|k| {
                let margin = from[k].abs() * 1e-11;
                if low {
                    if speed[k] < 0.0 { f64::NEG_INFINITY } else { from[k] - margin }
                } else if speed[k] > 0.0 {
                    f64::INFINITY
                } else {
                    from[k] + margin
                }
            }))
        };
        Aabb { min: reach(true), max: reach(false) }
    }

    fn swept_by_loop(&self, f: FaceId) -> Aabb {
        let exterior = self.solid.topology.loops(f).exterior;
        let corners =
            self.solid.topology.loop_of(exterior).map(|h| self.swept(self.solid.topology.origin(h)));
        grown(corners.fold(Aabb::EMPTY, Aabb::union))
    }

    /// The faces that may come into a box until the end: those that are near it and stay, and those with a vertex that
    /// moves.
    fn faces_near(&self, bounds: &Aabb, budget: &Budget) -> Result<Vec<FaceId>, Stopped> {
        let mut near = faces_near(self.solid, bounds, budget)?;
        near.extend(self.moving.vertices.iter().flat_map(|(v, _)| self.solid.topology.faces_around(*v)));
        near.sort_unstable();
        near.dedup();
        Ok(near)
    }

    /// Moving vertices against all faces, and all other vertices against moving faces.
    fn vertices_against_faces(&self, budget: &Budget, out: &mut Candidates) -> Result<(), Stopped> {
        let topology = &self.solid.topology;
        let sweeps: Vec<(VertexId, Aabb)> =
            self.moving.vertices.iter().map(|(v, _)| (*v, grown(self.swept(*v)))).collect();
        let all = sweeps.iter().fold(Aabb::EMPTY, |b, (_, s)| b.union(*s));
        let face_boxes: Vec<(FaceId, Aabb)> = self
            .faces_near(&all, budget)?
            .into_iter()
            .map(|f| (f, self.swept_by_loop(f)))
            .filter(|(_, bounds)| do_meet(bounds, &all))
            .collect();
        for (v, sweep) in &sweeps {
            budget.spend(face_boxes.len() as u64 / 16 + 1)?;
            for (f, bounds) in &face_boxes {
                if do_meet(sweep, bounds) {
                    self.try_vertex(*v, *f, out);
                }
            }
        }
        for f in self.motion.faces() {
            let bounds = self.swept_by_loop(f);
            let near = self.faces_near(&bounds, budget)?;
            let mut corners: Vec<VertexId> =
                near.into_iter().flat_map(|g| topology.sides(g)).map(|h| topology.origin(h)).collect();
            corners.sort_unstable();
            corners.dedup();
            budget.spend(corners.len() as u64 / 16 + 1)?;
            for v in corners {
                let p = self.solid.point(v).near;
                if do_meet(&bounds, &grown(Aabb { min: p, max: p })) && self.moving.get(v).is_none() {
                    self.try_vertex(v, f, out);
                }
            }
        }
        Ok(())
    }

    fn try_vertex(&self, v: VertexId, f: FaceId, out: &mut Candidates) {
        let plane = self.solid.plane(f);
        // Far from the plane at both ends of the time, on the same side: no root between.
        if self.end.is_finite() {
            let rate =
                self.motion.rate(f).map_or(0.0, |r| super::exact::quotient(r, &BigInt::one())) / plane.length;
            let (p, u) = (self.solid.point(v).near, self.speed(v));
            let height = plane.unit.dot(p) - plane.distance;
            let growth = (plane.unit.dot(u) - rate) * self.end;
            let size = plane.unit.abs().dot(p.abs())
                + plane.distance.abs()
                + plane.unit.abs().dot(u.abs()) * self.end
                + rate.abs() * self.end;
            let error = size * 1e-13;
            if height.abs() > error
                && (height + growth).abs() > error
                && (height > 0.0) == (height + growth > 0.0)
            {
                return;
            }
        }
        if self.solid.topology.faces_around(v).any(|g| g == f) {
            return;
        }
        let still;
        let point = match self.moving.get(v) {
            Some(point) => point,
            None => {
                still = MovingPoint::still(self.solid.point(v));
                &still
            }
        };
        let (normal, offset) = plane.row();
        let c0 = dot(&normal, &point.start) - &offset * &point.w;
        let c1 = dot(&normal, &point.speed) - self.motion.rate_or_zero(f) * plane.offset.denom() * &point.w;
        if let Some(s) = root_after_zero(&c0, &c1) {
            out.push((s, Contact::VertexFace { vertex: v, face: f }));
        }
    }

    /// Edges with a moving plane against all edges.
    fn edges_against_edges(&self, budget: &Budget, out: &mut Candidates) -> Result<(), Stopped> {
        let topology = &self.solid.topology;
        let mut moved: Vec<HalfEdgeId> = self
            .motion
            .faces()
            .flat_map(|f| topology.sides(f))
            .map(|h| h.min(topology.opposite(h)))
            .collect();
        moved.sort_unstable();
        moved.dedup();
        let sweep =
            |h: HalfEdgeId| grown(self.swept(topology.origin(h)).union(self.swept(topology.destination(h))));
        let all = moved.iter().fold(Aabb::EMPTY, |b, &h| b.union(sweep(h)));
        let mut edges: Vec<HalfEdgeId> = self
            .faces_near(&all, budget)?
            .into_iter()
            .flat_map(|f| topology.sides(f))
            .map(|h| h.min(topology.opposite(h)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        budget.spend(edges.len() as u64 / 16 + 1)?;
        let near: Vec<(HalfEdgeId, Aabb)> =
            edges.into_iter().map(|h| (h, sweep(h))).filter(|(_, bounds)| do_meet(bounds, &all)).collect();
        for &g in &moved {
            let bounds = sweep(g);
            budget.spend(near.len() as u64 / 16 + 1)?;
            for (h, other) in &near {
                let is_second_time = moved.binary_search(h).is_ok() && *h <= g;
                if !is_second_time && do_meet(&bounds, other) {
                    self.try_edges(g, *h, out);
                }
            }
        }
        Ok(())
    }

    fn try_edges(&self, g: HalfEdgeId, h: HalfEdgeId, out: &mut Candidates) {
        let topology = &self.solid.topology;
        let faces = |h| [topology.face(h), topology.face(topology.opposite(h))];
        let ends = |h| [topology.origin(h), topology.destination(h)];
        let (first, second) = (faces(g), faces(h));
        if first.iter().any(|f| second.contains(f)) || ends(g).iter().any(|v| ends(h).contains(v)) {
            return;
        }
        // An edge that stays must cross each plane of the other that stays.
        let stays = ends(h).iter().all(|v| self.moving.get(*v).is_none());
        for f in first.iter().filter(|f| stays && self.motion.rate(**f).is_none()) {
            let [a, b] = ends(h).map(|v| self.solid.plane(*f).side(self.solid.point(v)));
            if a == b || a == Ordering::Equal || b == Ordering::Equal {
                return;
            }
        }
        let (c0, c1) = self.coplanarity([first[0], first[1], second[0], second[1]]);
        if let Some(s) = root_after_zero(&c0, &c1) {
            out.push((s, Contact::EdgeEdge { first, second }));
        }
    }

    /// The determinant of the rows `(n, d)` of four planes as a function of time, times a positive number.
    fn coplanarity(&self, faces: [FaceId; 4]) -> (BigInt, BigInt) {
        let planes = faces.map(|f| self.solid.plane(f));
        let common = planes.iter().fold(BigInt::one(), |lcm, p| lcm.lcm(p.offset.denom()));
        let (mut c0, mut c1) = (BigInt::ZERO, BigInt::ZERO);
        for k in 0..4 {
            let others: Vec<&super::exact::Vector> =
                (0..4).filter(|&j| j != k).map(|j| &planes[j].normal).collect();
            let mut minor = det(others[0], others[1], others[2]);
            if k % 2 == 1 {
                minor = -minor;
            }
            c0 += planes[k].offset.numer() * (&common / planes[k].offset.denom()) * &minor;
            if let Some(rate) = self.motion.rate(faces[k]) {
                c1 += rate * &common * minor;
            }
        }
        (c0, c1)
    }

    /// Whether the elements really meet at time `s`, when the function that was solved is zero.
    fn do_meet(&self, candidate: &Contact, s: &Rational) -> bool {
        match *candidate {
            Contact::VertexFace { vertex, face } => {
                let p = self.moving.at(self.solid, vertex, s);
                let topology = &self.solid.topology;
                let corner = |v: VertexId| match self.moving.get(v) {
                    Some(moving) => Cow::Owned(moving.at(s)),
                    None => Cow::Borrowed(self.solid.point(v)),
                };
                let sides: Vec<[Cow<'_, Point>; 2]> = topology
                    .sides(face)
                    .map(|h| [topology.origin(h), topology.destination(h)].map(corner))
                    .collect();
                self.solid.view(face).locate(&p, sides.iter().map(|[a, b]| [&**a, &**b])) != Place::Outside
            }
            Contact::EdgeEdge { first, second } => self.do_edges_meet(first, second, s),
            Contact::EdgeVanishes { .. } | Contact::LoopLoop { .. } => false,
        }
    }

    fn do_edges_meet(&self, first: [FaceId; 2], second: [FaceId; 2], s: &Rational) -> bool {
        let at = |f: FaceId| {
            let plane = self.solid.plane(f);
            match self.motion.rate(f) {
                Some(rate) => plane.shifted(&(s * rate)),
                None => plane.clone(),
            }
        };
        let [a, b, c, d] = [first[0], first[1], second[0], second[1]].map(at);
        let Some(p) = meeting_point([&a, &b, &c]).or_else(|| meeting_point([&a, &b, &d])) else {
            return false;
        };
        self.has_edge_at(first, &p, s) && self.has_edge_at(second, &p, s)
    }

    /// Whether one of the edges between two faces passes through `p`, a point of their common line, at time `s`.
    fn has_edge_at(&self, faces: [FaceId; 2], p: &Point, s: &Rational) -> bool {
        let topology = &self.solid.topology;
        topology.sides(faces[0]).filter(|&h| topology.face(topology.opposite(h)) == faces[1]).any(|h| {
            let [a, b] =
                [topology.origin(h), topology.destination(h)].map(|v| self.moving.at(self.solid, v, s));
            (0..3).all(|k| {
                let (low, high) = if a.compare(&b, k) == Ordering::Greater { (&b, &a) } else { (&a, &b) };
                p.compare(low, k) != Ordering::Less && p.compare(high, k) != Ordering::Greater
            })
        })
    }

    /// A vertex that reaches a moving face by way of a face on which both have loops is one loop touching another.
    fn told(&self, contacts: Vec<Contact>) -> Vec<Contact> {
        let topology = &self.solid.topology;
        let tell = |contact: Contact| {
            let Contact::VertexFace { vertex, face } = contact else { return contact };
            let beside: Vec<FaceId> =
                topology.sides(face).map(|h| topology.face(topology.opposite(h))).collect();
            match topology.faces_around(vertex).find(|f| beside.contains(f)) {
                Some(common) if topology.loops(common).interior.is_empty() => contact,
                Some(common) => Contact::LoopLoop { face: common, vertex },
                None => contact,
            }
        };
        let mut told: Vec<Contact> = contacts.into_iter().map(tell).collect();
        told.sort_unstable();
        told.dedup();
        told
    }
}
