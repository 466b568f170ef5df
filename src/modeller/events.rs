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

use super::conflict::Conflict;
use super::exact::{Rational, cross, dot, to_f64};
use super::merged::MergedVertices;
use super::motion::{Motion, Moving, MovingPoint, root_after_zero};
use super::search::EventSearch;
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::{HalfEdgeId, VertexId};
use std::cmp::Ordering;

/// Most elements that are told of one event.
const BLOCKING_MAX: usize = 16;

/// What happens next.
#[derive(Debug, Clone)]
pub(super) struct MotionEvent {
    /// When, after 0.
    pub(super) at: Rational,
    /// The edges that lose their lengths then.
    pub(super) vanishing: Vec<HalfEdgeId>,
    /// What else comes to meet.
    pub(super) contacts: Vec<Conflict>,
}

impl MotionEvent {
    /// All elements that meet.
    pub(super) fn blocking(&self, solid: &Solid) -> Vec<Conflict> {
        let topology = &solid.topology;
        let vanish = |&h: &HalfEdgeId| Conflict::EdgeVanishes {
            faces: [topology.face(h), topology.face(topology.opposite(h))],
            vertices: [topology.origin(h), topology.destination(h)],
        };
        let all = self.vanishing.iter().map(vanish).chain(self.contacts.iter().copied());
        all.take(BLOCKING_MAX).collect()
    }
}

/// The next event of `motion`, or none ever. The motion must keep every vertex on all its planes.
///
/// Contacts are looked for in growing spans of time from 0 on: the longer a span, the more elements may meet in it. The
/// first contact of a span is the first of all.
pub(super) fn next_event(
    solid: &Solid,
    motion: &Motion,
    moving: &Moving,
    budget: &Budget,
) -> Result<Option<MotionEvent>, Stopped> {
    let (vanish_at, vanishing) = first_vanishing(solid, motion, moving);
    let end = vanish_at.as_ref().map_or(f64::INFINITY, rounded_up);
    let merged = MergedVertices::of(solid, &vanishing);
    let is_explained =
        |s: &Rational, contact: &Conflict| vanish_at.as_ref() == Some(s) && merged.explains(solid, contact);
    let mut search = EventSearch::new(solid, motion, moving);
    let mut found = FirstContacts::default();
    for span in search.spans(end) {
        found = first_contact(&mut search, span, vanish_at.as_ref(), &is_explained, budget)?;
        // What meets later than the span ends may not be the first that does.
        if found.at.as_ref().is_some_and(|at| rounded_up(at) <= span) {
            break;
        }
    }
    let FirstContacts { at: first, mut contacts } = found;
    contacts.sort_unstable();
    contacts.dedup();
    Ok(match (first, vanish_at) {
        (None, None) => None,
        (Some(at), Some(end)) if at == end => {
            Some(MotionEvent { at, vanishing, contacts: search.told(contacts) })
        }
        (Some(at), _) => Some(MotionEvent { at, vanishing: Vec::new(), contacts: search.told(contacts) }),
        (None, Some(at)) => Some(MotionEvent { at, vanishing, contacts }),
    })
}

/// The first contacts until `end`; where there are none before it, those that were found to come later, or none.
fn first_contact(
    search: &mut EventSearch<'_>,
    end: f64,
    vanish_at: Option<&Rational>,
    is_explained: &dyn Fn(&Rational, &Conflict) -> bool,
    budget: &Budget,
) -> Result<FirstContacts, Stopped> {
    search.end = end;
    let mut found = FirstContacts::default();
    let is_in_time = |s: &Rational| vanish_at.is_none_or(|end| s <= end);
    // What vertices find ends the time for edges.
    for search_for in [EventSearch::vertices_against_faces, EventSearch::edges_against_edges] {
        let mut candidates = Vec::new();
        search_for(search, budget, &mut candidates)?;
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
    Ok(found)
}

/// The first contacts that are known.
#[derive(Default)]
struct FirstContacts {
    at: Option<Rational>,
    contacts: Vec<Conflict>,
}

impl FirstContacts {
    fn is_before(&self, s: &Rational) -> bool {
        match &self.at {
            Some(at) => at < s || (at == s && self.contacts.len() >= BLOCKING_MAX),
            None => false,
        }
    }

    fn take(&mut self, s: Rational, contact: Conflict) {
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
