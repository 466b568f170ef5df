//! On which side of a line or a plane a point lies, exactly, for all finite coordinates.
//!
//! # Why the filters never lie
//! Let `e = 2^-53`. A rounded sum, difference or product is the true one times `1 + d` with `|d| <= e`; sums and
//! differences of f64 have no other error, products that underflow have a further absolute error of at most
//! `2^-1075`. Nothing here is fused, so the count of roundings is the count of operators.
//!
//! *Three dimensions.* `u = b - a`, `v = c - a`, `w = d - a`, `n = u x v`, `det = (w0 n0 + w1 n1) + w2 n2`. A product
//! inside `n` has three roundings (two differences and itself), a component of `n` one more, its product with `w` two
//! more, the sum at most two more: eight. So without underflow `|det - true| <= ((1 + e)^8 - 1) P` with
//! `P = sum |w_k| (|u_i v_j| + |u_j v_i|)`. The computed `P` has the same eight roundings, all of positive terms, so it
//! is at least `(1 - e)^8 P`, and `9 e` times it, rounded, is still larger than the error. Underflow adds at most
//! `2^-1075` for each of the six products in `n`, times `|w_k|`, and for each of the three outer ones; together less
//! than `(1 + |w0| + |w1| + |w2|) 2^-1072`, and it lowers the computed `P` by no more than that. The slack of
//! `(1 + |w0| + |w1| + |w2|) 2^-1000` covers both.
//!
//! *Two dimensions.* The same with four roundings: `5 e` times the sum of the two products, and `2^-1000`.
//!
//! *Overflow.* If any intermediate is infinite or NaN, so is the bound, and no comparison with it succeeds.
//!
//! What a filter cannot decide goes to [`super::exact`], which decides everything. As every answer is the sign of the
//! true determinant, the predicates are antisymmetric and consistent under every permutation.

use super::{DVec2, DVec3, Sign, exact};

/// `2^-53`, the largest relative error of one rounding.
const ROUNDING: f64 = f64::EPSILON / 2.0;
const BOUND_2D: f64 = 5.0 * ROUNDING;
const BOUND_3D: f64 = 9.0 * ROUNDING;
/// `2^-1000`; see the module's analysis of underflow.
const UNDERFLOW: f64 = f64::from_bits(23 << 52);

/// The sign that `value` shows beyond `error`, unless it is too close to zero. NaN shows none.
#[inline]
fn beyond(value: f64, error: f64) -> Option<Sign> {
    if value > error {
        Some(Sign::Positive)
    } else if -value > error {
        Some(Sign::Negative)
    } else {
        None
    }
}

/// Sign of `det(b - a, c - a)`: positive when `a`, `b`, `c` turn counter-clockwise, zero when they are collinear.
#[inline]
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    let left = (b.x - a.x) * (c.y - a.y);
    let right = (b.y - a.y) * (c.x - a.x);
    let error = BOUND_2D * (left.abs() + right.abs()) + UNDERFLOW;
    beyond(left - right, error).unwrap_or_else(|| exact::orient2d([a, b, c]))
}

/// How a triangle turns along the three coordinate axes as far as f64 is certain: bit `2 k` is set when its normal has a
/// positive component `k`, bit `2 k + 1` when it has a negative one, neither when it may be zero.
#[inline]
pub fn certain_turns(corners: [DVec3; 3]) -> u8 {
    let ThreePointPlane { normal, spread, .. } = ThreePointPlane::through(corners);
    (0..3).fold(0, |turns, k| {
        let error = BOUND_2D * spread[k] + UNDERFLOW;
        let (is_positive, is_negative) = (normal[k] > error, -normal[k] > error);
        turns | u8::from(is_positive) << (2 * k) | u8::from(is_negative) << (2 * k + 1)
    })
}

/// Sign of `det(b - a, c - a, d - a)`: positive when `d` is on the side from which `a`, `b`, `c` are seen
/// counter-clockwise, zero when the four are coplanar.
#[inline]
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    ThreePointPlane::through([a, b, c]).side(d)
}

/// The plane through three points, prepared for many questions. The points may be collinear; then every side is zero.
#[derive(Debug, Clone, Copy)]
pub struct ThreePointPlane {
    corners: [DVec3; 3],
    normal: [f64; 3],
    /// Sums of the magnitudes that each component of `normal` is the difference of.
    spread: [f64; 3],
}

impl ThreePointPlane {
    /// The plane through `corners`; its positive side is the one from which they are seen counter-clockwise.
    #[inline]
    pub fn through(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let [u0, u1, u2] = [b.x - a.x, b.y - a.y, b.z - a.z];
        let [v0, v1, v2] = [c.x - a.x, c.y - a.y, c.z - a.z];
        let plus = [u1 * v2, u2 * v0, u0 * v1];
        let minus = [u2 * v1, u0 * v2, u1 * v0];
        Self {
            corners,
            normal: std::array::from_fn(|k| plus[k] - minus[k]),
            spread: std::array::from_fn(|k| plus[k].abs() + minus[k].abs()),
        }
    }

