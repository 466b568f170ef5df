//! The boundary of a solid as faces with holes: half-edges, and for each face one exterior and any number of interior
//! loops. Topology only: no coordinates here.
//!
//! A half-edge knows its `origin`, its `opposite`, the `next` one of its loop and the `face` on its left; a vertex
//! knows one half-edge that leaves it; a face knows one half-edge of each of its loops, the exterior one first. There is
//! no border: every edge has a face on either side. Faces keep their numbers whatever is edited.

mod build;
mod check;
mod edit;

pub use super::half_edge::{FaceId, HalfEdgeId, VertexId};
pub use build::BuildFault;
pub use check::{EulerCounts, TopologyFault};
pub use edit::{ContractRefusal, SplitVertexRefusal};

/// The loops of a face, each by one of its half-edges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaceLoops {
    /// The loop around the face, counter-clockwise seen from outside.
    pub exterior: HalfEdgeId,
    /// The loops around its holes, clockwise seen from outside.
    pub interior: Vec<HalfEdgeId>,
}

/// The topology of a closed polyhedron whose faces may have holes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Polyhedron {
    origin: Vec<VertexId>,
    opposite: Vec<HalfEdgeId>,
    next: Vec<HalfEdgeId>,
    face: Vec<FaceId>,
    leaving: Vec<HalfEdgeId>,
    loops: Vec<FaceLoops>,
}

impl Polyhedron {
    /// The vertex where `h` starts.
    #[inline]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.origin[h.index()]
    }

    /// The vertex to which `h` goes.
    #[inline]
    pub fn destination(&self, h: HalfEdgeId) -> VertexId {
        self.origin(self.opposite(h))
    }

    /// The same edge in the other direction.
    #[inline]
    pub fn opposite(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.opposite[h.index()]
    }

    /// The half-edge after `h` in its loop.
    #[inline]
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.next[h.index()]
    }

    /// The half-edge before `h` in its loop; a walk around the origin of `h`.
    pub fn previous(&self, h: HalfEdgeId) -> HalfEdgeId {
        let mut g = self.opposite(h);
        while self.next(g) != h {
            g = self.opposite(self.next(g));
        }
        g
    }

    /// The face on the left of `h`.
    #[inline]
    pub fn face(&self, h: HalfEdgeId) -> FaceId {
        self.face[h.index()]
    }

    /// A half-edge that leaves `v`, unless `v` was removed.
    #[inline]
    pub fn leaving(&self, v: VertexId) -> Option<HalfEdgeId> {
        Some(self.leaving[v.index()]).filter(|&h| h != HalfEdgeId::NONE)
    }

    /// The loops of face `f`.
    pub fn loops(&self, f: FaceId) -> &FaceLoops {
        &self.loops[f.index()]
    }

    /// One half-edge of each loop of `f`, the exterior one first.
    pub fn loop_starts(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> {
        let loops = self.loops(f);
        std::iter::once(loops.exterior).chain(loops.interior.iter().copied())
    }

    /// The half-edges of the loop of `h`, from `h` on.
    pub fn loop_of(&self, h: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> {
        std::iter::successors(Some(h), move |&g| Some(self.next(g)).filter(|&n| n != h))
    }

    /// All half-edges of `f`, loop after loop.
    pub fn sides(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> {
        self.loop_starts(f).flat_map(|h| self.loop_of(h))
    }

    /// The half-edges that leave the origin of `h`, clockwise seen from outside, from `h` on.
    pub fn around(&self, h: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> {
        std::iter::successors(Some(h), move |&g| Some(self.next(self.opposite(g))).filter(|&n| n != h))
    }

    /// The faces around `v`, clockwise seen from outside; empty for a removed vertex.
    pub fn faces_around(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        self.leaving(v).into_iter().flat_map(|h| self.around(h)).map(|h| self.face(h))
    }

    /// True when `h` is a half-edge that was not removed.
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

    /// Number of faces; none is ever removed.
    pub fn face_count(&self) -> usize {
        self.loops.len()
    }

    /// The vertices that were not removed, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..self.leaving.len()).map(VertexId::new).filter(|&v| self.leaving(v).is_some())
    }

    /// The edges, each as the smaller of its half-edges, ascending.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdgeId> {
        (0..self.next.len()).map(HalfEdgeId::new).filter(|&h| self.contains(h) && h < self.opposite(h))
    }

    /// The faces, ascending.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + use<> {
        (0..self.loops.len()).map(FaceId::new)
    }

    /// The edge that `f` and `g` share with `v` at an end, as the half-edge of `f`.
    pub fn edge_between_at(&self, f: FaceId, g: FaceId, v: VertexId) -> Option<HalfEdgeId> {
        let h = self.leaving(v)?;
        self.around(h)
            .flat_map(|h| [h, self.opposite(h)])
            .find(|&h| self.face(h) == f && self.face(self.opposite(h)) == g)
    }

    /// True when both have the same faces with the same neighbours in the same cyclic orders, whatever the numbers of
    /// their vertices and half-edges.
    pub fn has_topology_of(&self, other: &Self) -> bool {
        self.face_count() == other.face_count()
            && self.vertex_cycles() == other.vertex_cycles()
            && self.loop_cycles() == other.loop_cycles()
    }

    /// The cycle of faces around each vertex, each from its smallest on, sorted.
    pub fn vertex_cycles(&self) -> Vec<Vec<FaceId>> {
        let mut cycles: Vec<_> =
            self.vertices().map(|v| from_smallest(self.faces_around(v).collect())).collect();
        cycles.sort_unstable();
        cycles
    }

    /// For each face the cycles of neighbours along its loops, each from its smallest rotation on, interior ones sorted.
    fn loop_cycles(&self) -> Vec<Vec<Vec<FaceId>>> {
        let cycle = |h| from_smallest(self.loop_of(h).map(|h| self.face(self.opposite(h))).collect());
        let of = |f: FaceId| {
            let mut cycles: Vec<_> = self.loop_starts(f).map(cycle).collect();
            cycles[1..].sort_unstable();
            cycles
        };
        self.faces().map(of).collect()
    }
}

