//! A corner table from a triangle list.

use super::{CornerTable, NONE, Triangle, triangle_of};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::half_edge::{BuildError, FaceId, VertexId};
use crate::mesh::next_corner;
use crate::par;

/// An edge that was met, in the list of its smaller end.
struct EdgeEntry {
    larger_end: u32,
    first_half_edge: u32,
    following: u32,
}

impl CornerTable {
    /// The table of `triangles`, in their order. O(n) when vertices have a bounded number of edges to later ones.
    ///
    /// # Errors
    /// When the triangles are not a coherently oriented manifold with boundary, or the budget stops the run.
    pub fn build(triangles: &[[u32; 3]], vertex_count: usize, budget: &Budget) -> Result<Self, BuildError> {
        if triangles.len() >= (u32::MAX / 4) as usize {
            return Err(BuildError::TooLarge);
        }
        let mut table = Self { triangles: Vec::with_capacity(triangles.len()), alive: triangles.len() };
        for (t, &corners) in triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            require_corners(t, corners, vertex_count)?;
            let [a, b, c] = corners;
            table.triangles.push(Triangle { corners: [a, b, c, NONE], twins: [NONE, NONE, NONE, 0] });
        }
        table.find_twins(vertex_count, budget)?;
        table.require_one_fan_each(vertex_count, budget)?;
        Ok(table)
    }

    /// Pairs half-edges, by a list of the edges met at each smaller end.
    fn find_twins(&mut self, vertex_count: usize, budget: &Budget) -> Result<(), BuildError> {
        let edges = self.triangles.len() * 3 / 2 + 1;
        let _charge = budget.charge((edges * size_of::<EdgeEntry>() + vertex_count * 4) as u64)?;
        let mut nodes: Vec<EdgeEntry> = Vec::with_capacity(edges);
        let mut heads = vec![NONE; vertex_count];
        for t in 0..self.triangles.len() as u32 {
            if (t as usize).is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            for h in [4 * t, 4 * t + 1, 4 * t + 2] {
                let (from, to) = (self.origin(h), self.destination(h));
                let (smaller, larger) = (from.min(to), from.max(to));
                let mut at = heads[smaller as usize];
                while at != NONE && nodes[at as usize].larger_end != larger {
                    at = nodes[at as usize].following;
                }
                if at == NONE {
                    let following = std::mem::replace(&mut heads[smaller as usize], nodes.len() as u32);
                    nodes.push(EdgeEntry { larger_end: larger, first_half_edge: h, following });
                } else {
                    self.pair_with(nodes[at as usize].first_half_edge, h)?;
                }
            }
        }
        Ok(())
    }

    /// Pairs `h` with `first`, the first half-edge of its edge.
    fn pair_with(&mut self, first: u32, h: u32) -> Result<(), BuildError> {
        let face = |h: u32| FaceId::new(triangle_of(h) as usize);
        let ends = [self.origin(first), self.destination(first)].map(|v| VertexId::new(v as usize));
        let second = self.twin(first);
        if second != NONE {
            let faces = [face(first), face(second), face(h)];
            let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            return Err(BuildError::SingularEdge { ends, faces });
        }
        if self.origin(first) == self.origin(h) {
            return Err(BuildError::OrientationConflict { ends, faces: [face(first), face(h)] });
        }
        self.pair(first, h, 0);
        Ok(())
    }

    /// Fails at the first vertex whose corners are more than one fan.
    fn require_one_fan_each(&self, vertex_count: usize, budget: &Budget) -> Result<(), BuildError> {
        let _charge = budget.charge(vertex_count as u64 * 8)?;
        // The last corner of each vertex, and how many there are.
        let mut stars = vec![(NONE, 0u32); vertex_count];
        for (t, triangle) in self.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            for (c, &v) in triangle.corners[..3].iter().enumerate() {
                let star = &mut stars[v as usize];
                *star = ((4 * t + c) as u32, star.1 + 1);
            }
        }
        let first_singular = par::try_map_ranges(vertex_count, CHECK_EVERY, |range| {
            budget.check()?;
            let is_singular = |&v: &usize| {
                let (corner, count) = stars[v];
                count > 1 && self.fan(corner).count() < count as usize
            };
            Ok::<_, Stopped>(range.into_iter().find(is_singular))
        })?;
        match first_singular.into_iter().flatten().next() {
            Some(v) => Err(BuildError::SingularVertex { vertex: VertexId::new(v) }),
            None => Ok(()),
        }
    }
}

fn require_corners(t: usize, corners: [u32; 3], vertex_count: usize) -> Result<(), BuildError> {
    let face = FaceId::new(t);
    for c in 0..3u32 {
        let vertex = corners[c as usize];
        if vertex as usize >= vertex_count {
            return Err(BuildError::VertexOutOfRange { face, vertex });
        }
        if vertex == corners[next_corner(c) as usize] {
            return Err(BuildError::RepeatedVertex { face, vertex: VertexId::new(vertex as usize) });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn built(triangles: &[[u32; 3]]) -> Result<CornerTable, BuildError> {
        CornerTable::build(triangles, 7, &Budget::unlimited())
    }

    #[test]
    fn triangles_keep_their_numbers_and_twins_run_back() {
        let table = built(&[[0, 1, 2], [2, 1, 3]]).unwrap();
        assert_eq!(table.corners(1), Some([2, 1, 3]));
        assert_eq!((table.twin(1), table.twin(4)), (4, 1));
        assert_eq!(table.half_edges().filter(|&h| table.twin(h) == NONE).count(), 4);
        assert_eq!((table.origin(6), table.destination(6)), (3, 2));
    }

    #[test]
    fn what_is_not_manifold_is_named_as_by_the_half_edge_mesh() {
        use crate::mesh::half_edge::HalfEdgeMesh;
        let broken: [&[[u32; 3]]; 6] = [
            &[[0, 1, 2], [0, 2, 7]],
            &[[0, 1, 2], [3, 2, 3]],
            &[[0, 1, 2], [1, 0, 3], [0, 1, 4]],
            &[[1, 0, 2], [1, 0, 3]],
            &[[0, 1, 2], [2, 3, 4]],
            &[[0, 1, 2], [0, 3, 4], [0, 5, 6]],
        ];
        for triangles in broken {
            let by_mesh = HalfEdgeMesh::from_triangles(triangles, 7, &Budget::unlimited()).unwrap_err();
            assert_eq!(built(triangles).unwrap_err(), by_mesh);
        }
    }
}
