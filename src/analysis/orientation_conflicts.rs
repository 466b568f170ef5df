//! Orientation conflicts: edges whose two triangles run in the same direction, so that one of them shows its back.

use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let edges = mesh.irregular_where(|triangles| triangles == 2);
    Ok(Finding::of(DefectCode::OrientationConflict, &edges, cx.samples, |&e| {
        let (ends, middle) = mesh.edge(e);
        mesh.names().witness(mesh.faces_at(e), ends, middle)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn a_face_turned_over_conflicts_with_each_neighbour() {
        let turned = soup(4, &[[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        assert_eq!(found(&turned, DefectCode::OrientationConflict).unwrap().count, 3);
    }

    #[test]
    fn an_edge_of_three_faces_is_no_conflict() {
        let book = soup(5, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
        assert_eq!(found(&book, DefectCode::OrientationConflict), None);
    }
}
