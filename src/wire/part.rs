//! What was done with a part of a file, as JSON.

use serde::Serialize;
use utoipa::ToSchema;

use super::action::Action;
use super::finite::finite;
use super::proposal::Plan;
use super::verdict::Verdict;
use crate::pipeline;

/// A part of a file that was handled by itself, in its own coordinates.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Part {
    /// Where in the file it is, such as `/3D/3dmodel.model`.
    pub path: String,
    /// Its id there.
    pub object: u32,
    /// Its name; empty when it has none.
    pub name: String,
    /// Its number among the volumes of the object; null: the object is one part.
    #[schema(required)]
    pub volume: Option<u32>,
    /// How often the file has it at a place.
    pub instances: u32,
    /// Number of its first face, where faces are numbered through all parts.
    pub first_face: u32,
    /// Triangles of the part as uploaded.
    pub triangles_before: u64,
    /// Triangles of the part as returned; null: it is not returned.
    #[schema(required)]
    pub triangles_after: Option<u64>,
    /// The conclusion about the part.
    pub verdict: Verdict,
    /// What may be done about each defect of the part, and the steps that made its result; null for operations other than
    /// `plan` and `repair`.
    #[schema(required)]
    pub plan: Option<Plan>,
    /// The steps that ran, in their order.
    pub actions: Vec<Action>,
    /// What became of what the file says of its faces, such as colours and paint; null: the part kept its bytes, or there is
    /// nothing.
    #[schema(required)]
    pub attributes: Option<Attributes>,
}

/// What became of what a file says of faces, in triangles of the result.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct Attributes {
    /// They are faces of the file and keep all.
    pub kept: u64,
    /// They are parts of such faces, were turned around or moved, and have what the faces have at their places: what is between
    /// the values at corners where these differ.
    pub from_face: u64,
    /// They are new, and take what is on the nearest face of the file.
    pub from_nearest: u64,
    /// They miss paint of a slicer that divides the face behind them, and have the rest of what is said of it.
    pub lost: u64,
    /// Share of the area of the result that keeps all, from 0 to 1.
    #[schema(required)]
    pub kept_area_share: Option<f64>,
    /// Share of the area of the result that misses paint, from 0 to 1.
    #[schema(required)]
    pub lost_area_share: Option<f64>,
}

impl From<&pipeline::PartReport> for Part {
    fn from(inner: &pipeline::PartReport) -> Self {
        let (facts, report) = (&inner.facts, &inner.report);
        Self {
            path: facts.path.clone(),
            object: facts.object,
            name: facts.name.clone(),
            volume: facts.volume,
            instances: facts.instances,
            first_face: facts.first_face,
            triangles_before: report.input_certificate.triangles,
            triangles_after: report.certificate.as_ref().map(|certificate| certificate.triangles),
            verdict: Verdict::of(report),
            plan: report.plan.as_ref().map(Plan::from),
            actions: report.actions.iter().map(Action::from).collect(),
            attributes: inner.attributes.as_ref().map(Attributes::from),
        }
    }
}

impl From<&pipeline::AttributeCounts> for Attributes {
    fn from(inner: &pipeline::AttributeCounts) -> Self {
        let &pipeline::AttributeCounts {
            kept,
            from_face,
            from_nearest,
            lost,
            kept_area_share,
            lost_area_share,
        } = inner;
        let [kept_area_share, lost_area_share] = [kept_area_share, lost_area_share].map(finite);
        Self { kept, from_face, from_nearest, lost, kept_area_share, lost_area_share }
    }
}
