//! Rational arithmetic as the truth behind the exact predicates: slow, simple, written independently of the engine.

use dashu_ratio::RBig;
use meshmend::geom::{DVec3, Sign};

/// A point or vector with rational coordinates.
pub(crate) type Point = [RBig; 3];

pub(crate) fn number(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

pub(crate) fn point(p: DVec3) -> Point {
    p.to_array().map(number)
}

pub(crate) fn sign(x: &RBig) -> Sign {
    match x.cmp(&RBig::ZERO) {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

pub(crate) fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

pub(crate) fn dot(a: &Point, b: &Point) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

/// `det(b - a, c - a, d - a)`.
pub(crate) fn orient3d(a: &Point, b: &Point, c: &Point, d: &Point) -> RBig {
    dot(&cross(&minus(b, a), &minus(c, a)), &minus(d, a))
}

pub(crate) fn is_zero(v: &Point) -> bool {
    v.iter().all(|x| *x == RBig::ZERO)
}
