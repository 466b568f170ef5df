//! Rims that face each other get one patch between them.

use super::climb::Uncertified;
use super::{Rung, RungKind, beside};
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "bridges",
    kind: RungKind::Plan,
    applies: |_, situation| {
        let has_several_rims = |last: &Uncertified| beside::has_several_rims(&last.holes);
        Ok(!situation.has_tried_bridging && situation.last.as_ref().is_some_and(has_several_rims))
    },
    tries: |climb, situation| {
        situation.has_tried_bridging = true;
        climb.try_closing(Variant { bridges: true, ..situation.variant }, situation)
    },
};
