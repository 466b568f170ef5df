//! Normals at corners, for shading that hides the facets of round surfaces and keeps creases.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;
use foldhash::fast::FixedState;
use std::collections::HashMap;

/// Cosine of the angle from which on an edge is seen as a crease: 40 degrees.
const CREASE_COSINE: f64 = 0.766;
/// Triangles at a vertex up to which each of its corners looks at all others; the tip of a cone of more is drawn flat.
const TRIANGLES_AT_VERTEX_MAX: usize = 64;

/// A unit normal for each corner of each triangle, outward as the corners run; zero where a triangle has none.
#[derive(Debug)]
pub(super) struct CornerNormals(Vec<[[f32; 3]; 3]>);

impl CornerNormals {
    pub(super) fn of(points: &[DVec3], triangles: &[[u32; 3]], budget: &Budget) -> Result<Self, Stopped> {
        let vertices = first_at_position(points, budget)?;
        let faces = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            budget.spend(range.len() as u64 / 8)?;
            Ok(range.map(|t| normal(triangles[t].map(|v| points[v as usize]))).collect::<Vec<_>>())
        })?
        .concat();
        // Triangles at each vertex, in order.
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
        let at_corner = |t: usize, v: u32| {
            let own = faces[t].normalize_or_zero();
            let v = vertices[v as usize] as usize;
            let fan = &around[starts[v] as usize..starts[v + 1] as usize];
            if fan.len() > TRIANGLES_AT_VERTEX_MAX {
                return own.as_vec3().to_array();
            }
            let is_smooth = |n: &DVec3| n.dot(own) > CREASE_COSINE * n.length();
            let sum: DVec3 = fan.iter().map(|&other| faces[other as usize]).filter(is_smooth).sum();
            sum.normalize_or(own).as_vec3().to_array()
        };
        let normals = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            budget.spend(range.len() as u64)?;
            Ok(range.map(|t| triangles[t].map(|v| at_corner(t, v))).collect::<Vec<_>>())
        })?;
        Ok(Self(normals.concat()))
    }

    /// The normals of triangle `t`.
    pub(super) fn of_triangle(&self, t: u32) -> [[f32; 3]; 3] {
        self.0[t as usize]
    }
}

/// The normal of a triangle, as long as twice its area.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// For each point the first one at the same position, bit for bit.
///
/// # Errors
/// When the budget stops the run.
pub fn first_at_position(points: &[DVec3], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let mut first: HashMap<[u64; 3], u32, FixedState> =
        HashMap::with_capacity_and_hasher(points.len(), FixedState::default());
    let mut vertices = Vec::with_capacity(points.len());
    for (v, p) in points.iter().enumerate() {
        if v % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64 / 8)?;
        }
        // Adding zero makes -0 and 0 one.
        vertices.push(*first.entry(p.to_array().map(|x| (x + 0.0).to_bits())).or_insert(v as u32));
    }
    Ok(vertices)
}
