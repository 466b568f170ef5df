//! What a run may cost: units of work in proportion to the bytes of the file and its triangles, known once it is read.
//!
//! The parts of a run get shares of what is left (`Budget::within_part`), so that one which would take it all ends with less
//! instead: the next plan, a coarser lattice, a surface with more triangles, a distance enclosed more widely. Where nothing
//! is left the run ends over its bound. `docs/bounds.md` lists what is bounded by what.

use super::{Answer, Effort, Failure, Operation, Options, Refusal, Report, WorkBound};
use crate::budget::{AsStopped, Budget, Stopped};

/// Files of fewer bytes may take as much as one of so many.
const SMALL_BYTES: u64 = 4 << 20;

/// Units of work for a small file that is only looked at. A unit is 10 to 20 ns of a processor of 2020.
const LOOKING: u64 = 500_000_000;

/// Units of work for a small file that is repaired.
const REPAIRING: u64 = 3_000_000_000;

/// So many times as much when the caller asks for the finest lattices.
const HIGH_EFFORT: u64 = 4;

/// Bytes for which each triangle counts at least: packed files, and files that place a mesh often, have fewer.
const BYTES_OF_TRIANGLE: u64 = 5;

/// Units of work that `operation` may use for files of so many `bytes` in all, where none of them has more than a triangle in 5
/// bytes; `None`: no more than the caller says.
pub fn work_units_max(operation: Operation, bytes: usize, options: &Options) -> Option<u64> {
    let of_small = match operation.facts().work {
        WorkBound::Looking => LOOKING,
        WorkBound::Repairing if options.wrap.effort == Effort::High => REPAIRING * HIGH_EFFORT,
        WorkBound::Repairing => REPAIRING,
        WorkBound::Unbounded => return None,
    };
    let bytes = (bytes as u64).max(SMALL_BYTES);
    Some((u128::from(of_small) * u128::from(bytes) / u128::from(SMALL_BYTES)).min(u128::from(u64::MAX)) as u64)
}

/// The bound of a run, from its start.
pub(super) struct Bound<'b> {
    operation: Operation,
    /// Of all its files.
    bytes: usize,
    options: &'b Options,
    budget: &'b Budget,
    /// Units that were used before.
    start: u64,
}

impl<'b> Bound<'b> {
    pub(super) fn of(operation: Operation, bytes: usize, options: &'b Options, budget: &'b Budget) -> Self {
        Self { operation, bytes, options, budget, start: budget.work_used() }
    }

    /// Runs `body`, which reads: in what the bytes alone allow.
    pub(super) fn reading<T>(&self, body: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
        self.within(self.bytes, body).map(|(read, _)| read)
    }

    /// Runs `body`, which has so many triangles before it: in what the bytes and they allow, less what reading took.
    pub(super) fn running(
        &self,
        triangles: u64,
        body: impl FnOnce() -> Result<Answer, Failure>,
    ) -> Result<Answer, Failure> {
        let bytes_for_them =
            usize::try_from(triangles.saturating_mul(BYTES_OF_TRIANGLE)).unwrap_or(usize::MAX);
        let (mut answer, units) = self.within(self.bytes.max(bytes_for_them), body)?;
        let Report { refusal, parts, .. } = &mut answer.report;
        // The parts of a run know what they used, not what the run may use.
        for refusal in parts.iter_mut().map(|part| &mut part.report.refusal).chain([refusal]).flatten() {
            if let Refusal::OverBudget { units: told } = refusal {
                *told = units.unwrap_or(*told);
            }
        }
        Ok(answer)
    }

