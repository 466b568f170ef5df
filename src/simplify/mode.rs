//! The modes, by one name each.

use super::fast::{simplify_fast, simplify_guarded};
use super::options::SimplifyOptions;
use super::result::{Simplified, SimplifyError, SimplifyInput};
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
/// ```
/// use meshmend::budget::Budget;
/// use meshmend::geom::DVec3;
/// use meshmend::simplify::{Mode, SimplifyInput, SimplifyOptions, Target, simplify};
///
/// // A flat square of four by four cells, two triangles each.
/// let place = |x: u32, y: u32| DVec3::new(f64::from(x), f64::from(y), 0.0);
/// let positions: Vec<DVec3> = (0..5).flat_map(|y| (0..5).map(move |x| place(x, y))).collect();
/// let cell = |x: u32, y: u32| {
///     let v = 5 * y + x;
///     [[v, v + 1, v + 6], [v, v + 6, v + 5]]
/// };
/// let triangles: Vec<[u32; 3]> = (0..4).flat_map(|y| (0..4).flat_map(move |x| cell(x, y))).collect();
///
/// let options = SimplifyOptions { targets: vec![Target::Faces(8)], ..SimplifyOptions::default() };
/// let input = SimplifyInput::new(&positions, &triangles);
/// let results = simplify(&input, Mode::Strict, &options, &Budget::unlimited())?;
/// assert!(results[0].triangles.len() <= 8);
/// # Ok::<(), meshmend::simplify::SimplifyError>(())
/// ```
///
/// # Errors
/// When the input is not a manifold, or the budget stops the run.
pub fn simplify(
    input: &SimplifyInput<'_>,
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
