//! The report as JSON, schema `meshmend.report/1`: what the file is, what was done, what came out, and why.
//!
//! null means not computed, never zero. Numbers that are not finite become null as well.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::action::Action;
use super::certificate::{Certificate, hex};
use super::distance::Distance;
use super::finite::finite;
use super::holes::Hole;
use super::level::Level;
use super::mesh_info::MeshInfo;
use super::modeller::Modeller;
use super::part::Part;
use super::printing::Printing;
use super::proposal::Plan;
use super::verdict::Verdict;
use super::words::{Encoding, Format, Operation, Stage, Units};
use crate::{analysis, pipeline};

/// The account of a run.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Report {
    /// Name of this schema: `meshmend.report/1`.
    pub schema: &'static str,
    /// What was asked.
    pub operation: Operation,
    /// Who made it.
    pub engine: EngineInfo,
    /// The uploaded bytes; of several meshes, the first.
    pub input: InputInfo,
    /// The meshes after the first, in their order; empty but for `boolean`.
    pub further_inputs: Vec<FurtherInput>,
    /// The mesh as uploaded; null: not analyzed.
    #[schema(required)]
    pub before: Option<MeshInfo>,
    /// Unit of the result, and of every length, area, volume and place of this report but those in `input_certificate`:
    /// where this says "unit of the file", and the result has another unit, it is this one.
    pub output_units: Units,
    /// What may be done about each defect, and the steps that made the result: to be edited and given to `repair` as
    /// `plan`; null for operations other than `plan` and `repair`.
    #[schema(required)]
    pub plan: Option<Plan>,
    /// What was tried to repair the file, in its order, by the names of `docs/ladder.md`; empty where no repair was looked for.
    pub tried: Vec<&'static str>,
    /// The steps of the plan in the order they ran.
    pub actions: Vec<Action>,
    /// The results of a simplification, in the order of its targets; the first is what `after`, `deviation` and
    /// `certificate` are about. Empty for other operations.
    pub levels: Vec<Level>,
    /// What became of holes: of `fill-holes` each of the first 10,000; of a repair those among the listed ones that it filled
    /// or tried to fill. Null for other operations, and of a repair that looked at none.
    #[schema(required)]
    pub holes: Option<Vec<Hole>>,
    /// What the modeller found and did; null for other operations.
    #[schema(required)]
    pub modeller: Option<Modeller>,
    /// The mesh as returned; null: the same as before, or none.
    #[schema(required)]
    pub after: Option<MeshInfo>,
    /// How far the result is from the input.
    pub deviation: Deviation,
    /// The conclusion.
    pub verdict: Verdict,
    /// The parts of the file that were handled one by one, in its order; empty when all triangles were handled together.
    pub parts: Vec<Part>,
    /// What of the file is kept and not judged, and which rules of its format it breaks, in sentences.
    pub remarks: Vec<String>,
    /// The uploaded bytes, judged.
    pub input_certificate: Certificate,
    /// The returned bytes, judged; null: no bytes are returned.
    #[schema(required)]
    pub certificate: Option<Certificate>,
    /// The result, or else the input, measured for printing; null: no policy was asked for, or there is nothing to measure.
    #[schema(required)]
    pub printing: Option<Printing>,
    /// Time of each pass.
    pub timing_ms: TimingMs,
    /// What the run used.
    pub resources: Resources,
}

/// Who made a report.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct EngineInfo {
    /// Name.
    pub name: &'static str,
    /// Version.
    pub version: &'static str,
}

/// Facts about the uploaded bytes.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct InputInfo {
    /// Format.
    pub format: Format,
    /// Layout of the bytes.
    pub encoding: Encoding,
    /// Number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes, in hexadecimal.
    pub sha256: String,
    /// Unit of the coordinates and how it is known.
    pub units: UnitsInfo,
}

/// A mesh after the first, as it was uploaded.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FurtherInput {
    /// The uploaded bytes.
    pub input: InputInfo,
    /// The mesh.
    #[schema(required)]
    pub before: Option<MeshInfo>,
    /// The uploaded bytes, judged.
    pub input_certificate: Certificate,
}

/// A unit and how it is known.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct UnitsInfo {
    /// The unit.
    pub unit: Units,
    /// The caller, the file or its format states it; false: it is assumed.
    pub is_stated: bool,
}

