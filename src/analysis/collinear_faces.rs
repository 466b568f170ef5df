//! Collinear faces: three different corners exactly on one line, so that there is no area and no side.

use super::names::middle;
use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    Ok(Finding::of(DefectCode::CollinearFace, &cx.collinear, cx.samples, |&t| {
        mesh.names().triangles(&[mesh.source(t)], middle(mesh.corners(t)))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};
    use crate::geom::DVec3;

    #[test]
    fn a_face_is_collinear_only_when_its_corners_are_exactly_on_one_line() {
        let mut mesh = soup(3, &[[0, 1, 2]]);
        mesh.positions = [0.1, 0.2, 0.4].map(|x| DVec3::new(x, x, 0.0)).to_vec();
        assert_eq!(found(&mesh, DefectCode::CollinearFace).unwrap().count, 1);
        assert_eq!(found(&mesh, DefectCode::CoincidentCorners), None);
        mesh.positions[1].y = 0.2_f64.next_up();
        assert_eq!(found(&mesh, DefectCode::CollinearFace), None);
    }
}
