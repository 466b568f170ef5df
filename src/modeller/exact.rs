//! Numbers without rounding: integers as large as needed, their quotients, and the f64 nearby.

pub(super) use crate::geom::integers::{IntegerVector, cross, dot};

use crate::geom::integers;
use num_bigint::{BigInt, Sign};
use num_rational::Ratio;
use num_traits::Zero;
use std::cmp::Ordering;

/// A quotient of integers of any size.
pub type Rational = Ratio<BigInt>;

/// The quotient that `x` is; `x` must be finite.
pub fn rational(x: f64) -> Rational {
    let (digits, exponent) = decompose(x);
    let digits = BigInt::from(digits);
    if exponent >= 0 {
        Rational::from_integer(digits << exponent)
    } else {
        Rational::new(digits, BigInt::from(1) << -exponent)
    }
}

/// `(m, e)` with `x = m 2^e` and an odd `m`, or two zeros.
pub(super) fn decompose(x: f64) -> (i64, i32) {
    let (digits, exponent) = integers::decompose(x);
    if digits == 0 {
        return (0, 0);
    }
    let zeros = digits.trailing_zeros() as i32;
    (digits >> zeros, exponent + zeros)
}

/// `numerator / denominator`, as [`integers::quotient`] gives it.
pub(super) fn quotient(numerator: &BigInt, denominator: &BigInt) -> f64 {
    integers::quotient(numerator, denominator, 0)
}

/// The f64 near `x`; see `quotient`.
pub fn to_f64(x: &Rational) -> f64 {
    quotient(x.numer(), x.denom())
}

/// `x` with at most one more significant bit than `bits`, towards zero; as it is where both its numbers have no more.
pub(super) fn shortened(x: &Rational, bits: u64) -> Rational {
    let shift = bits as i64 - x.numer().bits() as i64 + x.denom().bits() as i64;
    if x.numer().bits() <= bits && x.denom().bits() <= bits {
        return x.clone();
    }
    if shift >= 0 {
        Rational::new((x.numer() << shift) / x.denom(), BigInt::from(1) << shift)
    } else {
        Rational::from_integer((x.numer() / (x.denom() << -shift)) << -shift)
    }
}

/// The sign of `x` against zero.
pub(super) fn sign(x: &BigInt) -> Ordering {
    match x.sign() {
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
        Sign::Plus => Ordering::Greater,
    }
}

pub(super) fn det(a: &IntegerVector, b: &IntegerVector, c: &IntegerVector) -> BigInt {
    dot(&cross(a, b), c)
}

pub(super) fn negative(a: &IntegerVector) -> IntegerVector {
    a.each_ref().map(|x| -x)
}

pub(super) fn is_zero(a: &IntegerVector) -> bool {
    a.iter().all(Zero::is_zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_f64_is_a_quotient_and_comes_back() {
        for x in [0.0, 1.0, -0.1, 1e300, 1e-300, f64::MAX, f64::MIN_POSITIVE, 3.5e10] {
            assert_eq!(to_f64(&rational(x)), x);
        }
        let third = Rational::new(BigInt::from(1), BigInt::from(3));
        assert!((to_f64(&third) * 3.0 - 1.0).abs() <= f64::EPSILON);
    }

    #[test]
    fn a_shortened_number_is_nearer_to_zero_by_less_than_its_last_bit() {
        let two_thirds = Rational::new(BigInt::from(2), BigInt::from(3));
        assert_eq!(shortened(&two_thirds, 20), two_thirds, "its numbers are short");
        let x = Rational::new(BigInt::from(2_000_000_001), BigInt::from(3_000_000_000_u64));
        let short = shortened(&x, 20);
        assert!(short < x && &x - &short < Rational::new(BigInt::from(1), BigInt::from(1 << 19)));
        assert_eq!(shortened(&rational(0.375), 20), rational(0.375));
        let large = rational(1e30) + rational(1.0);
        assert!(shortened(&large, 60) <= large);
    }
}
