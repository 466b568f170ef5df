//! What may be done about each kind of defect: what is proposed, how sure that is, and what the caller chose instead.

use super::choices::ChosenHole;
use super::step::Step;
use crate::analysis::{Analysis, DefectCode, Finding, HoleGuess, Witness};

/// What is done about a defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Remedy {
    /// What is defect goes; what is around it meets.
    Drop,
    /// Both triangles of a pair go.
    DropBoth,
    /// One triangle of a pair goes.
    DropOne,
    /// Its short edge is collapsed.
    Collapse,
    /// Its long edge is flipped.
    Flip,
    /// It is divided.
    Split,
    /// Vertices at one place become one.
    Join,
    /// It is closed by new triangles.
    Fill,
    /// The open part gets a wall behind it.
    Thicken,
    /// The surface is cut there, and joined where it belongs together.
    Cut,
    /// Triangles are turned.
    Turn,
    /// The whole part goes; of triangles that meet, they and what is around them, and the place is filled.
    Remove,
    /// Bodies that pass through each other become one.
    Unite,
    /// Coordinates become float32.
    Round,
    /// No local step cures it; the surface is rebuilt.
    Rebuild,
    /// It stays. A file with an error that stays is not printable.
    Keep,
}

/// What is proposed for the defects of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// The kind.
    pub code: DefectCode,
    /// How many.
    pub count: u64,
    /// What is to be done about all that `elements` do not name.
    pub remedy: Remedy,
    /// What else there is to choose from.
    pub choices: &'static [Remedy],
    /// How sure it is that this is what the maker of the file would want, from 0 to 1, by the rules of `docs/plan.md`.
    pub confidence: f64,
    /// Why.
    pub reason: &'static str,
    /// One for each witness of the finding, where elements can be chosen one by one.
    pub elements: Vec<ElementProposal>,
}

/// What is proposed for one element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementProposal {
    /// Place among the witnesses of the finding, from 0.
    pub number: u32,
    /// What is to be done.
    pub remedy: Remedy,
    /// As in [`Proposal::confidence`].
    pub confidence: f64,
}

/// A plan: what is to be done about the defects of one file, or was.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// SHA-256 of the file.
    pub input_sha256: [u8; 32],
    /// For each kind of defect that was found.
    pub findings: Vec<Proposal>,
    /// The steps that made the result, in their order; `None`: none was made.
    pub steps: Option<Vec<Step>>,
}

/// A plan as a caller gives it back.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChosenPlan {
    /// SHA-256 of the file that it is for; `None`: any file.
    pub input_sha256: Option<[u8; 32]>,
    /// What was chosen.
    pub findings: Vec<ChosenRemedy>,
    /// Exactly these steps, without a search.
    pub steps: Option<Vec<Step>>,
}

/// What a caller chose for the defects of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenRemedy {
    /// The kind.
    pub code: DefectCode,
    /// For all that `elements` do not name; `None`: as proposed.
    pub remedy: Option<Remedy>,
    /// For elements, by their place among the witnesses of the finding.
    pub elements: Vec<(u32, Remedy)>,
    /// How boundary loops are filled that are to be filled in a way of their own.
    pub holes: Vec<ChosenHole>,
}

impl ChosenPlan {
    /// Witnesses that each finding must have, so that all elements can be found.
    pub(super) fn samples_min(&self) -> usize {
        let needs = |finding: &ChosenRemedy| {
            let of_holes = finding.holes.iter().map(|hole| hole.number as usize + 1);
            let numbers = finding.elements.iter().map(|&(number, _)| number as usize + 1).chain(of_holes);
            let usual = remedies_of(finding.code)[0];
            let chooses_all = finding.remedy.is_some_and(|remedy| remedy != usual)
                && finding.code != DefectCode::BoundaryLoop;
            let all = (chooses_all && has_elements(finding.code)).then_some(ELEMENTS_MAX);
            numbers.chain(all).max().unwrap_or(0).min(ELEMENTS_MAX)
        };
        self.findings.iter().map(needs).max().unwrap_or(0)
    }
}

