//! Joins boundary edges whose ends coincide. No vertex moves.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::mesh::{self, EdgeGroups, edge_of};
use crate::spatial::coincident_f64;

/// Joins boundary edges with equal end positions wherever the mesh stays a manifold. The draft must be one (see
/// [`cut_singular`](super::cut::cut_singular)).
///
/// # Errors
/// When the budget stops the run.
pub fn stitch(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let pairs = coincident_pairs(draft, budget)?;
    let stitched = mesh::stitch(&mut draft.triangles, draft.positions.len(), &pairs, budget)?;
    draft.drop_unused_vertices();
    Ok(Changes::counted([
        ("edges_joined", stitched.explicit),
        ("edges_joined_with_others", stitched.implicit),
    ]))
}

/// Coincident boundary edges that each one is paired with at most; keeps the number of pairs linear in that of edges.
const PARTNERS_MAX: usize = 32;

/// Pairs of boundary half-edges that run between the same two positions in opposite directions, by position, then id.
fn coincident_pairs(draft: &Draft, budget: &Budget) -> Result<Vec<(u32, u32)>, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    if places.first.len() == draft.positions.len() {
        return Ok(Vec::new());
    }
    let mut vertices_at = vec![0u32; places.first.len()];
    for &place in &places.group {
        vertices_at[place as usize] += 1;
    }
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let mut boundary: Vec<([u32; 2], u32)> = groups
        .iter()
        .filter_map(|group| match *group {
            [h] => Some((edge_of(&draft.triangles, h).map(|v| places.group[v as usize]), h)),
            _ => None,
        })
        .filter(|(ends, _)| ends.iter().any(|&place| vertices_at[place as usize] > 1))
        .collect();
    boundary.sort_unstable_by_key(|&([a, b], h)| (a.min(b), a.max(b), h));
    let mut pairs = Vec::new();
    for coincident in boundary.chunk_by(|(a, _), (b, _)| a == b || *a == [b[1], b[0]]) {
        for (i, &([a, _], g)) in coincident.iter().enumerate() {
            budget.spend(1)?;
            let later = coincident[i + 1..].iter().take(PARTNERS_MAX);
            pairs.extend(later.filter(|&&([b, _], _)| a != b).map(|&(_, h)| (g, h)));
        }
    }
    Ok(pairs)
}
