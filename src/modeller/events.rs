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
use super::merged::Merged;
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
use std::cell::RefCell;
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
    let mut search = Search::new(solid, motion, moving, vanish_at.as_ref());
    let mut found = First { at: None, contacts: Vec::new() };
    let merged = Merged::of(solid, &vanishing);
    let is_explained =
        |s: &Rational, contact: &Contact| vanish_at.as_ref() == Some(s) && merged.explains(solid, contact);
    let is_in_time = |s: &Rational| vanish_at.as_ref().is_none_or(|end| s <= end);
    // What vertices find ends the time for edges.
    for search_for in [Search::vertices_against_faces, Search::edges_against_edges] {
        let mut candidates = Vec::new();
        search_for(&search, budget, &mut candidates)?;
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (earliest, candidate) in candidates {
            budget.spend(1)?;
            if earliest > search.end {
                break;
            }
            let Some(s) = search.root(&candidate).filter(is_in_time) else { continue };
            if found.is_before(&s) || is_explained(&s, &candidate) || !search.do_meet(&candidate, &s) {
                continue;
            }
            search.end = search.end.min(rounded_up(&s));
            found.take(s, candidate);
        }
    }
    let First { at: first, mut contacts } = found;
    contacts.sort_unstable();
    contacts.dedup();
    Ok(match (first, vanish_at) {
        (None, None) => None,
        (Some(at), Some(end)) if at == end => Some(Event { at, vanishing, contacts: search.told(contacts) }),
        (Some(at), _) => Some(Event { at, vanishing: Vec::new(), contacts: search.told(contacts) }),
        (None, Some(at)) => Some(Event { at, vanishing, contacts }),
    })
}

/// The first contacts that are known.
struct First {
    at: Option<Rational>,
    contacts: Vec<Contact>,
}

impl First {
    fn is_before(&self, s: &Rational) -> bool {
        match &self.at {
            Some(at) => at < s || (at == s && self.contacts.len() >= BLOCKING_MAX),
            None => false,
        }
    }

    fn take(&mut self, s: Rational, contact: Contact) {
        if self.at.as_ref().is_none_or(|at| s < *at) {
            self.contacts.clear();
            self.at = Some(s);
        }
        self.contacts.push(contact);
    }
}

fn rounded_up(s: &Rational) -> f64 {
    to_f64(s) * (1.0 + 1e-12)
}

/// The earliest time at which `height + time growth` may be zero, when both are known within these errors; none when it
/// surely never is after 0.
fn earliest_root([height, height_error]: [f64; 2], [growth, growth_error]: [f64; 2]) -> Option<f64> {
    let is_sure = height.abs() > height_error && growth.abs() > growth_error;
    if is_sure && (height > 0.0) == (growth > 0.0) {
        return None;
    }
    let earliest = (height.abs() - height_error).max(0.0) / (growth.abs() + growth_error);
    Some(if earliest.is_nan() { 0.0 } else { earliest })
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
    /// The sides of the face that was asked for last, at the time that was asked for: many vertices reach one face at
    /// one time.
    sides: RefCell<Option<FaceAt>>,
}

/// A face at a time.
struct FaceAt {
    face: FaceId,
    time: Rational,
    corners: Vec<[Point; 2]>,
}

/// What may come to meet, and the earliest time at which it does.
type Candidates = Vec<(f64, Contact)>;

impl<'s> Search<'s> {
    fn new(solid: &'s Solid, motion: &'s Motion, moving: &'s Moving, end: Option<&Rational>) -> Self {
        let speeds = moving.vertices.iter().map(|(_, m)| m.near_speed()).collect();
        let end = end.map_or(f64::INFINITY, rounded_up);
        Self { solid, motion, moving, end, speeds, sides: RefCell::new(None) }
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
        let rate = self.rate(f);
        let (p, u) = (self.solid.point(v).near, self.speed(v));
        let height = [
            plane.unit.dot(p) - plane.distance,
            (plane.unit.abs().dot(p.abs()) + plane.distance.abs()) * 1e-13,
        ];
        let growth = [plane.unit.dot(u) - rate, (plane.unit.abs().dot(u.abs()) + rate.abs()) * 1e-13];
        let Some(earliest) = earliest_root(height, growth).filter(|t| *t <= self.end) else { return };
        if !self.solid.topology.faces_around(v).any(|g| g == f) {
            out.push((earliest, Contact::VertexFace { vertex: v, face: f }));
        }
    }