/// Most elements of one kind that can be chosen.
pub const ELEMENTS_MAX: usize = 10_000;

/// Why a plan is not for a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanMismatch {
    /// It was made for other bytes.
    OtherFile,
    /// The file has no such defect.
    NoSuchDefect(DefectCode),
    /// There is no such element that could be chosen.
    NoSuchElement(DefectCode, u32),
    /// That is no remedy of this defect.
    NoSuchRemedy(DefectCode, Remedy),
    /// A step that looks at the polygons of the file comes after another.
    NotFirst(&'static str),
}

/// The remedies of a kind of defect; the first is the usual one.
pub fn remedies_of(code: DefectCode) -> &'static [Remedy] {
    use Remedy::{
        Collapse, Cut, Drop, DropBoth, DropOne, Fill, Flip, Join, Keep, Rebuild, Remove, Round, Split,
        Thicken, Turn, Unite,
    };
    match code {
        DefectCode::Needle | DefectCode::FoldedEdge => &[Keep, Collapse],
        DefectCode::Cap => &[Keep, Flip],
        DefectCode::NoTriangle | DefectCode::DoubleSkin | DefectCode::Near => &[Keep],
        DefectCode::NoiseShell | DefectCode::OpenSheet => &[Keep, Remove],
        DefectCode::NonFiniteVertex
        | DefectCode::NonFiniteFace
        | DefectCode::IndexOutOfRange
        | DefectCode::TooFewCorners
        | DefectCode::CoincidentCorners
        | DefectCode::DuplicateFace
        | DefectCode::IsolatedVertex
        | DefectCode::IsolatedEdge => &[Drop],
        DefectCode::NonPlanarPolygon | DefectCode::ConcavePolygon => &[Split],
        DefectCode::CollinearFace => &[Split, Keep],
        DefectCode::OppositeDuplicateFace => &[DropBoth, DropOne],
        DefectCode::DuplicateVertex => &[Join],
        DefectCode::BoundaryLoop => &[Fill, Thicken, Keep],
        DefectCode::NonManifoldEdge | DefectCode::NonManifoldVertex | DefectCode::NonOrientable => {
            &[Cut, Keep]
        }
        DefectCode::OrientationConflict => &[Turn, Keep],
        DefectCode::InvertedShell => &[Turn, Remove, Keep],
        DefectCode::MisnestedShell => &[Remove, Turn, Keep],
        DefectCode::IsolatedFace => &[Thicken, Remove, Keep],
        DefectCode::ZeroVolumeShell => &[Rebuild, Remove, Keep],
        DefectCode::SelfIntersection | DefectCode::Overlap | DefectCode::Touch => {
            &[Unite, Remove, Rebuild, Keep]
        }
        DefectCode::UnsoundReading => &[Round, Keep],
    }
}

/// True when elements of this kind can be chosen one by one.
pub(super) fn has_elements(code: DefectCode) -> bool {
    matches!(
        code,
        DefectCode::BoundaryLoop
            | DefectCode::IsolatedFace
            | DefectCode::InvertedShell
            | DefectCode::MisnestedShell
            | DefectCode::ZeroVolumeShell
            | DefectCode::NoiseShell
            | DefectCode::OpenSheet
    )
}

/// What is proposed for each finding of `analysis`.
pub(super) fn proposals(analysis: &Analysis) -> Vec<Proposal> {
    let of_finding = |finding: &Finding| {
        let code = finding.code;
        let (remedy, confidence, reason) = proposed(finding);
        let choices = remedies_of(code);
        let element = |(number, witness): (usize, &Witness)| ElementProposal {
            number: number as u32,
            remedy,
            confidence: if remedy == Remedy::Fill { of_hole(witness) } else { confidence },
        };
        let elements = match has_elements(code) {
            true => finding.witnesses.iter().enumerate().map(element).collect::<Vec<_>>(),
            false => Vec::new(),
        };
        let least = elements.iter().map(|element| element.confidence).fold(confidence, f64::min);
        Proposal { code, count: finding.count, remedy, choices, confidence: least, reason, elements }
    };
    analysis.findings.iter().map(of_finding).collect()
}

