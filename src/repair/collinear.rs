//! Removes triangles whose three different corners lie exactly on one line, without opening a gap.
//!
//! Collinear triangles that share edges form a cluster on one line. The whole cluster goes at once, and every other
//! triangle with an edge of the cluster is divided at the cluster's vertices inside that edge:
//!
//! ```text
//!        c                       c
//!       / \                     /|\
//!      /   \                   / | \
//!     a-----b       gives     a--m--b       a m b was the collinear triangle; x and y stay as they are
//!      \-m-/                   x   y
//!      x   y
//! ```
//!
//! The boundary of a collinear triangle runs to and fro on its line and cancels there, so each piece of the line borders
//! as many triangles afterwards as before, counted without the cluster: no boundary opens. A triangle that is divided
//! leaves no collinear one, because its third corner is off the line. So one pass is enough.

use super::{Changes, Draft};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::are_collinear;
use crate::mesh::{UnionFind, divide};
use crate::par;

/// Removes collinear triangles. The draft must be welded and have no repeated corners.
///
/// # Errors
/// When the budget stops the run.
pub fn split_collinear(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let collinear = collinear_triangles(draft, budget)?;
    let mut split = 0;
    if !collinear.is_empty() {
        let lines = CollinearLines::of(draft, &collinear);
        split = replace(draft, &collinear, &lines, budget)?;
        draft.drop_unused_vertices();
    }
    Ok(Changes::counted([("triangles_dropped", collinear.len() as u64), ("triangles_split", split)]))
}

fn collinear_triangles(draft: &Draft, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let parts = par::try_map_ranges(draft.triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let is_collinear = |&t: &usize| {
            let [a, b, c] = draft.corners(t);
            are_collinear(a, b, c)
        };
        Ok(range.filter(is_collinear).map(|t| t as u32).collect::<Vec<u32>>())
    })?;
    Ok(parts.concat())
}

/// The edges of collinear triangles, and for each cluster its vertices along the line.
struct CollinearLines {
    /// Edge (smaller vertex first) and cluster, ascending.
    edges: Vec<([u32; 2], u32)>,
    /// Vertices of each cluster in the order of the line.
    vertices: Vec<Vec<u32>>,
}

impl CollinearLines {
    fn of(draft: &Draft, collinear: &[u32]) -> Self {
        let mut edges: Vec<([u32; 2], u32)> = collinear
            .iter()
            .enumerate()
            .flat_map(|(i, &t)| {
                let [a, b, c] = draft.triangles[t as usize];
                [(a, b), (b, c), (c, a)].map(|(a, b)| ([a.min(b), a.max(b)], i as u32))
            })
            .collect();
        edges.sort_unstable();
        let mut clusters = UnionFind::new(collinear.len());
        for shared in edges.chunk_by(|a, b| a.0 == b.0) {
            for other in &shared[1..] {
                clusters.unite(shared[0].1, other.1);
            }
        }
        let clusters = clusters.into_components();
        let mut vertices = vec![Vec::new(); clusters.count as usize];
        for (edge, i) in &mut edges {
            *i = clusters.of[*i as usize];
            vertices[*i as usize].extend(*edge);
        }
        edges.dedup();
        for line in &mut vertices {
            sort_along_line(line, draft);
        }
        Self { edges, vertices }
    }

    /// The cluster vertices strictly between the ends of an edge, from `a` to `b`.
    fn between(&self, a: u32, b: u32, draft: &Draft) -> Vec<u32> {
        let edge = [a.min(b), a.max(b)];
        let Ok(found) = self.edges.binary_search_by_key(&edge, |&(edge, _)| edge) else {
            return Vec::new();
        };
        let line = &self.vertices[self.edges[found].1 as usize];
        let rank = |v: u32| line.partition_point(|&u| key(draft, u) < key(draft, v));
        let (from, to) = (rank(a), rank(b));
        if from < to {
            line[from + 1..to].to_vec()
        } else {
            line[to + 1..from].iter().rev().copied().collect()
        }
    }
}

/// Coordinates in the order in which they decide; along a line this order is that of the line.
fn key(draft: &Draft, v: u32) -> [f64; 3] {
    draft.positions[v as usize].to_array()
}

