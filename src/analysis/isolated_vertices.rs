//! Isolated vertices: no face and no edge uses them. Harmless, though some programs count them in the box of the mesh.

use super::welded::{indices_where, used_vertices};
use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let soup = cx.mesh.soup;
    if soup.is_welded_by_format {
        return Ok(Vec::new());
    }
    let mut is_used = used_vertices(&soup.triangles, soup.positions.len(), cx.budget)?;
    for &v in soup.segments.iter().flat_map(|segment| &segment.ends) {
        is_used[v as usize] = true;
    }
    let is_isolated = |v: usize| !is_used[v] && soup.positions[v].is_finite();
    let isolated = indices_where(soup.positions.len(), cx.budget, is_isolated)?;
    Ok(Finding::of(DefectCode::IsolatedVertex, &isolated, cx.samples, |&v| {
        cx.mesh.names().witness([], [v], soup.positions[v as usize])
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};
    use crate::geom::DVec3;

    #[test]
    fn a_vertex_that_no_face_uses_is_isolated() {
        let finding = found(&soup(5, &[[0, 1, 3]]), DefectCode::IsolatedVertex).unwrap();
        let vertices: Vec<u32> = finding.witnesses.iter().map(|w| w.vertices[0].index).collect();
        assert_eq!(vertices, [2, 4]);
    }

    #[test]
    fn an_unused_vertex_that_is_not_finite_is_told_as_such_only() {
        let mut mesh = soup(4, &[[0, 1, 2]]);
        mesh.positions[3] = DVec3::NAN;
        mesh.non_finite_vertices = vec![3];
        assert_eq!(found(&mesh, DefectCode::IsolatedVertex), None);
        assert_eq!(found(&mesh, DefectCode::NonFiniteVertex).unwrap().count, 1);
    }
}
