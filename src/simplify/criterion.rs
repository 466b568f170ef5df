//! What a collapse costs and where the merged vertex goes: the one trait of all criteria.

use super::options::Placement;
use super::surface::{CollapseSurface, MergeRule, Vertex};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// A place for the vertex that an edge becomes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlacedVertex {
    pub position: DVec3,
    /// Decides the order.
    pub cost: f64,
    /// Squared error, in squared working units.
    pub error_squared: f64,
}

/// Which edges cost something else after a collapse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CostReach {
    /// Those of the merged vertex.
    Star,
    /// Those of the merged vertex and of its neighbours.
    Neighbours,
}

/// Costs of collapses. `Sync` because the first costs are computed on all cores.
pub(super) trait CollapseCriterion: Sync {
    /// What the criterion keeps at each vertex.
    type State: Copy + Default + Send + Sync;

    const REACH: CostReach;

    /// Fills in the states of all vertices.
    fn prepare(&self, surface: &mut CollapseSurface<Self::State>, budget: &Budget) -> Result<(), Stopped>;

    /// The place for the edge of `h` under `rule`.
    fn place(
        &self,
        surface: &CollapseSurface<Self::State>,
        h: u32,
        rule: MergeRule,
        placement: Placement,
    ) -> PlacedVertex;

    /// The state of the vertex at `position` that `ends` became.
    fn merged(&self, ends: [&Vertex<Self::State>; 2], position: DVec3) -> Self::State;
}

/// The better of two places; the second when they cost the same.
#[inline]
pub(super) fn cheaper(a: PlacedVertex, b: PlacedVertex) -> PlacedVertex {
    if a.cost < b.cost { a } else { b }
}
