//! Naming a face, a vertex or an edge by where it is.

use super::point::{Point, PointLocation};
use super::solid::Solid;
use crate::geom::DVec3;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId, VertexId};
use std::cmp::Ordering;

/// The first face that a ray meets from the outside, its border included; of several at one place the first.
pub fn face_on_ray(solid: &Solid, from: DVec3, direction: DVec3) -> Option<FaceId> {
    let topology = solid.topology();
    let mut best: Option<(f64, FaceId)> = None;
    for f in topology.faces() {
        let plane = solid.plane(f);
        let speed = plane.unit.dot(direction);
        let time = (plane.distance - plane.unit.dot(from)) / speed;
        // From outside the ray runs against the normal.
        if speed >= 0.0 || !time.is_finite() || time < 0.0 || best.is_some_and(|(t, _)| t <= time) {
            continue;
        }
        if solid.locate(f, &Point::of(from + direction * time)) != PointLocation::Outside {
            best = Some((time, f));
        }
    }
    best.map(|(_, f)| f)
}

/// The face whose normal is nearest to `normal`, and of those with the same the one nearest to `at`.
pub fn face_by_normal(solid: &Solid, normal: DVec3, at: DVec3) -> Option<FaceId> {
    let unit = normal.try_normalize()?;
    // A thousandth of a degree is far more than rounding and far less than a facet's angle.
    let step = |f: FaceId| ((1.0 - solid.plane(f).unit.dot(unit)) * 1e10).round();
    let far = |f: FaceId| distance_to_face(solid, f, at);
    let order =
        |a: &FaceId, b: &FaceId| step(*a).total_cmp(&step(*b)).then_with(|| far(*a).total_cmp(&far(*b)));
    solid.topology().faces().min_by(order)
}

/// How far a point is from a face, rounded.
fn distance_to_face(solid: &Solid, f: FaceId, p: DVec3) -> f64 {
    let plane = solid.plane(f);
    let height = plane.unit.dot(p) - plane.distance;
    if solid.locate(f, &Point::of(p - plane.unit * height)) != PointLocation::Outside {
        return height.abs();
    }
    let to_side = |[a, b]: [&Point; 2]| distance_to_segment(p, a.near, b.near);
    solid.sides(f).map(to_side).fold(f64::INFINITY, f64::min)
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let s = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * s)
}

/// The vertex nearest to a point.
pub fn vertex_near(solid: &Solid, at: DVec3) -> Option<VertexId> {
    let far = |v: &VertexId| solid.point(*v).near.distance_squared(at);
    solid.topology().vertices().min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// The edge between two faces, as the half-edge of the first; of several the one nearest to `at`, or the first.
pub fn edge_between(solid: &Solid, faces: [FaceId; 2], at: Option<DVec3>) -> Option<HalfEdgeId> {
    let topology = solid.topology();
    let shared = topology.sides(faces[0]).filter(|&h| topology.face(topology.opposite(h)) == faces[1]);
    let far = |h: &HalfEdgeId| {
        let [a, b] = solid.ends(*h);
        at.map_or(0.0, |p| distance_to_segment(p, a.near, b.near))
    };
    shared.min_by(|a, b| far(a).partial_cmp(&far(b)).unwrap_or(Ordering::Equal).then(a.cmp(b)))
}