    /// The points the plane was made of.
    #[inline]
    pub fn corners(&self) -> [&DVec3; 3] {
        self.corners.each_ref()
    }

    /// The side of `point`: the sign of `orient3d(corners, point)`.
    #[inline]
    pub fn side(&self, point: DVec3) -> Sign {
        let [a, b, c] = self.corners;
        let [w0, w1, w2] = [point.x - a.x, point.y - a.y, point.z - a.z];
        let [n0, n1, n2] = self.normal;
        let [s0, s1, s2] = self.spread;
        let det = w0 * n0 + w1 * n1 + w2 * n2;
        let [w0, w1, w2] = [w0.abs(), w1.abs(), w2.abs()];
        let error = BOUND_3D * (w0 * s0 + w1 * s1 + w2 * s2) + UNDERFLOW * (1.0 + w0 + w1 + w2);
        beyond(det, error).unwrap_or_else(|| exact::orient3d([a, b, c, point]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TINY: f64 = f64::from_bits(1);

    #[test]
    fn the_side_from_which_the_corners_turn_counter_clockwise_is_positive() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        assert_eq!(orient3d(DVec3::ZERO, x, y, z), Sign::Positive);
        assert_eq!(orient3d(DVec3::ZERO, x, y, -z), Sign::Negative);
        assert_eq!(orient3d(DVec3::ZERO, x, y, x + y), Sign::Zero);
        assert_eq!(orient2d(DVec2::ZERO, DVec2::X, DVec2::Y), Sign::Positive);
        assert_eq!(orient2d(DVec2::ZERO, DVec2::Y, DVec2::X), Sign::Negative);
    }

    #[test]
    fn turns_are_told_where_they_are_certain() {
        let turns = |a, b, c| certain_turns([a, b, c]);
        assert_eq!(turns(DVec3::ZERO, DVec3::X, DVec3::Y), 0b01_00_00);
        assert_eq!(turns(DVec3::ZERO, DVec3::Y, DVec3::X), 0b10_00_00);
        assert_eq!(turns(DVec3::X, DVec3::Y, DVec3::Z), 0b01_01_01);
        assert_eq!(turns(DVec3::ZERO, DVec3::X * TINY, DVec3::Y * TINY), 0);
        assert_eq!(turns(DVec3::MIN, DVec3::MAX, DVec3::X), 0);
    }

    #[test]
    fn products_that_underflow_are_not_taken_for_zero() {
        let far = 2f64.powi(500);
        // All products of the small coordinates are 0 in f64, yet the tetrahedron has a volume.
        let tetrahedron = |s: f64, z: f64| [DVec3::ZERO, DVec3::X * s, DVec3::Y * s, DVec3::new(0.0, 0.0, z)];
        for (s, z) in [(1e-200, 1e-200), (1e-200, far), (TINY, TINY), (TINY, f64::MAX)] {
            let [a, b, c, d] = tetrahedron(s, z);
            assert_eq!(orient3d(a, b, c, d), Sign::Positive, "{s} {z}");
            assert_eq!(orient3d(a, c, b, d), Sign::Negative, "{s} {z}");
        }
        assert_eq!(orient2d(DVec2::ZERO, DVec2::X * TINY, DVec2::Y * TINY), Sign::Positive);
    }

    #[test]
    fn differences_and_products_that_overflow_are_decided() {
        let m = f64::MAX;
        let [a, b, c, d] = [[-m, -m, -m], [m, -m, -m], [-m, m, -m], [-m, -m, m]].map(DVec3::from_array);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
        assert_eq!(orient3d(b, a, c, d), Sign::Negative);
        assert_eq!(orient3d(a, b, c, DVec3::new(m, m, -m)), Sign::Zero);
        assert_eq!(orient2d(DVec2::splat(-m), DVec2::new(m, -m), DVec2::splat(m)), Sign::Positive);
    }

    #[test]
    fn huge_and_tiny_coordinates_mix() {
        let small = 1e-200;
        let [a, b, c] = [DVec3::ZERO, DVec3::new(1.0, 0.0, small), DVec3::new(0.0, 1.0, small)];
        assert_eq!(orient3d(a, b, c, DVec3::new(1.0, 1.0, 2.0 * small)), Sign::Zero);
        assert_eq!(orient3d(a, b, c, DVec3::new(1.0, 1.0, 2.1 * small)), Sign::Positive);
        assert_eq!(orient3d(a, b, c, DVec3::new(1.0, 1.0, 1.9 * small)), Sign::Negative);
    }
}
