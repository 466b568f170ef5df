//! How far the offset centres of each point are from it.

use super::band::{Band, BandSurroundings};
use super::options::{ConstraintValues, LAMBDA_SHARE, LambdaFrom, RbfOptions};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::par;
use crate::spatial::NearestSearch;

/// Halvings after which a point gets no offsets, because another part of the surface is at it: a thousandth of the first
/// lambda, 5e-6 of the hole.
const HALVINGS_MAX: u32 = 10;
/// Share of lambda that the closest point of the surface may be beside the point itself where the surface is curved
/// toward the offset, if it is beside it and not behind it.
const SLIP_SHARE: f64 = 0.5;
/// What is farther from a point than so many lambdas is farther from its offsets than the point itself. 2, and a little for
/// rounding.
const CLEARANCE: f64 = 2.01;
/// Points handled between two checks of the budget.
const POINTS: usize = 64;

/// Lambda of each point.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Offsets {
    /// Lambda before it is halved, in the unit of the coordinates.
    pub first: f64,
    /// Lambda of each point; 0 where no lambda fits.
    pub lambdas: Vec<f64>,
    /// Points whose lambda was halved at least once.
    pub halved: usize,
}

/// Lambda of each point of `band`: the same for all, halved for each point until the point of the surface closest to
/// x + lambda n and x - lambda n is x itself (Carr et al. 2001, section 3.1), and 0 where that never happens. With unit values
/// the least lambda is that of all.
///
/// On a mesh the closest point is never x itself where the surface is concave; it is then on a triangle at x, or, if
/// triangles are smaller than lambda, beside x. What must not happen is that it is behind x, on another wall.
pub(super) fn offsets(
    band: &Band,
    around: &BandSurroundings<'_, '_>,
    options: &RbfOptions,
    budget: &Budget,
) -> Result<Offsets, Stopped> {
    let extent = match options.lambda_from {
        LambdaFrom::Mesh if !around.mesh_box.is_empty() => around.mesh_box,
        _ => Aabb::of(band.points.iter().copied()),
    };
    let first = options.lambda.unwrap_or(extent.diagonal() * LAMBDA_SHARE);
    let mut lambdas = vec![first; band.points.len()];
    if let Some(surface) = around.surface.filter(|surface| !surface.is_empty()) {
        let fit = |range: std::ops::Range<usize>| -> Result<Vec<f64>, Stopped> {
            budget.spend(range.len() as u64)?;
            range
                .map(|i| fitting(surface, band.points[i], band.normals[i].normalize(), first, budget))
                .collect()
        };
        lambdas = par::try_map_ranges(band.points.len(), POINTS, fit)?.concat();
    }
    let halved = lambdas.iter().filter(|&&lambda| lambda < first).count();
    if options.values == ConstraintValues::Unit {
        let least = lambdas.iter().filter(|&&lambda| lambda > 0.0).fold(first, |least, &l| least.min(l));
        lambdas.iter_mut().filter(|lambda| **lambda > 0.0).for_each(|lambda| *lambda = least);
    }
    Ok(Offsets { first, lambdas, halved })
}

fn fitting(
    surface: &NearestSearch<'_>,
    x: DVec3,
    normal: DVec3,
    first: f64,
    budget: &Budget,
) -> Result<f64, Stopped> {
    let mut lambda = first;
    if has_no_other_near(surface, x, CLEARANCE * first, budget)? {
        return Ok(first);
    }
    // What was closest last is a good guess for the next place.
    let mut hint = None;
    for _ in 0..=HALVINGS_MAX {
        let (out, inward) = (x + normal * lambda, x - normal * lambda);
        if belongs(surface, x, out, &mut hint, budget)? && belongs(surface, x, inward, &mut hint, budget)? {
            return Ok(lambda);
        }
        lambda *= 0.5;
    }
    Ok(0.0)
}

/// True when there are triangles at `x`, and no others within `reach` of it.
fn has_no_other_near(
    surface: &NearestSearch<'_>,
    x: DVec3,
    reach: f64,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let mut is_corner = false;
    let is_other = |t: u32| {
        let is_at_x = surface.corners(t).contains(&x);
        is_corner |= is_at_x;
        !is_at_x
    };
    let is_crowded = surface.bvh().any_in_box(Aabb { min: x - reach, max: x + reach }, budget, is_other)?;
    Ok(is_corner && !is_crowded)
}

