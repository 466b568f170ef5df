//! The printing report as JSON: checks against a policy, and the figures of a quote.
//!
//! All lengths are in millimetres, whatever the unit of the file, because policies and prices are; areas and volumes in
//! their squares and cubes, angles in degrees. Only places of witnesses are in the unit of the file.

mod figures;
mod policy;
mod sentence;
mod words;

pub use figures::{Edges, OrientedBox, Overhang, Parts, Quote, Spread, Thickness};
pub use policy::{PolicyInfo, PolicyLimit, PolicyVolume, policies};
pub use words::{BoundKind, BuildDirection, CheckCode, Fit, PolicyName, PrintedMesh, PrintingUnit, Status};

use serde::Serialize;
use utoipa::ToSchema;

use super::finite::{finite, point};
use crate::{pipeline, printing};

/// A mesh measured for printing. Lengths are in millimetres, areas and volumes in their squares and cubes, angles in
/// degrees.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Printing {
    /// Name of the process.
    pub policy: &'static str,
    /// Version of its limits.
    pub policy_version: u32,
    /// The mesh that was measured.
    pub about: PrintedMesh,
    /// What is up in the machine.
    pub build_direction: BuildDirection,
    /// The worst of all checks.
    pub verdict: Status,
    /// P3: no check is an error, on a valid solid. Measured, not proved. Null: no error was found, but the mesh is not a
    /// valid solid.
    #[schema(required)]
    pub p3_holds: Option<bool>,
    /// One for each limit of the policy.
    pub checks: Vec<PrintingCheck>,
    /// How the part fits the largest box; null: the policy has none.
    #[schema(required)]
    pub fit: Option<Fit>,
    /// Thickness of walls.
    pub walls: Thickness,
    /// Width of gaps between walls.
    pub gaps: Thickness,
    /// Faces flatter than this angle from the horizontal need support.
    pub overhang_limit: f64,
    /// What needs support with each direction up.
    pub overhangs: Vec<Overhang>,
    /// Sharp and short edges.
    pub edges: Edges,
    /// Parts of their own and cavities.
    pub parts: Parts,
    /// What a price depends on.
    pub quote: Quote,
}

/// One check.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct PrintingCheck {
    /// What was checked.
    pub code: CheckCode,
    /// What came of it; null: it cannot be told, because the mesh is not a valid solid.
    #[schema(required)]
    pub status: Option<Status>,
    /// The figure that decides; null: there is nothing to measure.
    #[schema(required)]
    pub measured: Option<f64>,
    /// Unit of the figure and its limits.
    pub unit: PrintingUnit,
    /// Limit of a warning; null: none.
    #[schema(required)]
    pub warning: Option<f64>,
    /// Limit of an error; null: none.
    #[schema(required)]
    pub error: Option<f64>,
    /// The outcome in a sentence.
    pub message: String,
    /// Where the mesh goes beyond the limits, the worst first.
    pub witnesses: Vec<PrintingWitness>,
}

/// A place where the mesh goes beyond a limit.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct PrintingWitness {
    /// Face of the mesh that was measured, from 0.
    pub face: u32,
    /// Where on it, in the unit of the file.
    #[schema(required)]
    pub position: Option<[f64; 3]>,
    /// What was measured there: in the unit of the check; of a cavity its volume.
    #[schema(required)]
    pub measured: Option<f64>,
}

impl Printing {
    /// The public form of what was measured on a file of which one unit is so many millimetres.
    pub(super) fn new(inner: &pipeline::PrintingReport, millimetres: f64) -> Self {
        let of = &inner.printing;
        let figures = &of.figures;
        Self {
            policy: of.policy.name,
            policy_version: of.policy.version,
            about: if inner.is_about_result { PrintedMesh::Result } else { PrintedMesh::Input },
            build_direction: of.policy.build_direction.into(),
            verdict: of.verdict().into(),
            p3_holds: of.holds(),
            checks: of.checks.iter().map(|check| PrintingCheck::new(check, inner, millimetres)).collect(),
            fit: of.fit.map(Fit::from),
            walls: Thickness::new(&figures.walls, millimetres),
            gaps: Thickness::new(&figures.gaps, millimetres),
            overhang_limit: figures.overhang_limit,
            overhangs: figures.overhangs.iter().map(|o| Overhang::new(o, millimetres)).collect(),
            edges: Edges::new(&figures.edges, millimetres),
            parts: Parts::new(&figures.parts, millimetres),
            quote: Quote::new(&figures.quote, of.is_solid, millimetres),
        }
    }
}

impl PrintingCheck {
    fn new(inner: &printing::Check, report: &pipeline::PrintingReport, millimetres: f64) -> Self {
        let code = CheckCode::from(inner.code);
        let factor = if code.unit() == PrintingUnit::Millimetres { millimetres } else { 1.0 };
        let of_witness = if code == CheckCode::Cavity { millimetres.powi(3) } else { factor };
        let witness = |witness: &printing::PrintingWitness| PrintingWitness {
            face: report.face_of(witness.triangle),
            position: point(&witness.place),
            measured: finite(witness.measured * of_witness),
        };
        let scaled = |value: Option<f64>| value.and_then(|value| finite(value * factor));
        Self {
            code,
            status: inner.status.map(Status::from),
            measured: scaled(inner.measured),
            unit: code.unit(),
            warning: scaled(inner.limit.warning).map(as_in_policy),
            error: scaled(inner.limit.error).map(as_in_policy),
            message: sentence::of(code, inner.status.map(Status::from), &report.printing, millimetres),
            witnesses: inner.witnesses.iter().map(witness).collect(),
        }
    }
}

/// A limit as the policy has it: on the way to the unit of the file and back it was rounded, and no policy has more than nine
/// decimals.
fn as_in_policy(limit: f64) -> f64 {
    (limit * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests;
