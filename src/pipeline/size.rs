//! The size of a mesh, of which limits and the thickness of walls are shares.

use crate::geom::{Aabb, DVec3, triangle_area};
use crate::mesh::Soup;
use crate::par;

/// Share of the surface that is the body of a mesh; the rest may be stray.
const BODY_SHARE: f64 = 0.9;

/// What is farther out than so many times the radius of the body does not count.
const STRAY_BEYOND: f64 = 2.0;

/// Triangles are sorted by their distance into so many rings.
const RINGS: usize = 1 << 12;

/// Triangles whose box is found at once.
const TRIANGLES: usize = 1 << 14;

/// Triangles that are looked at to say where the body is.
const SAMPLE: usize = 1 << 14;

/// The diagonal of the box around the triangles of `mesh`, in the unit of the file; 0 without any. Where something lies more
/// than twice as far from the middle of the surface as nine tenths of it, the box is around the rest: a single triangle far away
/// would make everything else look small.
pub(super) fn diagonal(mesh: &Soup) -> f64 {
    let is_finite = |corners: &[DVec3; 3]| corners.iter().all(|p| p.is_finite());
    let count = mesh.triangles.len();
    let every = |n: usize| (0..count as u32).step_by(n).map(|t| mesh.corners(t)).filter(is_finite);
    let bounds = par::map_ranges(count, TRIANGLES, |range| {
        let corners = range.map(|t| mesh.corners(t as u32)).filter(is_finite);
        Aabb::of(corners.flatten())
    });
    let bounds = bounds.into_iter().fold(Aabb::EMPTY, Aabb::union);
    if bounds.is_empty() {
        return 0.0;
    }
    let whole = bounds.diagonal();
    // By the box, so that neither sums nor areas overflow.
    let seen = |p: DVec3| (p - bounds.min) / whole;
    let sample = || every(count.div_ceil(SAMPLE)).map(|corners| corners.map(seen));
    let (mut area, mut moment) = (0.0, DVec3::ZERO);
    for corners in sample() {
        let of_triangle = triangle_area(corners);
        area += of_triangle;
        moment += corners.iter().sum::<DVec3>() / 3.0 * of_triangle;
    }
    if !(area > 0.0 && whole.is_finite()) {
        return whole;
    }
    let middle = moment / area;
    let outermost = |corners: [DVec3; 3]| corners.map(|p| p.distance(middle)).into_iter().fold(0.0, f64::max);
    let mut areas = vec![0.0; RINGS];
    for corners in sample() {
        areas[((outermost(corners) * RINGS as f64) as usize).min(RINGS - 1)] += triangle_area(corners);
    }
    let mut inside = 0.0;
    let reaches = |of_ring: &f64| {
        inside += of_ring;
        inside >= BODY_SHARE * area
    };
    let rings = areas.iter().position(reaches).unwrap_or(RINGS - 1) + 1;
    let reach = STRAY_BEYOND * rings as f64 / RINGS as f64;
    // Seen from the corner of the box, which is the origin then.
    let farthest = middle.max(seen(bounds.max) - middle).length();
    if farthest <= reach {
        return whole;
    }
    Aabb::of(every(1).filter(|&corners| outermost(corners.map(seen)) <= reach).flatten()).diagonal()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of so many by so many cells with a side of 1, and these triangles.
    fn square_and(cells: u32, others: &[[[f64; 3]; 3]]) -> Soup {
        let at = |i: u32, j: u32| [f64::from(i), f64::from(j), 0.0].map(|x| x / f64::from(cells));
        let cell =
            |i, j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
        let triangles =
            (0..cells).flat_map(|i| (0..cells).flat_map(move |j| cell(i, j))).chain(others.iter().copied());
        let corners: Vec<DVec3> = triangles.flatten().map(DVec3::from_array).collect();
        let triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Soup { positions: corners, triangles, ..Soup::default() }
    }

    #[test]
    fn a_stray_triangle_does_not_count() {
        let alone = diagonal(&square_and(8, &[]));
        assert_eq!(alone, 2.0f64.sqrt());
        for far in [3.0, 20.0, 1e6, 1e60] {
            let stray = [[far, 0.0, 0.0], [far + 0.1, 0.0, 0.0], [far, 0.1, 0.0]];
            assert_eq!(diagonal(&square_and(8, &[stray])), alone, "{far}");
        }
    }

    #[test]
    fn two_bodies_of_like_size_count_both() {
        let far = [[[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [9.0, 1.0, 0.0]]];
        assert!(diagonal(&square_and(1, &far)) > 10.0);
    }

    #[test]
    fn a_mesh_without_an_area_has_the_size_of_its_box() {
        let flat = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 0.0, 0.0]].map(DVec3::from_array).to_vec();
        assert_eq!(diagonal(&Soup { positions: flat, triangles: vec![[0, 1, 2]], ..Soup::default() }), 3.0);
        assert_eq!(diagonal(&Soup::default()), 0.0);
    }
}
