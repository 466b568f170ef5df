//! A long thin triangle against boxes: its own box is mostly empty and meets too many.

use super::Box32;
use super::frame::Frame;
use crate::geom::DVec3;

/// A triangle in the coordinates of the boxes, without their rounding.
#[derive(Debug)]
pub(in crate::spatial) struct Sliver {
    corners: [DVec3; 3],
    /// Directions in which a box can be separated from the triangle, beside the coordinate axes: across each edge as
    /// seen along each axis, and square to the triangle.
    axes: [DVec3; 10],
    /// What is this near, in each coordinate, counts as met.
    reach: f64,
}

/// More than the rounding of a coordinate to f32 can move it, in relation to its magnitude.
const BOX_ROUNDING: f64 = 1e-6;

/// More than the relative error of the few f64 operations behind a comparison.
const ROUNDING: f64 = 1e-14;

impl Sliver {
    pub(in crate::spatial) fn new(frame: &Frame, corners: [&DVec3; 3]) -> Self {
        let corners = corners.map(|p| frame.unrounded(*p));
        let [a, b, c] = corners;
        let [u, v, w] = [b - a, c - b, a - c];
        let across =
            |e: DVec3| [DVec3::new(0.0, -e.z, e.y), DVec3::new(e.z, 0.0, -e.x), DVec3::new(-e.y, e.x, 0.0)];
        let [[u0, u1, u2], [v0, v1, v2], [w0, w1, w2]] = [across(u), across(v), across(w)];
        Self { corners, axes: [u0, u1, u2, v0, v1, v2, w0, w1, w2, u.cross(v)], reach: 0.0 }
    }

    /// The same triangle, which also meets what is at most `reach` away from it in each coordinate of the boxes.
    pub(in crate::spatial) fn with_reach(self, reach: f64) -> Self {
        Self { reach, ..self }
    }

    /// False only when the triangle misses everything that the box holds (separating axes, Gottschalk 1996, beside
    /// those of the boxes). Out of the range of numbers it is always true.
    pub(in crate::spatial) fn may_meet(&self, bounds: &Box32) -> bool {
        let (min, max) = (bounds.min.map(f64::from), bounds.max.map(f64::from));
        let (min, max) = (DVec3::from_array(min), DVec3::from_array(max));
        if max.abs().max(min.abs()).max_element() >= f64::from(f32::MAX) {
            return true;
        }
        let center = (min + max) / 2.0;
        let half = (max - min) / 2.0
            + min.abs().max(max.abs()) * BOX_ROUNDING
            + (self.reach + f64::from(f32::MIN_POSITIVE));
        let [a, b, c] = self.corners.map(|p| p - center);
        let reach = half + (a.abs().max(b.abs()).max(c.abs())) * ROUNDING;
        !self.axes.iter().any(|axis| {
            let [a, b, c] = [a.dot(*axis), b.dot(*axis), c.dot(*axis)];
            // No product that underflows is off by more than the smallest normal number.
            let radius = reach.dot(axis.abs()) + f64::MIN_POSITIVE;
            a.min(b).min(c) > radius || a.max(b).max(c) < -radius
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small_box(x: f32, y: f32, z: f32) -> Box32 {
        Box32 { min: [x - 0.1, y - 0.1, z - 0.1], max: [x + 0.1, y + 0.1, z + 0.1] }
    }

    #[test]
    fn boxes_beside_a_diagonal_needle_are_missed_and_those_on_it_are_not() {
        let corners = [DVec3::ZERO, DVec3::splat(10.0), DVec3::new(10.0, 10.0, 9.9)];
        let sliver = Sliver::new(&Frame::UNIT, corners.each_ref());
        for i in 0..=10u8 {
            let x = f32::from(i);
            assert!(sliver.may_meet(&small_box(x, x, x)));
            assert!(!sliver.may_meet(&small_box(x + 0.3, x, x)));
            assert!(!sliver.may_meet(&small_box(x, x, x + 0.5)));
        }
        assert!(sliver.may_meet(&Box32 { min: [f32::MIN; 3], max: [f32::MAX; 3] }));
    }

    #[test]
    fn a_box_with_only_a_corner_on_the_triangle_is_not_missed() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let sliver = Sliver::new(&Frame::UNIT, corners.each_ref());
        assert!(sliver.may_meet(&Box32 { min: [0.5, 0.5, 0.0], max: [1.0; 3] }));
        assert!(sliver.may_meet(&Box32 { min: [-1.0; 3], max: [0.0; 3] }));
        assert!(!sliver.may_meet(&Box32 { min: [0.501, 0.501, 0.0], max: [1.0; 3] }));
    }
}
