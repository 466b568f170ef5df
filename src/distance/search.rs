//! The distance from one surface to another: vertices and samples first, then the triangles that may exceed them.

use super::bound::{Corner, upper_bound};
use super::pieces::{Farthest, Piece, Refined, Refining, Tolerance, WORK_MAX};
use super::samples::Areas;
use super::scale::Common;
use super::target::DistanceTarget;
use super::view::{ScaledSight, VisiblePart};
use super::{AreaShares, DirectedDistance, DistanceOptions, Surface, VisibilitySearch};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;
use crate::spatial::Found;
use std::collections::BinaryHeap;

/// One direction.
pub(super) struct Directed<'d, 'v> {
    pub(super) from: Surface<'d>,
    pub(super) to: &'d DistanceTarget<'d>,
    pub(super) view: ScaledSight<'v>,
    pub(super) common: &'d Common<'d>,
    pub(super) options: &'d DistanceOptions,
    pub(super) budget: &'d Budget,
}

/// A triangle close to a vertex, and its distance: the closest one, or one that is no farther than the farthest point that was
/// known when it was looked at.
#[derive(Debug, Clone, Copy)]
struct AtVertex {
    closest_triangle: u32,
    distance: f64,
}

/// Sums over samples.
#[derive(Debug, Clone, Copy)]
struct Sampled {
    /// Samples that were taken.
    taken: u32,
    /// Of those, what counts.
    count: u32,
    /// Of those, what is lost.
    lost: u32,
    sum: f64,
    sum_of_squares: f64,
    farthest: Farthest,
}

impl Sampled {
    const NONE: Self =
        Self { taken: 0, count: 0, lost: 0, sum: 0.0, sum_of_squares: 0.0, farthest: Farthest::NONE };
}

/// Units of work that a triangle counts over which a bound walks, and that a unit of refinement counts.
const WALKED: u64 = 4;
const REFINED: u64 = 16;

/// Vertices or samples looked at by one task.
const POINTS_OF_TASK: usize = 1024;

/// Pieces that are refined before it is seen how far the farthest point is now and which have the largest bounds: few at first.
const WAVES: std::ops::RangeInclusive<usize> = 64..=256;

/// Share of the largest bound at which pieces wait for the next wave.
const GOAL: f64 = 0.8;

/// Pieces that one task refines.
const PIECES_OF_TASK: usize = 16;

/// Samples that are taken first to see what one costs.
const PILOTS: usize = 1 << 10;

/// Boxes that may be looked at for all samples, whatever the size of the surfaces, and for each of their triangles. Most
/// samples take a few dozen; those on a disc of very many thin triangles thousands.
const SAMPLED_BOXES: u64 = 1 << 23;
const SAMPLED_BOXES_OF_TRIANGLE: u64 = 16;

/// A piece that waits, those with larger bounds first.
struct Waiting(Piece);

impl Waiting {
    /// Bounds are not negative, so that their bits are in the order of the numbers.
    fn key(&self) -> (u64, std::cmp::Reverse<u32>, [u64; 9]) {
        let places = self.0.corners.map(|corner| corner.place.to_array().map(f64::to_bits));
        let mut bits = [0; 9];
        bits.iter_mut().zip(places.as_flattened()).for_each(|(to, from)| *to = *from);
        (self.0.upper.to_bits(), std::cmp::Reverse(self.0.triangle), bits)
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.key().cmp(&other.key())
    }
}

