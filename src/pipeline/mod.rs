//! Operations from bytes to bytes: read, analyze, repair by a plan that the client can read, write, certify.

mod boolean;
mod bounds;
mod changed;
mod choices;
mod convert;
mod cut_stitch;
mod describe;
mod failure;
mod faithful;
mod fidelity;
mod fill_holes;
mod identical;
mod input;
mod input_facts;
mod ladder;
mod left_out;
mod looks;
mod modeller;
mod operation;
mod outcome;
mod output;
mod picture;
mod plan;
mod printing;
mod priority;
mod project;
mod rebuild;
mod remedies;
mod repair;
mod repair_choices;
mod seams;
mod simplify;
mod size;
mod step;
mod stitches;
mod texture;
mod units;

use self::bounds::Bound;
pub use self::bounds::work_units_max;
pub use self::choices::{
    ChosenHole, Contact, FidelityLimits, FillHoles, SimplifyChoices, SolidParts, VertexColors,
};
pub use self::cut_stitch::{CutStitchChoices, Stitching};
pub use self::failure::Failure;
pub use self::faithful::{ChangeKind, Fidelity, FidelityChange, FidelityVerdict};
pub use self::fidelity::Losses;
pub use self::fill_holes::{FillHolesChoices, Filling, HoleFate, HoleOutcome};
use self::input::Input;
pub use self::input_facts::InputFacts;
pub use self::modeller::{
    Blocker, BlockerKind, EdgeName, Edit, EditKind, FaceName, FaceRange, ModelFace, ModellerChoices,
    ModellerRefusal, ModellerReport, ModellerStep, NameFault, RangeName, RangeSide,
};
pub use self::operation::{Facts, MESHES_MAX, Operation, ProductKind, Require, WorkBound};
pub use self::outcome::Outcome;
pub use self::picture::{PictureChoices, PictureFormat};
pub use self::printing::PrintingReport;
pub use self::project::{AttributeCounts, PartFacts, PartReport};
pub use self::rebuild::{Effort, WrapChoices};
pub use self::remedies::{
    ChosenPlan, ChosenRemedy, ELEMENTS_MAX, ElementProposal, Plan, PlanMismatch, Proposal, Remedy,
    remedies_of,
};
pub use self::step::Step;
pub use self::stitches::{JoinedEdges, Stitches};
use crate::analysis::{Analysis, DefectCode};
use crate::budget::{Budget, Stage};
use crate::certificate::{Certificate, Violation};
use crate::distance::SurfaceDistance;
use crate::formats::{self, Encoding, Format, ReadOptions, WriteError};
use crate::mesh::Texture;
pub use crate::mesh::Units;
use crate::printing::PrintingPolicy;
use crate::repair::nest;
pub use crate::repair::unite::{NotCombined, NotSolid, SetOperation};
use crate::simplify::TargetReport as SimplifyReport;
use std::borrow::Cow;

/// Options of every operation; those that do not apply are ignored.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The caller's word for the input format.
    pub format: Option<Format>,
    /// Format of the output; the input's own encoding when `None`.
    pub output_format: Option<Format>,
    /// What of a file of several parts is one solid.
    pub parts: SolidParts,
    /// Limits and choice of reader.
    pub read: ReadOptions,
    /// Unit as the caller stated it, in which all lengths here are; `None`: lengths are in millimetres, and the file is in
    /// the unit of its format or, where that says none, in millimetres too.
    pub units: Option<Units>,
    /// Unit of the result; `None`: millimetres for STL, which says none and is read so, metres for glTF made of another
    /// format, that of the file otherwise.
    pub output_units: Option<Units>,
    /// What the result must be; `None`: the operation's default.
    pub require: Option<Require>,
    /// Hole filling of `repair`.
    pub fill_holes: FillHoles,
    /// What shells inside shells mean to `repair`.
    pub nesting: nest::NestingPolicy,
    /// What `repair` does with bodies that touch.
    pub contact: Contact,
    /// What `repair` is to do about each defect; `None`: as proposed.
    pub plan: Option<ChosenPlan>,
    /// How far the result of a repair may be from the file.
    pub limits: FidelityLimits,
    /// How a mesh is rebuilt that no step of `repair` makes a solid.
    pub wrap: WrapChoices,
    /// How `simplify` works, and how far; a repair ends with it when it has targets.
    pub simplify: SimplifyChoices,
    /// How `cut-stitch` works.
    pub cut_stitch: CutStitchChoices,
    /// How `fill-holes` works.
    pub filling: FillHolesChoices,
    /// What `modeller` does.
    pub modeller: ModellerChoices,
    /// What `boolean` makes of its solids.
    pub set_operation: SetOperation,
    /// Sizes in bytes of the files that stand one behind the other in the bytes of a run; none: it is one file.
    pub file_sizes: Vec<u64>,
    /// Largest distance of features that are reported as near, in the unit of the file; `None`: 1e-5 of the diagonal for
    /// `analyze` up to 100,000 triangles, and no search otherwise.
    pub near: Option<f64>,
    /// Witnesses to keep of each defect; `None`: 16.
    pub samples: Option<usize>,
    /// What the process can do that the mesh is to be printed with; `None`: the mesh is not measured for printing.
    pub policy: Option<PrintingPolicy>,
    /// The MTL file of an OBJ: its diffuse colours become face colours, which OFF, PLY and glTF can hold.
    pub material: Option<Vec<u8>>,
    /// The picture that is made beside everything else; `None`: none, and of `render` the usual one.
    pub picture: Option<PictureChoices>,
    /// A second file, which `render` shows beside the first.
    pub after: Option<Vec<u8>>,
}

