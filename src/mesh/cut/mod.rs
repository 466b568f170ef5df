//! Cuts a triangle list along marked edges and at singular vertices, so that what remains is a manifold with boundary.
//!
//! After Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching: converting sets of polygons to manifold surfaces"
//! (2001). Both of their methods are here and give the same triangles, numbered alike; they differ in cost: the global
//! one follows the number of edges, the local one the number of singular vertices times their valence. Here an edge
//! whose two triangles run in the same direction counts as marked and is cut too. No coordinates here.

mod chosen;
mod global;
mod local;
mod marks;

pub use chosen::ChosenEdges;
pub use marks::CutMarks;

use super::EdgeGroups;
use crate::budget::{Budget, Stopped};

/// How the corners that stay together are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CutMethod {
    /// Every triangle starts with three vertices of its own; corners are united across all unmarked edges.
    Global,
    /// Only the stars of vertices with more than one fan are taken apart.
    Local,
}

impl CutMethod {
    /// The method that costs less for these marks. The global one has to go through all corners whatever is marked, so
    /// the local one wins unless a large share of the corners is at singular vertices.
    pub fn cheaper(marks: &CutMarks, triangle_count: usize) -> Self {
        let is_local = marks.corner_count() * LOCAL_OF <= triangle_count * 3 * LOCAL_MAX;
        if is_local { Self::Local } else { Self::Global }
    }
}

/// So many of [`LOCAL_OF`] corners may be at singular vertices for the local cut: up to there it was measured, and cost less
/// everywhere (`benches/cut.rs`).
const LOCAL_MAX: usize = 2;

/// See [`LOCAL_MAX`].
const LOCAL_OF: usize = 3;

/// What [`cut_singular`] did.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CutResult {
    /// For each new vertex, numbered from the old vertex count on, the old vertex of which it is a copy.
    pub copies: Vec<u32>,
    /// Edges with more than two triangles, or with two in the same direction.
    pub singular_edges: u64,
}

/// Renames corners to new vertices until `triangles` are a manifold with boundary, coherently oriented. No triangle may
/// have a repeated vertex. A manifold stays as it is: of the fans around a vertex, the first keeps its id.
///
/// ```text
///      \ | /             \   | /
///       \|/               \  |/
///    ----v----    gives    v  v'---     three fans at v: one keeps v, the others get copies of it
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn cut_singular(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    budget: &Budget,
) -> Result<CutResult, Stopped> {
    let groups = EdgeGroups::build(triangles, vertex_count, budget)?;
    let marks = CutMarks::find(triangles, vertex_count, &groups, &ChosenEdges::default(), budget)?;
    drop(groups);
    let method = CutMethod::cheaper(&marks, triangles.len());
    let copies = cut(triangles, vertex_count, &marks, method, budget)?;
    Ok(CutResult { copies, singular_edges: marks.singular_edges + marks.conflicting_edges })
}

/// Cuts `triangles` at the `marks` that were found in them. Of the fans that are left around a vertex, the one with the
/// smallest corner keeps its id; each other one gets a copy. Gives for each copy, numbered from `vertex_count` on in the
/// order of their smallest corners, the old vertex.
///
/// # Errors
/// When the budget stops the run.
pub fn cut(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    marks: &CutMarks,
    method: CutMethod,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    match method {
        CutMethod::Global => global::cut(triangles, vertex_count, marks, budget),
        CutMethod::Local => local::cut(triangles, vertex_count, marks, budget),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut_by(
        method: CutMethod,
        triangles: &[[u32; 3]],
        vertex_count: usize,
        chosen: &[[u32; 2]],
    ) -> (Vec<[u32; 3]>, Vec<u32>) {
        let budget = Budget::unlimited();
        let mut after = triangles.to_vec();
        let groups = EdgeGroups::build(triangles, vertex_count, &budget).unwrap();
        let chosen = ChosenEdges::of(chosen.iter().copied());
        let marks = CutMarks::find(triangles, vertex_count, &groups, &chosen, &budget).unwrap();
        let copies = cut(&mut after, vertex_count, &marks, method, &budget).unwrap();
        (after, copies)
    }

    /// Both methods must give this.
    fn assert_cut(
        before: &[[u32; 3]],
        vertex_count: usize,
        chosen: &[[u32; 2]],
        after: &[[u32; 3]],
        copies: &[u32],
    ) {
        for method in [CutMethod::Global, CutMethod::Local] {
            let got = cut_by(method, before, vertex_count, chosen);
            assert_eq!(got, (after.to_vec(), copies.to_vec()), "{method:?}");
        }
    }

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_manifold_stays_as_it_is() {
        assert_cut(&TETRAHEDRON, 4, &[], &TETRAHEDRON, &[]);
    }

    #[test]
    fn a_fan_of_three_faces_on_one_edge_is_cut_into_three_sheets() {
        let sheets = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
        assert_cut(&sheets, 5, &[], &[[0, 1, 2], [5, 6, 3], [7, 8, 4]], &[1, 0, 0, 1]);
    }

    #[test]
    fn two_triangles_that_share_only_a_vertex_get_one_each() {
        assert_cut(&[[0, 1, 2], [0, 3, 4]], 5, &[], &[[0, 1, 2], [5, 3, 4]], &[0]);
    }

    #[test]
    fn neighbours_in_the_same_direction_are_parted() {
        assert_cut(&[[0, 1, 2], [0, 1, 3]], 4, &[], &[[0, 1, 2], [4, 5, 3]], &[0, 1]);
    }

    #[test]
    fn a_chosen_edge_inside_a_surface_is_a_slit_whose_ends_stay_whole() {
        // One edge of a closed surface: both ends still have one fan, so nothing can part.
        assert_cut(&TETRAHEDRON, 4, &[[0, 1]], &TETRAHEDRON, &[]);
        // A path of two: the vertex between them is parted.
        assert_cut(&TETRAHEDRON, 4, &[[1, 0], [0, 2]], &[[0, 2, 1], [4, 1, 3], [1, 2, 3], [2, 4, 3]], &[0]);
    }

    #[test]
    fn what_was_found_is_counted_by_kind() {
        let budget = Budget::unlimited();
        // A book of three pages on 0-1, a pair in one direction on 5-6, and 2 shared with a triangle of its own.
        let soup = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [5, 6, 7], [5, 6, 8], [2, 9, 10]];
        let groups = EdgeGroups::build(&soup, 11, &budget).unwrap();
        let marks = CutMarks::find(&soup, 11, &groups, &ChosenEdges::of([[2, 9]]), &budget).unwrap();
        assert_eq!((marks.singular_edges, marks.conflicting_edges, marks.chosen_edges), (1, 1, 1));
        assert_eq!(marks.vertices(), [0, 1, 2, 5, 6]);
        assert_eq!(marks.isolated_vertices, 0, "2 is the end of a chosen edge");
        let marks = CutMarks::find(&soup, 11, &groups, &ChosenEdges::default(), &budget).unwrap();
        assert_eq!((marks.chosen_edges, marks.isolated_vertices), (0, 1));
    }
}
