//! What may be done about each kind of defect: what is proposed, how sure that is, and what the caller chose instead.

use super::fill_holes::ChosenHole;
use super::plan::Step;
use super::{FillHoles, Options};
use crate::analysis::{Analysis, DefectCode, Finding, HoleGuess, Severity, Witness};
use crate::repair::Selection;
use crate::repair::duplicates::OppositePairs;
use crate::repair::fill::{FillOptions, HoleChoice};
use crate::repair::nest::{Fate, Policy};
use crate::repair::thin_faces::ThinFaces;
use crate::wrap::WALL_OF_DIAGONAL;

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
fn remedies_of(code: DefectCode) -> &'static [Remedy] {
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
fn has_elements(code: DefectCode) -> bool {
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

/// Whether open parts get walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Walls {
    /// Their holes are filled, or they stay.
    Never,
    /// Where filling makes no solid of them and they are read as sheets.
    #[default]
    ForSheets,
    /// Whatever they are.
    First,
}

fn diagonal_of(analysis: &Analysis) -> f64 {
    analysis.measures.bounds.map_or(0.0, |bounds| (bounds.max - bounds.min).length())
}

/// What a repair does and leaves, by the options and a plan.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Choices {
    pub(super) splits_collinear: bool,
    /// Parts that go, each by a triangle of the soup.
    pub(super) removed_parts: Vec<u32>,
    pub(super) orients: bool,
    pub(super) cuts: bool,
    pub(super) fills_holes: bool,
    pub(super) holes: Selection,
    /// Holes that are filled in a way of their own, ascending by half-edge.
    pub(super) hole_choices: Vec<HoleChoice>,
    pub(super) nesting: Policy,
    /// Whether open parts get walls.
    pub(super) walls: Walls,
    /// Thickness of such walls, in the unit of the file.
    pub(super) wall: f64,
    /// Which thin faces go.
    pub(super) thin_faces: ThinFaces,
    /// How far apart vertices of rims may be that are joined, in the unit of the file.
    pub(super) snap_epsilon: f64,
    /// Shells whose fate is chosen, each by a triangle of the soup.
    pub(super) shells: Vec<(u32, Fate)>,
    /// What becomes of opposite duplicates first.
    pub(super) opposite: OppositePairs,
    /// Bodies that pass through each other may become one.
    pub(super) unites: bool,
    /// Triangles that meet others may be removed.
    pub(super) removes_crossing: bool,
    /// A surface may be rebuilt.
    pub(super) rebuilds: bool,
    /// Coordinates may become float32 where the format could hold more.
    pub(super) rounds: bool,
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            splits_collinear: true,
            removed_parts: Vec::new(),
            orients: true,
            cuts: true,
            fills_holes: true,
            holes: Selection::default(),
            hole_choices: Vec::new(),
            nesting: Policy::default(),
            walls: Walls::default(),
            wall: 0.0,
            thin_faces: ThinFaces::default(),
            snap_epsilon: 0.0,
            shells: Vec::new(),
            opposite: OppositePairs::default(),
            unites: true,
            removes_crossing: true,
            rebuilds: true,
            rounds: true,
        }
    }
}

impl Choices {
    /// The choices for a file with `analysis`.
    ///
    /// # Errors
    /// When the plan names what the file does not have or what cannot be chosen.
    pub(super) fn of(options: &Options, analysis: Option<&Analysis>) -> Result<Self, PlanMismatch> {
        let diagonal = analysis.map_or(0.0, diagonal_of);
        let mut choices = Self {
            fills_holes: options.fill_holes == FillHoles::Simple,
            walls: if options.fill_holes == FillHoles::None { Walls::Never } else { Walls::default() },
            wall: options.wrap.wall.unwrap_or(WALL_OF_DIAGONAL * diagonal),
            snap_epsilon: options.cut_stitch.epsilon.unwrap_or(0.0),
            nesting: options.nesting,
            ..Self::default()
        };
        let findings = analysis.map_or(&[][..], |analysis| &analysis.findings);
        for chosen in options.plan.iter().flat_map(|plan| &plan.findings) {
            let code = chosen.code;
            // A repair does not look for what is near, and there is nothing to choose about it.
            if code == DefectCode::Near {
                continue;
            }
            let finding = findings.iter().find(|finding| finding.code == code);
            choices.take(chosen, finding.ok_or(PlanMismatch::NoSuchDefect(code))?)?;
        }
        choices.removed_parts.sort_unstable();
        Ok(choices)
    }

    /// How holes are filled.
    pub(super) fn filling(&self) -> FillOptions {
        FillOptions { choices: self.hole_choices.clone(), ..FillOptions::plain(self.holes.clone()) }
    }

    /// True unless a hole is to stay.
    pub(super) fn fills_all_holes(&self) -> bool {
        self.fills_holes && self.holes == Selection::default()
    }

    /// True when whole parts are removed as chosen.
    pub(super) fn removes(&self) -> bool {
        !self.removed_parts.is_empty() || self.shells.iter().any(|&(_, fate)| fate == Fate::Goes)
    }

    /// True when thin faces go.
    pub(super) fn mends_thin_faces(&self) -> bool {
        self.thin_faces.any()
    }

    /// The choices for a surface that is to be rebuilt: what is removed goes before, and holes are looked at later.
    pub(super) fn before_rebuilding(&self) -> Self {
        let gone = self.shells.iter().filter(|&&(_, fate)| fate == Fate::Goes).map(|&(triangle, _)| triangle);
        let mut removed_parts: Vec<u32> = self.removed_parts.iter().copied().chain(gone).collect();
        removed_parts.sort_unstable();
        Self { removed_parts, fills_holes: false, ..Self::default() }
    }

