//! Coincident corners: two or three corners of a triangle at one position. It covers nothing, and once the positions are
//! welded its neighbours meet without it.

use super::names::middle;
use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    Ok(Finding::of(DefectCode::CoincidentCorners, &mesh.coincident, cx.samples, |&t| {
        mesh.names().triangles(&[t], middle(mesh.soup.corners(t)))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn corners_coincide_by_index_or_by_position() {
        let mut mesh = soup(5, &[[0, 1, 1], [0, 1, 2], [2, 3, 4]]);
        mesh.positions[4] = mesh.positions[3];
        let finding = found(&mesh, DefectCode::CoincidentCorners).unwrap();
        let faces: Vec<u32> = finding.witnesses.iter().map(|w| w.faces[0].index).collect();
        assert_eq!(faces, [0, 2]);
    }

    #[test]
    fn a_tetrahedron_with_such_a_face_is_closed_all_the_same() {
        let mesh = soup(4, &[[0, 2, 1], [0, 1, 3], [1, 1, 2], [1, 2, 3], [2, 0, 3]]);
        assert_eq!(found(&mesh, DefectCode::BoundaryLoop), None);
        assert_eq!(found(&mesh, DefectCode::CoincidentCorners).unwrap().witnesses[0].faces[0].index, 2);
    }
}
