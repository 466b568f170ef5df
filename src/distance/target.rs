//! The surface to which distances are measured.

use super::Surface;
use super::cover::Cloth;
use super::scale::Common;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::spatial::{Found, NearestSearch};

/// The surface to which distances are measured, prepared.
pub(super) struct DistanceTarget<'s> {
    pub(super) near: NearestSearch<'s>,
    pub(super) cloth: Cloth<'s>,
}

impl<'s> DistanceTarget<'s> {
    pub(super) fn of(surface: Surface<'s>, common: &Common<'_>, budget: &Budget) -> Result<Self, Stopped> {
        let near = NearestSearch::build(surface.positions, surface.triangles, budget)?;
        Ok(Self { near, cloth: Cloth::of(surface, common.slack, budget)? })
    }

    /// A close point, exactly the closest one where the surface has no more than a few boxes about as far.
    pub(super) fn find(
        &self,
        place: DVec3,
        hint: Option<u32>,
        budget: &Budget,
    ) -> Result<Option<Found>, Stopped> {
        self.near.find_roughly(place, hint, BOXES_MAX, budget)
    }
}

/// Boxes that are looked at for a closest point, twice: many times what most take.
const BOXES_MAX: usize = 256;
