//! How thick walls are, and how wide the gaps between them, by samples.
//!
//! The number of samples is bounded, so that the time is too: four for each triangle, but at least [`SAMPLES_MIN`] and at
//! most [`SAMPLES_MAX`], spread evenly over the area; and, where there are at most [`MIDDLES_MAX`] triangles, the middle
//! of each, so that small walls of small meshes are not missed. Figures about shares of the area are from the former alone.
//! Where a sample must look at thousands of triangles, as below a disc that is a fan of very many, fewer are taken.

use super::ray::Ray;
use super::surface::WeldedSurface;
use super::{Limit, PrintingWitness, ball};
use crate::budget::{Budget, Stopped};
use crate::distance::{self, Areas};
use crate::geom::DVec3;
use crate::par;
use crate::spatial::NearestSearch;

const SAMPLES_MIN: usize = 1 << 12;
const SAMPLES_MAX: usize = 1 << 15;
const MIDDLES_MAX: usize = 1 << 14;

/// Samples that are taken first to see what one costs, and the least that are taken.
const PILOTS: usize = 1 << 10;

/// Triangles that may be looked at for all samples of one side, whatever the size of the mesh, and for each of its triangles.
/// Most samples look at a few dozen.
const LOOKED_AT_MAX: u64 = 1 << 25;
const LOOKED_AT_OF_TRIANGLE: u64 = 16;

/// Samples that one thread handles at a time.
const CHUNK: usize = 256;

/// Witnesses are farther from each other than this share of the diagonal.
const APART: f64 = 0.02;

/// Samples among which witnesses are looked for, for each of them.
const CANDIDATES_OF_WITNESS: usize = 512;

/// Which side of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SurfaceSide {
    /// Walls.
    Inside,
    /// Gaps.
    Outside,
}

/// Figures of one definition, in the unit of the file, over the samples that have a wall opposite.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    /// The smallest.
    pub min: Option<f64>,
    /// A twentieth of the area has less.
    pub p5: Option<f64>,
    /// Half of the area has less.
    pub median: Option<f64>,
    /// Share of the whole area, from 0 to 1, that has a figure.
    pub measured_share: f64,
}

/// Thickness of walls, or width of gaps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Thickness {
    /// Along the normal to the opposite wall.
    pub ray: Spread,
    /// Diameter of the largest ball that touches the surface there and holds nothing of it.
    pub sphere: Spread,
    /// Area below the limit of a warning, in square units of the file; `None`: no limit.
    pub area_below_warning: Option<f64>,
    /// Area below the limit of an error, in square units of the file; `None`: no limit.
    pub area_below_error: Option<f64>,
    /// Samples below a limit, the thinnest first, apart from each other.
    pub witnesses: Vec<PrintingWitness>,
    /// Samples by area.
    pub samples: u64,
}

impl Thickness {
    /// The least of both definitions.
    pub fn least(&self) -> Option<f64> {
        match (self.ray.min, self.sphere.min) {
            (Some(ray), Some(sphere)) => Some(ray.min(sphere)),
            (ray, sphere) => ray.or(sphere),
        }
    }
}

/// What was measured at one place.
#[derive(Debug, Clone, Copy)]
struct WallReading {
    place: DVec3,
    triangle: u32,
    ray: Option<f64>,
    sphere: Option<f64>,
    /// Triangles that were looked at.
    looked_at: u64,
}

impl WallReading {
    fn least(&self) -> Option<f64> {
        let all = [self.ray, self.sphere].into_iter().flatten();
        all.min_by(f64::total_cmp)
    }
}

/// A surface prepared for being measured.
pub(super) struct Probe<'p> {
    surface: &'p WeldedSurface<'p>,
    search: &'p NearestSearch<'p>,
    areas: &'p Areas,
    budget: &'p Budget,
}

impl<'p> Probe<'p> {
    pub(super) fn new(
        surface: &'p WeldedSurface<'p>,
        search: &'p NearestSearch<'p>,
        areas: &'p Areas,
        budget: &'p Budget,
    ) -> Self {
        Self { surface, search, areas, budget }
    }

