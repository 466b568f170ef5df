//! What a rung sees of the file and of the attempts before it, and how it runs one.

use super::flat_shells::flat_shells;
use super::{Climbed, RungKind};
use crate::analysis::{Analysis, DefectCode};
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::formats::Encoding;
use crate::geom::triangle_area;
use crate::mesh::Soup;
use crate::pipeline::fidelity::{DEFECTS_MAX, FidelityMeasurement, Original, defined_volume};
use crate::pipeline::input::Input;
use crate::pipeline::looks;
use crate::pipeline::output::Candidate;
use crate::pipeline::plan::{Attempt, Covered, Variant};
use crate::pipeline::rebuild::{self, NotRebuilt, Rebuilt};
use crate::pipeline::repair_choices::{Choices, Walls};
use crate::pipeline::size::diagonal;
use crate::pipeline::step::Step;
use crate::pipeline::{Action, Failure, FidelityLimits, Options, Refusal, Require};
use crate::repair::fill::{HoleReport, Rejection};
use crate::repair::nest::NestingPolicy;
use crate::repair::noise::Noise;
use crate::repair::{Draft, Effects, noise};
use crate::winding::{OpenShells, WindingSolid};
use std::cell::OnceCell;

/// A plan may take one of so many parts of the work that is left.
pub(super) const ATTEMPT_PART: u64 = 4;

/// What is hidden, the same.
const HIDDEN_PART: u64 = 4;

/// What stays the same on all rungs.
pub(in crate::pipeline) struct Climb<'a> {
    pub(in crate::pipeline) input: &'a Input,
    /// Of the result.
    pub(in crate::pipeline) encoding: Encoding,
    pub(in crate::pipeline) options: &'a Options,
    pub(in crate::pipeline) choices: &'a Choices,
    /// Of the file.
    pub(in crate::pipeline) before: Option<&'a Analysis>,
    pub(in crate::pipeline) budget: &'a Budget,
}

/// A certified result of steps.
pub(in crate::pipeline) struct Certified {
    pub(in crate::pipeline) attempt: Attempt,
    pub(in crate::pipeline) candidate: Candidate,
    /// What it is chosen by: what patches over openings cover is hidden, unless it is much.
    pub(in crate::pipeline) fidelity: FidelityMeasurement,
    /// What is told of it: nothing of the file is hidden that a straight line leads to.
    pub(in crate::pipeline) as_seen: FidelityMeasurement,
    /// The share of its surface that patches over openings are.
    openings: f64,
}

/// What a rung found.
pub(super) enum RungResult {
    Certified(Box<Certified>),
    Rebuilt(Box<Rebuilt>),
}

/// What the attempts until now have shown.
pub(super) struct Situation {
    /// The plan that was tried last; before the first attempt, the one to try first.
    pub(super) variant: Variant,
    /// What it left; `None` before the first attempt.
    pub(super) last: Option<Uncertified>,
    /// What the first plan does about noise.
    pub(super) first_noise: Noise,
    /// An attempt was no solid when its coordinates were read as float32.
    pub(super) fails_in_f32: bool,
    /// A plan took more than its share of the work, or all changes of the surface took more than theirs.
    pub(super) has_run_out: bool,
    /// Bodies were to be united.
    pub(super) has_tried_uniting: bool,
    /// Gaps between arcs and chords were to be closed.
    pub(super) has_tried_chordal_gaps: bool,
    /// Rims that face each other were to get one patch.
    pub(super) has_tried_bridging: bool,
    /// Sheets beside bodies were to get walls.
    pub(super) has_tried_sheets_left: bool,
    /// A surface was to be rebuilt.
    pub(super) has_tried_rebuilding: bool,
    /// The closest certified result.
    pub(super) certified: Option<Box<Certified>>,
    rebuilt: Option<Box<Rebuilt>>,
    /// Why no surface was rebuilt, and what was done before that was known.
    pub(super) not_rebuilt: Option<(Refusal, Vec<Action>)>,
    /// How open the surface is with rims joined; asked once.
    openness: OnceCell<Openness>,
}

/// How open a surface is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Openness {
    pub(super) boundary_edges: u64,
    pub(super) triangles: u64,
    /// The open parts are mostly sheets that may become walls.
    pub(super) is_sheets: bool,
}

