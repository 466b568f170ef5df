//! A half-edge mesh of polygons, with the operators that edit it and the checker of its invariants. Topology only: no
//! coordinates here.
//!
//! Every edge has two half-edges, twins of one another, in opposite directions. A half-edge knows the `next` and the
//! `prev` one of its loop, its `twin`, the vertex it starts at (`origin`) and the `face` on its left. Boundaries are
//! explicit: along a boundary the half-edges on the empty side exist too, have no face, and form loops of their own, so
//! that every walk around a vertex or a face is a cycle. A vertex knows one half-edge that leaves it, at a boundary the
//! one without a face; a face knows one of its half-edges.
//!
//! Elements that an operator removes keep their numbers, which are not used again; [`HalfEdgeMesh::half_edges`] and its
//! like give those that are there. A vertex without an edge is not part of the mesh.

mod build;
mod check;
mod collapse;
mod edge;
mod face;
mod fault;
mod handles;
mod walk;

#[cfg(test)]
mod samples;

pub use build::BuildError;

pub use collapse::{CollapseRefusal, Collapsed, SplitAt, SplitRefusal};
pub use edge::FlipRefusal;
pub use face::{MergeRefusal, SplitFaceRefusal};
pub use fault::{Claims, FAULTS_MAX, Fault, FaultElement, ReferenceField};
pub use handles::{FaceId, HalfEdgeId, VertexId};

/// A manifold mesh of polygons, with or without boundary. See the module for the structure and
/// [`check`](HalfEdgeMesh::check) for its invariants.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HalfEdgeMesh {
    next: Vec<HalfEdgeId>,
    prev: Vec<HalfEdgeId>,
    twin: Vec<HalfEdgeId>,
    origin: Vec<VertexId>,
    /// None on the empty side of a boundary.
    face: Vec<FaceId>,
    /// A half-edge that leaves the vertex; none for a vertex without an edge.
    leaving: Vec<HalfEdgeId>,
    /// A half-edge of the face; none for a removed face.
    side: Vec<HalfEdgeId>,
}

/// Numbers of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshCounts {
    /// Vertices with an edge.
    pub vertices: usize,
    /// Edges (pairs of half-edges).
    pub edges: usize,
    /// Faces.
    pub faces: usize,
    /// Boundary loops.
    pub boundary_loops: usize,
}

impl MeshCounts {
    /// Vertices minus edges plus faces.
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }
}

