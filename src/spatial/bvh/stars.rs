//! Vertices with so many triangles that their pairs must not be enumerated.

use super::build::Elements;
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// Triangles around one vertex up to which all their pairs may be looked at: 32 for each triangle.
const VALENCE_MAX: u32 = 64;

/// The triangles of a subtree that all have one vertex in common. A triangle is in one star at most: that of its
/// corner with the most triangles.
#[derive(Debug, Clone)]
pub(in crate::spatial) struct Star {
    /// The common vertex.
    pub(in crate::spatial) hub: u32,
    /// In the order they were given.
    pub(in crate::spatial) triangles: Vec<u32>,
}

/// The stars among `triangles`, by ascending hub.
pub(super) fn find(
    vertex_count: usize,
    triangles: &impl Elements,
    budget: &Budget,
) -> Result<Vec<Star>, Stopped> {
    let count = triangles.len();
    if count <= VALENCE_MAX as usize {
        return Ok(Vec::new());
    }
    let _charge = budget.charge(vertex_count as u64 * 4)?;
    let mut valence = vec![0u32; vertex_count];
    let mut largest = 0;
    for i in 0..count {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        for v in triangles.corners(triangles.id(i)) {
            valence[v as usize] += 1;
            largest = largest.max(valence[v as usize]);
        }
    }
    if largest <= VALENCE_MAX {
        return Ok(Vec::new());
    }
    let hubs: Vec<u32> = (0..vertex_count as u32).filter(|&v| valence[v as usize] > VALENCE_MAX).collect();
    let mut stars: Vec<Star> = hubs.iter().map(|&hub| Star { hub, triangles: Vec::new() }).collect();
    for i in 0..count {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let id = triangles.id(i);
        let hub = hub_of(triangles.corners(id), &valence);
        if let Ok(star) = hubs.binary_search(&hub) {
            stars[star].triangles.push(id);
        }
    }
    stars.retain(|star| star.triangles.len() > VALENCE_MAX as usize);
    Ok(stars)
}

/// The corner with the most triangles; of several the one with the smallest id.
fn hub_of(corners: [u32; 3], valence: &[u32]) -> u32 {
    let [a, b, c] = corners.map(|v| (std::cmp::Reverse(valence[v as usize]), v));
    a.min(b).min(c).1
}

/// The triangles that are in no star; all ids are below `id_end`.
pub(super) fn all_others(stars: &[Star], id_end: usize, triangles: &impl Elements) -> Vec<u32> {
    let mut is_in_star = vec![false; id_end];
    for &id in stars.iter().flat_map(|s| &s.triangles) {
        is_in_star[id as usize] = true;
    }
    (0..triangles.len()).map(|place| triangles.id(place)).filter(|&id| !is_in_star[id as usize]).collect()
}
