//! From a list of faces to half-edges, in time proportional to its length.

use super::{FaceId, HalfEdgeId, HalfEdgeMesh, VertexId};
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// Why a list of faces is no manifold mesh, with the numbers of what shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// A face has fewer than three corners.
    #[error("face {} has fewer than three corners", .face.index())]
    TooFewCorners {
        /// The face.
        face: FaceId,
    },
    /// A corner names a vertex that is not there.
    #[error("face {} names vertex {vertex}, which is not there", .face.index())]
    VertexOutOfRange {
        /// The face.
        face: FaceId,
        /// The number that it names.
        vertex: u32,
    },
    /// A face has a vertex at two of its corners.
    #[error("face {} has vertex {} twice", .face.index(), .vertex.index())]
    RepeatedVertex {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Three or more faces share an edge.
    #[error("three faces share the edge of vertices {} and {}", .ends[0].index(), .ends[1].index())]
    SingularEdge {
        /// Its ends, the smaller first.
        ends: [VertexId; 2],
        /// The first three of its faces.
        faces: [FaceId; 3],
    },
    /// Two faces run along their common edge in the same direction: they are oriented against each other.
    #[error("two faces run from vertex {} to vertex {}", .ends[0].index(), .ends[1].index())]
    OrientationConflict {
        /// From where to where both run.
        ends: [VertexId; 2],
        /// The faces.
        faces: [FaceId; 2],
    },
    /// The faces around a vertex are more than one fan.
    #[error("the faces around vertex {} are more than one fan", .vertex.index())]
    SingularVertex {
        /// The vertex.
        vertex: VertexId,
    },
    /// More elements than 32-bit numbers can tell apart.
    #[error("too many elements for 32-bit numbers")]
    TooLarge,
    /// The budget stopped the run.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl HalfEdgeMesh {
    /// The mesh of triangles. Half-edge `3 t + c` runs from corner `c` of triangle `t`; those on the empty sides of
    /// boundaries come after all others. O(n).
    ///
    /// # Errors
    /// When the triangles are not a coherently oriented manifold with boundary, or the budget stops the run.
    pub fn from_triangles(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<Self, BuildError> {
        let starts = (0..triangles.len() + 1).map(|t| (t * 3) as u32);
        Self::from_loops(triangles.as_flattened(), starts, vertex_count, budget)
    }

    /// The mesh of polygons: face `f` has the corners `starts[f]..starts[f + 1]`, counter-clockwise seen from outside.
    /// Half-edge `i` runs from corner `i`; those on the empty sides of boundaries come after all others. O(n).
    ///
    /// # Errors
    /// When the polygons are not a coherently oriented manifold with boundary, or the budget stops the run.
    ///
    /// # Panics
    /// When `starts` does not begin with 0, ascend and end with the number of corners.
    pub fn from_polygons(
        corners: &[u32],
        starts: &[u32],
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<Self, BuildError> {
        assert!(starts.first() == Some(&0) && starts.last() == Some(&(corners.len() as u32)), "starts");
        Self::from_loops(corners, starts.iter().copied(), vertex_count, budget)
    }

    fn from_loops(
        corners: &[u32],
        starts: impl ExactSizeIterator<Item = u32> + Clone,
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<Self, BuildError> {
        // Each corner may need a second half-edge on an empty side.
        if corners.len() >= (u32::MAX / 2) as usize || vertex_count >= u32::MAX as usize {
            return Err(BuildError::TooLarge);
        }
        let face_count = starts.len() - 1;
        let _charge = budget.charge(corners.len() as u64 * 20 + (vertex_count + face_count) as u64 * 4)?;
        let mut mesh = Self {
            next: vec![HalfEdgeId::NONE; corners.len()],
            prev: vec![HalfEdgeId::NONE; corners.len()],
            twin: vec![HalfEdgeId::NONE; corners.len()],
            origin: vec![VertexId::NONE; corners.len()],
            face: vec![FaceId::NONE; corners.len()],
            leaving: vec![HalfEdgeId::NONE; vertex_count],
            side: Vec::with_capacity(face_count),
        };
        mesh.close_loops(corners, starts, budget)?;
        mesh.pair_half_edges(budget)?;
        mesh.add_empty_sides(budget)?;
        mesh.require_one_fan_each(budget)?;
        Ok(mesh)
    }

    /// Faces, their loops and their vertices.
    fn close_loops(
        &mut self,
        corners: &[u32],
        starts: impl Iterator<Item = u32> + Clone,
        budget: &Budget,
    ) -> Result<(), BuildError> {
        // The last face that used a vertex: a vertex met again in one face is there twice.
        let mut last_face = vec![FaceId::NONE; self.leaving.len()];
        for (f, (start, end)) in starts.clone().zip(starts.skip(1)).enumerate() {
            if f % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let face = FaceId::new(f);
            if start as usize + 3 > end as usize {
                return Err(BuildError::TooFewCorners { face });
            }
            for i in start..end {
                let vertex = corners[i as usize];
                if vertex as usize >= self.leaving.len() {
                    return Err(BuildError::VertexOutOfRange { face, vertex });
                }
                if std::mem::replace(&mut last_face[vertex as usize], face) == face {
                    return Err(BuildError::RepeatedVertex { face, vertex: VertexId::new(vertex as usize) });
                }
                let h = HalfEdgeId::new(i as usize);
                self.origin[h.index()] = VertexId::new(vertex as usize);
                self.face[h.index()] = face;
                self.link(h, HalfEdgeId::new(if i + 1 == end { start } else { i + 1 } as usize));
                if self.leaving[vertex as usize] == HalfEdgeId::NONE {
                    self.leaving[vertex as usize] = h;
                }
            }
            self.side.push(HalfEdgeId::new(start as usize));
        }
        Ok(())
    }

    /// Finds the twins: a counting sort by the smaller end, then a short sort inside each vertex.
    fn pair_half_edges(&mut self, budget: &Budget) -> Result<(), BuildError> {
        let ends = |mesh: &Self, h: usize| {
            let (a, b) = (mesh.origin[h], mesh.origin[mesh.next[h].index()]);
            (a.min(b), a.max(b))
        };
        let _charge = budget.charge(self.next.len() as u64 * 12 + self.leaving.len() as u64 * 4)?;
        let mut cursor = vec![0u32; self.leaving.len() + 1];
        for h in 0..self.next.len() {
            cursor[ends(self, h).0.index() + 1] += 1;
        }
        for v in 1..cursor.len() {
            cursor[v] += cursor[v - 1];
        }
        budget.check()?;
        let mut keyed = vec![(VertexId::NONE, HalfEdgeId::NONE); self.next.len()];
        for h in 0..self.next.len() {
            let (min, max) = ends(self, h);
            let place = &mut cursor[min.index()];
            keyed[*place as usize] = (max, HalfEdgeId::new(h));
            *place += 1;
        }
        let mut begin = 0;
        for (v, &end) in cursor[..self.leaving.len()].iter().enumerate() {
            if v % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let star = &mut keyed[begin..end as usize];
            star.sort_unstable();
            for edge in star.chunk_by(|x, y| x.0 == y.0) {
                self.pair_edge(edge)?;
            }
            begin = end as usize;
        }
        Ok(())
    }

    /// Pairs the half-edges of one edge, which are in the order of their numbers.
    fn pair_edge(&mut self, edge: &[(VertexId, HalfEdgeId)]) -> Result<(), BuildError> {
        let face = |mesh: &Self, i: usize| mesh.face[edge[i].1.index()];
        let (a, b) = match *edge {
            [_] => return Ok(()),
            [(_, a), (_, b)] => (a, b),
            _ => {
                let (first, other) = (self.origin(edge[0].1), self.origin(self.next(edge[0].1)));
                let faces = std::array::from_fn(|i| face(self, i));
                return Err(BuildError::SingularEdge { ends: [first.min(other), first.max(other)], faces });
            }
        };
        if self.origin(a) == self.origin(b) {
            let ends = [self.origin(a), self.origin(self.next(a))];
            return Err(BuildError::OrientationConflict { ends, faces: [face(self, 0), face(self, 1)] });
        }
        self.pair(a, b);
        Ok(())
    }

    /// Gives each half-edge without a twin one on the empty side, and links these to loops.
    fn add_empty_sides(&mut self, budget: &Budget) -> Result<(), BuildError> {
        let inner = self.next.len();
        for i in 0..inner {
            if i % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let h = HalfEdgeId::new(i);
            if self.twin(h) == HalfEdgeId::NONE {
                let end = self.origin(self.next(h));
                let empty = HalfEdgeId::new(self.next.len());
                self.next.push(HalfEdgeId::NONE);
                self.prev.push(HalfEdgeId::NONE);
                self.twin.push(HalfEdgeId::NONE);
                self.origin.push(end);
                self.face.push(FaceId::NONE);
                self.pair(h, empty);
                // Two boundary half-edges leave a vertex only when it has two fans.
                if self.leaving[end.index()].index() >= inner {
                    return Err(BuildError::SingularVertex { vertex: end });
                }
                self.leaving[end.index()] = empty;
            }
        }
        for i in inner..self.next.len() {
            let empty = HalfEdgeId::new(i);
            let end = self.destination(empty);
            self.link(empty, self.leaving[end.index()]);
        }
        Ok(())
    }

    /// Fails at the first vertex that has faces beyond those of one fan.
    fn require_one_fan_each(&self, budget: &Budget) -> Result<(), BuildError> {
        let mut valence = vec![0u32; self.leaving.len()];
        for (h, v) in self.origin.iter().enumerate() {
            if h % CHECK_EVERY == 0 {
                budget.check()?;
            }
            valence[v.index()] += 1;
        }
        for vertex in self.vertices() {
            if vertex.index() % CHECK_EVERY == 0 {
                budget.check()?;
            }
            if self.star(vertex).count() < valence[vertex.index()] as usize {
                return Err(BuildError::SingularVertex { vertex });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::half_edge::Claims;
    use crate::mesh::half_edge::samples::{TETRAHEDRON, cube, sheet};

    fn built(triangles: &[[u32; 3]], vertex_count: usize) -> Result<HalfEdgeMesh, BuildError> {
        HalfEdgeMesh::from_triangles(triangles, vertex_count, &Budget::unlimited())
    }

    fn faces<const N: usize>(numbers: [usize; N]) -> [FaceId; N] {
        numbers.map(FaceId::new)
    }

    #[test]
    fn triangles_and_polygons_keep_their_numbers_and_corners() {
        let tetrahedron = built(&TETRAHEDRON, 5).unwrap();
        assert_eq!(tetrahedron.counts().euler(), 2);
        assert_eq!(tetrahedron.half_edge_bound(), 12);
        for (f, corners) in TETRAHEDRON.iter().enumerate() {
            let listed: Vec<u32> = tetrahedron.corners(FaceId::new(f)).map(|v| v.index() as u32).collect();
            assert_eq!(listed, corners);
        }
        assert!(tetrahedron.leaving(VertexId::new(4)).is_none());
        let cube = cube();
        assert_eq!((cube.counts().vertices, cube.counts().edges, cube.counts().faces), (8, 12, 6));
        let closed = Claims { is_closed: true, euler: Some(2), ..Claims::default() };
        assert_eq!(cube.check(&closed, &Budget::unlimited()).unwrap(), []);
    }

    #[test]
    fn the_empty_side_of_a_sheet_is_one_loop() {
        let sheet = sheet();
        let counts = sheet.counts();
        assert_eq!((counts.boundary_loops, counts.euler()), (1, 1));
        let first = sheet.boundary_loops()[0];
        assert_eq!(sheet.sides(first), 8);
        assert!(sheet.loop_of(first).all(|h| sheet.is_boundary_vertex(sheet.origin(h))));
        assert_eq!(sheet.check(&Claims::default(), &Budget::unlimited()).unwrap(), []);
    }

    #[test]
    fn faces_that_are_none_are_named() {
        let polygons = |corners: &[u32], starts: &[u32]| {
            HalfEdgeMesh::from_polygons(corners, starts, 4, &Budget::unlimited()).unwrap_err()
        };
        let face = FaceId::new(1);
        assert_eq!(polygons(&[0, 1, 2, 3, 0], &[0, 3, 5]), BuildError::TooFewCorners { face });
        assert_eq!(
            built(&[[0, 1, 2], [0, 2, 4]], 4).unwrap_err(),
            BuildError::VertexOutOfRange { face, vertex: 4 }
        );
        assert_eq!(
            built(&[[0, 1, 2], [3, 2, 3]], 4).unwrap_err(),
            BuildError::RepeatedVertex { face, vertex: VertexId::new(3) }
        );
    }

    #[test]
    fn what_is_not_manifold_is_named() {
        let v = VertexId::new;
        assert_eq!(
            built(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5).unwrap_err(),
            BuildError::SingularEdge { ends: [v(0), v(1)], faces: faces([0, 1, 2]) }
        );
        assert_eq!(
            built(&[[1, 0, 2], [1, 0, 3]], 4).unwrap_err(),
            BuildError::OrientationConflict { ends: [v(1), v(0)], faces: faces([0, 1]) }
        );
        let bow_tie = built(&[[0, 1, 2], [2, 3, 4]], 5).unwrap_err();
        assert_eq!(bow_tie, BuildError::SingularVertex { vertex: v(2) });
        let mut cones = TETRAHEDRON.to_vec();
        cones.extend(TETRAHEDRON.map(|t| t.map(|v| if v == 3 { 3 } else { v + 4 })));
        assert_eq!(built(&cones, 7).unwrap_err(), BuildError::SingularVertex { vertex: v(3) });
    }

    #[test]
    fn nothing_is_a_mesh_too() {
        assert_eq!(built(&[], 0).unwrap().counts().euler(), 0);
    }
}
