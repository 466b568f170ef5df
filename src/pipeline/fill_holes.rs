//! Holes closed and nothing else: every vertex and every triangle of the file stays, and patches are added.

use super::input::Input;
use super::output::{OperationMesh, unchanged};
use super::plan::Attempt;
use super::step::Step;
use super::{Answer, ChosenHole, Failure, Operation, Options, Outcome, Report, looks};
use crate::analysis::{Analysis, DefectCode, HoleGuess, Witness};
use crate::budget::{Budget, Stage, Stopped};
use crate::repair::fill::{FillOptions, HoleChoice, HoleReport, Rejected};
use crate::repair::{Draft, NEW, Selection};

/// Which holes are filled, and how.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FillHolesChoices {
    /// By their places among the boundary loops that `analyze` lists, from 0; `None`: all.
    pub holes: Option<Vec<ChosenHole>>,
    /// How; which ones is said by `holes`.
    pub fill: FillOptions,
}

/// What became of the holes of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Filling {
    /// One for each boundary loop, for several that get one patch, or for a gap between loops that meet in several vertices, in
    /// the order of their first loops; of `fill-holes` the
    /// first [`ELEMENTS_MAX`](super::ELEMENTS_MAX) loops, of a repair those that were filled or tried of those that are listed.
    pub holes: Vec<HoleOutcome>,
    /// Share of the area of the result that is patches.
    pub interpolated_area_share: f64,
}

/// What became of one hole.
#[derive(Debug, Clone, PartialEq)]
pub struct HoleOutcome {
    /// Which part of the file it is of; `None`: the file was taken as one mesh.
    pub part: Option<u32>,
    /// Places of its loops among the witnesses of the boundary loops, from 0, ascending.
    pub loops: Vec<u32>,
    /// What the first of them most likely is; `None`: it does not close.
    pub guess: Option<HoleGuess>,
    /// Edges of the loops.
    pub edges: u64,
    /// What happened.
    pub fate: HoleFate,
    /// Patches that were made and not taken.
    pub rejected: Vec<Rejected>,
    /// What the filling tells of the hole; `None`: it was not tried.
    pub told: Option<HoleReport>,
}

/// What happened to a hole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HoleFate {
    /// It has a patch.
    Filled,
    /// No patch was sound.
    Rejected,
    /// It is no simple loop: directions of faces contradict each other there, or more than two faces meet.
    NoLoop,
    /// It was not chosen.
    Kept,
}

/// The loops of the file, as they are listed.
pub(super) struct ListedLoops {
    /// The first ones.
    witnesses: Vec<Witness>,
    /// Half-edges of the soup and the number of the loop that each is in, ascending.
    edges: Vec<[u32; 2]>,
    count: u64,
}

/// Fills holes of `input`; one without holes, or without one that can be filled, comes back as it is.
pub(super) fn fill_holes(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let mut report = input.report(Operation::FillHoles, budget)?;
    let loops = ListedLoops::take(&mut report, input.samples);
    let fill = loops.chosen(&options.filling)?;
    let before = report.before.as_ref();
    let mut attempt = Attempt::start(&input.soup, before);
    let _charge = budget.charge(3 * attempt.draft.bytes())?;
    let filled = budget.stage(Stage::Repair, || run(&mut attempt, &fill, input, before, budget))?;
    let FilledFile { draft, holes } = filled;
    let Attempt { actions, .. } = attempt;
    let has_patch = draft.triangle_origin.contains(&NEW);
    let filling = Filling {
        holes: loops.outcomes(holes, options.filling.holes.as_deref()),
        interpolated_area_share: interpolated_share(&draft, budget)?,
    };
    let report = Report { actions, filling: Some(filling), ..report };
    // Without a patch this is what a conversion gives.
    if !has_patch && input.may_come_back_as(input.output_encoding(options)) {
        return Ok(unchanged(input, options, report, Outcome::Partial));
    }
    let outcome: fn(bool) -> Outcome = match has_patch {
        true => |_| Outcome::Filled,
        false => |is_printable| if is_printable { Outcome::Converted } else { Outcome::Partial },
    };
    let soup = looks::soup_of(&draft, &input.soup, budget)?;
    let made = OperationMesh { soup, origins: &draft.triangle_origin, outcome };
    made.returned(input, options, report, budget)
}

