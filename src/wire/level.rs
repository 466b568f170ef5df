//! One result of a simplification, in the public words.

use serde::Serialize;
use utoipa::ToSchema;

use super::action::Change;
use super::certificate::Certificate;
use super::distance::Distance;
use super::fidelity::{FidelityChange, fidelity_of};
use super::finite::finite;
use super::target::TargetSpec;
use super::words::{Fidelity, Units};
use crate::{pipeline, simplify};

/// One result of a simplification.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Level {
    /// What was asked.
    pub target: TargetSpec,
    /// False when no more collapses were possible before it was reached.
    pub is_reached: bool,
    /// Faces of the mesh that was simplified.
    pub faces_before: u64,
    /// Faces of the result.
    pub faces_after: u64,
    /// Edges that were collapsed.
    pub collapses: u64,
    /// Collapses that were refused, by reason; an edge that is tried again counts again.
    pub refusals: Vec<Change>,
    /// Largest error of a collapse by the criterion's own measure, in the unit of the file.
    #[schema(required)]
    pub error_max: Option<f64>,
    /// How far the result is from the mesh that was simplified; null: not measured.
    #[schema(required)]
    pub distance: Option<Distance>,
    /// How true the result is to the file; null: not judged.
    #[schema(required)]
    pub fidelity: Option<Fidelity>,
    /// What the result changed; empty unless `fidelity` is `changed`.
    pub changes: Vec<FidelityChange>,
    /// The bytes of the result, judged.
    pub certificate: Certificate,
}

impl Level {
    pub(super) fn new(inner: &pipeline::Level, units: Units) -> Self {
        let report = &inner.simplified;
        let refusals = simplify::SimplifyRefusal::ALL
            .map(|r| Change { name: r.name(), count: report.refusals.count(r) });
        let (fidelity, changes) = fidelity_of(inner.fidelity.as_ref(), units);
        Self {
            target: TargetSpec::of(report.target, units.millimetres()),
            is_reached: report.is_reached,
            faces_before: report.faces_before as u64,
            faces_after: report.faces_after as u64,
            collapses: report.collapses,
            refusals: refusals.into_iter().filter(|refusal| refusal.count > 0).collect(),
            error_max: finite(report.error_max),
            distance: inner.distance.as_ref().map(Distance::from),
            fidelity,
            changes,
            certificate: Certificate::from(&inner.certificate),
        }
    }
}