/// Sorts vertices of one line by position and drops repeated ones. Positions are finite and different, so the order is
/// total.
fn sort_along_line(line: &mut Vec<u32>, draft: &Draft) {
    line.sort_unstable();
    line.dedup();
    line.sort_by(|&u, &v| key(draft, u).partial_cmp(&key(draft, v)).unwrap_or(std::cmp::Ordering::Equal));
}

/// Drops the collinear triangles and divides their neighbours; gives the number of those.
fn replace(
    draft: &mut Draft,
    collinear: &[u32],
    lines: &CollinearLines,
    budget: &Budget,
) -> Result<u64, Stopped> {
    let mut is_on_line = vec![false; draft.positions.len()];
    for &v in lines.vertices.iter().flatten() {
        is_on_line[v as usize] = true;
    }
    let mut dropped = collinear.iter().peekable();
    let mut triangles = Vec::with_capacity(draft.triangles.len());
    let mut origins = Vec::with_capacity(draft.triangles.len());
    let mut split = 0;
    for (t, &[a, b, c]) in draft.triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if dropped.next_if(|&&d| d as usize == t).is_some() {
            continue;
        }
        let on = [(a, b), (b, c), (c, a)].map(|(a, b)| {
            if is_on_line[a as usize] && is_on_line[b as usize] {
                lines.between(a, b, draft)
            } else {
                Vec::new()
            }
        });
        let parts = divide([a, b, c], on.each_ref().map(Vec::as_slice));
        budget.spend(parts.len() as u64 - 1)?;
        split += u64::from(parts.len() > 1);
        origins.extend(std::iter::repeat_n(draft.triangle_origin[t], parts.len()));
        triangles.extend(parts);
    }
    draft.triangles = triangles;
    draft.triangle_origin = origins;
    Ok(split)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn draft(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> Draft {
        Draft {
            positions: points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect(),
            vertex_origin: (0..points.len() as u32).collect(),
            triangles: triangles.to_vec(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    fn split(draft: &mut Draft) -> Changes {
        let changes = split_collinear(draft, &Budget::unlimited()).unwrap();
        assert_eq!(draft.check(), Vec::<String>::new());
        changes
    }

    const LINE: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [1.0, 1.0], [1.0, -1.0]];

    #[test]
    fn the_neighbour_across_the_longest_edge_is_split_at_the_middle_vertex() {
        let mut mesh = draft(&LINE, &[[0, 2, 4], [0, 1, 2], [0, 5, 1], [1, 5, 2]]);
        let changes = split(&mut mesh);
        assert_eq!((changes.count("triangles_dropped"), changes.count("triangles_split")), (1, 1));
        // Vertex 3 is unused and gone: 4 is 3 now, and 5 is 4.
        assert_eq!(mesh.triangles, [[3, 0, 1], [2, 3, 1], [0, 4, 1], [1, 4, 2]]);
        assert_eq!(mesh.triangle_origin, [0, 0, 2, 3]);
    }

    #[test]
    fn a_chain_of_collinear_triangles_goes_in_one_pass() {
        let mut mesh = draft(&LINE, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5]]);
        let changes = split(&mut mesh);
        assert_eq!((changes.count("triangles_dropped"), changes.count("triangles_split")), (2, 1));
        assert_eq!(mesh.triangles.len(), 6);
        assert_eq!(mesh.triangle_origin, [2, 2, 2, 3, 4, 5]);
    }

    #[test]
    fn two_slivers_on_one_edge_split_each_others_neighbours() {
        // 0-3 is the common longest edge; one sliver has 1 inside it, the other 2.
        let mut mesh = draft(&LINE, &[[0, 3, 1], [3, 0, 2], [0, 1, 5], [1, 3, 5], [2, 0, 4], [3, 2, 4]]);
        let changes = split(&mut mesh);
        assert_eq!((changes.count("triangles_dropped"), changes.count("triangles_split")), (2, 2));
        assert_eq!(mesh.triangles.len(), 6);
    }

    #[test]
    fn a_collinear_triangle_alone_just_goes() {
        let mut mesh = draft(&LINE, &[[0, 1, 3]]);
        split(&mut mesh);
        assert!(mesh.triangles.is_empty() && mesh.positions.is_empty());
    }
}
