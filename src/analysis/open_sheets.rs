//! Open sheets: parts with a rim that bound no volume, as opposed to solids that only lack some faces.
//!
//! Where a surface bounds a volume, the winding numbers on its two sides are near 0 and 1, so their mean is near 1/2; for
//! a sheet they are near -1/2 and 1/2. The rule, and the threshold of 1/4 between both, are those by which a repair reads
//! open shells: [`are_sheets`]. A repair closes a part whose openings other bodies cover all the same.

use super::{Context, DefectCode, Finding};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::winding::are_sheets;

/// The sides of a triangle are looked at this far from it, as a share of the longest side of the box around all.
const BESIDE: f64 = 1e-6;

/// The share of the work left that the search may take: very many open parts all through each other would take hours.
const SHARE_OF_BOUND: u64 = 4;

/// The parts that are open sheets, ascending; `None` where telling them takes too much work.
pub(super) fn search(cx: &Context<'_>) -> Result<Option<Vec<u32>>, Stopped> {
    let mesh = &cx.mesh;
    let mut has_rim = vec![false; mesh.parts.len()];
    for (i, e) in mesh.irregular_where(|triangles| triangles == 1).into_iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        has_rim[mesh.part_at(e) as usize] = true;
    }
    let open: Vec<u32> = (0..mesh.parts.len() as u32).filter(|&p| has_rim[p as usize]).collect();
    if open.is_empty() {
        return Ok(Some(open));
    }
    let triangles =
        || open.iter().enumerate().flat_map(|(i, &p)| cx.members.part(p).iter().map(move |&t| (i, t)));
    let bounds = Aabb::of(triangles().flat_map(|(_, t)| mesh.corners(t)));
    let (center, half) = (bounds.min / 2.0 + bounds.max / 2.0, bounds.max / 2.0 - bounds.min / 2.0);
    let size = half.max_element();
    let in_unit = |p: DVec3| if size > 0.0 && size.is_finite() { (p - center) / size } else { p };
    let _charge = cx.budget.charge(triangles().count() as u64 * 270)?;
    let corners = triangles().map(|(_, t)| mesh.corners(t).map(in_unit)).collect();
    let part: Vec<u32> = triangles().map(|(i, _)| i as u32).collect();
    let told = || are_sheets(corners, &part, open.len(), BESIDE, cx.budget);
    let Some(is_sheet) = cx.budget.within_part(SHARE_OF_BOUND, told)? else { return Ok(None) };
    Ok(Some(open.into_iter().zip(is_sheet).filter(|&(_, is_sheet)| is_sheet).map(|(p, _)| p).collect()))
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    // Parts of one face are told as isolated faces.
    let is_told = |p: &u32| {
        let members = cx.members.part(*p);
        members.iter().any(|&t| cx.mesh.face_of(t) != cx.mesh.face_of(members[0]))
    };
    let sheets: Vec<u32> = cx.sheets.iter().flatten().copied().filter(is_told).collect();
    Ok(Finding::of(DefectCode::OpenSheet, &sheets, cx.samples, |&p| cx.part_witness(p)))
}

#[cfg(test)]
mod tests {
    use crate::analysis::DefectCode;
    use crate::analysis::tests::{found, joined, soup, tetrahedron};
    use crate::geom::DVec3;
    use crate::mesh::Soup;

    fn sheet_count(mesh: &Soup) -> u64 {
        found(mesh, DefectCode::OpenSheet).map_or(0, |f| f.count)
    }

    fn square(corner: DVec3, scale: f64) -> Soup {
        let mut mesh = soup(4, &[[0, 1, 2], [0, 2, 3]]);
        mesh.positions =
            [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y].map(|p| corner + p * scale).to_vec();
        mesh
    }

    #[test]
    fn a_square_is_a_sheet_and_a_tetrahedron_without_a_face_is_not() {
        for scale in [1e-200, 1.0, 1e200] {
            assert_eq!(sheet_count(&square(DVec3::ZERO, scale)), 1, "{scale}");
            let mut holed = tetrahedron(DVec3::ZERO, scale);
            holed.triangles.pop();
            holed.face_count -= 1;
            assert_eq!(sheet_count(&holed), 0, "{scale}");
        }
    }

    #[test]
    fn squares_that_bound_a_box_together_are_no_sheets_and_a_single_face_is_isolated_only() {
        let roof = joined(&[square(DVec3::ZERO, 1.0), tetrahedron(DVec3::splat(9.0), 1.0)]);
        assert_eq!(sheet_count(&roof), 1);
        assert_eq!(sheet_count(&soup(3, &[[0, 1, 2]])), 0);
        assert_eq!(found(&soup(3, &[[0, 1, 2]]), DefectCode::IsolatedFace).unwrap().count, 1);
    }
}
