//! Editing a closed polyhedron by its planes: read, edited, rounded, written and judged.

mod choices;
mod edit;
mod report;
mod written;

pub use choices::{EdgeName, Edit, EditKind, FaceName, ModellerChoices, RangeName};
pub use report::{
    Blocker, BlockerKind, FaceRange, ModelFace, ModellerRefusal, ModellerReport, ModellerStep, RangeSide,
};

use super::input::Input;
use super::output::{Candidate, NoCandidate};
use super::{Answer, Failure, Operation, Options, Outcome, Refusal, Report, Require};
use crate::budget::{Budget, Stage};
use crate::certificate::Depth;
use crate::repair::{Draft, NEW};
use edit::edit;
use written::written;

/// What exact planes and points, the boxes around them and copies of the topology take of memory, in times of what the
/// triangles do: measured on parts of 4,500 to 9,000 triangles, 1 to 2 kB for each.
const BYTES_PER_DRAFT_BYTE: u64 = 48;

/// Edits `input`; where no plane and no edge has changed it comes back as it is.
pub(super) fn model(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let mut report = input.report(Operation::Modeller, budget)?;
    let choices = &options.modeller;
    let (draft, _) = Draft::from_soup(&input.soup);
    let _charge = budget.charge(draft.bytes().saturating_mul(BYTES_PER_DRAFT_BYTE))?;
    let (edited, told) = budget.stage(Stage::Repair, || edit(&draft, choices, budget))?;
    let refused = |report: Report, told: Option<ModellerReport>, reason: ModellerRefusal| {
        let report = Report { modeller: told.map(Box::new), ..report };
        let units = report.input.result_units;
        Ok(report.refused(Refusal::Modeller { reason: Box::new(reason), units }))
    };
    let (edited, mut told) = match (edited, told) {
        (Ok(edited), Some(told)) => (edited, told),
        (Err(reason), told) => return refused(report, told, reason),
        (Ok(_), None) => return Ok(report.refused(Refusal::NothingToRepair)),
    };
    let encoding = input.output_encoding(options);
    let is_refused =
        |is_printable: bool| options.require.is_some_and(Require::is_of_a_solid) && !is_printable;
    let is_as_it_was = !edited.has_changed && choices.dual.is_none() && !choices.writes_polygons;
    if is_as_it_was && input.may_come_back_as(encoding) {
        report.modeller = Some(Box::new(told));
        let certificate = &input.examination.certificate;
        if is_refused(certificate.is_printable()) {
            let witness = certificate.witnesses.first().cloned();
            return Ok(report.refused(Refusal::NotRepairable { witness }));
        }
        let outcome = if certificate.is_printable() { Outcome::Identical } else { Outcome::Modelled };
        return Ok(input.returned_as_it_is(report, outcome));
    }
    let soup = match written(&edited.imported, choices, &mut told, budget)? {
        Ok(soup) => soup,
        Err(reason) => return refused(report, Some(told), reason),
    };
    report.modeller = Some(Box::new(told));
    let origins = vec![NEW; soup.triangles.len()];
    let depth = Depth::Count { samples: input.samples };
    let candidate = match Candidate::write(soup, encoding, depth, budget) {
        Ok(candidate) => candidate,
        Err(NoCandidate::Refused(refusal)) => return Ok(report.refused(refusal)),
        Err(NoCandidate::Failed(failure)) => return Err(failure),
    };
    if is_refused(candidate.certificate().is_printable()) {
        let witness = candidate.certificate().witnesses.first().cloned();
        return Ok(report.refused(Refusal::NotRepairable { witness }));
    }
    Ok(candidate.returned(input, &origins, report, Outcome::Modelled, budget)?)
}
