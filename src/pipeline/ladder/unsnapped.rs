//! Rims that lie close to each other are not joined.

use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "unsnapped",
    kind: RungKind::Plan,
    applies: |_, situation| Ok(situation.variant.snap_epsilon > 0.0),
    tries: |climb, situation| {
        let variant = Variant { snap_epsilon: 0.0, opposite: climb.choices.opposite, ..situation.variant };
        climb.try_plan(variant, situation)
    },
};
