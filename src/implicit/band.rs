//! The points that a field is fitted to, and what surrounds them.

use super::unfit::Unfit;
use crate::geom::{Aabb, DVec3};
use crate::spatial::NearestSearch;

/// Points of the surface around one or several holes: the rims first, then rings of their neighbours.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Band {
    /// The points, in the unit of the mesh.
    pub points: Vec<DVec3>,
    /// The normal of each point, outward, of any length but 0; all on one side of the surface.
    pub normals: Vec<DVec3>,
}

impl Band {
    /// Three points at least with normals, all finite.
    pub(super) fn check(&self) -> Result<(), Unfit> {
        let (points, normals) = (self.points.len(), self.normals.len());
        if points < 3 || points != normals {
            return Err(Unfit::TooFewPoints { points, normals });
        }
        let is_good = |i: &usize| {
            let square = self.normals[*i].length_squared();
            self.points[*i].is_finite() && square.is_finite() && square > 0.0
        };
        match (0..points).find(|i| !is_good(i)) {
            Some(point) => Err(Unfit::NotFinite { point }),
            None => Ok(()),
        }
    }
}

/// The surface around a band, which bounds how far offset centres may be from it.
#[derive(Debug, Clone, Copy)]
pub struct BandSurroundings<'s, 'm> {
    /// The triangles of the mesh. `None`: lambda is never halved.
    pub surface: Option<&'s NearestSearch<'m>>,
    /// The box of the whole mesh.
    pub mesh_box: Aabb,
}
