//! The dual structure: a vertex for each face, a face for each vertex.
//!
//! Conventions. A plane is `n . x = d` with the normal outward. The loops of the dual run as the faces around each vertex
//! do, counter-clockwise seen from outside. With the polar embedding, `n / d` for the plane `n . x = d`, the dual of a
//! convex polyhedron around the origin is its polar body and its loops look outward. (For planes written `n . x + d = 0`
//! the same formula gives the point-reflected polar body, whose loops look inward.) Only the polar embedding is
//! independent of the scale of the planes; the two others use unit normals.

use super::exact::{Rational, to_f64};
use super::solid::Solid;
use crate::geom::DVec3;
use crate::mesh::polyhedron::{BuildFault, FaceId, Polyhedron};
use num_traits::Zero;

/// Where the vertex of a face goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Embedding {
    /// `n / d`: the pole of the plane. Exact; undefined for a plane through the origin.
    #[default]
    Polar,
    /// `n (d + 1)` with a unit normal.
    OffsetNormal,
    /// `n d / n.n`: the foot of the origin on the plane, which has lost the sign of `d`.
    Foot,
    /// The centroid of the area of the face, holes left out.
    Centroid,
}

/// The dual of a polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Dual {
    /// A vertex for each face, in their order.
    pub positions: Vec<DVec3>,
    /// The corners of a face for each vertex, counter-clockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
}

/// Why there is no dual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DualRefusal {
    /// The plane of a face passes through the origin and has no pole.
    PlaneThroughOrigin {
        /// The face.
        face: FaceId,
    },
    /// A face has interior loops: its vertex would have several cyclic orders of neighbours.
    InteriorLoops {
        /// The face.
        face: FaceId,
    },
}

impl Dual {
    /// Its topology, which has a dual in turn.
    ///
    /// # Errors
    /// When two faces of the primal share several edges, or two vertices more than an edge: the dual is no polyhedron then.
    pub fn topology(&self) -> Result<Polyhedron, BuildFault> {
        let faces: Vec<Vec<Vec<u32>>> = self.faces.iter().map(|f| vec![f.clone()]).collect();
        Polyhedron::from_loops(&faces, self.positions.len())
    }
}

/// The faces around each vertex of `topology`, counter-clockwise seen from outside: the faces of the dual.
pub fn dual_faces(topology: &Polyhedron) -> Vec<Vec<u32>> {
    let cycle = |v| {
        let mut faces: Vec<u32> = topology.faces_around(v).map(|f| f.index() as u32).collect();
        faces.reverse();
        faces
    };
    topology.vertices().map(cycle).collect()
}

/// The dual of `solid`; with `origin` moved to 0 first, when it is given.
///
/// # Errors
/// A face with interior loops, or one whose plane has no pole.
pub fn dual(solid: &Solid, embedding: Embedding, origin: Option<[Rational; 3]>) -> Result<Dual, DualRefusal> {
    let topology = solid.topology();
    if let Some(face) = topology.faces().find(|f| !topology.loops(*f).interior.is_empty()) {
        return Err(DualRefusal::InteriorLoops { face });
    }
    let origin = origin.unwrap_or_else(|| [Rational::zero(), Rational::zero(), Rational::zero()]);
    let positions: Result<Vec<DVec3>, DualRefusal> =
        topology.faces().map(|f| position(solid, f, embedding, &origin)).collect();
    Ok(Dual { positions: positions?, faces: dual_faces(topology) })
}

fn position(
    solid: &Solid,
    face: FaceId,
    embedding: Embedding,
    origin: &[Rational; 3],
) -> Result<DVec3, DualRefusal> {
    let plane = solid.plane(face);
    let normal = plane.normal.each_ref().map(|n| Rational::from_integer(n.clone()));
    let shift = &normal[0] * &origin[0] + &normal[1] * &origin[1] + &normal[2] * &origin[2];
    let offset = &plane.offset - shift;
    let distance = to_f64(&offset) / plane.length;
    Ok(match embedding {
        Embedding::Polar if offset.is_zero() => return Err(DualRefusal::PlaneThroughOrigin { face }),
        Embedding::Polar => DVec3::from_array(normal.map(|n| to_f64(&(n / &offset)))),
        Embedding::OffsetNormal => plane.unit * (distance + 1.0),
        Embedding::Foot => {
            let square = &normal[0] * &normal[0] + &normal[1] * &normal[1] + &normal[2] * &normal[2];
            DVec3::from_array(normal.map(|n| to_f64(&(n * &offset / &square))))
        }
        Embedding::Centroid => centroid(solid, face) - DVec3::from_array(origin.each_ref().map(to_f64)),
    })
}

fn centroid(solid: &Solid, face: FaceId) -> DVec3 {
    let corners: Vec<DVec3> = solid.sides(face).map(|[a, _]| a.near).collect();
    let base = corners[0];
    let unit = solid.plane(face).unit;
    let (mut sum, mut area) = (DVec3::ZERO, 0.0);
    for pair in corners.windows(2) {
        let part = unit.dot((pair[0] - base).cross(pair[1] - base));
        sum += (pair[0] + pair[1] - 2.0 * base) * (part / 3.0);
        area += part;
    }
    base + sum / area
}