/// How far the result is from the input.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Deviation {
    /// Upper bound of the two-sided Hausdorff distance between the result and what can be seen of the input, in the unit
    /// of the file.
    #[schema(required)]
    pub hausdorff_max: Option<f64>,
    /// How far the surfaces are from each other, with places; null: not measured.
    #[schema(required)]
    pub distance: Option<Distance>,
    /// Difference of the volumes, in cubic units of the file; null unless both are defined.
    #[schema(required)]
    pub volume_change: Option<f64>,
    /// Difference of the areas, in square units of the file; null without a result.
    #[schema(required)]
    pub area_change: Option<f64>,
    /// Share by which the volume changed; null unless that of the input is defined.
    #[schema(required)]
    pub volume_change_share: Option<f64>,
    /// Share of the visible surface of the input, from 0 to 1, that is farther from the result than 0.2 % of the
    /// diagonal, by sampling; null: not measured.
    #[schema(required)]
    pub visible_loss: Option<f64>,
    /// Area of the input inside of it, which a rebuilt surface leaves out, in square units of the file; null: not
    /// measured.
    #[schema(required)]
    pub hidden_area: Option<f64>,
    /// Share of the surface of the result, from 0 to 1, that is farther from the input than 0.2 % of the diagonal, by
    /// sampling; null: not measured.
    #[schema(required)]
    pub invented: Option<f64>,
    /// Bodies of the input that can be seen and are lost as a whole; null: not measured.
    #[schema(required)]
    pub bodies_lost: Option<u32>,
    /// Share of the length of the creases of the input, from 0 to 1, which a rebuilt surface has, too, by sampling. A crease is an edge
    /// folded by more than 30 degrees whose sides can both be seen. The result has it where, within an eighth of a cell of its lattice,
    /// an edge folded by more than 20 degrees runs the same way to 20 degrees. Of several parts the least; null: nothing was rebuilt,
    /// or there are no creases.
    #[schema(required)]
    pub creases_recovered: Option<f64>,
    /// Area of the patches of holes as a share of the surface, from 0 to 1, before its triangles are made fewer; null where `holes`
    /// is null. A patch that a later step put inside a body or cut counts as it was made.
    #[schema(required)]
    pub interpolated_area_share: Option<f64>,
    /// Share of the input's triangles that are bit-identical in the result, from 0 to 1.
    #[schema(required)]
    pub identical_triangle_share: Option<f64>,
}

/// Milliseconds by the clock; null: the pass did not run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TimingMs {
    /// Bytes to mesh.
    #[schema(required)]
    pub read: Option<f64>,
    /// Report of the mesh.
    #[schema(required)]
    pub analyze: Option<f64>,
    /// Repair steps.
    #[schema(required)]
    pub repair: Option<f64>,
    /// Fewer triangles.
    #[schema(required)]
    pub simplify: Option<f64>,
    /// Mesh to bytes.
    #[schema(required)]
    pub write: Option<f64>,
    /// The exact check.
    #[schema(required)]
    pub certify: Option<f64>,
    /// How far the result is from the input.
    #[schema(required)]
    pub measure: Option<f64>,
    /// A picture.
    #[schema(required)]
    pub draw: Option<f64>,
    /// The whole run of the engine.
    pub total: f64,
}

impl TimingMs {
    /// Time of one pass.
    pub fn of(&self, stage: Stage) -> Option<f64> {
        match stage {
            Stage::Read => self.read,
            Stage::Analyze => self.analyze,
            Stage::Repair => self.repair,
            Stage::Simplify => self.simplify,
            Stage::Write => self.write,
            Stage::Certify => self.certify,
            Stage::Measure => self.measure,
            Stage::Draw => self.draw,
        }
    }

    /// Place of the time of one pass.
    pub fn of_mut(&mut self, stage: Stage) -> &mut Option<f64> {
        match stage {
            Stage::Read => &mut self.read,
            Stage::Analyze => &mut self.analyze,
            Stage::Repair => &mut self.repair,
            Stage::Simplify => &mut self.simplify,
            Stage::Write => &mut self.write,
            Stage::Certify => &mut self.certify,
            Stage::Measure => &mut self.measure,
            Stage::Draw => &mut self.draw,
        }
    }
}

/// What a run used, in counts that are the same on every machine.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Resources {
    /// Work units.
    pub work_units: u64,
    /// Most bytes charged at one time.
    pub charged_bytes_peak: u64,
}

