//! Openings that closed bodies cover: a boss without a bottom that stands on a plate is no sheet.

use super::WindingTree;
use super::shells::UnbalancedEdge;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::UnionFind;

/// Shares of the way from an edge of a rim to its middle at which an opening is looked at.
const SHARES: [f64; 2] = [0.1, 0.5];

/// Places are looked at so many times `beside` away from the opening: a turned body is off its planes by rounding.
const TIMES_BESIDE: f64 = 16.0;

/// Which of the parts that `is_asked` marks have openings that the `closed` bodies cover, all of them: on one side of each at least
/// is the inside of a body. `rims` names edges of `positions`.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn are_covered(
    positions: &[DVec3],
    rims: &[UnbalancedEdge],
    is_asked: &[bool],
    (closed, beside): (&[[DVec3; 3]], f64),
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let rims: Vec<&UnbalancedEdge> = rims.iter().filter(|rim| is_asked[rim.part as usize]).collect();
    let mut are_covered = vec![false; is_asked.len()];
    if closed.is_empty() || rims.is_empty() {
        return Ok(are_covered);
    }
    rims.iter().for_each(|rim| are_covered[rim.part as usize] = true);
    let tree = WindingTree::build(closed.to_vec(), budget)?;
    let mut sets = UnionFind::new(positions.len());
    for rim in &rims {
        sets.unite(rim.from, rim.to);
    }
    let mut by_opening: Vec<(u32, &UnbalancedEdge)> =
        rims.into_iter().map(|rim| (sets.find(rim.from), rim)).collect();
    by_opening.sort_by_key(|&(opening, _)| opening);
    for opening in by_opening.chunk_by(|a, b| a.0 == b.0) {
        let ends = |rim: &UnbalancedEdge| [rim.from, rim.to].map(|v| positions[v as usize]);
        let edges = || opening.iter().map(|&(_, rim)| ends(rim));
        let middle = edges().map(|[a, b]| (a + b) / 2.0).sum::<DVec3>() / opening.len() as f64;
        let normal = edges().map(|[a, b]| (a - middle).cross(b - middle)).sum::<DVec3>().normalize_or_zero();
        let step = normal * (TIMES_BESIDE * beside);
        let on_rays = |[a, b]: [DVec3; 2]| SHARES.map(|share| ((a + b) / 2.0).lerp(middle, share));
        let mut is_covered = step != DVec3::ZERO;
        for place in edges().flat_map(on_rays).chain([middle]) {
            if !is_covered {
                break;
            }
            budget.spend(16)?;
            is_covered =
                tree.is_inside(place - step, 0.0, budget)? || tree.is_inside(place + step, 0.0, budget)?;
        }
        if !is_covered {
            opening.iter().for_each(|&(_, rim)| are_covered[rim.part as usize] = false);
        }
    }
    Ok(are_covered)
}