/// The file with patches, and what is told of each hole.
struct FilledFile {
    draft: Draft,
    holes: Vec<HoleReport>,
}

/// Welds, and fills a copy in which faces agree and none is degenerate; of that copy only the patches are taken.
fn run(
    attempt: &mut Attempt,
    fill: &FillOptions,
    input: &Input,
    before: Option<&Analysis>,
    budget: &Budget,
) -> Result<FilledFile, Stopped> {
    let soup = &input.soup;
    attempt.run(&[Step::Weld], soup, before, budget)?;
    let whole = attempt.draft.clone();
    let told = attempt.actions.len();
    attempt.run(&[Step::DropDegenerate, Step::Orient], soup, before, budget)?;
    let turned = attempt.effects.turned_triangles;
    attempt.actions.truncate(told);
    let first = attempt.draft.triangles.len();
    attempt.run(&[Step::FillHoles(fill.clone())], soup, before, budget)?;
    if let (1.., Some(action)) = (turned, attempt.actions.last_mut()) {
        let seen =
            format!("{turned} faces that contradict their neighbours were taken as if they were turned");
        let separator = if action.reason.is_empty() { "" } else { "; " };
        action.reason.push_str(&format!("{separator}{seen}"));
    }
    let made = std::mem::take(&mut attempt.draft);
    let draft = Draft {
        triangles: [&whole.triangles[..], &made.triangles[first..]].concat(),
        triangle_origin: [&whole.triangle_origin[..], &made.triangle_origin[first..]].concat(),
        two_sided: whole.two_sided,
        ..made
    };
    Ok(FilledFile { draft, holes: std::mem::take(&mut attempt.holes) })
}

/// Share of the area that new triangles make up; 0 where nothing has an area.
fn interpolated_share(draft: &Draft, budget: &Budget) -> Result<f64, Stopped> {
    budget.spend(draft.triangles.len() as u64 / 64)?;
    let (mut new, mut all) = (0.0, 0.0);
    for (&origin, area) in draft.triangle_origin.iter().zip(draft.areas()) {
        all += area;
        new += if origin == NEW { area } else { 0.0 };
    }
    Ok(if all > 0.0 { new / all } else { 0.0 })
}

impl ListedLoops {
    /// The loops of the file of `report`, which keeps `samples` witnesses of them.
    pub(super) fn take(report: &mut Report, samples: usize) -> Self {
        let analysis = report.before.as_mut();
        let Some(analysis) = analysis else {
            return Self { witnesses: Vec::new(), edges: Vec::new(), count: 0 };
        };
        let edges = std::mem::take(&mut analysis.loop_edges);
        let count = analysis.counts.boundary_loops;
        let loops = analysis.findings.iter_mut().find(|finding| finding.code == DefectCode::BoundaryLoop);
        let witnesses = loops.map_or_else(Vec::new, |finding| {
            let all = finding.witnesses.clone();
            finding.witnesses.truncate(samples);
            all
        });
        Self { witnesses, edges, count }
    }

    /// How to fill, with the holes that are chosen.
    fn chosen(&self, choices: &FillHolesChoices) -> Result<FillOptions, Failure> {
        let Some(chosen) = &choices.holes else {
            return Ok(FillOptions { holes: Selection::default(), ..choices.fill.clone() });
        };
        let mut anchors = Vec::with_capacity(chosen.len());
        let mut single = Vec::new();
        for hole in chosen {
            let witness = self.witnesses.get(hole.number as usize);
            let no_such = Failure::NoSuchHole { number: hole.number, holes: self.count };
            let half_edge = witness.and_then(|witness| witness.anchor).ok_or(no_such)?;
            anchors.push(half_edge);
            if hole.method.is_some() || hole.band_rings.is_some() {
                single.push(HoleChoice { half_edge, method: hole.method, band_rings: hole.band_rings });
            }
        }
        anchors.sort_unstable();
        single.sort_by_key(|choice| choice.half_edge);
        Ok(FillOptions { holes: Selection::Only(anchors), choices: single, ..choices.fill.clone() })
    }

