//! Boxes in f32 that lose no meeting of boxes in f64.

use crate::geom::{Aabb, DVec3};

/// A closed axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::spatial) struct Box32 {
    pub(in crate::spatial) min: [f32; 3],
    pub(in crate::spatial) max: [f32; 3],
}

impl Box32 {
    /// The box of nothing.
    pub(in crate::spatial) const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// The box with both corners rounded to nearest.
    pub(in crate::spatial) fn around(bounds: Aabb) -> Self {
        Self { min: bounds.min.to_array().map(|x| x as f32), max: bounds.max.to_array().map(|x| x as f32) }
    }

    /// The smallest box around both.
    #[inline]
    pub(in crate::spatial) fn union(&self, other: &Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.min, other.min);
        let min = [smaller(a, d), smaller(b, e), smaller(c, f)];
        let ([a, b, c], [d, e, f]) = (self.max, other.max);
        Self { min, max: [larger(a, d), larger(b, e), larger(c, f)] }
    }

    /// True when the boxes have a point in common.
    #[inline]
    pub(in crate::spatial) fn meets(&self, other: &Self) -> bool {
        // Without short cuts: the six comparisons are cheaper than a branch that is guessed wrong.
        (0..3).fold(true, |meets, k| meets & (self.min[k] <= other.max[k]) & (other.min[k] <= self.max[k]))
    }

    /// The squared distance of the box from the point.
    #[inline]
    pub(in crate::spatial) fn squared_gap(&self, p: [f32; 3]) -> f32 {
        (0..3).fold(0.0, |sum, k| {
            let gap = larger(larger(self.min[k] - p[k], p[k] - self.max[k]), 0.0);
            sum + gap * gap
        })
    }

    pub(super) fn center(&self) -> [f32; 3] {
        std::array::from_fn(|k| self.min[k] * 0.5 + self.max[k] * 0.5)
    }
}

// Without the care for NaN that `f32::min` takes.
#[inline]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A map of each coordinate to f32: move, scale by a power of two, round to nearest, clamp to the finite range.
///
/// Every step keeps order (`x <= y` gives `map(x) <= map(y)`), so boxes that meet still meet after their corners are
/// mapped, whatever the rounding; nothing has to be rounded outward. Where the origin and the scale are chosen well,
/// far from zero or at extreme exponents, few other boxes meet.
#[derive(Debug, Clone, Copy)]
pub(in crate::spatial) struct Frame {
    origin: DVec3,
    scale: f64,
}

/// Points that the frame is chosen by.
const SAMPLES_MAX: usize = 31;

impl Frame {
    /// No move and no scale.
    pub(super) const UNIT: Self = Self { origin: DVec3::ZERO, scale: 1.0 };

    /// A frame for points of which `point_at` gives `count`. Medians decide, so a few stray points do not.
    pub(in crate::spatial) fn around(count: usize, point_at: impl Fn(usize) -> DVec3) -> Self {
        let samples = count.min(SAMPLES_MAX);
        let points: Vec<DVec3> = (0..samples).map(|i| point_at(i * count / samples)).collect();
        let origin = DVec3::from_array([0, 1, 2].map(|k| median(points.iter().map(|p| p[k]).collect())));
        let reaches: Vec<f64> = points.iter().map(|&p| (p - origin).abs().max_element()).collect();
        let largest = reaches.iter().copied().fold(0.0, f64::max);
        let typical = Some(median(reaches)).filter(|&reach| reach > 0.0).unwrap_or(largest);
        Self { origin, scale: reciprocal_power_of_two(typical) }
    }

    /// The mapped point before it is rounded to f32 and clamped.
    pub(super) fn unrounded(&self, p: DVec3) -> DVec3 {
        (p - self.origin) * self.scale
    }

    /// A length in the mapped coordinates.
    #[inline]
    pub(in crate::spatial) fn scaled(&self, length: f64) -> f64 {
        length * self.scale
    }

    #[inline]
    pub(in crate::spatial) fn map(&self, p: DVec3) -> [f32; 3] {
        let map =
            |x: f64, origin: f64| smaller(larger(((x - origin) * self.scale) as f32, f32::MIN), f32::MAX);
        [map(p.x, self.origin.x), map(p.y, self.origin.y), map(p.z, self.origin.z)]
    }

    /// The box of the mapped points. The map keeps order, so that only the corners of the box need to be mapped.
    #[inline]
    pub(in crate::spatial) fn box_of<const N: usize>(&self, points: [DVec3; N]) -> Box32 {
        let Aabb { min, max } = Aabb::of(points);
        Box32 { min: self.map(min), max: self.map(max) }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// A power of two that brings `reach` near 1; 1 for zero.
fn reciprocal_power_of_two(reach: f64) -> f64 {
    if reach == 0.0 {
        return 1.0;
    }
    let exponent = (reach.to_bits() >> 52) as i64 - 1023;
    f64::from_bits(((1023 - exponent.clamp(-1022, 1022)) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame_of(points: &[DVec3]) -> Frame {
        Frame::around(points.len(), |i| points[i])
    }

    #[test]
    fn the_map_keeps_order_and_stays_finite_at_every_scale() {
        let values =
            [-f64::MAX, -1e300, -1.0, -1e-200, 0.0, f64::from_bits(1), 1e-200, 1.0, 1.0 + f64::EPSILON];
        for points in [vec![], vec![DVec3::ZERO], values.map(DVec3::splat).to_vec(), vec![DVec3::MAX; 3]] {
            let frame = frame_of(&points);
            let mapped = values.map(|x| frame.map(DVec3::splat(x))[0]);
            assert!(mapped.is_sorted() && mapped.iter().all(|x| x.is_finite()), "{frame:?}: {mapped:?}");
        }
    }

    #[test]
    fn neighbours_stay_apart_far_from_zero_and_at_tiny_scales() {
        for (origin, step) in [(0.0, 1.0), (1e12, 1.0), (0.0, 1e-300), (0.0, 1e300), (-4e5, 1e-3)] {
            let points: Vec<DVec3> = (0..100).map(|i| DVec3::splat(origin + step * f64::from(i))).collect();
            let frame = frame_of(&points);
            for pair in points.windows(2) {
                assert!(frame.map(pair[0])[0] < frame.map(pair[1])[0], "{origin} {step}");
            }
        }
    }

    #[test]
    fn a_stray_point_does_not_coarsen_the_rest() {
        let mut points: Vec<DVec3> = (0..100).map(|i| DVec3::splat(f64::from(i) * 1e-100)).collect();
        points.push(DVec3::splat(1e100));
        let frame = frame_of(&points);
        assert!(frame.map(points[50])[0] < frame.map(points[51])[0]);
    }

    #[test]
    fn boxes_meet_when_they_have_a_point_in_common() {
        let unit = Box32 { min: [0.0; 3], max: [1.0; 3] };
        assert!(unit.meets(&Box32 { min: [1.0; 3], max: [2.0; 3] }));
        assert!(!unit.meets(&Box32 { min: [0.0, 0.0, 1.5], max: [2.0; 3] }));
        assert!(!unit.meets(&Box32::EMPTY));
    }
}
