//! A point where planes meet, exactly, and questions about such points in the plane of a face.

use super::exact::{IntegerVector, Rational, decompose, quotient, sign};
use crate::geom::DVec3;
use num_bigint::BigInt;
use num_traits::One;
use std::cmp::Ordering;

/// The point `x / w` with integers and a positive `w`.
#[derive(Debug, Clone)]
pub struct Point {
    pub(super) x: IntegerVector,
    pub(super) w: BigInt,
    /// Each coordinate within one unit in the last place.
    pub(super) near: DVec3,
}

impl PartialEq for Point {
    fn eq(&self, other: &Self) -> bool {
        // Coordinates within a unit in the last place each.
        let is_apart = |k: usize| {
            let (a, b) = (self.near[k], other.near[k]);
            (a - b).abs() > (a.abs() + b.abs()) * (1.0 / (1u64 << 51) as f64)
        };
        !(0..3).any(is_apart) && (0..3).all(|k| &self.x[k] * &other.w == &other.x[k] * &self.w)
    }
}

impl Point {
    pub(super) fn new(x: IntegerVector, w: BigInt) -> Self {
        let near = DVec3::from_array(x.each_ref().map(|x| quotient(x, &w)));
        Self { x, w, near }
    }

    /// The point with these finite coordinates.
    pub(super) fn of(p: DVec3) -> Self {
        let parts = p.to_array().map(decompose);
        let low = parts.iter().filter(|(m, _)| *m != 0).map(|(_, e)| *e).min().unwrap_or(0).min(0);
        let x = parts.map(|(m, e)| if m == 0 { BigInt::ZERO } else { BigInt::from(m) << (e - low) });
        Self { x, w: BigInt::from(1) << -low, near: p }
    }

    /// The point that is so many times as far from the origin, for a positive factor.
    pub(super) fn scaled(&self, factor: &Rational) -> Self {
        if factor.is_one() {
            return self.clone();
        }
        Self::new(self.x.each_ref().map(|x| x * factor.numer()), &self.w * factor.denom())
    }

    /// The coordinates, rounded to within one unit in the last place.
    pub fn rounded(&self) -> DVec3 {
        self.near
    }

    /// The coordinates without rounding.
    pub fn coordinates(&self) -> [Rational; 3] {
        self.x.each_ref().map(|x| Rational::new(x.clone(), self.w.clone()))
    }

    /// How coordinate `axis` compares with that of `other`.
    pub(super) fn compare(&self, other: &Self, axis: usize) -> Ordering {
        let (a, b) = (self.near[axis], other.near[axis]);
        if (a - b).abs() > (a.abs() + b.abs()) * (1.0 / (1u64 << 51) as f64) {
            return a.total_cmp(&b);
        }
        (&self.x[axis] * &other.w).cmp(&(&other.x[axis] * &self.w))
    }

    /// Twice the difference to `other` is not needed; this is `other - self` times both denominators.
    pub(super) fn to(&self, other: &Self) -> IntegerVector {
        std::array::from_fn(|k| &other.x[k] * &self.w - &self.x[k] * &other.w)
    }
}

/// The view of a plane along the coordinate axis nearest to its normal, mirrored if need be so that what turns
/// counter-clockwise around the normal does so in the view.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisView {
    pub(super) u: usize,
    pub(super) v: usize,
}

/// Where a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PointLocation {
    Inside,
    Border,
    Outside,
}

impl AxisView {
    /// The view of the plane with this unit normal.
    pub(super) fn along(normal: DVec3) -> Self {
        let size = normal.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] < 0.0 { Self { u: v, v: u } } else { Self { u, v } }
    }

    /// How three points turn in the view: greater is counter-clockwise.
    pub(super) fn turn(self, a: &Point, b: &Point, c: &Point) -> Ordering {
        let [p, q, r] = [a, b, c].map(|p| (p.near[self.u], p.near[self.v]));
        let (x1, y1, x2, y2) = (q.0 - p.0, q.1 - p.1, r.0 - p.0, r.1 - p.1);
        let value = x1 * y2 - y1 * x2;
        // A coordinate is within 2^-52 of its size, a difference of two of size m within 2^-50 m; the product of two
        // differences d and e is then within 2^-50 m (|d| + |e|) + 2^-100 m^2, and rounding adds 2^-52 |d e|.
        let m = [p, q, r].iter().fold(0.0f64, |m, p| m.max(p.0.abs()).max(p.1.abs()))
            * (1.0 / (1u64 << 49) as f64);
        let spread = x1.abs() + y1.abs() + x2.abs() + y2.abs();
        let error =
            m * spread + 4.0 * m * m + ((x1 * y2).abs() + (y1 * x2).abs()) * (1.0 / (1u64 << 50) as f64);
        if value > error {
            return Ordering::Greater;
        }
        if value < -error {
            return Ordering::Less;
        }
        let (u, v) = (self.u, self.v);
        let exact = &a.x[u] * (&b.x[v] * &c.w - &b.w * &c.x[v]) - &a.x[v] * (&b.x[u] * &c.w - &b.w * &c.x[u])
            + &a.w * (&b.x[u] * &c.x[v] - &b.x[v] * &c.x[u]);
        sign(&exact)
    }

    /// True when `p`, on the line of `a` and `b`, is not beyond either.
    pub(super) fn is_between(self, p: &Point, a: &Point, b: &Point) -> bool {
        [self.u, self.v].iter().all(|&k| {
            let (low, high) = if a.compare(b, k) == Ordering::Greater { (b, a) } else { (a, b) };
            p.compare(low, k) != Ordering::Less && p.compare(high, k) != Ordering::Greater
        })
    }

    /// Where `p` is in the region bounded by `edges`, which are those of simple disjoint loops.
    pub(super) fn locate<'p>(self, p: &Point, edges: impl Iterator<Item = [&'p Point; 2]>) -> PointLocation {
        let mut is_inside = false;
        for [a, b] in edges {
            let (from, to) = (a.compare(p, self.v), b.compare(p, self.v));
            if from == to && from != Ordering::Equal {
                continue;
            }
            let turn = self.turn(a, b, p);
            if turn == Ordering::Equal && self.is_between(p, a, b) {
                return PointLocation::Border;
            }
            // Upward edges count with their lower end and without their upper one.
            let is_upward = from != Ordering::Greater && to == Ordering::Greater;
            let is_downward = to != Ordering::Greater && from == Ordering::Greater;
            if (is_upward && turn == Ordering::Greater) || (is_downward && turn == Ordering::Less) {
                is_inside = !is_inside;
            }
        }
        if is_inside { PointLocation::Inside } else { PointLocation::Outside }
    }
}
