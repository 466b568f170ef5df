//! Edge flip and edge split.

use super::{HalfEdgeId, HalfEdgeMesh, VertexId};

/// Why an edge is not flipped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FlipRefusal {
    /// One side of the edge is empty.
    #[error("a boundary edge")]
    Boundary,
    /// A face of the edge is not a triangle.
    #[error("a face of the edge is not a triangle")]
    NotTriangles,
    /// The vertices that the edge would join are one vertex or have an edge already.
    #[error("vertices {} and {} are joined already", .ends[0].index(), .ends[1].index())]
    JoinedAlready {
        /// The vertices.
        ends: [VertexId; 2],
    },
}

impl HalfEdgeMesh {
    /// Turns the edge of `h` so that it joins the other two corners of its triangles. `h` then goes from `y` to `x`.
    ///
    /// ```text
    ///        x                   x
    ///      /   \               / | \
    ///     a--h->b    gives    a  h  b
    ///      \   /               \ | /
    ///        y                   y
    /// ```
    ///
    /// # Errors
    /// With the reason why not; then nothing changes.
    pub fn flip(&mut self, h: HalfEdgeId) -> Result<(), FlipRefusal> {
        let t = self.twin(h);
        let (Some(left), Some(right)) = (self.face(h), self.face(t)) else {
            return Err(FlipRefusal::Boundary);
        };
        if self.sides(h) != 3 || self.sides(t) != 3 {
            return Err(FlipRefusal::NotTriangles);
        }
        let (bx, xa, ay, yb) = (self.next(h), self.prev(h), self.next(t), self.prev(t));
        let (a, b, x, y) = (self.origin(h), self.origin(t), self.origin(xa), self.origin(yb));
        if x == y || self.find(x, y).is_some() {
            return Err(FlipRefusal::JoinedAlready { ends: [x, y] });
        }
        for (v, gone, stays) in [(a, h, ay), (b, t, bx)] {
            if self.leaving[v.index()] == gone {
                self.leaving[v.index()] = stays;
            }
        }
        self.origin[h.index()] = y;
        self.origin[t.index()] = x;
        for (first, second, third, face) in [(h, xa, ay, left), (t, yb, bx, right)] {
            self.link(first, second);
            self.link(second, third);
            self.link(third, first);
            self.side[face.index()] = first;
            self.set_face(first, face);
        }
        Ok(())
    }

    /// Puts a new vertex on the edge of `h` and gives the half-edge from it to the old destination; `h` ends at it.
    /// The faces on both sides have a corner more; split them too where triangles are wanted.
    ///
    /// ```text
    ///     a------h------>b    gives    a--h-->m--g-->b
    /// ```
    pub fn split_edge(&mut self, h: HalfEdgeId) -> HalfEdgeId {
        let t = self.twin(h);
        let b = self.origin(t);
        let m = self.add_vertex();
        let (g, back) = self.add_edge(m, b);
        let (after, before) = (self.next(h), self.prev(t));
        self.link(h, g);
        self.link(g, after);
        self.link(before, back);
        self.link(back, t);
        self.face[g.index()] = self.face[h.index()];
        self.face[back.index()] = self.face[t.index()];
        self.origin[t.index()] = m;
        if self.leaving[b.index()] == t {
            self.leaving[b.index()] = back;
        }
        self.choose_leaving(g);
        g
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::mesh::half_edge::Claims;
    use crate::mesh::half_edge::samples::{OCTAHEDRON, TETRAHEDRON, cube, mesh_of, sheet};

    fn assert_sound(mesh: &HalfEdgeMesh) {
        let euler = mesh.counts().euler();
        let claims = Claims { euler: Some(euler), ..Claims::default() };
        assert_eq!(mesh.check(&claims, &Budget::unlimited()).unwrap(), []);
    }

    #[test]
    fn two_flips_turn_an_edge_around_and_four_are_none() {
        let before = mesh_of(&OCTAHEDRON);
        let mut flipped = 0;
        for h in before.half_edges() {
            let mut mesh = before.clone();
            let ends = (before.origin(h), before.destination(h));
            if mesh.flip(h).is_err() {
                continue;
            }
            flipped += 1;
            assert_sound(&mesh);
            assert_eq!(mesh.find(ends.0, ends.1), None);
            mesh.flip(h).unwrap();
            assert_eq!((mesh.destination(h), mesh.origin(h)), ends);
            mesh.flip(h).unwrap();
            mesh.flip(h).unwrap();
            assert_eq!((mesh.origin(h), mesh.destination(h)), ends);
            assert_sound(&mesh);
        }
        assert_eq!(flipped, 24, "every edge of an octahedron can be flipped");
    }

    #[test]
    fn each_refused_flip_is_named() {
        let refusal = |mesh: &HalfEdgeMesh, a: usize, b: usize| {
            mesh.clone().flip(mesh.find(VertexId::new(a), VertexId::new(b)).unwrap()).unwrap_err()
        };
        assert_eq!(refusal(&sheet(), 0, 1), FlipRefusal::Boundary);
        assert_eq!(refusal(&cube(), 0, 1), FlipRefusal::NotTriangles);
        let ends = [VertexId::new(3), VertexId::new(2)];
        assert_eq!(refusal(&mesh_of(&TETRAHEDRON), 0, 1), FlipRefusal::JoinedAlready { ends });
    }

    #[test]
    fn every_edge_can_be_split_also_at_a_boundary() {
        for before in [cube(), sheet(), mesh_of(&TETRAHEDRON)] {
            for h in before.half_edges() {
                let mut mesh = before.clone();
                let end = before.destination(h);
                let g = mesh.split_edge(h);
                assert_sound(&mesh);
                assert_eq!((mesh.destination(g), mesh.destination(h)), (end, mesh.origin(g)));
                assert_eq!(mesh.face(g), before.face(h));
                assert_eq!(mesh.counts().vertices, before.counts().vertices + 1);
            }
        }
    }
}
