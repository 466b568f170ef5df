//! The public words: options, reports, jobs and problems as JSON, shared by the service and the command line.
//!
//! Everything here mirrors an engine type, so that a rename inside cannot change the contract; exhaustive matches make
//! the compiler ask for a public word when the engine learns a new one.

mod action;
mod boolean;
mod certificate;
mod distance;
mod edges;
mod event;
mod fidelity;
mod fill_settings;
mod finite;
mod formats;
mod holes;
mod input_ref;
mod job;
mod labels;
mod level;
mod limits;
mod mesh_answers;
mod mesh_info;
mod modeller;
mod option_schema;
mod options;
mod part;
mod plan;
mod plan_fault;
mod printing;
mod problem;
mod problem_code;
mod proposal;
mod report;
mod report_page;
mod request;
mod shortened;
mod stitches;
mod target;
mod unit_hypothesis;
mod upload;
mod verdict;
mod version;
mod webhook;
mod whole_number;
mod words;

#[cfg(test)]
pub(crate) mod sample;

pub use action::{Action, Change};
pub use certificate::{Certificate, Claim, Reading, Shell, Violation, ViolationCount};
pub use distance::{DirectedDistance, Distance};
pub use event::{Phase, StageEvent, StateEvent};
pub use fidelity::FidelityChange;
pub use fill_settings::{FillSettings, SingleHole};
pub use formats::{FormatInfo, extension_of, format_of_media_type, formats, media_type_of};
pub use holes::{ChosenHole, FieldFit, Hole, Holes, RejectedPatch};
pub use input_ref::InputRef;
pub use job::{Job, JobList, JobState, Links, Progress};
pub use labels::{LABELS_MAX, Labels, label_from_text};
pub use level::Level;
pub use limits::Limits;
pub use mesh_answers::{Proximity, TestCounts, VolumeInterval, VolumeMethod, Watertight};
pub use mesh_info::{
    Bounds, Counts, Defect, Element, Figure, HoleCounts, Measures, MeshInfo, Properties, Witness,
};
pub use modeller::{
    Blocker, BlockerKind, DualEmbedding, EdgeRef, EditKind, EditSpec, FaceByNormal, FaceByRay, FaceInfo,
    FaceMove, FaceRangeInfo, FaceRate, FaceRef, FaceSpeed, FlipSpec, Length, MergeSpec, ModelRule,
    ModelValidity, Modeller, ModellerStep, MovedFace, OperatorReason, PickingRay, RangeSideInfo, RangeSpec,
    RefusedOperator, ShiftSpec, SplitSpec, TogetherSpec, UndoSpec, Vector,
};
pub use option_schema::{
    camel_case, option_parameters, option_schemas, options_object, options_of, with_input,
};
pub use options::{OptionError, OptionKind, OptionSpec, Options, SPECS};
pub use part::{Attributes, Part};
pub use plan::{ChosenElement, ChosenFinding, ChosenShell, PlanRequest, PlanStep};
pub use printing::{
    BoundKind, BuildDirection, CheckCode, Edges, Fit, OrientedBox, Overhang, Parts, PolicyInfo, PolicyLimit,
    PolicyName, PolicyVolume, PrintedMesh, Printing, PrintingCheck, PrintingUnit, PrintingWitness, Quote,
    Spread, Status, Thickness, policies,
};
pub use problem::Problem;
pub use problem_code::{ErrorInfo, ProblemCode, errors};
pub use proposal::{ElementProposal, Plan, Proposal};
pub use report::{Deviation, EngineInfo, FurtherInput, InputInfo, Report, Resources, TimingMs, UnitsInfo};
pub use report_page::{Escaped, REPORT_PAGE_CSP, report_page};
pub use request::JobRequest;
pub use stitches::{JoinedEdges, Stitches};
pub use target::TargetSpec;
pub use unit_hypothesis::UnitHypothesis;
pub use upload::{PresignedRequest, PutRequest, UploadInfo};
pub use verdict::{Reason, Verdict};
pub use version::{ENGINE_NAME, ENGINE_VERSION, REPORT_SCHEMA, Version};
pub use webhook::{
    Deliveries, Delivery, DeliveryState, DeliveryTry, WebhookEvent, WebhookMessage, WebhookRequest,
};
pub use words::{
    Across, ChangeKind, Condition, ConstraintValues, Contact, Criterion, Cut, DefectCode, Degenerate,
    DrawnEdges, Effort, Encoding, Extract, Fidelity, FillHoles, FillMethod, Format, HoleClass, HoleFate,
    Kernel, LambdaFrom, Mode, Nesting, OpenShells, Operation, Opposite, Outcome, PictureFormat, Placement,
    Projection, ProximityTest, Reader, ReasonCode, Rejection, Remedy, Require, SetOperation, Severity, Shade,
    ShellFate, SolidParts, Stage, Stitch, StitchValidity, Units, VertexColors, Views, Weld,
};
