//! The quadric criterion: Garland and Heckbert (1997), area weighted.
//!
//! What orders the collapses is the summed squared distance over the square root of the area behind it, halfway between
//! the sum and the mean. The sum alone lets small features far off go for the sake of large flat areas; on 32 models of
//! the corpus, at a tenth of the faces, this takes a tenth off the Hausdorff distance and adds a hundredth to the mean
//! distance.

use super::criterion::{CollapseCriterion, CostReach, PlacedVertex, cheaper};
use super::marks::LINE;
use super::options::Placement;
use super::quadric::Quadric;
use super::surface::{CollapseSurface, MergeRule, Vertex};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::corner_table::next;

/// Share of the squared length of an edge that is added to the squared error: where the surface is flat, short edges
/// go first instead of whatever rounding says. Far below the error of any curved area.
const LENGTH_SHARE: f64 = 1e-7;

/// Costs by quadrics. A vertex keeps its quadric about its own position.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadricError {
    /// Weight of the walls on lines.
    pub wall_weight: f64,
}

impl CollapseCriterion for QuadricError {
    type State = Quadric;

    const REACH: CostReach = CostReach::Star;

    fn prepare(&self, surface: &mut CollapseSurface<Quadric>, budget: &Budget) -> Result<(), Stopped> {
        for t in 0..surface.table.triangle_bound() as u32 {
            if (t as usize).is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let Some(vertices) = surface.table.corners(t) else { continue };
            let corners = surface.corners(4 * t);
            // The plane goes through all three corners, so its quadric is the same about each.
            let plane = Quadric::of_triangle(corners);
            vertices.iter().for_each(|&v| surface.vertices[v as usize].state += plane);
            for h in [4 * t, 4 * t + 1, 4 * t + 2] {
                if surface.table.marks(h) & LINE != 0 {
                    self.add_wall(surface, h);
                }
            }
        }
        Ok(())
    }

    #[inline]
    fn place(
        &self,
        surface: &CollapseSurface<Quadric>,
        h: u32,
        rule: MergeRule,
        placement: Placement,
    ) -> PlacedVertex {
        let [a, b] = surface.ends(h);
        let to_a = a.position - b.position;
        let both = a.state.about(-to_a) + b.state;
        let weight = both.weight();
        let length_cost = LENGTH_SHARE * weight * to_a.length_squared();
        let evenness = if weight > 0.0 { weight.sqrt().recip() } else { 0.0 };
        let placed = |position: DVec3, value: f64| PlacedVertex {
            position,
            cost: (value + length_cost) * evenness,
            error_squared: if weight > 0.0 { value / weight } else { 0.0 },
        };
        let onto_a = || placed(a.position, both.value(to_a));
        let onto_b = || placed(b.position, both.value_here());
        match (rule, placement) {
            (MergeRule::OntoOrigin, _) => onto_a(),
            (MergeRule::OntoDestination, _) => onto_b(),
            (MergeRule::Anywhere, Placement::OntoEnd) => cheaper(onto_a(), onto_b()),
            (MergeRule::Anywhere, Placement::Optimal) => {
                let offset = both.minimum(0.5 * to_a).position;
                placed(b.position + offset, both.value(offset))
            }
        }
    }

    #[inline]
    fn merged(&self, ends: [&Vertex<Quadric>; 2], position: DVec3) -> Quadric {
        let [a, b] = ends.map(|end| end.state.about(position - end.position));
        a + b
    }
}

impl QuadricError {
    /// Adds the wall on the edge of `h`, across the triangle of `h`, to both ends.
    fn add_wall(&self, surface: &mut CollapseSurface<Quadric>, h: u32) {
        let [p, q, r] = surface.corners(h);
        let wall = Quadric::of_wall(p, q, (q - p).cross(r - p), self.wall_weight);
        for v in [h, next(h)].map(|g| surface.table.origin(g)) {
            surface.vertices[v as usize].state += wall;
        }
    }
}
