//! What may come to meet while planes move, and whether it does: by rounded numbers with their errors first, then exactly.

use super::conflict::Conflict;
use super::contact::{do_meet, grown};
use super::exact::{Rational, det, dot, quotient};
use super::motion::{Motion, Moving, MovingPoint, root_after_zero};
use super::near::faces_near;
use super::plane::meeting_point;
use super::point::{Point, PointLocation};
use super::solid::Solid;
use super::sweep::each_meeting;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::One;
use std::cell::RefCell;
use std::cmp::Ordering;

/// Of a span of time to the one before it. Larger: fewer searches; smaller: less that is found in vain.
const SPAN_GROWTH: f64 = 16.0;
/// Spans before the last, which has all of the time.
const SHORT_SPANS: usize = 2;
/// Sides up to which a face is bounded anew for every vertex that may reach it.
const FEW_SIDES: usize = 8;

/// A span of time.
#[derive(Debug, Clone, Copy)]
struct TimeSpan {
    from: f64,
    to: f64,
}

/// When `height + time growth` may be zero, when both are known within these errors; none when it surely never is after 0.
fn root_span([height, height_error]: [f64; 2], [growth, growth_error]: [f64; 2]) -> Option<TimeSpan> {
    let is_sure = height.abs() > height_error && growth.abs() > growth_error;
    if is_sure && (height > 0.0) == (growth > 0.0) {
        return None;
    }
    let from = (height.abs() - height_error).max(0.0) / (growth.abs() + growth_error);
    let to = (height.abs() + height_error) / (growth.abs() - growth_error).max(0.0);
    // What is not a number is 0 / 0.
    let from = if from.is_nan() { 0.0 } else { from * (1.0 - 1e-14) };
    let to = if to.is_nan() { f64::INFINITY } else { to * (1.0 + 1e-14) };
    Some(TimeSpan { from, to })
}

/// What moves, and until when.
pub(super) struct EventSearch<'s> {
    solid: &'s Solid,
    motion: &'s Motion,
    moving: &'s Moving,
    /// No later time is asked for; rounded up, infinite when there is no such time.
    pub(super) end: f64,
    speeds: Vec<DVec3>,
    /// How fast the planes move that do, rounded, by face.
    rates: Vec<(FaceId, f64)>,
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
pub(super) type Candidates = Vec<(f64, Conflict)>;

impl<'s> EventSearch<'s> {
    pub(super) fn new(solid: &'s Solid, motion: &'s Motion, moving: &'s Moving) -> Self {
        let speeds = moving.vertices.iter().map(|(_, m)| m.near_speed()).collect();
        let rate = |(f, r): &(FaceId, BigInt)| (*f, quotient(r, &BigInt::one()) / solid.plane(*f).length);
        let rates = motion.rates().iter().map(rate).collect();
        Self { solid, motion, moving, end: f64::INFINITY, speeds, rates, sides: RefCell::new(None) }
    }

    /// Growing spans of time, the last of them until `end`: in the first no vertex goes farther than the box around all
    /// that move is long.
    pub(super) fn spans(&self, end: f64) -> Vec<f64> {
        let bounds = Aabb::of(self.moving.vertices.iter().map(|(v, _)| self.solid.point(*v).near));
        let fastest = self.speeds.iter().fold(0.0, |fastest: f64, speed| fastest.max(speed.length()));
        let mut spans = Vec::new();
        let mut span = bounds.diagonal() / fastest;
        while spans.len() < SHORT_SPANS && span * 2.0 < end && span.is_normal() {
            spans.push(span);
            span *= SPAN_GROWTH;
        }
        spans.push(end);
        spans
    }

    fn speed(&self, v: VertexId) -> DVec3 {
        self.moving.vertices.binary_search_by_key(&v, |(w, _)| *w).map_or(DVec3::ZERO, |i| self.speeds[i])
    }

    /// The box that a vertex sweeps until the end; everything when there is no end.
    fn swept(&self, v: VertexId) -> Aabb {
        self.swept_in(v, TimeSpan { from: 0.0, to: self.end })
    }

