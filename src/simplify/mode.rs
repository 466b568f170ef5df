//! The modes, by one name each.

use super::fast::{simplify_fast, simplify_guarded};
use super::options::SimplifyOptions;
use super::result::{Input, Simplified, SimplifyError};
use super::strict::simplify_strict;
use crate::budget::Budget;

/// Which guarantees, and what speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Always the cheapest collapse of all that are possible.
    Strict,
    /// Cheap collapses first, in many independent parts of the mesh at a time: several times as fast as strict.
    Fast,
    /// As fast, with checks that surfaces neither meet nor pass through each other: valid in, valid out. Takes four to five times as long.
    Guarded,
}

/// Simplifies `input` in this mode; one result for each target, from one run.
///
/// # Errors
/// When the input is not a manifold, or the budget stops the run.
pub fn simplify(
    input: &Input<'_>,
    mode: Mode,
    options: &SimplifyOptions<'_>,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    match mode {
        Mode::Strict => simplify_strict(input, options, budget),
        Mode::Fast => simplify_fast(input, options, budget),
        Mode::Guarded => simplify_guarded(input, options, budget),
    }
}