/// What an attempt that is no valid solid leaves.
pub(super) struct Uncertified {
    pub(super) holes: Vec<HoleReport>,
    pub(super) effects: Effects,
    /// Its mesh, where it left flat sheets and no other hole. Otherwise it goes: other attempts need the memory.
    pub(super) with_sheets: Option<Draft>,
    actions: Vec<Action>,
    /// Without the steps that join what was cut; only where the best effort was asked for.
    pub(super) mended: Option<Box<Attempt>>,
    pub(super) refusal: Refusal,
}

/// True when something was left open, all of it flat sheets.
fn leaves_sheets(holes: &[HoleReport]) -> bool {
    let is_flat = |hole: &HoleReport| {
        hole.rejected.last().is_some_and(|rejected| rejected.reason == Rejection::FlatSheet)
    };
    let mut left = holes.iter().filter(|hole| hole.used.is_none()).peekable();
    left.peek().is_some() && left.all(is_flat)
}

impl Situation {
    /// Before the first attempt, which joins rims that lie `snap_epsilon` apart.
    pub(super) fn at_the_foot(climb: &Climb<'_>, snap_epsilon: f64) -> Result<Self, Stopped> {
        let (draft, _) = Draft::from_soup(&climb.input.soup);
        // Where noise about zero keeps rims apart, joining them is the smaller change: both rims could be closed instead,
        // which would leave two bodies with nothing between them.
        let parts_rims = || noise::parts_rims(&draft, climb.budget);
        let parts_rims = climb.budget.within_part(ATTEMPT_PART, parts_rims)?.unwrap_or(false);
        let noise = if parts_rims { Noise::Joined } else { Noise::Stays };
        let variant = Variant {
            noise,
            rounds: climb.needs_f32(),
            snap_epsilon,
            opposite: climb.choices.opposite,
            thickens: climb.choices.walls == Walls::First,
            mends_thin_faces: true,
            ..Variant::default()
        };
        Ok(Self {
            variant,
            last: None,
            first_noise: noise,
            fails_in_f32: false,
            has_run_out: false,
            has_tried_uniting: false,
            has_tried_chordal_gaps: false,
            has_tried_bridging: false,
            has_tried_sheets_left: false,
            has_tried_rebuilding: false,
            certified: None,
            rebuilt: None,
            not_rebuilt: None,
            openness: OnceCell::new(),
        })
    }

    /// Whether a rung of this kind may still come. Another plan takes as much as one that took too much.
    pub(super) fn may_try(&self, kind: RungKind) -> bool {
        match kind {
            RungKind::Plan => !self.has_run_out && self.may_change_the_surface(),
            RungKind::Union => self.may_change_the_surface(),
            RungKind::NewSurface => true,
        }
    }

    /// True while nothing is certified and something is left that another change could make a solid of.
    fn may_change_the_surface(&self) -> bool {
        let is_broken = |last: &Uncertified| matches!(last.refusal, Refusal::NotRepairable { .. });
        self.certified.is_none() && self.last.as_ref().is_none_or(is_broken)
    }

    /// Takes in what a rung found.
    pub(super) fn keep_closest(&mut self, found: Option<RungResult>, climb: &Climb<'_>) {
        match found {
            None => {}
            Some(RungResult::Certified(certified)) => self.certified = Some(certified),
            Some(RungResult::Rebuilt(rebuilt)) => {
                let limits = &climb.options.limits;
                let is_closer =
                    |certified: &Certified| !certified.fidelity.is_no_worse(&rebuilt.fidelity, limits);
                if self.certified.as_deref().is_none_or(is_closer) {
                    self.rebuilt = Some(rebuilt);
                }
            }
        }
    }

    /// The best there is.
    pub(super) fn outcome(self, climb: &Climb<'_>) -> Climbed {
        let over_budget = Refusal::OverBudget { units: climb.budget.work_used() };
        let refused = |refusal, actions| Climbed::Refused { refusal, actions };
        if let Some(rebuilt) = self.rebuilt {
            return Climbed::Rebuilt(rebuilt);
        }
        if let Some(certified) = self.certified {
            return Climbed::Certified(certified);
        }
        let Some(Uncertified { actions, mended, refusal, .. }) = self.last else {
            let (refusal, actions) = self.not_rebuilt.unwrap_or((over_budget, Vec::new()));
            return refused(refusal, actions);
        };
        let may_be_partial = match &self.not_rebuilt {
            Some((refusal, _)) => *refusal != Refusal::NothingToRepair,
            None => matches!(refusal, Refusal::NotRepairable { .. }),
        };
        let refusal = if self.has_run_out { over_budget } else { refusal };
        let (refusal, actions) = self.not_rebuilt.unwrap_or((refusal, actions));
        match mended.filter(|_| may_be_partial) {
            Some(mended) => Climbed::Mended(mended),
            None => refused(refusal, actions),
        }
    }
}

