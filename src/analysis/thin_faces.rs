//! Needles and caps: faces so thin that their normals, and what programs compute with them, are mostly rounding.
//!
//! A needle has an edge that is short beside the others; a cap has none, but an angle that is almost flat. Every triangle
//! that is thinner than about a hundredth of its length is one or the other. Exactly collinear ones are told as such.

use super::names::middle;
use super::{Context, DefectCode, Finding};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::{DVec3, Thinness, thinness};
use crate::par;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let parts = par::try_map_ranges(mesh.triangles.len(), CHECK_EVERY, |range| {
        cx.budget.check()?;
        let thin = range.filter_map(|t| Some((t as u32, thinness(mesh.corners(t as u32))?)));
        Ok(thin.filter(|(t, _)| cx.collinear.binary_search(t).is_err()).collect::<Vec<_>>())
    })?;
    let found = |code, is_of_kind: fn(Thinness) -> bool| {
        let of_kind = || parts.iter().flatten().filter(|(_, thin)| is_of_kind(*thin)).map(|&(t, _)| t);
        let witness = |t: u32| {
            let corners = mesh.corners(t);
            let mut witness = mesh.names().triangles(&[mesh.source(t)], middle(corners));
            let lengths = [0, 1, 2].map(|i| corners[i].distance(corners[(i + 1) % 3]));
            witness.figures = vec![
                ("shortest_edge", lengths.into_iter().fold(f64::INFINITY, f64::min)),
                ("longest_edge", lengths.into_iter().fold(0.0, f64::max)),
                ("largest_angle_degrees", largest_angle_degrees(corners)),
            ];
            witness
        };
        Finding::with(code, of_kind().count() as u64, of_kind().take(cx.samples).map(witness).collect())
    };
    let needles = found(DefectCode::Needle, |thin| matches!(thin, Thinness::Needle { .. }));
    let caps = found(DefectCode::Cap, |thin| matches!(thin, Thinness::Cap { .. }));
    Ok([needles, caps].concat())
}

/// The edges opposite to each corner, scaled so that the largest coordinate is 1: squares stay in the range of f64.
fn scaled_edges([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let edges = [c - b, a - c, b - a];
    let largest = edges[0].abs().max(edges[1].abs()).max(edges[2].abs()).max_element();
    edges.map(|edge| edge / largest)
}

fn largest_angle_degrees(corners: [DVec3; 3]) -> f64 {
    let edges = scaled_edges(corners);
    let angle = |i: usize| {
        let [u, v] = [edges[(i + 1) % 3], -edges[(i + 2) % 3]];
        libm::atan2(u.cross(v).length(), u.dot(v)).to_degrees()
    };
    (0..3).map(angle).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    fn thin(points: [[f64; 3]; 3], scale: f64) -> [u64; 2] {
        let mut mesh = soup(3, &[[0, 1, 2]]);
        mesh.positions = points.map(|p| DVec3::from(p) * scale).to_vec();
        [DefectCode::Needle, DefectCode::Cap].map(|code| found(&mesh, code).map_or(0, |f| f.count))
    }

    #[test]
    fn a_face_is_a_needle_by_its_edges_and_a_cap_by_its_angle_at_every_scale() {
        for scale in [1e-300, 1.0, 1e300] {
            let needle = |width: f64| [[0.0; 3], [100.0, 0.0, 0.0], [100.0, 0.0, width]];
            assert_eq!(thin(needle(0.99), scale), [1, 0]);
            assert_eq!(thin(needle(1.01), scale), [0, 0]);
            // Half of 5 degrees at each foot: a height of 2.18 for a foot of 50.
            let cap = |height: f64| [[0.0; 3], [100.0, 0.0, 0.0], [50.0, height, 0.0]];
            assert_eq!(thin(cap(2.17), scale), [0, 1]);
            assert_eq!(thin(cap(2.19), scale), [0, 0]);
            assert_eq!(thin(cap(0.0), scale), [0, 0], "collinear");
        }
    }

    #[test]
    fn a_cap_is_told_with_its_angle_and_a_needle_with_its_edges() {
        let mut mesh = soup(3, &[[0, 1, 2]]);
        mesh.positions = vec![DVec3::ZERO, DVec3::new(100.0, 0.0, 0.0), DVec3::new(100.0, 0.5, 0.0)];
        let figures = found(&mesh, DefectCode::Needle).unwrap().witnesses[0].figures.clone();
        assert_eq!(figures[0], ("shortest_edge", 0.5));
        assert!((figures[2].1 - 90.0).abs() < 1e-9, "{figures:?}");
    }
}
