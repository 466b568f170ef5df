//! The invariants of the topology, each a named fault, and the counts of Euler's formula.

use super::{FaceId, HalfEdgeId, Polyhedron, VertexId};
use crate::mesh::UnionFind;

/// A broken invariant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TopologyFault {
    /// A half-edge is not the opposite of its opposite, or is its own.
    Opposite(HalfEdgeId),
    /// A half-edge does not start where its predecessor ends.
    Origin(HalfEdgeId),
    /// A loop does not close, or runs along several faces, or is in no list of loops.
    Loop(HalfEdgeId),
    /// A loop has fewer than three sides.
    ShortLoop(FaceId),
    /// A face passes a vertex more than once.
    RepeatedVertex(FaceId, VertexId),
    /// The half-edge of a vertex does not start there, or not all that do are around it.
    Fan(VertexId),
    /// A vertex has fewer than three faces.
    FewFaces(VertexId),
}

/// Numbers of elements, as Euler's formula has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EulerCounts {
    /// Vertices, V.
    pub vertices: usize,
    /// Edges, E.
    pub edges: usize,
    /// Faces, F.
    pub faces: usize,
    /// Interior loops, R.
    pub interior_loops: usize,
    /// Shells, S.
    pub shells: usize,
}

impl EulerCounts {
    /// H of V - E + F - R = 2 (S - H), the number of through-holes; none when no whole number not below 0 solves it.
    pub fn genus(&self) -> Option<usize> {
        let left = self.vertices as i64 - self.edges as i64 + self.faces as i64 - self.interior_loops as i64;
        let doubled = 2 * self.shells as i64 - left;
        (doubled >= 0 && doubled % 2 == 0).then_some(doubled as usize / 2)
    }
}

impl Polyhedron {
    /// The shell of each face, numbered by their first faces.
    pub fn shell_of_faces(&self) -> (Vec<u32>, usize) {
        let mut joined = UnionFind::new(self.face_count());
        for h in self.edges() {
            joined.unite(self.face(h).index() as u32, self.face(self.opposite(h)).index() as u32);
        }
        let (mut shell_of_root, mut count) = (vec![u32::MAX; self.face_count()], 0);
        let of = |f: usize| {
            let shell = &mut shell_of_root[joined.find(f as u32) as usize];
            if *shell == u32::MAX {
                *shell = count;
                count += 1;
            }
            *shell
        };
        let shells = (0..self.face_count()).map(of).collect();
        (shells, count as usize)
    }

    /// How many elements there are. O(n).
    pub fn counts(&self) -> EulerCounts {
        EulerCounts {
            vertices: self.vertices().count(),
            edges: self.edges().count(),
            faces: self.face_count(),
            interior_loops: self.loops.iter().map(|l| l.interior.len()).sum(),
            shells: self.shell_of_faces().1,
        }
    }

    /// All broken invariants; none for what the constructor and the operators make. O(n).
    pub fn check(&self) -> Vec<TopologyFault> {
        let mut faults = Vec::new();
        let ids = || (0..self.next.len()).map(HalfEdgeId::new).filter(|&h| self.contains(h));
        for h in ids() {
            let o = self.opposite(h);
            if o == h || !self.contains(o) || self.opposite(o) != h || !self.contains(self.next(h)) {
                faults.push(TopologyFault::Opposite(h));
            } else if self.origin(self.next(h)) != self.destination(h) {
                faults.push(TopologyFault::Origin(h));
            }
        }
        // Walks are only safe on sound pointers.
        if faults.is_empty() {
            self.check_loops(&mut faults);
            self.check_fans(&mut faults);
        }
        faults
    }

    fn check_loops(&self, faults: &mut Vec<TopologyFault>) {
        let mut is_walked = vec![false; self.next.len()];
        let mut last_face = vec![u32::MAX; self.leaving.len()];
        for f in self.faces() {
            for start in self.loop_starts(f) {
                let mut sides = 0usize;
                let mut h = start;
                loop {
                    if !self.contains(h)
                        || self.face(h) != f
                        || std::mem::replace(&mut is_walked[h.index()], true)
                    {
                        faults.push(TopologyFault::Loop(h));
                        break;
                    }
                    let v = self.origin(h);
                    if std::mem::replace(&mut last_face[v.index()], f.index() as u32) == f.index() as u32 {
                        faults.push(TopologyFault::RepeatedVertex(f, v));
                    }
                    sides += 1;
                    h = self.next(h);
                    if h == start {
                        break;
                    }
                }
                if sides < 3 {
                    faults.push(TopologyFault::ShortLoop(f));
                }
            }
        }
        let stray =
            (0..self.next.len()).map(HalfEdgeId::new).filter(|&h| self.contains(h) && !is_walked[h.index()]);
        faults.extend(stray.map(TopologyFault::Loop));
    }

    fn check_fans(&self, faults: &mut Vec<TopologyFault>) {
        let mut is_around = vec![false; self.next.len()];
        for v in self.vertices() {
            let mut degree = 0;
            let mut h = self.leaving[v.index()];
            let first = h;
            loop {
                if !self.contains(h)
                    || self.origin(h) != v
                    || std::mem::replace(&mut is_around[h.index()], true)
                {
                    faults.push(TopologyFault::Fan(v));
                    break;
                }
                degree += 1;
                h = self.next(self.opposite(h));
                if h == first {
                    break;
                }
            }
            if degree < 3 {
                faults.push(TopologyFault::FewFaces(v));
            }
        }
        let missed =
            (0..self.next.len()).map(HalfEdgeId::new).filter(|&h| self.contains(h) && !is_around[h.index()]);
        faults.extend(missed.map(|h| TopologyFault::Fan(self.origin(h))));
    }
}
