//! Isolated faces: they share no edge with another face of the file.

use super::names::middle;
use super::{Context, DefectCode, Finding, Witness};
use crate::budget::{CHECK_EVERY, Stopped};

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    // A polygon's triangles share edges with each other only.
    let mut is_one_face = vec![true; mesh.parts.len()];
    for (t, &part) in mesh.components.of.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        let part = part as usize;
        is_one_face[part] &= mesh.face_of(t as u32) == mesh.face_of(mesh.parts[part].first);
    }
    let firsts = mesh
        .parts
        .iter()
        .zip(is_one_face)
        .filter(|&(_, is_one_face)| is_one_face)
        .map(|(part, _)| part.first);
    let isolated: Vec<u32> = firsts.collect();
    Ok(Finding::of(DefectCode::IsolatedFace, &isolated, cx.samples, |&t| {
        let t = mesh.source(t);
        let middle = middle(mesh.soup.triangles[t as usize].map(|v| mesh.position(v)));
        Witness { anchor: Some(3 * t), ..mesh.names().triangles(&[t], middle) }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, polygon, soup};
    use crate::geom::DVec3;

    #[test]
    fn a_face_that_meets_others_in_a_vertex_only_is_isolated() {
        let finding = found(&soup(6, &[[0, 1, 2], [0, 2, 3], [0, 4, 5]]), DefectCode::IsolatedFace).unwrap();
        assert_eq!(finding.count, 1);
        assert_eq!(finding.witnesses[0].faces[0].index, 2);
    }

    #[test]
    fn a_lone_quadrilateral_is_one_isolated_face() {
        assert_eq!(
            found(
                &polygon(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]),
                DefectCode::IsolatedFace
            )
            .unwrap()
            .count,
            1
        );
    }
}