impl Directed<'_, '_> {
    pub(super) fn measure(&self) -> Result<DirectedDistance, Stopped> {
        let _charge = self.budget.charge(self.from.positions.len() as u64 * 16)?;
        let sampled = self.at_samples()?;
        let (vertices, known) = self.at_vertices(sampled.farthest)?;
        let mut upper = 0.0;
        let (candidates, farthest) = self.candidates(&vertices, known, &mut upper)?;
        let _charge = self.budget.charge(candidates.len() as u64 * 16)?;
        let farthest = self.refine_all(&vertices, &candidates, farthest, &mut upper)?;
        let share = |part: f64, all: u32| (all > 0).then(|| part / f64::from(all));
        let mean_of = |sum: f64| share(sum, sampled.count);
        let seen = self.options.lost_beyond.map(|_| AreaShares {
            hidden_share: share(f64::from(sampled.taken - sampled.count), sampled.taken).unwrap_or(0.0),
            lost_share: share(f64::from(sampled.lost), sampled.count).unwrap_or(0.0),
        });
        let lower = farthest.distance.max(0.0);
        Ok(DirectedDistance {
            upper: upper.max(lower) + self.common.slack,
            lower,
            is_within_tolerance: upper <= self.tolerance().enough(lower),
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

    /// A triangle close to each vertex that a triangle uses, and the farther of what is `known` and of the farthest vertex. Where
    /// the triangle of a neighbour is no farther than the farthest point so far, none closer is searched: the vertex can then be no
    /// farther than that point, which is all that a bound needs.
    fn at_vertices(&self, known: Farthest) -> Result<(Vec<AtVertex>, Farthest), Stopped> {
        const UNUSED: u32 = u32::MAX;
        let mut triangle_of = vec![UNUSED; self.from.positions.len()];
        for (t, corners) in self.from.triangles.iter().enumerate() {
            corners.iter().for_each(|&v| triangle_of[v as usize] = t as u32);
        }
        let parts = par::try_map_ranges(triangle_of.len(), POINTS_OF_TASK, |range| {
            let (first, mut found) = (range.start, Vec::<AtVertex>::with_capacity(range.len()));
            let (mut last, mut farthest, mut look) = (None, known, self.view.look());
            self.budget.spend(range.len() as u64)?;
            for v in range {
                let (place, triangle) = (self.from.positions[v], triangle_of[v]);
                if triangle == UNUSED {
                    found.push(AtVertex { closest_triangle: 0, distance: 0.0 });
                    continue;
                }
                let corners = self.from.triangles[triangle as usize].map(|u| u as usize);
                let neighbour = corners.into_iter().filter(|u| (first..v).contains(u)).max();
                let hint = neighbour.map(|u| found[u - first].closest_triangle).or(last);
                let close = hint.map(|t| self.to.near.on_triangle(place, t));
                if let Some(close) = close.filter(|close| close.distance <= farthest.distance) {
                    found.push(AtVertex { closest_triangle: close.triangle, distance: close.distance });
                    continue;
                }
                let close = self.to.find(place, hint, self.budget)?;
                if let Some(Found { nearest, is_exact, .. }) = close {
                    last = Some(nearest.triangle);
                    let is_farther = is_exact && nearest.distance > farthest.distance;
                    if is_farther && self.view.counts(&mut look, place, triangle)? {
                        farthest = Farthest::at(place, triangle, &nearest);
                    }
                }
                let nearest = close.map(|close| close.nearest);
                let (closest_triangle, distance) = nearest.map_or((0, 0.0), |n| (n.triangle, n.distance));
                found.push(AtVertex { closest_triangle, distance });
            }
            Ok((found, farthest))
        })?;
        let farthest = parts.iter().fold(known, |so_far, (_, farthest)| so_far.or(*farthest));
        Ok((parts.into_iter().flat_map(|(found, _)| found).collect(), farthest))
    }

    /// The distances at the samples that count: as many as were asked for, or as some are seen to allow.
    fn at_samples(&self) -> Result<Sampled, Stopped> {
        let asked = self.options.samples as usize;
        let areas = Areas::of(self.from, self.budget)?;
        if asked <= PILOTS {
            return Ok(self.at_some_samples(&areas, asked)?.0);
        }
        let (pilots, boxes) = self.at_some_samples(&areas, PILOTS)?;
        let triangles = (self.from.triangles.len() + self.to.near.len()) as u64;
        let boxes_max = SAMPLED_BOXES + SAMPLED_BOXES_OF_TRIANGLE * triangles;
        let affordable = boxes_max as f64 / (boxes as f64 / PILOTS as f64).max(1.0);
        match (affordable as usize).min(asked) {
            few if few <= PILOTS => Ok(pilots),
            count => Ok(self.at_some_samples(&areas, count)?.0),
        }
    }

    /// The distances at `count` samples, and the boxes that were looked at.
    fn at_some_samples(&self, areas: &Areas, count: usize) -> Result<(Sampled, u64), Stopped> {
        let parts = par::try_map_ranges(count, POINTS_OF_TASK, |range| {
            self.budget.spend(range.len() as u64)?;
            let mut of = Sampled { taken: range.len() as u32, ..Sampled::NONE };
            let (mut hint, mut boxes, mut look) = (None, 0, self.view.look());
            for k in range {
                let sample = areas.sample(self.from, k, count);
                if !self.view.counts(&mut look, sample.place, sample.triangle)? {
                    continue;
                }
                let found = self.to.near.find_roughly(sample.place, hint, usize::MAX, self.budget)?;
                if let Some(Found { nearest, boxes: looked_at, .. }) = found {
                    hint = Some(nearest.triangle);
                    boxes += looked_at as u64;
                    of.count += 1;
                    of.lost += u32::from(self.view.loses(nearest.distance));
                    of.sum += nearest.distance;
                    of.sum_of_squares += nearest.distance * nearest.distance;
                    of.farthest = of.farthest.or(Farthest::at(sample.place, sample.triangle, &nearest));
                }
            }
            Ok((of, boxes))
        })?;
        Ok(parts.into_iter().fold((Sampled::NONE, 0), |(all, boxes), (part, more)| {
            let sum = Sampled {
                taken: all.taken + part.taken,
                count: all.count + part.count,
                lost: all.lost + part.lost,
                sum: all.sum + part.sum,
                sum_of_squares: all.sum_of_squares + part.sum_of_squares,
                farthest: all.farthest.or(part.farthest),
            };
            (sum, boxes + more)
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
            let (mut farthest, mut above, mut look) = (known, Vec::new(), self.view.look());
            for t in range {
                let bound = self.triangle_bound(vertices, &mut look, t as u32, &mut farthest)?;
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
    fn triangle_bound(
        &self,
        vertices: &[AtVertex],
        look: &mut Option<VisibilitySearch<'_>>,
        t: u32,
        farthest: &mut Farthest,
    ) -> Result<f64, Stopped> {
        let corners = self.corners(vertices, t);
        let enough = self.tolerance().enough(farthest.distance);
        let bound = upper_bound(&self.to.near, &corners, enough);
        if bound <= enough {
            return Ok(bound);
        }
        let middle = (corners[0].place + corners[1].place + corners[2].place) / 3.0;
        self.budget.spend(1)?;
        let Some(found) = self.to.find(middle, Some(corners[0].closest_triangle), self.budget)? else {
            return Ok(bound);
        };
        match self.view.visible(look, &corners, t)? {
            VisiblePart::Nothing => return Ok(0.0),
            VisiblePart::At(place) => {
                *farthest = farthest.or_seen(self.to, place, t, found.nearest.triangle, self.budget)?;
            }
            VisiblePart::All => {}
        }
        let nearest = found.nearest;
        let is_farther = found.is_exact && nearest.distance > farthest.distance;
        if is_farther && self.view.counts(look, middle, t)? {
            *farthest = Farthest::at(middle, t, &nearest);
        }
        let from_one = corners.map(|c| self.to.near.on_triangle(c.place, nearest.triangle).distance);
        let bound = bound.min(from_one.into_iter().fold(0.0, f64::max));
        if bound <= enough {
            return Ok(bound);
        }
        let (covered, walked) =
            self.to.cloth.bound(&corners, nearest.point - middle, nearest.triangle, bound);
        self.budget.spend(walked * WALKED)?;
        Ok(covered.map_or(bound, |covered| covered.min(bound)))
    }

    /// Refines in waves what has the largest bounds, candidates and parts of them; `upper` grows to the bound of
    /// everything that was put aside.
    fn refine_all(
        &self,
        vertices: &[AtVertex],
        candidates: &[(f64, u32)],
        mut farthest: Farthest,
        upper: &mut f64,
    ) -> Result<Farthest, Stopped> {
        let tolerance = self.tolerance();
        let (mut next, mut wave_len, mut work) = (0, *WAVES.start(), 0);
        let mut waiting: BinaryHeap<Waiting> = BinaryHeap::new();
        let mut wave: Vec<Piece> = Vec::new();
        let largest = |waiting: &BinaryHeap<Waiting>, next: usize| {
            let of_candidate = candidates.get(next).map(|&(bound, _)| bound);
            of_candidate.into_iter().chain(waiting.peek().map(|piece| piece.0.upper)).reduce(f64::max)
        };
        let start = self.budget.work_used();
        let may_go_on = || self.budget.work_used() - start < self.options.refining_work_max;
        while work < self.options.refinements_max && may_go_on() {
            let enough = tolerance.enough(farthest.distance);
            // No more pieces than the work that is left is enough for.
            let most = ((self.options.refinements_max - work) / WORK_MAX + 1).min(wave_len as u64) as usize;
            let goal = largest(&waiting, next).map_or(enough, |bound| enough.max(bound * GOAL));
            wave.clear();
            while wave.len() < most && largest(&waiting, next).is_some_and(|bound| bound > goal) {
                let is_candidate = candidates
                    .get(next)
                    .is_some_and(|&(bound, _)| waiting.peek().is_none_or(|p| p.0.upper < bound));
                if let (true, Some(&(upper, t))) = (is_candidate, candidates.get(next)) {
                    let corners = self.corners(vertices, t);
                    // It was asked about when it became one.
                    wave.push(Piece { corners, triangle: t, upper, is_seen: true });
                    next += 1;
                } else if let Some(Waiting(piece)) = waiting.pop() {
                    wave.push(piece);
                }
            }
            if wave.is_empty() {
                break;
            }
            for Refined { farthest: found, upper: aside, left, work: spent } in
                self.refine_wave(&wave, farthest, goal)?
            {
                farthest = farthest.or(found);
                *upper = upper.max(aside);
                waiting.extend(left.into_iter().map(Waiting));
                work += spent;
            }
            wave_len = (2 * wave_len).min(*WAVES.end());
        }
        *upper = upper.max(largest(&waiting, next).unwrap_or(0.0));
        Ok(farthest)
    }

    fn refine_wave(&self, wave: &[Piece], farthest: Farthest, goal: f64) -> Result<Vec<Refined>, Stopped> {
        let Self { to, view, budget, .. } = self;
        let refining = Refining { to, view, tolerance: self.tolerance(), goal, budget };
        let parts = par::try_map_ranges(wave.len(), PIECES_OF_TASK, |range| {
            let (mut all, mut look) = (Vec::with_capacity(range.len()), self.view.look());
            for &piece in &wave[range] {
                let refined = refining.refine(&mut look, piece, farthest)?;
                self.budget.spend(refined.work * REFINED)?;
                all.push(refined);
            }
            Ok(all)
        })?;
        Ok(parts.into_iter().flatten().collect())
    }
}
