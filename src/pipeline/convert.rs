//! The same mesh in another format.

use super::input::Input;
use super::output::{OperationMesh, unchanged};
use super::{Answer, Failure, Operation, Options, Outcome};
use crate::budget::Budget;
use crate::repair::Draft;

/// Writes the triangles of `input` in the asked format. Vertices that no triangle uses are left behind.
pub(super) fn convert(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let report = input.report(Operation::Convert, budget)?;
    if input.may_come_back_as(input.output_encoding(options)) {
        return Ok(unchanged(input, options, report, Outcome::Partial));
    }
    let (draft, _) = Draft::from_soup(&input.soup);
    let outcome = |is_printable| if is_printable { Outcome::Converted } else { Outcome::Partial };
    let made = OperationMesh { soup: draft.to_soup(&input.soup), origins: &draft.triangle_origin, outcome };
    made.returned(input, options, report, budget)
}
