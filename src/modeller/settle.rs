//! A solid as it is just after a motion has begun: vertices whose planes do not stay in one point are split.

use super::motion::{Motion, Moving};
use super::near::tree;
use super::resolve;
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::VertexId;
use std::borrow::Cow;

/// The solid with every vertex split that `motion` takes apart; `Err` with one that has no good split in this direction.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn settle<'s>(
    solid: &'s Solid,
    motion: &Motion,
    budget: &Budget,
) -> Result<Result<Cow<'s, Solid>, VertexId>, Stopped> {
    let unsettled = Moving::unsettled(solid, motion);
    if unsettled.is_empty() {
        return Ok(Ok(Cow::Borrowed(solid)));
    }
    tree(solid, budget)?;
    let mut copy = solid.clone();
    for vertex in unsettled {
        if resolve::split(&mut copy, motion, vertex).is_none() {
            return Ok(Err(vertex));
        }
    }
    Ok(Ok(Cow::Owned(copy)))
}
