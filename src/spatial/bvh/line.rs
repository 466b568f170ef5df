//! A segment against boxes.

use super::Box32;
use super::frame::Frame;
use crate::geom::DVec3;

/// A segment in the coordinates of the boxes, without their rounding.
#[derive(Debug)]
pub(super) struct Line {
    from: DVec3,
    /// Reciprocals of what it extends along each axis.
    reciprocal: DVec3,
}

/// More than the rounding of a coordinate to f32 can move it, in relation to its magnitude.
const BOX_ROUNDING: f64 = 1e-6;

impl Line {
    pub(super) fn new(frame: &Frame, [from, to]: [DVec3; 2]) -> Self {
        let [from, to] = [from, to].map(|p| frame.unrounded(p));
        Self { from, reciprocal: (to - from).recip() }
    }

    /// False only when the segment misses everything that the box holds (slabs, Kay and Kajiya 1986). Out of the range of
    /// numbers it is always true.
    pub(super) fn may_meet(&self, bounds: &Box32) -> bool {
        let (mut enters, mut leaves) = (0.0f64, 1.0f64);
        for k in 0..3 {
            let (min, max) = (f64::from(bounds.min[k]), f64::from(bounds.max[k]));
            let slack = BOX_ROUNDING * min.abs().max(max.abs());
            let (a, b) = (
                (min - slack - self.from[k]) * self.reciprocal[k],
                (max + slack - self.from[k]) * self.reciprocal[k],
            );
            // What is not a number, where the segment runs along a side of the box, does not count.
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
            Line::new(&Frame::UNIT, [from, to].map(DVec3::from_array)).may_meet(&bounds)
        };
        assert!(meets([0.0; 3], [3.0; 3]));
        assert!(meets([1.5, 2.0, 2.0], [1.6, 2.0, 2.0]), "inside");
        assert!(meets([0.0, 1.0, 1.0], [5.0, 1.0, 1.0]), "along an edge");
        assert!(!meets([0.0; 3], [0.9; 3]), "ends before it");
        assert!(!meets([0.0, 0.0, 0.0], [5.0, 0.0, 0.0]), "beside it");
        assert!(!meets([0.0, 3.0, 0.0], [3.0, 5.0, 4.0]), "past a corner");
    }
}
