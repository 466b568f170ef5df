//! Clears what rounded sines and cosines leave of a zero.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::EdgeGroups;
use crate::spatial::coincident_f64;

/// A coordinate below this share of the largest one is noise: 2^-40, the step of a lattice 2^17 times finer than float32
/// at that size. Modellers write 6e-17 for the cosine of a right angle, and two rims that should be one are then apart.
const NOISE_SHARE: f64 = 1.0 / (1u64 << 40) as f64;

/// True when some coordinate is noise beside the largest. Positions that are not finite are left out.
pub fn has_noise(positions: &[DVec3]) -> bool {
    let limit = noise_limit(positions);
    positions.iter().any(|p| p.to_array().into_iter().any(|x| is_noise(x, limit)))
}

/// True when rims that would be one are kept apart by noise alone: with it cleared, fewer edges have one triangle.
///
/// # Errors
/// When the budget stops the run.
pub fn parts_rims(draft: &Draft, budget: &Budget) -> Result<bool, Stopped> {
    if !has_noise(&draft.positions) {
        return Ok(false);
    }
    let mut cleared = draft.clone();
    clear_noise(&mut cleared);
    Ok(boundary_edges(&cleared, budget)? < boundary_edges(draft, budget)?)
}

/// Number of edges with one triangle when vertices at one place are one.
fn boundary_edges(draft: &Draft, budget: &Budget) -> Result<usize, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let placed = draft.triangles.iter().map(|t| t.map(|v| places.group[v as usize]));
    let triangles: Vec<[u32; 3]> = placed.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let groups = EdgeGroups::build(&triangles, places.first.len(), budget)?;
    Ok(groups.iter().filter(|group| group.len() == 1).count())
}

/// Moves every vertex with a coordinate that is noise to where that coordinate is zero.
pub fn clear_noise(draft: &mut Draft) -> Changes {
    let limit = noise_limit(&draft.positions);
    let (mut moved, mut move_max) = (0, 0.0f64);
    for position in &mut draft.positions {
        let cleared = position.map(|x| if is_noise(x, limit) { 0.0 } else { x });
        if cleared != *position {
            moved += 1;
            move_max = move_max.max(cleared.distance(*position));
            *position = cleared;
        }
    }
    Changes { move_max, ..Changes::counted([("vertices_moved", moved)]) }
}

fn noise_limit(positions: &[DVec3]) -> f64 {
    let finite = positions.iter().filter(|p| p.is_finite());
    finite.fold(0.0, |largest, p| p.abs().max_element().max(largest)) * NOISE_SHARE
}

fn is_noise(x: f64, limit: f64) -> bool {
    x != 0.0 && x.abs() < limit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_nothing_beside_the_largest_coordinate_becomes_zero() {
        let mut draft = Draft {
            positions: vec![DVec3::new(5.0, -3e-16, 0.0), DVec3::new(1e-11, 1.0, 0.0)],
            ..Draft::default()
        };
        assert!(has_noise(&draft.positions));
        let changes = clear_noise(&mut draft);
        assert_eq!((changes.count("vertices_moved"), changes.move_max), (1, 3e-16));
        assert_eq!(draft.positions, [DVec3::new(5.0, 0.0, 0.0), DVec3::new(1e-11, 1.0, 0.0)]);
        assert!(!has_noise(&draft.positions));
    }

    #[test]
    fn two_triangles_along_a_noisy_edge_are_kept_apart_by_noise() {
        let rims = |noise: f64| Draft {
            positions: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, noise], [1.0, noise], [0.0, -1.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.0))
                .to_vec(),
            triangles: vec![[0, 1, 2], [4, 3, 5]],
            ..Draft::default()
        };
        let parts_rims = |noise: f64| parts_rims(&rims(noise), &Budget::unlimited()).unwrap();
        assert!(parts_rims(1e-17));
        assert!(!parts_rims(0.0));
        assert!(!parts_rims(1e-3));
    }
}
