//! Negative parts of a project, which are taken away from the solid that its parts became.

use super::merge;
use crate::budget::{Budget, Stage};
use crate::formats::threemf::{NegativeParts, read_negative_parts};
use crate::formats::{self, Encoding};
use crate::pipeline::bounds::Bound;
use crate::pipeline::{
    Answer, Failure, Operation, Options, Outcome, Parts, Report, SetOperation, SimplifyChoices, boolean,
    run_on_file,
};

/// The name under which one mesh leaves them out.
const NEGATIVE_PARTS: &str = "negative_parts";

/// The answer of a repair that made one solid of the parts of the 3MF `bytes`, without what its negative parts take away. Where they
/// cannot be taken away it stays, and a remark says why.
///
/// # Errors
/// When the budget stops the run.
pub(in crate::pipeline) fn without_negative_parts(
    answer: Answer,
    bytes: &[u8],
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let Some(output) = answer.output.as_ref().filter(|_| answer.report.refusal.is_none()) else {
        return Ok(answer);
    };
    let read = || read_negative_parts(bytes, &options.read, budget);
    let Some(negative) = budget.stage(Stage::Read, read)? else { return Ok(answer) };
    let stays = |mut answer: Answer, why: &str| {
        answer.report.remarks.push(format!("What is negative is not taken away: {why}."));
        Ok(answer)
    };
    if !answer.levels.is_empty() {
        return stays(answer, "a simplification has several results");
    }
    if negative.reach_other_items {
        return stays(answer, "a negative part reaches an item of the build that it does not belong to");
    }
    let encoding = output.encoding;
    let result_units = answer.report.input.result_units;
    // What both files have to be: of one format, in one unit, without further choices.
    let plain = Options {
        format: None,
        output_format: Some(encoding.format()),
        output_units: Some(result_units),
        parts: Parts::Together,
        plan: None,
        policy: None,
        simplify: SimplifyChoices::default(),
        picture: None,
        ..options.clone()
    };
    let Some(negative) = mended(&negative, &plain, bound, budget)? else {
        return stays(answer, "no valid solid could be made of it");
    };
    let solid = output.bytes.as_deref().unwrap_or(bytes);
    let both = [solid, &negative].concat();
    let states_units = matches!(encoding, Encoding::ThreeMf | Encoding::Glb | Encoding::Gltf);
    let choices = Options {
        units: (!states_units).then_some(result_units),
        file_sizes: vec![solid.len() as u64, negative.len() as u64],
        set_operation: SetOperation::Difference,
        policy: options.policy,
        picture: options.picture.clone(),
        ..plain
    };
    let cut = boolean::boolean(&both, &choices, bound, budget)?;
    if cut.report.refusal.is_some() {
        return stays(answer, "the solid without it cannot be made");
    }
    let mut first = answer.report;
    for action in &mut first.actions {
        action.changes.retain(|&(name, _)| name != NEGATIVE_PARTS);
    }
    first.actions.retain(|action| action.step != "left_out" || !action.changes.is_empty());
    let second = Report {
        operation: Operation::Repair,
        outcome: Some(Outcome::Repaired),
        further_inputs: Vec::new(),
        ..cut.report
    };
    let remarks = merge::left_out(&super::read(bytes, options, budget)?, encoding);
    Ok(Answer { report: Report { remarks, ..merge::in_turn(first, second, true) }, ..cut })
}

/// The negative parts as a file of one valid solid; `None`: they are none.
fn mended(
    negative: &NegativeParts,
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Option<Vec<u8>>, Failure> {
    let bytes = match budget.stage(Stage::Write, || formats::write(&negative.soup, Encoding::ThreeMf, budget))
    {
        Ok(bytes) => bytes,
        Err(formats::WriteError::Stopped(stopped)) => return Err(stopped.into()),
        Err(_) => return Ok(None),
    };
    let options = Options { units: None, ..options.clone() };
    let answer = run_on_file(Operation::Repair, &bytes, &options, bound, budget)?;
    let made = answer.output.filter(|_| answer.report.refusal.is_none());
    Ok(made.map(|output| output.bytes.unwrap_or(bytes)))
}
