//! A broken file to a certified one: plans in order, the first whose bytes are certified wins.

use super::fidelity::{Fidelity, Original, defined_volume};
use super::input::Input;
use super::output::{Candidate, NoCandidate};
use super::plan::{Attempt, Step, Variant};
use super::rebuild::{NotRebuilt, Rebuilt};
use super::remedies::{Choices, PlanMismatch, Walls};
use super::united::United;
use super::{
    Answer, Contact, Failure, Operation, Options, Outcome, Refusal, Report, Require, bounds, rebuild,
    simplify,
};
use crate::analysis::Analysis;
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::formats::Encoding;
use crate::repair::duplicates::OppositePairs;
use crate::repair::nest::Policy;
use crate::repair::{self, Draft};
use crate::winding::{OpenShells, Solid};

/// Repairs `input`. A valid one comes back as it is, or converted.
pub(super) fn repair(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let report = input.planned(Operation::Repair, budget)?;
    let plan = options.plan.as_ref();
    if plan.and_then(|plan| plan.input_sha256).is_some_and(|asked| asked != input.facts.sha256) {
        return Err(PlanMismatch::OtherFile.into());
    }
    let choices = Choices::of(options, report.before.as_ref())?;
    if let Some(steps) = plan.and_then(|plan| plan.steps.as_deref()) {
        return bounds::or_refused(report, budget, |report| replay(input, steps, options, report, budget));
    }
    bounds::or_refused(report, budget, |report| planned(input, &choices, options, report, budget))
}

/// Repairs `input` by the plans that may lead to a solid.
fn planned(
    input: &Input,
    choices: &Choices,
    options: &Options,
    report: Report,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let encoding = input.output_encoding(options);
    // Cavities and small parts make no mesh invalid, but the caller may want them filled and removed.
    let is_as_asked = || {
        !choices.removes()
            && !choices.mends_thin_faces()
            && (choices.nesting != Policy::Fill || !has_cavities(input))
    };
    if input.examination.certificate.is_printable() && is_as_asked() {
        let (draft, _) = Draft::from_soup(&input.soup);
        if let Some(fewer) = simplify::of_certified(&draft, input, options, budget)? {
            let report = report.made_by(vec![Step::Simplify]);
            return fewer.returned(input, &draft, report, Outcome::Simplified, options, budget);
        }
        let report = report.clone().made_by(Vec::new());
        if input.may_come_back_as(encoding) {
            return Ok(input.returned_as_it_is(report, Outcome::Identical));
        }
        match write(&draft, input, encoding, Depth::FirstViolation, budget) {
            Ok(candidate) if candidate.certificate().is_printable() => {
                let origins = &draft.triangle_origin;
                return Ok(candidate.returned(input, origins, report, Outcome::Converted, budget)?);
            }
            // The rounding of the other format broke it: it goes on as a broken mesh.
            Ok(_) => {}
            Err(NoCandidate::Refused(refusal)) => return Ok(report.refused(refusal)),
            Err(NoCandidate::Failed(failure)) => return Err(failure),
        }
    }
    let before = report.before.clone();
    let search = Search { input, encoding, options, choices, before: before.as_ref(), budget };
    // What local edits do not do in half of the work is left to the lattice.
    let found = budget.within_part(2, || search.run())?.unwrap_or(Found::Nowhere);
    match found {
        Found::Certified(found) => {
            let (attempt, candidate) = *found;
            let fidelity = fidelity_of(&attempt, &candidate, &search)?;
            certified(United { attempt, candidate, fidelity }, &search, report)
        }
        Found::United(united) => certified(*united, &search, report),
        Found::Nowhere if choices.rebuilds => search.rebuilt(report),
        Found::Nowhere => Ok(report.refused(Refusal::OverBudget { units: budget.work_used() })),
        Found::Nothing { refusal: Refusal::NotRepairable { .. }, mended: Some(mended), .. }
            if options.require == Some(Require::None) =>
        {
            partial(input, encoding, report, *mended, budget)
        }
        Found::Nothing {
            refusal: Refusal::NotRepairable { .. } | Refusal::NothingToRepair, mended, ..
        } if choices.rebuilds => match (search.rebuild(), mended) {
            (Ok(rebuilt), _) => {
                let report = report.made_by(rebuilding(choices));
                Ok(rebuilt.returned(input, report, budget)?)
            }
            (Err(NotRebuilt::Failed(failure)), _) => Err(failure),
            (Err(NotRebuilt::Refused { refusal, .. }), Some(mended))
                if refusal != Refusal::NothingToRepair =>
            {
                partial(input, encoding, report, *mended, budget)
            }
            (Err(NotRebuilt::Refused { refusal, actions }), _) => {
                Ok(Report { actions, ..report }.refused(refusal))
            }
        },
        Found::Nothing { refusal: Refusal::NotRepairable { .. }, mended: Some(mended), .. } => {
            partial(input, encoding, report, *mended, budget)
        }
        Found::Nothing { refusal, last, .. } => {
            Ok(Report { actions: last.actions, ..report }.refused(refusal))
        }
    }
}

