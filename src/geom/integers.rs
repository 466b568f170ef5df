//! Integers of any size: the digits of an f64, vectors, and the f64 near a quotient.

use super::power_of_two;
use num_bigint::BigInt;
use num_traits::{ToPrimitive, Zero};

/// A vector of integers of any size.
pub(crate) type IntegerVector = [BigInt; 3];

/// `(m, e)` with `value = m * 2^e` and `|m| < 2^53`; `value` must be finite.
pub(crate) fn decompose(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let field = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let digits = if field == 0 { fraction } else { fraction | (1 << 52) };
    (if value.is_sign_negative() { -digits } else { digits }, field.max(1) - 1075)
}

pub(crate) fn cross(a: &IntegerVector, b: &IntegerVector) -> IntegerVector {
    let part = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

pub(crate) fn dot(a: &IntegerVector, b: &IntegerVector) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// `numerator / denominator * 2^exponent` within two units in the last place, for results in the range of normal numbers;
/// beyond it zero or infinity. Not a number where the denominator is zero, which must not be negative.
pub(crate) fn quotient(numerator: &BigInt, denominator: &BigInt, exponent: i32) -> f64 {
    if denominator.is_zero() {
        return f64::NAN;
    }
    if numerator.is_zero() {
        return 0.0;
    }
    let shift = 66 - numerator.bits() as i64 + denominator.bits() as i64;
    let scaled =
        if shift >= 0 { (numerator << shift) / denominator } else { numerator / (denominator << -shift) };
    // Between 2^65 and 2^67, so that nothing is lost here but the rounding.
    let mut value = scaled.to_f64().unwrap_or(f64::NAN);
    let mut left = i64::from(exponent) - shift;
    while left != 0 {
        let step = left.clamp(-1000, 1000);
        value *= power_of_two(step as i32);
        left -= step;
        if value == 0.0 || !value.is_finite() {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_the_numbers_that_they_stand_for() {
        for x in [1.0, -0.1, 1e300, -1e-300, f64::MAX, f64::MIN_POSITIVE, 3.5e10] {
            let (digits, exponent) = decompose(x);
            assert_eq!(quotient(&digits.into(), &BigInt::from(1), exponent), x);
            assert_eq!(quotient(&(BigInt::from(digits) * 3), &(BigInt::from(3) << 2000), exponent + 2000), x);
        }
        assert_eq!(decompose(0.0).0, 0);
        assert_eq!(quotient(&BigInt::ZERO, &BigInt::from(7), 5), 0.0);
        assert!(quotient(&BigInt::from(1), &BigInt::ZERO, 0).is_nan());
        assert_eq!(quotient(&BigInt::from(-1), &BigInt::from(3), 1100), f64::NEG_INFINITY);
        assert_eq!(quotient(&BigInt::from(1), &BigInt::from(3), -1100), 0.0);
    }

    #[test]
    fn a_cross_product_is_square_to_its_factors() {
        let [a, b] = [[2, -7, 5], [11, 3, -4]].map(|v: [i64; 3]| v.map(BigInt::from));
        let c = cross(&a, &b);
        assert_eq!(c, [13, 63, 83].map(BigInt::from));
        assert!(dot(&a, &c).is_zero() && dot(&b, &c).is_zero());
    }
}
