//! How much of the creases of a file a rebuilt surface has.

use crate::budget::{Budget, Stage, Stopped};
use crate::distance::{Surface, creases_recovered};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::pipeline::fidelity::Original;
use crate::winding::LookedFrom;

/// An edge that is no farther from a crease of the input recovers it, in cells. Where the lattice cuts a crease off, what is left is
/// two edges that are farther away.
const REACH: f64 = 0.125;

/// The share of the length of the creases of the input that can be seen which `result` has, too, with cells that are `spacing` wide.
/// `None`: there are none, or to tell takes too much work.
pub(super) fn recovered(
    original: &Original<'_>,
    result: &Soup,
    spacing: f64,
    budget: &Budget,
) -> Result<Option<f64>, Stopped> {
    let mut nearby = LookedFrom::default();
    let mut is_seen = |place: DVec3, triangle: u32| {
        let seen = original.first_visible(&mut std::iter::once(place), triangle, &mut nearby, budget)?;
        Ok(seen.is_some())
    };
    let [from, to] = [original.input, result]
        .map(|mesh| Surface { positions: &mesh.positions, triangles: &mesh.triangles });
    let search = || creases_recovered(from, to, REACH * spacing, &mut is_seen, budget);
    Ok(budget.within_part(4, || budget.stage(Stage::Measure, search))?.flatten())
}