/// True when the point of the surface closest to `offset` is `x`, or on a triangle at `x`, or beside it.
fn belongs(
    surface: &NearestSearch<'_>,
    x: DVec3,
    offset: DVec3,
    hint: &mut Option<u32>,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let Some(nearest) = surface.find(offset, *hint, budget)? else { return Ok(true) };
    *hint = Some(nearest.triangle);
    if surface.corners(nearest.triangle).contains(&x) || nearest.point == x {
        return Ok(true);
    }
    let (slip, away) = (nearest.point - x, offset - x);
    let lambda = away.length();
    // Beside: less than half of the way is along the normal.
    Ok(slip.length() <= SLIP_SHARE * lambda && slip.dot(away).abs() <= 0.5 * slip.length() * lambda)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares of side 10 at z = 0 (facing up) and z = -gap (facing down).
    fn wall(gap: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let square =
            |z: f64| [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| DVec3::new(x, y, z));
        let positions = [square(0.0), square(-gap)].concat();
        (positions, vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]])
    }

    fn lambda_at(gap: f64, lambda: f64) -> Offsets {
        let (positions, triangles) = wall(gap);
        let budget = Budget::unlimited();
        let surface = NearestSearch::build(&positions, &triangles, &budget).unwrap();
        let around =
            BandSurroundings { surface: Some(&surface), mesh_box: Aabb::of(positions.iter().copied()) };
        let band = Band {
            points: vec![positions[0], positions[1], positions[2], positions[3]],
            normals: vec![DVec3::Z; 4],
        };
        let options = RbfOptions { lambda: Some(lambda), ..RbfOptions::default() };
        offsets(&band, &around, &options, &budget).unwrap()
    }

    #[test]
    fn lambda_is_halved_until_it_is_at_most_half_of_the_wall() {
        let thick = lambda_at(5.0, 1.0);
        assert_eq!((thick.lambdas[0], thick.halved), (1.0, 0));
        for gap in [0.5, 0.3, 1.1] {
            for lambda in [1.0, 3.0, 0.9] {
                let found = lambda_at(gap, lambda);
                assert!(
                    found.lambdas.iter().all(|&l| l <= gap / 2.0 && l > gap / 8.0),
                    "{gap} {lambda} {found:?}"
                );
                assert_eq!(found.halved, if lambda > gap / 2.0 { 4 } else { 0 });
            }
        }
    }

    #[test]
    fn a_point_on_another_wall_gets_no_offsets() {
        let found = lambda_at(1e-5, 1.0);
        assert_eq!((found.lambdas, found.halved), (vec![0.0; 4], 4));
    }

    #[test]
    fn a_concave_corner_keeps_its_lambda() {
        // The inside of a box's corner: normals toward +x +y +z.
        let positions = [DVec3::ZERO, DVec3::X * 5.0, DVec3::Y * 5.0, DVec3::Z * 5.0];
        let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 1]];
        let budget = Budget::unlimited();
        let surface = NearestSearch::build(&positions, &triangles, &budget).unwrap();
        let around = BandSurroundings { surface: Some(&surface), mesh_box: Aabb::of(positions) };
        let band = Band { points: vec![DVec3::ZERO; 3], normals: vec![DVec3::ONE; 3] };
        let options = RbfOptions { lambda: Some(0.5), ..RbfOptions::default() };
        assert_eq!(offsets(&band, &around, &options, &budget).unwrap().halved, 0);
    }

    #[test]
    fn lambda_comes_from_the_box_that_is_asked_for() {
        let band =
            Band { points: vec![DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 4.0], normals: vec![DVec3::Z; 3] };
        let mesh_box = Aabb { min: DVec3::ZERO, max: DVec3::new(30.0, 40.0, 0.0) };
        let around = BandSurroundings { surface: None, mesh_box };
        let mut options = RbfOptions::default();
        let found =
            |options: &RbfOptions| offsets(&band, &around, options, &Budget::unlimited()).unwrap().first;
        assert!((found(&options) - 0.025).abs() < 1e-12);
        options.lambda_from = LambdaFrom::Mesh;
        assert!((found(&options) - 0.25).abs() < 1e-12);
    }
}
