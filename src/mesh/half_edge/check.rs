//! The invariants of a half-edge mesh, as a function that names every breach.

use super::fault::{Claims, FAULTS_MAX, Fault, FaultElement, ReferenceField};
use super::{FaceId, HalfEdgeId, HalfEdgeMesh, VertexId};
use crate::budget::{Budget, CHECK_EVERY, Stopped};

impl HalfEdgeMesh {
    /// Broken invariants, at most [`FAULTS_MAX`]; empty when all hold. References out of range hide what would follow
    /// them, and broken loops hide what is found by walking. O(n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn check(&self, claims: &Claims, budget: &Budget) -> Result<Vec<Fault>, Stopped> {
        let mut faults = Faults { list: Vec::new(), budget };
        self.check_ranges(&mut faults)?;
        if faults.list.is_empty() {
            self.check_half_edges(&mut faults)?;
        }
        if faults.list.is_empty() {
            self.check_faces(claims, &mut faults)?;
            self.check_vertices(&mut faults)?;
        }
        if faults.list.is_empty() {
            self.check_claims(claims, &mut faults)?;
        }
        Ok(faults.list)
    }

    fn check_ranges(&self, faults: &mut Faults<'_>) -> Result<(), Stopped> {
        for h in self.half_edges() {
            faults.tick(h.index())?;
            let of = FaultElement::HalfEdge(h);
            for (field, other) in [
                (ReferenceField::Next, self.next(h)),
                (ReferenceField::Prev, self.prev(h)),
                (ReferenceField::Twin, self.twin(h)),
            ] {
                faults.require(self.contains(other), || Fault::OutOfRange { of, field });
            }
            let is_there = self.origin(h).index() < self.vertex_bound();
            faults.require(is_there, || Fault::OutOfRange { of, field: ReferenceField::Origin });
            let is_there =
                self.face(h).is_none_or(|f| f.index() < self.face_bound() && self.side(f).is_some());
            faults.require(is_there, || Fault::OutOfRange { of, field: ReferenceField::Face });
        }
        for (v, &h) in self.leaving.iter().enumerate() {
            faults.tick(v)?;
            let of = FaultElement::Vertex(VertexId::new(v));
            let is_there = h == HalfEdgeId::NONE || self.contains(h);
            faults.require(is_there, || Fault::OutOfRange { of, field: ReferenceField::Leaving });
        }
        for (f, &h) in self.side.iter().enumerate() {
            faults.tick(f)?;
            let of = FaultElement::Face(FaceId::new(f));
            let is_there = h == HalfEdgeId::NONE || self.contains(h);
            faults.require(is_there, || Fault::OutOfRange { of, field: ReferenceField::Side });
        }
        Ok(())
    }

    fn check_half_edges(&self, faults: &mut Faults<'_>) -> Result<(), Stopped> {
        for h in self.half_edges() {
            faults.tick(h.index())?;
            let (next, prev, twin) = (self.next(h), self.prev(h), self.twin(h));
            let half_edge = h;
            faults.require(twin != h, || Fault::TwinOfItself { half_edge });
            faults.require(self.twin(twin) == h, || Fault::TwinNotMutual { half_edge, twin });
            faults.require(self.prev(next) == h, || Fault::NextNotInverse { half_edge, next });
            faults.require(self.next(prev) == h, || Fault::PrevNotInverse { half_edge, prev });
            faults.require(self.face(next) == self.face(h), || Fault::LoopFaceDiffers { half_edge, next });
            let (start, end) = (self.origin(h), self.destination(h));
            faults.require(end == self.origin(next), || Fault::OriginNotDestination { half_edge, next });
            faults.require(start != end, || Fault::EdgeWithOneEnd { half_edge, vertex: start });
            let has_face = !self.is_boundary(h) || !self.is_boundary(twin) || twin < h;
            faults.require(has_face, || Fault::EdgeWithoutFace { half_edge });
        }
        Ok(())
    }

    /// Loops close, because next and prev are inverse here.
    fn check_faces(&self, claims: &Claims, faults: &mut Faults<'_>) -> Result<(), Stopped> {
        let mut is_on_loop = vec![false; self.half_edge_bound()];
        let mut last_face = vec![FaceId::NONE; self.vertex_bound()];
        for face in self.faces() {
            faults.tick(face.index())?;
            let Some(side) = self.side(face) else { continue };
            faults
                .require(self.face(side) == Some(face), || Fault::SideOfOtherFace { face, half_edge: side });
            let mut sides = 0;
            for h in self.loop_of(side) {
                is_on_loop[h.index()] = true;
                sides += 1;
                let vertex = self.origin(h);
                let is_first = std::mem::replace(&mut last_face[vertex.index()], face) != face;
                faults.require(is_first, || Fault::RepeatedVertex { face, vertex });
            }
            let is_wrong = sides < 3 || (claims.is_triangular && sides > 3);
            faults.require(!is_wrong, || Fault::WrongSides { face, sides });
        }
        for half_edge in self.half_edges() {
            faults.tick(half_edge.index())?;
            if let Some(face) = self.face(half_edge) {
                faults.require(is_on_loop[half_edge.index()], || Fault::SecondLoop { face, half_edge });
            }
        }
        Ok(())
    }

    fn check_vertices(&self, faults: &mut Faults<'_>) -> Result<(), Stopped> {
        let mut is_reached = vec![false; self.half_edge_bound()];
        // The half-edge by which a vertex was last reached.
        let mut by = vec![HalfEdgeId::NONE; self.vertex_bound()];
        for vertex in self.vertices() {
            faults.tick(vertex.index())?;
            let Some(first) = self.leaving(vertex) else { continue };
            if self.origin(first) != vertex {
                faults.require(false, || Fault::LeavingStartsElsewhere { vertex, half_edge: first });
                continue;
            }
            for h in self.around(first) {
                is_reached[h.index()] = true;
                let known = h == first || !self.is_boundary(h);
                faults.require(known, || Fault::LeavingNotBoundary { vertex, boundary: h });
                let other = std::mem::replace(&mut by[self.destination(h).index()], h);
                let is_new = other == HalfEdgeId::NONE || self.origin(other) != vertex;
                faults.require(is_new, || Fault::EdgeTwice { half_edges: [other, h] });
            }
        }
        for half_edge in self.half_edges() {
            faults.tick(half_edge.index())?;
            let vertex = self.origin(half_edge);
            if self.leaving(vertex).is_none() {
                faults.require(false, || Fault::NoLeaving { vertex, half_edge });
            } else if !is_reached[half_edge.index()] {
                faults.require(false, || Fault::SecondFan { vertex, half_edge });
            }
        }
        Ok(())
    }

    fn check_claims(&self, claims: &Claims, faults: &mut Faults<'_>) -> Result<(), Stopped> {
        for half_edge in self.half_edges().filter(|_| claims.is_closed) {
            faults.tick(half_edge.index())?;
            faults.require(!self.is_boundary(half_edge), || Fault::BoundaryOfClosed { half_edge });
        }
        if let Some(claimed) = claims.euler {
            let is = self.counts().euler();
            faults.require(is == claimed, || Fault::Euler { is, claimed });
        }
        Ok(())
    }
}

