//! Of two copies of opposite direction one stays.

use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;
use crate::repair::duplicates::OppositePairs;

pub(super) const RUNG: Rung = Rung {
    name: "keep-first",
    kind: RungKind::Plan,
    applies: |_, situation| {
        Ok(situation.last.as_ref().is_some_and(|last| last.effects.cancelled_opposite_pairs))
    },
    tries: |climb, situation| {
        let opposite = OppositePairs::KeepFirst;
        climb.try_plan(Variant { opposite, ..situation.variant }, situation)
    },
};
