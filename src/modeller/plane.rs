//! The plane of a face: `n . x = d` with a normal of integers that never changes and a rational offset.

use super::exact::{IntegerVector, Rational, cross, quotient};
use super::point::Point;
use crate::geom::DVec3;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;

/// A plane `n . x = d`. The normal points out of the solid and is primitive: its integers have no common divisor.
#[derive(Debug, Clone)]
pub struct Plane {
    pub(super) normal: IntegerVector,
    pub(super) offset: Rational,
    /// `normal` divided by `length`, within 2^-51 of each component.
    pub(super) unit: DVec3,
    /// `offset` divided by the same `length`, within 2^-51.
    pub(super) distance: f64,
    /// About the length of the normal.
    pub(super) length: f64,
}

impl PartialEq for Plane {
    fn eq(&self, other: &Self) -> bool {
        self.normal == other.normal && self.offset == other.offset
    }
}

impl Plane {
    /// The plane with this normal, which must not be zero, and offset. Both are divided by the common divisor of the
    /// normal.
    pub(super) fn new(normal: IntegerVector, offset: Rational) -> Self {
        let divisor = normal[0].gcd(&normal[1]).gcd(&normal[2]);
        let normal = normal.map(|n| n / &divisor);
        // A scale for all three, so that large integers do not leave the range of f64.
        let bits = normal.iter().map(BigInt::bits).max().unwrap_or(0);
        let scale = BigInt::from(1) << bits;
        let scaled = DVec3::from_array(normal.each_ref().map(|n| quotient(n, &scale)));
        let length = scaled.length();
        let offset = offset / divisor;
        let distance = quotient(offset.numer(), &(offset.denom() * &scale)) / length;
        let length_of_normal = length * quotient(&scale, &BigInt::from(1));
        Self { unit: scaled / length, distance, length: length_of_normal, normal, offset }
    }

    /// The plane through a point of integers over `w`, which must be positive.
    pub(super) fn through(normal: IntegerVector, point: &Point) -> Self {
        let offset = Rational::new(super::exact::dot(&normal, &point.x), point.w.clone());
        Self::new(normal, offset)
    }

    /// The same plane moved along its normal: `d` becomes `d + t`.
    pub(super) fn shifted(&self, t: &Rational) -> Self {
        Self::new(self.normal.clone(), &self.offset + t)
    }

    /// The plane that is so many times as far from the origin, for a positive factor.
    pub(super) fn scaled(&self, factor: &Rational) -> Self {
        Self::new(self.normal.clone(), &self.offset * factor)
    }

    /// The unit normal, rounded.
    pub fn unit_normal(&self) -> DVec3 {
        self.unit
    }

    /// The offset in the stored scale: `d` of `n . x = d`.
    pub fn offset(&self) -> &Rational {
        &self.offset
    }

    /// The normal in the stored scale: integers without a common divisor.
    pub fn normal(&self) -> &[BigInt; 3] {
        &self.normal
    }

    /// The length of the stored normal, rounded: how much `d` grows when the face moves by one unit.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// On which side of the plane `p` is: greater is where the normal points.
    pub(super) fn side(&self, p: &Point) -> Ordering {
        let terms = self.unit * p.near;
        let value = terms.x + terms.y + terms.z - self.distance;
        // Factors are within 2^-51 and 2^-52, one product and three sums round: below 2^-49 of the magnitudes.
        let error = (terms.abs().element_sum() + self.distance.abs()) * (1.0 / (1u64 << 49) as f64);
        if value > error {
            return Ordering::Greater;
        }
        if value < -error {
            return Ordering::Less;
        }
        let left = super::exact::dot(&self.normal, &p.x) * self.offset.denom();
        left.cmp(&(self.offset.numer() * &p.w))
    }

    /// True when the planes have normals on one line.
    pub(super) fn is_parallel(&self, other: &Self) -> bool {
        super::exact::is_zero(&cross(&self.normal, &other.normal))
    }

    /// The row `(n, d)` with integers: all four times the denominator of the offset.
    pub(super) fn row(&self) -> (IntegerVector, BigInt) {
        let denominator = self.offset.denom();
        (self.normal.each_ref().map(|n| n * denominator), self.offset.numer().clone())
    }
}

/// The point where three planes meet, unless their normals are dependent.
pub(super) fn meeting_point(planes: [&Plane; 3]) -> Option<Point> {
    let crossed = [
        cross(&planes[1].normal, &planes[2].normal),
        cross(&planes[2].normal, &planes[0].normal),
        cross(&planes[0].normal, &planes[1].normal),
    ];
    let w = super::exact::dot(&planes[0].normal, &crossed[0]);
    if w.is_zero() {
        return None;
    }
    let common = planes.iter().fold(BigInt::from(1), |lcm, p| lcm.lcm(p.offset.denom()));
    let weights = planes.map(|p| p.offset.numer() * (&common / p.offset.denom()));
    let x = std::array::from_fn(|k| {
        &weights[0] * &crossed[0][k] + &weights[1] * &crossed[1][k] + &weights[2] * &crossed[2][k]
    });
    let w = w * common;
    Some(if w.is_negative() { Point::new(super::exact::negative(&x), -w) } else { Point::new(x, w) })
}
