//! The largest ball that touches the surface at a place and holds nothing of it.
//!
//! The shrinking ball of Ma, Bae and Choi (2012, "3D medial axis point approximation using nearest neighbors and the
//! normal field"), against triangles instead of points: a ball that is too large holds the point closest to its
//! centre; the next one goes through that point.

use super::ray::{Hit, Ray};
use super::surface::WeldedSurface;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::spatial::NearestSearch;

/// A ball is empty when nothing is closer to its centre than this share of its radius: more than rounding does, less than
/// anybody measures.
const EMPTY_SHARE: f64 = 1.0 - 1e-7;

/// Shrinkings of one ball. Most need three to six; each is valid as an upper bound.
const SHRINKINGS_MAX: u32 = 40;

/// Boxes that are looked at for one centre, twice: several times what most centres take. In the middle of a ball or on the
/// axis of a cylinder every triangle is as far as any other, and looking at all of them would show nothing.
const BOXES_MAX: usize = 192;

/// Diameter of the largest ball that touches the surface at the start of `ray`, on the side to which it goes; `hit` is
/// what it met there. `None` when nothing opposite limits it.
///
/// Departs from the paper where the surface bends away: a contact with a triangle that is not opposite is the same wall
/// going on around an edge or a facet, and ends the shrinking (in the place of the noise rule of Peters 2018). Otherwise
/// every box would be infinitely thin along its edges. The work for each centre is bounded; what is missed by that makes the
/// ball too large, never too small, and lies about as far from the centre as what was found.
pub(super) fn diameter(
    ray: &Ray,
    hit: Hit,
    surface: &WeldedSurface<'_>,
    search: &NearestSearch<'_>,
    budget: &Budget,
) -> Result<Option<f64>, Stopped> {
    let mut radius = hit.distance / 2.0;
    let (mut is_limited, mut hint) = (surface.are_opposite(ray.own, hit.triangle), hit.triangle);
    for _ in 0..SHRINKINGS_MAX {
        let centre = ray.from + ray.along * radius;
        let Some(found) = search.find_roughly(centre, Some(hint), BOXES_MAX, budget)? else { break };
        let nearest = found.nearest;
        if nearest.distance >= radius * EMPTY_SHARE || !surface.are_opposite(ray.own, nearest.triangle) {
            break;
        }
        let Some(next) = radius_through(ray, nearest.point).filter(|&next| next < radius) else { break };
        (radius, hint, is_limited) = (next, nearest.triangle, true);
    }
    Ok(is_limited.then_some(2.0 * radius))
}

/// Radius of the ball that touches the surface at the start and goes through `point`.
fn radius_through(ray: &Ray, point: DVec3) -> Option<f64> {
    let to = point - ray.from;
    let ahead = to.dot(ray.along);
    (ahead > 0.0).then(|| to.length_squared() / (2.0 * ahead))
}
