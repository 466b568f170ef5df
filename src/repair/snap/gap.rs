//! How far apart rims lie that should be one.

use super::beside::{Flank, JoinReach, NEAR_MAX, flank_of, lie_side_by_side};
use super::divide::{Beside, RimSearch, slits};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, is_on_segment};
use crate::mesh::{Boundary, Components, EdgeGroups, edge_of, triangle_of};
use crate::repair::Draft;
use crate::spatial::{Octree, coincident_f64};
use rustc_hash::FxHashMap;

/// The distance at which snapping joins the rims that lie beside each other, at most `most`: twice the largest distance of
/// an edge with one triangle to the nearest one of another triangle, or of a vertex to the nearest edge of another boundary that
/// it lies beside, among those that are apart, by less than `most`, and lie side by side.
///
/// # Errors
/// When the budget stops the run.
pub fn gap_between_rims(draft: &Draft, most: f64, budget: &Budget) -> Result<Option<f64>, Stopped> {
    let rims = WeldedBoundary::of(draft, budget)?;
    let [between, beside] =
        [rims.widest_between_edges(most, budget)?, rims.widest_beside_vertices(most, budget)?];
    let widest = beside.map_or(between, |apart| larger(between, apart));
    Ok(widest.map(|widest| (2.0 * widest).min(most)))
}

/// The edges with one triangle, where vertices at one place are one.
struct WeldedBoundary {
    places: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    half_edges: Vec<u32>,
    /// Triangles connected by edges.
    parts: Components,
    boundary: Boundary,
}

impl WeldedBoundary {
    fn of(draft: &Draft, budget: &Budget) -> Result<Self, Stopped> {
        let at = coincident_f64(&draft.positions, budget)?;
        let placed = |t: &[u32; 3]| t.map(|v| at.group[v as usize]);
        let triangles: Vec<[u32; 3]> =
            draft.triangles.iter().map(placed).filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let groups = EdgeGroups::build(&triangles, at.first.len(), budget)?;
        let half_edges =
            groups.iter().filter_map(|group| <[u32; 1]>::try_from(group).ok()).map(|[h]| h).collect();
        Ok(Self {
            places: at.first.iter().map(|&v| draft.positions[v as usize]).collect(),
            half_edges,
            parts: groups.components(budget)?,
            boundary: Boundary::trace(&triangles, at.first.len(), &groups, budget)?,
            triangles,
        })
    }

    fn flank(&self, h: u32) -> Flank {
        flank_of(&self.triangles, h).map(|v| self.places[v as usize])
    }

    /// The largest distance of an edge to the nearest one of another triangle beside it.
    fn widest_between_edges(&self, most: f64, budget: &Budget) -> Result<Option<f64>, Stopped> {
        let mut edges_at: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
        for &h in &self.half_edges {
            for v in edge_of(&self.triangles, h) {
                edges_at.entry(v).or_default().push(h);
            }
        }
        let mut ends: Vec<u32> = edges_at.keys().copied().collect();
        ends.sort_unstable();
        let octree = Octree::build(&self.places, ends, budget)?;
        let mut widest = None;
        for &h in &self.half_edges {
            let [from, to, third] = self.flank(h);
            let reach = JoinReach { epsilon: most, by_edge: true }.of_edge([from, to]);
            let near = octree.near(from, reach, budget)?;
            let compared = near.iter().map(|beside| edges_at[beside].len()).sum::<usize>();
            budget.spend(near.len() as u64 + compared.min(NEAR_MAX) as u64)?;
            if compared > NEAR_MAX {
                continue;
            }
            let mut least = f64::INFINITY;
            for &beside in &near {
                for &other in &edges_at[&beside] {
                    let [a, b, c] = self.flank(other);
                    let begins_here = edge_of(&self.triangles, other)[0] == beside;
                    let flank = if begins_here { [a, b, c] } else { [b, a, c] };
                    let apart = flank[0].distance(from).max(flank[1].distance(to));
                    let is_another = triangle_of(other) != triangle_of(h);
                    if is_another && apart <= reach && lie_side_by_side([from, to, third], flank) {
                        least = least.min(apart);
                    }
                }
            }
            if least > 0.0 && least.is_finite() {
                widest = larger(widest, least);
            }
        }
        Ok(widest)
    }

