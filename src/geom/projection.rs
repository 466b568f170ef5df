//! Exact questions about points in a plane or on a line, asked along a coordinate axis.

use super::{DVec2, DVec3, Sign, orient2d};

/// The view along a coordinate axis. The two coordinates that remain keep their cyclic order, so a triangle turns
/// counter-clockwise in the view exactly when its normal has a positive component along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisProjection {
    axis: usize,
}

impl AxisProjection {
    /// The three views: along x, y and z.
    pub const ALL: [Self; 3] = [Self { axis: 0 }, Self { axis: 1 }, Self { axis: 2 }];

    /// The view from above, along z.
    pub const ALONG_Z: Self = Self { axis: 2 };

    /// A view in which the triangle is not degenerate, and its turn there; `None` when the triangle is degenerate.
    ///
    /// The axis is chosen by the exact turn, not by the size of a rounded normal, which can point anywhere for a
    /// needle.
    pub fn showing([a, b, c]: [DVec3; 3]) -> Option<(Self, Sign)> {
        Self::ALL.into_iter().map(|view| (view, view.turn(a, b, c))).find(|(_, turn)| !turn.is_zero())
    }

    /// The two coordinates of `p` that are seen.
    #[inline]
    pub fn of(self, p: DVec3) -> DVec2 {
        match self.axis {
            0 => DVec2::new(p.y, p.z),
            1 => DVec2::new(p.z, p.x),
            _ => DVec2::new(p.x, p.y),
        }
    }

    /// How `a`, `b`, `c` turn in this view: positive counter-clockwise.
    #[inline]
    pub fn turn(self, a: DVec3, b: DVec3, c: DVec3) -> Sign {
        orient2d(self.of(a), self.of(b), self.of(c))
    }
}

/// True when the three points lie exactly on one line (or coincide).
pub fn are_collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    AxisProjection::showing([a, b, c]).is_none()
}

/// True when `p` lies exactly on the closed segment from `a` to `b`.
pub fn is_on_segment(p: DVec3, a: DVec3, b: DVec3) -> bool {
    let is_between = (0..3).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]));
    is_between && are_collinear(p, a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_shown_along_an_axis_that_its_plane_does_not_contain() {
        let vertical = [DVec3::ZERO, DVec3::Z, DVec3::X];
        let (view, turn) = AxisProjection::showing(vertical).unwrap();
        assert_eq!((view, turn), (AxisProjection::ALL[1], Sign::Positive));
    }

    #[test]
    fn points_one_unit_in_the_last_place_off_a_line_are_not_collinear() {
        let (a, b) = (DVec3::splat(0.1), DVec3::splat(0.3));
        assert!(are_collinear(a, b, DVec3::splat(0.7)));
        let off = f64::from_bits(0.7f64.to_bits() + 1);
        for k in 0..3 {
            let mut p = DVec3::splat(0.7);
            p[k] = off;
            assert!(!are_collinear(a, b, p), "axis {k}");
        }
        assert!(are_collinear(a, a, b));
    }

    #[test]
    fn a_segment_holds_its_ends_and_what_is_between() {
        let (a, b) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(3.0, 2.0, -1.0));
        assert!(is_on_segment(a, a, b) && is_on_segment(b, a, b));
        assert!(is_on_segment(DVec3::new(2.0, 2.0, 1.0), a, b));
        assert!(!is_on_segment(DVec3::new(4.0, 2.0, -3.0), a, b));
        assert!(!is_on_segment(DVec3::new(2.0, 2.0, 1.5), a, b));
    }
}
