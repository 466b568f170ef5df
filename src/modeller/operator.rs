//! The operators: Face Shift, Point Split, Point Merge and Edge Flip. All are planes in motion, with what happens to the
//! topology at events along the way:
//!
//! ```text
//!      before              at the event          after
//!
//!    \   3   /               \ 3 /              \   3   /
//!  1  \_____/  2     ->     1  X  2     ->     1 \     / 2
//!     /  4  \                / 4 \                | | |       an edge flip: 3 and 4 part, 1 and 2 meet
//!    /       \              /     \              /   4   \
//! ```
//!
//! Edges that lose their lengths are contracted (a merge), and a vertex whose planes do not stay concurrent is split for
//! what comes just after. So an edge flip is a merge and a split.

use super::approach::{Approach, approaches, no_split};
use super::events::{MotionEvent, next_event};
use super::exact::{Rational, det, sign};
use super::journal::Journal;
use super::motion::{Motion, Moving};
use super::refusal::OperatorRefusal;
use super::resolve;
use super::solid::Solid;
use super::validity::check_changed;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::{ContractRefusal, FaceId, HalfEdgeId, VertexId};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;

/// Most events that one operator passes.
const EVENTS_MAX: usize = 1000;

/// What a shift does at an event that edges which lose their lengths make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum EventPolicy {
    /// It is refused: the shift must stay inside the open interval.
    #[default]
    Refuse,
    /// It goes on with another topology where that is good.
    Pass,
}

/// An edit. Lengths `t` are in the scale of the stored planes: the offset grows by `t`.
#[derive(Debug, Clone, PartialEq)]
pub enum Operator {
    /// Faces move along their normals.
    Shift {
        /// Each face and how much its offset grows.
        faces: Vec<(FaceId, Rational)>,
        /// What is done at events.
        events: EventPolicy,
    },
    /// A vertex of degree above three becomes several because one of its faces moves.
    Split {
        /// The vertex.
        vertex: VertexId,
        /// The face that moves.
        face: FaceId,
        /// How much its offset grows.
        by: Rational,
    },
    /// A face moves until an edge has no length; its ends become one vertex.
    Merge {
        /// The edge.
        edge: HalfEdgeId,
        /// The face that moves.
        face: FaceId,
    },
    /// A face moves until an edge has no length and a little on: the faces at its ends become neighbours.
    Flip {
        /// The edge.
        edge: HalfEdgeId,
        /// The face that moves.
        face: FaceId,
        /// How much its offset grows in all; `None`: past the event by half of the way to it, or half of the way to the
        /// next one if that is less.
        by: Option<Rational>,
    },
}

/// A change of topology along the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TopologyChange {
    /// An edge became a vertex: the faces beside it.
    Merged([FaceId; 2]),
    /// A vertex became an edge: the faces beside it.
    Split([FaceId; 2]),
}

/// What an operator did.
#[derive(Debug, Clone)]
pub struct Applied {
    /// How much the offset of each face grew.
    pub shifts: Vec<(FaceId, Rational)>,
    /// The changes of topology, in their order.
    pub changes: Vec<TopologyChange>,
    /// The faces that moved or have a vertex that did.
    pub changed_faces: Vec<FaceId>,
    journal: Journal,
}

impl Applied {
    /// Takes the operator back, which must be the last that was applied: the same planes and topology as before.
    pub fn undo(self, solid: &mut Solid) {
        self.journal.restore(solid);
    }

    /// The operator that leads back to the same planes and topology. Where the topology has changed it is tried first:
    /// `None` when the way back is another one.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn inverse(&self, solid: &Solid, budget: &Budget) -> Result<Option<Operator>, Stopped> {
        let faces: Vec<(FaceId, Rational)> = self.shifts.iter().map(|(f, t)| (*f, -t)).collect();
        let events = if self.changes.is_empty() { EventPolicy::Refuse } else { EventPolicy::Pass };
        let inverse = Operator::Shift { faces, events };
        if self.changes.is_empty() {
            return Ok(Some(inverse));
        }
        let mut trial = solid.clone();
        let leads_back =
            apply(&mut trial, &inverse, budget)?.is_ok() && self.journal.is_state_of(&trial, solid);
        Ok(leads_back.then_some(inverse))
    }
}

/// How far an edit goes.
enum Until {
    Time(Rational),
    /// Up to the first event, where edges are merged.
    FirstEvent,
    /// Past the first event by half of the way to it, or half of the way to the next one if that is less.
    PastFirstEvent,
}

