//! Where the triangles of a star point, seen from its hub, with all that is near their far edges.
//!
//! Features with the hub in common are no pair. So of two triangles of a star that have near features, one speaks for its
//! far edge or an end of it. What is at most `r` from a place at least `d` from the hub is seen from there at an angle
//! from it whose sine is at most `r / d`, as unit vectors at most `sqrt(2) r / d` apart.

use super::NearInput;
use crate::geom::{Aabb, DVec3, arc_box, closest_point_on_triangle};
use crate::spatial::bvh::{Box32, Elements, HubStar};

/// The triangles of a star as directions from its hub.
pub(super) struct NearDirections<'s> {
    pub(super) input: NearInput<'s>,
    pub(super) star: &'s HubStar,
}

/// Beyond this share of its distance from the hub, what is near an edge may be anywhere.
const SINE_MAX: f64 = 0.5;

impl Elements for NearDirections<'_> {
    fn len(&self) -> usize {
        self.star.triangles.len()
    }

    fn id(&self, place: usize) -> u32 {
        self.star.triangles[place]
    }

    fn bounds(&self, id: u32) -> Box32 {
        let corners = self.corners(id);
        let first = corners.iter().position(|&v| v == self.star.hub).unwrap_or(0);
        let [hub, q, r] = [0, 1, 2].map(|k| corners[(first + k) % 3]);
        let reach = self.input.reach[q as usize].max(self.input.reach[r as usize]);
        let [hub, q, r] = [hub, q, r].map(|v| self.input.positions[v as usize]);
        let sine = reach / closest_point_on_triangle(hub, [q, r, r]).distance(hub);
        if sine.is_nan() || sine > SINE_MAX {
            return Box32::around(Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE });
        }
        let arc = arc_box(hub, q, r);
        // Somewhat more than the root of 2.
        Box32::around(Aabb { min: arc.min - 1.5 * sine, max: arc.max + 1.5 * sine })
    }

    fn corners(&self, id: u32) -> [u32; 3] {
        self.input.triangles[id as usize]
    }
}