/// The list of faults, with its limit and the budget.
struct Faults<'a> {
    list: Vec<Fault>,
    budget: &'a Budget,
}

impl Faults<'_> {
    fn tick(&self, index: usize) -> Result<(), Stopped> {
        if index.is_multiple_of(CHECK_EVERY) { self.budget.check() } else { Ok(()) }
    }

    fn require(&mut self, holds: bool, fault: impl FnOnce() -> Fault) {
        if !holds && self.list.len() < FAULTS_MAX {
            self.list.push(fault());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::half_edge::samples::{TETRAHEDRON, cube, mesh_of, sheet};

    fn h(i: usize) -> HalfEdgeId {
        HalfEdgeId::new(i)
    }

    fn v(i: usize) -> VertexId {
        VertexId::new(i)
    }

    fn f(i: usize) -> FaceId {
        FaceId::new(i)
    }

    /// The faults of `mesh` once `plant` has broken it.
    fn planted(mut mesh: HalfEdgeMesh, plant: impl FnOnce(&mut HalfEdgeMesh)) -> Vec<Fault> {
        assert_eq!(mesh.check(&Claims::default(), &Budget::unlimited()).unwrap(), []);
        plant(&mut mesh);
        mesh.check(&Claims::default(), &Budget::unlimited()).unwrap()
    }

    fn tetrahedron() -> HalfEdgeMesh {
        mesh_of(&TETRAHEDRON)
    }

    #[test]
    fn references_out_of_range_or_to_removed_elements() {
        let of_half_edge = |field| vec![Fault::OutOfRange { of: FaultElement::HalfEdge(h(5)), field }];
        assert_eq!(planted(tetrahedron(), |m| m.next[5] = h(99)), of_half_edge(ReferenceField::Next));
        assert_eq!(
            planted(tetrahedron(), |m| m.prev[5] = HalfEdgeId::NONE),
            of_half_edge(ReferenceField::Prev)
        );
        assert_eq!(planted(tetrahedron(), |m| m.twin[5] = h(12)), of_half_edge(ReferenceField::Twin));
        assert_eq!(planted(tetrahedron(), |m| m.origin[5] = v(4)), of_half_edge(ReferenceField::Origin));
        assert_eq!(planted(tetrahedron(), |m| m.face[5] = f(4)), of_half_edge(ReferenceField::Face));
        let of = FaultElement::Vertex(v(2));
        assert_eq!(
            planted(tetrahedron(), |m| m.leaving[2] = h(12)),
            [Fault::OutOfRange { of, field: ReferenceField::Leaving }]
        );
        let of = FaultElement::Face(f(3));
        assert_eq!(
            planted(tetrahedron(), |m| m.side[3] = h(12)),
            [Fault::OutOfRange { of, field: ReferenceField::Side }]
        );
        let removed = planted(tetrahedron(), |m| m.remove_half_edge(h(5)));
        assert!(
            removed.contains(&Fault::OutOfRange {
                of: FaultElement::HalfEdge(h(4)),
                field: ReferenceField::Next
            })
        );
        let gone = planted(tetrahedron(), |m| m.side[1] = HalfEdgeId::NONE);
        assert!(
            gone.contains(&Fault::OutOfRange {
                of: FaultElement::HalfEdge(h(3)),
                field: ReferenceField::Face
            })
        );
    }

    #[test]
    fn twins_that_are_not() {
        let own = planted(tetrahedron(), |m| m.twin[4] = h(4));
        assert!(own.contains(&Fault::TwinOfItself { half_edge: h(4) }));
        let (mesh, other) = (tetrahedron(), tetrahedron().twin(h(7)));
        let one_way = planted(mesh, |m| m.twin[4] = other);
        assert!(one_way.contains(&Fault::TwinNotMutual { half_edge: h(4), twin: other }), "{one_way:?}");
    }

    #[test]
    fn next_and_prev_that_do_not_fit() {
        let next = planted(tetrahedron(), |m| m.next[0] = h(2));
        assert!(next.contains(&Fault::NextNotInverse { half_edge: h(0), next: h(2) }), "{next:?}");
        let prev = planted(tetrahedron(), |m| m.prev[0] = h(1));
        assert!(prev.contains(&Fault::PrevNotInverse { half_edge: h(0), prev: h(1) }), "{prev:?}");
    }

    #[test]
    fn loops_with_several_faces_and_faces_with_several_loops() {
        let mixed = planted(tetrahedron(), |m| m.face[1] = f(2));
        assert!(mixed.contains(&Fault::LoopFaceDiffers { half_edge: h(0), next: h(1) }), "{mixed:?}");
        let other = planted(tetrahedron(), |m| m.side[1] = h(0));
        assert!(other.contains(&Fault::SideOfOtherFace { face: f(1), half_edge: h(0) }), "{other:?}");
        let two = planted(tetrahedron(), |m| {
            m.set_face(h(3), f(0));
            m.side[1] = HalfEdgeId::NONE;
        });
        assert_eq!(two, [3, 4, 5].map(|i| Fault::SecondLoop { face: f(0), half_edge: h(i) }));
    }

    #[test]
    fn ends_that_do_not_meet_and_edges_with_one_end() {
        let apart = planted(tetrahedron(), |m| m.origin[1] = v(3));
        assert!(apart.contains(&Fault::OriginNotDestination { half_edge: h(0), next: h(1) }), "{apart:?}");
        let point = planted(tetrahedron(), |m| {
            let twin = m.twin(h(0));
            m.origin[twin.index()] = v(0);
        });
        assert!(point.contains(&Fault::EdgeWithOneEnd { half_edge: h(0), vertex: v(0) }), "{point:?}");
    }

    #[test]
    fn vertices_that_know_the_wrong_half_edge_or_none() {
        let start = tetrahedron().leaving(v(0)).unwrap();
        let elsewhere = planted(tetrahedron(), |m| m.leaving[1] = start);
        assert!(elsewhere.contains(&Fault::LeavingStartsElsewhere { vertex: v(1), half_edge: start }));
        let none = planted(tetrahedron(), |m| m.leaving[0] = HalfEdgeId::NONE);
        assert!(none.contains(&Fault::NoLeaving { vertex: v(0), half_edge: start }), "{none:?}");
        let boundary = sheet().leaving(v(1)).unwrap();
        let inner = planted(sheet(), |m| m.leaving[1] = m.twin(m.prev(boundary)));
        assert_eq!(inner, [Fault::LeavingNotBoundary { vertex: v(1), boundary }]);
    }

    #[test]
    fn a_vertex_with_two_fans() {
        // Two tetrahedra, of which one gives the other its vertex 0.
        let two = TETRAHEDRON.into_iter().chain(TETRAHEDRON.map(|t| t.map(|v| v + 4)));
        let mesh = mesh_of(&two.collect::<Vec<_>>());
        let star: Vec<HalfEdgeId> = mesh.star(v(4)).collect();
        let faults = planted(mesh, |m| {
            star.iter().for_each(|g| m.origin[g.index()] = v(0));
            m.leaving[4] = HalfEdgeId::NONE;
        });
        assert_eq!(faults.len(), star.len());
        for half_edge in star {
            assert!(faults.contains(&Fault::SecondFan { vertex: v(0), half_edge }));
        }
    }

    /// A cube with a vertex `m` on the edge from `a` to `b`; the half-edges `am` and `mb`.
    fn cube_with_split_edge() -> (HalfEdgeMesh, HalfEdgeId, HalfEdgeId) {
        let mut mesh = cube();
        let mb = mesh.split_edge(h(0));
        (mesh, h(0), mb)
    }

    #[test]
    fn two_edges_with_the_same_ends() {
        let (mut mesh, am, mb) = cube_with_split_edge();
        let (right, left) = (mesh.twin(mb), mesh.next(mb));
        mesh.split_face(am, left).unwrap();
        // The same in the face on the other side.
        let faults = planted(mesh, |m| {
            m.cut_face(right, m.next(m.next(right)));
        });
        let is_twice = |f: &Fault| matches!(f, Fault::EdgeTwice { .. });
        assert_eq!((faults.len(), faults.iter().all(is_twice)), (2, true), "{faults:?}");
    }

    #[test]
    fn edges_without_a_face_and_faces_that_meet_a_vertex_twice() {
        let loose = planted(sheet(), |m| {
            for i in 0..3 {
                m.face[i] = FaceId::NONE;
            }
            m.side[0] = HalfEdgeId::NONE;
        });
        assert!(loose.contains(&Fault::EdgeWithoutFace { half_edge: h(0) }), "{loose:?}");
        // Two faces share two consecutive edges; when one is removed, the other dangles in the merged face.
        let (mesh, am, mb) = cube_with_split_edge();
        let (face, vertex) = (mesh.face(am).unwrap(), mesh.destination(mb));
        assert_eq!(planted(mesh, |m| m.join_faces(am)), [Fault::RepeatedVertex { face, vertex }]);
    }

    #[test]
    fn what_a_mesh_is_said_to_be() {
        let claims = |claims: Claims, mesh: HalfEdgeMesh| mesh.check(&claims, &Budget::unlimited()).unwrap();
        let closed = Claims { is_closed: true, ..Claims::default() };
        assert_eq!(claims(closed, tetrahedron()), []);
        let boundary = sheet().boundary_loops()[0];
        assert!(claims(closed, sheet()).contains(&Fault::BoundaryOfClosed { half_edge: boundary }));
        let triangular = Claims { is_triangular: true, ..Claims::default() };
        assert_eq!(claims(triangular, tetrahedron()), []);
        assert!(claims(triangular, cube()).contains(&Fault::WrongSides { face: f(5), sides: 4 }));
        let euler = Claims { euler: Some(0), ..Claims::default() };
        assert_eq!(claims(euler, tetrahedron()), [Fault::Euler { is: 2, claimed: 0 }]);
    }

    #[test]
    fn the_list_of_faults_is_bounded() {
        let strip: Vec<[u32; 3]> = (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let faults = planted(mesh_of(&strip), |m| m.twin.iter_mut().for_each(|t| *t = h(1_000_000)));
        assert_eq!(faults.len(), FAULTS_MAX);
    }
}
