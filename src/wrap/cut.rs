//! Where the edges of the lattice are cut: on the input surface, as near as the clamped steps allow.

use super::lattice::Lattice;
use super::signs::{Inside, Signs, THIN};
use super::surface::{InputSurface, Says, SegmentHit, separate};
use super::tetrahedra::CutEdge;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::par;
use crate::spatial::NearestSearch;

/// No triangle of the input.
pub(super) const NONE: u32 = u32::MAX;

/// Where an edge is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LatticeCut {
    /// Share of the edge before the cut, in steps of the lattice; clamped to 1/8 to 7/8.
    pub(super) steps: u16,
    /// The point of the input that the cut stands for, in lattice units; where there is none, the cut itself.
    pub(super) point: DVec3,
    /// The triangle of the input that the point is on, or [`NONE`].
    pub(super) triangle: u32,
    /// Why the inner end of the edge is inside.
    pub(super) why: Inside,
}

/// The cut of every edge.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn cuts(
    lattice: &Lattice,
    signs: &Signs<'_>,
    surface: &InputSurface,
    edges: &[CutEdge],
    budget: &Budget,
) -> Result<Vec<LatticeCut>, Stopped> {
    let (thin_names, sheet_names) = (separate(signs.thin.len()), separate(surface.sheets().len()));
    let cutter = Cutter {
        lattice,
        signs,
        surface,
        thin: NearestSearch::build(signs.thin.as_flattened(), &thin_names, budget)?,
        sheets: NearestSearch::build(surface.sheets().as_flattened(), &sheet_names, budget)?,
        budget,
    };
    let cuts = par::try_map_ranges(edges.len(), 1024, |range| {
        budget.spend(range.len() as u64 * 2)?;
        let mut found = Vec::new();
        edges[range]
            .iter()
            .map(|&edge| cutter.cut(edge, &mut found))
            .collect::<Result<Vec<LatticeCut>, Stopped>>()
    })?;
    Ok(cuts.concat())
}

struct Cutter<'a> {
    lattice: &'a Lattice,
    signs: &'a Signs<'a>,
    surface: &'a InputSurface,
    thin: NearestSearch<'a>,
    sheets: NearestSearch<'a>,
    budget: &'a Budget,
}

impl Cutter<'_> {
    fn cut(&self, edge: CutEdge, found: &mut Vec<SegmentHit>) -> Result<LatticeCut, Stopped> {
        let base = edge.base as usize;
        let along = [0, 1, 2].map(|a| isize::from(edge.direction >> a & 1 == 1));
        let end = base.wrapping_add_signed(self.lattice.stride(along));
        let place = |index: usize| DVec3::from_array(self.lattice.coordinates(index).map(|n| n as f64));
        let is_up = self.signs.is_inside(base);
        let (inside, outside) = if is_up { (base, end) } else { (end, base) };
        let (from, to) = (place(inside), place(outside));
        self.surface.crossings(from, to, self.budget, found)?;
        let why = self.signs.why(inside);
        let says = if why == Inside::NearSheet { Says::Sheet } else { Says::Boundary };
        let fits =
            |c: &&SegmentHit| self.surface.says(c.triangle) == says && (says == Says::Sheet || c.is_exit);
        // The one nearest to the outside is what can be seen.
        let crossing = match why {
            Inside::NearThin => None,
            _ => found
                .iter()
                .filter(fits)
                .max_by(|a, b| a.share.total_cmp(&b.share).then(b.triangle.cmp(&a.triangle))),
        };
        let (share, triangle) = match crossing {
            Some(c) => (c.share, c.triangle),
            None => (self.share_without_crossing(why, [inside, outside], [from, to])?, NONE),
        };
        let steps = f64::from(1u32 << self.lattice.steps_log2);
        let upward = if is_up { share } else { 1.0 - share };
        let clamped = (upward * steps).round().clamp(steps / 8.0, steps * 0.875);
        let point = from.lerp(to, share);
        Ok(LatticeCut { steps: clamped as u16, point, triangle, why })
    }

    /// Share of the way from inside to outside where a value falls below its threshold, taken as linear.
    fn share_without_crossing(
        &self,
        why: Inside,
        indices: [usize; 2],
        places: [DVec3; 2],
    ) -> Result<f64, Stopped> {
        let (values, threshold) = match why {
            Inside::Wound => {
                let [high, low] = indices.map(|index| self.signs.winding(index, self.budget));
                ([high?, low?], 0.5)
            }
            Inside::NearSheet => (self.distances(&self.sheets, places)?, -self.signs.sheet_reach),
            Inside::NearThin => (self.distances(&self.thin, places)?, -THIN),
        };
        let [high, low] = values.map(|value| value - threshold);
        let share = high / (high - low);
        Ok(if high >= 0.0 && low < 0.0 { share } else { 0.5 })
    }

    /// Distances, negative.
    fn distances(&self, search: &NearestSearch<'_>, places: [DVec3; 2]) -> Result<[f64; 2], Stopped> {
        let mut distances = [0.0; 2];
        for (distance, place) in distances.iter_mut().zip(places) {
            *distance = search.find(place, None, self.budget)?.map_or(0.0, |nearest| -nearest.distance);
        }
        Ok(distances)
    }
}