/// Applies an operator. A refused one changes nothing.
///
/// # Errors
/// When the budget stops the run; `solid` is as before then.
pub fn apply(
    solid: &mut Solid,
    operator: &Operator,
    budget: &Budget,
) -> Result<Result<Applied, OperatorRefusal>, Stopped> {
    match operator {
        Operator::Shift { faces, events } => run_shift(solid, faces, *events, budget),
        Operator::Split { vertex, face, by } => {
            let around: Vec<FaceId> = solid.topology.faces_around(*vertex).collect();
            if !around.contains(face) {
                return Ok(Err(OperatorRefusal::NotThere { face: *face }));
            }
            if around.len() < 4 {
                return Ok(Err(OperatorRefusal::VertexIsTrihedral { vertex: *vertex }));
            }
            run_shift(solid, &[(*face, by.clone())], EventPolicy::Refuse, budget)
        }
        Operator::Merge { edge, face } => merge(solid, *edge, *face, budget),
        Operator::Flip { edge, face, by } => flip(solid, *edge, *face, by.as_ref(), budget),
    }
}

fn run_shift(
    solid: &mut Solid,
    faces: &[(FaceId, Rational)],
    events: EventPolicy,
    budget: &Budget,
) -> Result<Result<Applied, OperatorRefusal>, Stopped> {
    match Motion::of(faces) {
        Some((motion, time)) => run(solid, &motion, &Until::Time(time), events, budget),
        None => Ok(Err(OperatorRefusal::NothingMoves)),
    }
}

/// Moves `face` until the edge of `h` has no length, in the first direction in which that is good.
fn merge(
    solid: &mut Solid,
    h: HalfEdgeId,
    face: FaceId,
    budget: &Budget,
) -> Result<Result<Applied, OperatorRefusal>, Stopped> {
    let motions: Vec<Motion> = match approaches(solid, h, face, budget)? {
        Ok(found) => found.into_iter().map(|approach| approach.motion).collect(),
        Err(refusal) => return Ok(Err(refusal)),
    };
    let mut first = None;
    for motion in motions {
        let done = run(solid, &motion, &Until::FirstEvent, EventPolicy::Pass, budget)?;
        match done.and_then(|applied| keep_if_merged(solid, applied, h)) {
            Ok(applied) => return Ok(Ok(applied)),
            Err(refusal) => first = first.or(Some(refusal)),
        }
    }
    Ok(Err(first.unwrap_or(OperatorRefusal::EdgeStays)))
}

/// A merge that stopped at another event is taken back.
fn keep_if_merged(solid: &mut Solid, applied: Applied, edge: HalfEdgeId) -> Result<Applied, OperatorRefusal> {
    if !solid.topology.contains(edge) {
        return Ok(applied);
    }
    let limits = applied.shifts.clone();
    applied.undo(solid);
    Err(OperatorRefusal::Limit { limits, blocking: Vec::new() })
}

/// The flip of an edge between faces 1 and 2 whose ends are on faces 3 and 4.
fn flip(
    solid: &mut Solid,
    h: HalfEdgeId,
    face: FaceId,
    by: Option<&Rational>,
    budget: &Budget,
) -> Result<Result<Applied, OperatorRefusal>, Stopped> {
    let mut found = match approaches(solid, h, face, budget)? {
        Ok(found) => found,
        Err(refusal) => return Ok(Err(bad_flip(solid, h).unwrap_or(refusal))),
    };
    // The direction that is asked for goes first.
    found
        .sort_by_key(|approach| by.is_some_and(|by| (by / approach.motion.rate_or_zero(face)).is_negative()));
    let mut plans = Vec::new();
    let mut first = None;
    for approach in &found {
        match flip_plan(approach, h, face, by, budget)? {
            Ok(until) => {
                let splits = approach.settled.topology.vertices().count() - solid.topology.vertices().count();
                plans.push((approach.motion.clone(), until, end_faces(&approach.settled, h), splits));
            }
            Err(refusal) => first = first.or(Some(refusal)),
        }
    }
    drop(found);
    for (motion, until, ends, splits) in plans {
        let refusal = match run(solid, &motion, &until, EventPolicy::Pass, budget)? {
            Err(OperatorRefusal::NoSplit { .. }) => OperatorRefusal::DoesNotOpen { faces: ends },
            // The merged vertex must not have opened the old way.
            Ok(applied) if applied.changes.len() != splits + 2 => {
                applied.undo(solid);
                OperatorRefusal::DoesNotOpen { faces: ends }
            }
            Ok(applied) => return Ok(Ok(applied)),
            Err(refusal) => refusal,
        };
        first = first.or(Some(refusal));
    }
    Ok(Err(first.unwrap_or(OperatorRefusal::EdgeStays)))
}