impl Climb<'_> {
    /// Tries the plan of `variant`, and once more without mending thin faces where that did something: a vertex that was
    /// merged may have taken a face through another one.
    pub(super) fn try_plan(
        &self,
        variant: Variant,
        situation: &mut Situation,
    ) -> Result<Option<RungResult>, Failure> {
        situation.variant = variant;
        let run = |variant| self.budget.within_part(ATTEMPT_PART, || self.run(variant));
        let Some((mut mended, mut attempt)) = run(variant)? else {
            situation.has_run_out = true;
            return Ok(None);
        };
        // Without a bridge or a gap that was closed it is the plan that was tried before.
        let Effects { bridged_rims, closed_chordal_gaps, .. } = attempt.effects;
        if variant.bridges && !bridged_rims && !variant.thickens_rest
            || variant.closes_chordal_gaps && !closed_chordal_gaps
        {
            return Ok(None);
        }
        let mut judged = self.judge(&attempt)?;
        let has_mended = |attempt: &Attempt| attempt.effects.mended_thin_faces;
        if variant.mends_thin_faces && judged.is_broken() && has_mended(&attempt) {
            situation.fails_in_f32 |= judged.fails_in_f32();
            situation.variant.mends_thin_faces = false;
            match run(situation.variant)? {
                Some(again) => {
                    (mended, attempt) = again;
                    judged = self.judge(&attempt)?;
                }
                None => situation.has_run_out = true,
            }
        }
        situation.fails_in_f32 |= judged.fails_in_f32();
        match judged {
            Judgement::Certified(candidate) => {
                let certified = Certified::measured(attempt, *candidate, self)?;
                Ok(Some(RungResult::Certified(Box::new(certified))))
            }
            Judgement::Not(refusal) => {
                let Attempt { draft, holes, effects, actions, .. } = attempt;
                let with_sheets = leaves_sheets(&holes).then_some(draft);
                situation.last = Some(Uncertified { holes, effects, with_sheets, actions, mended, refusal });
                Ok(None)
            }
        }
    }

    /// Runs a plan: the mended mesh if the best effort may be asked for it, and the one that may be a solid.
    fn run(&self, variant: Variant) -> Result<(Option<Box<Attempt>>, Attempt), Stopped> {
        let (choices, budget) = (self.choices, self.budget);
        let is_best_effort = matches!(self.options.require, Some(Require::BestEffort | Require::None));
        let soup = &self.input.soup;
        budget.stage(Stage::Repair, || {
            let mut attempt = Attempt::start(soup, self.before);
            let _charge = budget.charge(attempt.draft.bytes() * if is_best_effort { 2 } else { 1 })?;
            attempt.run(&variant.mending(choices), soup, self.before, budget)?;
            let mended = is_best_effort.then(|| Box::new(attempt.clone()));
            attempt.run(&variant.solidifying(choices, self.has_contacts()), soup, self.before, budget)?;
            Ok((mended, attempt))
        })
    }

    /// Runs further steps.
    pub(in crate::pipeline) fn go_on(&self, attempt: &mut Attempt, steps: &[Step]) -> Result<(), Stopped> {
        self.budget.stage(Stage::Repair, || attempt.run(steps, &self.input.soup, self.before, self.budget))
    }

    /// Writes what an attempt made, and judges the bytes.
    pub(super) fn judge(&self, attempt: &Attempt) -> Result<Judgement, Failure> {
        if attempt.draft.triangles.is_empty() {
            return Ok(Judgement::Not(Refusal::NothingToRepair));
        }
        let soup = looks::soup_of(&attempt.draft, &self.input.soup, self.budget)?;
        match Candidate::write(soup, self.input, self.encoding, Depth::FirstViolation, self.budget) {
            Ok(candidate) if candidate.certificate().is_printable() => {
                Ok(Judgement::Certified(Box::new(candidate)))
            }
            Ok(candidate) => {
                let witness = candidate.certificate().witnesses.first().cloned();
                Ok(Judgement::Not(Refusal::NotRepairable { witness }))
            }
            Err(reason) => Ok(Judgement::Not(reason.refusal()?)),
        }
    }

    /// Makes a new surface.
    pub(in crate::pipeline) fn rebuild(&self) -> Result<Rebuilt, NotRebuilt> {
        rebuild::rebuild(self.input, self.encoding, self.options, self.choices, self.before, self.budget)
    }

    /// True when the encoding holds no more than float32, so that every plan has to round.
    pub(super) fn needs_f32(&self) -> bool {
        self.encoding.is_float32() && !self.input.soup.is_f32_exact
    }

    /// True unless it is known that no triangles meet others.
    pub(super) fn has_contacts(&self) -> bool {
        self.input.examination.contacts.as_ref().is_none_or(|contacts| contacts.count > 0)
    }

    /// True when the file has a defect of this kind.
    pub(super) fn has_found(&self, code: DefectCode) -> bool {
        let findings = self.before.map_or(&[][..], |analysis| &analysis.findings);
        findings.iter().any(|finding| finding.code == code && finding.count > 0)
    }

    /// The largest coordinate by its amount, in the unit of the file.
    pub(super) fn reach(&self) -> f64 {
        let finite = self.input.soup.positions.iter().filter(|p| p.is_finite());
        finite.fold(0.0f64, |reach, p| reach.max(p.abs().max_element()))
    }

    /// How open the surface is: once rims are joined that lie beside each other, if that does not take too much work.
    pub(super) fn openness(&self, situation: &Situation) -> Result<Openness, Stopped> {
        let variant = situation.variant;
        if variant.snap_epsilon == 0.0 {
            return self.openness_as_read();
        }
        if let Some(&known) = situation.openness.get() {
            return Ok(known);
        }
        let joined = self.budget.within_part(ATTEMPT_PART, || self.openness_joined(variant))?;
        let found = joined.map_or_else(|| self.openness_as_read(), Ok)?;
        Ok(*situation.openness.get_or_init(|| found))
    }

    fn openness_as_read(&self) -> Result<Openness, Stopped> {
        let counts = self.before.map(|analysis| analysis.counts).unwrap_or_default();
        self.openness_of([counts.boundary_edges, counts.triangles], || Draft::from_soup(&self.input.soup).0)
    }

    fn openness_joined(&self, variant: Variant) -> Result<Openness, Stopped> {
        let mut attempt = Attempt::start(&self.input.soup, self.before);
        let _charge = self.budget.charge(attempt.draft.bytes())?;
        self.go_on(&mut attempt, &variant.joining(self.choices))?;
        let rim = attempt.draft.edge_groups(self.budget)?.iter().filter(|group| group.len() == 1).count();
        let counts = [rim as u64, attempt.draft.triangles.len() as u64];
        self.openness_of(counts, || attempt.draft)
    }

    /// A surface with few boundary edges for its triangles is no sheet: a square of them has three for the root of their number.
    fn openness_of(
        &self,
        [boundary_edges, triangles]: [u64; 2],
        draft: impl FnOnce() -> Draft,
    ) -> Result<Openness, Stopped> {
        let may_be_sheets = boundary_edges > 0
            && boundary_edges as f64 >= (triangles as f64).sqrt()
            && self.choices.walls == Walls::ForSheets
            && self.options.wrap.open_shells != OpenShells::Close;
        let is_sheets = || rebuild::is_mostly_sheets(&draft(), self.options, self.budget);
        let is_sheets = may_be_sheets && self.budget.stage(Stage::Measure, is_sheets)?;
        Ok(Openness { boundary_edges, triangles, is_sheets })
    }
}

