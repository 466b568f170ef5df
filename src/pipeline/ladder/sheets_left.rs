//! Flat sheets beside bodies get walls, and all other holes are filled.

use super::climb::Uncertified;
use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;
use crate::repair::fill::{HoleReport, Rejection};

pub(super) const RUNG: Rung = Rung {
    name: "sheets-left",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        let is_flat = |hole: &HoleReport| {
            hole.rejected.last().is_some_and(|rejected| rejected.reason == Rejection::FlatSheet)
        };
        let leaves_sheets = |last: &Uncertified| {
            let mut left = last.attempt.holes.iter().filter(|hole| hole.used.is_none()).peekable();
            left.peek().is_some() && left.all(is_flat)
        };
        let may_wall = climb.may_wall_sheets() && climb.choices.fills_all_holes();
        let variant = situation.variant;
        let was_tried = situation.has_tried_sheets_left || variant.thickens || variant.contact.is_some();
        // Where all is sheets, holes in them are a part of their shape.
        let may_apply = may_wall && !was_tried && situation.last.as_ref().is_some_and(leaves_sheets);
        Ok(may_apply && !climb.openness(situation)?.is_sheets)
    },
    tries: |climb, situation| {
        situation.has_tried_sheets_left = true;
        let variant = Variant { bridges: true, thickens_rest: true, ..situation.variant };
        climb.try_closing(variant, situation)
    },
};
