//! Triangulates a flat region, with islands, by a constrained Delaunay triangulation.

use super::DVec2;
use spade::handles::{FixedFaceHandle, FixedVertexHandle, PossiblyOuterTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// Triangles of the region to the left of the `loops`: the outer one and those of islands. Corners are numbered through all loops. `None`
/// when the loops touch or cross, or run the wrong way.
pub(crate) fn triangulate_region(loops: &[Vec<DVec2>]) -> Option<Vec<[usize; 3]>> {
    let points: Vec<Point2<f64>> = loops.iter().flatten().map(|p| Point2::new(p.x, p.y)).collect();
    let count = points.len();
    let edges = directed_edges(loops);
    let mut has_crossing = false;
    let mesh = ConstrainedDelaunayTriangulation::<_>::try_bulk_load_cdt(points, edges.clone(), |_| {
        has_crossing = true;
    })
    .ok()?;
    if has_crossing || mesh.num_vertices() != count {
        return None;
    }
    let inside = faces_left_of(&mesh, &edges)?;
    // Euler: a region with h holes and n corners has n + 2 h - 2 triangles.
    (inside.len() + 4 == count + 2 * loops.len()).then_some(inside)
}

/// Each corner and the next one of its loop.
fn directed_edges(loops: &[Vec<DVec2>]) -> Vec<[usize; 2]> {
    let mut edges = Vec::new();
    for corners in loops {
        let first = edges.len();
        edges.extend((0..corners.len()).map(|i| [first + i, first + (i + 1) % corners.len()]));
    }
    edges
}

/// The triangles that are reached from the left sides of `edges` without crossing a constraint.
fn faces_left_of(
    mesh: &ConstrainedDelaunayTriangulation<Point2<f64>>,
    edges: &[[usize; 2]],
) -> Option<Vec<[usize; 3]>> {
    let mut is_inside = vec![false; mesh.num_all_faces()];
    let mut open: Vec<FixedFaceHandle<PossiblyOuterTag>> = Vec::new();
    for ends in edges {
        let [from, to] = ends.map(FixedVertexHandle::from_index);
        open.push(mesh.get_edge_from_neighbors(from, to)?.face().fix());
    }
    let mut triangles = Vec::new();
    while let Some(face) = open.pop() {
        let face = mesh.face(face).as_inner()?;
        if std::mem::replace(&mut is_inside[face.index()], true) {
            continue;
        }
        triangles.push(face.vertices().map(|v| v.index()));
        open.extend(
            face.adjacent_edges().iter().filter(|e| !e.is_constraint_edge()).map(|e| e.rev().face().fix()),
        );
    }
    Some(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64, is_island: bool) -> Vec<DVec2> {
        let mut corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|p| DVec2::from_array(p) * half)
            .to_vec();
        if is_island {
            corners.reverse();
        }
        corners
    }

    fn area(loops: &[Vec<DVec2>], triangles: &[[usize; 3]]) -> f64 {
        let points = loops.concat();
        triangles.iter().map(|t| t.map(|i| points[i])).map(|[a, b, c]| (b - a).perp_dot(c - a) / 2.0).sum()
    }

    #[test]
    fn a_frame_is_triangulated_around_its_island() {
        let loops = [square(2.0, false), square(1.0, true)];
        let triangles = triangulate_region(&loops).unwrap();
        assert_eq!(triangles.len(), 8);
        assert_eq!(area(&loops, &triangles), 12.0);
    }

    #[test]
    fn corners_in_the_middle_of_straight_sides_are_used() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]];
        let loops = [corners.map(DVec2::from_array).to_vec()];
        let triangles = triangulate_region(&loops).unwrap();
        assert_eq!(triangles.len(), 4);
        assert_eq!(area(&loops, &triangles), 4.0);
    }

    #[test]
    fn loops_that_cross_or_run_the_wrong_way_are_not_triangulated() {
        let shifted: Vec<DVec2> = square(1.0, true).iter().map(|p| p + DVec2::X * 2.0).collect();
        assert_eq!(triangulate_region(&[square(2.0, false), shifted]), None);
        assert_eq!(triangulate_region(&[square(2.0, true)]), None);
    }
}
