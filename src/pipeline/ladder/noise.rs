//! Coordinates that are all but zero become zero, or stay where the first plan made them zero.

use super::{Kind, Rung};
use crate::pipeline::plan::Variant;
use crate::repair::noise;

pub(super) const RUNG: Rung = Rung {
    name: "noise",
    kind: Kind::Plan,
    applies: |climb, situation| {
        let is_first = situation.variant.clears_noise == situation.first_clears_noise;
        Ok(is_first && noise::has_noise(&climb.input.soup.positions))
    },
    tries: |climb, situation| {
        let variant = Variant {
            clears_noise: !situation.first_clears_noise,
            rounds: climb.needs_f32(),
            opposite: climb.choices.opposite,
            ..situation.variant
        };
        climb.try_plan(variant, situation)
    },
};
