//! What a run may cost, known before it starts: units of work in proportion to the bytes of the file.
//!
//! The parts of a run get shares of what is left (`Budget::within_part`), so that one which would take it all ends with less
//! instead: the next plan, a coarser lattice, a surface with more triangles, a distance enclosed more widely. Where nothing
//! is left the run ends over its bound. `docs/bounds.md` lists what is bounded by what.

use super::{Answer, Effort, Failure, Operation, Options, Refusal, Report};
use crate::budget::{AsStopped, Budget, Stopped};

/// Files of fewer bytes may take as much as one of so many.
const SMALL_BYTES: u64 = 4 << 20;

/// Units of work for a small file that is only looked at. A unit is 10 to 20 ns of a processor of 2020.
const LOOKING: u64 = 500_000_000;

/// Units of work for a small file that is repaired.
const REPAIRING: u64 = 3_000_000_000;

/// So many times as much when the caller asks for the finest lattices.
const HIGH_EFFORT: u64 = 4;

/// Units of work that `operation` may use for a file of so many `bytes`; `None`: no more than the caller says.
pub fn work_units_max(operation: Operation, bytes: usize, options: &Options) -> Option<u64> {
    let of_small = match operation {
        Operation::Analyze | Operation::Plan | Operation::Verify | Operation::Convert => LOOKING,
        Operation::Repair if options.wrap.effort == Effort::High => REPAIRING * HIGH_EFFORT,
        Operation::Repair => REPAIRING,
        Operation::Simplify | Operation::CutStitch | Operation::FillHoles | Operation::Modeller => {
            return None;
        }
    };
    let bytes = (bytes as u64).max(SMALL_BYTES);
    Some((u128::from(of_small) * u128::from(bytes) / u128::from(SMALL_BYTES)).min(u128::from(u64::MAX)) as u64)
}

/// Runs `body` in the work that `operation` may use for a file of so many `bytes`.
pub(super) fn within_bounds(
    operation: Operation,
    bytes: usize,
    options: &Options,
    budget: &Budget,
    body: impl FnOnce() -> Result<Answer, Failure>,
) -> Result<Answer, Failure> {
    match work_units_max(operation, bytes, options) {
        Some(units) => budget.within(units, body)?.ok_or(Failure::OverBudget { units }),
        None => body(),
    }
}

/// The answer of `body`, or a refusal where it needs more work than is left.
pub(super) fn or_refused(
    report: Report,
    budget: &Budget,
    body: impl FnOnce(Report) -> Result<Answer, Failure>,
) -> Result<Answer, Failure> {
    let (before, kept) = (budget.work_used(), report.clone());
    // All but the last unit, so that it is this share which ends.
    let left = budget.work_left().saturating_sub(1);
    let refused = || kept.refused(Refusal::OverBudget { units: before + left });
    Ok(budget.within(left, || body(report))?.unwrap_or_else(refused))
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

    #[test]
    fn what_takes_more_ends_over_budget_and_a_callers_limit_as_the_callers() {
        let end = |budget: &Budget| {
            let body = || Err(budget.spend(LOOKING + 1).unwrap_err().into());
            within_bounds(Operation::Verify, 100, &Options::default(), budget, body).unwrap_err()
        };
        assert_eq!(end(&Budget::unlimited()), Failure::OverBudget { units: LOOKING });
        let limited = Budget::new(crate::budget::StopFlag::default(), 7, u64::MAX);
        assert_eq!(end(&limited), Failure::Stopped(Stopped::Work { limit: 7 }));
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
