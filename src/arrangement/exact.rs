//! Integers of any size for points and planes whose filter cannot decide.

pub(super) use crate::geom::integers::{IntegerVector, cross, dot, quotient};

use crate::geom::{BitSpan, DVec3, Sign};
use num_bigint::BigInt;

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

pub(super) fn minus(a: &IntegerVector, b: &IntegerVector) -> IntegerVector {
    std::array::from_fn(|k| &a[k] - &b[k])
}

/// Points in integers, in units of two to the power that is given with them.
pub(super) fn integers<const N: usize>(points: [DVec3; N]) -> ([IntegerVector; N], i32) {
    let span = points.iter().flat_map(DVec3::to_array).fold(BitSpan::ZERO, BitSpan::with);
    (points.map(|p| p.to_array().map(|x| span.to_big(x))), span.low())
}
