//! Duplicate vertices: several vertices of the file at one position, as exporters write them along seams of texture or
//! shading.
//!
//! Readers that weld see one vertex. Readers that trust the indices see the surface torn open where the two sides of an
//! edge name different vertices; then the finding is an error, because such a file is valid for some readers only.

use super::welded::{Welded, indices_where, used_vertices};
use super::{Context, DefectCode, Finding, Severity};
use crate::budget::{Budget, Stopped};
use crate::mesh::{EdgeGroups, NO_TWIN};

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    if mesh.has_distinct_positions() {
        return Ok(Vec::new());
    }
    let soup = mesh.soup;
    let is_used = used_vertices(&soup.triangles, soup.positions.len(), cx.budget)?;
    let mut first_used = vec![u32::MAX; soup.positions.len()];
    let mut duplicates = Vec::new();
    for v in indices_where(soup.positions.len(), cx.budget, |v| is_used[v])? {
        let first = &mut first_used[mesh.first_at(v) as usize];
        if *first == u32::MAX {
            *first = v;
        } else {
            duplicates.push((v, *first));
        }
    }
    let mut findings = Finding::of(DefectCode::DuplicateVertex, &duplicates, cx.samples, |&(v, first)| {
        mesh.names().witness([], [v, first], soup.positions[v as usize])
    });
    if let Some(finding) = findings.first_mut()
        && is_torn_as_indexed(mesh, cx.budget)?
    {
        finding.severity = Severity::Error;
    }
    Ok(findings)
}

/// True when an edge that joins two triangles after the weld has one triangle by the indices as written.
fn is_torn_as_indexed(mesh: &Welded<'_>, budget: &Budget) -> Result<bool, Stopped> {
    let soup = mesh.soup;
    let as_indexed: Vec<[u32; 3]> =
        (0..mesh.triangles.len() as u32).map(|t| soup.triangles[mesh.source(t) as usize]).collect();
    let edges = EdgeGroups::build(&as_indexed, soup.positions.len(), budget)?;
    let is_torn = |e: usize| matches!(edges.group(e), &[h] if mesh.twins[h as usize] != NO_TWIN);
    Ok(!indices_where(edges.len(), budget, is_torn)?.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_seam_that_opens_the_surface_as_indexed_is_an_error() {
        let mut mesh = soup(5, &TETRAHEDRON);
        mesh.positions[4] = mesh.positions[3];
        mesh.triangles[1] = [0, 1, 4];
        let finding = found(&mesh, DefectCode::DuplicateVertex).unwrap();
        assert_eq!((finding.count, finding.severity), (1, Severity::Error));
        let vertices: Vec<u32> = finding.witnesses[0].vertices.iter().map(|v| v.index).collect();
        assert_eq!(vertices, [4, 3]);
        assert_eq!(found(&mesh, DefectCode::BoundaryLoop), None);
    }

    #[test]
    fn parts_that_touch_in_a_vertex_of_their_own_are_whole_as_indexed() {
        let second = TETRAHEDRON.map(|t| t.map(|v| v + 4));
        let mut mesh = soup(8, &[TETRAHEDRON, second].concat());
        mesh.positions[4] = mesh.positions[0];
        let finding = found(&mesh, DefectCode::DuplicateVertex).unwrap();
        assert_eq!((finding.count, finding.severity), (1, Severity::Warning));
    }

    #[test]
    fn a_copy_of_a_vertex_that_no_face_uses_is_isolated_only() {
        let mut mesh = soup(5, &TETRAHEDRON);
        mesh.positions[4] = mesh.positions[0];
        assert_eq!(found(&mesh, DefectCode::DuplicateVertex), None);
        assert_eq!(found(&mesh, DefectCode::IsolatedVertex).unwrap().count, 1);
    }
}