impl Options {
    /// The files in the bytes of a run.
    fn files_in<'b>(&self, bytes: &'b [u8]) -> Vec<&'b [u8]> {
        if self.file_sizes.is_empty() {
            return vec![bytes];
        }
        let mut rest = bytes;
        let mut take = |&size: &u64| {
            let (file, after) = rest.split_at(rest.len().min(size as usize));
            rest = after;
            file
        };
        self.file_sizes.iter().map(&mut take).collect()
    }
}

/// One result of a simplification.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// What was asked and how far it came.
    pub simplified: SimplifyReport,
    /// The bytes, judged.
    pub certificate: Certificate,
    /// How far the surface is from the one that was simplified.
    pub distance: Option<SurfaceDistance>,
    /// How true it is to the file.
    pub fidelity: Option<FidelityVerdict>,
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// No finite non-degenerate triangle.
    NothingToRepair,
    /// No valid solid was found in the work that a file of this size may take.
    OverBudget {
        /// The bound, in units of work.
        units: u64,
    },
    /// No step of the plan led to a valid solid; the first violation of the last attempt.
    NotRepairable {
        /// What still breaks the contract.
        witness: Option<Violation>,
    },
    /// The pitch of float32 is too coarse for a part that must be rebuilt: more than 2^-14 of its diagonal.
    BeyondFloat32 {
        /// The pitch, in the unit of the file.
        pitch: f64,
        /// The diagonal of the part, in the same unit.
        diagonal: f64,
    },
    /// No result is as close to the file as the caller demands.
    DeviationBeyondLimit {
        /// No point of the closest result is farther away than this, in the unit of the result.
        deviation: f64,
        /// One is at least this far away, in the same unit.
        found: f64,
        /// What was demanded, in the same unit.
        limit: f64,
    },
    /// No result keeps the volume as the caller demands.
    VolumeChangeBeyondLimit {
        /// The least change that was reached, as a share of the volume of the file.
        change: f64,
        /// What was demanded.
        limit: f64,
    },
    /// A faithful result was demanded, and the closest one is changed.
    NotFaithful {
        /// What it changed.
        changes: Vec<FidelityChange>,
        /// Unit of the distance among them.
        units: Units,
    },
    /// The modeller has no result.
    Modeller {
        /// Why.
        reason: Box<ModellerRefusal>,
        /// Unit of the distances in it.
        units: Units,
    },
    /// Solids cannot be combined.
    Boolean {
        /// Why.
        reason: BooleanRefusal,
    },
    /// A coordinate cannot be written in the output format.
    NotRepresentable {
        /// Which, and why.
        reason: WriteError,
    },
}

/// Why solids cannot be combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BooleanRefusal {
    /// What was asked.
    pub operation: SetOperation,
    /// Why there is no result.
    pub reason: NotCombined,
}

/// One step of a repair: what it was asked to do, why, and what it changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Action {
    /// Name of the step.
    pub step: &'static str,
    /// The defects that caused it.
    pub causes: Vec<DefectCode>,
    /// Named counts of what changed; all zero: nothing to do.
    pub changes: Vec<(&'static str, u64)>,
    /// Largest distance that a vertex moved, in the unit of the file.
    pub move_max: f64,
    /// What was decided, in a sentence, where there was a choice; empty otherwise.
    pub reason: String,
    /// The edges that a step of `cut-stitch` joined; `None` for other steps and operations.
    pub stitches: Option<Stitches>,
}

/// What is told of a file beside the first.
#[derive(Debug, Clone, PartialEq)]
pub struct FurtherInput {
    /// Its bytes.
    pub facts: InputFacts,
    /// Its mesh.
    pub before: Option<Analysis>,
    /// Its bytes, judged.
    pub certificate: Certificate,
}

