//! What the guarded mode knows of the input, and how a round was run.

use super::shells::ClosedShells;
use super::strays::Strays;
use std::sync::Arc;

/// What the guarded mode knows of the input.
pub(super) struct Guard {
    pub(super) shells: ClosedShells,
    /// For each reading that the surface must be sound in, whether coordinates are rounded to f32 in it.
    pub(super) roundings: Vec<bool>,
}

impl Guard {
    pub(super) fn new(shells: ClosedShells, is_f32_exact: bool) -> Self {
        Self { shells, roundings: if is_f32_exact { vec![false] } else { vec![false, true] } }
    }
}

/// How a round was run.
#[derive(Clone)]
pub(super) struct RoundConditions {
    /// The first round prepares the vertices.
    pub(super) is_first: bool,
    /// The last class that parts went to.
    pub(super) class_max: usize,
    /// What parts must not meet.
    pub(super) strays: Option<Arc<Strays>>,
}
