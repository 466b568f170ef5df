//! Folded edges: two faces of an edge that lie almost on each other, so that there is next to nothing between them.

use super::welded::is_regular;
use super::{Context, DefectCode, Finding};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::{DVec3, is_folded};
use crate::mesh::{edge_of, prev_corner, triangle_of};
use crate::par;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let parts = par::try_map_ranges(mesh.edges.len(), CHECK_EVERY, |range| {
        cx.budget.check()?;
        let is_fold = |e: &u32| normals(cx, *e).is_some_and(is_folded);
        Ok(range.map(|e| e as u32).filter(is_fold).collect::<Vec<_>>())
    })?;
    Ok(Finding::of(DefectCode::FoldedEdge, &parts.concat(), cx.samples, |&e| {
        let (ends, middle) = mesh.edge(e);
        let mut witness = mesh.names().witness(mesh.faces_at(e), ends, middle);
        let angle = normals(cx, e).map_or(f64::NAN, |[n, m]| libm::atan2(n.cross(m).length(), -n.dot(m)));
        witness.figures = vec![("dihedral_degrees", angle.to_degrees())];
        witness
    }))
}

/// The normals of the two faces of edge `e`, if it is regular and they have not the same three vertices; of lengths
/// whose products stay in the range of f64.
fn normals(cx: &Context<'_>, e: u32) -> Option<[DVec3; 2]> {
    let mesh = &cx.mesh;
    let group = mesh.edges.group(e as usize);
    if !is_regular(&mesh.triangles, group) {
        return None;
    }
    let &[h, g] = group else { return None };
    debug_assert_ne!(triangle_of(h), triangle_of(g), "a triangle has each edge once");
    // From the smaller end, so that rounding does not depend on the order of the faces.
    let start = |h: u32| mesh.position(edge_of(&mesh.triangles, h)[0]).to_array();
    let [h, g] = if start(h) <= start(g) { [h, g] } else { [g, h] };
    let [from, to] = edge_of(&mesh.triangles, h);
    let [c, d] = [h, g].map(|h| edge_of(&mesh.triangles, prev_corner(h))[0]);
    if c == d {
        return None;
    }
    let [along, c, d] = [to, c, d].map(|v| mesh.position(v) - mesh.position(from));
    let [long, c_long, d_long] = [along, c, d].map(|v| v.abs().max_element());
    let unit = along / long;
    Some([unit.cross(c / c_long.max(long)), (d / d_long.max(long)).cross(unit)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn a_flap_is_folded_when_its_angle_is_below_one_degree_at_every_scale() {
        for scale in [1e-150, 1.0, 1e150] {
            for (degrees, is_folded) in
                [(0.5, true), (0.99, true), (1.01, false), (90.0, false), (180.0, false)]
            {
                let mut mesh = soup(4, &[[0, 1, 2], [1, 0, 3]]);
                let (sin, cos) = libm::sincos(f64::to_radians(degrees));
                let rim = [DVec3::ZERO, DVec3::X, DVec3::new(0.3, 1.0, 0.0), DVec3::new(0.6, cos, sin) * 0.7];
                mesh.positions = rim.map(|p| p * scale).to_vec();
                let finding = found(&mesh, DefectCode::FoldedEdge);
                assert_eq!(finding.is_some(), is_folded, "{degrees} at {scale}");
                if let Some(finding) = finding {
                    let (_, told) = finding.witnesses[0].figures[0];
                    assert!((told - degrees).abs() < 1e-9, "{told}");
                }
            }
        }
    }

    #[test]
    fn a_face_and_its_back_are_no_folded_edge() {
        assert_eq!(found(&soup(3, &[[0, 1, 2], [0, 2, 1]]), DefectCode::FoldedEdge), None);
    }
}