/// The judgement on what an attempt made.
pub(super) enum Judgement {
    Certified(Box<Candidate>),
    Not(Refusal),
}

impl Judgement {
    /// True when it was written, and is no valid solid.
    fn is_broken(&self) -> bool {
        matches!(self, Self::Not(Refusal::NotRepairable { .. }))
    }

    /// True when its first violation is one of coordinates that are read as float32.
    pub(super) fn fails_in_f32(&self) -> bool {
        matches!(self, Self::Not(Refusal::NotRepairable { witness: Some(witness) }) if witness.reading.is_f32)
    }
}

impl Certified {
    /// A certified result, measured against the file.
    pub(in crate::pipeline) fn measured(
        attempt: Attempt,
        candidate: Candidate,
        climb: &Climb<'_>,
    ) -> Result<Self, Failure> {
        let measure =
            |looks_out| fidelity(&attempt, &candidate, looks_out, attempt.covered(looks_out).as_ref(), climb);
        let fidelity = measure(attempt.hides_more)?;
        // What is inside of the outermost shells goes as chosen, also behind openings.
        let may_be_seen = attempt.closes_openings
            && !attempt.hides_more
            && climb.choices.nesting != NestingPolicy::Fill
            && fidelity.losses.hidden_area > 0.0;
        // Where that is too much work, patches stay in the way.
        let seen_past = || if may_be_seen { measure(true) } else { Ok(fidelity) };
        let mut as_seen = climb.budget.within_part(HIDDEN_PART, seen_past)?.unwrap_or(fidelity);
        let limits = &climb.options.limits;
        let openings = openings(&attempt, fidelity.losses.invented, candidate.soup());
        let chosen = fidelity.to_choose_by(as_seen, openings, limits);
        let mut fidelity = chosen_past_mouths(&attempt, &candidate, chosen, as_seen, climb)?;
        if attempt.closes_openings {
            // What was a sheet is no body by a patch that lies on it.
            let origins = candidate.origins(&attempt.draft.triangle_origin);
            let flat = flat_shells(candidate.soup(), &origins, diagonal(&climb.input.soup), climb.budget)?;
            fidelity.losses.bodies_lost += flat;
            as_seen.losses.bodies_lost += flat;
        }
        Ok(Self { attempt, candidate, fidelity, as_seen, openings })
    }

