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

/// What is done about noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Noise {
    /// It stays.
    #[default]
    Stays,
    /// Vertices that it alone keeps apart go to where one of them is.
    Joined,
    /// It becomes zero everywhere.
    Cleared,
}

/// True when rims that would be one are kept apart by noise alone: with it cleared, fewer edges have one triangle.
///
/// # Errors
/// When the budget stops the run.
pub fn parts_rims(draft: &Draft, budget: &Budget) -> Result<bool, Stopped> {
    if !has_noise(&draft.positions) {
        return Ok(false);
    }
    let mut joined = draft.clone();
    join_over_noise(&mut joined, budget)?;
    Ok(boundary_edges(&joined, budget)? < boundary_edges(draft, budget)?)
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
    let cleared = cleared(&draft.positions);
    move_to(draft, cleared)
}

/// Moves vertices that would be at one position without noise to that of them which the most triangles have.
///
/// # Errors
/// When the budget stops the run.
pub fn join_over_noise(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let without = coincident_f64(&cleared(&draft.positions), budget)?.group;
    let places = coincident_f64(&draft.positions, budget)?;
    budget.spend(draft.triangles.len() as u64)?;
    let mut triangles = vec![0u32; places.first.len()];
    for &v in draft.triangles.as_flattened() {
        triangles[places.group[v as usize] as usize] += 1;
    }
    let position = |place: u32| draft.positions[places.first[place as usize] as usize];
    // Of those that as many triangles have, the one with the smallest coordinates, so that one side of a seam stays as a whole.
    let is_better = |a: u32, b: u32| {
        let smaller = || position(a).to_array() < position(b).to_array();
        triangles[a as usize] > triangles[b as usize]
            || triangles[a as usize] == triangles[b as usize] && smaller()
    };
    let mut best: Vec<Option<u32>> = vec![None; draft.positions.len()];
    for (&group, &place) in without.iter().zip(&places.group) {
        let best = &mut best[group as usize];
        *best = Some(best.filter(|&best| !is_better(place, best)).unwrap_or(place));
    }
    let own = places.group.iter().zip(&without);
    let joined = own.map(|(&place, &group)| position(best[group as usize].unwrap_or(place))).collect();
    Ok(move_to(draft, joined))
}

/// Positions without noise.
fn cleared(positions: &[DVec3]) -> Vec<DVec3> {
    let limit = noise_limit(positions);
    positions.iter().map(|p| p.map(|x| if is_noise(x, limit) { 0.0 } else { x })).collect()
}

fn move_to(draft: &mut Draft, places: Vec<DVec3>) -> Changes {
    let (mut moved, mut move_max) = (0, 0.0f64);
    for (position, place) in draft.positions.iter_mut().zip(places) {
        if place != *position {
            moved += 1;
            move_max = move_max.max(place.distance(*position));
            *position = place;
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
    fn vertices_that_noise_keeps_apart_go_to_where_most_triangles_have_them() {
        let mut draft = Draft {
            positions: [[0.0, 1e-17], [0.0, -1e-17], [1.0, 0.0], [0.0, 1.0], [-1.0, 1e-18], [0.0, -1.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.0))
                .to_vec(),
            triangles: vec![[0, 2, 3], [1, 3, 4], [1, 4, 5]],
            ..Draft::default()
        };
        let changes = join_over_noise(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("vertices_moved"), changes.move_max), (1, 2e-17));
        assert_eq!(
            [draft.positions[0].y, draft.positions[1].y, draft.positions[4].y],
            [-1e-17, -1e-17, 1e-18]
        );
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
