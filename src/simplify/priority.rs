//! Which vertices would go next.

use super::criterion::CollapseCriterion;
use super::options::Placement;
use super::surface::CollapseSurface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// For each vertex of the surface the least cost of the collapses of its edges, as the criterion has it; infinite for a
/// vertex that must stay or has no edge.
pub(super) fn costs_of_vertices<C: CollapseCriterion>(
    surface: &CollapseSurface<C::State>,
    criterion: &C,
    placement: Placement,
    budget: &Budget,
) -> Result<Vec<f64>, Stopped> {
    let mut costs = vec![f64::INFINITY; surface.vertices.len()];
    for (i, h) in surface.table.half_edges().enumerate() {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let Some(rule) = surface.rule(h).filter(|_| surface.table.edge(h) == h) else { continue };
        let cost = criterion.place(surface, h, rule, placement).cost.max(0.0);
        for v in [surface.table.origin(h), surface.table.destination(h)] {
            costs[v as usize] = costs[v as usize].min(cost);
        }
    }
    Ok(costs)
}
