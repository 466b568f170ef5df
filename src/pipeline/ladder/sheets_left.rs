//! Flat sheets beside bodies get walls, and all other holes are filled.

use super::climb::RungResult;
use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;
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
        let area = climb.before.map_or(0.0, |analysis| analysis.measures.area);
        let are_strays = || left.iter().map(|hole| hole.area).sum::<f64>() <= STRAYS_MAX * area;
        let may_wall = climb.may_wall_sheets() && climb.choices.fills_all_holes();
        let variant = situation.variant;
        let was_tried = situation.has_tried_sheets_left || variant.thickens || variant.contact.is_some();
        // Where all is sheets, holes in them are a part of their shape.
        let may_apply = may_wall && !was_tried && leaves_sheets;
        Ok(may_apply && (are_strays() || !climb.openness(situation)?.is_sheets))
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