/// A result of local steps, unless it lost too much and one that is rebuilt is closer.
fn certified(found: United, search: &Search<'_>, report: Report) -> Result<Answer, Failure> {
    let Search { input, options, budget, .. } = *search;
    let United { attempt, candidate, fidelity } = found;
    // What was removed as chosen is no loss that a rebuilt surface could make good.
    if !fidelity.passes(&options.limits) && search.choices.rebuilds && !search.choices.removes() {
        let rebuilt = match budget.within_part(2, || search.rebuild()) {
            Ok(rebuilt) => rebuilt,
            Err(NotRebuilt::Refused { .. }) => None,
            Err(NotRebuilt::Failed(failure)) => return Err(failure),
        };
        let closer = rebuilt.filter(|rebuilt| !fidelity.is_no_worse(&rebuilt.fidelity, &options.limits));
        if let Some(rebuilt) = closer {
            return Ok(rebuilt.returned(input, report.made_by(rebuilding(search.choices)), budget)?);
        }
    }
    finished((attempt, candidate), fidelity, Outcome::Repaired, search, report)
}

/// How far a result of local steps is from the file.
pub(super) fn fidelity_of(
    attempt: &Attempt,
    candidate: &Candidate,
    search: &Search<'_>,
) -> Result<Fidelity, Failure> {
    let Search { input, options, before, budget, .. } = *search;
    let (draft, volume) = (&attempt.draft, defined_volume(before));
    // Mostly nothing is gone, and what is hidden does not matter.
    let all = Original::new(&input.soup, volume, None);
    let covered = attempt.covered();
    let measure = |original: &Original<'_>| {
        original.measure_rest(candidate.soup(), &draft.triangle_origin, covered.as_ref(), budget)
    };
    let fidelity = measure(&all)?;
    if fidelity.passes(&options.limits) {
        return Ok(fidelity);
    }
    let read = || Solid::of(&draft.positions, &draft.triangles, options.wrap.open_shells, budget);
    let solid = budget.stage(Stage::Measure, read)?;
    let visible = Original::new(&input.soup, volume, Some(solid));
    Ok(measure(&visible)?)
}

/// A result of local steps as the answer, with fewer triangles if that is asked, unless it is beyond the caller's limits.
fn finished(
    (attempt, candidate): (Attempt, Candidate),
    fidelity: Fidelity,
    outcome: Outcome,
    search: &Search<'_>,
    report: Report,
) -> Result<Answer, Failure> {
    let Search { input, options, budget, .. } = *search;
    let Attempt { draft, actions, steps, .. } = attempt;
    if let Some(refusal) = fidelity.breach(&options.limits) {
        return Ok(Report { actions, ..report }.refused(refusal));
    }
    let report = Report { actions, losses: Some(fidelity.losses), distance: fidelity.distance, ..report };
    if let Some(fewer) = simplify::of_certified(&draft, input, options, budget)? {
        let report = report.made_by([steps, vec![Step::Simplify]].concat());
        return fewer.returned(input, &draft, report, outcome, options, budget);
    }
    Ok(candidate.returned(input, &draft.triangle_origin, report.made_by(steps), outcome, budget)?)
}

