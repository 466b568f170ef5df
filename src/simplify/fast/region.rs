//! Which part of space belongs to which part of the mesh.
//!
//! The code of a cell never falls when a coordinate grows. So when both corners of a box, the one with the smallest and
//! the one with the largest coordinates, have codes between those of the neighbouring parts, all of the box has.

use crate::geom::Aabb;
use crate::simplify::order::Curve;

/// The space whose codes are between those of the parts before and after: no two parts have a point in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct CodeRegion {
    pub(super) curve: Curve,
    /// The last code of the part before.
    pub(super) after: Option<u32>,
    /// The first code of the part behind.
    pub(super) before: Option<u32>,
}

impl CodeRegion {
    /// True when all of the box is in the region.
    #[inline]
    pub(super) fn holds(&self, bounds: Aabb) -> bool {
        self.after.is_none_or(|code| self.curve.code(bounds.min) > code)
            && self.before.is_none_or(|code| self.curve.code(bounds.max) < code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    #[test]
    fn a_box_in_a_region_has_all_its_points_there() {
        let curve = Curve::over(Aabb::of([DVec3::ZERO, DVec3::splat(16.0)]), DVec3::new(0.3, 0.0, 0.9));
        let mut state = 1u64;
        let mut number = move |below: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * below
        };
        let mut inside = 0;
        for _ in 0..2_000 {
            let mut point = |size: f64| DVec3::new(number(size), number(size), number(size));
            let codes = [point(16.0), point(16.0)].map(|p| curve.code(p));
            let region = CodeRegion {
                curve,
                after: Some(codes[0].min(codes[1])),
                before: Some(codes[0].max(codes[1])),
            };
            let min = point(16.0);
            let bounds = Aabb { min, max: min + point(2.0) };
            if region.holds(bounds) {
                inside += 1;
                for _ in 0..20 {
                    let p = bounds.min + point(1.0) * (bounds.max - bounds.min);
                    let code = curve.code(p);
                    assert!(region.after < Some(code) && Some(code) < region.before);
                }
            }
        }
        assert!(inside > 100, "{inside}");
    }
}
