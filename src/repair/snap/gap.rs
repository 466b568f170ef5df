//! How far apart rims lie that should be one.

use super::beside::{Reach, lie_side_by_side};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::repair::Draft;
use crate::spatial::{Octree, coincident_f64};
use rustc_hash::FxHashMap;

/// Edges that one is compared with at most. Where more are as close, they do not say which belong together.
const NEAR_MAX: usize = 256;

/// The distance at which snapping joins the rims that lie beside each other, at most `most`: twice the largest distance of
/// an edge with one triangle to the nearest one of another triangle, among those that are apart by less than `most` and lie
/// side by side. 0 when there are none.
///
/// # Errors
/// When the budget stops the run.
pub fn gap_between_rims(draft: &Draft, most: f64, budget: &Budget) -> Result<f64, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let placed = |t: &[u32; 3]| t.map(|v| places.group[v as usize]);
    let triangles: Vec<[u32; 3]> =
        draft.triangles.iter().map(placed).filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let at = |group: u32| draft.positions[places.first[group as usize] as usize];
    let groups = EdgeGroups::build(&triangles, places.first.len(), budget)?;
    let rim: Vec<u32> =
        groups.iter().filter_map(|group| <[u32; 1]>::try_from(group).ok()).map(|[h]| h).collect();
    drop(groups);
    let mut edges_at: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for &h in &rim {
        for v in edge_of(&triangles, h) {
            edges_at.entry(v).or_default().push(h);
        }
    }
    let mut ends: Vec<u32> = edges_at.keys().copied().collect();
    ends.sort_unstable();
    let places_of_groups: Vec<DVec3> = (0..places.first.len() as u32).map(at).collect();
    let octree = Octree::build(&places_of_groups, ends, budget)?;
    let mut widest = 0.0f64;
    for &h in &rim {
        let own = triangle_of(h);
        let [from, to, third] = flank(&triangles, h).map(at);
        let reach = Reach { epsilon: most, by_edge: true }.of_edge([from, to]);
        let near = octree.near(from, reach, budget)?;
        let compared = near.iter().map(|beside| edges_at[beside].len()).sum::<usize>();
        budget.spend(near.len() as u64 + compared.min(NEAR_MAX) as u64)?;
        if compared > NEAR_MAX {
            continue;
        }
        let mut least = f64::INFINITY;
        for &beside in &near {
            for &other in &edges_at[&beside] {
                let [a, b, c] = flank(&triangles, other);
                let flank = if a == beside { [a, b, c] } else { [b, a, c] }.map(at);
                let apart = flank[0].distance(from).max(flank[1].distance(to));
                if triangle_of(other) != own && apart <= reach && lie_side_by_side([from, to, third], flank) {
                    least = least.min(apart);
                }
            }
        }
        if least.is_finite() {
            widest = widest.max(least);
        }
    }
    Ok((2.0 * widest).min(most))
}

/// The ends of a half-edge and the third corner of its triangle.
fn flank(triangles: &[[u32; 3]], h: u32) -> [u32; 3] {
    let corners = triangles[triangle_of(h) as usize];
    [0, 1, 2].map(|k| corners[(h as usize + k) % 3])
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
        gap_between_rims(draft, most, &Budget::unlimited()).unwrap()
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
}
