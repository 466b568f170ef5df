//! The ways in which one face takes the length from an edge: outward and inward, each with the splits of its beginning.

use super::events::vanishing_time;
use super::exact::Rational;
use super::motion::{Motion, Moving};
use super::refusal::OperatorRefusal;
use super::settle::settle;
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use num_bigint::BigInt;
use std::borrow::Cow;

/// A motion of one face that takes the length from an edge.
pub(super) struct Approach<'s> {
    pub(super) motion: Motion,
    /// The solid just after the motion has begun, with vertices split that it takes apart.
    pub(super) settled: Cow<'s, Solid>,
    pub(super) moving: Moving,
    /// When the edge has no length.
    pub(super) time: Rational,
}

/// The motions of `face` alone, outward and inward, that take the length from the edge of `h`: one at least.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn approaches<'s>(
    solid: &'s Solid,
    h: HalfEdgeId,
    face: FaceId,
    budget: &Budget,
) -> Result<Result<Vec<Approach<'s>>, OperatorRefusal>, Stopped> {
    let topology = &solid.topology;
    let is_at_an_end = [topology.origin(h), topology.destination(h)]
        .iter()
        .any(|&v| topology.faces_around(v).any(|f| f == face));
    if !is_at_an_end {
        return Ok(Err(OperatorRefusal::NotThere { face }));
    }
    let (mut found, mut refusal) = (Vec::new(), OperatorRefusal::EdgeStays);
    for rate in [1, -1] {
        let Some((motion, _)) = Motion::of(&[(face, Rational::from_integer(BigInt::from(rate)))]) else {
            continue;
        };
        let settled = match settle(solid, &motion, budget)? {
            Ok(settled) => settled,
            Err(vertex) => {
                refusal = no_split(solid, vertex);
                continue;
            }
        };
        let Ok(moving) = Moving::of(&settled, &motion) else { continue };
        if let Some(time) = vanishing_time(&settled, &motion, &moving, h) {
            found.push(Approach { motion, settled, moving, time });
        }
    }
    Ok(if found.is_empty() { Err(refusal) } else { Ok(found) })
}

/// The refusal of a motion that takes a vertex apart for which there is no good split.
pub(super) fn no_split(solid: &Solid, vertex: VertexId) -> OperatorRefusal {
    OperatorRefusal::NoSplit { vertex, faces: solid.topology.faces_around(vertex).collect() }
}
