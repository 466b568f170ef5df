//! The steps that mend the surface, on the file as it is drawn; with walls where patches would hide much of it.

use super::climb::RungResult;
use super::{Kind, Rung};

pub(super) const RUNG: Rung = Rung {
    name: "as-drawn",
    kind: Kind::Plan,
    applies: |_, situation| Ok(situation.last.is_none()),
    tries: |climb, situation| match climb.try_plan(situation.variant, situation)? {
        Some(RungResult::Certified(closed)) => climb.with_walls_if_closer(closed, situation).map(Some),
        found => Ok(found),
    },
};
