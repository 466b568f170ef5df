//! The same mesh in another format.

use super::input::Input;
use super::output::{Candidate, NoCandidate};
use super::{Answer, Failure, Operation, Options, Outcome, Refusal};
use crate::budget::Budget;
use crate::certificate::{Certificate, Depth};
use crate::repair::Draft;

/// Writes the triangles of `input` in the asked format. Vertices that no triangle uses are left behind.
pub(super) fn convert(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let report = input.report(Operation::Convert, budget)?;
    let refusal = |certificate: &Certificate| match options.require {
        Some(require) if require.is_of_a_solid() && !certificate.is_printable() => {
            Some(Refusal::NotRepairable { witness: certificate.witnesses.first().cloned() })
        }
        _ => None,
    };
    let encoding = input.output_encoding(options);
    if input.may_come_back_as(encoding) {
        let certificate = &input.examination.certificate;
        let outcome = if certificate.is_printable() { Outcome::Identical } else { Outcome::Partial };
        return Ok(match refusal(certificate) {
            Some(refusal) => report.refused(refusal),
            None => input.returned_as_it_is(report, outcome),
        });
    }
    let (draft, _) = Draft::from_soup(&input.soup);
    if draft.triangles.is_empty() {
        return Ok(report.refused(Refusal::NothingToRepair));
    }
    let depth = Depth::Count { samples: input.samples };
    let candidate = match Candidate::write(draft.to_soup(&input.soup), encoding, depth, budget) {
        Ok(candidate) => candidate,
        Err(NoCandidate::Refused(refusal)) => return Ok(report.refused(refusal)),
        Err(NoCandidate::Failed(failure)) => return Err(failure),
    };
    if let Some(refusal) = refusal(candidate.certificate()) {
        return Ok(report.refused(refusal));
    }
    let outcome = if candidate.certificate().is_printable() { Outcome::Converted } else { Outcome::Partial };
    Ok(candidate.returned(input, &draft.triangle_origin, report, outcome, budget)?)
}
