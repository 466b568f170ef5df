//! The steps that a plan is a list of.

use crate::analysis::DefectCode;
use crate::budget::{Budget, Stopped};
use crate::mesh::{ChosenEdges, Soup, StitchValidity};
use crate::repair::cut::CutOptions;
use crate::repair::duplicates::OppositePairs;
use crate::repair::fill::{FillOptions, HoleReport};
use crate::repair::nest::NestOptions;
use crate::repair::pair_sheets::Across;
use crate::repair::polygons::DegenerateFaces;
use crate::repair::snap::SnapOptions;
use crate::repair::thin_faces::ThinFaces;
use crate::repair::{self, Changes, Draft};

/// One step of a plan, with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Polygons that pass a vertex more than once become simple ones, or go.
    SplitPolygons(DegenerateFaces),
    /// Vertices that only coordinates which are all but zero keep apart go to where one of them is.
    JoinOverNoise,
    /// Coordinates that are all but zero become zero.
    ClearNoise,
    /// Coordinates become float32.
    RoundToF32,
    /// Those of triangles that meet others when all are read as float32 become float32.
    RoundWhereItMatters,
    /// Vertices at one position become one.
    Weld,
    /// Triangles with a repeated vertex go.
    DropDegenerate,
    /// Collinear triangles go and their neighbours are divided.
    SplitCollinear,
    /// Boundary edges are divided where a boundary vertex lies on them.
    SplitTVertices,
    /// The parts in which these triangles of the soup are go.
    RemoveParts(Vec<u32>),
    /// Copies of triangles go.
    DropDuplicates(OppositePairs),
    /// Triangles that meet others go.
    RemoveCrossing {
        /// Rings of triangles around them that go too.
        rings: u32,
    },
    /// Sheets that lie triangle by triangle near other ones go.
    DropNearDuplicates {
        /// Largest distance of their corners, in the unit of the file.
        epsilon: f64,
    },
    /// Faces are turned so that neighbours agree.
    Orient,
    /// Triangles at edges with four or more are paired by their angles.
    PairSheets(Across),
    /// Singular edges and vertices are cut.
    Cut(CutOptions),
    /// Edges that the cut has parted are joined from where boundaries turn back on themselves.
    Pinch(ChosenEdges, StitchValidity),
    /// Boundary edges that are close are joined.
    Snap(SnapOptions),
    /// Gaps between an arc and its chord over which a surface lies are closed.
    CloseChordalGaps,
    /// Parts are turned so that rims which belong together run in opposite directions.
    TurnToBridge,
    /// Holes are closed.
    FillHoles(FillOptions),
    /// Needles, caps and folds go.
    MendThinFaces(ThinFaces),
    /// Open parts get a wall behind them.
    Thicken {
        /// Thickness, in the unit of the file.
        wall: f64,
    },
    /// What is open is closed by triangles between its rims that may pass through others.
    SpanRims,
    /// Bodies that pass through each other or overlap become one.
    Unite,
    /// As `Unite`; triangles with void on both sides, which go then, leave copies that are open parts of their own.
    UniteAndCopyBare,
    /// Edges that an odd number of triangles have are closed as by `SpanRims`, whichever way these turn.
    SpanOddEdges,
    /// What the triangles of each connected part enclose becomes solid, whichever way they turn.
    Enclose,
    /// As `Enclose`; triangles that enclose nothing leave copies that are open parts of their own.
    EncloseAndCopyBare,
    /// Small bodies are taken out where the solid touches itself.
    BoreContacts {
        /// From their middle out, in steps of the lattice.
        steps: u32,
    },
    /// Corners of triangles that meet others when all coordinates are read on a coarser lattice go to it.
    RoundToCoarser {
        /// Its step, in steps of the print lattice.
        steps: u32,
    },
    /// Bodies that touch become one.
    JoinContacts {
        /// Thickness of the necks between them, in the unit of the file.
        size: f64,
    },
    /// Bodies that touch are drawn apart.
    OpenContacts,
    /// Vertices at one position become one again.
    JoinCopies,
    /// Shells are turned and dropped so that they alternate.
    Nest(NestOptions),
    /// The surface is rebuilt on a lattice.
    Rebuild,
    /// The certified mesh gets fewer triangles.
    Simplify,
}

