//! A broken file to a certified one: valid already, or a plan that is replayed, or a climb of the ladder.

use super::fill_holes::ListedLoops;
use super::input::Input;
use super::ladder::{self, Certified, Climb, Climbed};
use super::output::{Candidate, NoCandidate};
use super::plan::Attempt;
use super::remedies::PlanMismatch;
use super::repair_choices::Choices;
use super::step::Step;
use super::{
    Answer, Failure, Operation, Options, Outcome, Refusal, Report, Require, bounds, looks, simplify,
};
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::formats::Encoding;
use crate::repair::Draft;
use crate::repair::nest::NestingPolicy;

/// Repairs `input`. A valid one comes back as it is, or converted.
pub(super) fn repair(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let mut report = input.planned(Operation::Repair, budget)?;
    let loops = ListedLoops::take(&mut report, input.samples);
    let plan = options.plan.as_ref();
    if plan.and_then(|plan| plan.input_sha256).is_some_and(|asked| asked != input.facts.sha256) {
        return Err(PlanMismatch::OtherFile.into());
    }
    let choices = Choices::of(options, &input.soup, report.before.as_ref())?;
    if let Some(steps) = plan.and_then(|plan| plan.steps.as_deref()) {
        return bounds::or_refused(report, budget, |report| {
            replay(input, steps, &loops, options, report, budget)
        });
    }
    bounds::or_refused(report, budget, |report| planned(input, &choices, &loops, options, report, budget))
}

/// Repairs `input` by what may lead to a solid.
fn planned(
    input: &Input,
    choices: &Choices,
    loops: &ListedLoops,
    options: &Options,
    report: Report,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let encoding = input.output_encoding(options);
    // Cavities and small parts make no mesh invalid, but the caller may want them filled and removed.
    let is_as_asked = || {
        !choices.removes()
            && !choices.mends_thin_faces()
            && (choices.nesting != NestingPolicy::Fill || !has_cavities(input))
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
            Err(reason) => return Ok(report.refused(reason.refusal()?)),
        }
    }
    let before = report.before.clone();
    let climb = Climb { input, encoding, options, choices, before: before.as_ref(), budget };
    let (end, tried) = ladder::climb(&climb)?;
    let report = Report { tried, ..report };
    match end {
        Climbed::Certified(certified) => finished(*certified, Outcome::Repaired, &climb, loops, report),
        Climbed::Rebuilt(rebuilt) => {
            Ok(rebuilt.returned(input, report.made_by(rebuilding(choices)), budget)?)
        }
        Climbed::Mended(mended) => partial(input, encoding, loops, report, *mended, budget),
        Climbed::Refused { refusal, actions } => Ok(Report { actions, ..report }.refused(refusal)),
    }
}

/// A result of local steps as the answer, with fewer triangles if that is asked, unless it is beyond the caller's limits.
fn finished(
    certified: Certified,
    outcome: Outcome,
    climb: &Climb<'_>,
    loops: &ListedLoops,
    report: Report,
) -> Result<Answer, Failure> {
    let Climb { input, options, budget, .. } = *climb;
    let Certified { attempt, candidate, as_seen: fidelity, .. } = certified;
    let Attempt { mut draft, actions, steps, holes, .. } = attempt;
    if let Some(refusal) = fidelity.breach(&options.limits) {
        return Ok(Report { actions, ..report }.refused(refusal));
    }
    let filling = loops.filling(holes, &draft, budget)?;
    let report =
        Report { actions, losses: Some(fidelity.losses), distance: fidelity.distance, filling, ..report };
    if let Some(fewer) = simplify::of_certified(&draft, input, options, budget)? {
        let report = report.made_by([steps, vec![Step::Simplify]].concat());
        return fewer.returned(input, &draft, report, outcome, options, budget);
    }
    // What is told of the result needs the memory of the mesh that it was written from.
    let origins = std::mem::take(&mut draft.triangle_origin);
    drop(draft);
    Ok(candidate.returned(input, &origins, report.made_by(steps), outcome, budget)?)
}

/// Runs exactly `steps`, as a plan gives them.
fn replay(
    input: &Input,
    steps: &[Step],
    loops: &ListedLoops,
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
    let climb = Climb { input, encoding, options, choices, before: before.as_ref(), budget };
    if steps.contains(&Step::Rebuild) {
        return match climb.rebuild() {
            Ok(rebuilt) => Ok(rebuilt.returned(input, report.made_by(rebuilding(choices)), budget)?),
            Err(reason) => {
                let (refusal, actions) = reason.refusal()?;
                Ok(Report { actions, ..report }.refused(refusal))
            }
        };
    }
    if steps.is_empty() && input.may_come_back_as(encoding) {
        let certificate = &input.examination.certificate;
        if certificate.is_printable() {
            return Ok(input.returned_as_it_is(report.made_by(Vec::new()), Outcome::Identical));
        }
        if options.require.unwrap_or(Require::Printable).is_of_a_solid() {
            return Ok(
                report.refused(Refusal::NotRepairable { witness: certificate.witnesses.first().cloned() })
            );
        }
        return Ok(input.returned_as_it_is(report.made_by(Vec::new()), Outcome::Partial));
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
        Err(reason) => {
            return Ok(Report { actions: attempt.actions, ..report }.refused(reason.refusal()?));
        }
    };
    if !candidate.certificate().is_printable() {
        if options.require.unwrap_or(Require::Printable).is_of_a_solid() {
            let witness = candidate.certificate().witnesses.first().cloned();
            let refusal = Refusal::NotRepairable { witness };
            return Ok(Report { actions: attempt.actions, ..report }.refused(refusal));
        }
        return partial(input, encoding, loops, report, attempt, budget);
    }
    let outcome = match (local.is_empty(), is_simplified) {
        (false, _) => Outcome::Repaired,
        (true, true) => Outcome::Simplified,
        (true, false) => Outcome::Converted,
    };
    finished(Certified::measured(attempt, candidate, &climb)?, outcome, &climb, loops, report)
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

fn write(
    draft: &Draft,
    input: &Input,
    encoding: Encoding,
    depth: Depth,
    budget: &Budget,
) -> Result<Candidate, NoCandidate> {
    Candidate::write(looks::soup_of(draft, &input.soup, budget)?, input, encoding, depth, budget)
}

/// The result that is not certified, on request.
fn partial(
    input: &Input,
    encoding: Encoding,
    loops: &ListedLoops,
    report: Report,
    mended: Attempt,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let filling = loops.filling(mended.holes, &mended.draft, budget)?;
    let report = Report { actions: mended.actions, filling, ..report }.made_by(mended.steps);
    match write(&mended.draft, input, encoding, Depth::Count { samples: input.samples }, budget) {
        Ok(candidate) => {
            Ok(candidate.returned(input, &mended.draft.triangle_origin, report, Outcome::Partial, budget)?)
        }
        Err(reason) => Ok(report.refused(reason.refusal()?)),
    }
}
