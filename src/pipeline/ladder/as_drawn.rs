//! The steps that mend the surface, on the file as it is drawn; with walls where patches would hide much of it, and with one of two
//! copies of opposite direction, or as a union, where much was lost without both.

use super::climb::RungResult;
use super::{Rung, RungKind};

pub(super) const RUNG: Rung = Rung {
    name: "as-drawn",
    kind: RungKind::Plan,
    applies: |_, situation| Ok(situation.last.is_none()),
    tries: |climb, situation| match climb.try_plan(situation.variant, situation)? {
        Some(RungResult::Certified(closed)) => {
            let closed = climb.with_copies_if_closer(closed, situation)?;
            let closed = climb.with_union_if_closer(closed, situation)?;
            let closed = climb.with_bridges_if_closer(closed, situation)?;
            let closed = climb.with_walls_if_closer(closed, situation)?;
            Ok(Some(RungResult::Certified(closed)))
        }
        found => Ok(found),
    },
};
