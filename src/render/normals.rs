//! Normals at corners, for shading that hides the facets of round surfaces and keeps creases.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;
use crate::spatial::{Coincident, coincident_f64};

/// Cosine of the angle from which on an edge is seen as a crease: 40 degrees.
const CREASE_COSINE: f64 = 0.766;
/// Triangles at a vertex up to which each of its corners looks at all others; the tip of a cone of more is drawn flat.
const TRIANGLES_AT_VERTEX_MAX: usize = 64;

/// From what the normals at corners are made.
#[derive(Debug)]
pub(super) struct CornerNormals {
    /// For each vertex the first one at its place.
    vertices: Vec<u32>,
    /// The normal of each triangle, as long as twice its area.
    faces: Vec<DVec3>,
    /// Where the triangles of a vertex begin in `around`; those of the last end with it.
    starts: Vec<u32>,
    /// Triangles at each vertex that is the first at its place, in order.
    around: Vec<u32>,
}

impl CornerNormals {
    /// Bytes for so many vertices and triangles.
    pub(super) fn bytes(vertices: usize, triangles: usize) -> usize {
        vertices * 3 * size_of::<u32>() + triangles * (size_of::<DVec3>() + 3 * size_of::<u32>())
    }

    pub(super) fn of(points: &[DVec3], triangles: &[[u32; 3]], budget: &Budget) -> Result<Self, Stopped> {
        let vertices = first_at_position(points, budget)?;
        let faces = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            budget.spend(range.len() as u64 / 8)?;
            Ok(range.map(|t| normal(triangles[t].map(|v| points[v as usize]))).collect::<Vec<_>>())
        })?
        .concat();
        let mut starts = vec![0_u32; points.len() + 1];
        for corners in triangles {
            corners.iter().for_each(|&v| starts[vertices[v as usize] as usize + 1] += 1);
        }
        for v in 0..points.len() {
            starts[v + 1] += starts[v];
        }
        budget.spend(triangles.len() as u64 / 8)?;
        let mut next = starts.clone();
        let mut around = vec![0_u32; triangles.len() * 3];
        for (t, corners) in triangles.iter().enumerate() {
            for &v in corners {
                let place = &mut next[vertices[v as usize] as usize];
                around[*place as usize] = t as u32;
                *place += 1;
            }
        }
        budget.spend(triangles.len() as u64 / 8)?;
        Ok(Self { vertices, faces, starts, around })
    }

    /// A unit normal for each corner of triangle `t`, outward as the corners run; zero where it has none.
    pub(super) fn of_triangle(&self, t: u32, corners: [u32; 3]) -> [DVec3; 3] {
        let own = self.faces[t as usize].normalize_or_zero();
        let is_smooth = |n: &DVec3| {
            let along = n.dot(own);
            along > 0.0 && along * along > CREASE_COSINE * CREASE_COSINE * n.length_squared()
        };
        corners.map(|v| {
            let v = self.vertices[v as usize] as usize;
            let fan = &self.around[self.starts[v] as usize..self.starts[v + 1] as usize];
            if fan.len() > TRIANGLES_AT_VERTEX_MAX {
                return own;
            }
            let sum: DVec3 = fan.iter().map(|&other| self.faces[other as usize]).filter(is_smooth).sum();
            sum.normalize_or(own)
        })
    }
}

/// The normal of a triangle, as long as twice its area.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// For each point the first one at the same position; -0 equals 0.
///
/// # Errors
/// When the budget stops the run.
pub fn first_at_position(points: &[DVec3], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let Coincident { group, first } = coincident_f64(points, budget)?;
    Ok(group.into_iter().map(|group| first[group as usize]).collect())
}
