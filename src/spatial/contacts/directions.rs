//! Where the triangles of a star point, seen from its hub.

use super::SearchedSurface;
use crate::geom::arc_box;
use crate::spatial::bvh::{Box32, Elements, HubStar};

/// The triangles of a star as directions from its hub.
pub(super) struct ContactDirections<'s> {
    pub(super) surface: SearchedSurface<'s>,
    pub(super) star: &'s HubStar,
}

impl Elements for ContactDirections<'_> {
    fn len(&self) -> usize {
        self.star.triangles.len()
    }

    fn id(&self, place: usize) -> u32 {
        self.star.triangles[place]
    }

    fn bounds(&self, id: u32) -> Box32 {
        let [hub, q, r] =
            from_hub(self.corners(id), self.star.hub).map(|v| self.surface.positions[v as usize]);
        Box32::around(arc_box(hub, q, r))
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
