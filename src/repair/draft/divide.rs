//! Dividing triangles of a draft at new vertices beside their edges.

use super::Draft;
use crate::geom::{DVec3, are_collinear};
use crate::mesh::divide;

/// Cosine of the angle between a triangle and what becomes of it above which it goes on: 60 degrees.
const TURN_COS_MIN: f64 = 0.5;

/// A new vertex beside an edge of a triangle.
#[derive(Debug, Clone, Copy)]
pub(in crate::repair) struct VertexBeside {
    /// The half-edge that is to go through it.
    pub(in crate::repair) half_edge: u32,
    pub(in crate::repair) place: DVec3,
    /// The vertex of the draft whose origin it has.
    pub(in crate::repair) like: u32,
}

impl Draft {
    /// Divides triangle `t` at new vertices, those of each edge in the order of its direction; `false`, and nothing is changed, where
    /// a part would turn.
    pub(in crate::repair) fn divide_beside(
        &mut self,
        t: u32,
        inside: impl IntoIterator<Item = VertexBeside>,
    ) -> bool {
        let whole = self.corners(t as usize);
        let first = self.positions.len();
        let mut on: [Vec<u32>; 3] = Default::default();
        for VertexBeside { half_edge, place, like } in inside {
            on[half_edge as usize % 3].push(self.positions.len() as u32);
            self.positions.push(place);
            self.vertex_origin.push(self.vertex_origin[like as usize]);
        }
        let parts = divide(self.triangles[t as usize], on.each_ref().map(Vec::as_slice));
        if !parts.iter().all(|part| Self::goes_on(whole, part.map(|v| self.positions[v as usize]))) {
            self.positions.truncate(first);
            self.vertex_origin.truncate(first);
            return false;
        }
        self.replace(t, &parts);
        true
    }

    /// True when what becomes of a triangle has an area and looks the way that it did.
    pub(in crate::repair) fn goes_on(before: [DVec3; 3], after: [DVec3; 3]) -> bool {
        let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize_or_zero();
        let [a, b, c] = after;
        !are_collinear(a, b, c) && normal(before).dot(normal(after)) > TURN_COS_MIN
    }
}
