//! Which contacts of an event only say that edges vanish there.

use super::conflict::Conflict;
use super::solid::Solid;
use crate::mesh::UnionFind;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};

/// Vertices that become one because edges between them vanish.
pub(super) struct MergedVertices {
    /// The class of each such vertex, ascending.
    class_of: Vec<(VertexId, u32)>,
    /// The faces at the vertices of each class, ascending.
    faces: Vec<Vec<FaceId>>,
}

impl MergedVertices {
    pub(super) fn of(solid: &Solid, vanishing: &[HalfEdgeId]) -> Self {
        let topology = &solid.topology;
        let ends = |h: &HalfEdgeId| [topology.origin(*h), topology.destination(*h)];
        let mut vertices: Vec<VertexId> = vanishing.iter().flat_map(ends).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |v: VertexId| vertices.binary_search(&v).unwrap_or(0) as u32;
        let mut joined = UnionFind::new(vertices.len());
        for [a, b] in vanishing.iter().map(ends) {
            joined.unite(place(a), place(b));
        }
        let mut faces = vec![Vec::new(); vertices.len()];
        let mut class_of = Vec::with_capacity(vertices.len());
        for (i, &v) in vertices.iter().enumerate() {
            let class = joined.find(i as u32);
            class_of.push((v, class));
            faces[class as usize].extend(topology.faces_around(v));
        }
        faces.iter_mut().for_each(|faces: &mut Vec<FaceId>| faces.sort_unstable());
        Self { class_of, faces }
    }

    fn class(&self, v: VertexId) -> Option<u32> {
        self.class_of.binary_search_by_key(&v, |(w, _)| *w).ok().map(|i| self.class_of[i].1)
    }

    /// Whether a contact only says that vertices become one: the elements share a vertex then.
    pub(super) fn explains(&self, solid: &Solid, contact: &Conflict) -> bool {
        let topology = &solid.topology;
        match *contact {
            Conflict::VertexFace { vertex, face } => {
                self.class(vertex).is_some_and(|c| self.faces[c as usize].binary_search(&face).is_ok())
            }
            Conflict::EdgeEdge { first, second } => {
                let classes = |[f, g]: [FaceId; 2]| -> Vec<u32> {
                    let sides = topology.sides(f).filter(|h| topology.face(topology.opposite(*h)) == g);
                    let ends = sides.flat_map(|h| [topology.origin(h), topology.destination(h)]);
                    ends.filter_map(|v| self.class(v)).collect()
                };
                let others = classes(second);
                classes(first).iter().any(|class| others.contains(class))
            }
            Conflict::EdgeVanishes { .. } | Conflict::LoopLoop { .. } => true,
        }
    }
}