    /// The largest distance of a vertex to the nearest edge of another boundary that it lies beside, but not on.
    fn widest_beside_vertices(&self, most: f64, budget: &Budget) -> Result<Option<f64>, Stopped> {
        let loops = self.boundary.loops.iter();
        let is_slit =
            slits(&self.places, &self.triangles, loops.clone().map(|own| own.iter().copied()), most);
        let mut loop_of: FxHashMap<u32, u32> = FxHashMap::default();
        for (own, of) in loops.zip(0..) {
            loop_of.extend(own.iter().map(|&h| (h, of)));
        }
        let part_of = |h: u32| self.parts.of[triangle_of(h) as usize];
        let search = RimSearch::of(&self.places, &self.triangles, &self.half_edges, budget)?;
        let mut widest = None;
        for (v, own) in search.vertices() {
            let may_divide = |h: u32| {
                let of = loop_of.get(&h);
                let is_no_slit = of.is_some_and(|&of| !is_slit[of as usize]);
                let is_other = |g: u32| part_of(g) != part_of(h) || loop_of.get(&g) != of || is_no_slit;
                own.iter().all(|&(_, g)| is_other(g))
            };
            // What is nearer to an end is compared with it, as the end of an edge.
            let off_ends =
                |[from, to, _]: Flank| JoinReach { epsilon: most, by_edge: true }.of_edge([from, to]);
            let nearest = search.nearest_beside(v, own, most, off_ends, may_divide, budget)?;
            let Some(Beside { half_edge, apart }) = nearest else { continue };
            let [from, to, _] = self.flank(half_edge);
            if !is_on_segment(self.places[v as usize], from, to) {
                widest = larger(widest, apart);
            }
        }
        Ok(widest)
    }
}

fn larger(widest: Option<f64>, apart: f64) -> Option<f64> {
    Some(widest.map_or(apart, |widest| widest.max(apart)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares side by side with a gap of this width between x = 1 and x = 1 + gap, each of two triangles without common
    /// vertices.
    fn squares(gap: f64) -> Draft {
        let square = |x: f64| [[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 0.0], [x + 1.0, 1.0], [x, 1.0]];
        let corners = [square(0.0), square(1.0 + gap)].concat();
        Draft {
            positions: corners.into_iter().map(|[x, y]| DVec3::new(x, y, 0.0)).collect(),
            triangles: (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            ..Draft::default()
        }
    }

    fn gap(draft: &Draft, most: f64) -> f64 {
        gap_between_rims(draft, most, &Budget::unlimited()).unwrap().unwrap_or(0.0)
    }

    #[test]
    fn it_is_twice_the_width_of_the_widest_gap_that_is_narrow_enough() {
        for width in [1e-9, 1e-6, 1e-3] {
            let found = gap(&squares(width), 0.01);
            assert!((found / width - 2.0).abs() < 1e-6, "{width:e}: {found:e}");
        }
        assert_eq!(gap(&squares(0.008), 0.01), 0.01);
        assert_eq!(gap(&squares(0.011), 0.01), 0.0);
        assert_eq!(gap(&squares(0.5), 1.0), 0.0, "wide for the length of its edges");
    }

    #[test]
    fn rims_that_coincide_and_the_sides_of_a_needle_have_none() {
        assert_eq!(gap(&squares(0.0), 0.1), 0.0);
        let needle = Draft {
            positions: vec![DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 1e-6, 0.0)],
            triangles: vec![[0, 1, 2]],
            ..Draft::default()
        };
        assert_eq!(gap(&needle, 0.1), 0.0);
    }

    #[test]
    fn a_vertex_beside_the_inside_of_an_edge_of_another_rim_counts_and_one_on_it_or_in_a_slit_does_not() {
        let below = [[0.0, -1.0], [2.0, -1.0], [2.0, 0.0], [0.0, -1.0], [2.0, 0.0], [0.0, 0.0]];
        let strips = |width: f64| {
            let above = [[0.0, 0.0], [0.7, width], [0.0, 1.0], [0.7, width], [2.0, 0.0], [0.0, 1.0]];
            Draft {
                positions: below.into_iter().chain(above).map(|[x, y]| DVec3::new(x, y, 0.0)).collect(),
                triangles: (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
                ..Draft::default()
            }
        };
        for width in [1e-9, 1e-3] {
            let found = gap(&strips(width), 0.01);
            assert!((found / width - 2.0).abs() < 1e-6, "{width:e}: {found:e}");
        }
        assert_eq!(gap(&strips(0.0), 0.01), 0.0, "on the edge");
        let mut slit = strips(1e-3);
        // Joined at its ends by two triangles beyond each.
        let left = [[0.0, 1.0], [-1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [-1.0, 0.0], [0.0, -1.0]];
        let right = [[2.0, 0.0], [3.0, 1.0], [0.0, 1.0], [2.0, -1.0], [3.0, 1.0], [2.0, 0.0]];
        slit.positions.extend(left.into_iter().chain(right).map(|[x, y]| DVec3::new(x, y, 0.0)));
        slit.triangles = (0..8).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        assert_eq!(gap(&slit, 0.01), 0.0, "a slit");
    }
}
