//! A new surface on a lattice around what no other rung could make a solid, or where what they made lost much.

use super::climb::{Climb, RungResult, Situation};
use super::{Rung, RungKind};
use crate::pipeline::{Refusal, Require};

pub(super) const RUNG: Rung = Rung {
    name: "rebuild",
    kind: RungKind::NewSurface,
    applies: |climb, situation| Ok(climb.choices.rebuilds && is_wanted(climb, situation)),
    tries: |climb, situation| {
        situation.has_tried_rebuilding = true;
        // Beside a certified result it takes no more than half of what is left, which the result needs too.
        let part = if situation.certified.is_some() { 2 } else { 1 };
        match climb.budget.within_part(part, || climb.rebuild()) {
            Ok(rebuilt) => Ok(rebuilt.map(|rebuilt| RungResult::Rebuilt(Box::new(rebuilt)))),
            Err(reason) => {
                situation.not_rebuilt = Some(reason.refusal()?);
                Ok(None)
            }
        }
    },
};

/// True where nothing is certified, or what is certified has lost much of the file.
fn is_wanted(climb: &Climb<'_>, situation: &Situation) -> bool {
    if situation.has_tried_rebuilding {
        return false;
    }
    if let Some(certified) = &situation.certified {
        // What was removed as chosen is no loss that a new surface could make good.
        return !certified.fidelity.passes(&climb.options.limits) && !climb.choices.removes();
    }
    let may_invent = climb.options.require != Some(Require::None);
    if situation.has_run_out {
        return may_invent;
    }
    situation.last.as_ref().is_some_and(|last| match last.refusal {
        Refusal::NotRepairable { .. } => may_invent,
        Refusal::NothingToRepair => true,
        _ => false,
    })
}
