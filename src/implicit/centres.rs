//! The centres of the system, from the points of a band: moved and scaled, without those that coincide.

use super::band::Band;
use super::cells::{PointCells, QUESTIONS};
use super::offsets::Offsets;
use super::options::{ConstraintValues, RbfOptions};
use super::polynomial::{TERMS, dot, rank, terms};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};

/// An offset centre closer to another centre than this share of lambda is left out: it repeats the other or
/// contradicts it, and either makes the system singular.
const APART_SHARE: f64 = 0.05;
/// Times that offsets which are left out may be made good by others.
const PARTINGS: usize = 4;
/// Points closer to one another than this share of the extent are one point.
const SAME_SHARE: f64 = 1e-9;

/// A point of the band in the coordinates of the system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Site {
    pub point: DVec3,
    /// Centres at the end of point + offset and point - offset, with values `value` and -`value`; both 0 where there is no room
    /// for them.
    pub offset: DVec3,
    pub value: f64,
    /// Whether the offset centres outside and inside of the surface are there.
    pub has: [bool; 2],
}

impl Site {
    /// The centres of the site with their values; the one on the surface first.
    pub(super) fn centres(&self) -> impl Iterator<Item = (DVec3, f64)> {
        let outside = self.has[0].then_some((self.point + self.offset, self.value));
        let inside = self.has[1].then_some((self.point - self.offset, -self.value));
        [Some((self.point, 0.0)), outside, inside].into_iter().flatten()
    }
}

/// Where the origin of the system is and how long its unit is, so that the centres are within about a unit of 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct UnitFrame {
    pub origin: DVec3,
    pub unit: f64,
}

impl UnitFrame {
    pub(super) fn of(points: &[DVec3]) -> Self {
        let extent = Aabb::of(points.iter().copied());
        // Halves first: the sum of large coordinates may leave the range of f64.
        Self { origin: extent.min * 0.5 + extent.max * 0.5, unit: extent.diagonal() * 0.5 }
    }

    pub(super) fn inward(&self, p: DVec3) -> DVec3 {
        (p - self.origin) / self.unit
    }
}

/// The sites of a band in the order of its points; points at one place are one site, with the normal of the first.
pub(super) fn sites(
    band: &Band,
    offsets: &Offsets,
    options: &RbfOptions,
    frame: &UnitFrame,
    budget: &Budget,
) -> Result<Vec<Site>, Stopped> {
    let places: Vec<DVec3> = band.points.iter().map(|&p| frame.inward(p)).collect();
    let first_at = PointCells::new(&places, SAME_SHARE).first_within(SAME_SHARE, budget)?;
    let mut sites = Vec::with_capacity(places.len());
    let mut with_room = 0;
    for (i, &point) in places.iter().enumerate() {
        if first_at[i] != i as u32 {
            continue;
        }
        let lambda = offsets.lambdas[i] / frame.unit;
        let value = if options.values == ConstraintValues::Unit && lambda > 0.0 { 1.0 } else { lambda };
        let has_room = lambda > 0.0;
        let has = [has_room && keeps_offsets(with_room, options.share); 2];
        with_room += usize::from(has_room);
        sites.push(Site { point, offset: band.normals[i].normalize() * lambda, value, has });
    }
    let mut is_parted = vec![false; sites.len()];
    for round in 0..PARTINGS {
        let gained = restore_rank(&mut sites, &is_parted, budget)?;
        if round > 0 && !gained {
            break;
        }
        let parted = part(&mut sites, budget)?;
        if parted.is_empty() {
            break;
        }
        for i in parted {
            is_parted[i] = true;
        }
    }
    Ok(sites)
}

/// True for `share` of all numbers, spread evenly.
fn keeps_offsets(i: usize, share: f64) -> bool {
    let count = |i: usize| (i as f64 * share).ceil();
    count(i + 1) > count(i)
}

