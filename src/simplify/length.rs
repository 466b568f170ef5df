//! The criterion of edge length: the shortest edge first.

use super::criterion::{Criterion, PlacedVertex, Reach};
use super::options::Placement;
use super::surface::{CollapseSurface, Rule, Vertex};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Costs by squared length; the merged vertex is the middle of the edge, or its destination.
#[derive(Debug, Clone, Copy)]
pub(super) struct Length;

impl Criterion for Length {
    type State = ();

    const REACH: Reach = Reach::Star;

    fn prepare(&self, _: &mut CollapseSurface<()>, _: &Budget) -> Result<(), Stopped> {
        Ok(())
    }

    #[inline]
    fn place(&self, surface: &CollapseSurface<()>, h: u32, rule: Rule, placement: Placement) -> PlacedVertex {
        let [a, b] = surface.ends(h).map(|end| end.position);
        let position = match (rule, placement) {
            (Rule::OntoOrigin, _) => a,
            (Rule::OntoDestination, _) | (Rule::Anywhere, Placement::OntoEnd) => b,
            (Rule::Anywhere, Placement::Optimal) => a + 0.5 * (b - a),
        };
        let cost = a.distance_squared(b);
        PlacedVertex { position, cost, error_squared: cost }
    }

    #[inline]
    fn merged(&self, _: [&Vertex<()>; 2], _: DVec3) {}
}
