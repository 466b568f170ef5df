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
/// Loops run with or against each other when the cosine of the angle between their normals is above this, or below its opposite.
const AGAINST_COS_MIN: f64 = 0.3;
/// Width of a gap, at most, as a share of the diagonal of the larger loop.
const GAP_SHARE_MAX: f64 = 0.5;
/// Width of the gap between the rims of two sheets, at most, in the same way: sheets farther apart are shelves, no plate.
const SHEET_GAP_SHARE_MAX: f64 = 0.2;
/// Each of two sheets looks along the way between their middles with at least this cosine; others lie beside each other.
const SHEET_LOOKS_MIN: f64 = 0.5;
/// Of the rims of two sheets, the smaller one bounds at least this share of the area of the larger one.
const SHEET_AREA_SHARE_MIN: f64 = 0.25;
/// Sides of a loop that are looked at.
const SAMPLES: usize = 16;
/// Most loops among which partners are searched, in time that grows with their square.
const LOOPS_MAX: usize = 1024;

/// The loops among which partners are searched.
pub(super) struct Rims<'a> {
    pub(super) shapes: &'a [LoopPolyline],
    pub(super) loops: &'a [&'a BoundaryLoop],
    /// The unit normals of the flat sheets of which loops are rims.
    pub(super) sheets: &'a [Option<DVec3>],
    /// The unit direction in which the surface would go on beyond a half-edge.
    pub(super) outward: &'a dyn Fn(u32) -> DVec3,
}

/// Two loops that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RimPair {
    pub(super) inner: usize,
    pub(super) outer: usize,
    /// They run the same way, so that one of their parts has to turn.
    pub(super) run_alike: bool,
}

