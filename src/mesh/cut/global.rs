//! The global cut: all corners start apart and are united across every edge that is not marked.

use super::CutMarks;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{NO_TWIN, UnionFind, next_corner};

pub(super) fn cut(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    marks: &CutMarks,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let _charge = budget.charge(triangles.len() as u64 * 3 * 8)?;
    let mut corners = UnionFind::new(triangles.len() * 3);
    for (g, &h) in marks.twins().iter().enumerate() {
        if g % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let g = g as u32;
        if h != NO_TWIN && g < h {
            corners.unite(g, next_corner(h));
            corners.unite(next_corner(g), h);
        }
    }
    name_classes(triangles, vertex_count, &mut corners, budget)
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
