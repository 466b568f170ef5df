//! Determinants of f64 coordinates without any rounding: the slow tiers behind the filters.
//!
//! Every finite f64 is an integer times a power of two. [`BitSpan`] finds the bits that a set of coordinates uses, and
//! the narrowest arithmetic that holds the determinant then evaluates it: small integers where differences are such
//! ([`differences`]), 128-bit integers, floating-point expansions (Shewchuk 1997, crate `robust`), or big integers.

use super::integers::decompose;
use super::{DVec2, DVec3, Sign, differences};
use num_bigint::BigInt;
use std::cell::Cell;
use std::ops::{Add, Mul, Sub};

/// The bits that a set of finite numbers uses: each is a multiple of `2^low` and smaller than `2^high` in magnitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BitSpan {
    low: i32,
    high: i32,
}

impl BitSpan {
    /// The span of zero alone.
    pub(crate) const ZERO: Self = Self { low: i32::MAX, high: i32::MIN };

    fn of(values: impl IntoIterator<Item = f64>) -> Self {
        values.into_iter().fold(Self::ZERO, Self::with)
    }

    /// The span that also holds `value`.
    pub(crate) fn with(self, value: f64) -> Self {
        let (digits, exponent) = decompose(value);
        if digits == 0 {
            return self;
        }
        let low = exponent + digits.trailing_zeros() as i32;
        let high = exponent + (64 - digits.unsigned_abs().leading_zeros()) as i32;
        Self { low: self.low.min(low), high: self.high.max(high) }
    }

    /// The exponent of the unit in which all numbers are integers; 0 when there is none but zero.
    pub(crate) fn low(self) -> i32 {
        if self.low == i32::MAX { 0 } else { self.low }
    }

    /// Bits of the largest number in units of `2^low`.
    pub(crate) fn bits(self) -> i32 {
        if self.low == i32::MAX { 0 } else { self.high - self.low }
    }

    /// True when products of three differences stay so far inside the exponent range of f64 that expansions of them
    /// lose nothing.
    ///
    /// Every intermediate of an expansion of such a product is a multiple of `2^(3 low)`, here at least `2^-870`, so
    /// nothing underflows, not even after a factor of `2^-106` from the error bounds inside; and every intermediate is
    /// below `2^(3 (high + 1) + 8)`, here at most `2^911`, so nothing overflows, not even the splitting by `2^27 + 1`.
    fn suits_expansions(self) -> bool {
        self.low >= -290 && self.high <= 300
    }

    /// `value / 2^low`; the caller knows that it fits.
    pub(super) fn to_i128(self, value: f64) -> i128 {
        let (digits, exponent) = decompose(value);
        if digits == 0 {
            return 0;
        }
        match exponent - self.low {
            shift @ 0.. => i128::from(digits) << shift,
            shift => i128::from(digits >> -shift),
        }
    }

    /// `value / 2^low`.
    pub(crate) fn to_big(self, value: f64) -> BigInt {
        let (digits, exponent) = decompose(value);
        if digits == 0 {
            return BigInt::ZERO;
        }
        match exponent - self.low {
            shift @ 0.. => BigInt::from(digits) << shift,
            shift => BigInt::from(digits >> -shift),
        }
    }
}

/// True when the signs of determinants of those points that are finite never take big integers. One pass.
pub fn suits_expansions<'p>(points: impl IntoIterator<Item = &'p DVec3>) -> bool {
    // As of the largest and the smallest magnitude: each number has at most 53 digits.
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for x in points.into_iter().flat_map(DVec3::to_array).map(f64::abs).filter(|x| x.is_finite()) {
        most = most.max(x);
        if x > 0.0 {
            least = least.min(x);
        }
    }
    least == f64::INFINITY || BitSpan { low: decompose(least).1, high: 0 }.with(most).suits_expansions()
}

thread_local! {
    static WORK: Cell<u64> = const { Cell::new(0) };
}

/// Units of work that a sign takes by small integers, and by wider numbers.
const SMALL_UNITS: u64 = 2;
const WIDE_UNITS: u64 = 8;

/// Units of work that this thread has spent on exact signs so far: whether a sign needs them is seen only when it is asked for, and such
/// a sign takes many times as long as one that a filter gives.
#[inline]
pub fn work_on_exact_signs() -> u64 {
    WORK.get()
}

fn count(units: u64) {
    WORK.set(WORK.get() + units);
}

/// Coordinates of at most 62 bits: differences fit 63 bits, products 126, the determinant 127, with its sign 128.
const ORIENT2D_BITS_MAX: i32 = 62;

/// Coordinates of at most 40 bits: differences fit 41 bits, minors 83, products 124, the determinant 126.
const ORIENT3D_BITS_MAX: i32 = 40;

/// Sign of `det(b - a, c - a)`, exact for all finite coordinates.
#[cold]
pub(super) fn orient2d(points: [DVec2; 3]) -> Sign {
    count(SMALL_UNITS);
    differences::orient2d(points).unwrap_or_else(|| wide_orient2d(points))
}