impl Rims<'_> {
    /// For each loop the larger one that it shares a patch with. Loops that are islands in a plane, or hold one, have none.
    pub(super) fn partners(
        &self,
        in_plane: &[Option<usize>],
        budget: &Budget,
    ) -> Result<Vec<Option<usize>>, Stopped> {
        let mut is_free: Vec<bool> = in_plane.iter().map(Option::is_none).collect();
        for &outer in in_plane.iter().flatten() {
            is_free[outer] = false;
        }
        let mut partner = vec![None; self.shapes.len()];
        for pair in self.pairs(is_free, |[inner, outer]| !self.run_alike(inner, outer), budget)? {
            partner[pair.inner] = Some(pair.outer);
        }
        Ok(partner)
    }

    /// Loops of different parts that would belong together if one of the parts turned, and those that do as they are; `part` tells of
    /// which part a loop is.
    pub(super) fn pairs_of_parts(
        &self,
        part: impl Fn(usize) -> u32,
        budget: &Budget,
    ) -> Result<Vec<RimPair>, Stopped> {
        let are_apart = |[inner, outer]: [usize; 2]| part(inner) != part(outer);
        self.pairs(vec![true; self.shapes.len()], are_apart, budget)
    }

    /// Pairs of free loops that belong together and `may`: loops that face each other and lips of two skins first, then rims of sheets
    /// that are left. A loop may be the larger one of several pairs but for those of sheets.
    fn pairs(
        &self,
        mut is_free: Vec<bool>,
        may: impl Fn([usize; 2]) -> bool,
        budget: &Budget,
    ) -> Result<Vec<RimPair>, Stopped> {
        let mut pairs = Vec::new();
        let mut is_inner = vec![false; self.shapes.len()];
        let order = self.by_area(|i| is_free[i] && self.shapes[i].area > 0.0);
        for (rank, &inner) in order.iter().enumerate() {
            budget.spend(rank as u64 / 16 + 1)?;
            let mut best: Option<(f64, usize)> = None;
            for &outer in order[..rank].iter().filter(|&&outer| !is_inner[outer] && may([inner, outer])) {
                if let Some(cos) = self.facing(inner, outer, budget)?
                    && best.is_none_or(|best| cos > best.0)
                {
                    best = Some((cos, outer));
                }
            }
            if let Some((_, outer)) = best {
                is_inner[inner] = true;
                pairs.push(RimPair { inner, outer, run_alike: self.run_alike(inner, outer) });
            }
        }
        for pair in &pairs {
            (is_free[pair.inner], is_free[pair.outer]) = (false, false);
        }
        // Sheets that look away from each other first, then those that are nearest.
        let mut found = Vec::new();
        let order = self.by_area(|i| is_free[i] && self.sheets[i].is_some());
        for (rank, &inner) in order.iter().enumerate() {
            budget.spend(rank as u64 / 16 + 1)?;
            for &outer in order[..rank].iter().filter(|&&outer| may([inner, outer])) {
                if let Some((looks_in, gap)) = self.back_to_back(inner, outer, budget)? {
                    found.push((looks_in, gap, inner, outer));
                }
            }
        }
        found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then((a.2, a.3).cmp(&(b.2, b.3))));
        for (_, _, inner, outer) in found {
            if is_free[inner] && is_free[outer] {
                (is_free[inner], is_free[outer]) = (false, false);
                pairs.push(RimPair { inner, outer, run_alike: self.run_alike(inner, outer) });
            }
        }
        Ok(pairs)
    }

    /// The loops that are `wanted`, the largest first; none where there are too many.
    fn by_area(&self, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.shapes.len()).filter(|&i| wanted(i)).collect();
        if order.len() > LOOPS_MAX {
            return Vec::new();
        }
        let area = |i: usize| self.shapes[i].area;
        order.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
        order
    }

    /// True when the loops run the same way around.
    fn run_alike(&self, inner: usize, outer: usize) -> bool {
        self.shapes[inner].normal.dot(self.shapes[outer].normal) > 0.0
    }

    /// How well the loops face each other, as a cosine, if they do, or are the lips of two skins; where they run alike, once one of
    /// their parts has turned.
    fn facing(&self, inner: usize, outer: usize, budget: &Budget) -> Result<Option<f64>, Stopped> {
        let [a, b] = [inner, outer].map(|i| &self.shapes[i]);
        if !are_near(a, b) {
            return Ok(None);
        }
        budget.spend(((a.points.len() + b.points.len()) * SAMPLES) as u64)?;
        let outward = |of: usize| move |side: usize| (self.outward)(self.loops[of][side]);
        let ([cos_a, gap_a], [cos_b, gap_b]) =
            (cosine_and_gap(a, b, outward(inner)), cosine_and_gap(b, a, outward(outer)));
        let gap = gap_a.max(gap_b);
        let size = b.bounds.diagonal();
        let cos = cos_a.min(cos_b);
        let are_lips = || {
            let [lift_a, lift_b] = [lift(a, outward(inner)), lift(b, outward(outer))];
            // The normals of loops that run against each other do so too.
            let one_way = (lift_a * lift_b < 0.0) != self.run_alike(inner, outer);
            gap <= LIP_GAP_SHARE_MAX * size && lift_a.abs().min(lift_b.abs()) >= LIP_COS_MIN && one_way
        };
        let belong = gap <= GAP_SHARE_MAX * size && cos >= FACING_COS_MIN || are_lips();
        Ok(belong.then_some(cos))
    }

    /// Whether two flat sheets back to back look at each other, as where they are inside out, and the gap between their rims, both outer
    /// rims or both rims of holes; where they run alike, once one of the sheets has turned.
    fn back_to_back(
        &self,
        inner: usize,
        outer: usize,
        budget: &Budget,
    ) -> Result<Option<(bool, f64)>, Stopped> {
        let [a, b] = [inner, outer].map(|i| &self.shapes[i]);
        let (Some(sheet_a), Some(sheet_b)) = (self.sheets[inner], self.sheets[outer]) else {
            return Ok(None);
        };
        if a.area < SHEET_AREA_SHARE_MIN * b.area || !are_near(a, b) {
            return Ok(None);
        }
        let is_hole = |shape: &LoopPolyline, sheet: DVec3| shape.normal.dot(sheet) > 0.0;
        let way = (b.bounds.min + b.bounds.max - a.bounds.min - a.bounds.max).normalize_or_zero();
        let [look_a, look_b] = [sheet_a, sheet_b].map(|sheet| sheet.dot(way));
        let runs_alike = self.run_alike(inner, outer);
        let are_opposite = (look_a * look_b < 0.0) != runs_alike;
        let look_along = look_a.abs().min(look_b.abs()) >= SHEET_LOOKS_MIN;
        if is_hole(a, sheet_a) != is_hole(b, sheet_b) || !look_along || !are_opposite {
            return Ok(None);
        }
        budget.spend(((a.points.len() + b.points.len()) * SAMPLES) as u64)?;
        let [gap_a, gap_b] = [(a, b), (b, a)].map(|(from, to)| cosine_and_gap(from, to, |_| DVec3::ZERO)[1]);
        let gap = gap_a.max(gap_b);
        let is_near = gap <= SHEET_GAP_SHARE_MAX * b.bounds.diagonal();
        Ok(is_near.then_some((!runs_alike && look_a > 0.0, gap)))
    }
}

/// True when the boxes are no farther apart than a gap may be, and the loops run with or against each other.
fn are_near(inner: &LoopPolyline, outer: &LoopPolyline) -> bool {
    let apart =
        (outer.bounds.min - inner.bounds.max).max(inner.bounds.min - outer.bounds.max).max(DVec3::ZERO);
    apart.length() <= GAP_SHARE_MAX * outer.bounds.diagonal()
        && inner.normal.dot(outer.normal).abs() >= AGAINST_COS_MIN
}

/// The mean cosine between where the surface would go on from the sides of a loop, by their number, and the nearest place on the
/// other one, and the mean distance of that.
fn cosine_and_gap(from: &LoopPolyline, to: &LoopPolyline, outward: impl Fn(usize) -> DVec3) -> [f64; 2] {
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
    [cos / count, gap / count]
}

/// The mean cosine between the normal of a loop and where the surface would go on from its sides, by their number.
fn lift(shape: &LoopPolyline, outward: impl Fn(usize) -> DVec3) -> f64 {
    let n = shape.points.len();
    let sides = (0..n).step_by(n.div_ceil(SAMPLES));
    let count = sides.clone().count() as f64;
    sides.map(|side| outward(side).dot(shape.normal)).sum::<f64>() / count
}
