//! Integers of any size for points and planes whose filter cannot decide.

pub(super) use crate::geom::IntegerVector;

use crate::geom::{BitSpan, DVec3, Sign, power_of_two};
use num_bigint::BigInt;
use num_traits::{ToPrimitive, Zero};

/// The point `x / w`, with a positive `w`.
#[derive(Debug, Clone)]
pub(super) struct Homogeneous {
    pub(super) x: IntegerVector,
    pub(super) w: BigInt,
}

impl Homogeneous {
    /// The point `x / w`; `w` must not be zero.
    pub(super) fn new(x: IntegerVector, w: BigInt) -> Self {
        if w.sign() == num_bigint::Sign::Minus { Self { x: x.map(|x| -x), w: -w } } else { Self { x, w } }
    }
}

/// The plane `n . x = d`.
#[derive(Debug, Clone)]
pub(super) struct ExactPlane {
    pub(super) n: IntegerVector,
    pub(super) d: BigInt,
}

pub(super) fn sign_of(x: &BigInt) -> Sign {
    match x.sign() {
        num_bigint::Sign::Minus => Sign::Negative,
        num_bigint::Sign::NoSign => Sign::Zero,
        num_bigint::Sign::Plus => Sign::Positive,
    }
}

pub(super) fn cross(a: &IntegerVector, b: &IntegerVector) -> IntegerVector {
    let part = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

pub(super) fn dot(a: &IntegerVector, b: &IntegerVector) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(super) fn minus(a: &IntegerVector, b: &IntegerVector) -> IntegerVector {
    std::array::from_fn(|k| &a[k] - &b[k])
}

/// `numerator / denominator * 2^exponent` within two units in the last place, for results in the range of normal numbers;
/// beyond it zero or infinity. Not a number where the denominator is zero.
pub(super) fn quotient(numerator: &BigInt, denominator: &BigInt, exponent: i32) -> f64 {
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

/// Points in integers, in units of two to the power that is given with them.
pub(super) fn integers<const N: usize>(points: [DVec3; N]) -> ([IntegerVector; N], i32) {
    let span = points.iter().flat_map(DVec3::to_array).fold(BitSpan::ZERO, BitSpan::with);
    (points.map(|p| p.to_array().map(|x| span.to_big(x))), span.low())
}
