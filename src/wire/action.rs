//! What a step of a repair did.

use serde::Serialize;
use utoipa::ToSchema;

use super::finite::finite;
use super::stitches::Stitches;
use super::words::DefectCode;
use crate::pipeline;

/// One step of a repair.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Action {
    /// Name of the step.
    pub step: &'static str,
    /// The defects that caused it.
    pub causes: Vec<DefectCode>,
    /// What it changed; all zero: there was nothing to do.
    pub changes: Vec<Change>,
    /// Largest distance that a vertex moved, in the unit of the file.
    #[schema(required)]
    pub move_max: Option<f64>,
    /// What was decided where there was a choice; empty otherwise.
    pub reason: String,
    /// The edges that the step joined, one by one; null for steps other than `pinch` and `snap` and for operations other
    /// than `cut-stitch`.
    #[schema(required)]
    pub stitches: Option<Stitches>,
}

/// How many elements a step changed.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Change {
    /// What was changed.
    pub name: &'static str,
    /// How many.
    pub count: u64,
}

impl From<&pipeline::Action> for Action {
    fn from(inner: &pipeline::Action) -> Self {
        Self {
            step: inner.step,
            causes: inner.causes.iter().copied().map(DefectCode::from).collect(),
            changes: inner.changes.iter().map(|&(name, count)| Change { name, count }).collect(),
            move_max: finite(inner.move_max),
            reason: inner.reason.clone(),
            stitches: inner.stitches.as_ref().map(Stitches::from),
        }
    }
}