/// Runs exactly `steps`, as a plan gives them.
fn replay(
    input: &Input,
    steps: &[Step],
    options: &Options,
    report: Report,
    budget: &Budget,
) -> Result<Answer, Failure> {
    if let Some(late) = steps.iter().skip(1).find(|step| matches!(step, Step::SplitPolygons(_))) {
        return Err(PlanMismatch::NotFirst(late.name()).into());
    }
    let before = report.before.clone();
    let encoding = input.output_encoding(options);
    let removed = |step: &Step| if let Step::RemoveParts(parts) = step { parts.clone() } else { Vec::new() };
    let choices = &Choices { removed_parts: steps.iter().flat_map(removed).collect(), ..Choices::default() };
    let is_simplified = steps.contains(&Step::Simplify);
    let mut settings = options.clone();
    if !is_simplified && !steps.contains(&Step::Rebuild) {
        settings.simplify.targets.clear();
    }
    let options = &settings;
    let search = Search { input, encoding, options, choices, before: before.as_ref(), budget };
    if steps.contains(&Step::Rebuild) {
        return search.rebuilt(report);
    }
    if steps.is_empty() && input.may_come_back_as(encoding) {
        let is_valid = input.examination.certificate.is_printable();
        let outcome = if is_valid { Outcome::Identical } else { Outcome::Partial };
        return Ok(input.returned_as_it_is(report.made_by(Vec::new()), outcome));
    }
    let local: Vec<Step> = steps.iter().filter(|&step| *step != Step::Simplify).cloned().collect();
    let attempt = budget.stage(Stage::Repair, || {
        let mut attempt = Attempt::start(&input.soup, before.as_ref());
        let _charge = budget.charge(attempt.draft.bytes())?;
        attempt.run(&local, &input.soup, before.as_ref(), budget)?;
        Ok::<_, Stopped>(attempt)
    })?;
    if attempt.draft.triangles.is_empty() {
        return Ok(Report { actions: attempt.actions, ..report }.refused(Refusal::NothingToRepair));
    }
    let candidate = match write(&attempt.draft, input, encoding, Depth::FirstViolation, budget) {
        Ok(candidate) => candidate,
        Err(NoCandidate::Refused(refusal)) => {
            return Ok(Report { actions: attempt.actions, ..report }.refused(refusal));
        }
        Err(NoCandidate::Failed(failure)) => return Err(failure),
    };
    if !candidate.certificate().is_printable() {
        if options.require.unwrap_or(Require::Printable).is_of_a_solid() {
            let witness = candidate.certificate().witnesses.first().cloned();
            let refusal = Refusal::NotRepairable { witness };
            return Ok(Report { actions: attempt.actions, ..report }.refused(refusal));
        }
        return partial(input, encoding, report, attempt, budget);
    }
    let outcome = match (local.is_empty(), is_simplified) {
        (false, _) => Outcome::Repaired,
        (true, true) => Outcome::Simplified,
        (true, false) => Outcome::Converted,
    };
    let fidelity = fidelity_of(&attempt, &candidate, &search)?;
    finished((attempt, candidate), fidelity, outcome, &search, report)
}

/// The steps of a surface that is rebuilt: what was removed as chosen is not there any more.
fn rebuilding(choices: &Choices) -> Vec<Step> {
    let removed = choices.before_rebuilding().removed_parts;
    let remove = (!removed.is_empty()).then_some(Step::RemoveParts(removed));
    remove.into_iter().chain([Step::Rebuild]).collect()
}

/// True when a shell of the valid `input` lies in another.
fn has_cavities(input: &Input) -> bool {
    input.examination.certificate.shells.iter().any(|shell| shell.depth > 0)
}

/// The search for a plan that leads to certified bytes.
pub(super) struct Search<'a> {
    pub(super) input: &'a Input,
    pub(super) encoding: Encoding,
    pub(super) options: &'a Options,
    pub(super) choices: &'a Choices,
    pub(super) before: Option<&'a Analysis>,
    pub(super) budget: &'a Budget,
}

/// Rings that are removed around triangles that meet others, at most.
const RINGS_MAX: u32 = 2;

enum Found {
    /// The search took too much work.
    Nowhere,
    Certified(Box<(Attempt, Candidate)>),
    United(Box<United>),
    Nothing {
        refusal: Refusal,
        /// The last plan, run to its end.
        last: Box<Attempt>,
        /// The last plan without the steps that join what was cut, if the best effort was asked for.
        mended: Option<Box<Attempt>>,
    },
}

impl Found {
    fn nothing(refusal: Refusal, last: Attempt, mended: Option<Attempt>) -> Self {
        Self::Nothing { refusal, last: Box::new(last), mended: mended.map(Box::new) }
    }
}