    /// The number of the loop that half-edge `h` of the soup is in.
    fn number_of(&self, h: u32) -> Option<u32> {
        let found = self.edges.binary_search_by_key(&h, |edge| edge[0]).ok()?;
        Some(self.edges[found][1])
    }

    /// What became of each of the listed loops.
    fn outcomes(&self, told: Vec<HoleReport>, chosen: Option<&[ChosenHole]>) -> Vec<HoleOutcome> {
        let mut outcomes = self.told(told);
        let mut is_told = vec![false; self.witnesses.len()];
        for &number in outcomes.iter().flat_map(|outcome| &outcome.loops) {
            if let Some(is_told) = is_told.get_mut(number as usize) {
                *is_told = true;
            }
        }
        let mut is_chosen = vec![chosen.is_none(); self.witnesses.len()];
        for hole in chosen.into_iter().flatten() {
            is_chosen[hole.number as usize] = true;
        }
        let others = (0..).zip(&self.witnesses).zip(&is_told).filter(|&(_, &is_told)| !is_told);
        outcomes.extend(others.map(|((number, witness), _)| HoleOutcome {
            part: None,
            loops: vec![number],
            guess: witness.hole,
            edges: witness.figures.iter().find(|(name, _)| *name == "edges").map_or(0, |&(_, n)| n as u64),
            fate: if is_chosen[number as usize] { HoleFate::NoLoop } else { HoleFate::Kept },
            rejected: Vec::new(),
            told: None,
        }));
        outcomes.sort_by_key(|outcome| outcome.loops.first().copied());
        outcomes
    }

    /// What a repair that made `draft` tells of the holes that it filled or tried to fill; `None`: of none. What was no loop of
    /// the file, but became one by a step before, is not listed.
    pub(super) fn filling(
        &self,
        told: Vec<HoleReport>,
        draft: &Draft,
        budget: &Budget,
    ) -> Result<Option<Filling>, Stopped> {
        if told.is_empty() {
            return Ok(None);
        }
        budget.spend(draft.triangles.len() as u64 / 64)?;
        let of_result: f64 = draft.areas().into_iter().sum();
        // From a zero without a sign, which the sum of nothing has.
        let filled = told.iter().filter(|hole| hole.used.is_some());
        let of_patches = filled.fold(0.0, |area, hole| area + hole.area);
        let interpolated_area_share = if of_result > 0.0 { (of_patches / of_result).min(1.0) } else { 0.0 };
        let mut holes = self.told(told);
        holes.sort_by_key(|outcome| outcome.loops.first().copied());
        Ok(Some(Filling { holes, interpolated_area_share }))
    }

    /// What became of the listed loops that reports name.
    fn told(&self, told: Vec<HoleReport>) -> Vec<HoleOutcome> {
        let outcome = |report: HoleReport| {
            let half_edges = report.rims.iter().flat_map(|rim| &rim.half_edges);
            let mut loops: Vec<u32> = half_edges.filter_map(|&h| self.number_of(h)).collect();
            loops.sort_unstable();
            loops.dedup();
            let is_listed = loops.first().is_some_and(|&number| (number as usize) < self.witnesses.len());
            is_listed.then(|| HoleOutcome {
                part: None,
                guess: self.guess(&loops),
                edges: report.rims.iter().map(|rim| u64::from(rim.edges)).sum(),
                fate: if report.used.is_some() { HoleFate::Filled } else { HoleFate::Rejected },
                rejected: report.rejected.clone(),
                loops,
                told: Some(report),
            })
        };
        told.into_iter().filter_map(outcome).collect()
    }

    fn guess(&self, loops: &[u32]) -> Option<HoleGuess> {
        self.witnesses.get(*loops.first()? as usize)?.hole
    }
}