    /// Measures one side of the surface, with at most `witnesses` witnesses.
    pub(super) fn measure(
        &self,
        side: SurfaceSide,
        limit: &Limit,
        witnesses: usize,
    ) -> Result<Thickness, Stopped> {
        let len = self.surface.triangles.len();
        let wanted = (4 * len).clamp(SAMPLES_MIN, SAMPLES_MAX);
        let middles = if len <= MIDDLES_MAX { len } else { 0 };
        let pilots = self.by_area(PILOTS, side)?;
        let looked_at: u64 = pilots.iter().map(|reading| reading.looked_at).sum();
        let most = LOOKED_AT_MAX + LOOKED_AT_OF_TRIANGLE * len as u64;
        let affordable = most as f64 / (looked_at as f64 / PILOTS as f64).max(1.0);
        let count = wanted.min((affordable as usize).max(PILOTS));
        let by_area = if count == PILOTS { pilots } else { self.by_area(count, side)? };
        let middles = if middles as f64 <= affordable { middles } else { 0 };
        let in_middles = self.readings(middles, side, |k| {
            (self.surface.corners(k as u32).iter().sum::<DVec3>() / 3.0, k as u32)
        })?;
        let all: Vec<WallReading> = by_area.iter().chain(&in_middles).copied().collect();
        let share_below = |bound: f64| {
            let below = by_area.iter().filter(|reading| reading.least().is_some_and(|least| least < bound));
            below.count() as f64 / count as f64
        };
        let area_below = |bound: Option<f64>| bound.map(|bound| share_below(bound) * self.areas.total());
        Ok(Thickness {
            ray: spread(&by_area, &all, |reading| reading.ray),
            sphere: spread(&by_area, &all, |reading| reading.sphere),
            area_below_warning: area_below(limit.warning),
            area_below_error: area_below(limit.error),
            witnesses: self.witnesses(&all, limit, witnesses)?,
            samples: count as u64,
        })
    }

    /// What is measured at `count` places that are spread evenly over the surface.
    fn by_area(&self, count: usize, side: SurfaceSide) -> Result<Vec<WallReading>, Stopped> {
        let of = distance::Surface { positions: self.surface.positions, triangles: &self.surface.triangles };
        self.readings(count, side, |k| {
            let sample = self.areas.sample(of, k, count);
            (sample.place, sample.triangle)
        })
    }

    fn readings(
        &self,
        count: usize,
        side: SurfaceSide,
        place: impl Fn(usize) -> (DVec3, u32) + Sync,
    ) -> Result<Vec<WallReading>, Stopped> {
        let parts = par::try_map_ranges(count, CHUNK, |range| {
            self.budget.spend(range.len() as u64)?;
            range.map(|k| self.read(place(k), side)).collect::<Result<Vec<_>, _>>()
        })?;
        Ok(parts.into_iter().flatten().collect())
    }

    fn read(&self, (place, triangle): (DVec3, u32), side: SurfaceSide) -> Result<WallReading, Stopped> {
        let normal = self.surface.normals[triangle as usize];
        let is_inside = side == SurfaceSide::Inside;
        let along = if is_inside { -normal } else { normal };
        let ray = Ray { from: place, along, own: triangle, is_inside };
        let (hit, looked_at) = ray.first_hit(self.surface, self.search.bvh(), self.budget)?;
        let nothing = WallReading { place, triangle, ray: None, sphere: None, looked_at };
        let Some(hit) = hit else { return Ok(nothing) };
        let is_opposite = self.surface.are_opposite(triangle, hit.triangle);
        let sphere = ball::diameter(&ray, hit, self.surface, self.search, self.budget)?;
        Ok(WallReading { ray: is_opposite.then_some(hit.distance), sphere, ..nothing })
    }

    /// The thinnest places below the first limit, apart from each other.
    fn witnesses(
        &self,
        readings: &[WallReading],
        limit: &Limit,
        most: usize,
    ) -> Result<Vec<PrintingWitness>, Stopped> {
        let Some(bound) = limit.first_below() else { return Ok(Vec::new()) };
        let measured = readings.iter().enumerate().filter_map(|(k, reading)| Some((reading.least()?, k)));
        let mut thin: Vec<(f64, usize)> = measured.filter(|&(least, _)| least < bound).collect();
        thin.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let apart = APART * self.surface.diagonal();
        let mut chosen: Vec<PrintingWitness> = Vec::new();
        for (least, k) in thin.into_iter().take(CANDIDATES_OF_WITNESS * most) {
            let WallReading { place, triangle, .. } = readings[k];
            self.budget.check()?;
            if chosen.len() == most {
                break;
            }
            if chosen.iter().all(|witness| witness.place.distance(place) > apart) {
                chosen.push(self.surface.witness(triangle, place, least));
            }
        }
        Ok(chosen)
    }
}

/// Shares of the area from `by_area`, the smallest of `all`.
fn spread(by_area: &[WallReading], all: &[WallReading], of: impl Fn(&WallReading) -> Option<f64>) -> Spread {
    let mut values: Vec<f64> = by_area.iter().filter_map(&of).collect();
    values.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| values.get((share * values.len() as f64) as usize).copied();
    Spread {
        min: all.iter().filter_map(&of).min_by(f64::total_cmp),
        p5: at(0.05),
        median: at(0.5),
        measured_share: values.len() as f64 / by_area.len().max(1) as f64,
    }
}
