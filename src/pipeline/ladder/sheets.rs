//! Open parts that are read as sheets get walls, and no hole is filled.

use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "sheets",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        let Variant { thickens, contact, .. } = situation.variant;
        Ok(!thickens && contact.is_none() && climb.openness(situation)?.is_sheets)
    },
    tries: |climb, situation| {
        let variant = Variant {
            thickens: true,
            noise: situation.first_noise,
            opposite: climb.choices.opposite,
            ..situation.variant
        };
        climb.try_plan(variant, situation)
    },
};
