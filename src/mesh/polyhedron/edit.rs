//! Contracting an edge to a vertex, and splitting a vertex into an edge: each undoes the other.
//!
//! ```text
//!      A               A
//!    \ | /            \|/
//!     \a/              a
//!  L   |   R   <->  L / \ R
//!     /b\            /   \
//!      B               B
//! ```

use super::{FaceId, HalfEdgeId, Polyhedron, VertexId};

/// Why an edge cannot become a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContractRefusal {
    /// A face of the edge has three sides in the loop: it would lose its area.
    FaceVanishes(FaceId),
    /// A face is at both ends of the edge and not beside it: the link of the merged vertex would be no circle.
    FaceAtBothEnds(FaceId),
}

/// Why a vertex cannot be split between two faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SplitVertexRefusal {
    /// A face is not at the vertex.
    NotAround(FaceId),
    /// The faces are one, or neighbours there: one of the two vertices would have fewer than three faces.
    Neighbours,
}

impl Polyhedron {
    /// Whether the edge of `h` can become a vertex.
    ///
    /// # Errors
    /// When what is left would not be a manifold of faces with area.
    pub fn can_contract(&self, h: HalfEdgeId) -> Result<(), ContractRefusal> {
        let o = self.opposite(h);
        for g in [h, o] {
            if self.next(self.next(self.next(g))) == g {
                return Err(ContractRefusal::FaceVanishes(self.face(g)));
            }
        }
        let beside = [self.face(h), self.face(o)];
        let mut at_start: Vec<FaceId> =
            self.around(h).map(|g| self.face(g)).filter(|f| !beside.contains(f)).collect();
        at_start.sort_unstable();
        match self.around(o).map(|g| self.face(g)).find(|f| at_start.binary_search(f).is_ok()) {
            Some(face) => Err(ContractRefusal::FaceAtBothEnds(face)),
            None => Ok(()),
        }
    }

    /// Makes one vertex, the origin of `h`, of both ends of the edge, which is removed.
    ///
    /// # Errors
    /// As [`can_contract`](Self::can_contract); nothing is changed then.
    pub fn contract(&mut self, h: HalfEdgeId) -> Result<VertexId, ContractRefusal> {
        self.can_contract(h)?;
        let o = self.opposite(h);
        let (keep, gone) = (self.origin(h), self.origin(o));
        let moved: Vec<HalfEdgeId> = self.around(o).collect();
        let (before_h, before_o) = (self.previous(h), self.previous(o));
        let (after_h, after_o) = (self.next(h), self.next(o));
        for g in moved {
            self.origin[g.index()] = keep;
        }
        self.next[before_h.index()] = after_h;
        self.next[before_o.index()] = after_o;
        self.leaving[keep.index()] = after_h;
        self.leaving[gone.index()] = HalfEdgeId::NONE;
        for (removed, after) in [(h, after_h), (o, after_o)] {
            let loops = &mut self.loops[self.face[removed.index()].index()];
            let named = std::iter::once(&mut loops.exterior).chain(&mut loops.interior);
            named.filter(|first| **first == removed).for_each(|first| *first = after);
            self.next[removed.index()] = HalfEdgeId::NONE;
            self.opposite[removed.index()] = HalfEdgeId::NONE;
        }
        Ok(keep)
    }

    /// Splits `v` into an edge between the faces `left` and `right`. The new vertex takes the edges met between `left` and
    /// `right` when going clockwise around `v`; the returned half-edge goes from `v` to it.
    ///
    /// # Errors
    /// When the faces are not at `v`, or are neighbours there; nothing is changed then.
    pub fn split_vertex(
        &mut self,
        v: VertexId,
        left: FaceId,
        right: FaceId,
    ) -> Result<HalfEdgeId, SplitVertexRefusal> {
        let leaving: Vec<HalfEdgeId> = self.leaving(v).map(|h| self.around(h).collect()).unwrap_or_default();
        let place = |f: FaceId| {
            leaving.iter().position(|&h| self.face(h) == f).ok_or(SplitVertexRefusal::NotAround(f))
        };
        // Going clockwise, the corner of the face of leaving[i] lies between leaving[i - 1] and leaving[i].
        let (i, j) = (place(left)?, place(right)?);
        let degree = leaving.len();
        let taken = (j + degree - i) % degree;
        if taken < 2 || degree - taken < 2 {
            return Err(SplitVertexRefusal::Neighbours);
        }
        let to_new: Vec<HalfEdgeId> = (0..taken).map(|k| leaving[(i + k) % degree]).collect();
        let (first, last) = (leaving[i], leaving[j]);
        let (before_first, before_last) = (self.previous(first), self.previous(last));
        let w = VertexId::new(self.leaving.len());
        let h = HalfEdgeId::new(self.next.len());
        let o = HalfEdgeId::new(h.index() + 1);
        // In `left` the new half-edge runs v -> w, then `first` leaves w; in `right` it runs w -> v, then `last` leaves v.
        self.leaving.push(o);
        self.origin.extend([v, w]);
        self.opposite.extend([o, h]);
        self.face.extend([left, right]);
        self.next.extend([first, last]);
        self.next[before_first.index()] = h;
        self.next[before_last.index()] = o;
        for g in to_new {
            self.origin[g.index()] = w;
        }
        self.leaving[v.index()] = h;
        Ok(h)
    }
}
