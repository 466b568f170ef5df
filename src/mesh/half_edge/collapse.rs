//! Edge collapse under the full link condition, and vertex split, its inverse. For triangles around both ends.

use super::{HalfEdgeId, HalfEdgeMesh, VertexId};

/// Why an edge is not collapsed: what would not survive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CollapseRefusal {
    /// A face around an end of the edge is not a triangle; `half_edge` is one of its sides.
    #[error("a face around an end is not a triangle")]
    NotTriangles {
        /// A side of that face.
        half_edge: HalfEdgeId,
    },
    /// Both ends are on a boundary and the edge is not: two boundary loops would meet in a vertex, or one fall in two.
    #[error("an inner edge between two boundary vertices")]
    InnerEdgeBetweenBoundaries,
    /// The ends have a common neighbour that is not a corner of a face of the edge: two edges would become one that is
    /// not theirs to share.
    #[error("the ends share vertex {}, which is in no face of the edge", .vertex.index())]
    CommonNeighbour {
        /// The neighbour.
        vertex: VertexId,
    },
    /// A face of the edge has its two other sides on a boundary: what is left of it would be an edge without a face.
    #[error("an ear: the other sides of a face of the edge are on a boundary")]
    Ear,
    /// The two faces of the edge and two more are a tetrahedron: two faces would be left on the same three vertices.
    #[error("the edge of a tetrahedron")]
    Tetrahedron,
    /// The two faces of the edge have the same corners, so the mesh is no simplicial complex.
    #[error("the faces of the edge have the same corners")]
    DoubleFace,
}

/// Where the fan that a vertex split moves begins or ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SplitAt {
    /// At the edge of this half-edge, which leaves the vertex: a triangle opens there.
    Edge(HalfEdgeId),
    /// At the empty side of a boundary: no triangle opens.
    Boundary,
}

/// What [`HalfEdgeMesh::collapse`] did, enough to undo it with [`HalfEdgeMesh::split_vertex`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Collapsed {
    /// The vertex that is gone.
    pub removed: VertexId,
    /// The vertex that has its edges now.
    pub kept: VertexId,
    /// Where the fan of the removed vertex begins around the kept one, counter-clockwise.
    pub from: SplitAt,
    /// Where that fan ends.
    pub to: SplitAt,
}

/// Why a vertex is not split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SplitRefusal {
    /// An edge to open does not leave the vertex.
    #[error("half-edge {} does not leave the vertex", .half_edge.index())]
    NotLeaving {
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// It begins and ends at the same edge, or on the same side of the boundary.
    #[error("the fan begins where it ends")]
    SameEdge,
    /// The fan is to begin or end at a boundary, and the vertex has none.
    #[error("the vertex is not on a boundary")]
    NotOnBoundary,
}

impl HalfEdgeMesh {
    /// Whether the edge of `h` may be collapsed: all faces around its ends are triangles, and the link condition of
    /// Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving edge contraction" (1998), holds, with every boundary
    /// closed by a cone: `lk(a) ∩ lk(b) = lk(ab)`, for link vertices and link edges alike. Then the collapse keeps the
    /// surface, up to homeomorphism; otherwise it would change it or leave no simplicial complex. O(valence).
    ///
    /// # Errors
    /// With the reason why not.
    pub fn can_collapse(&self, h: HalfEdgeId) -> Result<(), CollapseRefusal> {
        let t = self.twin(h);
        self.require_triangles_around(h)?;
        self.require_triangles_around(t)?;
        let (a, b) = (self.origin(h), self.origin(t));
        // The cone's apex is a common neighbour that only the link of a boundary edge has.
        if !self.is_boundary_edge(h) && self.is_boundary_vertex(a) && self.is_boundary_vertex(b) {
            return Err(CollapseRefusal::InnerEdgeBetweenBoundaries);
        }
        let apexes = [h, t].map(|g| self.face(g).map(|_| self.origin(self.prev(g))));
        if apexes[0] == apexes[1] {
            return Err(CollapseRefusal::DoubleFace);
        }
        for vertex in self.neighbours(a) {
            if !apexes.contains(&Some(vertex)) && self.find(b, vertex).is_some() {
                return Err(CollapseRefusal::CommonNeighbour { vertex });
            }
        }
        self.require_no_common_link_edge(h, apexes)
    }

