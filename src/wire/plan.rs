//! Plans as JSON, as a caller gives them back, and their steps.

use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use utoipa::ToSchema;

use super::certificate::digest_of_hex;
use super::fill_settings::{FillSettings, contradiction, rings};
use super::whole_number::{whole, whole_number};
use super::words::{Across, DefectCode, Degenerate, FillMethod, Nesting, Opposite, Remedy, ShellFate};
use crate::pipeline::{self, ELEMENTS_MAX, Step};
use crate::repair::Selection;
use crate::repair::cut::CutOptions;
use crate::repair::nest::NestOptions;
use crate::repair::snap::SnapOptions;
use crate::repair::thin_faces::ThinFaces;
use crate::{mesh, repair};

/// A plan as it is given back: one that was proposed, edited, or that of an earlier repair. What is left out is done as
/// proposed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PlanRequest {
    /// SHA-256 of the file that it is for, in hexadecimal; another file is refused. Null: any file.
    #[schema(pattern = "^[0-9a-f]{64}$")]
    #[serde(default)]
    pub input_sha256: Option<String>,
    /// What is chosen for kinds of defects.
    #[serde(default)]
    #[schema(max_items = 100)]
    pub findings: Vec<ChosenFinding>,
    /// Run exactly these steps; null: search for the first plan that leads to a certified result.
    #[serde(default)]
    #[schema(max_items = 100)]
    pub steps: Option<Vec<PlanStep>>,
}

/// What is chosen for the defects of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ChosenFinding {
    /// The kind.
    pub code: DefectCode,
    /// For all that `elements` do not name; null: as proposed.
    #[serde(default)]
    pub remedy: Option<Remedy>,
    /// For single elements.
    #[serde(default)]
    #[schema(max_items = 10_000)]
    pub elements: Vec<ChosenElement>,
    /// Ignored: as proposed.
    #[serde(default)]
    #[schema(value_type = Option<u64>)]
    count: Ignored,
    /// Ignored: as proposed.
    #[serde(default)]
    #[schema(value_type = Option<Vec<Remedy>>)]
    choices: Ignored,
    /// Ignored: as proposed.
    #[serde(default)]
    #[schema(value_type = Option<f64>)]
    confidence: Ignored,
    /// Ignored: as proposed.
    #[serde(default)]
    #[schema(value_type = Option<String>)]
    reason: Ignored,
}

/// What is chosen for one element.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ChosenElement {
    /// Place among the witnesses of the defect, from 0.
    #[serde(deserialize_with = "whole")]
    pub number: u32,
    /// What is to be done.
    pub remedy: Remedy,
    /// How a hole is filled; null: as for all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<FillMethod>,
    /// Rings of neighbours around the rim of a hole that its patch is fitted to; null: as for all.
    #[serde(default, deserialize_with = "rings", skip_serializing_if = "Option::is_none")]
    #[schema(maximum = 8)]
    pub band_rings: Option<u32>,
    /// Ignored: as proposed.
    #[serde(default)]
    #[schema(value_type = Option<f64>)]
    confidence: Ignored,
}

impl ChosenElement {
    /// What is wrong with an element whose members are right each by itself; `None`: nothing.
    pub(super) fn contradiction(&self) -> Option<&'static str> {
        contradiction(self.method, self.band_rings)
    }
}

/// A member that a plan has when it is answered and that says nothing when it is given back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Ignored;

impl<'de> Deserialize<'de> for Ignored {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        IgnoredAny::deserialize(from).map(|_| Self)
    }
}

impl Serialize for Ignored {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_unit()
    }
}

