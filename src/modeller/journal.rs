//! What an operator has changed, kept so that it can be taken back exactly.

use super::exact::Rational;
use super::motion::{Motion, Moving};
use super::plane::Plane;
use super::point::Point;
use super::solid::Solid;
use crate::mesh::polyhedron::{FaceId, Polyhedron, VertexId};
use std::sync::Arc;

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

    /// The vertices that moved, ascending.
    pub(super) fn moved_vertices(&self) -> Vec<VertexId> {
        let mut moved: Vec<VertexId> = self.points.iter().map(|(v, _)| *v).collect();
        moved.sort_unstable();
        moved.dedup();
        moved
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
