//! Isolated edges: the file states them by themselves and no face has them. They are no part of a surface.

use super::{Context, DefectCode, Finding, Witness};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::Segment;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let mut isolated: Vec<Segment> = Vec::new();
    for (i, segment) in mesh.soup.segments.iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        let [a, b] = segment.ends.map(|v| mesh.first_at(v));
        let is_of_face = a != b && mesh.edges.find(&mesh.triangles, [a.min(b), a.max(b)]).is_some();
        if !is_of_face {
            isolated.push(*segment);
        }
    }
    Ok(Finding::of(DefectCode::IsolatedEdge, &isolated, cx.samples, |segment| {
        let [a, b]: [DVec3; 2] = segment.ends.map(|v| mesh.soup.positions[v as usize]);
        let witness = mesh.names().witness([], segment.ends, (a + b) / 2.0);
        Witness {
            figures: segment.line.map(|line| ("line", f64::from(line))).into_iter().collect(),
            ..witness
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn an_edge_that_no_face_has_is_isolated_and_its_ends_are_no_isolated_vertices() {
        let mut mesh = soup(6, &[[0, 1, 3]]);
        let segment = |ends, line| Segment { ends, line: Some(line) };
        mesh.segments = vec![segment([3, 0], 7), segment([1, 2], 8), segment([2, 4], 9), segment([4, 4], 9)];
        let finding = found(&mesh, DefectCode::IsolatedEdge).unwrap();
        assert_eq!(finding.count, 3);
        let witness = &finding.witnesses[0];
        let vertices: Vec<u32> = witness.vertices.iter().map(|v| v.index).collect();
        assert_eq!((vertices, &witness.figures[..]), (vec![1, 2], &[("line", 8.0)][..]));
        let vertices = found(&mesh, DefectCode::IsolatedVertex).unwrap();
        assert_eq!((vertices.count, vertices.witnesses[0].vertices[0].index), (1, 5));
    }

    #[test]
    fn an_edge_over_a_vertex_that_is_there_twice_is_the_edge_of_the_face() {
        let mut mesh = soup(4, &[[0, 1, 2]]);
        mesh.positions[3] = mesh.positions[1];
        mesh.segments = vec![Segment { ends: [3, 0], line: None }];
        assert_eq!(found(&mesh, DefectCode::IsolatedEdge), None);
    }
}