/// The full account of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// What was asked.
    pub operation: Operation,
    /// The uploaded bytes.
    pub input: InputFacts,
    /// The mesh as uploaded; `None` for `verify`.
    pub before: Option<Analysis>,
    /// The uploaded bytes, judged.
    pub input_certificate: Certificate,
    /// The files after the first, which `input`, `before` and `input_certificate` are about; none but for `boolean`.
    pub further_inputs: Vec<FurtherInput>,
    /// What may be done about each defect, and what was; `None` for operations other than `plan` and `repair`.
    pub plan: Option<Plan>,
    /// Rungs of the ladder in the order they were tried; empty where no repair was looked for.
    pub tried: Vec<&'static str>,
    /// Steps in the order they ran; empty when none did.
    pub actions: Vec<Action>,
    /// The results of a simplification, in the order of the targets; the first is the one that `after`, `certificate`
    /// and `distance` are about.
    pub levels: Vec<Level>,
    /// The mesh as returned; `None` when it is the same or there is none.
    pub after: Option<Analysis>,
    /// The returned bytes, judged; `None` when there are none.
    pub certificate: Option<Certificate>,
    /// Share of the input's triangles that are bit-identical in the output; `None` without an output.
    pub identical_triangle_share: Option<f64>,
    /// How far the returned surface is from the input's; `None` where it was not measured.
    pub distance: Option<SurfaceDistance>,
    /// What a repair lost of the input; `None` where it was not measured.
    pub losses: Option<Losses>,
    /// How true the result is to the input; `None` without a result.
    pub fidelity: Option<FidelityVerdict>,
    /// What became of holes; `None` for operations other than `fill-holes` and `repair`, and of a repair that tried to fill none.
    pub filling: Option<Filling>,
    /// What the modeller found and did; `None` for other operations, and for what is no polyhedron.
    pub modeller: Option<Box<ModellerReport>>,
    /// What became of the file; `None` for `analyze` and `verify`.
    pub outcome: Option<Outcome>,
    /// Why there is no result.
    pub refusal: Option<Refusal>,
    /// The result, or else the input, measured for printing; `None`: no policy was given, nothing can be measured, or the run is
    /// over budget.
    pub printing: Option<PrintingReport>,
    /// The parts of the file that were handled one by one; empty when all triangles were handled together.
    pub parts: Vec<PartReport>,
    /// What of the file is kept and not judged, and which rules of its format it breaks, as sentences.
    pub remarks: Vec<String>,
    /// Work units used (deterministic).
    pub work_used: u64,
    /// Largest number of bytes charged at one time (deterministic).
    pub bytes_peak: u64,
}

/// A file that is returned.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The bytes; `None`: the very bytes that were uploaded.
    pub bytes: Option<Vec<u8>>,
    /// How they are laid out.
    pub encoding: Encoding,
    /// For each triangle the triangle of the input behind it, or [`u32::MAX`]; empty where the bytes are those that were
    /// uploaded, and for a file of several parts.
    pub origins: Vec<u32>,
    /// Texture of the triangles of a part of a project, whose groups hold it; empty otherwise.
    pub texture: Texture,
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The account.
    pub report: Report,
    /// The file, if the operation returns one and it was not refused.
    pub output: Option<Output>,
    /// The files of further targets of a simplification.
    pub levels: Vec<Output>,
    /// A picture of the mesh and of the result, as PNG, if one was asked for.
    pub picture: Option<Vec<u8>>,
}

/// Runs `operation` on `bytes`. A pure function: the same arguments give the same answer, whatever the thread count. Bytes that are
/// given away (`Vec<u8>`) are released once they are read, mostly.
///
/// ```
/// use meshmend::budget::Budget;
/// use meshmend::pipeline::{Operation, Options, Outcome, run};
///
/// // A tetrahedron, one triangle of which is missing.
/// let file = b"v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
/// let answer = run(Operation::Repair, file, &Options::default(), &Budget::unlimited())?;
/// assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
/// assert!(answer.report.certificate.is_some_and(|certificate| certificate.is_printable()));
/// let repaired = answer.output.and_then(|output| output.bytes).expect("the file is not as it was");
/// assert!(repaired.starts_with(b"v 0 0 0\n"));
/// # Ok::<(), meshmend::pipeline::Failure>(())
/// ```
///
/// # Errors
/// Only unreadable input, options that do not go with it, a stopped budget, and a mesh that takes more work than its file may; a
/// broken mesh is a successful analysis, a refusal part of the report.
pub fn run<'b>(
    operation: Operation,
    bytes: impl Into<Cow<'b, [u8]>>,
    options: &Options,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let bytes = bytes.into();
    if operation != Operation::Boolean && options.file_sizes.len() > 1 {
        return Err(Failure::MeshCount { operation, count: options.file_sizes.len() });
    }
    let bound = Bound::of(operation, bytes.len(), options, budget);
    let mut answer = match operation {
        Operation::Boolean => boolean::boolean(&bytes, options, &bound, budget)?,
        _ => run_on_file(operation, bytes, options, &bound, budget)?,
    };
    answer.report.work_used = budget.work_used();
    answer.report.bytes_peak = budget.bytes_peak();
    Ok(answer)
}