/// One step of a repair, with its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "step", rename_all = "kebab-case", deny_unknown_fields)]
pub enum PlanStep {
    /// Polygons that pass a vertex more than once become simple ones, or go.
    SplitPolygons {
        /// Which.
        degenerate: Degenerate,
    },
    /// Vertices that only coordinates which are all but zero keep apart go to where one of them is.
    JoinOverNoise {},
    /// Coordinates that are all but zero become zero.
    ClearNoise {},
    /// Coordinates become float32.
    #[serde(rename = "round-to-float32")]
    RoundToF32 {},
    /// Coordinates of triangles that meet others when all are read as float32 become float32.
    RoundWhereItMatters {},
    /// Vertices at one position become one.
    Weld {},
    /// Triangles with a repeated vertex go.
    DropDegenerate {},
    /// Collinear triangles go and their neighbours are divided.
    SplitCollinear {},
    /// Boundary edges are divided where a boundary vertex lies on them.
    SplitTVertices {},
    /// Whole parts go.
    RemoveParts {
        /// A triangle in each, by its number from 0 after polygons are split.
        #[serde(deserialize_with = "whole_list")]
        #[schema(max_items = 10_000)]
        triangles: Vec<u32>,
    },
    /// Copies of triangles go.
    DropDuplicates {
        /// What becomes of two in opposite directions.
        opposite: Opposite,
    },
    /// Triangles that meet others go.
    RemoveCrossing {
        /// Rings of triangles around them that go too.
        #[serde(deserialize_with = "whole")]
        #[schema(maximum = 10)]
        rings: u32,
    },
    /// Sheets that lie triangle by triangle near other ones go.
    DropNearDuplicates {
        /// Largest distance of their corners, in the unit of the file.
        #[schema(minimum = 0.0)]
        epsilon: f64,
    },
    /// Faces are turned so that neighbours agree.
    Orient {},
    /// Triangles at edges with four or more are paired by their angles.
    PairSheets {
        /// What lies between two that are paired.
        across: Across,
    },
    /// Singular edges and vertices are cut.
    Cut {},
    /// Edges that the cut has parted are joined from where boundaries turn back on themselves.
    Pinch {},
    /// Boundary edges that are close are joined.
    Snap {
        /// Largest distance of vertices that become one, in the unit of the file; 0: what coincides.
        #[schema(minimum = 0.0)]
        epsilon: f64,
        /// No part is turned to be joined.
        #[serde(default)]
        keeps_winding: bool,
        /// Of edges that do not coincide, only those are joined that lie side by side: with ends closer than an eighth of the
        /// shorter one, and triangles that do not lie back to back. Edges are divided first where vertices of another boundary
        /// lie beside them.
        #[serde(default)]
        by_edge: bool,
    },
    /// Needles, caps and folds go.
    MendThinFaces {
        /// Needles go.
        needles: bool,
        /// Caps go.
        caps: bool,
        /// Folds go.
        folds: bool,
    },
    /// Gaps between an arc and its chord over which a surface lies are closed.
    CloseChordalGaps {},
    /// Parts are turned so that rims which belong together run in opposite directions.
    TurnToBridge {},
    /// Holes are closed.
    FillHoles {
        /// All but `except`; false: only `except`.
        all: bool,
        /// A half-edge of each hole: three times the number of its triangle, plus the place of its corner in it.
        #[serde(deserialize_with = "whole_list")]
        #[schema(max_items = 10_000)]
        except: Vec<u32>,
        /// How; left out: as in a repair without choices.
        #[serde(default)]
        how: FillSettings,
    },
    /// Open parts get a wall behind them.
    Thicken {
        /// Thickness, in the unit of the file.
        #[schema(minimum = 0.0)]
        wall: f64,
    },
    /// Bodies that touch become one.
    JoinContacts {
        /// Thickness of the necks between them, in the unit of the file.
        #[schema(minimum = 0.0)]
        size: f64,
    },
    /// Bodies that pass through each other or overlap become one.
    Unite {},
    /// As `unite`; triangles with void on both sides, which go then, leave copies that are open parts of their own, for `thicken` to
    /// put walls behind.
    UniteAndCopyBare {},
    /// Edges that an odd number of triangles have are closed as by `span-rims`, whichever way these turn.
    SpanOddEdges {},
    /// What the triangles of each connected part enclose becomes solid, whichever way they turn.
    Enclose {},
    /// As `enclose`; triangles that enclose nothing, which go then, leave copies that are open parts of their own, for `thicken` to put
    /// walls behind.
    EncloseAndCopyBare {},
    /// Where the solid touches itself, a body of some steps of the print lattice is taken out of it.
    BoreContacts {
        /// From its middle out, in steps of the lattice.
        #[serde(deserialize_with = "whole")]
        #[schema(maximum = 65_536)]
        steps: u32,
    },
    /// Corners of triangles that meet others when all coordinates are read on a coarser lattice go to it.
    RoundToCoarser {
        /// Its step, in steps of the print lattice.
        #[serde(deserialize_with = "whole")]
        #[schema(maximum = 65_536)]
        steps: u32,
    },
    /// What is still open is closed by triangles between its rims that may pass through others; `unite` resolves that.
    SpanRims {},
    /// Bodies that touch are drawn apart.
    OpenContacts {},
    /// Vertices at one position become one again.
    JoinCopies {},
    /// Shells are turned and dropped so that they alternate.
    Nest {
        /// What shells inside shells mean.
        nesting: Nesting,
        /// Shells whose fate was chosen.
        #[schema(max_items = 10_000)]
        chosen: Vec<ChosenShell>,
    },
    /// The surface is rebuilt, by the options of the request; local steps do not count then.
    Rebuild {},
    /// The certified mesh gets fewer triangles, by the options of the request.
    Simplify {},
}