/// The usual remedy, how sure it is, and why.
fn proposed(finding: &Finding) -> (Remedy, f64, &'static str) {
    let usual = remedies_of(finding.code)[0];
    let (confidence, reason) = match finding.code {
        DefectCode::Needle | DefectCode::Cap | DefectCode::FoldedEdge | DefectCode::Near => {
            (0.9, "thin shapes print as they are")
        }
        DefectCode::DoubleSkin => (0.6, "a wall too thin to print, which only its maker can thicken"),
        DefectCode::NoiseShell => (0.6, "no body is removed unless that is asked for"),
        DefectCode::OpenSheet => {
            (0.6, "it is a part of the mesh; see its boundary loops for what becomes of it")
        }
        DefectCode::NoTriangle => (1.0, "there is nothing to repair"),
        DefectCode::NonFiniteVertex
        | DefectCode::NonFiniteFace
        | DefectCode::IndexOutOfRange
        | DefectCode::TooFewCorners => {
            (0.8, "it says nothing that could be printed; the place is filled where it can be")
        }
        DefectCode::CoincidentCorners
        | DefectCode::DuplicateFace
        | DefectCode::IsolatedVertex
        | DefectCode::IsolatedEdge
        | DefectCode::DuplicateVertex
        | DefectCode::CollinearFace => (1.0, "the surface is the same without it"),
        DefectCode::NonPlanarPolygon | DefectCode::ConcavePolygon => {
            (0.9, "programs split it differently; triangles are read the same by all")
        }
        DefectCode::OppositeDuplicateFace => (
            0.7,
            "a wall between two bodies is inside the solid; one that bounds nothing else stays as one triangle",
        ),
        DefectCode::BoundaryLoop => (
            0.95,
            "rims that coincide are joined and simple holes closed; open parts that bound no volume become walls",
        ),
        DefectCode::NonManifoldEdge | DefectCode::NonManifoldVertex => {
            (0.9, "bodies that only touch are taken as bodies of their own")
        }
        DefectCode::OrientationConflict => (0.95, "the fewer faces of a part are turned"),
        DefectCode::NonOrientable => (0.5, "the surface has no two sides; it is cut along the conflict"),
        DefectCode::InvertedShell => (0.95, "nothing is around it that it could be a cavity of"),
        DefectCode::MisnestedShell => (
            0.7,
            "it points as the shell around it, so it is a wall inside the solid; it could be meant as a cavity",
        ),
        DefectCode::IsolatedFace => (0.4, "a single face bounds nothing; it could be a wall or a remnant"),
        DefectCode::ZeroVolumeShell => (0.3, "it bounds nothing; it could be a wall or a remnant"),
        DefectCode::SelfIntersection | DefectCode::Overlap | DefectCode::Touch => (
            0.8,
            "bodies that pass through each other are one solid; where they are not closed, few triangles that meet others are removed and their place is filled, and the surface is rebuilt where that does not hold",
        ),
        DefectCode::UnsoundReading => (0.95, "coordinates and triangles that all programs read the same"),
    };
    (usual, confidence, reason)
}

/// How sure it is that a hole is meant to be closed. A chain that does not close is none that a patch could close.
fn of_hole(witness: &Witness) -> f64 {
    witness.hole.map_or(CHAIN_CONFIDENCE, HoleGuess::confidence_of_closing)
}

/// As for a mesh that is open for a reason that is not understood.
const CHAIN_CONFIDENCE: f64 = 0.4;
