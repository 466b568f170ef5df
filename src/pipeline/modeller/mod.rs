//! Editing a closed polyhedron by its planes: read, edited, rounded, written and judged.

mod choices;
mod edit;
mod report;
mod written;

pub use choices::{EdgeName, Edit, EditKind, FaceName, ModellerChoices, RangeName};
pub use report::{
    Blocker, BlockerKind, FaceRange, ModelFace, ModellerRefusal, ModellerReport, ModellerStep, NameFault,
    RangeSide,
};

use super::input::Input;
use super::output::{OperationMesh, unchanged};
use super::{Answer, Failure, Operation, Options, Outcome, Refusal, Report};
use crate::budget::{Budget, Stage};
use crate::formats::Format;
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
    let (mut draft, _) = Draft::from_soup(&input.soup);
    // Faces are found on the coordinates of the file: their numbers do not depend on the unit of the result.
    let factor = input.of_file.as_ref().map_or(1.0, |of_file| {
        draft.positions = draft.vertex_origin.iter().map(|&v| of_file.positions[v as usize]).collect();
        of_file.factor
    });
    let _charge = budget.charge(draft.bytes().saturating_mul(BYTES_PER_DRAFT_BYTE))?;
    let (edited, told) = budget.stage(Stage::Repair, || edit(&draft, factor, choices, budget))?;
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
    let writes_polygons = choices.writes_polygons && matches!(encoding.format(), Format::Obj | Format::Off);
    let is_as_it_was = !edited.has_changed && choices.dual.is_none() && !writes_polygons;
    if is_as_it_was && input.may_come_back_as(encoding) {
        let report = Report { modeller: Some(Box::new(told)), ..report };
        return Ok(unchanged(input, options, report, Outcome::Modelled));
    }
    let soup = match written(&edited.imported, choices, &mut told, budget)? {
        Ok(soup) => soup,
        Err(reason) => return refused(report, Some(told), reason),
    };
    report.modeller = Some(Box::new(told));
    let origins = vec![NEW; soup.triangles.len()];
    let made = OperationMesh { soup, origins: &origins, outcome: |_| Outcome::Modelled };
    made.returned(input, options, report, budget)
}