    /// A link edge of both ends: between an apex and the cone, or between the two apexes.
    fn require_no_common_link_edge(
        &self,
        h: HalfEdgeId,
        apexes: [Option<VertexId>; 2],
    ) -> Result<(), CollapseRefusal> {
        let is_ear = |g: HalfEdgeId| {
            !self.is_boundary(g) && self.is_boundary_edge(self.next(g)) && self.is_boundary_edge(self.prev(g))
        };
        if is_ear(h) || is_ear(self.twin(h)) {
            return Err(CollapseRefusal::Ear);
        }
        let [Some(x), Some(y)] = apexes else { return Ok(()) };
        let has_face = |v: VertexId| {
            self.star(v).any(|g| {
                !self.is_boundary(g) && {
                    let others = [self.destination(g), self.origin(self.prev(g))];
                    others == [x, y] || others == [y, x]
                }
            })
        };
        if has_face(self.origin(h)) && has_face(self.destination(h)) {
            return Err(CollapseRefusal::Tetrahedron);
        }
        Ok(())
    }

    fn require_triangles_around(&self, h: HalfEdgeId) -> Result<(), CollapseRefusal> {
        let is_odd = |&g: &HalfEdgeId| !self.is_boundary(g) && self.next(self.next(g)) != self.prev(g);
        match self.around(h).find(is_odd) {
            None => Ok(()),
            Some(half_edge) => Err(CollapseRefusal::NotTriangles { half_edge }),
        }
    }

    /// Moves the origin `a` of `h` onto its destination `b`.
    ///
    /// ```text
    ///         x                      x
    ///      \ / \ /                \  |  /
    ///     --a-h-b--     gives     ---b---
    ///      / \ / \                /  |  \
    ///         y                      y
    /// ```
    /// The vertex `a`, the edge and its faces are removed, and of the edges `ax` and `bx`, `ay` and `by` one remains
    /// each. At a boundary edge one side of the picture is empty.
    ///
    /// # Errors
    /// When [`can_collapse`](Self::can_collapse) says no; then nothing changes.
    pub fn collapse(&mut self, h: HalfEdgeId) -> Result<Collapsed, CollapseRefusal> {
        self.can_collapse(h)?;
        let t = self.twin(h);
        let (removed, kept) = (self.origin(h), self.origin(t));
        let star: Vec<HalfEdgeId> = self.around(h).collect();
        for g in star {
            self.origin[g.index()] = kept;
        }
        let from = self.close_side(h);
        let to = self.close_side(t);
        self.remove_half_edge(h);
        self.remove_half_edge(t);
        self.leaving[removed.index()] = HalfEdgeId::NONE;
        for at in [from, to] {
            if let SplitAt::Edge(left) = at {
                self.choose_leaving(left);
            }
        }
        Ok(Collapsed { removed, kept, from, to })
    }

    /// Removes the triangle on the left of `g` and joins what is behind its other two sides; at a boundary, takes `g`
    /// out of its loop. Gives the half-edge from the collapsed edge's place to the apex.
    fn close_side(&mut self, g: HalfEdgeId) -> SplitAt {
        let (next, prev) = (self.next(g), self.prev(g));
        let Some(face) = self.face(g) else {
            self.link(prev, next);
            return SplitAt::Boundary;
        };
        let (to_apex, from_apex) = (self.twin(prev), self.twin(next));
        let apex = self.origin(prev);
        if self.leaving[apex.index()] == prev {
            self.leaving[apex.index()] = from_apex;
        }
        self.pair(to_apex, from_apex);
        self.remove_half_edge(next);
        self.remove_half_edge(prev);
        self.side[face.index()] = HalfEdgeId::NONE;
        SplitAt::Edge(to_apex)
    }