    fn take(&mut self, chosen: &ChosenRemedy, finding: &Finding) -> Result<(), PlanMismatch> {
        let code = chosen.code;
        let mut anchors = Vec::with_capacity(chosen.elements.len());
        for &(number, remedy) in &chosen.elements {
            let witness = finding.witnesses.get(number as usize).filter(|_| has_elements(code));
            let anchor = witness.and_then(|witness| witness.anchor);
            anchors.push((anchor.ok_or(PlanMismatch::NoSuchElement(code, number))?, remedy));
        }
        let all = chosen.remedy.into_iter().chain(chosen.elements.iter().map(|&(_, remedy)| remedy));
        for remedy in all {
            // Walls are for all open parts or for none.
            let is_for_one = remedy == Remedy::Thicken && chosen.remedy != Some(Remedy::Thicken);
            if !remedies_of(code).contains(&remedy) || is_for_one {
                return Err(PlanMismatch::NoSuchRemedy(code, remedy));
            }
            // What is to stay would not survive.
            let stays = remedy == Remedy::Keep && finding.severity == Severity::Error;
            self.rebuilds &= !stays;
            self.unites &= !stays;
        }
        self.take_holes(chosen, finding)?;
        self.apply(code, chosen.remedy, anchors, finding);
        Ok(())
    }

    fn take_holes(&mut self, chosen: &ChosenRemedy, finding: &Finding) -> Result<(), PlanMismatch> {
        let code = chosen.code;
        for hole in &chosen.holes {
            let witness = finding.witnesses.get(hole.number as usize);
            let witness = witness.filter(|_| code == DefectCode::BoundaryLoop);
            let half_edge = witness.and_then(|witness| witness.anchor);
            let half_edge = half_edge.ok_or(PlanMismatch::NoSuchElement(code, hole.number))?;
            let &ChosenHole { method, band_rings, .. } = hole;
            self.hole_choices.push(HoleChoice { half_edge, method, band_rings });
        }
        self.hole_choices.sort_by_key(|choice| choice.half_edge);
        Ok(())
    }

    /// `anchors`: elements with a remedy of their own.
    fn apply(
        &mut self,
        code: DefectCode,
        remedy: Option<Remedy>,
        anchors: Vec<(u32, Remedy)>,
        finding: &Finding,
    ) {
        let keeps = remedy == Some(Remedy::Keep);
        match code {
            DefectCode::CollinearFace => self.splits_collinear &= !keeps,
            DefectCode::Needle => self.thin_faces.needles |= remedy == Some(Remedy::Collapse),
            DefectCode::FoldedEdge => self.thin_faces.folds |= remedy == Some(Remedy::Collapse),
            DefectCode::Cap => self.thin_faces.caps |= remedy == Some(Remedy::Flip),
            DefectCode::OrientationConflict => self.orients &= !keeps,
            DefectCode::NonManifoldEdge | DefectCode::NonManifoldVertex | DefectCode::NonOrientable => {
                self.cuts &= !keeps;
            }
            DefectCode::UnsoundReading => self.rounds &= !keeps,
            DefectCode::OppositeDuplicateFace if remedy == Some(Remedy::DropOne) => {
                self.opposite = OppositePairs::KeepFirst;
                // A wall inside a solid would go.
                self.unites = false;
            }
            DefectCode::SelfIntersection | DefectCode::Overlap | DefectCode::Touch => {
                self.unites &= matches!(remedy, None | Some(Remedy::Unite));
                self.removes_crossing &= !matches!(remedy, Some(Remedy::Keep | Remedy::Rebuild));
            }
            DefectCode::BoundaryLoop if remedy == Some(Remedy::Thicken) => self.walls = Walls::First,
            DefectCode::BoundaryLoop => {
                let differing = |usual: Remedy| {
                    let mut listed: Vec<u32> =
                        anchors.iter().filter(|&&(_, remedy)| remedy != usual).map(|&(h, _)| h).collect();
                    listed.sort_unstable();
                    listed
                };
                self.holes = match keeps {
                    true => Selection::Only(differing(Remedy::Keep)),
                    false => Selection::AllBut(differing(Remedy::Fill)),
                };
                if self.holes != Selection::default() {
                    self.walls = Walls::Never;
                }
            }
            _ if has_elements(code) => {
                let usual = remedies_of(code)[0];
                let for_others = remedy.unwrap_or(usual);
                let others = finding.witnesses.iter().filter_map(|witness| witness.anchor);
                let is_named = |h: &u32| anchors.iter().any(|&(named, _)| named == *h);
                let others: Vec<(u32, Remedy)> =
                    others.filter(|h| !is_named(h)).map(|h| (h, for_others)).collect();
                // What is proposed for all is what the steps do by themselves.
                let is_chosen = |&(_, remedy): &(u32, Remedy)| remedy != usual || for_others != usual;
                for (h, remedy) in others.into_iter().chain(anchors).filter(is_chosen) {
                    self.apply_to_part(code, h / 3, remedy);
                }
            }
            _ => {}
        }
    }

    fn apply_to_part(&mut self, code: DefectCode, triangle: u32, remedy: Remedy) {
        let is_shell = matches!(code, DefectCode::InvertedShell | DefectCode::MisnestedShell);
        match remedy {
            // A wall inside a solid is dropped by the nesting, which lists it.
            Remedy::Remove if code == DefectCode::MisnestedShell => self.shells.push((triangle, Fate::Goes)),
            Remedy::Remove => self.removed_parts.push(triangle),
            Remedy::Turn => self.shells.push((triangle, Fate::Turns)),
            Remedy::Keep if is_shell => self.shells.push((triangle, Fate::Stays)),
            // Walls are for all open parts or for none.
            Remedy::Keep if code == DefectCode::IsolatedFace => self.walls = Walls::Never,
            _ => {}
        }
    }
}