impl Search<'_> {
    /// Tries the plans, least invasive first.
    fn run(&self) -> Result<Found, Failure> {
        let clears_noise = self.starts_with_clearing()?;
        let first = Variant { opposite: self.choices.opposite, ..Variant::default() };
        let thickens = self.choices.walls == Walls::First;
        let rounds = self.needs_f32();
        let mut variant = Variant { clears_noise, rounds, thickens, mends_thin_faces: true, ..first };
        let mut fails_in_f32 = false;
        let (mut may_unite, has_contacts) = (self.may_unite(), self.has_contacts());
        loop {
            let Some((mended, last)) = self.budget.within_part(4, || self.attempt(variant))? else {
                let united = if may_unite { self.united(variant)? } else { None };
                return Ok(united.map_or(Found::Nowhere, |united| Found::United(Box::new(united))));
            };
            if last.draft.triangles.is_empty() {
                return Ok(Found::nothing(Refusal::NothingToRepair, last, mended));
            }
            let candidate =
                match write(&last.draft, self.input, self.encoding, Depth::FirstViolation, self.budget) {
                    Ok(candidate) if candidate.certificate().is_printable() => {
                        return Ok(Found::Certified(Box::new((last, candidate))));
                    }
                    Ok(candidate) => candidate,
                    Err(NoCandidate::Refused(refusal)) => {
                        return Ok(Found::nothing(refusal, last, mended));
                    }
                    Err(NoCandidate::Failed(failure)) => return Err(failure),
                };
            let witness = candidate.certificate().witnesses.first().cloned();
            fails_in_f32 |= witness.as_ref().is_some_and(|violation| violation.reading.is_f32);
            // A vertex that was merged may have taken a face through another one.
            if variant.mends_thin_faces && last.has_mended_thin_faces() {
                variant.mends_thin_faces = false;
                continue;
            }
            let next = self.next(variant, clears_noise, &last, fails_in_f32)?;
            // Where nothing meets, all that moves no triangle through another comes first.
            let is_last = next.is_none_or(|next| next.removes_crossing.is_some());
            if (has_contacts || is_last)
                && std::mem::take(&mut may_unite)
                && let Some(united) = self.united(variant)?
            {
                return Ok(Found::United(Box::new(united)));
            }
            let Some(next) = next else {
                return Ok(Found::nothing(Refusal::NotRepairable { witness }, last, mended));
            };
            variant = next;
        }
    }

    /// Runs a plan: the mended mesh if the best effort may be asked for it, and the one that may be a solid.
    fn attempt(&self, variant: Variant) -> Result<(Option<Attempt>, Attempt), Stopped> {
        let (input, budget) = (self.input, self.budget);
        let has_contacts = self.has_contacts();
        let is_best_effort = matches!(self.options.require, Some(Require::BestEffort | Require::None));
        budget.stage(Stage::Repair, || {
            let mut attempt = Attempt::start(&input.soup, self.before);
            let _charge = budget.charge(attempt.draft.bytes() * if is_best_effort { 2 } else { 1 })?;
            attempt.run(&variant.mending(self.choices), &input.soup, self.before, budget)?;
            let mended = is_best_effort.then(|| attempt.clone());
            attempt.run(
                &variant.solidifying(self.choices, has_contacts),
                &input.soup,
                self.before,
                budget,
            )?;
            Ok((mended, attempt))
        })
    }

    /// True when noise about zero keeps rims apart. Clearing it is then the smaller change: both rims could be closed
    /// instead, which would leave two bodies with nothing between them.
    fn starts_with_clearing(&self) -> Result<bool, Stopped> {
        let (draft, _) = Draft::from_soup(&self.input.soup);
        repair::noise::parts_rims(&draft, self.budget)
    }

    /// The plan to try after `variant`, if one can make a difference. `first_clears`: what the first plan did about noise.
    fn next(
        &self,
        variant: Variant,
        first_clears: bool,
        last: &Attempt,
        fails_in_f32: bool,
    ) -> Result<Option<Variant>, Stopped> {
        if let Some(rings) = variant.removes_crossing {
            let may_help = rings < RINGS_MAX && last.count("triangles_removed") > 0;
            return Ok(may_help.then_some(Variant { removes_crossing: Some(rings + 1), ..variant }));
        }
        if last.count("opposite_pairs_cancelled") > 0 {
            return Ok(Some(Variant { opposite: OppositePairs::KeepFirst, ..variant }));
        }
        let first = Variant { opposite: self.choices.opposite, ..variant };
        if fails_in_f32 && self.choices.rounds && !variant.rounds && !self.input.soup.is_f32_exact {
            return Ok(Some(Variant { rounds: true, ..first }));
        }
        let is_second_try = variant.clears_noise != first_clears;
        if !is_second_try && repair::noise::has_noise(&self.input.soup.positions) {
            return Ok(Some(Variant { clears_noise: !first_clears, rounds: self.needs_f32(), ..first }));
        }
        let first = Variant { clears_noise: first_clears, ..first };
        if !variant.thickens && variant.contact.is_none() && self.reads_as_sheets()? {
            return Ok(Some(Variant { thickens: true, ..first }));
        }
        let first = Variant { thickens: false, ..first };
        // Bodies that lie on each other would be parted by a gap that nobody wants.
        let only_touches = self.before.is_some_and(|before| before.properties.is_embedded == Some(true));
        if only_touches && variant.contact.is_none() && last.count("vertices_copied") > 0 {
            return Ok(Some(Variant { contact: Some(self.options.contact), ..first }));
        }
        if variant.contact == Some(Contact::Join) {
            return Ok(Some(Variant { contact: Some(Contact::Open), ..first }));
        }
        Ok(self.may_cross_locally().then_some(Variant { removes_crossing: Some(0), ..first }))
    }

    /// Whether the open parts are mostly sheets that may become walls. A surface with few boundary edges for its triangles
    /// is none: a square of them has three for the root of their number.
    pub(super) fn reads_as_sheets(&self) -> Result<bool, Stopped> {
        let counts = self.before.map(|analysis| analysis.counts).unwrap_or_default();
        let [rim, triangles] = [counts.boundary_edges, counts.triangles].map(|count| count as f64);
        let may_be = rim > 0.0 && rim >= triangles.sqrt() && self.choices.walls == Walls::ForSheets;
        if !may_be || self.options.wrap.open_shells == OpenShells::Close {
            return Ok(false);
        }
        let (draft, _) = Draft::from_soup(&self.input.soup);
        self.budget.stage(Stage::Measure, || rebuild::is_mostly_sheets(&draft, self.options, self.budget))
    }

    /// True unless it is known that no triangles meet others, or that a large share of them does.
    fn may_cross_locally(&self) -> bool {
        if !self.choices.removes_crossing {
            return false;
        }
        let most = self.input.soup.triangles.len() as u64 / 20;
        self.input.examination.contacts.as_ref().is_none_or(|contacts| (1..=most).contains(&contacts.count))
    }

    /// The rebuilt surface as the answer, or why there is none.
    fn rebuilt(&self, report: Report) -> Result<Answer, Failure> {
        match self.rebuild() {
            Ok(rebuilt) => {
                Ok(rebuilt.returned(self.input, report.made_by(rebuilding(self.choices)), self.budget)?)
            }
            Err(NotRebuilt::Failed(failure)) => Err(failure),
            Err(NotRebuilt::Refused { refusal, actions }) => {
                Ok(Report { actions, ..report }.refused(refusal))
            }
        }
    }

    fn rebuild(&self) -> Result<Rebuilt, NotRebuilt> {
        rebuild::rebuild(self.input, self.encoding, self.options, self.choices, self.before, self.budget)
    }

    /// True when the encoding holds no more than float32, so that every plan has to round.
    fn needs_f32(&self) -> bool {
        self.encoding == Encoding::StlBinary && !self.input.soup.is_f32_exact
    }
}

pub(super) fn write(
    draft: &Draft,
    input: &Input,
    encoding: Encoding,
    depth: Depth,
    budget: &Budget,
) -> Result<Candidate, NoCandidate> {
    Candidate::write(draft.to_soup(&input.soup), encoding, depth, budget)
}

/// The result that is not certified, on request.
fn partial(
    input: &Input,
    encoding: Encoding,
    report: Report,
    mended: Attempt,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let report = Report { actions: mended.actions, ..report }.made_by(mended.steps);
    match write(&mended.draft, input, encoding, Depth::Count { samples: input.samples }, budget) {
        Ok(candidate) => {
            Ok(candidate.returned(input, &mended.draft.triangle_origin, report, Outcome::Partial, budget)?)
        }
        Err(NoCandidate::Refused(refusal)) => Ok(report.refused(refusal)),
        Err(NoCandidate::Failed(failure)) => Err(failure),
    }
}