    /// The box that a vertex sweeps in a span of time.
    fn swept_in(&self, v: VertexId, span: TimeSpan) -> Aabb {
        let (start, speed) = (self.solid.point(v).near, self.speed(v));
        let from = start + speed * span.from;
        if span.to.is_finite() {
            let to = start + speed * span.to;
            let margin = (start.abs().max(to.abs()) + (speed * span.to).abs()) * 1e-11;
            return Aabb { min: from.min(to) - margin, max: from.max(to) + margin };
        }
        let reach = |low: bool| {
            DVec3::from_array(std::array::from_fn(|k| {
                let margin = (start[k].abs() + (speed[k] * span.from).abs()) * 1e-11;
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

    fn swept_by_edge(&self, h: HalfEdgeId, span: TimeSpan) -> Aabb {
        let topology = &self.solid.topology;
        grown(self.swept_in(topology.origin(h), span).union(self.swept_in(topology.destination(h), span)))
    }

    fn swept_by_loop(&self, f: FaceId) -> Aabb {
        let exterior = self.solid.topology.loops(f).exterior;
        let corners =
            self.solid.topology.loop_of(exterior).map(|h| self.swept(self.solid.topology.origin(h)));
        grown(corners.fold(Aabb::EMPTY, Aabb::union))
    }

    /// The box of a face of few sides in a span of time; none for others.
    fn swept_by_few(&self, f: FaceId, span: TimeSpan) -> Option<Aabb> {
        let topology = &self.solid.topology;
        let mut bounds = Aabb::EMPTY;
        for (k, h) in topology.loop_of(topology.loops(f).exterior).enumerate() {
            if k == FEW_SIDES {
                return None;
            }
            bounds = bounds.union(self.swept_in(topology.origin(h), span));
        }
        Some(grown(bounds))
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
    pub(super) fn vertices_against_faces(
        &self,
        budget: &Budget,
        out: &mut Candidates,
    ) -> Result<(), Stopped> {
        let topology = &self.solid.topology;
        let sweeps: Vec<Aabb> = self.moving.vertices.iter().map(|(v, _)| grown(self.swept(*v))).collect();
        let all = sweeps.iter().fold(Aabb::EMPTY, |b, s| b.union(*s));
        let near = self.faces_near(&all, budget)?.into_iter().map(|f| (f, self.swept_by_loop(f)));
        let (faces, boxes): (Vec<FaceId>, Vec<Aabb>) =
            near.filter(|(_, bounds)| do_meet(bounds, &all)).unzip();
        each_meeting(&sweeps, &boxes, budget, |i, j| {
            self.try_vertex(self.moving.vertices[i].0, faces[j], &boxes[j], out);
        })?;
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
                    self.try_vertex(v, f, &bounds, out);
                }
            }
        }
        Ok(())
    }

    /// `bounds`: the box that the face sweeps until the end.
    fn try_vertex(&self, v: VertexId, f: FaceId, bounds: &Aabb, out: &mut Candidates) {
        let plane = self.solid.plane(f);
        let rate = self.rate(f);
        let (p, u) = (self.solid.point(v).near, self.speed(v));
        let height = [
            plane.unit.dot(p) - plane.distance,
            (plane.unit.abs().dot(p.abs()) + plane.distance.abs()) * 1e-13,
        ];
        let growth = [plane.unit.dot(u) - rate, (plane.unit.abs().dot(u.abs()) + rate.abs()) * 1e-13];
        let Some(span) = self.in_time(root_span(height, growth)) else { return };
        let there = grown(self.swept_in(v, span));
        let are_near = do_meet(&there, bounds)
            && self.swept_by_few(f, span).is_none_or(|bounds| do_meet(&there, &bounds));
        if are_near && !self.solid.topology.faces_around(v).any(|g| g == f) {
            out.push((span.from, Conflict::VertexFace { vertex: v, face: f }));
        }
    }

    /// The part of a span that is not after the end.
    fn in_time(&self, span: Option<TimeSpan>) -> Option<TimeSpan> {
        let TimeSpan { from, to } = span?;
        (from <= self.end).then_some(TimeSpan { from, to: to.min(self.end) })
    }

    /// How fast the plane of `f` moves, rounded.
    fn rate(&self, f: FaceId) -> f64 {
        self.rates.binary_search_by_key(&f, |(g, _)| *g).map_or(0.0, |i| self.rates[i].1)
    }

    /// The time after 0 at which what would meet is in one plane.
    pub(super) fn root(&self, candidate: &Conflict) -> Option<Rational> {
        match *candidate {
            Conflict::VertexFace { vertex, face } => {
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
            Conflict::EdgeEdge { first, second } => {
                let (c0, c1) = self.coplanarity([first[0], first[1], second[0], second[1]]);
                root_after_zero(&c0, &c1)
            }
            Conflict::EdgeVanishes { .. } | Conflict::LoopLoop { .. } => None,
        }
    }

    /// Edges with a moving plane against all edges.
    pub(super) fn edges_against_edges(&self, budget: &Budget, out: &mut Candidates) -> Result<(), Stopped> {
        let topology = &self.solid.topology;
        let each_once = |sides: &mut dyn Iterator<Item = HalfEdgeId>| {
            let mut edges: Vec<HalfEdgeId> = sides.map(|h| h.min(topology.opposite(h))).collect();
            edges.sort_unstable();
            edges.dedup();
            edges
        };
        let until_end = TimeSpan { from: 0.0, to: self.end };
        let moved = each_once(&mut self.motion.faces().flat_map(|f| topology.sides(f)));
        let sweeps: Vec<Aabb> = moved.iter().map(|&h| self.swept_by_edge(h, until_end)).collect();
        let all = sweeps.iter().fold(Aabb::EMPTY, |b, s| b.union(*s));
        let near = self.faces_near(&all, budget)?;
        let edges = each_once(&mut near.into_iter().flat_map(|f| topology.sides(f)));
        budget.spend(edges.len() as u64 / 16 + 1)?;
        let swept = edges.into_iter().map(|h| (h, self.swept_by_edge(h, until_end)));
        let (near, boxes): (Vec<HalfEdgeId>, Vec<Aabb>) =
            swept.filter(|(_, bounds)| do_meet(bounds, &all)).unzip();
        let is_moved: Vec<bool> = near.iter().map(|h| moved.binary_search(h).is_ok()).collect();
        each_meeting(&sweeps, &boxes, budget, |i, j| {
            let is_second_time = is_moved[j] && near[j] <= moved[i];
            if !is_second_time {
                self.try_edges(moved[i], near[j], out);
            }
        })
    }

    fn try_edges(&self, g: HalfEdgeId, h: HalfEdgeId, out: &mut Candidates) {
        let topology = &self.solid.topology;
        let faces = |h| [topology.face(h), topology.face(topology.opposite(h))];
        let ends = |h| [topology.origin(h), topology.destination(h)];
        let (first, second) = (faces(g), faces(h));
        if first.iter().any(|f| second.contains(f)) || ends(g).iter().any(|v| ends(h).contains(v)) {
            return;
        }
        let coplanarity = self.near_coplanarity([first[0], first[1], second[0], second[1]]);
        let Some(span) = self.in_time(coplanarity) else { return };
        let are_near = do_meet(&self.swept_by_edge(g, span), &self.swept_by_edge(h, span));
        if are_near && self.is_crossable(ends(h), first) {
            out.push((span.from, Conflict::EdgeEdge { first, second }));
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

    /// When four planes may meet in one point.
    fn near_coplanarity(&self, faces: [FaceId; 4]) -> Option<TimeSpan> {
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
        root_span([height, height_error], [growth, growth_error])
    }

    /// The determinant of the rows `(n, d)` of four planes as a function of time, times a positive number.
    fn coplanarity(&self, faces: [FaceId; 4]) -> (BigInt, BigInt) {
        let planes = faces.map(|f| self.solid.plane(f));
        let common = planes.iter().fold(BigInt::one(), |lcm, p| lcm.lcm(p.offset.denom()));
        let (mut c0, mut c1) = (BigInt::ZERO, BigInt::ZERO);
        for k in 0..4 {
            let others: Vec<&super::exact::IntegerVector> =
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
    pub(super) fn do_meet(&self, candidate: &Conflict, s: &Rational) -> bool {
        match *candidate {
            Conflict::VertexFace { vertex, face } => {
                let p = self.moving.at(self.solid, vertex, s);
                let mut kept = self.sides.borrow_mut();
                let is_kept = |kept: &FaceAt| kept.face == face && kept.time == *s;
                let sides = match &mut *kept {
                    Some(kept) if is_kept(kept) => kept,
                    other => other.insert(self.face_at(face, s)),
                };
                let corners = sides.corners.iter().map(|[a, b]| [a, b]);
                self.solid.view(face).locate(&p, corners) != PointLocation::Outside
            }
            Conflict::EdgeEdge { first, second } => self.do_edges_meet(first, second, s),
            Conflict::EdgeVanishes { .. } | Conflict::LoopLoop { .. } => false,
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
    pub(super) fn told(&self, contacts: Vec<Conflict>) -> Vec<Conflict> {
        let topology = &self.solid.topology;
        let tell = |contact: Conflict| {
            let Conflict::VertexFace { vertex, face } = contact else { return contact };
            let beside: Vec<FaceId> =
                topology.sides(face).map(|h| topology.face(topology.opposite(h))).collect();
            match topology.faces_around(vertex).find(|f| beside.contains(f)) {
                Some(common) if topology.loops(common).interior.is_empty() => contact,
                Some(common) => Conflict::LoopLoop { face: common, vertex },
                None => contact,
            }
        };
        let mut told: Vec<Conflict> = contacts.into_iter().map(tell).collect();
        told.sort_unstable();
        told.dedup();
        told
    }
}
