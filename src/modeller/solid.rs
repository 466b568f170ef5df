//! A polyhedron as the planes of its faces and its topology; the vertices are where planes meet.

use super::exact::{IntegerVector, Rational, cross, dot, negative, sign};
use super::index::Index;
use super::plane::{Plane, meeting_point};
use super::point::{AxisView, Point, PointLocation};
use crate::geom::DVec3;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, Polyhedron, VertexId};
use std::cmp::Ordering;
use std::sync::Arc;

/// A closed polyhedron. Its state is the planes and the topology; the points follow from them.
#[derive(Debug, Clone)]
pub struct Solid {
    pub(super) topology: Polyhedron,
    pub(super) planes: Vec<Arc<Plane>>,
    /// Where each vertex is; of no meaning for a removed one.
    pub(super) points: Vec<Arc<Point>>,
    /// Which faces are near a place.
    pub(super) index: Index,
}

impl Solid {
    /// The solid with these planes; `None` where a vertex is not the one point of all its planes.
    pub(super) fn new(topology: Polyhedron, planes: Vec<Plane>) -> Result<Self, VertexId> {
        let planes = planes.into_iter().map(Arc::new).collect();
        let mut solid = Self { topology, planes, points: Vec::new(), index: Index::default() };
        let nowhere = Arc::new(Point::of(DVec3::ZERO));
        for v in (0..solid.topology.vertex_bound()).map(VertexId::new) {
            let point = match solid.topology.leaving(v) {
                None => nowhere.clone(),
                Some(_) => Arc::new(solid.point_of_planes(v).ok_or(v)?),
            };
            solid.points.push(point);
        }
        Ok(solid)
    }

    /// The same solid, so many times as large, for a positive factor.
    pub(super) fn scaled(&self, factor: &Rational) -> Self {
        Self {
            topology: self.topology.clone(),
            planes: self.planes.iter().map(|plane| Arc::new(plane.scaled(factor))).collect(),
            points: self.points.iter().map(|point| Arc::new(point.scaled(factor))).collect(),
            index: Index::default(),
        }
    }

    /// Its topology.
    pub fn topology(&self) -> &Polyhedron {
        &self.topology
    }

    /// The plane of a face.
    pub fn plane(&self, f: FaceId) -> &Plane {
        &self.planes[f.index()]
    }

    /// Where a vertex is.
    pub fn point(&self, v: VertexId) -> &Point {
        &self.points[v.index()]
    }

    /// True when both have the same planes and the same topology, whatever the numbers of vertices and half-edges.
    pub fn is_same_as(&self, other: &Self) -> bool {
        self.planes == other.planes && self.topology.has_topology_of(&other.topology)
    }

    /// Three faces at `v` whose planes meet in one point only, the first such in their order around `v`.
    pub(super) fn defining_faces(&self, faces: &[FaceId]) -> Option<[FaceId; 3]> {
        let normal = |f: FaceId| &self.planes[f.index()].normal;
        let (&first, rest) = faces.split_first()?;
        let second = *rest.iter().find(|&&f| !self.plane(f).is_parallel(self.plane(first)))?;
        let line = cross(normal(first), normal(second));
        let third = *rest.iter().find(|&&f| sign(&dot(&line, normal(f))) != Ordering::Equal)?;
        Some([first, second, third])
    }

    /// The one point of all planes at `v`, if there is one.
    pub(super) fn point_of_planes(&self, v: VertexId) -> Option<Point> {
        let faces: Vec<FaceId> = self.topology.faces_around(v).collect();
        let point = meeting_point(self.defining_faces(&faces)?.map(|f| self.plane(f)))?;
        let is_on_all =
            faces.len() == 3 || faces.iter().all(|&f| self.plane(f).side(&point) == Ordering::Equal);
        is_on_all.then_some(point)
    }

    /// How the plane of `f` is seen.
    pub(super) fn view(&self, f: FaceId) -> AxisView {
        AxisView::along(self.plane(f).unit)
    }

    /// The ends of each side of `f`.
    pub(super) fn sides(&self, f: FaceId) -> impl Iterator<Item = [&Point; 2]> {
        self.topology.sides(f).map(|h| self.ends(h))
    }

    /// Where the edge of `h` begins and ends.
    pub(super) fn ends(&self, h: HalfEdgeId) -> [&Point; 2] {
        [self.point(self.topology.origin(h)), self.point(self.topology.destination(h))]
    }

    /// Where `p`, a point of the plane of `f`, is in `f`.
    pub(super) fn locate(&self, f: FaceId, p: &Point) -> PointLocation {
        self.view(f).locate(p, self.sides(f))
    }

    /// The direction of `h`: the cross product of the normals on its left and right, or its opposite at a reflex edge.
    pub(super) fn direction(&self, h: HalfEdgeId) -> IntegerVector {
        let [left, right] = [h, self.topology.opposite(h)].map(|h| self.plane(self.topology.face(h)));
        let line = cross(&left.normal, &right.normal);
        let [from, to] = self.ends(h);
        let largest = (0..3).max_by(|&i, &j| line[i].magnitude().cmp(line[j].magnitude())).unwrap_or(0);
        let is_along = to.compare(from, largest) == sign(&line[largest]);
        if is_along { line } else { negative(&line) }
    }

    /// The diagonal of the box around all vertices, in the unit of the coordinates.
    pub fn diagonal(&self) -> f64 {
        self.bounds().diagonal()
    }

    /// The box around all vertices, rounded.
    pub fn bounds(&self) -> crate::geom::Aabb {
        crate::geom::Aabb::of(self.topology.vertices().map(|v| self.point(v).near))
    }
}