/// The rotation of a cycle that is the first of all in lexical order.
fn from_smallest<T: Ord + Clone>(cycle: Vec<T>) -> Vec<T> {
    let rotations = (0..cycle.len()).map(|k| [&cycle[k..], &cycle[..k]].concat());
    rotations.min().unwrap_or(cycle)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube: the faces are those of x = 0, x = 1, y = 0, y = 1, z = 0, z = 1; vertex `i` is at the bits of `i`.
    pub(super) fn cube() -> Polyhedron {
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let faces: Vec<Vec<Vec<u32>>> = faces.map(|f| vec![f.to_vec()]).to_vec();
        Polyhedron::from_loops(&faces, 8).unwrap()
    }

    #[test]
    fn a_cube_has_eight_corners_of_three_faces() {
        let cube = cube();
        assert_eq!(cube.check(), []);
        let counts = cube.counts();
        assert_eq!((counts.vertices, counts.edges, counts.faces, counts.interior_loops), (8, 12, 6, 0));
        assert_eq!((counts.shells, counts.genus()), (1, Some(0)));
        assert!(cube.vertices().all(|v| cube.faces_around(v).count() == 3));
        assert!(cube.edges().all(|h| cube.next(cube.previous(h)) == h));
    }

    #[test]
    fn an_edge_that_is_contracted_and_split_again_leaves_the_same_topology() {
        let cube = cube();
        for h in cube.edges() {
            let mut other = cube.clone();
            let [left, right] = [cube.face(h), cube.face(cube.opposite(h))];
            let v = other.contract(h).unwrap();
            assert_eq!(other.check(), []);
            assert_eq!(other.faces_around(v).count(), 4);
            assert!(!other.has_topology_of(&cube));
            let ends: Vec<FaceId> = other.faces_around(v).filter(|&f| f != left && f != right).collect();
            let mut flipped = other.clone();
            other.split_vertex(v, left, right).unwrap();
            assert_eq!(other.check(), []);
            assert!(other.has_topology_of(&cube));
            flipped.split_vertex(v, ends[0], ends[1]).unwrap();
            assert_eq!(flipped.check(), []);
            assert!(!flipped.has_topology_of(&cube));
        }
    }
}