/// Gives offsets back to the sites that bring most until the centres tell as many polynomials apart as they would
/// with all offsets, but for those at sites that have been parted. `false`: none was given.
fn restore_rank(sites: &mut [Site], is_parted: &[bool], budget: &Budget) -> Result<bool, Stopped> {
    let may_get: Vec<bool> =
        sites.iter().zip(is_parted).map(|(site, &is_parted)| site.value > 0.0 && !is_parted).collect();
    if sites.iter().zip(&may_get).all(|(site, &may_get)| site.has[0] || !may_get) {
        return Ok(false);
    }
    let mut has_gained = false;
    let all: Vec<DVec3> = sites
        .iter()
        .zip(&may_get)
        .map(|(site, &may_get)| if may_get { Site { has: [true; 2], ..*site } } else { *site })
        .flat_map(|site| site.centres().map(|(p, _)| p).collect::<Vec<_>>())
        .collect();
    let wanted = rank(&all, TERMS);
    for _ in 0..TERMS {
        budget.spend(sites.len() as u64)?;
        let kept: Vec<DVec3> = sites.iter().flat_map(Site::centres).map(|(p, _)| p).collect();
        if rank(&kept, TERMS) >= wanted {
            break;
        }
        let basis = row_basis(&kept);
        let gain =
            |site: &Site| beyond(&basis, site.point + site.offset) + beyond(&basis, site.point - site.offset);
        let missing = (0..sites.len()).filter(|&i| !sites[i].has[0] && may_get[i]);
        let best = missing.fold(None, |best: Option<(usize, f64)>, i| {
            let gain = gain(&sites[i]);
            if best.is_some_and(|(_, most)| most >= gain) { best } else { Some((i, gain)) }
        });
        let Some((best, _)) = best else { break };
        sites[best].has = [true; 2];
        has_gained = true;
    }
    Ok(has_gained)
}

/// An orthonormal basis of the rows of the polynomials at `points`, the longest first.
fn row_basis(points: &[DVec3]) -> Vec<[f64; TERMS]> {
    let mut basis: Vec<[f64; TERMS]> = Vec::new();
    for _ in 0..rank(points, TERMS) {
        let rests = points.iter().map(|&p| rest_of(&basis, p));
        let longest = rests.fold([0.0; TERMS], |a, b| if dot(&b, &b) > dot(&a, &a) { b } else { a });
        let length = dot(&longest, &longest).sqrt();
        basis.push(longest.map(|x| x / length));
    }
    basis
}

fn rest_of(basis: &[[f64; TERMS]], p: DVec3) -> [f64; TERMS] {
    let mut row = terms(p);
    for b in basis {
        let share = dot(&row, b);
        row.iter_mut().zip(b).for_each(|(x, b)| *x -= share * b);
    }
    row
}

/// The squared length of what the basis does not span of the polynomials at `p`.
fn beyond(basis: &[[f64; TERMS]], p: DVec3) -> f64 {
    let rest = rest_of(basis, p);
    dot(&rest, &rest)
}

