//! The repair plan: a list of steps that a client can read, and the loop that runs it.

use super::{Action, FillHoles};
use crate::analysis::{Analysis, DefectCode};
use crate::budget::{Budget, Stopped};
use crate::mesh::{ChosenEdges, Soup, Validity};
use crate::repair::cut::CutOptions;
use crate::repair::duplicates::OppositePairs;
use crate::repair::polygons::DegenerateFaces;
use crate::repair::snap::SnapOptions;
use crate::repair::{self, Changes, Draft};

/// One step of a plan, with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    SplitPolygons(DegenerateFaces),
    ClearNoise,
    RoundToF32,
    Weld,
    DropDegenerate,
    SplitCollinear,
    SplitTVertices,
    DropDuplicates(OppositePairs),
    RemoveCrossing { rings: u32 },
    Orient,
    Cut(CutOptions),
    Pinch(ChosenEdges, Validity),
    Snap(SnapOptions),
    FillHoles,
    OpenContacts,
    JoinCopies,
    Nest { is_embedded: bool },
}

/// What distinguishes the plans that are tried for one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Variant {
    /// Coordinates that are all but zero become zero first.
    pub(super) clears_noise: bool,
    /// Coordinates become float32 first.
    pub(super) rounds: bool,
    /// What becomes of opposite duplicates.
    pub(super) opposite: OppositePairs,
    /// Triangles that meet others go first, with this many rings around them.
    pub(super) removes_crossing: Option<u32>,
    /// Bodies that touch are drawn apart.
    pub(super) opens_contacts: bool,
}

impl Variant {
    /// The steps that mend the surface, least invasive first; each finds what those before it leave.
    pub(super) fn mending(self, fill_holes: FillHoles) -> Vec<Step> {
        let clear = self.clears_noise.then_some(Step::ClearNoise);
        let round = self.rounds.then_some(Step::RoundToF32);
        let split = Step::SplitPolygons(DegenerateFaces::Split);
        let welded = [
            Step::Weld,
            Step::DropDegenerate,
            Step::SplitCollinear,
            Step::SplitTVertices,
            Step::DropDuplicates(self.opposite),
        ];
        let remove = self.removes_crossing.map(|rings| Step::RemoveCrossing { rings });
        let cut = [Step::Orient, Step::Cut(CutOptions::default())];
        // Which copies belong together matters only where they are drawn apart.
        let pinch = self.opens_contacts.then(|| Step::Pinch(ChosenEdges::default(), Validity::Exact));
        // Only what coincides: no vertex moves.
        let snap = Step::Snap(SnapOptions { epsilon: Some(0.0), ..SnapOptions::default() });
        let fill = (fill_holes == FillHoles::Simple).then_some(Step::FillHoles);
        let start = [split].into_iter().chain(clear).chain(round).chain(welded);
        start.chain(remove).chain(cut).chain(pinch).chain([snap]).chain(fill).collect()
    }

    /// The steps that make it a solid. Readers weld, so that copies of a vertex would be one again: what is to be
    /// certified has none. `has_contacts`: triangles of the input meet beyond common vertices and edges. Nothing that
    /// mends adds a contact, but moving vertices can.
    pub(super) fn solidifying(self, has_contacts: bool) -> Vec<Step> {
        let moves = self.rounds || self.clears_noise || self.opens_contacts;
        let open = self.opens_contacts.then_some(Step::OpenContacts);
        let nest = Step::Nest { is_embedded: !has_contacts && !moves };
        open.into_iter().chain([Step::JoinCopies, nest]).collect()
    }
}

