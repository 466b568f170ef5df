//! A field of many centres, made of overlapping parts with smooth weights that sum to one.
//!
//! One dense system costs the cube of its centres, so many are divided: space is cut into boxes with few sites each, and
//! each box, widened by a margin, has a field of its own; the fields are blended by weights that fall to zero at the
//! ends of the widened boxes (partition of unity: Wendland 2002; Tobor, Reuter and Schlick 2004). What is usual for
//! dense scans would fail at a hole: its middle has no points, and a field of the points on one side of it knows nothing
//! of the others. So each part also takes far sites, ever sparser with their distance, and is a field of the whole
//! hole that is exact near its box and coarse elsewhere. All values at centres are taken exactly.

use super::centres::Site;
use super::options::Kernel;
use super::system::{Solution, solve};
use super::unfit::Unfit;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::par;

/// The most sites in a box before it is widened.
const BOX_SITES_MAX: usize = 48;
/// What a box is widened by on each side, as a share of its extent; halved while that brings too many sites.
const MARGIN_SHARE: f64 = 0.3;
const MARGIN_SHARE_MIN: f64 = 0.01;
/// The most sites in a widened box.
const WIDE_SITES_MAX: usize = 6 * BOX_SITES_MAX;
/// A far site is taken when no chosen one is closer to it than this share of its distance from the box.
const SPACING_SHARE: f64 = 0.35;
/// Sites that are ordered from coarse to fine. Work grows with it times the number of sites.
const ORDERED_MAX: usize = 2_048;

/// A box with its margin, and the field of the sites in it.
#[derive(Debug, Clone)]
struct Subdomain {
    middle: DVec3,
    /// From the middle to the ends of the widened box, below and above; infinite where nothing lies beyond.
    reach: [DVec3; 2],
    solution: Solution,
}

impl Subdomain {
    /// The weight at `p` and its gradient: the product over the axes of (1 - t^2)^3.
    fn weight(&self, p: DVec3) -> Option<(f64, DVec3)> {
        let away = (p - self.middle).to_array();
        let mut factors = [0.0; 3];
        let mut slopes = [0.0; 3];
        for axis in 0..3 {
            let reach = if away[axis] < 0.0 { self.reach[0][axis] } else { self.reach[1][axis] };
            let t = away[axis] / reach;
            let rest = 1.0 - t * t;
            if rest <= 0.0 {
                return None;
            }
            factors[axis] = rest * rest * rest;
            slopes[axis] = -6.0 * t * rest * rest / reach;
        }
        let [x, y, z] = factors;
        Some((x * y * z, DVec3::new(slopes[0] * y * z, x * slopes[1] * z, x * y * slopes[2])))
    }
}

/// Fields of overlapping boxes.
#[derive(Debug, Clone)]
pub(super) struct Partition {
    parts: Vec<Subdomain>,
}

impl Partition {
    /// Fits the parts. O(n) parts of bounded size.
    pub(super) fn fit(
        kernel: Kernel,
        sites: &[Site],
        budget: &Budget,
    ) -> Result<Result<Self, Unfit>, Stopped> {
        let spacing = spacings(sites, budget)?;
        let boxes = boxes(sites, budget)?;
        let fit = |_, cell: PartitionCell| -> Result<Result<Subdomain, Unfit>, Stopped> {
            let (reach, mut chosen) = cell.choose(sites, &spacing);
            let middle = (cell.low + cell.high) * 0.5;
            let has_offsets = |&i: &u32| sites[i as usize].has != [false; 2];
            if !chosen.iter().any(has_offsets) {
                // A field without offset centres would be zero everywhere.
                let apart = |i: u32| sites[i as usize].point.distance_squared(middle);
                let with_offsets = (0..sites.len() as u32).filter(has_offsets);
                chosen.extend(with_offsets.min_by(|&i, &k| apart(i).total_cmp(&apart(k))));
            }
            let (points, values): (Vec<DVec3>, Vec<f64>) =
                chosen.iter().flat_map(|&i| sites[i as usize].centres()).unzip();
            budget.spend(points.len() as u64)?;
            Ok(solve(kernel, &points, &values, budget)?.map(|solution| Subdomain { middle, reach, solution }))
        };
        let parts: Result<Vec<_>, Stopped> = par::map_items(boxes, fit).into_iter().collect();
        Ok(parts?.into_iter().collect::<Result<Vec<_>, Unfit>>().map(|parts| Self { parts }))
    }

    pub(super) fn solutions(&self) -> impl Iterator<Item = &Solution> {
        self.parts.iter().map(|part| &part.solution)
    }

    /// The blend of what `of` gives for the parts around `p`.
    pub(super) fn value(&self, p: DVec3, of: impl Fn(&Solution) -> f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for part in &self.parts {
            if let Some((weight, _)) = part.weight(p) {
                sum += weight * of(&part.solution);
                weights += weight;
            }
        }
        sum / weights
    }

    /// The blend of values and its gradient.
    pub(super) fn value_and_gradient(
        &self,
        p: DVec3,
        of: impl Fn(&Solution) -> (f64, DVec3),
    ) -> (f64, DVec3) {
        let (mut sum, mut weights) = (0.0, 0.0);
        let (mut slope, mut drift) = (DVec3::ZERO, DVec3::ZERO);
        for part in &self.parts {
            if let Some((weight, change)) = part.weight(p) {
                let (value, gradient) = of(&part.solution);
                sum += weight * value;
                weights += weight;
                slope += change * value + gradient * weight;
                drift += change;
            }
        }
        let value = sum / weights;
        (value, (slope - drift * value) / weights)
    }
}

