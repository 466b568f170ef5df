//! Numbers known up to an error: the f64 filter of the predicates on points that are not input vertices.
//!
//! A [`Ball`] holds a true number within `rad` of `mid`. With `u = 2^-53`, a rounded sum, product or quotient `x` is
//! within `u |x|` of the exact one of the midpoints, products and quotients that underflow within a further `2^-1074`. The radius
//! adds what the radii of the operands contribute; it is itself computed with at most eight roundings of positive terms,
//! each a factor of at least `1 - u`, which [`GROWTH`] outweighs, and a few underflows, which [`TINY`] outweighs. Overflow
//! makes the radius infinite or NaN, and then no sign is told.

use crate::geom::Sign;
use std::ops::{Add, Mul, Sub};

const UNIT: f64 = f64::EPSILON / 2.0;
const GROWTH: f64 = 1.0 + 16.0 * f64::EPSILON;
/// `2^-1060`.
const TINY: f64 = f64::from_bits(1 << 14);

/// A number within `rad` of `mid`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ball {
    pub(super) mid: f64,
    pub(super) rad: f64,
}

impl Ball {
    /// Nothing is known.
    pub(super) const UNKNOWN: Self = Self { mid: 0.0, rad: f64::INFINITY };

    /// Exactly `x`.
    pub(super) fn exactly(x: f64) -> Self {
        Self { mid: x, rad: 0.0 }
    }

    /// The sign, where it is certain and not zero.
    #[inline]
    pub(super) fn sign(self) -> Option<Sign> {
        if self.mid > self.rad {
            Some(Sign::Positive)
        } else if -self.mid > self.rad {
            Some(Sign::Negative)
        } else {
            None
        }
    }

    /// This number divided by `other`; unknown when that may be zero.
    pub(super) fn over(self, other: Self) -> Self {
        let least = (other.mid.abs() - other.rad) * (1.0 - 4.0 * f64::EPSILON);
        if least.is_nan() || least <= 0.0 {
            return Self::UNKNOWN;
        }
        let mid = self.mid / other.mid;
        // |a / b - A / B| <= (|a - A| + |a / b| |b - B|) / |B|.
        let size = mid.abs() * GROWTH + TINY;
        let rad = ((self.rad + size * other.rad) / least + mid.abs() * UNIT) * GROWTH + TINY;
        Self { mid, rad }
    }

    /// True unless the numbers are certainly different.
    #[inline]
    pub(super) fn may_equal(self, other: Self) -> bool {
        (self - other).sign().is_none()
    }
}

impl Add for Ball {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let mid = self.mid + other.mid;
        Self { mid, rad: (self.rad + other.rad + mid.abs() * UNIT) * GROWTH }
    }
}

impl Sub for Ball {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        let mid = self.mid - other.mid;
        Self { mid, rad: (self.rad + other.rad + mid.abs() * UNIT) * GROWTH }
    }
}

impl Mul for Ball {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let mid = self.mid * other.mid;
        let spread = self.mid.abs() * other.rad + self.rad * other.mid.abs() + self.rad * other.rad;
        Self { mid, rad: (spread + mid.abs() * UNIT) * GROWTH + TINY }
    }
}

/// The cross product of two vectors.
pub(super) fn cross(a: [Ball; 3], b: [Ball; 3]) -> [Ball; 3] {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// The scalar product of two vectors.
pub(super) fn dot(a: [Ball; 3], b: [Ball; 3]) -> Ball {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a - b` by coordinates.
pub(super) fn minus(a: [Ball; 3], b: [Ball; 3]) -> [Ball; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
