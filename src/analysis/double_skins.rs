//! Double skins: closed shells, or a shell and the next one inside it, with next to nothing between their two sides.
//!
//! The mean distance of the two sides of a closed shell is twice its volume by its area, and that of two nested shells is
//! the difference of their volumes by the area of the inner one. Where that is at most half of the epsilon for what is
//! near, the sides are nearer than epsilon over at least half of the area (Markov's inequality).

use super::shells::OrientedShell;
use super::sum::CompensatedSum;
use super::{Context, DefectCode, Finding, Witness};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::triangle_area;

/// A double skin: its outer shell, the inner one if there are two, and the mean distance of the sides.
struct DoubleSkin {
    outer: OrientedShell,
    inner: Option<OrientedShell>,
    thickness: f64,
}

/// The double skins among the shells of the mesh and the pairs `nested` (outer, inner) of shells that are next to each
/// other.
pub(super) fn find(
    cx: &Context<'_>,
    nested: &[(OrientedShell, OrientedShell)],
) -> Result<Vec<Finding>, Stopped> {
    let thick = cx.epsilon / 2.0;
    let mut found = Vec::new();
    for &outer in cx.shells.iter().filter(|shell| has_volume(shell)) {
        let thickness = 2.0 * outer.volume.abs() / area(cx, outer.part)?;
        if thickness <= thick {
            found.push(DoubleSkin { outer, inner: None, thickness });
        }
    }
    for &(outer, inner) in nested.iter().filter(|(outer, inner)| has_volume(outer) && has_volume(inner)) {
        let between = outer.volume.abs() - inner.volume.abs();
        let thickness = between.max(0.0) / area(cx, inner.part)?;
        if thickness <= thick {
            found.push(DoubleSkin { outer, inner: Some(inner), thickness });
        }
    }
    Ok(Finding::of(DefectCode::DoubleSkin, &found, cx.samples, |skin| witness(cx, skin)))
}

fn witness(cx: &Context<'_>, skin: &DoubleSkin) -> Witness {
    let mut witness = cx.part_witness(skin.outer.part);
    if let Some(inner) = skin.inner {
        let other = cx.part_witness(inner.part);
        witness.faces.truncate(4);
        witness.faces.extend(other.faces.into_iter().take(4));
    }
    witness.figures.push(("mean_thickness", skin.thickness));
    witness.figures.push(("shells", if skin.inner.is_some() { 2.0 } else { 1.0 }));
    witness
}

/// False for what is told as without volume, and where the volume is out of the range of f64.
fn has_volume(shell: &OrientedShell) -> bool {
    !shell.volume_sign.is_zero() && shell.volume.is_normal()
}

fn area(cx: &Context<'_>, part: u32) -> Result<f64, Stopped> {
    let mut area = CompensatedSum::default();
    for block in cx.members.part(part).chunks(CHECK_EVERY) {
        cx.budget.check()?;
        block.iter().for_each(|&t| area.add(triangle_area(cx.mesh.corners(t))));
    }
    Ok(area.value())
}

#[cfg(test)]
mod tests {
    use crate::analysis::DefectCode;
    use crate::analysis::tests::{joined, searched, soup, turned};
    use crate::geom::DVec3;
    use crate::mesh::Soup;

    fn count(mesh: &Soup) -> u64 {
        let findings = searched(mesh).findings;
        findings.iter().find(|f| f.code == DefectCode::DoubleSkin).map_or(0, |f| f.count)
    }

    fn cuboid(low: DVec3, high: DVec3) -> Soup {
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mut mesh = soup(8, &triangles);
        let corner = |i: usize| {
            DVec3::from_array(std::array::from_fn(|k| if i >> k & 1 == 1 { high[k] } else { low[k] }))
        };
        mesh.positions = (0..8).map(corner).collect();
        mesh
    }

    #[test]
    fn a_plate_is_a_double_skin_below_half_of_a_hundred_thousandth_of_its_diagonal() {
        let plate = |height: f64| cuboid(DVec3::ZERO, DVec3::new(3.0, 4.0, height));
        assert_eq!(count(&plate(2.4e-5)), 1);
        assert_eq!(count(&plate(2.6e-5)), 0);
        assert_eq!(count(&plate(0.0)), 0, "told as without volume");
    }

    #[test]
    fn a_wall_around_a_cavity_is_a_double_skin_when_it_is_as_thin() {
        let hollow = |wall: f64| {
            let inner = cuboid(DVec3::splat(wall), DVec3::splat(10.0 - wall));
            joined(&[cuboid(DVec3::ZERO, DVec3::splat(10.0)), turned(inner)])
        };
        assert_eq!(count(&hollow(5e-5)), 1);
        assert_eq!(count(&hollow(2e-4)), 0);
    }
}
