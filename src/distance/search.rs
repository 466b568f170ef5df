//! The distance from one surface to another: vertices and samples first, then the triangles that may exceed them.

use super::bound::{Corner, upper_bound};
use super::pieces::{Farthest, Piece, Refined, Tolerance, refine};
use super::samples::Areas;
use super::scale::Common;
use super::view::View;
use super::{DirectedDistance, DistanceOptions, Seen, Surface};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;
use crate::spatial::NearestSearch;

/// One direction.
pub(super) struct Directed<'d> {
    pub(super) from: Surface<'d>,
    pub(super) to: &'d NearestSearch<'d>,
    pub(super) view: View<'d>,
    pub(super) common: &'d Common<'d>,
    pub(super) options: &'d DistanceOptions,
    pub(super) budget: &'d Budget,
}

/// What is closest to a vertex.
#[derive(Debug, Clone, Copy)]
struct AtVertex {
    closest_triangle: u32,
    distance: f64,
}

/// Sums over samples.
#[derive(Debug, Clone, Copy)]
struct Sampled {
    /// Samples that count.
    count: u32,
    /// Of those, what is lost.
    lost: u32,
    sum: f64,
    sum_of_squares: f64,
    farthest: Farthest,
}

impl Sampled {
    const NONE: Self = Self { count: 0, lost: 0, sum: 0.0, sum_of_squares: 0.0, farthest: Farthest::NONE };
}

/// Vertices or samples looked at by one task.
const POINTS_OF_TASK: usize = 1024;

/// Pieces that are refined before it is seen how far the farthest point is now: few at first.
const WAVES: std::ops::RangeInclusive<usize> = 64..=16_384;

