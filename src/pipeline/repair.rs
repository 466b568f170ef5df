//! A broken file to a certified one: plans in order, the first whose bytes are certified wins.

use super::fidelity::Original;
use super::input::Input;
use super::output::{Candidate, NoCandidate};
use super::plan::{Attempt, Variant};
use super::rebuild::NotRebuilt;
use super::{Answer, Failure, Operation, Options, Outcome, Refusal, Report, Require, rebuild, simplify};
use crate::analysis::Analysis;
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::formats::Encoding;
use crate::repair::duplicates::OppositePairs;
use crate::repair::{self, Draft};
use crate::winding::Solid;

/// Repairs `input`. A valid one comes back as it is, or converted.
pub(super) fn repair(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let report = input.report(Operation::Repair, budget)?;
    let encoding = input.output_encoding(options);
    if input.examination.certificate.is_printable() {
        let (draft, _) = Draft::from_soup(&input.soup);
        if let Some(fewer) = simplify::of_certified(&draft, input, options, budget)? {
            return fewer.returned(input, &draft, report, Outcome::Simplified, options, budget);
        }
        if encoding == input.facts.encoding {
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
    let search = Search { input, encoding, options, before: report.before.as_ref(), budget };
    match search.run()? {
        Found::Certified(found) => certified(*found, input, encoding, options, report, budget),
        Found::Nothing { refusal: Refusal::NotRepairable { .. }, mended: Some(mended), .. }
            if options.require == Some(Require::None) =>
        {
            partial(input, encoding, report, *mended, budget)
        }
        Found::Nothing {
            refusal: Refusal::NotRepairable { .. } | Refusal::NothingToRepair, mended, ..
        } => match (rebuild::rebuild(input, encoding, options, report.before.as_ref(), budget), mended) {
            (Ok(rebuilt), _) => Ok(rebuilt.returned(input, report, budget)?),
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
        Found::Nothing { refusal, last, .. } => {
            Ok(Report { actions: last.actions, ..report }.refused(refusal))
        }
    }
}

/// A result of local steps, unless it lost too much and one that is rebuilt is closer.
fn certified(
    (attempt, candidate): (Attempt, Candidate),
    input: &Input,
    encoding: Encoding,
    options: &Options,
    report: Report,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let before = report.before.as_ref();
    let volume = before.and_then(|analysis| analysis.measures.volume);
    let Attempt { draft, actions } = attempt;
    let origins = &draft.triangle_origin;
    // Mostly nothing is gone, and what is hidden does not matter.
    let all = Original::new(&input.soup, volume, None);
    let mut fidelity = all.measure(candidate.soup(), origins, budget)?;
    if !fidelity.passes(&options.limits) {
        let read = || Solid::of(&draft.positions, &draft.triangles, options.wrap.open_shells, budget);
        let solid = budget.stage(Stage::Measure, read)?;
        let visible = Original::new(&input.soup, volume, Some(solid));
        fidelity = visible.measure(candidate.soup(), origins, budget)?;
    }
    if !fidelity.passes(&options.limits) {
        let rebuilt = match rebuild::rebuild(input, encoding, options, before, budget) {
            Ok(rebuilt) => Some(rebuilt),
            Err(NotRebuilt::Refused { .. }) => None,
            Err(NotRebuilt::Failed(failure)) => return Err(failure),
        };
        let closer = rebuilt.filter(|rebuilt| !fidelity.is_no_worse(&rebuilt.fidelity, &options.limits));
        if let Some(rebuilt) = closer {
            return Ok(rebuilt.returned(input, report, budget)?);
        }
        if let Some(refusal) = fidelity.breach(&options.limits) {
            return Ok(Report { actions, ..report }.refused(refusal));
        }
    }
    let report = Report { actions, losses: Some(fidelity.losses), distance: fidelity.distance, ..report };
    if let Some(fewer) = simplify::of_certified(&draft, input, options, budget)? {
        return fewer.returned(input, &draft, report, Outcome::Repaired, options, budget);
    }
    Ok(candidate.returned(input, origins, report, Outcome::Repaired, budget)?)
}

/// The search for a plan that leads to certified bytes.
struct Search<'a> {
    input: &'a Input,
    encoding: Encoding,
    options: &'a Options,
    before: Option<&'a Analysis>,
    budget: &'a Budget,
}

/// Rings that are removed around triangles that meet others, at most.
const RINGS_MAX: u32 = 2;

enum Found {
    Certified(Box<(Attempt, Candidate)>),
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
        let mut variant = Variant { clears_noise, rounds: self.needs_f32(), ..Variant::default() };
        let mut fails_in_f32 = false;
        loop {
            let (mended, last) = self.attempt(variant)?;
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
            let Some(next) = self.next(variant, clears_noise, &last, fails_in_f32) else {
                return Ok(Found::nothing(Refusal::NotRepairable { witness }, last, mended));
            };
            variant = next;
        }
    }

    /// Runs a plan: the mended mesh if the best effort may be asked for it, and the one that may be a solid.
    fn attempt(&self, variant: Variant) -> Result<(Option<Attempt>, Attempt), Stopped> {
        let (input, budget) = (self.input, self.budget);
        let has_contacts = input.examination.contacts.as_ref().is_none_or(|contacts| contacts.count > 0);
        let is_best_effort = matches!(self.options.require, Some(Require::BestEffort | Require::None));
        budget.stage(Stage::Repair, || {
            let mut attempt = Attempt::start(&input.soup, self.before);
            let _charge = budget.charge(attempt.draft.bytes() * if is_best_effort { 2 } else { 1 })?;
            attempt.run(&variant.mending(self.options.fill_holes), &input.soup, self.before, budget)?;
            let mended = is_best_effort.then(|| attempt.clone());
            attempt.run(&variant.solidifying(has_contacts), &input.soup, self.before, budget)?;
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
    ) -> Option<Variant> {
        if let Some(rings) = variant.removes_crossing {
            let may_help = rings < RINGS_MAX && last.count("triangles_removed") > 0;
            return may_help.then_some(Variant { removes_crossing: Some(rings + 1), ..variant });
        }
        if last.count("opposite_pairs_cancelled") > 0 {
            return Some(Variant { opposite: OppositePairs::KeepFirst, ..variant });
        }
        let first = Variant { opposite: OppositePairs::Cancel, ..variant };
        if fails_in_f32 && !variant.rounds && !self.input.soup.is_f32_exact {
            return Some(Variant { rounds: true, ..first });
        }
        let is_second_try = variant.clears_noise != first_clears;
        if !is_second_try && repair::noise::has_noise(&self.input.soup.positions) {
            return Some(Variant { clears_noise: !first_clears, rounds: self.needs_f32(), ..first });
        }
        let first = Variant { clears_noise: first_clears, ..first };
        // Bodies that lie on each other would be parted by a gap that nobody wants.
        let only_touches = self.before.is_some_and(|before| before.properties.is_embedded == Some(true));
        if only_touches && !variant.opens_contacts && last.count("vertices_copied") > 0 {
            return Some(Variant { opens_contacts: true, ..first });
        }
        self.may_cross_locally().then_some(Variant { removes_crossing: Some(0), ..first })
    }

    /// True unless it is known that no triangles meet others, or that a large share of them does.
    fn may_cross_locally(&self) -> bool {
        let most = self.input.soup.triangles.len() as u64 / 20;
        self.input.examination.contacts.as_ref().is_none_or(|contacts| (1..=most).contains(&contacts.count))
    }

    /// True when the encoding holds no more than float32, so that every plan has to round.
    fn needs_f32(&self) -> bool {
        self.encoding == Encoding::StlBinary && !self.input.soup.is_f32_exact
    }
}

fn write(
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
    let report = Report { actions: mended.actions, ..report };
    match write(&mended.draft, input, encoding, Depth::Count { samples: input.samples }, budget) {
        Ok(candidate) => {
            Ok(candidate.returned(input, &mended.draft.triangle_origin, report, Outcome::Partial, budget)?)
        }
        Err(NoCandidate::Refused(refusal)) => Ok(report.refused(refusal)),
        Err(NoCandidate::Failed(failure)) => Err(failure),
    }
}