/// A shell whose fate was chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ChosenShell {
    /// A triangle in it, by its number from 0 after polygons are split.
    #[serde(deserialize_with = "whole")]
    pub triangle: u32,
    /// What becomes of it.
    pub fate: ShellFate,
}

fn whole_list<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u32>, D::Error> {
    let numbers = Vec::<f64>::deserialize(from)?;
    let whole: Option<Vec<u32>> = numbers.into_iter().map(whole_number).collect();
    whole.ok_or_else(|| D::Error::custom("not whole numbers"))
}

/// Most steps of a plan, and most kinds of defects.
pub(super) const LIST_MAX: usize = 100;
/// Most rings.
const RINGS_MAX: u32 = 10;

/// True when everything that must be an object is one: the deserializer would take lists of their members too.
fn has_objects(plan: &Value) -> bool {
    let items = |of: &Value, name: &str| of[name].as_array().cloned().unwrap_or_default();
    let (findings, steps) = (items(plan, "findings"), items(plan, "steps"));
    let elements = findings.iter().flat_map(|finding| items(finding, "elements"));
    let shells = steps.iter().flat_map(|step| items(step, "chosen"));
    plan.is_object()
        && elements.chain(shells).all(|item| item.is_object())
        && findings.iter().chain(&steps).all(Value::is_object)
}

impl PlanRequest {
    /// The plan of a JSON text; `None` when it is none.
    pub(super) fn from_json(text: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(text).ok().filter(has_objects)?;
        let plan = Self::deserialize(value).ok()?;
        let is_digest = plan.input_sha256.as_deref().is_none_or(|text| digest_of_hex(text).is_some());
        let steps = plan.steps.as_deref().unwrap_or_default();
        let is_small = plan.findings.len() <= LIST_MAX
            && steps.len() <= LIST_MAX
            && plan.findings.iter().all(|finding| finding.elements.len() <= ELEMENTS_MAX)
            && plan
                .findings
                .iter()
                .flat_map(|finding| &finding.elements)
                .all(|own| own.contradiction().is_none())
            && steps.iter().all(PlanStep::is_small);
        (is_digest && is_small).then_some(plan)
    }

    /// The engine's plan.
    pub(super) fn to_engine(&self) -> pipeline::ChosenPlan {
        let element = |element: &ChosenElement| (element.number, element.remedy.into());
        let hole = |element: &ChosenElement| {
            let &ChosenElement { number, method, band_rings, .. } = element;
            let is_own = method.is_some() || band_rings.is_some();
            is_own.then(|| pipeline::ChosenHole { number, method: method.map(Into::into), band_rings })
        };
        let finding = |finding: &ChosenFinding| pipeline::ChosenRemedy {
            code: finding.code.into(),
            remedy: finding.remedy.map(Into::into),
            elements: finding.elements.iter().map(element).collect(),
            holes: finding.elements.iter().filter_map(hole).collect(),
        };
        pipeline::ChosenPlan {
            input_sha256: self.input_sha256.as_deref().and_then(digest_of_hex),
            findings: self.findings.iter().map(finding).collect(),
            steps: self.steps.as_ref().map(|steps| steps.iter().map(PlanStep::to_engine).collect()),
        }
    }
}

