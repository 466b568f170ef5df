//! Open parts that are read as sheets get walls, and no hole is filled.

use super::Rung;
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "sheets",
    is_new_surface: false,
    applies: |climb, situation| {
        let Variant { thickens, contact, .. } = situation.variant;
        Ok(!thickens && contact.is_none() && climb.reads_as_sheets()?)
    },
    tries: |climb, situation| {
        let variant = Variant {
            thickens: true,
            clears_noise: situation.first_clears_noise,
            opposite: climb.choices.opposite,
            ..situation.variant
        };
        climb.try_plan(variant, situation)
    },
};
