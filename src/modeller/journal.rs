//! What an operator has changed, kept so that it can be taken back exactly.

use super::exact::Rational;
use super::motion::{Motion, Moving};
use super::plane::Plane;
use super::point::Point;
use super::solid::Solid;
use crate::geom::Aabb;
use crate::mesh::polyhedron::{FaceId, Polyhedron, VertexId};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What an operator has moved.
pub(super) struct Moves {
    /// The faces that moved or have a vertex that did, ascending.
    pub(super) faces: Vec<FaceId>,
    /// Those whose planes moved, ascending.
    pub(super) planes: Vec<FaceId>,
    /// The vertices that moved, ascending, and the boxes of all places where they were.
    pub(super) reach: Vec<(VertexId, Aabb)>,
    /// Edges became vertices or vertices edges.
    pub(super) has_new_topology: bool,
}

impl Moves {
    /// Everywhere that `v` was, if it moved.
    pub(super) fn of(&self, v: VertexId) -> Option<&Aabb> {
        self.reach.binary_search_by_key(&v, |(w, _)| *w).ok().map(|i| &self.reach[i].1)
    }
}

/// The state before an operator, as far as it was changed.
#[derive(Debug, Clone)]
pub(super) struct Journal {
    topology: Option<Box<Polyhedron>>,
    planes: Vec<(FaceId, Arc<Plane>)>,
    points: Vec<(VertexId, Arc<Point>)>,
    point_count: usize,
    changed: Vec<FaceId>,
}

impl Journal {
    pub(super) fn begin(solid: &Solid) -> Self {
        let point_count = solid.points.len();
        Self { topology: None, planes: Vec::new(), points: Vec::new(), point_count, changed: Vec::new() }
    }

    /// To be called before the topology is edited.
    pub(super) fn keep_topology(&mut self, solid: &Solid) {
        if self.topology.is_none() {
            self.topology = Some(Box::new(solid.topology.clone()));
        }
    }

    /// Lets `motion` run for the time `s`: planes and points as they are then.
    pub(super) fn advance(&mut self, solid: &mut Solid, motion: &Motion, moving: &Moving, s: &Rational) {
        for (f, rate) in motion.rates() {
            let shifted = Arc::new(solid.planes[f.index()].shifted(&(s * rate)));
            self.planes.push((*f, std::mem::replace(&mut solid.planes[f.index()], shifted)));
        }
        for (v, point) in &moving.vertices {
            let there = Arc::new(point.at(s));
            self.points.push((*v, std::mem::replace(&mut solid.points[v.index()], there)));
            self.changed.extend(solid.topology.faces_around(*v));
        }
        self.changed_faces();
        solid.index.touch(&self.changed, solid.topology.face_count());
    }

    /// The faces that moved or have a vertex that did, ascending.
    pub(super) fn changed_faces(&mut self) -> &[FaceId] {
        self.changed.sort_unstable();
        self.changed.dedup();
        &self.changed
    }

    /// What moved, for the check of it.
    pub(super) fn moves(&mut self, solid: &Solid) -> Moves {
        let is_there = |v: VertexId| solid.topology.leaving(v).is_some();
        let mut reach: BTreeMap<VertexId, Aabb> = BTreeMap::new();
        for (v, before) in &self.points {
            let now = if is_there(*v) { solid.point(*v).near } else { before.near };
            let bounds = reach.entry(*v).or_insert(Aabb { min: now, max: now });
            *bounds = bounds.union(Aabb { min: before.near, max: before.near });
        }
        let mut planes: Vec<FaceId> = self.planes.iter().map(|(f, _)| *f).collect();
        planes.sort_unstable();
        planes.dedup();
        let faces = self.changed_faces().to_vec();
        Moves { faces, planes, reach: reach.into_iter().collect(), has_new_topology: self.topology.is_some() }
    }

    /// The planes and the topology as they were.
    pub(super) fn restore(&self, solid: &mut Solid) {
        for (f, plane) in self.planes.iter().rev() {
            solid.planes[f.index()] = Arc::clone(plane);
        }
        for (v, point) in self.points.iter().rev() {
            solid.points[v.index()] = Arc::clone(point);
        }
        solid.points.truncate(self.point_count);
        if let Some(topology) = &self.topology {
            solid.topology = (**topology).clone();
        }
    }

    /// True when `solid` has the planes and the topology from before.
    pub(super) fn is_state_of(&self, solid: &Solid, now: &Solid) -> bool {
        let mut first: Vec<&(FaceId, Arc<Plane>)> = Vec::new();
        for entry in &self.planes {
            if first.iter().all(|(f, _)| *f != entry.0) {
                first.push(entry);
            }
        }
        let topology = self.topology.as_deref().unwrap_or(&now.topology);
        first.iter().all(|(f, plane)| solid.plane(*f) == &**plane) && solid.topology.has_topology_of(topology)
    }
}
