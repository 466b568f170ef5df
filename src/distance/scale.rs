//! Coordinates in which squares of lengths are in the range of f64.

use super::{DirectedDistance, FarPoint, Surface};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::par;

/// Both surfaces, multiplied by a power of two where lengths would leave the range of numbers otherwise.
pub(super) struct Common<'s> {
    a: Surface<'s>,
    b: Surface<'s>,
    /// Positions of both when they had to be multiplied.
    scaled: Option<[Vec<DVec3>; 2]>,
    /// What they were multiplied by.
    pub(super) factor: f64,
    /// Diagonal of the box around both, in the new coordinates.
    pub(super) diagonal: f64,
    /// More than rounding can take from a distance, in the new coordinates: corners of pieces and closest points are
    /// off by a few units in the last place of the largest coordinate.
    pub(super) slack: f64,
}

/// Largest coordinates for which nothing is multiplied: squares of such lengths, and of those 2^-200 times as large,
/// are normal numbers.
const USUAL: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

impl<'s> Common<'s> {
    pub(super) fn of(a: Surface<'s>, b: Surface<'s>, budget: &Budget) -> Result<Self, Stopped> {
        let bounds = bounds(a, budget)?.union(bounds(b, budget)?);
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let factor =
            if largest == 0.0 || USUAL.contains(&largest) { 1.0 } else { reciprocal_power_of_two(largest) };
        let scaled =
            (factor != 1.0).then(|| [a, b].map(|s| s.positions.iter().map(|&p| p * factor).collect()));
        let diagonal = ((bounds.max * factor) - (bounds.min * factor)).length();
        let slack = 64.0 * f64::EPSILON * (largest * factor);
        Ok(Self { a, b, scaled, factor, diagonal, slack })
    }

    pub(super) fn surfaces(&self) -> (Surface<'_>, Surface<'_>) {
        match &self.scaled {
            None => (self.a, self.b),
            Some([a, b]) => (Surface { positions: a, ..self.a }, Surface { positions: b, ..self.b }),
        }
    }

    /// A result in the coordinates of the caller.
    pub(super) fn unscale(&self, of: DirectedDistance) -> DirectedDistance {
        let back = |x: f64| x / self.factor;
        let FarPoint { place, closest, .. } = of.farthest;
        DirectedDistance {
            upper: back(of.upper),
            lower: back(of.lower),
            is_within_tolerance: of.is_within_tolerance,
            farthest: FarPoint { place: place / self.factor, closest: closest / self.factor, ..of.farthest },
            mean: of.mean.map(back),
            root_mean_square: of.root_mean_square.map(back),
            seen: of.seen,
        }
    }
}

fn bounds(surface: Surface<'_>, budget: &Budget) -> Result<Aabb, Stopped> {
    let boxes = par::try_map_ranges(surface.triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let corners = surface.triangles[range].iter().flatten();
        Ok(Aabb::of(corners.map(|&v| surface.positions[v as usize])))
    })?;
    Ok(boxes.into_iter().fold(Aabb::EMPTY, Aabb::union))
}

/// A power of two, or its nearest normal neighbour, that brings `x` near 1.
fn reciprocal_power_of_two(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52) as i64 - 1023;
    f64::from_bits(((1023 - exponent.clamp(-1022, 1022)) as u64) << 52)
}