/// Leaves out offset centres that nearly coincide with a centre on the surface or an earlier offset centre; gives their
/// sites.
fn part(sites: &mut [Site], budget: &Budget) -> Result<Vec<usize>, Stopped> {
    let longest = sites.iter().map(|s| s.offset.length()).fold(0.0, f64::max);
    let (mut points, mut whose) = (Vec::new(), Vec::new());
    for (i, site) in sites.iter().enumerate() {
        points.push(site.point);
        whose.push((i, 2, site.offset.length()));
    }
    for (i, site) in sites.iter().enumerate() {
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            if site.has[side] {
                points.push(site.point + site.offset * sign);
                whose.push((i, side, site.offset.length()));
            }
        }
    }
    let cells = PointCells::new(&points, longest * APART_SHARE);
    let mut is_gone = vec![false; points.len()];
    let mut parted = Vec::new();
    for at in sites.len()..points.len() {
        if at.is_multiple_of(QUESTIONS) {
            budget.check()?;
        }
        let (i, side, lambda) = whose[at];
        let is_near = |other: u32| {
            let other = other as usize;
            let reach = APART_SHARE * lambda.min(whose[other].2);
            other < at && !is_gone[other] && points[other].distance_squared(points[at]) < reach * reach
        };
        if cells.near(points[at]).any(is_near) {
            is_gone[at] = true;
            sites[i].has[side] = false;
            parted.push(i);
        }
    }
    Ok(parted)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(count: u32) -> Band {
        let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let points = (0..count).map(|i| DVec3::new(libm::cos(turn(i)), libm::sin(turn(i)), 0.0)).collect();
        Band { points, normals: vec![DVec3::Z; count as usize] }
    }

    fn sites_of(band: &Band, share: f64) -> Vec<Site> {
        let frame = UnitFrame::of(&band.points);
        let offsets = Offsets { first: 0.05, lambdas: vec![0.05; band.points.len()], halved: 0 };
        let options = RbfOptions { share, ..RbfOptions::default() };
        sites(band, &offsets, &options, &frame, &Budget::unlimited()).unwrap()
    }

    fn count(sites: &[Site]) -> usize {
        sites.iter().flat_map(Site::centres).count()
    }

    #[test]
    fn a_share_of_the_offsets_is_kept_evenly_and_all_centres_on_the_surface() {
        let band = circle(40);
        for (share, offsets) in [(1.0, 40), (0.7, 28), (0.5, 20), (0.3, 12)] {
            let sites = sites_of(&band, share);
            assert_eq!((sites.len(), count(&sites)), (40, 40 + 2 * offsets), "{share}");
        }
    }

    #[test]
    fn offsets_come_back_where_the_rank_needs_them() {
        let sites = sites_of(&circle(40), 1e-3);
        let kept: Vec<DVec3> = sites.iter().flat_map(Site::centres).map(|(p, _)| p).collect();
        // Of a planar circular rim with all offsets the rank is 9.
        assert_eq!(rank(&kept, TERMS), 9);
        assert!(kept.len() < 70);
    }

    #[test]
    fn points_without_room_take_no_offsets_from_others() {
        let band = circle(40);
        let frame = UnitFrame::of(&band.points);
        let mut offsets = Offsets { first: 0.05, lambdas: vec![0.05; 40], halved: 7 };
        offsets.lambdas[..7].fill(0.0);
        for values in [ConstraintValues::Distance, ConstraintValues::Unit] {
            let options = RbfOptions { share: 0.01, values, ..RbfOptions::default() };
            let sites = sites(&band, &offsets, &options, &frame, &Budget::unlimited()).unwrap();
            assert!(sites[..7].iter().all(|site| site.has == [false; 2] && site.value == 0.0));
            assert_eq!(sites[7].has, [true; 2]);
            let kept: Vec<DVec3> = sites.iter().flat_map(Site::centres).map(|(p, _)| p).collect();
            assert_eq!(rank(&kept, TERMS), 9, "as with all offsets that have room");
        }
    }

    #[test]
    fn points_at_one_place_are_one_site() {
        let mut band = circle(12);
        band.points.extend_from_within(3..5);
        band.normals.extend([DVec3::Z; 2]);
        assert_eq!(sites_of(&band, 1.0).len(), 12);
    }

    #[test]
    fn offsets_that_meet_are_left_out_and_far_ones_stay() {
        // Two points whose outer offsets end at the same place.
        let mut band = circle(12);
        band.points.extend([DVec3::new(0.0, 0.0, 0.0), DVec3::new(0.1, 0.0, 0.0)]);
        band.normals.extend([DVec3::X, -DVec3::X]);
        let sites = sites_of(&band, 1.0);
        assert_eq!(sites[12].has, [true, true]);
        assert_eq!(sites[13].has, [false, true]);
        assert_eq!(count(&sites), 14 * 3 - 1);
    }

    #[test]
    fn offsets_that_are_left_out_are_made_good_by_others() {
        // Both offsets of the first point, the one that a small share keeps, are where other points are.
        let mut band = circle(40);
        band.points.extend([DVec3::new(1.0, 0.0, 0.05), DVec3::new(1.0, 0.0, -0.05)]);
        band.normals.extend([DVec3::Z; 2]);
        let kept = |share: f64| -> Vec<DVec3> {
            sites_of(&band, share).iter().flat_map(Site::centres).map(|(p, _)| p).collect()
        };
        assert_eq!(sites_of(&band, 1e-3)[0].has, [false; 2]);
        assert_eq!(rank(&kept(1e-3), TERMS), rank(&kept(1.0), TERMS));
    }
}