impl PlanStep {
    pub(super) fn is_small(&self) -> bool {
        match self {
            Self::RemoveParts { triangles } => triangles.len() <= ELEMENTS_MAX,
            Self::FillHoles { except, how, .. } => except.len() <= ELEMENTS_MAX && how.is_small(),
            Self::Nest { chosen, .. } => chosen.len() <= ELEMENTS_MAX,
            Self::RemoveCrossing { rings } => *rings <= RINGS_MAX,
            Self::Thicken { wall: length }
            | Self::Snap { epsilon: length, .. }
            | Self::DropNearDuplicates { epsilon: length }
            | Self::JoinContacts { size: length } => *length >= 0.0,
            _ => true,
        }
    }

    fn to_engine(&self) -> Step {
        match self {
            Self::SplitPolygons { degenerate } => Step::SplitPolygons((*degenerate).into()),
            Self::JoinOverNoise {} => Step::JoinOverNoise,
            Self::ClearNoise {} => Step::ClearNoise,
            Self::RoundToF32 {} => Step::RoundToF32,
            Self::RoundWhereItMatters {} => Step::RoundWhereItMatters,
            Self::Weld {} => Step::Weld,
            Self::DropDegenerate {} => Step::DropDegenerate,
            Self::SplitCollinear {} => Step::SplitCollinear,
            Self::SplitTVertices {} => Step::SplitTVertices,
            Self::RemoveParts { triangles } => Step::RemoveParts(sorted(triangles)),
            Self::DropDuplicates { opposite } => Step::DropDuplicates((*opposite).into()),
            Self::RemoveCrossing { rings } => Step::RemoveCrossing { rings: *rings },
            Self::DropNearDuplicates { epsilon } => Step::DropNearDuplicates { epsilon: *epsilon },
            Self::Orient {} => Step::Orient,
            Self::PairSheets { across } => Step::PairSheets((*across).into()),
            Self::Cut {} => Step::Cut(CutOptions::default()),
            Self::Pinch {} => Step::Pinch(mesh::ChosenEdges::default(), mesh::StitchValidity::Exact),
            &Self::Snap { epsilon, keeps_winding, by_edge } => {
                let epsilon = Some(epsilon);
                Step::Snap(SnapOptions { epsilon, keeps_winding, by_edge, ..SnapOptions::default() })
            }
            Self::MendThinFaces { needles, caps, folds } => {
                Step::MendThinFaces(ThinFaces { needles: *needles, caps: *caps, folds: *folds })
            }
            Self::CloseChordalGaps {} => Step::CloseChordalGaps,
            Self::TurnToBridge {} => Step::TurnToBridge,
            Self::FillHoles { all: true, except, how } => {
                Step::FillHoles(how.to_engine(Selection::AllBut(sorted(except))))
            }
            Self::FillHoles { all: false, except, how } => {
                Step::FillHoles(how.to_engine(Selection::Only(sorted(except))))
            }
            Self::Thicken { wall } => Step::Thicken { wall: *wall },
            Self::JoinContacts { size } => Step::JoinContacts { size: *size },
            Self::Unite {} => Step::Unite,
            Self::UniteAndCopyBare {} => Step::UniteAndCopyBare,
            Self::SpanOddEdges {} => Step::SpanOddEdges,
            Self::Enclose {} => Step::Enclose,
            Self::EncloseAndCopyBare {} => Step::EncloseAndCopyBare,
            Self::BoreContacts { steps } => Step::BoreContacts { steps: *steps },
            Self::RoundToCoarser { steps } => Step::RoundToCoarser { steps: *steps },
            Self::SpanRims {} => Step::SpanRims,
            Self::OpenContacts {} => Step::OpenContacts,
            Self::JoinCopies {} => Step::JoinCopies,
            Self::Nest { nesting, chosen } => Step::Nest(NestOptions {
                policy: (*nesting).into(),
                is_embedded: false,
                chosen: chosen.iter().map(|shell| (shell.triangle, shell.fate.into())).collect(),
            }),
            Self::Rebuild {} => Step::Rebuild,
            Self::Simplify {} => Step::Simplify,
        }
    }
}

