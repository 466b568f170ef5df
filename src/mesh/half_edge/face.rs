//! Face split by a new edge, and its inverse, the merge of two faces by removing their common edge.

use super::{FaceId, HalfEdgeId, HalfEdgeMesh, VertexId};

/// Why a face is not split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SplitFaceRefusal {
    /// The half-edges are not of one face.
    #[error("the half-edges are not of one face")]
    NotOneFace,
    /// The vertices that the edge would join are one vertex or have an edge already.
    #[error("vertices {} and {} are joined already", .ends[0].index(), .ends[1].index())]
    JoinedAlready {
        /// The vertices.
        ends: [VertexId; 2],
    },
}

/// Why two faces are not merged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum MergeRefusal {
    /// One side of the edge is empty.
    #[error("a boundary edge")]
    Boundary,
    /// The faces share another vertex: the merged face would have it twice.
    #[error("the faces also share vertex {}", .vertex.index())]
    SharedVertex {
        /// The vertex.
        vertex: VertexId,
    },
}

impl HalfEdgeMesh {
    /// Splits the face of `h` and `g` by an edge between their origins, and gives its half-edge from the origin of `g`
    /// to that of `h`, which has the old face; its twin has a new one.
    ///
    /// ```text
    ///      +-----g+              +-----g+
    ///      |      |              |    / |
    ///      |      |    gives     |  /   |      h, ..., and the new edge back to it: the old face
    ///      +h-----+              +h-----+
    /// ```
    ///
    /// # Errors
    /// With the reason why not; then nothing changes.
    pub fn split_face(&mut self, h: HalfEdgeId, g: HalfEdgeId) -> Result<HalfEdgeId, SplitFaceRefusal> {
        if self.is_boundary(h) || self.face(g) != self.face(h) {
            return Err(SplitFaceRefusal::NotOneFace);
        }
        let (a, b) = (self.origin(h), self.origin(g));
        if a == b || self.find(a, b).is_some() {
            return Err(SplitFaceRefusal::JoinedAlready { ends: [a, b] });
        }
        Ok(self.cut_face(h, g))
    }

    /// Removes the edge of `h`; the face of `h` takes the place of both. Gives that face.
    ///
    /// ```text
    ///      +-----+-----+             +-----+-----+
    ///      |     |     |             |           |
    ///      |     h     |    gives    |           |
    ///      +-----+-----+             +-----+-----+
    /// ```
    ///
    /// # Errors
    /// With the reason why not; then nothing changes.
    pub fn merge_faces(&mut self, h: HalfEdgeId) -> Result<FaceId, MergeRefusal> {
        let t = self.twin(h);
        let (Some(kept), Some(gone)) = (self.face(h), self.face(t)) else {
            return Err(MergeRefusal::Boundary);
        };
        let ends = [self.origin(h), self.origin(t)];
        for vertex in self.corners(gone) {
            if !ends.contains(&vertex) && self.corners(kept).any(|v| v == vertex) {
                return Err(MergeRefusal::SharedVertex { vertex });
            }
        }
        self.join_faces(h);
        Ok(kept)
    }

    /// [`split_face`](Self::split_face) without its conditions.
    pub(super) fn cut_face(&mut self, h: HalfEdgeId, g: HalfEdgeId) -> HalfEdgeId {
        let (a, b, face) = (self.origin(h), self.origin(g), self.face[h.index()]);
        let (before_h, before_g) = (self.prev(h), self.prev(g));
        let (back, new) = self.add_edge(b, a);
        self.link(before_g, back);
        self.link(back, h);
        self.link(before_h, new);
        self.link(new, g);
        self.face[back.index()] = face;
        self.side[face.index()] = back;
        self.add_face(new);
        back
    }

    /// [`merge_faces`](Self::merge_faces) without its conditions.
    pub(super) fn join_faces(&mut self, h: HalfEdgeId) {
        let t = self.twin(h);
        let (kept, gone) = (self.face[h.index()], self.face[t.index()]);
        let sides = [(self.prev(h), self.next(t)), (self.prev(t), self.next(h))];
        for (before, after) in sides {
            self.link(before, after);
        }
        self.set_face(sides[0].0, kept);
        self.side[kept.index()] = sides[0].0;
        self.side[gone.index()] = HalfEdgeId::NONE;
        for (v, removed, (_, after)) in [(self.origin(h), h, sides[0]), (self.origin(t), t, sides[1])] {
            if self.leaving[v.index()] == removed {
                self.leaving[v.index()] = after;
            }
        }
        self.remove_half_edge(h);
        self.remove_half_edge(t);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::mesh::half_edge::Claims;
    use crate::mesh::half_edge::samples::{OCTAHEDRON, cube, mesh_of, sheet};

    fn assert_sound(mesh: &HalfEdgeMesh, euler: i64) {
        let claims = Claims { euler: Some(euler), ..Claims::default() };
        assert_eq!(mesh.check(&claims, &Budget::unlimited()).unwrap(), []);
    }

    #[test]
    fn a_quad_is_split_along_both_diagonals_and_merged_again() {
        let before = cube();
        for h in before.half_edges() {
            let mut mesh = before.clone();
            let g = before.next(before.next(h));
            let edge = mesh.split_face(h, g).unwrap();
            assert_sound(&mesh, 2);
            assert_eq!((mesh.destination(edge), mesh.origin(edge)), (before.origin(h), before.origin(g)));
            assert_eq!((mesh.face(edge), mesh.sides(edge)), (before.face(h), 3));
            assert_eq!(mesh.merge_faces(edge), Ok(before.face(h).unwrap()));
            assert_sound(&mesh, 2);
            assert!(before.half_edges().all(|h| mesh.next(h) == before.next(h)));
        }
    }

    #[test]
    fn each_refusal_is_named() {
        let mut cube = cube();
        let h = HalfEdgeId::new(0);
        let (a, b) = (cube.origin(h), cube.destination(h));
        assert_eq!(cube.split_face(h, cube.next(h)), Err(SplitFaceRefusal::JoinedAlready { ends: [a, b] }));
        assert_eq!(cube.split_face(h, h), Err(SplitFaceRefusal::JoinedAlready { ends: [a, a] }));
        assert_eq!(cube.split_face(h, cube.twin(h)), Err(SplitFaceRefusal::NotOneFace));
        let mut sheet = sheet();
        let border = sheet.boundary_loops()[0];
        assert_eq!(sheet.merge_faces(border), Err(MergeRefusal::Boundary));
    }

    #[test]
    fn faces_are_merged_until_they_would_meet_themselves() {
        let mut mesh = mesh_of(&OCTAHEDRON);
        let mut refused = 0;
        for h in 0..mesh.half_edge_bound() {
            let h = HalfEdgeId::new(h);
            if mesh.contains(h) {
                match mesh.merge_faces(h) {
                    Ok(_) => {}
                    Err(MergeRefusal::SharedVertex { .. }) => refused += 1,
                    Err(MergeRefusal::Boundary) => unreachable!("a closed mesh"),
                }
                assert_sound(&mesh, 2);
            }
        }
        assert!(refused > 0);
        assert!(mesh.counts().faces < 8);
    }
}
