//! Small meshes that the tests of this module share.

use super::HalfEdgeMesh;
use crate::budget::Budget;

pub(super) const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

pub(super) const OCTAHEDRON: [[u32; 3]; 8] =
    [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]];

pub(super) fn mesh_of(triangles: &[[u32; 3]]) -> HalfEdgeMesh {
    let vertex_count = triangles.as_flattened().iter().max().map_or(0, |&v| v as usize + 1);
    HalfEdgeMesh::from_triangles(triangles, vertex_count, &Budget::unlimited()).unwrap()
}

/// Six quads.
pub(super) fn cube() -> HalfEdgeMesh {
    let corners = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
    HalfEdgeMesh::from_polygons(&corners, &[0, 4, 8, 12, 16, 20, 24], 8, &Budget::unlimited()).unwrap()
}

/// Two by two squares of two triangles each:
/// ```text
/// 6-7-8
/// |/|/|
/// 3-4-5
/// |/|/|
/// 0-1-2
/// ```
pub(super) fn sheet() -> HalfEdgeMesh {
    let square = |a: u32| [[a, a + 1, a + 4], [a, a + 4, a + 3]];
    mesh_of([0, 1, 3, 4].map(square).as_flattened())
}