impl Step {
    /// Name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::SplitPolygons(_) => "split-polygons",
            Self::JoinOverNoise => "join-over-noise",
            Self::ClearNoise => "clear-noise",
            Self::RoundToF32 => "round-to-float32",
            Self::RoundWhereItMatters => "round-where-it-matters",
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
            Self::PairSheets(_) => "pair-sheets",
            Self::JoinContacts { .. } => "join-contacts",
            Self::SpanRims => "span-rims",
            Self::SpanOddEdges => "span-odd-edges",
            Self::UniteAndCopyBare => "unite-and-copy-bare",
            Self::Enclose => "enclose",
            Self::EncloseAndCopyBare => "enclose-and-copy-bare",
            Self::Unite => "unite",
            Self::BoreContacts { .. } => "bore-contacts",
            Self::RoundToCoarser { .. } => "round-to-coarser",
            Self::DropNearDuplicates { .. } => "drop-near-duplicates",
            Self::OpenContacts => "open-contacts",
            Self::CloseChordalGaps => "close-chordal-gaps",
            Self::TurnToBridge => "turn-to-bridge",
            Self::FillHoles(_) => "fill-holes",
            Self::MendThinFaces(_) => "mend-thin-faces",
            Self::Thicken { .. } => "thicken",
            Self::JoinCopies => "join-copies",
            Self::Nest(_) => "nest",
            Self::RemoveParts(_) => "remove-parts",
            Self::Rebuild => "rebuild",
            Self::Simplify => "simplify",
        }
    }

    /// The defects that the step is for.
    pub(super) fn cures(&self) -> &'static [DefectCode] {
        match self {
            Self::JoinOverNoise | Self::ClearNoise => &[
                DefectCode::BoundaryLoop,
                DefectCode::SelfIntersection,
                DefectCode::Overlap,
                DefectCode::Touch,
            ],
            Self::RoundToF32 | Self::RoundWhereItMatters => &[DefectCode::UnsoundReading],
            Self::JoinCopies | Self::Rebuild | Self::Simplify => &[],
            Self::MendThinFaces(_) => &[DefectCode::Needle, DefectCode::Cap, DefectCode::FoldedEdge],
            Self::Thicken { .. } => &[DefectCode::IsolatedFace, DefectCode::BoundaryLoop],
            Self::RemoveParts(_) => &[
                DefectCode::IsolatedFace,
                DefectCode::InvertedShell,
                DefectCode::MisnestedShell,
                DefectCode::ZeroVolumeShell,
            ],
            Self::RemoveCrossing { .. } | Self::Unite | Self::UniteAndCopyBare => {
                &[DefectCode::SelfIntersection, DefectCode::Overlap, DefectCode::Touch]
            }
            Self::Enclose | Self::EncloseAndCopyBare => &[
                DefectCode::BoundaryLoop,
                DefectCode::NonManifoldEdge,
                DefectCode::NonOrientable,
                DefectCode::OrientationConflict,
                DefectCode::SelfIntersection,
                DefectCode::Overlap,
                DefectCode::Touch,
            ],
            Self::PairSheets(_)
            | Self::JoinContacts { .. }
            | Self::OpenContacts
            | Self::BoreContacts { .. }
            | Self::RoundToCoarser { .. } => &[DefectCode::NonManifoldEdge, DefectCode::NonManifoldVertex],
            Self::DropNearDuplicates { .. } => &[DefectCode::BoundaryLoop, DefectCode::DoubleSkin],
            Self::SplitPolygons(_) => &[DefectCode::CoincidentCorners, DefectCode::DuplicateVertex],
            Self::Weld => &[DefectCode::DuplicateVertex],
            Self::DropDegenerate => &[DefectCode::CoincidentCorners],
            Self::SplitCollinear => &[DefectCode::CollinearFace],
            Self::DropDuplicates(_) => &[DefectCode::DuplicateFace, DefectCode::OppositeDuplicateFace],
            Self::Orient => &[DefectCode::OrientationConflict, DefectCode::NonOrientable],
            Self::Cut(_) => {
                &[DefectCode::NonManifoldEdge, DefectCode::NonManifoldVertex, DefectCode::NonOrientable]
            }
            Self::SpanOddEdges
            | Self::SplitTVertices
            | Self::Pinch(..)
            | Self::Snap(_)
            | Self::CloseChordalGaps
            | Self::TurnToBridge
            | Self::FillHoles(_)
            | Self::SpanRims => &[DefectCode::BoundaryLoop],
            Self::Nest(_) => &[DefectCode::InvertedShell, DefectCode::MisnestedShell],
        }
    }

    /// Runs the step on `draft`, which was made of `soup`; `holes` gets what is told of each hole.
    pub(super) fn run(
        &self,
        draft: &mut Draft,
        soup: &Soup,
        holes: &mut Vec<HoleReport>,
        budget: &Budget,
    ) -> Result<Changes, Stopped> {
        match self {
            Self::SplitPolygons(how) => repair::polygons::split_polygons(draft, soup, *how, budget),
            Self::JoinOverNoise => repair::noise::join_over_noise(draft, budget),
            Self::ClearNoise => Ok(repair::noise::clear_noise(draft)),
            Self::RoundToF32 => Ok(repair::round::round_to_f32(draft)),
            Self::RoundWhereItMatters => repair::round::round_where_it_matters(draft, budget),
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
            Self::SpanRims => repair::fill::span_rims(draft, budget),
            Self::SpanOddEdges => repair::fill::span_odd_edges(draft, budget),
            Self::UniteAndCopyBare => repair::unite::unite_and_copy_bare(draft, budget),
            Self::Enclose => repair::unite::enclose(draft, budget),
            Self::EncloseAndCopyBare => repair::unite::enclose_and_copy_bare(draft, budget),
            Self::Unite => repair::unite::unite(draft, budget),
            Self::BoreContacts { steps } => repair::unite::bore_contacts(draft, *steps, budget),
            Self::RoundToCoarser { steps } => repair::round::round_to_coarser(draft, *steps, budget),
            Self::OpenContacts => repair::contact::open_contacts(draft, budget),
            Self::JoinContacts { size } => repair::joint::join_contacts(draft, *size, budget),
            Self::PairSheets(across) => repair::pair_sheets::pair_sheets(draft, *across, budget),
            Self::DropNearDuplicates { epsilon } => {
                repair::near_duplicates::drop_near_duplicates(draft, *epsilon, budget)
            }
            Self::CloseChordalGaps => repair::chordal_gaps::close_chordal_gaps(draft, budget),
            Self::TurnToBridge => repair::fill::turn_to_bridge(draft, budget),
            Self::FillHoles(options) => {
                let filled = repair::fill::fill(draft, soup, options, budget)?;
                holes.extend(filled.holes);
                Ok(filled.changes)
            }
            Self::MendThinFaces(which) => repair::thin_faces::mend_thin_faces(draft, *which, budget),
            Self::Thicken { wall } => {
                repair::thicken::thicken(draft, *wall, repair::unite::unite_as_oriented, budget)
            }
            Self::Nest(options) => repair::nest::nest(draft, options, budget),
            Self::RemoveParts(triangles) => repair::parts::remove_parts(draft, triangles, budget),
            // These make new meshes and are not for a draft; see `replay`.
            Self::Rebuild | Self::Simplify => Ok(Changes::default()),
        }
    }
}
