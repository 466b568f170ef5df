//! Sizes of the mesh: box, area and volume.

use super::sum::CompensatedSum;
use super::welded::Welded;
use super::{Context, Measures};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, triangle_area};
use crate::mesh::Soup;
use crate::par;

impl Measures {
    pub(super) fn of(cx: &Context<'_>) -> Result<Self, Stopped> {
        let [vertices, edges, triangles] = [cx.used.len(), cx.mesh.edges.len(), cx.mesh.triangles.len()];
        Ok(Self {
            bounds: cx.bounds,
            area: area(cx)?,
            volume: volume(cx),
            euler_characteristic: vertices as i64 - edges as i64 + triangles as i64,
        })
    }
}

/// The box of the vertices `used`; `None` without any.
pub(super) fn bounds(mesh: &Welded<'_>, used: &[u32], budget: &Budget) -> Result<Option<Aabb>, Stopped> {
    let boxes = par::try_map_ranges(used.len(), CHECK_EVERY, |range| {
        budget.check()?;
        Ok(Aabb::of(used[range].iter().map(|&v| mesh.position(v))))
    })?;
    Ok(boxes.into_iter().reduce(Aabb::union))
}

/// The triangles' areas, and those of polygons as they are.
fn area(cx: &Context<'_>) -> Result<f64, Stopped> {
    let polygons = &cx.mesh.soup.polygons;
    let is_of_polygon = of_polygons(cx)?;
    let of_triangle =
        |t: &usize| is_of_polygon.is_empty() || !is_of_polygon[cx.mesh.source(*t as u32) as usize];
    let triangles = par::try_map_ranges(cx.mesh.triangles.len(), CHECK_EVERY, |range| {
        cx.budget.check()?;
        let areas = range.filter(of_triangle).map(|t| triangle_area(cx.mesh.corners(t as u32)));
        Ok(areas.collect::<CompensatedSum>().value())
    })?;
    let polygons = par::try_map_ranges(polygons.faces.len(), CHECK_EVERY / 4, |range| {
        cx.budget.check()?;
        Ok(range.map(|i| polygon_area(cx.mesh.soup, i)).collect::<CompensatedSum>().value())
    })?;
    Ok(triangles.into_iter().chain(polygons).collect::<CompensatedSum>().value())
}

/// For each triangle of the soup, whether it is a part of a polygon; empty when none is.
fn of_polygons(cx: &Context<'_>) -> Result<Vec<bool>, Stopped> {
    let (soup, polygons) = (cx.mesh.soup, &cx.mesh.soup.polygons);
    if polygons.faces.is_empty() {
        return Ok(Vec::new());
    }
    let mut is_of_polygon = vec![false; soup.triangles.len()];
    for (i, &first) in polygons.first_triangles.iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        let first = first as usize;
        is_of_polygon[first..first + polygons.corners_of(i).len() - 2].fill(true);
    }
    Ok(is_of_polygon)
}

/// Half the norm of the sum of the cross products of neighbouring corners about the centroid: the area of the polygon's
/// shadow along its normal, so that what is not planar has less than its triangles and a bow-tie of equal halves has none.
fn polygon_area(soup: &Soup, i: usize) -> f64 {
    let corners = soup.polygons.corners_of(i);
    let place = |k: usize| soup.positions[corners[k % corners.len()] as usize];
    let centroid = (0..corners.len()).map(place).sum::<DVec3>() / corners.len() as f64;
    let arms = |k: usize| (place(k) - centroid, place(k + 1) - centroid);
    // Lengths of at most 1 keep the products in range.
    let longest = (0..corners.len()).map(|k| arms(k).0.abs().max_element()).fold(0.0, f64::max);
    if longest == 0.0 {
        return 0.0;
    }
    let sum: DVec3 = (0..corners.len()).map(arms).map(|(a, b)| (a / longest).cross(b / longest)).sum();
    sum.length() / 2.0 * longest * longest
}

/// Sum of the shells' volumes, if every part is a shell and there is one.
fn volume(cx: &Context<'_>) -> Option<f64> {
    let is_solid = !cx.shells.is_empty() && cx.shells.len() == cx.mesh.parts.len();
    let volume = cx.shells.iter().map(|shell| shell.volume).collect::<CompensatedSum>().value();
    (is_solid && volume.is_finite()).then_some(volume)
}

#[cfg(test)]
mod tests {
    use crate::analysis::Measures;
    use crate::analysis::tests::{described, joined, polygon, tetrahedron, turned};
    use crate::geom::DVec3;
    use crate::mesh::Soup;

    fn measures(mesh: &Soup) -> Measures {
        described(mesh).measures
    }

    #[test]
    fn a_tetrahedron_has_its_box_area_and_volume_also_far_from_the_origin() {
        for corner in [DVec3::ZERO, DVec3::new(1e6, -2e6, 3e6)] {
            let of = measures(&tetrahedron(corner, 6.0));
            let bounds = of.bounds.unwrap();
            assert_eq!((bounds.min, bounds.max), (corner, corner + 6.0));
            assert!((of.area - (54.0 + 18.0 * 3f64.sqrt())).abs() < 1e-12, "{of:?}");
            assert_eq!(of.volume, Some(36.0));
            assert_eq!(of.euler_characteristic, 2);
        }
    }

    #[test]
    fn an_inverted_solid_has_a_negative_volume_and_a_cavity_takes_from_it() {
        let [solid, small] = [tetrahedron(DVec3::ZERO, 6.0), tetrahedron(DVec3::ONE, 1.5)];
        assert_eq!(measures(&turned(solid.clone())).volume, Some(-36.0));
        assert_eq!(measures(&joined(&[solid, turned(small)])).volume, Some(36.0 - 0.5625));
    }

    #[test]
    fn what_is_open_or_in_conflict_has_no_volume() {
        let mut open = tetrahedron(DVec3::ZERO, 6.0);
        open.triangles.pop();
        open.face_count -= 1;
        assert_eq!(measures(&open).volume, None);
        let mut turned = tetrahedron(DVec3::ZERO, 6.0);
        turned.triangles[0].swap(1, 2);
        assert_eq!(measures(&turned).volume, None);
        assert_eq!(measures(&Soup::default()).volume, None);
    }

    #[test]
    fn a_polygon_has_the_area_about_its_centroid() {
        let area = |corners: [[f64; 3]; 4]| measures(&polygon(&corners.map(DVec3::from_array))).area;
        let saddle = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
        let bow_tie = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let square = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        for start in 0..4 {
            for (mut corners, wanted) in [(saddle, 1.0), (bow_tie, 0.0), (square, 6.0)] {
                corners.rotate_left(start);
                assert!((area(corners) - wanted).abs() < 1e-12, "{corners:?}: {}", area(corners));
            }
        }
    }

    #[test]
    fn nothing_has_no_box() {
        let of = measures(&Soup::default());
        assert_eq!((of.bounds, of.area, of.euler_characteristic), (None, 0.0, 0));
    }
}
