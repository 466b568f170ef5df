//! Rims that lie close to each other are not joined.

use super::{Kind, Rung};
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "unsnapped",
    kind: Kind::Plan,
    applies: |_, situation| Ok(situation.variant.snap_epsilon > 0.0),
    tries: |climb, situation| {
        let variant = Variant { snap_epsilon: 0.0, opposite: climb.choices.opposite, ..situation.variant };
        climb.try_plan(variant, situation)
    },
};
