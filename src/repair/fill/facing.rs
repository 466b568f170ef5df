//! Finds loops that face each other across a gap: the surface at each would go on towards the other. So do the two rims
//! where a band is missing of a tube, and an island and the hole around it; the rims at the ends of a tube look away from
//! each other, and those of two holes on both sides of a wall past each other. The lips of two skins, as of a cup, and the rims
//! of two flat sheets back to back, as of a plate without its sides, belong together too.

use super::shape::LoopPolyline;
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, closest_point_on_triangle};
use crate::mesh::BoundaryLoop;

/// Mean cosine of the angle between the direction in which the surface would go on and that to the other loop, at least.
const FACING_COS_MIN: f64 = 0.6;
/// Loops are the lips of two skins, as of a cup, when both surfaces leave the planes of the loops in one direction, with at least this
/// mean cosine to the normals.
const LIP_COS_MIN: f64 = 0.6;
/// Width of the gap between the lips of two skins, at most, as a share of the diagonal of the larger loop.
const LIP_GAP_SHARE_MAX: f64 = 0.25;
/// Loops run against each other when the cosine of the angle between their normals is below this.
const AGAINST_COS_MAX: f64 = -0.3;
/// Width of a gap, at most, as a share of the diagonal of the larger loop.
const GAP_SHARE_MAX: f64 = 0.5;
/// Of the rims of two sheets, the smaller one bounds at least this share of the area of the larger one.
const SHEET_AREA_SHARE_MIN: f64 = 0.25;
/// Sides of a loop that are looked at.
const SAMPLES: usize = 64;
/// Most loops among which partners are searched, in time that grows with their square.
const LOOPS_MAX: usize = 4096;

/// For each rim of a flat sheet that is `free`, the larger one of another sheet that it shares a patch with.
fn sheet_partners(
    shapes: &[LoopPolyline],
    sheets: &[Option<DVec3>],
    free: &[bool],
    budget: &Budget,
) -> Result<Vec<Option<usize>>, Stopped> {
    let mut partner = vec![None; shapes.len()];
    let mut is_free = free.to_vec();
    let order = by_area(shapes, |i| is_free[i] && sheets[i].is_some());
    for (rank, &inner) in order.iter().enumerate() {
        budget.spend(rank as u64 / 16 + 1)?;
        let mut best: Option<(f64, usize)> = None;
        for &outer in order[..rank].iter().filter(|&&outer| is_free[outer]) {
            let (a, b) = (&shapes[inner], &shapes[outer]);
            let is_like = a.area >= SHEET_AREA_SHARE_MIN * b.area && is_near(a, b);
            if !is_like || !are_back_to_back([a, b], [inner, outer].map(|i| sheets[i])) {
                continue;
            }
            budget.spend(((a.points.len() + b.points.len()) * SAMPLES) as u64 / 16)?;
            let gap = facing(a, b, |_| DVec3::ZERO).1.max(facing(b, a, |_| DVec3::ZERO).1);
            if gap <= GAP_SHARE_MAX * b.bounds.diagonal() && best.is_none_or(|best| gap < best.0) {
                best = Some((gap, outer));
            }
        }
        if let Some((_, outer)) = best {
            partner[inner] = Some(outer);
            (is_free[inner], is_free[outer]) = (false, false);
        }
    }
    Ok(partner)
}

/// The loops that are `wanted`, the largest first; none where there are too many.
fn by_area(shapes: &[LoopPolyline], wanted: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..shapes.len()).filter(|&i| wanted(i)).collect();
    if order.len() > LOOPS_MAX {
        return Vec::new();
    }
    order.sort_by(|&a, &b| shapes[b].area.total_cmp(&shapes[a].area).then(a.cmp(&b)));
    order
}

/// True when both loops are outer rims of their sheets or both are rims of holes in them, and both sheets look away from each other,
/// or both at each other where they are inside out.
fn are_back_to_back([a, b]: [&LoopPolyline; 2], [of_a, of_b]: [Option<DVec3>; 2]) -> bool {
    let (Some(of_a), Some(of_b)) = (of_a, of_b) else { return false };
    let is_hole = |shape: &LoopPolyline, sheet: DVec3| shape.normal.dot(sheet) > 0.0;
    let way = (b.bounds.min + b.bounds.max) / 2.0 - (a.bounds.min + a.bounds.max) / 2.0;
    is_hole(a, of_a) == is_hole(b, of_b) && of_a.dot(way) * of_b.dot(way) < 0.0
}

