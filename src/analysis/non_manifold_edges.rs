//! Non-manifold edges: edges with three triangles or more, so that it is open which of them belong together.

use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let edges = mesh.irregular_where(|triangles| triangles > 2);
    Ok(Finding::of(DefectCode::NonManifoldEdge, &edges, cx.samples, |&e| {
        let (ends, middle) = mesh.edge(e);
        let mut witness = mesh.names().witness(mesh.faces_at(e), ends, middle);
        witness.figures.push(("triangles", mesh.edges.group(e as usize).len() as f64));
        witness
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn a_book_with_three_pages_has_a_non_manifold_spine() {
        let book = soup(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
        let finding = found(&book, DefectCode::NonManifoldEdge).unwrap();
        assert_eq!(finding.count, 1);
        assert_eq!(finding.witnesses[0].figures, [("triangles", 3.0)]);
        let vertices: Vec<u32> = finding.witnesses[0].vertices.iter().map(|v| v.index).collect();
        assert_eq!(vertices, [0, 1]);
    }
}
