//! Finds loops that face each other across a gap: the surface at each would go on towards the other. So do the two rims
//! where a band is missing of a tube, and an island and the hole around it; the rims at the ends of a tube look away from
//! each other, and those of two holes on both sides of a wall past each other.

use super::shape::LoopPolyline;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::BoundaryLoop;

/// Mean cosine of the angle between the direction in which the surface would go on and that to the other loop, at least.
const FACING_COS_MIN: f64 = 0.6;
/// Loops run against each other when the cosine of the angle between their normals is below this.
const AGAINST_COS_MAX: f64 = -0.3;
/// Width of a gap, at most, as a share of the diagonal of the larger loop.
const GAP_SHARE_MAX: f64 = 0.5;
/// Corners of a loop that are looked at.
const SAMPLES: usize = 64;
/// Most loops among which partners are searched, in time that grows with their square.
const LOOPS_MAX: usize = 4096;

/// For each loop the larger one that it shares a patch with. Loops that are islands in a plane, or hold one, have none.
pub(super) fn partners(
    shapes: &[LoopPolyline],
    loops: &[&BoundaryLoop],
    outward: &dyn Fn(u32) -> DVec3,
    in_plane: &[Option<usize>],
    budget: &Budget,
) -> Result<Vec<Option<usize>>, Stopped> {
    let mut partner = vec![None; shapes.len()];
    let mut is_taken: Vec<bool> = in_plane.iter().map(Option::is_some).collect();
    for &outer in in_plane.iter().flatten() {
        is_taken[outer] = true;
    }
    let mut order: Vec<usize> = (0..shapes.len()).filter(|&i| !is_taken[i] && shapes[i].area > 0.0).collect();
    if order.len() > LOOPS_MAX {
        return Ok(partner);
    }
    order.sort_by(|&a, &b| shapes[b].area.total_cmp(&shapes[a].area).then(a.cmp(&b)));
    for (rank, &inner) in order.iter().enumerate() {
        budget.spend(rank as u64 / 16 + 1)?;
        let mut best: Option<(f64, usize)> = None;
        for &outer in order[..rank].iter().filter(|&&outer| partner[outer].is_none()) {
            if !is_near(&shapes[inner], &shapes[outer]) {
                continue;
            }
            budget.spend(((loops[inner].len() + loops[outer].len()) * SAMPLES) as u64 / 16)?;
            let toward = |from: usize, to: usize| facing(&shapes[from], loops[from], &shapes[to], outward);
            let limit = GAP_SHARE_MAX * shapes[outer].bounds.diagonal();
            let ((a, gap), (b, _)) = (toward(inner, outer), toward(outer, inner));
            let cos = a.min(b);
            if gap <= limit && cos >= FACING_COS_MIN && best.is_none_or(|best| cos > best.0) {
                best = Some((cos, outer));
            }
        }
        partner[inner] = best.map(|(_, outer)| outer);
    }
    Ok(partner)
}

/// True when the boxes are no farther apart than a gap may be, and the loops run against each other.
fn is_near(inner: &LoopPolyline, outer: &LoopPolyline) -> bool {
    let apart =
        (outer.bounds.min - inner.bounds.max).max(inner.bounds.min - outer.bounds.max).max(DVec3::ZERO);
    apart.length() <= GAP_SHARE_MAX * outer.bounds.diagonal()
        && inner.normal.dot(outer.normal) <= AGAINST_COS_MAX
}

/// The mean cosine between where the surface would go on and the nearest corner of the other loop, and the mean distance
/// of that.
fn facing(
    from: &LoopPolyline,
    half_edges: &BoundaryLoop,
    to: &LoopPolyline,
    outward: &dyn Fn(u32) -> DVec3,
) -> (f64, f64) {
    let n = half_edges.len();
    let stride = n.div_ceil(SAMPLES);
    let (mut cos, mut gap, mut count) = (0.0, 0.0, 0.0);
    for i in (0..n).step_by(stride) {
        let middle = (from.points[i] + from.points[(i + 1) % n]) / 2.0;
        let nearest = to
            .points
            .iter()
            .copied()
            .min_by(|a, b| a.distance_squared(middle).total_cmp(&b.distance_squared(middle)));
        let Some(nearest) = nearest else { continue };
        cos += (nearest - middle).normalize_or_zero().dot(outward(half_edges[i]));
        gap += nearest.distance(middle);
        count += 1.0;
    }
    (cos / count, gap / count)
}