pub(super) fn wide_orient2d(points: [DVec2; 3]) -> Sign {
    count(WIDE_UNITS);
    let span = BitSpan::of(points.iter().flat_map(DVec2::to_array));
    if span.bits() <= ORIENT2D_BITS_MAX {
        let [a, b, c] = points.map(|p| p.to_array().map(|x| span.to_i128(x)));
        return Sign::of(&det2(&minus(&b, &a), &minus(&c, &a)));
    }
    if span.suits_expansions() {
        let [a, b, c] = points.map(|p| robust::Coord { x: p.x, y: p.y });
        return Sign::of(&robust::orient2d(a, b, c));
    }
    let [a, b, c] = points.map(|p| p.to_array().map(|x| span.to_big(x)));
    Sign::of(&det2(&minus(&b, &a), &minus(&c, &a)))
}

/// Sign of `det(b - a, c - a, d - a)`, exact for all finite coordinates.
#[cold]
pub(super) fn orient3d(points: [DVec3; 4]) -> Sign {
    count(SMALL_UNITS);
    differences::orient3d(points).unwrap_or_else(|| wide_orient3d(points))
}

pub(super) fn wide_orient3d(points: [DVec3; 4]) -> Sign {
    count(WIDE_UNITS);
    let span = BitSpan::of(points.iter().flat_map(DVec3::to_array));
    if span.bits() <= ORIENT3D_BITS_MAX {
        let [a, b, c, d] = points.map(|p| p.to_array().map(|x| span.to_i128(x)));
        return Sign::of(&det3(&minus(&b, &a), &minus(&c, &a), &minus(&d, &a)));
    }
    if span.suits_expansions() {
        let [a, b, c, d] = points.map(|p| robust::Coord3D { x: p.x, y: p.y, z: p.z });
        return -Sign::of(&robust::orient3d(a, b, c, d));
    }
    let [a, b, c, d] = points.map(|p| p.to_array().map(|x| span.to_big(x)));
    Sign::of(&det3(&minus(&b, &a), &minus(&c, &a), &minus(&d, &a)))
}

/// `a - b`.
fn minus<T, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N]
where
    for<'t> &'t T: Sub<&'t T, Output = T>,
{
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn det2<T>(u: &[T; 2], v: &[T; 2]) -> T
where
    T: Sub<T, Output = T>,
    for<'t> &'t T: Mul<&'t T, Output = T>,
{
    &u[0] * &v[1] - &u[1] * &v[0]
}

/// Determinant of three rows.
pub(super) fn det3<T>(u: &[T; 3], v: &[T; 3], w: &[T; 3]) -> T
where
    T: Sub<T, Output = T> + Add<T, Output = T> + Mul<T, Output = T>,
    for<'t> &'t T: Mul<&'t T, Output = T> + Mul<T, Output = T>,
{
    let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
    &w[0] * minor(1, 2) + &w[1] * minor(2, 0) + &w[2] * minor(0, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_is_the_bits_in_use() {
        assert_eq!(BitSpan::of([0.0, -0.0]), BitSpan::ZERO);
        assert_eq!(BitSpan::of([6.0]), BitSpan { low: 1, high: 3 });
        assert_eq!(BitSpan::of([1.0, -0.375]), BitSpan { low: -3, high: 1 });
        assert_eq!(BitSpan::of([f64::from_bits(1), f64::MAX]), BitSpan { low: -1074, high: 1024 });
        assert_eq!(BitSpan::ZERO.bits(), 0);
    }

    #[test]
    fn numbers_become_integers_of_their_span() {
        let span = BitSpan::of([0.375, -20.0]);
        assert_eq!(span.to_i128(0.375), 3);
        assert_eq!(span.to_i128(-20.0), -160);
        assert_eq!(span.to_i128(0.0), 0);
        let wide = BitSpan::of([f64::from_bits(1), -1e300]);
        assert_eq!(wide.to_big(f64::from_bits(1)), BigInt::from(1));
        assert_eq!(Sign::of(&wide.to_big(-1e300)), Sign::Negative);
    }

    #[test]
    fn the_widest_integers_of_each_tier_do_not_overflow() {
        let big = f64::from(1u32 << 31) * 512.0 - 1.0;
        assert_eq!(BitSpan::of([big, 1.0]).bits(), ORIENT3D_BITS_MAX);
        let signs = [[-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]];
        let [a, b, c, d] = signs.map(|s| DVec3::from_array(s) * big);
        assert_eq!(wide_orient3d([a, b, c, d]), Sign::Negative);
        assert_eq!(wide_orient3d([a, c, b, d]), Sign::Positive);
        let side = f64::from_bits((2f64.powi(62)).to_bits() - 1);
        assert_eq!(BitSpan::of([side, 1.0]).bits(), ORIENT2D_BITS_MAX);
        let [a, b, c] = [DVec2::new(-side, -side), DVec2::new(side, -side), DVec2::new(-side, side)];
        assert_eq!(wide_orient2d([a, b, c]), Sign::Positive);
        assert_eq!(wide_orient2d([b, a, c]), Sign::Negative);
    }
}
