//! The steps that mend the surface, on the file as it is drawn.

use super::{Kind, Rung};

pub(super) const RUNG: Rung = Rung {
    name: "as-drawn",
    kind: Kind::Plan,
    applies: |_, situation| Ok(situation.last.is_none()),
    tries: |climb, situation| climb.try_plan(situation.variant, situation),
};
