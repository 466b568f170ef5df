//! Walks around a vertex and around a loop.

use super::{FaceId, HalfEdgeId, HalfEdgeMesh, VertexId};

impl HalfEdgeMesh {
    /// The half-edges of the loop of `h`, from `h` on.
    pub fn loop_of(&self, h: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> {
        self.cycle(h, Self::next)
    }

    /// The half-edges that leave the origin of `h`, counter-clockwise from `h` on. (Seen from outside, faces are on the
    /// left of their half-edges.)
    pub fn around(&self, h: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> {
        self.cycle(h, |mesh, h| mesh.twin(mesh.prev(h)))
    }

    /// The half-edges that leave `v`.
    pub fn star(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> {
        self.leaving(v).into_iter().flat_map(|h| self.around(h))
    }

    /// The vertices that share an edge with `v`.
    pub fn neighbours(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.star(v).map(|h| self.destination(h))
    }

    /// The vertices of face `f`, in order; none for a removed face.
    pub fn corners(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.side(f).into_iter().flat_map(|h| self.loop_of(h)).map(|h| self.origin(h))
    }

    /// The half-edge from `a` to `b`, if there is one.
    pub fn find(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        self.star(a).find(|&h| self.destination(h) == b)
    }

    /// Number of half-edges in the loop of `h`.
    pub fn sides(&self, h: HalfEdgeId) -> usize {
        self.loop_of(h).count()
    }

    /// `first` and what follows by `step`, until `first` comes again.
    fn cycle(
        &self,
        first: HalfEdgeId,
        step: impl Fn(&Self, HalfEdgeId) -> HalfEdgeId,
    ) -> impl Iterator<Item = HalfEdgeId> {
        std::iter::successors(Some(first), move |&h| Some(step(self, h)).filter(|&g| g != first))
    }
}
