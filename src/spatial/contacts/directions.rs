//! Where the triangles of a star point, seen from its hub.

use super::Surface;
use crate::geom::DVec3;
use crate::spatial::bvh::{Box32, Elements, Star};

/// What rounding can move a coordinate of a unit vector, with a wide margin: f32 has 2^-24, or 6e-8.
const ROUNDING: f64 = 1e-6;

/// The triangles of a star as directions from its hub.
pub(super) struct Directions<'s> {
    pub(super) surface: Surface<'s>,
    pub(super) star: &'s Star,
}

impl Elements for Directions<'_> {
    fn len(&self) -> usize {
        self.star.triangles.len()
    }

    fn id(&self, place: usize) -> u32 {
        self.star.triangles[place]
    }

    fn bounds(&self, id: u32) -> Box32 {
        let [hub, q, r] =
            from_hub(self.corners(id), self.star.hub).map(|v| self.surface.positions[v as usize]);
        arc_box(hub, q, r)
    }

    fn corners(&self, id: u32) -> [u32; 3] {
        self.surface.triangles[id as usize]
    }
}

/// The same triangle, beginning with the hub.
fn from_hub([a, b, c]: [u32; 3], hub: u32) -> [u32; 3] {
    if a == hub {
        [a, b, c]
    } else if b == hub {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// A box around all unit vectors from `hub` to points of the segment `q r`.
///
/// They form an arc of the unit circle in the triangle's plane. With a chord of length `c` it leaves the chord by at
/// most `1 - sqrt(1 - c^2 / 4)`, which is at most `c^2 / 4`.
fn arc_box(hub: DVec3, q: DVec3, r: DVec3) -> Box32 {
    let (Some(u), Some(v)) = (unit(q, hub), unit(r, hub)) else {
        return Box32 { min: [-1.0; 3], max: [1.0; 3] };
    };
    let margin = (u - v).length_squared() / 4.0 + ROUNDING;
    Box32 {
        min: (u.min(v) - margin).to_array().map(|x| x as f32),
        max: (u.max(v) + margin).to_array().map(|x| x as f32),
    }
}

/// The unit vector from `hub` to `q`; `None` when the difference is out of the range of f64.
fn unit(q: DVec3, hub: DVec3) -> Option<DVec3> {
    let difference = q - hub;
    let largest = difference.abs().max_element();
    (largest > 0.0 && largest.is_finite()).then(|| (difference / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_holds_every_direction_to_the_far_edge() {
        let hub = DVec3::new(1.0, 2.0, 3.0);
        for (q, r) in [
            (DVec3::X, DVec3::Y),
            (DVec3::new(1.0, 0.01, 0.0), DVec3::new(-1.0, 0.01, 0.0)),
            (DVec3::splat(1e-9), DVec3::new(5.0, -3.0, 1e5)),
        ] {
            let bounds = arc_box(hub, hub + q, hub + r);
            for i in 0..=100 {
                let direction = q.lerp(r, f64::from(i) / 100.0).normalize().to_array().map(|x| x as f32);
                assert!(bounds.meets(&Box32 { min: direction, max: direction }), "{q} {r} {i}");
            }
        }
        let everywhere = arc_box(DVec3::splat(-f64::MAX), DVec3::MAX, DVec3::X);
        assert_eq!(everywhere, Box32 { min: [-1.0; 3], max: [1.0; 3] });
    }
}
