//! The first wall that a ray meets.

use super::surface::WeldedSurface;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::spatial::Bvh;

/// A ray from a place on the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    pub(super) from: DVec3,
    /// Of length 1.
    pub(super) along: DVec3,
    /// The triangle that it starts on, which it does not meet.
    pub(super) own: u32,
    /// True when it meets walls from inside, at their backs; false: from outside.
    pub(super) is_inside: bool,
}

/// What a ray met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    pub(super) triangle: u32,
    pub(super) distance: f64,
}

/// Shares of the diagonal at which the search looks up: most walls are thin, and the boxes along a whole ray are many.
const REACHES: [f64; 4] = [1.0 / 128.0, 1.0 / 16.0, 1.0 / 3.0, 1.01];

impl Ray {
    /// The closest wall that faces the ray in the way it looks for, of several at one distance the first triangle; and the
    /// number of triangles that were looked at.
    pub(super) fn first_hit(
        &self,
        surface: &WeldedSurface<'_>,
        bvh: &Bvh,
        budget: &Budget,
    ) -> Result<(Option<Hit>, u64), Stopped> {
        let (u, v) = self.along.any_orthonormal_pair();
        let axes = [u, v, self.along];
        let mut near = 0.0;
        let (mut best, mut looked_at): (Option<Hit>, u64) = (None, 0);
        for reach in REACHES.map(|share| share * surface.diagonal()) {
            let segment = [near, reach].map(|distance| self.from + self.along * distance);
            bvh.visit_segment(segment, budget, |t| {
                looked_at += 1;
                let may_be_met = t != self.own && self.faces(surface.normals[t as usize]);
                let crossed = may_be_met.then(|| crossing(self.from, axes, surface.corners(t))).flatten();
                if let Some(hit) = crossed.map(|distance| Hit { triangle: t, distance }) {
                    best = Some(best.filter(|best| !hit.is_before(best)).unwrap_or(hit));
                }
                true
            })?;
            if best.is_some_and(|hit| hit.distance <= reach) {
                return Ok((best, looked_at));
            }
            near = reach;
        }
        Ok((best, looked_at))
    }

    fn faces(&self, normal: DVec3) -> bool {
        let cosine = normal.dot(self.along);
        if self.is_inside { cosine > 0.0 } else { cosine < 0.0 }
    }
}

impl Hit {
    fn is_before(&self, other: &Self) -> bool {
        self.distance.total_cmp(&other.distance).then(self.triangle.cmp(&other.triangle)).is_lt()
    }
}

/// How far along the last of the `axes` the triangle is met, at 0 or more. Two triangles that share an edge leave no gap
/// between them (Woop, Benthin and Wald 2013): a corner has the same coordinates in both, so that the turns about the
/// edge are exactly opposite.
fn crossing(from: DVec3, axes: [DVec3; 3], corners: [DVec3; 3]) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| axes.map(|axis| (corner - from).dot(axis)));
    let turn = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
    let weights = [turn(b, c), turn(c, a), turn(a, b)];
    if weights.iter().any(|&w| w < 0.0) && weights.iter().any(|&w| w > 0.0) {
        return None;
    }
    let sum: f64 = weights.iter().sum();
    let distance = (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) / sum;
    // Not a number where the triangle is seen edge on.
    (distance >= 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];

    #[test]
    fn a_triangle_is_met_on_its_border_and_behind_the_start_never() {
        let corners = [DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.0, 2.0), DVec3::new(0.0, 1.0, 2.0)];
        assert_eq!(crossing(DVec3::new(0.25, 0.25, 0.0), AXES, corners), Some(2.0));
        assert_eq!(crossing(DVec3::new(0.5, 0.5, 0.5), AXES, corners), Some(1.5), "on an edge");
        assert_eq!(crossing(DVec3::new(0.6, 0.6, 0.0), AXES, corners), None);
        assert_eq!(crossing(DVec3::new(0.25, 0.25, 3.0), AXES, corners), None);
    }

    #[test]
    fn a_triangle_along_the_ray_is_not_met() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 0.0, 1.0)];
        assert_eq!(crossing(DVec3::new(0.5, 0.0, -1.0), AXES, corners), None);
    }
}