    /// Splits `v`: a new vertex `a` takes the half-edges of `v` counter-clockwise from `from` on and before `to` (with
    /// the empty side of a boundary, if that lies between two edges), and is joined to `v` by an edge, with a triangle where an edge opens. Gives the half-edge from `a` to `v`. What
    /// [`collapse`](Self::collapse) did is undone with its `kept`, `from` and `to`.
    ///
    /// ```text
    ///       from                     x
    ///      \ | /                  \ / \ /
    ///     ---v---     gives      --a-h-v--
    ///      / | \                  / \ / \
    ///        to                      y
    /// ```
    ///
    /// # Errors
    /// With the reason when that is no fan; then nothing changes.
    pub fn split_vertex(
        &mut self,
        v: VertexId,
        from: SplitAt,
        to: SplitAt,
    ) -> Result<HalfEdgeId, SplitRefusal> {
        let fan = self.fan_between(v, from, to)?;
        let gap = self.leaving(v).filter(|&g| self.is_boundary(g)).map(|g| (self.prev(g), g));
        let a = self.add_vertex();
        for g in fan {
            self.origin[g.index()] = a;
        }
        let (h, t) = self.add_edge(a, v);
        for (side, at) in [(h, from), (t, to)] {
            match (at, gap) {
                (SplitAt::Edge(e), _) => self.open_side(side, e),
                (SplitAt::Boundary, Some((before, after))) => {
                    self.link(before, side);
                    self.link(side, after);
                }
                (SplitAt::Boundary, None) => {}
            }
        }
        self.choose_leaving(h);
        self.choose_leaving(t);
        Ok(h)
    }

    /// Puts a triangle between `g` and the two sides that the edge of `e` becomes.
    fn open_side(&mut self, g: HalfEdgeId, e: HalfEdgeId) {
        let behind = self.twin(e);
        let apex = self.origin(behind);
        let (to_apex, from_apex) = self.add_edge(self.destination(g), apex);
        self.pair(to_apex, behind);
        self.pair(from_apex, e);
        self.link(g, to_apex);
        self.link(to_apex, from_apex);
        self.link(from_apex, g);
        self.add_face(g);
    }

