//! Triangulates a flat region, with islands, by a constrained Delaunay triangulation of its view along an axis.

use crate::geom::{DVec2, DVec3};
use spade::handles::{FixedFaceHandle, FixedVertexHandle, PossiblyOuterTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// Most corners of a region; a triangulation of so many takes some 20 ms and cannot be stopped inside.
pub(super) const CORNERS_MAX: usize = 1 << 14;

/// The view of a plane with this normal along the axis that is nearest to it, mirrored if need be so that what turns
/// counter-clockwise around the normal does so in the view. Coordinates are not changed, so the view is exact.
pub(super) fn view(normal: DVec3) -> impl Fn(DVec3) -> DVec2 {
    let size = normal.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
    move |p| DVec2::new(p[u], p[v])
}

/// Triangles of the region to the left of the `loops` (the outer one and those of islands) as they are seen along
/// `normal`; corners are numbered through all loops. `None` when the loops touch or cross in the view.
pub(super) fn triangulate(loops: &[Vec<DVec3>], normal: DVec3) -> Option<Vec<[usize; 3]>> {
    let view = view(normal);
    let points: Vec<Point2<f64>> =
        loops.iter().flatten().map(|&p| view(p)).map(|p| Point2::new(p.x, p.y)).collect();
    if points.len() > CORNERS_MAX {
        return None;
    }
    let edges = directed_edges(loops);
    let mut has_crossing = false;
    let mesh =
        ConstrainedDelaunayTriangulation::<_>::try_bulk_load_cdt(points.clone(), edges.clone(), |_| {
            has_crossing = true;
        })
        .ok()?;
    if has_crossing || mesh.num_vertices() != points.len() {
        return None;
    }
    let inside = faces_left_of(&mesh, &edges)?;
    // Euler: a region with h holes and n corners has n + 2 h - 2 triangles.
    (inside.len() + 4 == points.len() + 2 * loops.len()).then_some(inside)
}

/// Each corner and the next one of its loop.
fn directed_edges(loops: &[Vec<DVec3>]) -> Vec<[usize; 2]> {
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

    fn square(half: f64, is_island: bool) -> Vec<DVec3> {
        let mut corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x * half, 5.0, y * half))
            .to_vec();
        if !is_island {
            corners.reverse();
        }
        corners
    }

    fn area(loops: &[Vec<DVec3>], triangles: &[[usize; 3]]) -> DVec3 {
        let points = loops.concat();
        triangles.iter().map(|t| t.map(|i| points[i])).map(|[a, b, c]| (b - a).cross(c - a) / 2.0).sum()
    }

    #[test]
    fn a_frame_is_triangulated_around_its_island() {
        let loops = [square(2.0, false), square(1.0, true)];
        let triangles = triangulate(&loops, DVec3::Y).unwrap();
        assert_eq!(triangles.len(), 8);
        assert_eq!(area(&loops, &triangles), DVec3::Y * 12.0);
    }

    #[test]
    fn corners_in_the_middle_of_straight_sides_are_used() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]];
        let loops = [corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec()];
        let triangles = triangulate(&loops, DVec3::Z).unwrap();
        assert_eq!(triangles.len(), 4);
        assert_eq!(area(&loops, &triangles), DVec3::Z * 4.0);
    }

    #[test]
    fn loops_that_cross_or_run_the_wrong_way_are_not_triangulated() {
        let shifted: Vec<DVec3> = square(1.0, true).iter().map(|p| p + DVec3::X * 2.0).collect();
        assert_eq!(triangulate(&[square(2.0, false), shifted], DVec3::Y), None);
        assert_eq!(triangulate(&[square(2.0, true)], DVec3::Y), None);
    }
}
