//! Cuts a triangle list along its singular edges and vertices, so that what remains is a manifold with boundary.
//!
//! The global cut of Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001): every triangle starts with
//! three vertices of its own, and corners are united across the edges that exactly two triangles share. Here an edge
//! whose two triangles run in the same direction counts as marked and is cut too. No coordinates here.

use super::{EdgeGroups, UnionFind, edge_of, next_corner};
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// What [`cut_singular`] did.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Cut {
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
) -> Result<Cut, Stopped> {
    let groups = EdgeGroups::build(triangles, vertex_count, budget)?;
    let _charge = budget.charge(triangles.len() as u64 * 3 * 8)?;
    let mut corners = UnionFind::new(triangles.len() * 3);
    let mut singular_edges = 0;
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        match *group {
            [_] => {}
            [g, h] if edge_of(triangles, g)[0] != edge_of(triangles, h)[0] => {
                corners.unite(g, next_corner(h));
                corners.unite(next_corner(g), h);
            }
            _ => singular_edges += 1,
        }
    }
    let copies = name_classes(triangles, vertex_count, &mut corners, budget)?;
    Ok(Cut { copies, singular_edges })
}

/// Gives each class of corners its vertex: the first class at a vertex keeps it, each other one gets a copy.
fn name_classes(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    corners: &mut UnionFind,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let mut copies = Vec::new();
    let mut is_taken = vec![false; vertex_count];
    // The vertex of each class, at its smallest corner, which is met first.
    let mut vertex_of_class = vec![0; triangles.len() * 3];
    for (corner, vertex) in triangles.as_flattened_mut().iter_mut().enumerate() {
        if corner % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let class = corners.find(corner as u32) as usize;
        if class == corner {
            vertex_of_class[class] = if std::mem::replace(&mut is_taken[*vertex as usize], true) {
                copies.push(*vertex);
                (vertex_count + copies.len() - 1) as u32
            } else {
                *vertex
            };
        }
        *vertex = vertex_of_class[class];
    }
    Ok(copies)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(mut triangles: Vec<[u32; 3]>, vertex_count: usize) -> (Vec<[u32; 3]>, Cut) {
        let cut = cut_singular(&mut triangles, vertex_count, &Budget::unlimited()).unwrap();
        (triangles, cut)
    }

    #[test]
    fn a_manifold_stays_as_it_is() {
        let tetrahedron = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert_eq!(cut(tetrahedron.clone(), 4), (tetrahedron, Cut::default()));
    }

    #[test]
    fn a_fan_of_three_faces_on_one_edge_is_cut_into_three_sheets() {
        let (triangles, cut) = cut(vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5);
        assert_eq!(triangles, [[0, 1, 2], [5, 6, 3], [7, 8, 4]]);
        assert_eq!(cut, Cut { copies: vec![1, 0, 0, 1], singular_edges: 1 });
    }

    #[test]
    fn two_triangles_that_share_only_a_vertex_get_one_each() {
        let (triangles, cut) = cut(vec![[0, 1, 2], [0, 3, 4]], 5);
        assert_eq!(triangles, [[0, 1, 2], [5, 3, 4]]);
        assert_eq!(cut.copies, [0]);
    }

    #[test]
    fn neighbours_in_the_same_direction_are_parted() {
        let (triangles, cut) = cut(vec![[0, 1, 2], [0, 1, 3]], 4);
        assert_eq!(triangles, [[0, 1, 2], [4, 5, 3]]);
        assert_eq!(cut.singular_edges, 1);
    }
}