    /// The half-edges of `v` counter-clockwise from `from` on and before `to`.
    fn fan_between(&self, v: VertexId, from: SplitAt, to: SplitAt) -> Result<Vec<HalfEdgeId>, SplitRefusal> {
        for at in [from, to] {
            match at {
                SplitAt::Edge(half_edge) if !self.contains(half_edge) || self.origin(half_edge) != v => {
                    return Err(SplitRefusal::NotLeaving { half_edge });
                }
                SplitAt::Boundary if !self.is_boundary_vertex(v) => return Err(SplitRefusal::NotOnBoundary),
                _ => {}
            }
        }
        if from == to {
            return Err(SplitRefusal::SameEdge);
        }
        let start = match (from, self.leaving(v)) {
            (SplitAt::Edge(e), _) => e,
            (SplitAt::Boundary, Some(gap)) => self.twin(self.prev(gap)),
            (SplitAt::Boundary, None) => return Err(SplitRefusal::NotOnBoundary),
        };
        let mut fan = Vec::new();
        for g in self.around(start) {
            if to == SplitAt::Edge(g) {
                break;
            }
            fan.push(g);
            // Counter-clockwise of a half-edge without a face comes the empty side.
            if to == SplitAt::Boundary && self.is_boundary(g) {
                break;
            }
        }
        Ok(fan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::mesh::half_edge::samples::{OCTAHEDRON, TETRAHEDRON, cube, mesh_of, sheet};
    use crate::mesh::half_edge::{Claims, FaceId};

    fn edge(mesh: &HalfEdgeMesh, a: usize, b: usize) -> HalfEdgeId {
        mesh.find(VertexId::new(a), VertexId::new(b)).unwrap()
    }

    fn assert_sound(mesh: &HalfEdgeMesh, euler: i64) {
        let claims = Claims { is_triangular: true, euler: Some(euler), ..Claims::default() };
        assert_eq!(mesh.check(&claims, &Budget::unlimited()).unwrap(), []);
    }

    /// The faces as sorted corner lists that begin with their smallest corner.
    fn listed(mesh: &HalfEdgeMesh, rename: impl Fn(usize) -> usize) -> Vec<Vec<usize>> {
        let corners = |f: FaceId| {
            let mut c: Vec<usize> = mesh.corners(f).map(|v| rename(v.index())).collect();
            let smallest = (0..c.len()).min_by_key(|&i| c[i]).unwrap();
            c.rotate_left(smallest);
            c
        };
        let mut faces: Vec<Vec<usize>> = mesh.faces().map(corners).collect();
        faces.sort();
        faces
    }

    #[test]
    fn every_collapse_that_is_allowed_is_undone_by_its_split() {
        for before in [mesh_of(&OCTAHEDRON), sheet()] {
            let euler = before.counts().euler();
            let mut allowed = 0;
            for h in before.half_edges() {
                let mut mesh = before.clone();
                let Ok(done) = mesh.collapse(h) else { continue };
                allowed += 1;
                assert_sound(&mesh, euler);
                let back = mesh.split_vertex(done.kept, done.from, done.to).unwrap();
                assert_sound(&mesh, euler);
                let new = mesh.origin(back).index();
                let again = listed(&mesh, |v| if v == new { done.removed.index() } else { v });
                assert_eq!(again, listed(&before, |v| v), "{h:?}");
            }
            assert!(allowed >= 12, "{allowed}");
        }
    }

    #[test]
    fn each_refusal_is_named() {
        let refusal = |mesh: &HalfEdgeMesh, a, b| mesh.clone().collapse(edge(mesh, a, b)).unwrap_err();
        assert_eq!(refusal(&mesh_of(&TETRAHEDRON), 0, 1), CollapseRefusal::Tetrahedron);
        assert!(matches!(refusal(&cube(), 0, 1), CollapseRefusal::NotTriangles { .. }));
        assert_eq!(refusal(&sheet(), 1, 5), CollapseRefusal::InnerEdgeBetweenBoundaries);
        assert_eq!(refusal(&mesh_of(&[[0, 1, 2]]), 0, 1), CollapseRefusal::Ear);
        assert_eq!(refusal(&mesh_of(&[[0, 1, 2], [0, 2, 1]]), 0, 1), CollapseRefusal::DoubleFace);
        // Two tetrahedra glued along a face and that face taken out: its three edges still share neighbours.
        let waist = mesh_of(&[[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4]]);
        let vertex = VertexId::new(2);
        assert_eq!(refusal(&waist, 0, 1), CollapseRefusal::CommonNeighbour { vertex });
    }

    #[test]
    fn a_split_that_is_no_fan_is_refused_and_changes_nothing() {
        let mut sheet = sheet();
        let before = sheet.clone();
        let v = VertexId::new(1);
        let to_right = edge(&sheet, 1, 2);
        let mut split = |v, from, to| sheet.split_vertex(v, from, to).unwrap_err();
        let inner = VertexId::new(4);
        let other = edge(&before, 0, 1);
        assert_eq!(
            split(v, SplitAt::Edge(other), SplitAt::Boundary),
            SplitRefusal::NotLeaving { half_edge: other }
        );
        assert_eq!(split(v, SplitAt::Edge(to_right), SplitAt::Edge(to_right)), SplitRefusal::SameEdge);
        assert_eq!(split(v, SplitAt::Boundary, SplitAt::Boundary), SplitRefusal::SameEdge);
        let from_inner = SplitAt::Edge(edge(&before, 4, 5));
        assert_eq!(split(inner, from_inner, SplitAt::Boundary), SplitRefusal::NotOnBoundary);
        assert_eq!(sheet, before);
    }

    #[test]
    fn an_inner_vertex_is_split_along_two_of_its_edges() {
        let mut mesh = mesh_of(&OCTAHEDRON);
        let (from, to) = (SplitAt::Edge(edge(&mesh, 0, 1)), SplitAt::Edge(edge(&mesh, 0, 3)));
        let h = mesh.split_vertex(VertexId::new(0), from, to).unwrap();
        assert_eq!(mesh.destination(h), VertexId::new(0));
        assert_sound(&mesh, 2);
        assert_eq!((mesh.counts().vertices, mesh.counts().faces), (7, 10));
        assert_eq!(mesh.neighbours(mesh.origin(h)).count(), 4);
    }
}
