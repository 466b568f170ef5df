//! A segment against boxes.

use super::Box32;
use super::frame::Frame;
use crate::geom::DVec3;

/// A segment in the coordinates of the boxes, without their rounding.
#[derive(Debug)]
pub(super) struct BoxSegment {
    from: DVec3,
    /// Reciprocals of what it extends along each axis.
    reciprocal: DVec3,
    /// How far `from` may be from where it should be, along each axis, and a box from the numbers that f32 has near zero.
    rounding: DVec3,
}

/// More than the rounding of a coordinate to f32 can move it, in relation to its magnitude.
const BOX_ROUNDING: f64 = 1e-6;

/// More than the rounding of the few operations on a coordinate in f64 can move it, in relation to its magnitude.
const ROUNDING: f64 = 4e-15;

/// More than half the smallest number of f32: what is nearer to zero is zero in a box.
const SMALLEST: f64 = 1e-44;

/// Coordinates of a box beyond about the largest number of f32 are not those of what it holds.
const LARGEST: f64 = 1e38;

impl BoxSegment {
    pub(super) fn new(frame: &Frame, [from, to]: [DVec3; 2]) -> Self {
        let [from, to] = [from, to].map(|p| frame.unrounded(p));
        let is_in_range = from.abs().max(to.abs()).max_element() < LARGEST;
        let reciprocal = if is_in_range { (to - from).recip() } else { DVec3::NAN };
        Self { from, reciprocal, rounding: from.abs() * ROUNDING + SMALLEST }
    }

    /// False only when the segment misses everything that the box holds (slabs, Kay and Kajiya 1986). Out of the range of
    /// numbers it is always true.
    pub(super) fn may_meet(&self, bounds: &Box32) -> bool {
        let (mut enters, mut leaves) = (0.0f64, 1.0f64);
        for k in 0..3 {
            let (min, max) = (f64::from(bounds.min[k]), f64::from(bounds.max[k]));
            let slack = BOX_ROUNDING * min.abs().max(max.abs()) + self.rounding[k];
            let (a, b) = (
                (min - slack - self.from[k]) * self.reciprocal[k],
                (max + slack - self.from[k]) * self.reciprocal[k],
            );
            // Neither is a number, and neither counts, where the segment runs within a box without extent.
            enters = enters.max(a.min(b));
            leaves = leaves.min(a.max(b));
        }
        leaves.is_nan() || enters <= leaves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_meets_the_boxes_that_it_goes_through() {
        let bounds = Box32 { min: [1.0, 1.0, 1.0], max: [2.0, 3.0, 4.0] };
        let meets = |from: [f64; 3], to: [f64; 3]| {
            BoxSegment::new(&Frame::UNIT, [from, to].map(DVec3::from_array)).may_meet(&bounds)
        };
        assert!(meets([0.0; 3], [3.0; 3]));
        assert!(meets([1.5, 2.0, 2.0], [1.6, 2.0, 2.0]), "inside");
        assert!(meets([0.0, 1.0, 1.0], [5.0, 1.0, 1.0]), "along an edge");
        assert!(!meets([0.0; 3], [0.9; 3]), "ends before it");
        assert!(!meets([0.0, 0.0, 0.0], [5.0, 0.0, 0.0]), "beside it");
        assert!(!meets([0.0, 3.0, 0.0], [3.0, 5.0, 4.0]), "past a corner");
    }

    #[test]
    fn a_segment_meets_the_boxes_of_points_on_it_at_every_scale() {
        let meets = |from: DVec3, to: DVec3, p: DVec3| {
            let at = p.to_array().map(|x| (x as f32).clamp(f32::MIN, f32::MAX));
            BoxSegment::new(&Frame::UNIT, [from, to]).may_meet(&Box32 { min: at, max: at })
        };
        // Beyond f32, nearer to zero than f32, and where one coordinate of the point is zero.
        for (from, to) in [
            (DVec3::new(-1e300, -3e300, 1e299), DVec3::new(3e300, 1e300, 3e299)),
            (DVec3::new(0.0, 1.0, 2.0), DVec3::new(1e-50, 3.0, 4.0)),
            (DVec3::new(-1.0 / 3.0, 0.1, 0.7), DVec3::new(1.0 / 3.0, 1e-9, 0.7 + 1e-9)),
            (DVec3::new(-7.0, 1.0, 1.0), DVec3::new(7.0, 1.0, 1e-7)),
        ] {
            assert!(meets(from, to, from * 0.5 + to * 0.5), "{from} {to}");
        }
        assert!(!meets(DVec3::ZERO, DVec3::ONE, DVec3::new(0.5, 0.5, 0.6)), "a point beside it");
    }
}
