//! Flat sheets beside bodies get walls, and all other holes are filled.

use super::climb::RungResult;
use super::{Rung, RungKind};
use crate::budget::{Budget, Stopped};
use crate::mesh::triangle_of;
use crate::pipeline::plan::Variant;
use crate::repair::Draft;
use crate::repair::fill::{HoleReport, Rejection};

/// Flat sheets that are at most this share of the surface are strays: what the rest is without them, it is with them.
const STRAYS_MAX: f64 = 0.1;

pub(super) const RUNG: Rung = Rung {
    name: "sheets-left",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        let is_flat = |hole: &&HoleReport| {
            hole.rejected.last().is_some_and(|rejected| rejected.reason == Rejection::FlatSheet)
        };
        let holes = situation.last.as_ref().map_or(&[][..], |last| &last.attempt.holes);
        let left: Vec<&HoleReport> = holes.iter().filter(|hole| hole.used.is_none()).collect();
        let leaves_sheets = !left.is_empty() && left.iter().all(is_flat);
        let may_wall = climb.may_wall_sheets() && climb.choices.fills_all_holes();
        let variant = situation.variant;
        let was_tried = situation.has_tried_sheets_left || variant.thickens || variant.contact.is_some();
        // Where all is sheets, holes in them are a part of their shape.
        let Some(last) = situation.last.as_ref().filter(|_| may_wall && !was_tried && leaves_sheets) else {
            return Ok(false);
        };
        let are_strays = open_share(&last.attempt.draft, climb.budget)? <= STRAYS_MAX;
        Ok(are_strays || !climb.openness(situation)?.is_sheets)
    },
    tries: |climb, situation| {
        situation.has_tried_sheets_left = true;
        let variant = Variant { bridges: true, thickens_rest: true, ..situation.variant };
        match climb.try_closing(variant, situation)? {
            Some(RungResult::Certified(closed)) => {
                Ok(Some(RungResult::Certified(climb.with_walls_if_closer(closed, situation)?)))
            }
            found => Ok(found),
        }
    },
};

/// The share of the surface that parts with a rim have.
fn open_share(draft: &Draft, budget: &Budget) -> Result<f64, Stopped> {
    let groups = draft.edge_groups(budget)?;
    let parts = groups.components(budget)?;
    let mut is_open = vec![false; parts.count as usize];
    for h in groups.iter().filter(|group| group.len() == 1).flatten() {
        is_open[parts.of[triangle_of(*h) as usize] as usize] = true;
    }
    let areas = draft.areas();
    let open = areas.iter().zip(&parts.of).filter(|&(_, &part)| is_open[part as usize]);
    Ok(open.fold(0.0, |sum, (area, _)| sum + area) / areas.iter().sum::<f64>())
}