    /// The result, and the bound.
    fn within<T>(
        &self,
        bytes: usize,
        body: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<(T, Option<u64>), Failure> {
        let Some(units) = work_units_max(self.operation, bytes, self.options) else {
            return Ok((body()?, None));
        };
        let left = (self.start.saturating_add(units)).saturating_sub(self.budget.work_used());
        let result = self.budget.within(left, body)?;
        Ok((result.ok_or(Failure::OverBudget { units })?, Some(units)))
    }
}

/// The answer of `body`, or a refusal where it needs more work than is left.
pub(super) fn or_refused(
    report: Report,
    budget: &Budget,
    body: impl FnOnce(Report) -> Result<Answer, Failure>,
) -> Result<Answer, Failure> {
    let kept = report.clone();
    // All but the last unit, so that it is this share which ends.
    let left = budget.work_left().saturating_sub(1);
    let answer = budget.within(left, || body(report))?;
    Ok(answer.unwrap_or_else(|| kept.refused(Refusal::OverBudget { units: budget.work_used() })))
}

/// The answer with the picture that `draw` gives, if it is asked for. Beside a result, one that takes more work than half of what
/// is left is left out, and a remark says so.
pub(super) fn with_picture(
    operation: Operation,
    mut answer: Answer,
    budget: &Budget,
    draw: impl FnOnce(&Answer) -> Result<Option<Vec<u8>>, Failure>,
) -> Result<Answer, Failure> {
    let drawn = match operation {
        Operation::Render => Some(draw(&answer)?),
        _ => budget.within_part(2, || draw(&answer))?,
    };
    match drawn {
        Some(picture) => answer.picture = picture,
        None => answer.report.remarks.push(no_picture(&"it takes more work than a file of its size may")),
    }
    Ok(answer)
}

/// The remark that a picture was left out.
pub(super) fn no_picture(why: &dyn std::fmt::Display) -> String {
    format!("There is no picture of the file: {why}.")
}

impl AsStopped for Failure {
    fn as_stopped(&self) -> Option<Stopped> {
        match self {
            Self::Stopped(stopped) => Some(*stopped),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verifying(budget: &Budget) -> Result<Answer, Failure> {
        let options = Options::default();
        let bound = Bound::of(Operation::Verify, 100, &options, budget);
        bound.reading(|| Ok(budget.spend(LOOKING / 2)?))?;
        bound.running(12, || Err(budget.spend(LOOKING / 2 + 1).unwrap_err().into()))
    }

    #[test]
    fn what_takes_more_ends_over_budget_and_a_callers_limit_as_the_callers() {
        let end = |budget: &Budget| verifying(budget).unwrap_err();
        assert_eq!(end(&Budget::unlimited()), Failure::OverBudget { units: LOOKING });
        let limited = Budget::new(crate::budget::StopFlag::default(), 7, u64::MAX);
        assert_eq!(end(&limited), Failure::Stopped(Stopped::Work { limit: 7 }));
    }

    #[test]
    fn triangles_count_where_the_bytes_are_few_for_them() {
        let (options, budget) = (Options::default(), Budget::unlimited());
        let bound = Bound::of(Operation::Verify, 100, &options, &budget);
        let end = |triangles, units: u64| {
            let body = || {
                Err(budget
                    .spend(units)
                    .err()
                    .map_or(Failure::NoSuchHole { number: 0, holes: 0 }, Failure::from))
            };
            bound.running(triangles, body).unwrap_err()
        };
        let triangles = 2 * SMALL_BYTES;
        assert_eq!(end(triangles, LOOKING + 1), Failure::NoSuchHole { number: 0, holes: 0 });
        let share = 2 * BYTES_OF_TRIANGLE;
        assert_eq!(end(triangles, (share - 1) * LOOKING), Failure::OverBudget { units: share * LOOKING });
    }

    #[test]
    fn a_file_may_take_work_in_proportion_to_its_bytes_from_four_megabytes_on() {
        let of = |bytes| work_units_max(Operation::Verify, bytes, &Options::default()).unwrap();
        assert_eq!((of(0), of(1 << 20), of(4 << 20)), (LOOKING, LOOKING, LOOKING));
        assert_eq!((of(8 << 20), of(40 << 20)), (2 * LOOKING, 10 * LOOKING));
        assert!(of(usize::MAX) > of(1 << 40));
        assert!(work_units_max(Operation::Repair, 0, &Options::default()).unwrap() > LOOKING);
        assert_eq!(work_units_max(Operation::Simplify, 0, &Options::default()), None);
    }
}
