//! Sizes of the mesh: box, area and volume.

use super::sum::CompensatedSum;
use super::welded::Welded;
use super::{Context, Measures};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, triangle_area};
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

fn area(cx: &Context<'_>) -> Result<f64, Stopped> {
    let sums = par::try_map_ranges(cx.mesh.triangles.len(), CHECK_EVERY, |range| {
        cx.budget.check()?;
        Ok(range.map(|t| triangle_area(cx.mesh.corners(t as u32))).collect::<CompensatedSum>().value())
    })?;
    Ok(sums.into_iter().collect::<CompensatedSum>().value())
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
    use crate::analysis::tests::{described, joined, tetrahedron, turned};
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
    fn nothing_has_no_box() {
        let of = measures(&Soup::default());
        assert_eq!((of.bounds, of.area, of.euler_characteristic), (None, 0.0, 0));
    }
}