    /// How fast the plane of `f` moves, rounded.
    fn rate(&self, f: FaceId) -> f64 {
        let rate = self.motion.rate(f).map_or(0.0, |r| super::exact::quotient(r, &BigInt::one()));
        rate / self.solid.plane(f).length
    }

    /// The time after 0 at which what would meet is in one plane.
    fn root(&self, candidate: &Contact) -> Option<Rational> {
        match *candidate {
            Contact::VertexFace { vertex, face } => {
                let still;
                let point = match self.moving.get(vertex) {
                    Some(point) => point,
                    None => {
                        still = MovingPoint::still(self.solid.point(vertex));
                        &still
                    }
                };
                let plane = self.solid.plane(face);
                let (normal, offset) = plane.row();
                let c0 = dot(&normal, &point.start) - &offset * &point.w;
                let rate = self.motion.rate_or_zero(face) * plane.offset.denom();
                let c1 = dot(&normal, &point.speed) - rate * &point.w;
                root_after_zero(&c0, &c1)
            }
            Contact::EdgeEdge { first, second } => {
                let (c0, c1) = self.coplanarity([first[0], first[1], second[0], second[1]]);
                root_after_zero(&c0, &c1)
            }
            Contact::EdgeVanishes { .. } | Contact::LoopLoop { .. } => None,
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
        let Some(earliest) = self.earliest_coplanarity([first[0], first[1], second[0], second[1]]) else {
            return;
        };
        if earliest <= self.end && self.is_crossable(ends(h), first) {
            out.push((earliest, Contact::EdgeEdge { first, second }));
        }
    }

    /// Whether an edge that stays crosses each plane of the other that stays.
    fn is_crossable(&self, ends: [VertexId; 2], faces: [FaceId; 2]) -> bool {
        let stays = ends.iter().all(|v| self.moving.get(*v).is_none());
        !stays
            || faces.iter().filter(|f| self.motion.rate(**f).is_none()).all(|f| {
                let [a, b] = ends.map(|v| self.solid.plane(*f).side(self.solid.point(v)));
                a != b && a != Ordering::Equal && b != Ordering::Equal
            })
    }

    /// The earliest time at which four planes may meet in one point.
    fn earliest_coplanarity(&self, faces: [FaceId; 4]) -> Option<f64> {
        let planes = faces.map(|f| self.solid.plane(f));
        let ([mut height, mut height_error], [mut growth, mut growth_error]) = ([0.0; 2], [0.0; 2]);
        for k in 0..4 {
            let [a, b, c] = [0, 1, 2].map(|i| planes[i + usize::from(i >= k)].unit);
            let minor = a.dot(b.cross(c)) * if k % 2 == 1 { -1.0 } else { 1.0 };
            let rate = self.rate(faces[k]);
            height += planes[k].distance * minor;
            growth += rate * minor;
            // Components of the normals are within 2^-51, so minors within 2e-14.
            height_error += planes[k].distance.abs() * 3e-14;
            growth_error += rate.abs() * 3e-14;
        }
        earliest_root([height, height_error], [growth, growth_error])
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
                let mut kept = self.sides.borrow_mut();
                let is_kept = |kept: &FaceAt| kept.face == face && kept.time == *s;
                let sides = match &mut *kept {
                    Some(kept) if is_kept(kept) => kept,
                    other => other.insert(self.face_at(face, s)),
                };
                let corners = sides.corners.iter().map(|[a, b]| [a, b]);
                self.solid.view(face).locate(&p, corners) != Place::Outside
            }
            Contact::EdgeEdge { first, second } => self.do_edges_meet(first, second, s),
            Contact::EdgeVanishes { .. } | Contact::LoopLoop { .. } => false,
        }
    }

    fn face_at(&self, face: FaceId, s: &Rational) -> FaceAt {
        let topology = &self.solid.topology;
        let at = |v: VertexId| self.moving.at(self.solid, v, s);
        let ends = |h| [topology.origin(h), topology.destination(h)].map(at);
        FaceAt { face, time: s.clone(), corners: topology.sides(face).map(ends).collect() }
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