impl HalfEdgeMesh {
    /// The half-edge after `h` in its loop.
    #[inline]
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.next[h.index()]
    }

    /// The half-edge before `h` in its loop.
    #[inline]
    pub fn prev(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.prev[h.index()]
    }

    /// The other half-edge of the edge of `h`.
    #[inline]
    pub fn twin(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.twin[h.index()]
    }

    /// The vertex where `h` starts.
    #[inline]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.origin[h.index()]
    }

    /// The vertex to which `h` goes.
    #[inline]
    pub fn destination(&self, h: HalfEdgeId) -> VertexId {
        self.origin(self.twin(h))
    }

    /// The face on the left of `h`; none on the empty side of a boundary.
    #[inline]
    pub fn face(&self, h: HalfEdgeId) -> Option<FaceId> {
        Some(self.face[h.index()]).filter(|&f| f != FaceId::NONE)
    }

    /// A half-edge that leaves `v`, at a boundary the one without a face; none when `v` has no edge.
    #[inline]
    pub fn leaving(&self, v: VertexId) -> Option<HalfEdgeId> {
        Some(self.leaving[v.index()]).filter(|&h| h != HalfEdgeId::NONE)
    }

    /// A half-edge of face `f`, unless the face was removed.
    #[inline]
    pub fn side(&self, f: FaceId) -> Option<HalfEdgeId> {
        Some(self.side[f.index()]).filter(|&h| h != HalfEdgeId::NONE)
    }

    /// True when `h` has no face on its left.
    #[inline]
    pub fn is_boundary(&self, h: HalfEdgeId) -> bool {
        self.face(h).is_none()
    }

    /// True when one side of the edge of `h` is empty.
    #[inline]
    pub fn is_boundary_edge(&self, h: HalfEdgeId) -> bool {
        self.is_boundary(h) || self.is_boundary(self.twin(h))
    }

    /// True when an edge of `v` is on a boundary.
    #[inline]
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.leaving(v).is_some_and(|h| self.is_boundary(h))
    }

    /// True when `h` is a half-edge of the mesh: in range and not removed.
    #[inline]
    pub fn contains(&self, h: HalfEdgeId) -> bool {
        self.next.get(h.index()).is_some_and(|&n| n != HalfEdgeId::NONE)
    }

    /// Vertex numbers are below this.
    pub fn vertex_bound(&self) -> usize {
        self.leaving.len()
    }

    /// Half-edge numbers are below this.
    pub fn half_edge_bound(&self) -> usize {
        self.next.len()
    }

    /// Face numbers are below this.
    pub fn face_bound(&self) -> usize {
        self.side.len()
    }

    /// The vertices with an edge, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..self.leaving.len()).map(VertexId::new).filter(|&v| self.leaving(v).is_some())
    }

    /// The half-edges, ascending.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> {
        (0..self.next.len()).map(HalfEdgeId::new).filter(|&h| self.contains(h))
    }

    /// The edges, each as the smaller of its half-edges, ascending.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdgeId> {
        self.half_edges().filter(|&h| h < self.twin(h))
    }

    /// The faces, ascending.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> {
        (0..self.side.len()).map(FaceId::new).filter(|&f| self.side(f).is_some())
    }

    /// How many elements there are. O(n).
    pub fn counts(&self) -> MeshCounts {
        MeshCounts {
            vertices: self.vertices().count(),
            edges: self.edges().count(),
            faces: self.faces().count(),
            boundary_loops: self.boundary_loops().len(),
        }
    }

    /// One half-edge of each boundary loop, the smallest, ascending. O(n).
    pub fn boundary_loops(&self) -> Vec<HalfEdgeId> {
        let mut is_walked = vec![false; self.half_edge_bound()];
        let mut first = Vec::new();
        for h in self.half_edges().filter(|&h| self.is_boundary(h)) {
            if !is_walked[h.index()] {
                first.push(h);
                self.loop_of(h).for_each(|g| is_walked[g.index()] = true);
            }
        }
        first
    }

    /// Makes `b` the one after `a`.
    fn link(&mut self, a: HalfEdgeId, b: HalfEdgeId) {
        self.next[a.index()] = b;
        self.prev[b.index()] = a;
    }

    /// Makes `a` and `b` twins.
    fn pair(&mut self, a: HalfEdgeId, b: HalfEdgeId) {
        self.twin[a.index()] = b;
        self.twin[b.index()] = a;
    }

    /// Two new half-edges, twins, from `a` to `b` and back, still without loop and face.
    fn add_edge(&mut self, a: VertexId, b: VertexId) -> (HalfEdgeId, HalfEdgeId) {
        let h = HalfEdgeId::new(self.next.len());
        let g = HalfEdgeId::new(h.index() + 1);
        self.next.extend([h, g]);
        self.prev.extend([h, g]);
        self.twin.extend([g, h]);
        self.origin.extend([a, b]);
        self.face.extend([FaceId::NONE; 2]);
        (h, g)
    }

    fn add_vertex(&mut self) -> VertexId {
        self.leaving.push(HalfEdgeId::NONE);
        VertexId::new(self.leaving.len() - 1)
    }

    /// Gives the loop of `h` a new face.
    fn add_face(&mut self, h: HalfEdgeId) -> FaceId {
        let f = FaceId::new(self.side.len());
        self.side.push(h);
        self.set_face(h, f);
        f
    }

    /// Gives the loop of `h` the face `f`.
    fn set_face(&mut self, h: HalfEdgeId, f: FaceId) {
        let mut g = h;
        loop {
            self.face[g.index()] = f;
            g = self.next(g);
            if g == h {
                break;
            }
        }
    }

    /// Removes a half-edge that nothing names any more.
    fn remove_half_edge(&mut self, h: HalfEdgeId) {
        self.next[h.index()] = HalfEdgeId::NONE;
        self.prev[h.index()] = HalfEdgeId::NONE;
        self.twin[h.index()] = HalfEdgeId::NONE;
        self.origin[h.index()] = VertexId::NONE;
        self.face[h.index()] = FaceId::NONE;
    }

    /// Makes `h`, or the half-edge without a face around its origin, the one its origin knows.
    fn choose_leaving(&mut self, h: HalfEdgeId) {
        let v = self.origin(h);
        let choice = self.around(h).find(|&g| self.is_boundary(g)).unwrap_or(h);
        self.leaving[v.index()] = choice;
    }
}