/// How far a flip goes on one approach.
fn flip_plan(
    approach: &Approach<'_>,
    h: HalfEdgeId,
    face: FaceId,
    by: Option<&Rational>,
    budget: &Budget,
) -> Result<Result<Until, OperatorRefusal>, Stopped> {
    let Approach { motion, settled, moving, time } = approach;
    if let Some(refusal) = bad_flip(settled, h) {
        return Ok(Err(refusal));
    }
    // The first event must be this edge's, alone.
    let event = next_event(settled, motion, moving, budget)?;
    let Some(event) = event else { return Ok(Err(OperatorRefusal::EdgeStays)) };
    let too_early = limit(settled, motion, &Rational::zero(), &event);
    if event.at != *time || !event.contacts.is_empty() {
        return Ok(Err(too_early));
    }
    if event.vanishing.len() != 1 {
        return Ok(Err(OperatorRefusal::SeveralVanish { count: event.vanishing.len() }));
    }
    Ok(match by.map(|by| by / motion.rate_or_zero(face)) {
        None => Ok(Until::PastFirstEvent),
        Some(asked) if asked <= *time => Err(too_early),
        Some(asked) => Ok(Until::Time(asked)),
    })
}

/// The faces at the ends of an edge, before and behind it.
fn end_faces(solid: &Solid, h: HalfEdgeId) -> [FaceId; 2] {
    let topology = &solid.topology;
    let beyond = |h: HalfEdgeId| topology.face(topology.opposite(topology.next(h)));
    [beyond(topology.opposite(h)), beyond(h)]
}

/// The reason why the edge of `h` cannot be flipped, as far as topology and normals tell it.
fn bad_flip(solid: &Solid, h: HalfEdgeId) -> Option<OperatorRefusal> {
    let topology = &solid.topology;
    let beside = [h, topology.opposite(h)].map(|h| topology.face(h));
    for g in [h, topology.opposite(h)] {
        if topology.loop_of(g).count() == 3 {
            return Some(OperatorRefusal::FaceHasThreeSides { face: topology.face(g) });
        }
    }
    let ends = end_faces(solid, h);
    if ends[0] == ends[1] {
        return Some(OperatorRefusal::EndsAreOneFace { face: ends[0] });
    }
    let [a, b] = [topology.origin(h), topology.destination(h)];
    if [a, b].iter().any(|&v| topology.edge_between_at(ends[0], ends[1], v).is_some()) {
        return Some(OperatorRefusal::EndsAreNeighbours { faces: ends });
    }
    let is_trihedral = [a, b].iter().all(|&v| topology.faces_around(v).count() == 3);
    let [n1, n2] = beside.map(|f| &solid.plane(f).normal);
    let [n3, n4] = ends.map(|f| &solid.plane(f).normal);
    let signs = [sign(&det(n3, n4, n1)), sign(&det(n3, n4, n2))];
    let opens = signs[0] != Ordering::Equal && signs[0] == signs[1].reverse();
    // At reflex edges the split itself is tried: the determinants alone do not decide it.
    (is_trihedral && !opens && is_convex_around(solid, h))
        .then_some(OperatorRefusal::DoesNotOpen { faces: ends })
}

/// True when the edge and all edges at its ends are convex.
fn is_convex_around(solid: &Solid, h: HalfEdgeId) -> bool {
    let topology = &solid.topology;
    let is_convex = |h: HalfEdgeId| {
        let [left, right] = [h, topology.opposite(h)].map(|h| &solid.plane(topology.face(h)).normal);
        sign(&det(left, right, &solid.direction(h))) == Ordering::Greater
    };
    topology.around(h).chain(topology.around(topology.opposite(h))).all(is_convex)
}

pub(super) fn limit(
    solid: &Solid,
    motion: &Motion,
    passed: &Rational,
    event: &MotionEvent,
) -> OperatorRefusal {
    let time = passed + &event.at;
    let limits = motion.rates().iter().map(|(f, rate)| (*f, &time * rate)).collect();
    OperatorRefusal::Limit { limits, blocking: event.blocking(solid) }
}

