//! Coordinates that are all but zero become zero.

use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;
use crate::repair::noise::{self, Noise};

pub(super) const RUNG: Rung = Rung {
    name: "noise",
    kind: RungKind::Plan,
    applies: |climb, situation| {
        let is_left = situation.variant.noise != Noise::Cleared;
        Ok(is_left && noise::has_noise(&climb.input.soup.positions))
    },
    tries: |climb, situation| {
        let variant = Variant {
            noise: Noise::Cleared,
            rounds: climb.needs_f32(),
            opposite: climb.choices.opposite,
            ..situation.variant
        };
        climb.try_plan(variant, situation)
    },
};