/// A box of the division of space, and the sites in it.
struct PartitionCell {
    low: DVec3,
    high: DVec3,
    sites: Vec<u32>,
    /// Where the box ends with everything: nothing lies beyond.
    is_end: [[bool; 3]; 2],
}

impl PartitionCell {
    /// How far the widened box reaches from the middle, and the sites of its field.
    fn choose(&self, sites: &[Site], spacing: &[f64]) -> ([DVec3; 2], Vec<u32>) {
        let extent = self.high - self.low;
        let gap = |p: DVec3, margin: DVec3| {
            let outside = |axis: usize| {
                let below = if self.is_end[0][axis] { 0.0 } else { self.low[axis] - margin[axis] - p[axis] };
                let above = if self.is_end[1][axis] { 0.0 } else { p[axis] - self.high[axis] - margin[axis] };
                below.max(above).max(0.0)
            };
            DVec3::new(outside(0), outside(1), outside(2)).length()
        };
        let mut share = MARGIN_SHARE;
        let mut margin = extent * share;
        let within =
            |margin: DVec3| (0..sites.len()).filter(move |&i| gap(sites[i].point, margin) == 0.0).count();
        while share > MARGIN_SHARE_MIN && within(margin) > WIDE_SITES_MAX {
            share *= 0.5;
            margin = extent * share;
        }
        let mut chosen: Vec<u32> = (0..sites.len() as u32)
            .filter(|&i| spacing[i as usize] >= SPACING_SHARE * gap(sites[i as usize].point, margin))
            .collect();
        if chosen.len() > 2 * WIDE_SITES_MAX {
            // Only where sites crowd at the end of a large box; the coarsest ones then stand for the others.
            chosen.sort_by(|&a, &b| spacing[b as usize].total_cmp(&spacing[a as usize]).then(a.cmp(&b)));
            chosen.truncate(2 * WIDE_SITES_MAX);
            chosen.sort_unstable();
        }
        let half = extent * 0.5 + margin;
        let reach = |side: usize| {
            DVec3::from_array(std::array::from_fn(
                |a| if self.is_end[side][a] { f64::INFINITY } else { half[a] },
            ))
        };
        ([reach(0), reach(1)], chosen)
    }
}

/// Space cut at medians of sites into boxes with few of them.
fn boxes(sites: &[Site], budget: &Budget) -> Result<Vec<PartitionCell>, Stopped> {
    let extent = Aabb::of(sites.iter().map(|site| site.point));
    let all = PartitionCell {
        low: extent.min,
        high: extent.max,
        sites: (0..sites.len() as u32).collect(),
        is_end: [[true; 3]; 2],
    };
    let (mut done, mut open) = (Vec::new(), vec![all]);
    while let Some(cell) = open.pop() {
        budget.spend(cell.sites.len() as u64)?;
        if cell.sites.len() <= BOX_SITES_MAX {
            done.push(cell);
        } else {
            open.extend(halves(cell, sites));
        }
    }
    Ok(done)
}

fn halves(mut cell: PartitionCell, sites: &[Site]) -> [PartitionCell; 2] {
    let tight = Aabb::of(cell.sites.iter().map(|&i| sites[i as usize].point));
    let size = tight.max - tight.min;
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let at = |i: u32| sites[i as usize].point[axis];
    cell.sites.sort_by(|&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
    let above = cell.sites.split_off(cell.sites.len() / 2);
    let cut = 0.5 * (at(cell.sites[cell.sites.len() - 1]) + at(above[0]));
    let mut other = PartitionCell { low: cell.low, high: cell.high, sites: above, is_end: cell.is_end };
    other.low[axis] = cut;
    other.is_end[0][axis] = false;
    cell.high[axis] = cut;
    cell.is_end[1][axis] = false;
    [cell, other]
}

/// For each site how far it was from all earlier ones when each next site is the one farthest from those before
/// (Gonzalez 1985): the sites with at least some spacing cover all others at that distance. Sites past the first
/// [`ORDERED_MAX`] have the spacing 0.
fn spacings(sites: &[Site], budget: &Budget) -> Result<Vec<f64>, Stopped> {
    let mut spacing = vec![0.0; sites.len()];
    let mut apart = vec![f64::INFINITY; sites.len()];
    let mut next = 0;
    for _ in 0..sites.len().min(ORDERED_MAX) {
        spacing[next] = apart[next].sqrt();
        let from = sites[next].point;
        let near = |range: std::ops::Range<usize>| {
            let distances = sites[range.clone()].iter().map(|site| site.point.distance_squared(from));
            distances.zip(&apart[range]).map(|(d, &a)| d.min(a)).collect::<Vec<_>>()
        };
        apart = par::map_ranges(sites.len(), CHECK_EVERY, near).concat();
        next = (0..apart.len()).fold(0, |best, i| if apart[i] > apart[best] { i } else { best });
        budget.spend(sites.len() as u64)?;
        if apart[next] == 0.0 {
            break;
        }
    }
    Ok(spacing)
}