/// For each loop the larger one that it shares a patch with; `sheets` gives the normals of flat sheets of which loops are rims. Loops that
/// are islands in a plane, or hold one, have none.
pub(super) fn partners(
    shapes: &[LoopPolyline],
    loops: &[&BoundaryLoop],
    sheets: &[Option<DVec3>],
    outward: &dyn Fn(u32) -> DVec3,
    in_plane: &[Option<usize>],
    budget: &Budget,
) -> Result<Vec<Option<usize>>, Stopped> {
    let mut partner: Vec<Option<usize>> = vec![None; shapes.len()];
    let mut is_free: Vec<bool> = in_plane.iter().map(Option::is_none).collect();
    for &outer in in_plane.iter().flatten() {
        is_free[outer] = false;
    }
    let order = by_area(shapes, |i| is_free[i] && shapes[i].area > 0.0);
    for (rank, &inner) in order.iter().enumerate() {
        budget.spend(rank as u64 / 16 + 1)?;
        let mut best: Option<(f64, usize)> = None;
        for &outer in order[..rank].iter().filter(|&&outer| partner[outer].is_none()) {
            if !is_near(&shapes[inner], &shapes[outer]) {
                continue;
            }
            budget.spend(((loops[inner].len() + loops[outer].len()) * SAMPLES) as u64 / 16)?;
            let toward = |from: usize, to: usize| {
                facing(&shapes[from], &shapes[to], |side| outward(loops[from][side]))
            };
            let limit = GAP_SHARE_MAX * shapes[outer].bounds.diagonal();
            let ((a, gap), (b, _)) = (toward(inner, outer), toward(outer, inner));
            let cos = a.min(b);
            let is_facing = gap <= limit && cos >= FACING_COS_MIN;
            let are_lips = || {
                let [a, b] = [inner, outer].map(|i| lift(&shapes[i], |side| outward(loops[i][side])));
                // The normals of the loops point against each other.
                gap <= LIP_GAP_SHARE_MAX * shapes[outer].bounds.diagonal()
                    && a.abs().min(b.abs()) >= LIP_COS_MIN
                    && a * b < 0.0
            };
            if (is_facing || are_lips()) && best.is_none_or(|best| cos > best.0) {
                best = Some((cos, outer));
            }
        }
        partner[inner] = best.map(|(_, outer)| outer);
    }
    for (inner, outer) in partner.iter().enumerate().filter_map(|(inner, outer)| Some((inner, (*outer)?))) {
        (is_free[inner], is_free[outer]) = (false, false);
    }
    let back_to_back = sheet_partners(shapes, sheets, &is_free, budget)?;
    Ok(partner.into_iter().zip(back_to_back).map(|(facing, sheet)| facing.or(sheet)).collect())
}

/// True when the boxes are no farther apart than a gap may be, and the loops run against each other.
fn is_near(inner: &LoopPolyline, outer: &LoopPolyline) -> bool {
    let apart =
        (outer.bounds.min - inner.bounds.max).max(inner.bounds.min - outer.bounds.max).max(DVec3::ZERO);
    apart.length() <= GAP_SHARE_MAX * outer.bounds.diagonal()
        && inner.normal.dot(outer.normal) <= AGAINST_COS_MAX
}

/// The mean cosine between where the surface would go on from the sides of a loop, by their number, and the nearest place on the
/// other one, and the mean distance of that.
fn facing(from: &LoopPolyline, to: &LoopPolyline, outward: impl Fn(usize) -> DVec3) -> (f64, f64) {
    let n = from.points.len();
    let stride = n.div_ceil(SAMPLES);
    let (mut cos, mut gap, mut count) = (0.0, 0.0, 0.0);
    for i in (0..n).step_by(stride) {
        let middle = (from.points[i] + from.points[(i + 1) % n]) / 2.0;
        let next = to.points.iter().cycle().skip(1);
        let places = to.points.iter().zip(next).map(|(&a, &b)| closest_point_on_triangle(middle, [a, b, b]));
        let nearest = places.min_by(|a, b| a.distance_squared(middle).total_cmp(&b.distance_squared(middle)));
        let Some(nearest) = nearest else { continue };
        cos += (nearest - middle).normalize_or_zero().dot(outward(i));
        gap += nearest.distance(middle);
        count += 1.0;
    }
    (cos / count, gap / count)
}

/// The mean cosine between the normal of a loop and where the surface would go on from its sides, by their number.
fn lift(shape: &LoopPolyline, outward: impl Fn(usize) -> DVec3) -> f64 {
    let n = shape.points.len();
    let sides = (0..n).step_by(n.div_ceil(SAMPLES));
    let count = sides.clone().count() as f64;
    sides.map(|side| outward(side).dot(shape.normal)).sum::<f64>() / count
}