fn sorted(list: &[u32]) -> Vec<u32> {
    let mut list = list.to_vec();
    list.sort_unstable();
    list
}

impl From<&Step> for PlanStep {
    fn from(inner: &Step) -> Self {
        match inner {
            Step::SplitPolygons(degenerate) => Self::SplitPolygons { degenerate: (*degenerate).into() },
            Step::JoinOverNoise => Self::JoinOverNoise {},
            Step::ClearNoise => Self::ClearNoise {},
            Step::RoundToF32 => Self::RoundToF32 {},
            Step::RoundWhereItMatters => Self::RoundWhereItMatters {},
            Step::Weld => Self::Weld {},
            Step::DropDegenerate => Self::DropDegenerate {},
            Step::SplitCollinear => Self::SplitCollinear {},
            Step::SplitTVertices => Self::SplitTVertices {},
            Step::RemoveParts(triangles) => Self::RemoveParts { triangles: triangles.clone() },
            Step::DropDuplicates(opposite) => Self::DropDuplicates { opposite: (*opposite).into() },
            Step::RemoveCrossing { rings } => Self::RemoveCrossing { rings: *rings },
            Step::DropNearDuplicates { epsilon } => Self::DropNearDuplicates { epsilon: *epsilon },
            Step::Orient => Self::Orient {},
            Step::PairSheets(across) => Self::PairSheets { across: (*across).into() },
            Step::Cut(_) => Self::Cut {},
            Step::Pinch(..) => Self::Pinch {},
            Step::Snap(options) => Self::Snap {
                epsilon: options.epsilon.unwrap_or(0.0),
                keeps_winding: options.keeps_winding,
                by_edge: options.by_edge,
            },
            Step::MendThinFaces(which) => {
                Self::MendThinFaces { needles: which.needles, caps: which.caps, folds: which.folds }
            }
            Step::CloseChordalGaps => Self::CloseChordalGaps {},
            Step::TurnToBridge => Self::TurnToBridge {},
            Step::FillHoles(options) => {
                let (all, except) = match &options.holes {
                    Selection::AllBut(except) => (true, except.clone()),
                    Selection::Only(only) => (false, only.clone()),
                };
                Self::FillHoles { all, except, how: FillSettings::from(options) }
            }
            Step::Thicken { wall } => Self::Thicken { wall: *wall },
            Step::JoinContacts { size } => Self::JoinContacts { size: *size },
            Step::Unite => Self::Unite {},
            Step::UniteAndCopyBare => Self::UniteAndCopyBare {},
            Step::SpanOddEdges => Self::SpanOddEdges {},
            Step::Enclose => Self::Enclose {},
            Step::EncloseAndCopyBare => Self::EncloseAndCopyBare {},
            Step::BoreContacts { steps } => Self::BoreContacts { steps: *steps },
            Step::RoundToCoarser { steps } => Self::RoundToCoarser { steps: *steps },
            Step::SpanRims => Self::SpanRims {},
            Step::OpenContacts => Self::OpenContacts {},
            Step::JoinCopies => Self::JoinCopies {},
            Step::Nest(repair::nest::NestOptions { policy, chosen, .. }) => {
                let shell = |&(triangle, fate): &(u32, repair::nest::ShellFate)| ChosenShell {
                    triangle,
                    fate: fate.into(),
                };
                Self::Nest { nesting: (*policy).into(), chosen: chosen.iter().map(shell).collect() }
            }
            Step::Rebuild => Self::Rebuild {},
            Step::Simplify => Self::Simplify {},
        }
    }
}

#[cfg(test)]
mod tests;