/// Runs `operation` on one file.
fn run_on_file(
    operation: Operation,
    bytes: Cow<'_, [u8]>,
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Answer, Failure> {
    match budget.stage(Stage::Read, || formats::sniff(&bytes, options.format))? {
        Encoding::ThreeMf => run_on_package(operation, &bytes, options, bound, budget),
        encoding => run_on_mesh(operation, bytes, encoding, options, bound, budget),
    }
}

/// Runs `operation` on a 3MF.
fn run_on_package(
    operation: Operation,
    bytes: &[u8],
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let encoding = Encoding::ThreeMf;
    let is_by_parts = project::is_by_parts(encoding, operation, options);
    let mut answer = if is_by_parts {
        let project = bound.reading(|| project::read(bytes, options, budget))?;
        let triangles = project::triangles_of(&project, operation, options);
        bound.running(triangles, || project::run_by_parts(operation, bytes, &project, options, budget))?
    } else {
        run_on_mesh(operation, bytes.into(), encoding, options, bound, budget)?
    };
    let Report { remarks, parts, .. } = &answer.report;
    if parts.is_empty() && (remarks.is_empty() || !is_by_parts) {
        let of_scene = project::remarks_on_scene(bytes, &answer, options, budget)?;
        answer.report.remarks.splice(0..0, of_scene);
    }
    if operation == Operation::Repair && options.parts == SolidParts::Union {
        return project::without_negative_parts(answer, bytes, options, bound, budget);
    }
    Ok(answer)
}

/// Runs `operation` on a file as one mesh.
fn run_on_mesh(
    operation: Operation,
    bytes: Cow<'_, [u8]>,
    encoding: Encoding,
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let soup = bound.reading(|| Input::read_soup(&bytes, encoding, options, budget))?;
    let remark_on_end = left_out::remark_on_end(&soup);
    let mut answer = bound.running(soup.triangles.len() as u64, || {
        let mut input = Input::examined(soup, bytes, encoding, options, budget)?;
        let answer = run_on(operation, &mut input, options, budget)?;
        bounds::with_picture(operation, answer, budget, |answer| {
            picture::of_mesh(operation, &input, answer, options, budget)
        })
    })?;
    answer.report.remarks.extend(remark_on_end);
    Ok(answer)
}

/// Runs `operation` on a mesh that was read.
fn run_on(
    operation: Operation,
    input: &mut Input,
    options: &Options,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let in_units_of_file = input.take_lengths(options);
    let options = in_units_of_file.as_ref().unwrap_or(options);
    let in_result_units = input.take_units_of_result(operation, options)?;
    let options = in_result_units.as_ref().unwrap_or(options);
    let answer = match operation {
        Operation::Analyze | Operation::Render => input.report(operation, budget)?.into_answer(),
        Operation::Plan => input.planned(operation, budget)?.into_answer(),
        Operation::Verify => input.verification().into_answer(),
        Operation::Convert => convert::convert(input, options, budget)?,
        Operation::Repair => repair::repair(input, options, budget)?,
        Operation::Simplify => simplify::simplify(input, options, budget)?,
        Operation::CutStitch => cut_stitch::cut_stitch(input, options, budget)?,
        Operation::FillHoles => fill_holes::fill_holes(input, options, budget)?,
        Operation::Modeller => modeller::model(input, options, budget)?,
        Operation::Boolean => return Err(Failure::MeshCount { operation, count: 1 }),
    };
    finished(input, options, answer, budget)
}

/// The answer with what every operation tells.
fn finished(
    input: &Input,
    options: &Options,
    mut answer: Answer,
    budget: &Budget,
) -> Result<Answer, Failure> {
    if options.require == Some(Require::Faithful) {
        answer = faithful::demand_faithful(answer);
    }
    // What is over budget has nothing left to measure with.
    let is_over_budget = matches!(answer.report.refusal, Some(Refusal::OverBudget { .. }));
    if let Some(policy) = options.policy.as_ref().filter(|_| !is_over_budget) {
        answer.report.printing = printing::measure(input, &answer, policy, budget)?;
    }
    Ok(answer)
}
