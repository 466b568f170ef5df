//! What a repair does and leaves, by the options and the plan of the caller.

use super::Options;
use super::choices::{ChosenHole, FillHoles};
use super::remedies::{ChosenRemedy, PlanMismatch, Remedy, has_elements, remedies_of};
use super::size::diagonal;
use crate::analysis::{Analysis, DefectCode, Finding, Severity};
use crate::mesh::Soup;
use crate::repair::Selection;
use crate::repair::duplicates::OppositePairs;
use crate::repair::fill::{FillOptions, HoleChoice};
use crate::repair::nest::{NestingPolicy, ShellFate};
use crate::repair::thin_faces::ThinFaces;
use crate::wrap::WALL_OF_DIAGONAL;

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
    pub(super) nesting: NestingPolicy,
    /// Whether open parts get walls.
    pub(super) walls: Walls,
    /// Thickness of such walls, in the unit of the file.
    pub(super) wall: f64,
    /// Which thin faces go.
    pub(super) thin_faces: ThinFaces,
    /// How far apart vertices of rims may be that are joined, in the unit of the file; `None`: as the rims suggest.
    pub(super) snap_epsilon: Option<f64>,
    /// Shells whose fate is chosen, each by a triangle of the soup.
    pub(super) shells: Vec<(u32, ShellFate)>,
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
            nesting: NestingPolicy::default(),
            walls: Walls::default(),
            wall: 0.0,
            thin_faces: ThinFaces::default(),
            snap_epsilon: None,
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
    /// The choices for a file with this mesh and `analysis`.
    ///
    /// # Errors
    /// When the plan names what the file does not have or what cannot be chosen.
    pub(super) fn of(
        options: &Options,
        mesh: &Soup,
        analysis: Option<&Analysis>,
    ) -> Result<Self, PlanMismatch> {
        let mut choices = Self {
            fills_holes: options.fill_holes == FillHoles::Simple,
            walls: if options.fill_holes == FillHoles::None { Walls::Never } else { Walls::default() },
            wall: options.wrap.wall.unwrap_or_else(|| WALL_OF_DIAGONAL * diagonal(mesh)),
            snap_epsilon: options.cut_stitch.epsilon,
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

    /// How holes are filled; with one patch between rims that face each other when it `bridges`.
    pub(super) fn filling(&self, bridges: bool) -> FillOptions {
        FillOptions { choices: self.hole_choices.clone(), bridges, ..FillOptions::plain(self.holes.clone()) }
    }

    /// True unless a hole is to stay.
    pub(super) fn fills_all_holes(&self) -> bool {
        self.fills_holes && self.holes == Selection::default()
    }

    /// True when rims may be joined as they suggest: nothing else was chosen about them.
    pub(super) fn may_join_rims(&self) -> bool {
        self.snap_epsilon.is_none() && self.cuts && self.fills_all_holes()
    }

    /// True when whole parts are removed as chosen.
    pub(super) fn removes(&self) -> bool {
        !self.removed_parts.is_empty() || self.shells.iter().any(|&(_, fate)| fate == ShellFate::Goes)
    }

    /// True when thin faces go.
    pub(super) fn mends_thin_faces(&self) -> bool {
        self.thin_faces.any()
    }

    /// The choices for a surface that is to be rebuilt: what is removed goes before, and holes are looked at later.
    pub(super) fn before_rebuilding(&self) -> Self {
        let gone =
            self.shells.iter().filter(|&&(_, fate)| fate == ShellFate::Goes).map(|&(triangle, _)| triangle);
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
            Remedy::Remove if code == DefectCode::MisnestedShell => {
                self.shells.push((triangle, ShellFate::Goes));
            }
            Remedy::Remove => self.removed_parts.push(triangle),
            Remedy::Turn => self.shells.push((triangle, ShellFate::Turns)),
            Remedy::Keep if is_shell => self.shells.push((triangle, ShellFate::Stays)),
            // Walls are for all open parts or for none.
            Remedy::Keep if code == DefectCode::IsolatedFace => self.walls = Walls::Never,
            _ => {}
        }
    }
}
