//! Gaps between an arc and its chord over which a surface lies, such as the lid of a cylinder whose wall has fewer sides, are closed.

use super::climb::Uncertified;
use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;
use crate::repair::fill::Rejection;

pub(super) const RUNG: Rung = Rung {
    name: "chordal-gaps",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        // Patches over such gaps meet the surface that lies over them.
        let has_gaps = |last: &Uncertified| {
            let met = |reason| matches!(reason, Rejection::MeetsOther | Rejection::EdgeInUse);
            let mut open = last.holes.iter().filter(|hole| hole.used.is_none());
            open.any(|hole| hole.rejected.iter().any(|rejected| met(rejected.reason)))
        };
        Ok(climb.choices.may_join_rims()
            && !situation.has_tried_chordal_gaps
            && situation.last.as_ref().is_some_and(has_gaps))
    },
    tries: |climb, situation| {
        situation.has_tried_chordal_gaps = true;
        climb.try_closing(Variant { closes_chordal_gaps: true, ..situation.variant }, situation)
    },
};
