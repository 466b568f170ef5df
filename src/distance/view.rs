//! What of the first surface counts.

use super::bound::Corner;
use super::scale::Common;
use super::{DistanceOptions, Look, VisibilitySearch};
use crate::budget::Stopped;
use crate::geom::DVec3;

/// A piece is asked about at places about this far from each other, as a share of the diagonal.
const RESOLUTION: f64 = 2e-3;

/// Rows of places on a piece.
const ROWS_MAX: usize = 3;

/// A sight, in the coordinates of the search.
#[derive(Clone, Copy)]
pub(super) struct ScaledSight<'v> {
    look: Option<Look<'v>>,
    /// What is farther than this is lost.
    lost_beyond: f64,
    /// What the caller's coordinates were multiplied by.
    factor: f64,
    /// Diagonal of the box around both surfaces.
    diagonal: f64,
}

/// What of a piece can be seen.
pub(super) enum VisiblePart {
    /// No place that was asked about.
    Nothing,
    /// This place.
    At(DVec3),
    /// Nothing is hidden anywhere.
    All,
}

impl<'v> ScaledSight<'v> {
    pub(super) fn of(look: Option<Look<'v>>, common: &Common<'_>, options: &DistanceOptions) -> Self {
        let lost_beyond = options.lost_beyond.map_or(f64::INFINITY, |length| length * common.factor);
        Self { look, lost_beyond, factor: common.factor, diagonal: common.diagonal }
    }

    /// A look for places that are near each other; `None`: nothing is hidden anywhere.
    pub(super) fn look(&self) -> Option<VisibilitySearch<'v>> {
        self.look.map(|look| look())
    }

    /// Whether a place of a triangle counts.
    pub(super) fn counts(
        &self,
        look: &mut Option<VisibilitySearch<'_>>,
        place: DVec3,
        triangle: u32,
    ) -> Result<bool, Stopped> {
        let visible = self.first_visible(look, std::iter::once(place), triangle)?;
        Ok(!matches!(visible, VisiblePart::Nothing))
    }

    /// What of the places of a piece that are asked about can be seen.
    pub(super) fn visible(
        &self,
        look: &mut Option<VisibilitySearch<'_>>,
        corners: &[Corner; 3],
        triangle: u32,
    ) -> Result<VisiblePart, Stopped> {
        let [a, b, c] = corners.map(|corner| corner.place);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let rows = ((longest / (RESOLUTION * self.diagonal)).ceil() as usize).clamp(1, ROWS_MAX);
        let place = |i: usize, j: usize, third: f64| {
            let share = |n: usize| (n as f64 + third) / rows as f64;
            a + (b - a) * share(i) + (c - a) * share(j)
        };
        // The middles of the triangles into which the rows cut the piece: those like it, and those upside down.
        let places = (0..rows).flat_map(|i| (0..rows - i).map(move |j| (i, j))).flat_map(|(i, j)| {
            let is_last = i + j + 1 == rows;
            let upside_down = (!is_last).then(|| place(i, j, 2.0 / 3.0));
            std::iter::once(place(i, j, 1.0 / 3.0)).chain(upside_down)
        });
        self.first_visible(look, places, triangle)
    }

    fn first_visible(
        &self,
        look: &mut Option<VisibilitySearch<'_>>,
        places: impl Iterator<Item = DVec3>,
        triangle: u32,
    ) -> Result<VisiblePart, Stopped> {
        let Some(look) = look else { return Ok(VisiblePart::All) };
        let first = look(&mut places.map(|place| place / self.factor), triangle)?;
        Ok(first.map_or(VisiblePart::Nothing, |place| VisiblePart::At(place * self.factor)))
    }

    /// Whether something at this distance is lost.
    pub(super) fn loses(&self, distance: f64) -> bool {
        distance > self.lost_beyond
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::distance::{DistanceOptions, Surface, directed_distance};

    #[test]
    fn a_place_that_is_seen_counts_where_no_corner_and_no_middle_is() {
        // The first of the places of a triangle that rises from the other one: a ninth along each side, at a ninth of its height.
        let seen = DVec3::new(1.0, 1.0, 2.0);
        let corners = [DVec3::ZERO, DVec3::new(9.0, 0.0, 9.0), DVec3::new(0.0, 9.0, 9.0)];
        let ground =
            [DVec3::new(-20.0, -20.0, 0.0), DVec3::new(40.0, -20.0, 0.0), DVec3::new(-20.0, 40.0, 0.0)];
        let found = |sees: &(dyn Fn(DVec3) -> bool + Sync)| {
            let look = || -> VisibilitySearch<'_> {
                Box::new(|places, _| {
                    for place in places {
                        if sees(place) {
                            return Ok(Some(place));
                        }
                    }
                    Ok(None)
                })
            };
            let options = DistanceOptions { samples: 0, refinements_max: 0, ..DistanceOptions::default() };
            let [from, to] =
                [&corners, &ground].map(|positions| Surface { positions, triangles: &[[0, 1, 2]] });
            directed_distance(from, to, Some(&look), &options, &Budget::unlimited()).unwrap().unwrap()
        };
        let spot = found(&|place| place.distance(seen) < 0.01);
        assert!((spot.lower - seen.z).abs() < 1e-6 && spot.upper > 5.0, "{spot:?}");
        assert_eq!(found(&|_| false).lower, 0.0, "nothing of it is seen");
    }
}