    /// True when so much is lost behind patches that the openings may have been better left open.
    pub(super) fn covers_much(&self, limits: &FidelityLimits) -> bool {
        // Where more is lost than patches cover, they may cover more than defects too.
        let openings = if self.fidelity.passes(limits) { self.openings } else { 1.0 };
        self.attempt.closes_openings && self.as_seen.loses_much_behind(openings)
    }
}

/// The share of the surface of a result that patches over openings are, where a missing triangle is no opening unless it is large;
/// `invented`, where it is not known what patches there are.
fn openings(attempt: &Attempt, invented: f64, result: &Soup) -> f64 {
    if attempt.holes.is_empty() {
        return invented;
    }
    let area: f64 = (0..result.triangles.len() as u32).map(|t| triangle_area(result.corners(t))).sum();
    let is_opening = |hole: &&HoleReport| {
        let edges: u32 = hole.rims.iter().map(|rim| rim.edges).sum();
        edges > 3 || hole.area > DEFECTS_MAX * area
    };
    let patches: f64 = attempt.holes.iter().filter(is_opening).map(|hole| hole.area).sum();
    if area > 0.0 { patches / area } else { 0.0 }
}

/// What a candidate is chosen by where cavities are open: what is lost there is told, and no reason to fill them.
fn chosen_past_mouths(
    attempt: &Attempt,
    candidate: &Candidate,
    chosen: FidelityMeasurement,
    as_seen: FidelityMeasurement,
    climb: &Climb<'_>,
) -> Result<FidelityMeasurement, Stopped> {
    let (limits, looks_out) = (&climb.options.limits, attempt.hides_more);
    let demands_all = climb.options.require == Some(Require::Faithful) || as_seen.breach(limits).is_some();
    if chosen.passes(limits) || demands_all {
        return Ok(chosen);
    }
    let Some(covered) = attempt.covered_but_for_mouths(looks_out) else { return Ok(chosen) };
    let past = fidelity(attempt, candidate, looks_out, Some(&covered), climb)?;
    Ok(if past.passes(limits) { past } else { chosen })
}

/// How far a candidate is from the file, of which what is `covered` need not be looked for. What a straight line leads to from outside
/// of the file is not hidden when it `looks_out`.
fn fidelity(
    attempt: &Attempt,
    candidate: &Candidate,
    looks_out: bool,
    covered: Option<&Covered>,
    climb: &Climb<'_>,
) -> Result<FidelityMeasurement, Stopped> {
    let Climb { input, options, before, budget, .. } = *climb;
    let (draft, volume) = (&attempt.draft, defined_volume(before));
    let origins = candidate.origins(&draft.triangle_origin);
    let measure =
        |original: &Original<'_>| original.measure_rest(candidate.soup(), &origins, covered, budget);
    // Mostly nothing is gone, and what is hidden does not matter.
    let all_seen = measure(&Original::new(&input.soup, volume, None))?;
    if all_seen.passes(&options.limits) && !all_seen.is_far_from(&input.soup) {
        return Ok(all_seen);
    }
    let read = || {
        let solid = WindingSolid::of(&draft.positions, &draft.triangles, options.wrap.open_shells, budget)?;
        let original = Original::new(&input.soup, volume, Some(solid));
        if looks_out { original.with_outlook(budget) } else { Ok(original) }
    };
    // Where it is too much work to say what is hidden, everything counts as seen.
    let original = budget.within_part(HIDDEN_PART, || budget.stage(Stage::Measure, read))?;
    original.map_or(Ok(all_seen), |original| measure(&original))
}
