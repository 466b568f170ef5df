//! Flat sheets beside bodies get walls, and all other holes are filled.

use super::climb::RungResult;
use super::{Rung, RungKind};
use crate::budget::{Budget, Stopped};
use crate::mesh::triangle_of;
use crate::pipeline::plan::Variant;
use crate::repair::Draft;

/// Flat sheets that are at most this share of the surface are strays: what the rest is without them, it is with them.
const STRAYS_MAX: f64 = 0.1;

pub(super) const RUNG: Rung = Rung {
    name: "sheets-left",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        let may_wall = climb.may_wall_sheets() && climb.choices.fills_all_holes();
        let variant = situation.variant;
        let was_tried = situation.has_tried_sheets_left || variant.thickens || variant.contact.is_some();
        // Where all is sheets, holes in them are a part of their shape.
        let with_sheets = situation.last.as_ref().and_then(|last| last.with_sheets.as_ref());
        let Some(draft) = with_sheets.filter(|_| may_wall && !was_tried) else {
            return Ok(false);
        };
        let are_strays = open_share(draft, climb.budget)? <= STRAYS_MAX;
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
