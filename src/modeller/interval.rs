//! The open interval by which faces may move without an event.

use super::conflict::Conflict;
use super::events::next_event;
use super::exact::Rational;
use super::motion::{Motion, Moving};
use super::operator::limit;
use super::refusal::OperatorRefusal;
use super::settle::settle;
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::{FaceId, VertexId};
use num_traits::{Signed, Zero};

/// One side of the interval by which faces may move.
#[derive(Debug, Clone, PartialEq)]
pub enum IntervalSide {
    /// As far as one likes.
    Unbounded,
    /// By less than this.
    Limit {
        /// The growth of the offset of each moving face at the event.
        limits: Vec<(FaceId, Rational)>,
        /// What would meet.
        blocking: Vec<Conflict>,
    },
    /// Not at all: a vertex has no good split in this direction.
    Blocked {
        /// The vertex.
        vertex: VertexId,
    },
}

/// The open interval by which the faces may move together without an event, as its two sides: with negative and with
/// positive multiples of `shifts`.
///
/// # Errors
/// When the budget stops the run.
pub fn range(
    solid: &Solid,
    shifts: &[(FaceId, Rational)],
    budget: &Budget,
) -> Result<[IntervalSide; 2], Stopped> {
    let opposite: Vec<(FaceId, Rational)> = shifts.iter().map(|(f, t)| (*f, -t)).collect();
    Ok([one_side(solid, &opposite, budget)?, one_side(solid, shifts, budget)?])
}

fn one_side(solid: &Solid, shifts: &[(FaceId, Rational)], budget: &Budget) -> Result<IntervalSide, Stopped> {
    let Some((motion, _)) = Motion::of(shifts) else { return Ok(IntervalSide::Unbounded) };
    let settled = match settle(solid, &motion, budget)? {
        Ok(settled) => settled,
        Err(vertex) => return Ok(IntervalSide::Blocked { vertex }),
    };
    let solid = settled.as_ref();
    let Ok(moving) = Moving::of(solid, &motion) else { return Ok(IntervalSide::Unbounded) };
    Ok(match next_event(solid, &motion, &moving, budget)? {
        None => IntervalSide::Unbounded,
        Some(event) => match limit(solid, &motion, &Rational::zero(), &event) {
            OperatorRefusal::Limit { limits, blocking } => IntervalSide::Limit { limits, blocking },
            _ => IntervalSide::Unbounded,
        },
    })
}

/// How much the offset of a plane grows when its face moves by `distance`, rounded once to an f64.
pub fn offset_growth(solid: &Solid, face: FaceId, distance: f64) -> Rational {
    super::exact::rational(distance * solid.plane(face).length)
}

/// The distance by which a face moves when its offset grows by `t`; never farther from 0 than the true one.
pub fn distance_of_growth(solid: &Solid, face: FaceId, t: &Rational) -> f64 {
    let near = super::exact::to_f64(t) / solid.plane(face).length;
    let inward = near * (1.0 - 4.0 * f64::EPSILON);
    if t.is_negative() { inward.min(0.0) } else { inward.max(0.0) }
}
