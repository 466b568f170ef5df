//! Flat sheets: parts of the surface that lie in one plane. A patch within the rim of one would lie on it, and what the two
//! enclose would be nothing but the rounding of coordinates.

use super::pinched::Walk;
use super::shape::{LoopPolyline, shape};
use super::surface::FillSurface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::triangle_of;

/// How far from its plane a part may be to be flat, as a share of its diagonal: a twentieth of what counts as lost.
const FLAT_SHARE_MAX: f64 = 1e-4;

/// A part of the surface.
#[derive(Clone, Copy)]
struct SheetCandidate {
    bounds: Aabb,
    /// Any of its corners.
    origin: DVec3,
    /// The sum of its triangles' normals, by their area; then of unit length, or zero.
    normal: DVec3,
    is_flat: bool,
}

/// For each walk the unit normal of the flat sheet of which it is a rim; `None` where it is one of something else.
pub(super) fn of_flat_sheets(
    walks: &[Walk],
    surface: &FillSurface,
    budget: &Budget,
) -> Result<Vec<Option<DVec3>>, Stopped> {
    // Mostly no rim is one of a sheet, and the rest of the surface need not be looked at.
    budget.spend(walks.iter().map(|walk| walk.half_edges.len() as u64).sum::<u64>() / 4)?;
    if !walks.iter().any(|walk| may_be_outer_rim(walk, surface)) {
        return Ok(vec![None; walks.len()]);
    }
    let parts = surface.groups.components(budget)?;
    let _charge = budget.charge(u64::from(parts.count) * size_of::<SheetCandidate>() as u64)?;
    budget.spend(surface.triangles.len() as u64 / 8)?;
    let unseen =
        SheetCandidate { bounds: Aabb::EMPTY, origin: DVec3::ZERO, normal: DVec3::ZERO, is_flat: false };
    let mut found = vec![unseen; parts.count as usize];
    let part_of = |h: u32| parts.of[triangle_of(h) as usize] as usize;
    for h in walks.iter().flat_map(|walk| &walk.half_edges) {
        found[part_of(*h)].is_flat = true;
    }
    let visit = |found: &mut [SheetCandidate], look: fn(&mut SheetCandidate, [DVec3; 3])| {
        for (t, (corners, &part)) in surface.triangles.iter().zip(&parts.of).enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let part = &mut found[part as usize];
            if part.is_flat {
                look(part, corners.map(|v| surface.positions[v as usize]));
            }
        }
        Ok::<(), Stopped>(())
    };
    visit(&mut found, |part, [a, b, c]| {
        part.origin = a;
        part.normal += (b - a).cross(c - a);
        part.bounds = part.bounds.union(Aabb::of([a, b, c]));
    })?;
    for part in &mut found {
        // Where the normals of all triangles cancel, there is no plane.
        part.normal = part.normal.normalize_or_zero();
        part.is_flat &= part.normal != DVec3::ZERO;
    }
    visit(&mut found, |part, [a, b, c]| {
        let height = |p: DVec3| (p - part.origin).dot(part.normal).abs();
        let size = part.bounds.diagonal();
        // A needle may point anywhere.
        let turns_back = (b - a).cross(c - a).dot(part.normal) < -FLAT_SHARE_MAX * size * size;
        part.is_flat = [a, b, c].into_iter().all(|p| height(p) <= FLAT_SHARE_MAX * size) && !turns_back;
    })?;
    let sheet = |walk: &Walk| {
        let part = part_of(walk.half_edges[0]);
        let is_of_one = walk.half_edges.iter().all(|&h| part_of(h) == part);
        (is_of_one && found[part].is_flat).then_some(found[part].normal)
    };
    Ok(walks.iter().map(sheet).collect())
}

/// True when the triangles along a walk lie in its plane, as those of a flat sheet do whose outer rim it is.
fn may_be_outer_rim(walk: &Walk, surface: &FillSurface) -> bool {
    let LoopPolyline { normal, bounds, points, .. } =
        shape(walk.half_edges.iter().map(|&h| surface.point(h)).collect());
    let most = 2.0 * FLAT_SHARE_MAX * bounds.diagonal();
    let is_in_plane = |&h: &u32| {
        let corners = surface.triangles[triangle_of(h) as usize].map(|v| surface.positions[v as usize]);
        corners.into_iter().all(|p| (p - points[0]).dot(normal).abs() <= most)
    };
    normal != DVec3::ZERO && walk.half_edges.iter().all(is_in_plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Boundary;

    fn normals(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<Option<DVec3>> {
        let positions: Vec<DVec3> = points.iter().map(|&p| DVec3::from_array(p)).collect();
        let budget = Budget::unlimited();
        let surface = FillSurface::new(positions, triangles.to_vec(), &budget).unwrap();
        let boundary =
            Boundary::trace(&surface.triangles, surface.positions.len(), &surface.groups, &budget).unwrap();
        let walks: Vec<Walk> = boundary.loops.into_iter().map(Walk::of_one).collect();
        of_flat_sheets(&walks, &surface, &budget).unwrap()
    }

    #[test]
    fn a_sheet_is_flat_by_its_corners_and_a_box_whose_normals_cancel_is_none() {
        let square = |z: f64| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, z], [0.0, 1.0, 0.0]];
        let halves = [[0, 1, 2], [0, 2, 3]];
        assert_eq!(normals(&square(0.0), &halves), [Some(DVec3::Z)]);
        assert!(normals(&square(1e-5), &halves)[0].is_some_and(|normal| normal.z > 0.999));
        assert_eq!(normals(&square(0.01), &halves), [None]);
        // A triangle is missing of two opposite sides.
        let corner = |i: u32| [0, 1, 2].map(|k| f64::from(i >> k & 1));
        let corners: Vec<[f64; 3]> = (0..8).map(corner).collect();
        let open = [
            [0, 3, 1],
            [4, 7, 6],
            [0, 1, 5],
            [0, 5, 4],
            [2, 6, 7],
            [2, 7, 3],
            [0, 4, 6],
            [0, 6, 2],
            [1, 3, 7],
            [1, 7, 5],
        ];
        assert_eq!(normals(&corners, &open), [None, None]);
    }
}
