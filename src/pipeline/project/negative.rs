//! Negative parts of a project, which are taken away from the solid that its parts became.

use super::merge;
use crate::budget::{Budget, Stage};
use crate::formats::threemf::{NegativeParts, read_negative_parts};
use crate::formats::{self, Encoding};
use crate::pipeline::bounds::Bound;
use crate::pipeline::faithful::demand_faithful;
use crate::pipeline::{
    Answer, Failure, Operation, Options, Outcome, Output, Refusal, Report, Require, SetOperation,
    SimplifyChoices, SolidParts, boolean, run_on_file,
};

/// The name under which one mesh leaves them out.
const NEGATIVE_PARTS: &str = "negative_parts";

/// The answer of a repair that made one solid of the parts of the 3MF `bytes`, without what its negative parts take away. Where they
/// cannot be taken away it stays as it is, and a remark says why.
///
/// # Errors
/// When the budget stops the run.
pub(in crate::pipeline) fn without_negative_parts(
    mut answer: Answer,
    bytes: &[u8],
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let why = match take_away(&answer, bytes, options, bound, budget) {
        Ok(None) => return Ok(answer),
        Ok(Some(cut)) => {
            let encoding = cut.answer.output.as_ref().map_or(Encoding::ThreeMf, |output| output.encoding);
            let remarks = merge::left_out(&super::read(bytes, options, budget)?, encoding);
            let answer = cut.after(answer, remarks);
            let must_be_faithful = options.require == Some(Require::Faithful);
            return Ok(if must_be_faithful { demand_faithful(answer) } else { answer });
        }
        Err(NotCut::Because(why)) => why.to_owned(),
        Err(NotCut::Failed(failure @ Failure::Stopped(_))) => return Err(failure),
        Err(NotCut::Failed(failure)) => failure.to_string(),
    };
    answer.report.remarks.push(format!("What is negative is not taken away: {why}."));
    Ok(answer)
}

/// Why negative parts stay out of the solid without being taken away.
enum NotCut {
    Because(&'static str),
    Failed(Failure),
}

const OVER_BUDGET: NotCut = NotCut::Because("that takes more work than a file of this size may take");

impl<E: Into<Failure>> From<E> for NotCut {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// The solid without the negative parts.
struct NegativeCut {
    answer: Answer,
    /// What was done with the negative parts before.
    negative: Report,
}

impl NegativeCut {
    /// The account of the repair that gave `before`, and of this.
    fn after(self, before: Answer, remarks: Vec<String>) -> Answer {
        let Self { answer, negative } = self;
        let of_both = [&before.report, &negative];
        let (fidelity, outcome) = (merge::fidelity(&of_both), merge::outcome(&of_both, Operation::Repair));
        let mut first = Report { fidelity, outcome, ..before.report };
        first.actions.extend(negative.actions);
        for action in &mut first.actions {
            action.changes.retain(|&(name, _)| name != NEGATIVE_PARTS);
        }
        first.actions.retain(|action| action.step != "left_out" || !action.changes.is_empty());
        let remarks = remarks.into_iter().chain(answer.report.remarks.iter().cloned()).collect();
        let filling = first.filling.take();
        let second = Report {
            operation: Operation::Repair,
            outcome: Some(Outcome::Repaired),
            further_inputs: Vec::new(),
            ..answer.report
        };
        let report = Report { remarks, filling, ..merge::in_turn(first, second, true) };
        let output = answer.output.map(|output| Output { origins: Vec::new(), ..output });
        Answer { report, output, ..answer }
    }
}

/// `None`: the file has no negative parts, or there is no solid.
fn take_away(
    answer: &Answer,
    bytes: &[u8],
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Option<NegativeCut>, NotCut> {
    let Some(output) = answer.output.as_ref().filter(|_| answer.report.refusal.is_none()) else {
        return Ok(None);
    };
    let read = || Ok(read_negative_parts(bytes, &options.read, budget)?);
    let Some(negative) = bound.reading(|| budget.stage(Stage::Read, read))? else { return Ok(None) };
    if !answer.levels.is_empty() {
        return Err(NotCut::Because("a simplification has several results"));
    }
    if negative.reach_other_items {
        return Err(NotCut::Because(
            "a negative part reaches an item of the build that it does not belong to",
        ));
    }
    let encoding = output.encoding;
    let result_units = answer.report.input.result_units;
    // What both files have to be: of one format, in one unit, without further choices.
    let plain = Options {
        format: None,
        read: super::unlimited(),
        output_format: Some(encoding.format()),
        output_units: Some(result_units),
        parts: SolidParts::Together,
        plan: None,
        policy: None,
        simplify: SimplifyChoices::default(),
        picture: None,
        ..options.clone()
    };
    let (negative, report) = mended(&negative, &plain, bound, budget)?;
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
    let answer = boolean::boolean(&both, &choices, bound, budget)?;
    match answer.report.refusal {
        Some(Refusal::OverBudget { .. }) => Err(OVER_BUDGET),
        Some(_) => Err(NotCut::Because("the solid without it cannot be made")),
        None => Ok(Some(NegativeCut { answer, negative: report })),
    }
}

/// The negative parts as a file of one valid solid, and what was done for that.
fn mended(
    negative: &NegativeParts,
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<(Vec<u8>, Report), NotCut> {
    const NONE: NotCut = NotCut::Because("it is no valid solid and cannot be repaired");
    let write = || formats::write(&negative.soup, Encoding::ThreeMf, budget);
    let bytes = match budget.stage(Stage::Write, write) {
        Ok(bytes) => bytes,
        Err(formats::WriteError::Stopped(stopped)) => return Err(stopped.into()),
        Err(_) => return Err(NONE),
    };
    let options = Options { units: None, require: Some(Require::Printable), ..options.clone() };
    let answer = run_on_file(Operation::Repair, bytes.as_slice().into(), &options, bound, budget)?;
    match answer.report.refusal {
        Some(Refusal::OverBudget { .. }) => return Err(OVER_BUDGET),
        Some(_) => return Err(NONE),
        None => {}
    }
    let Some(output) = answer.output else { return Err(NONE) };
    Ok((output.bytes.unwrap_or(bytes), answer.report))
}
