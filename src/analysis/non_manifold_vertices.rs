//! Non-manifold vertices: their triangles form more than one fan, so that parts of the surface hang together in a point.

use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;
use crate::mesh::{fan_heads, triangle_of};

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let vertices = &cx.singular;
    let sampled = &vertices[..vertices.len().min(cx.samples)];
    let heads = if sampled.is_empty() {
        Vec::new()
    } else {
        fan_heads(&mesh.triangles, sampled, &mesh.twins, cx.budget)?
    };
    let witnesses = sampled.iter().zip(heads).map(|(&v, heads)| {
        let faces = heads.iter().map(|&corner| mesh.face_of(triangle_of(corner)));
        let mut witness = mesh.names().witness(faces, [v], mesh.position(v));
        witness.figures.push(("fans", heads.len() as f64));
        witness
    });
    Ok(Finding::with(DefectCode::NonManifoldVertex, vertices.len() as u64, witnesses.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn two_tetrahedra_on_one_apex_share_a_non_manifold_vertex() {
        let first = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let second = first.map(|t| t.map(|v| if v == 3 { 3 } else { v + 4 }));
        let finding = found(&soup(7, &[first, second].concat()), DefectCode::NonManifoldVertex).unwrap();
        assert_eq!(finding.count, 1);
        let witness = &finding.witnesses[0];
        assert_eq!(witness.figures, [("fans", 2.0)]);
        assert_eq!(witness.vertices[0].index, 3);
        let faces: Vec<u32> = witness.faces.iter().map(|f| f.index).collect();
        assert_eq!(faces, [1, 5], "one face of each fan");
    }

    #[test]
    fn a_vertex_on_the_border_of_a_sheet_has_one_fan() {
        assert_eq!(found(&soup(4, &[[0, 1, 2], [0, 2, 3]]), DefectCode::NonManifoldVertex), None);
    }
}