impl Directed<'_> {
    pub(super) fn measure(&self) -> Result<DirectedDistance, Stopped> {
        let _charge = self.budget.charge(self.from.positions.len() as u64 * 16)?;
        let (vertices, at_vertices) = self.at_vertices()?;
        let sampled = self.at_samples()?;
        let known = at_vertices.or(sampled.farthest);
        let mut upper = 0.0;
        let (candidates, farthest) = self.candidates(&vertices, known, &mut upper)?;
        let _charge = self.budget.charge(candidates.len() as u64 * 16)?;
        let farthest = self.refine_all(&vertices, &candidates, farthest, &mut upper)?;
        let share = |part: f64, all: u32| (all > 0).then(|| part / f64::from(all));
        let mean_of = |sum: f64| share(sum, sampled.count);
        let seen = self.view.sight.map(|_| Seen {
            hidden_share: share(f64::from(self.options.samples - sampled.count), self.options.samples)
                .unwrap_or(0.0),
            lost_share: share(f64::from(sampled.lost), sampled.count).unwrap_or(0.0),
        });
        Ok(DirectedDistance {
            upper: upper.max(farthest.distance) + self.common.slack,
            lower: farthest.distance.max(0.0),
            farthest: farthest.point,
            mean: mean_of(sampled.sum),
            root_mean_square: mean_of(sampled.sum_of_squares).map(f64::sqrt),
            seen,
        })
    }

    fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.options.tolerance_relative,
            absolute: (self.options.tolerance_of_diagonal * self.common.diagonal).max(self.common.slack),
        }
    }

    /// What is closest to each vertex that a triangle uses, and the farthest vertex.
    fn at_vertices(&self) -> Result<(Vec<AtVertex>, Farthest), Stopped> {
        const UNUSED: u32 = u32::MAX;
        let mut triangle_of = vec![UNUSED; self.from.positions.len()];
        for (t, corners) in self.from.triangles.iter().enumerate() {
            corners.iter().for_each(|&v| triangle_of[v as usize] = t as u32);
        }
        let parts = par::try_map_ranges(triangle_of.len(), POINTS_OF_TASK, |range| {
            let mut found = Vec::with_capacity(range.len());
            let (mut hint, mut farthest) = (None, Farthest::NONE);
            self.budget.spend(range.len() as u64)?;
            for v in range {
                let nearest = match triangle_of[v] {
                    UNUSED => None,
                    _ => self.to.find(self.from.positions[v], hint, self.budget)?,
                };
                if let Some(nearest) = nearest {
                    hint = Some(nearest.triangle);
                    let (place, triangle) = (self.from.positions[v], triangle_of[v]);
                    if nearest.distance > farthest.distance && self.view.counts(place, triangle)? {
                        farthest = Farthest::at(place, triangle, &nearest);
                    }
                }
                let (closest_triangle, distance) = nearest.map_or((0, 0.0), |n| (n.triangle, n.distance));
                found.push(AtVertex { closest_triangle, distance });
            }
            Ok((found, farthest))
        })?;
        let farthest = parts.iter().fold(Farthest::NONE, |so_far, (_, farthest)| so_far.or(*farthest));
        Ok((parts.into_iter().flat_map(|(found, _)| found).collect(), farthest))
    }

    /// The distances at the samples that count.
    fn at_samples(&self) -> Result<Sampled, Stopped> {
        let count = self.options.samples as usize;
        let areas = Areas::of(self.from, self.budget)?;
        let parts = par::try_map_ranges(count, POINTS_OF_TASK, |range| {
            self.budget.spend(range.len() as u64)?;
            let mut of = Sampled::NONE;
            let mut hint = None;
            for k in range {
                let sample = areas.sample(self.from, k, count);
                if !self.view.counts(sample.place, sample.triangle)? {
                    continue;
                }
                if let Some(nearest) = self.to.find(sample.place, hint, self.budget)? {
                    hint = Some(nearest.triangle);
                    of.count += 1;
                    of.lost += u32::from(self.view.loses(nearest.distance));
                    of.sum += nearest.distance;
                    of.sum_of_squares += nearest.distance * nearest.distance;
                    of.farthest = of.farthest.or(Farthest::at(sample.place, sample.triangle, &nearest));
                }
            }
            Ok(of)
        })?;
        Ok(parts.into_iter().fold(Sampled::NONE, |all, part| Sampled {
            count: all.count + part.count,
            lost: all.lost + part.lost,
            sum: all.sum + part.sum,
            sum_of_squares: all.sum_of_squares + part.sum_of_squares,
            farthest: all.farthest.or(part.farthest),
        }))
    }

    fn corners(&self, vertices: &[AtVertex], t: u32) -> [Corner; 3] {
        self.from.triangles[t as usize].map(|v| {
            let AtVertex { closest_triangle, distance } = vertices[v as usize];
            Corner { place: self.from.positions[v as usize], closest_triangle, distance }
        })
    }

    /// The triangles that may hold a point farther than the tolerance allows, farthest first; `upper` grows to the
    /// bound of all others. Looks at their middles.
    fn candidates(
        &self,
        vertices: &[AtVertex],
        known: Farthest,
        upper: &mut f64,
    ) -> Result<(Vec<(f64, u32)>, Farthest), Stopped> {
        let parts = par::try_map_ranges(self.from.triangles.len(), CHECK_EVERY, |range| {
            self.budget.check()?;
            let mut below = 0f64;
            let (mut farthest, mut above) = (known, Vec::new());
            for t in range {
                let bound = self.triangle_bound(vertices, t as u32, &mut farthest)?;
                if bound <= self.tolerance().enough(farthest.distance) {
                    below = below.max(bound);
                } else {
                    above.push((bound, t as u32));
                }
            }
            Ok((above, below, farthest))
        })?;
        let farthest = parts.iter().fold(known, |so_far, (_, _, farthest)| so_far.or(*farthest));
        *upper = parts.iter().fold(*upper, |most, (_, below, _)| most.max(*below));
        let mut candidates: Vec<(f64, u32)> = parts.into_iter().flat_map(|(above, _, _)| above).collect();
        candidates.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        Ok((candidates, farthest))
    }

    /// The bound of a whole triangle. Where the corners do not decide, the triangle closest to its middle may: surfaces
    /// that are the same in a region are seen to be so at once.
    fn triangle_bound(&self, vertices: &[AtVertex], t: u32, farthest: &mut Farthest) -> Result<f64, Stopped> {
        let corners = self.corners(vertices, t);
        let enough = self.tolerance().enough(farthest.distance);
        let bound = upper_bound(self.to, &corners, enough);
        if bound <= enough {
            return Ok(bound);
        }
        let middle = (corners[0].place + corners[1].place + corners[2].place) / 3.0;
        self.budget.spend(1)?;
        let Some(nearest) = self.to.find(middle, Some(corners[0].closest_triangle), self.budget)? else {
            return Ok(bound);
        };
        if self.view.hides(&corners, t)? {
            return Ok(0.0);
        }
        if nearest.distance > farthest.distance && self.view.counts(middle, t)? {
            *farthest = Farthest::at(middle, t, &nearest);
        }
        let from_one = corners.map(|c| self.to.on_triangle(c.place, nearest.triangle).distance);
        Ok(bound.min(from_one.into_iter().fold(0.0, f64::max)))
    }

    /// Refines the candidates in waves; `upper` grows to the bound of everything that was put aside.
    fn refine_all(
        &self,
        vertices: &[AtVertex],
        candidates: &[(f64, u32)],
        mut farthest: Farthest,
        upper: &mut f64,
    ) -> Result<Farthest, Stopped> {
        let tolerance = self.tolerance();
        let (mut next, mut wave_len, mut work) = (0, *WAVES.start(), 0);
        let mut wave: Vec<Piece> = Vec::new();
        loop {
            let enough = tolerance.enough(farthest.distance);
            let fresh = candidates[next..].iter().take(wave_len.saturating_sub(wave.len()));
            let fresh: Vec<_> = fresh.take_while(|(bound, _)| *bound > enough).collect();
            next += fresh.len();
            let piece =
                |&&(upper, t): &&(f64, u32)| Piece { corners: self.corners(vertices, t), triangle: t, upper };
            wave.extend(fresh.iter().map(piece));
            if wave.is_empty() || work >= self.options.refinements_max {
                break;
            }
            let refined = self.refine_wave(&wave, farthest)?;
            wave.clear();
            for Refined { farthest: found, upper: aside, left, work: spent } in refined {
                farthest = farthest.or(found);
                *upper = upper.max(aside);
                wave.extend(left);
                work += spent;
            }
            wave_len = (2 * wave_len).min(*WAVES.end());
        }
        // Sorted, so the first bound is the largest of those that were not needed.
        let unused = candidates.get(next).map_or(0.0, |&(bound, _)| bound);
        *upper = wave.iter().map(|piece| piece.upper).fold(upper.max(unused), f64::max);
        Ok(farthest)
    }

    fn refine_wave(&self, wave: &[Piece], farthest: Farthest) -> Result<Vec<Refined>, Stopped> {
        par::try_map_ranges(wave.len(), 1, |range| {
            let piece = wave[range.start];
            let refined = refine(self.to, &self.view, piece, farthest, self.tolerance(), self.budget)?;
            self.budget.spend(refined.work)?;
            Ok(refined)
        })
    }
}
