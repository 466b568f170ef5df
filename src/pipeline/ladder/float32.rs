//! Coordinates become float32 first, where the result was no solid when it was read so.

use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "float32",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        let may_round = climb.choices.rounds && !climb.input.soup.is_f32_exact;
        Ok(situation.fails_in_f32 && may_round && !situation.variant.rounds)
    },
    tries: |climb, situation| {
        let opposite = climb.choices.opposite;
        climb.try_plan(Variant { rounds: true, opposite, ..situation.variant }, situation)
    },
};
