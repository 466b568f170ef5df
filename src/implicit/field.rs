//! The field: a function that is zero on the surface, positive outside and negative inside.

use super::centres::UnitFrame;
use super::options::{ConstraintValues, Kernel};
use super::partition::Partition;
use super::polynomial::{dot, gradient, terms};
use super::system::Solution;
use crate::geom::DVec3;

/// Steps of Newton's method in [`Field::project`].
const STEPS_MAX: usize = 24;
/// Halvings of one step that does not bring the value down.
const HALVINGS_MAX: usize = 6;
/// A point is on the surface when its distance from it, as value over gradient, is at most this share of the extent.
const ON_SURFACE_SHARE: f64 = 1e-12;
/// Gradients below this share of the usual one have no direction.
const FLAT_SHARE: f64 = 1e-6;

/// How the system was solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolveMethod {
    /// As one dense system.
    Dense,
    /// In overlapping parts, blended by smooth weights.
    Partition {
        /// Number of parts.
        parts: usize,
        /// Centres of the largest part.
        centres_max: usize,
    },
}

/// What was fitted, for reports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitFacts {
    /// The radial function.
    pub kernel: Kernel,
    /// Points of the band at different places.
    pub points: usize,
    /// Centres of the system: the points and the offset centres.
    pub centres: usize,
    /// Offset centres that were left out because they nearly coincide with other centres.
    pub coincident_offsets: usize,
    /// Degree of the polynomial, 1 or 2; the least of all parts.
    pub degree: u32,
    /// The rank of the ten polynomials of degree 2 or less at the centres: below 10 the degree is 1. The least of all
    /// parts.
    pub rank: usize,
    /// The largest difference of the field from a value that it should take, over the largest value.
    pub residual: f64,
    /// Lambda before it is halved, in the unit of the coordinates.
    pub lambda: f64,
    /// The least and the largest lambda used.
    pub lambda_range: [f64; 2],
    /// Points whose lambda was halved; those without offset centres because no lambda fits are among them.
    pub halved: usize,
    /// Points without offset centres because no lambda fits: another part of the surface is at them.
    pub without_room: usize,
    /// How the system was solved.
    pub method: SolveMethod,
}

#[derive(Debug, Clone)]
pub(super) enum FieldSolution {
    One(Box<Solution>),
    Many(Partition),
}

/// A smooth function of space whose zero set is the surface: positive outside, negative inside. With distances as
/// values it is about the signed distance near the points, in the unit of the coordinates.
#[derive(Debug, Clone)]
pub struct Field {
    pub(super) kernel: Kernel,
    pub(super) values: ConstraintValues,
    pub(super) frame: UnitFrame,
    /// What a value of the system is in the values of the field.
    pub(super) value_unit: f64,
    pub(super) parts: FieldSolution,
    pub(super) facts: FitFacts,
}

impl Field {
    /// The value at `p`. O(centres).
    pub fn value(&self, p: DVec3) -> f64 {
        let p = self.frame.inward(p);
        let of = |s: &Solution| s.centres.sum(self.kernel, p) + dot(&terms(p), &s.polynomial);
        let value = match &self.parts {
            FieldSolution::One(solution) => of(solution),
            FieldSolution::Many(partition) => partition.value(p, of),
        };
        value * self.value_unit
    }

    /// The value at `p` and the gradient, which points outside. O(centres).
    pub fn value_and_gradient(&self, p: DVec3) -> (f64, DVec3) {
        let p = self.frame.inward(p);
        let of = |s: &Solution| {
            let (value, slope) = s.centres.sum_and_gradient(self.kernel, p);
            (value + dot(&terms(p), &s.polynomial), slope + gradient(&s.polynomial, p))
        };
        let (value, gradient) = match &self.parts {
            FieldSolution::One(solution) => of(solution),
            FieldSolution::Many(partition) => partition.value_and_gradient(p, of),
        };
        (value * self.value_unit, gradient * (self.value_unit / self.frame.unit))
    }

    /// The unit normal of the level surface through `p`, outward; `None` where the field is flat.
    pub fn normal(&self, p: DVec3) -> Option<DVec3> {
        self.value_and_gradient(p).1.try_normalize()
    }

    /// The point of the zero set that Newton's method along the gradient reaches from `p`, at most `reach` away from
    /// it; `None` when it reaches none.
    pub fn project(&self, p: DVec3, reach: f64) -> Option<DVec3> {
        let usual = self.usual_slope();
        let mut place = p;
        let (mut value, mut slope) = self.value_and_gradient(place);
        for _ in 0..STEPS_MAX {
            let square = slope.length_squared();
            if square.is_nan() || square <= (FLAT_SHARE * usual) * (FLAT_SHARE * usual) {
                return None;
            }
            if value.abs() <= ON_SURFACE_SHARE * self.frame.unit * square.sqrt() {
                break;
            }
            let step = (slope * (-value / square)).clamp_length_max(reach);
            let before = value.abs();
            let mut share = 1.0;
            for _ in 0..HALVINGS_MAX {
                let trial = place + step * share;
                let (trial_value, trial_slope) = self.value_and_gradient(trial);
                if trial_value.abs() < before {
                    (place, value, slope) = (trial, trial_value, trial_slope);
                    break;
                }
                share *= 0.5;
            }
            if value.abs() >= before {
                break;
            }
            if place.distance(p) > reach {
                return None;
            }
        }
        let is_there = value.abs() <= self.accuracy() * slope.length() && place.distance(p) <= reach;
        is_there.then_some(place)
    }

    /// How far from the zero set, as value over gradient, a projected point may end: what rounding leaves.
    fn accuracy(&self) -> f64 {
        1e-9 * self.frame.unit
    }

    /// The gradient's length where the field is as it should be.
    fn usual_slope(&self) -> f64 {
        let [least, _] = self.facts.lambda_range;
        if self.values == ConstraintValues::Unit { 1.0 / least } else { 1.0 }
    }

    /// What was fitted.
    pub fn facts(&self) -> &FitFacts {
        &self.facts
    }
}