/// Runs a motion, checks what it changed, and takes everything back when it is refused or stopped.
fn run(
    solid: &mut Solid,
    motion: &Motion,
    until: &Until,
    events: EventPolicy,
    budget: &Budget,
) -> Result<Result<Applied, OperatorRefusal>, Stopped> {
    let mut run = ShiftRun { journal: Journal::begin(solid), changes: Vec::new(), passed: Rational::zero() };
    let result = match run.advance(solid, motion, until, events, budget) {
        Ok(Ok(())) => {
            let moves = run.journal.moves(solid);
            check_changed(solid, &moves, budget).map(|faults| match faults.into_iter().next() {
                None => Ok(moves.faces),
                Some(fault) => Err(OperatorRefusal::Invalid(fault)),
            })
        }
        Ok(Err(refusal)) => Ok(Err(refusal)),
        Err(stopped) => Err(stopped),
    };
    match result {
        Ok(Ok(changed_faces)) => {
            let shifts = motion.rates().iter().map(|(f, rate)| (*f, &run.passed * rate)).collect();
            Ok(Ok(Applied { shifts, changes: run.changes, changed_faces, journal: run.journal }))
        }
        Ok(Err(refusal)) => {
            run.journal.restore(solid);
            Ok(Err(refusal))
        }
        Err(stopped) => {
            run.journal.restore(solid);
            Err(stopped)
        }
    }
}

struct ShiftRun {
    journal: Journal,
    changes: Vec<TopologyChange>,
    passed: Rational,
}

impl ShiftRun {
    fn advance(
        &mut self,
        solid: &mut Solid,
        motion: &Motion,
        until: &Until,
        events: EventPolicy,
        budget: &Budget,
    ) -> Result<Result<(), OperatorRefusal>, Stopped> {
        for count in 0..EVENTS_MAX {
            if let Err(refusal) = self.split_vertices(solid, motion) {
                return Ok(Err(refusal));
            }
            let moving = match Moving::of(solid, motion) {
                Ok(moving) => moving,
                Err(vertex) => return Ok(Err(no_split(solid, vertex))),
            };
            let event = next_event(solid, motion, &moving, budget)?;
            let end = self.end(until, count, event.as_ref());
            match (event, end) {
                (event, Some(end)) if event.as_ref().is_none_or(|e| end < e.at) => {
                    self.journal.advance(solid, motion, &moving, &end);
                    self.passed += end;
                    return Ok(Ok(()));
                }
                (None, _) => return Ok(Err(OperatorRefusal::EdgeStays)),
                (Some(event), end) => {
                    let must_stop = events == EventPolicy::Refuse || !event.contacts.is_empty();
                    if must_stop {
                        return Ok(Err(limit(solid, motion, &self.passed, &event)));
                    }
                    if let Err(refusal) = self.pass(solid, motion, &moving, &event) {
                        return Ok(Err(refusal));
                    }
                    let is_at_end =
                        matches!(until, Until::FirstEvent) || end.is_some_and(|end| end == event.at);
                    if is_at_end {
                        return Ok(Ok(()));
                    }
                }
            }
        }
        Ok(Err(OperatorRefusal::TooManyEvents { limit: EVENTS_MAX }))
    }

    /// The time that is left, if the goal is a time.
    fn end(&self, until: &Until, count: usize, event: Option<&MotionEvent>) -> Option<Rational> {
        match until {
            Until::Time(time) => Some(time - &self.passed),
            Until::FirstEvent => None,
            Until::PastFirstEvent if count == 0 => None,
            Until::PastFirstEvent => {
                let room =
                    event.map_or_else(|| self.passed.clone(), |e| e.at.clone().min(self.passed.clone()));
                Some(super::exact::shortened(&(room / BigInt::from(2)), 64))
            }
        }
    }

    /// Splits every vertex whose planes do not stay concurrent.
    fn split_vertices(&mut self, solid: &mut Solid, motion: &Motion) -> Result<(), OperatorRefusal> {
        for vertex in Moving::unsettled(solid, motion) {
            self.journal.keep_topology(solid);
            let edges = resolve::split(solid, motion, vertex).ok_or_else(|| no_split(solid, vertex))?;
            let topology = &solid.topology;
            let beside = |h: HalfEdgeId| [topology.face(h), topology.face(topology.opposite(h))];
            self.changes.extend(edges.into_iter().map(|h| TopologyChange::Split(beside(h))));
        }
        Ok(())
    }

    /// Goes to an event and contracts the edges that have no length there.
    fn pass(
        &mut self,
        solid: &mut Solid,
        motion: &Motion,
        moving: &Moving,
        event: &MotionEvent,
    ) -> Result<(), OperatorRefusal> {
        self.journal.keep_topology(solid);
        self.journal.advance(solid, motion, moving, &event.at);
        self.passed += &event.at;
        for &h in &event.vanishing {
            let beside = [h, solid.topology.opposite(h)].map(|h| solid.topology.face(h));
            solid.topology.contract(h).map_err(|refusal| match refusal {
                ContractRefusal::FaceVanishes(face) => OperatorRefusal::FaceVanishes { face },
                ContractRefusal::FaceAtBothEnds(face) => OperatorRefusal::LinkNotADisk { face },
            })?;
            self.changes.push(TopologyChange::Merged(beside));
        }
        Ok(())
    }
}
