//! From faces whose corners lie in one plane exactly.

use super::super::exact::{cross, is_zero};
use super::super::plane::Plane;
use super::super::point::Point;
use super::super::solid::Solid;
use crate::geom::DVec3;
use crate::mesh::polyhedron::{BuildFault, Polyhedron};
use std::cmp::Ordering;

/// Why faces are no polyhedron with exact planes.
#[derive(Debug, Clone, PartialEq)]
pub enum PolygonFault {
    /// The loops are not a closed manifold.
    NotClosed(BuildFault),
    /// The corners of a face are on one line.
    NoPlane(u32),
    /// A corner of a face is not in the plane of the first three that are not on one line.
    NotFlat(u32),
    /// The planes around a vertex do not meet in one point.
    Vertex(u32),
}

/// The polyhedron of faces given as loops of corners, the exterior one first, counter-clockwise seen from outside. The
/// corners must be finite.
///
/// # Errors
/// When the faces are not flat exactly, or no closed manifold.
pub fn from_polygons(points: &[DVec3], faces: &[Vec<Vec<u32>>]) -> Result<Solid, PolygonFault> {
    let topology = Polyhedron::from_loops(faces, points.len()).map_err(PolygonFault::NotClosed)?;
    let at: Vec<Point> = points.iter().map(|&p| Point::of(p)).collect();
    let plane = |f: usize| {
        let corners = &faces[f][0];
        // The sum over the loop is the area vector, whichever corners are reflex.
        let base = &at[corners[0] as usize];
        let normal = corners.windows(2).skip(1).fold([0, 0, 0].map(num_bigint::BigInt::from), |sum, pair| {
            let [b, c] = [pair[0], pair[1]].map(|v| &at[v as usize]);
            // Differences carry the denominators of both points; they are powers of two here and made equal.
            let (u, v) = (base.to(b).map(|x| x * &c.w), base.to(c).map(|x| x * &b.w));
            let part = cross(&u, &v);
            let scale = &b.w * &c.w;
            let scale = &scale * &scale;
            std::array::from_fn(|k| &sum[k] + (&part[k] << 512) / &scale)
        });
        if is_zero(&normal) {
            return Err(PolygonFault::NoPlane(f as u32));
        }
        let plane = Plane::through(normal, base);
        let is_flat = faces[f].iter().flatten().all(|&v| plane.side(&at[v as usize]) == Ordering::Equal);
        if is_flat { Ok(plane) } else { Err(PolygonFault::NotFlat(f as u32)) }
    };
    let planes: Result<Vec<Plane>, PolygonFault> = (0..faces.len()).map(plane).collect();
    Solid::new(topology, planes?).map_err(|v| PolygonFault::Vertex(v.index() as u32))
}