impl Step {
    /// Name in reports.
    fn name(&self) -> &'static str {
        match self {
            Self::SplitPolygons(_) => "split-polygons",
            Self::ClearNoise => "clear-noise",
            Self::RoundToF32 => "round-to-float32",
            Self::Weld => "weld",
            Self::DropDegenerate => "drop-degenerate",
            Self::SplitCollinear => "split-collinear",
            Self::SplitTVertices => "split-t-vertices",
            Self::DropDuplicates(_) => "drop-duplicates",
            Self::Orient => "orient",
            Self::Cut(_) => "cut",
            Self::Pinch(..) => "pinch",
            Self::Snap(_) => "snap",
            Self::RemoveCrossing { .. } => "remove-crossing",
            Self::OpenContacts => "open-contacts",
            Self::FillHoles => "fill-holes",
            Self::JoinCopies => "join-copies",
            Self::Nest { .. } => "nest",
        }
    }

    /// The defects that the step is for.
    fn cures(&self) -> &'static [DefectCode] {
        match self {
            Self::ClearNoise => &[
                DefectCode::BoundaryLoop,
                DefectCode::SelfIntersection,
                DefectCode::Overlap,
                DefectCode::Touch,
            ],
            Self::RoundToF32 => &[DefectCode::UnsoundReading],
            Self::JoinCopies => &[],
            Self::RemoveCrossing { .. } => {
                &[DefectCode::SelfIntersection, DefectCode::Overlap, DefectCode::Touch]
            }
            Self::OpenContacts => &[DefectCode::NonManifoldEdge, DefectCode::NonManifoldVertex],
            Self::SplitPolygons(_) => &[DefectCode::CoincidentCorners, DefectCode::DuplicateVertex],
            Self::Weld => &[DefectCode::DuplicateVertex],
            Self::DropDegenerate => &[DefectCode::CoincidentCorners],
            Self::SplitCollinear => &[DefectCode::CollinearFace],
            Self::DropDuplicates(_) => &[DefectCode::DuplicateFace, DefectCode::OppositeDuplicateFace],
            Self::Orient => &[DefectCode::OrientationConflict, DefectCode::NonOrientable],
            Self::Cut(_) => {
                &[DefectCode::NonManifoldEdge, DefectCode::NonManifoldVertex, DefectCode::NonOrientable]
            }
            Self::SplitTVertices | Self::Pinch(..) | Self::Snap(_) | Self::FillHoles => {
                &[DefectCode::BoundaryLoop]
            }
            Self::Nest { .. } => &[DefectCode::InvertedShell, DefectCode::MisnestedShell],
        }
    }

    fn run(&self, draft: &mut Draft, soup: &Soup, budget: &Budget) -> Result<Changes, Stopped> {
        match self {
            Self::SplitPolygons(how) => repair::polygons::split_polygons(draft, soup, *how, budget),
            Self::ClearNoise => Ok(repair::noise::clear_noise(draft)),
            Self::RoundToF32 => Ok(repair::round::round_to_f32(draft)),
            Self::Weld | Self::JoinCopies => repair::weld::weld(draft, budget),
            Self::DropDegenerate => Ok(repair::degenerate::drop_degenerate(draft)),
            Self::SplitCollinear => repair::collinear::split_collinear(draft, budget),
            Self::SplitTVertices => repair::t_vertices::split_t_vertices(draft, budget),
            Self::DropDuplicates(opposite) => repair::duplicates::drop_duplicates(draft, *opposite, budget),
            Self::Orient => repair::orient::orient(draft, budget),
            Self::Cut(options) => repair::cut::cut(draft, options, budget),
            Self::Pinch(chosen, validity) => repair::pinch::pinch(draft, chosen, *validity, budget),
            Self::Snap(options) => repair::snap::snap(draft, options, budget),
            Self::RemoveCrossing { rings } => repair::crossing::remove_crossing(draft, *rings, budget),
            Self::OpenContacts => repair::contact::open_contacts(draft, budget),
            Self::FillHoles => repair::fill::fill_holes(draft, budget),
            Self::Nest { is_embedded } => repair::nest::nest(draft, *is_embedded, budget),
        }
    }
}

/// A mesh on its way through the steps of a plan.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    pub(super) draft: Draft,
    /// What the steps did, in their order.
    pub(super) actions: Vec<Action>,
}

impl Attempt {
    /// The usable triangles of `soup`.
    pub(super) fn start(soup: &Soup, before: Option<&Analysis>) -> Self {
        let (draft, changes) = Draft::from_soup(soup);
        Self { draft, actions: vec![action("take-usable", &UNUSABLE, changes, soup, before)] }
    }

    /// Runs `steps`, and notes what each did, and why by the defects found `before`.
    pub(super) fn run(
        &mut self,
        steps: &[Step],
        soup: &Soup,
        before: Option<&Analysis>,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        for step in steps {
            budget.check()?;
            let changes = step.run(&mut self.draft, soup, budget)?;
            debug_assert_eq!(self.draft.check(), Vec::<String>::new(), "after {step:?}");
            self.actions.push(action(step.name(), step.cures(), changes, soup, before));
        }
        Ok(())
    }

    /// Count of this name, over all steps.
    pub(super) fn count(&self, name: &str) -> u64 {
        self.actions
            .iter()
            .flat_map(|action| &action.changes)
            .filter(|(n, _)| *n == name)
            .map(|(_, count)| count)
            .sum()
    }
}

/// What taking the triangles of the file as they are leaves behind.
const UNUSABLE: [DefectCode; 7] = [
    DefectCode::NonFiniteVertex,
    DefectCode::NonFiniteFace,
    DefectCode::IndexOutOfRange,
    DefectCode::TooFewCorners,
    DefectCode::NonPlanarPolygon,
    DefectCode::ConcavePolygon,
    DefectCode::IsolatedVertex,
];

fn action(
    step: &'static str,
    cures: &[DefectCode],
    changes: Changes,
    soup: &Soup,
    before: Option<&Analysis>,
) -> Action {
    let findings = before.map_or(&[][..], |analysis| &analysis.findings);
    let has = |code: &DefectCode| findings.iter().any(|f| f.code == *code && f.count > 0);
    Action {
        step,
        causes: cures.iter().copied().filter(has).collect(),
        changes: changes.counts,
        move_max: changes.move_max,
        reason: changes.reason + &parts_with_faces(&changes.removed_parts, soup),
    }
}

/// Parts that are gone that a reason lists one by one.
const PARTS_LISTED_MAX: usize = 16;

/// The parts that are gone, each by a face of the file.
fn parts_with_faces(removed_parts: &[u32], soup: &Soup) -> String {
    if removed_parts.is_empty() {
        return String::new();
    }
    let faces: Vec<String> =
        removed_parts.iter().take(PARTS_LISTED_MAX).map(|&t| soup.face_of(t).to_string()).collect();
    let more = if removed_parts.len() > PARTS_LISTED_MAX { " and others" } else { "" };
    format!(" (those with faces {}{more})", faces.join(", "))
}
