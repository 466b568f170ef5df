//! Points spread evenly over a surface, the same in every run.
//!
//! Systematic sampling: of `n` samples, sample `k` is at the share `(k + 1/2) / n` of the area, counted from triangle to
//! triangle. Inside a triangle it is at the place that the plastic-number sequence (Roberts 2018) has for `k`.

use super::Surface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, triangle_area};
use crate::par;

/// The area of all triangles up to and with each one.
#[derive(Debug, Clone)]
pub struct Areas {
    sums: Vec<f64>,
}

/// A point of a surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceSample {
    /// Where it is.
    pub place: DVec3,
    /// A triangle that it is on.
    pub triangle: u32,
}

impl Areas {
    /// Sums up the areas of `surface`.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of(surface: Surface<'_>, budget: &Budget) -> Result<Self, Stopped> {
        let areas = par::try_map_ranges(surface.triangles.len(), CHECK_EVERY, |range| {
            budget.check()?;
            let corners = |t: &[u32; 3]| t.map(|v| surface.positions[v as usize]);
            Ok(surface.triangles[range].iter().map(|t| triangle_area(corners(t))).collect::<Vec<_>>())
        })?;
        let mut sum = 0.0;
        let sums = areas.into_iter().flatten().map(|area| {
            sum += area;
            sum
        });
        Ok(Self { sums: sums.collect() })
    }

    /// The area of all triangles.
    pub fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// Sample `k` of `count` on the same surface, which must have a triangle.
    pub fn sample(&self, surface: Surface<'_>, k: usize, count: usize) -> SurfaceSample {
        let share = self.total() * ((k as f64 + 0.5) / count as f64);
        let triangle = self.sums.partition_point(|&sum| sum <= share).min(self.sums.len() - 1);
        let [a, b, c] = surface.triangles[triangle].map(|v| surface.positions[v as usize]);
        // Powers of the reciprocal of the plastic number, the real root of x^3 = x + 1.
        let fraction = |step: f64| (k as f64 * step).fract();
        let (s, t) = (fraction(0.754_877_666_246_692_8), fraction(0.569_840_290_998_053_2));
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        SurfaceSample { place: a + (b - a) * s + (c - a) * t, triangle: triangle as u32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_as_many_as_the_area_and_lie_in_their_triangles() {
        let positions = [DVec3::ZERO, DVec3::X * 3.0, DVec3::Y, DVec3::new(3.0, 1.0, 0.0), DVec3::X];
        // Areas 1.5, 0, 1.5 and 0.5.
        let triangles = [[0, 1, 2], [0, 0, 1], [1, 3, 2], [0, 4, 2]];
        let surface = Surface { positions: &positions, triangles: &triangles };
        let areas = Areas::of(surface, &Budget::unlimited()).unwrap();
        let mut counts = [0; 4];
        let mut sum = DVec3::ZERO;
        for k in 0..7_000 {
            let sample = areas.sample(surface, k, 7_000);
            counts[sample.triangle as usize] += 1;
            if sample.triangle == 0 {
                sum += sample.place;
                assert!(sample.place.x / 3.0 + sample.place.y <= 1.0 + 1e-12 && sample.place.y >= 0.0);
            }
        }
        assert_eq!(counts, [3_000, 0, 3_000, 1_000]);
        assert!((sum / 3_000.0).distance(DVec3::new(1.0, 1.0 / 3.0, 0.0)) < 0.01, "{sum}");
    }
}