impl Report {
    /// The public form of the engine's report, with the times that the caller measured.
    pub fn new(inner: &pipeline::Report, timing_ms: TimingMs) -> Self {
        let remaining = remaining_of(inner);
        let units = Units::from(inner.input.result_units);
        Self {
            schema: super::REPORT_SCHEMA,
            operation: inner.operation.into(),
            engine: EngineInfo { name: super::ENGINE_NAME, version: super::ENGINE_VERSION },
            input: InputInfo::from(&inner.input),
            further_inputs: inner.further_inputs.iter().map(FurtherInput::from).collect(),
            output_units: units,
            before: inner
                .before
                .as_ref()
                .map(|mesh| MeshInfo::new(mesh, remaining).with_units_of(&inner.input)),
            plan: inner.plan.as_ref().map(Plan::from),
            tried: inner.tried.clone(),
            actions: inner.actions.iter().map(Action::from).collect(),
            levels: inner.levels.iter().map(|level| Level::new(level, units)).collect(),
            holes: inner.filling.as_ref().map(|filling| filling.holes.iter().map(Hole::from).collect()),
            modeller: Modeller::of(inner, units.millimetres()),
            after: inner.after.as_ref().map(|mesh| MeshInfo::new(mesh, None)),
            deviation: Deviation::of(inner),
            verdict: Verdict::of(inner),
            parts: inner.parts.iter().map(Part::from).collect(),
            remarks: inner.remarks.clone(),
            input_certificate: Certificate::from(&inner.input_certificate),
            certificate: inner.certificate.as_ref().map(Certificate::from),
            printing: inner.printing.as_ref().map(|printing| Printing::new(printing, units.millimetres())),
            timing_ms,
            resources: Resources { work_units: inner.work_used, charged_bytes_peak: inner.bytes_peak },
        }
    }
}

/// The mesh that is returned: a new one, the uploaded one when its bytes are returned, none when none is.
fn remaining_of(inner: &pipeline::Report) -> Option<&analysis::Analysis> {
    inner.certificate.as_ref()?;
    inner.after.as_ref().or(inner.before.as_ref())
}

impl From<&pipeline::InputFacts> for InputInfo {
    fn from(inner: &pipeline::InputFacts) -> Self {
        Self {
            format: inner.encoding.format().into(),
            encoding: inner.encoding.into(),
            bytes: inner.bytes,
            sha256: hex(&inner.sha256),
            units: UnitsInfo { unit: inner.units.into(), is_stated: inner.units_are_stated },
        }
    }
}

impl From<&pipeline::FurtherInput> for FurtherInput {
    fn from(inner: &pipeline::FurtherInput) -> Self {
        let mesh = inner.before.as_ref();
        Self {
            input: InputInfo::from(&inner.facts),
            before: mesh.map(|mesh| MeshInfo::new(mesh, None).with_units_of(&inner.facts)),
            input_certificate: Certificate::from(&inner.certificate),
        }
    }
}

impl Deviation {
    fn of(inner: &pipeline::Report) -> Self {
        let measures = |mesh: Option<&analysis::Analysis>| mesh.map(|mesh| mesh.measures);
        let (before, after) = (measures(inner.before.as_ref()), measures(remaining_of(inner)));
        let change = |of: fn(&analysis::Measures) -> Option<f64>| finite(of(&after?)? - of(&before?)?);
        Self {
            hausdorff_max: inner.distance.and_then(|distance| finite(distance.upper())),
            distance: inner.distance.as_ref().map(Distance::from),
            volume_change: change(|measures| measures.volume),
            area_change: change(|measures| Some(measures.area)),
            volume_change_share: inner.losses.and_then(|losses| finite(losses.volume_change?)),
            visible_loss: inner.losses.and_then(|losses| finite(losses.visible_loss)),
            hidden_area: inner.losses.and_then(|losses| finite(losses.hidden_area)),
            invented: inner.losses.and_then(|losses| finite(losses.invented)),
            bodies_lost: inner.losses.map(|losses| losses.bodies_lost),
            creases_recovered: inner.losses.and_then(|losses| finite(losses.creases_recovered?)),
            interpolated_area_share: inner
                .filling
                .as_ref()
                .and_then(|filling| finite(filling.interpolated_area_share)),
            identical_triangle_share: inner.identical_triangle_share.and_then(finite),
        }
    }
}

#[cfg(test)]
mod tests;
