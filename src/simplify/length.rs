//! The criterion of edge length: the shortest edge first.

use super::criterion::{CollapseCriterion, CostReach, PlacedVertex};
use super::options::Placement;
use super::surface::{CollapseSurface, MergeRule, Vertex};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Costs by squared length; the merged vertex is the middle of the edge, or its destination.
#[derive(Debug, Clone, Copy)]
pub(super) struct SquaredLength;

impl CollapseCriterion for SquaredLength {
    type State = ();

    const REACH: CostReach = CostReach::Star;

    fn prepare(&self, _: &mut CollapseSurface<()>, _: &Budget) -> Result<(), Stopped> {
        Ok(())
    }

    #[inline]
    fn place(
        &self,
        surface: &CollapseSurface<()>,
        h: u32,
        rule: MergeRule,
        placement: Placement,
    ) -> PlacedVertex {
        let [a, b] = surface.ends(h).map(|end| end.position);
        let position = match (rule, placement) {
            (MergeRule::OntoOrigin, _) => a,
            (MergeRule::OntoDestination, _) | (MergeRule::Anywhere, Placement::OntoEnd) => b,
            (MergeRule::Anywhere, Placement::Optimal) => a + 0.5 * (b - a),
        };
        let cost = a.distance_squared(b);
        PlacedVertex { position, cost, error_squared: cost }
    }

    #[inline]
    fn merged(&self, _: [&Vertex<()>; 2], _: DVec3) {}
}
