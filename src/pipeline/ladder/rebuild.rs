//! A new surface on a lattice around what no other rung could make a solid, or where what they made lost much.

use super::Rung;
use super::climb::{Climb, Found, Situation};
use crate::pipeline::{Refusal, Require};

pub(super) const RUNG: Rung = Rung {
    name: "rebuild",
    is_new_surface: true,
    applies: |climb, situation| Ok(climb.choices.rebuilds && is_wanted(climb, situation)),
    tries: |climb, situation| {
        situation.has_tried_rebuilding = true;
        match climb.rebuild() {
            Ok(rebuilt) => Ok(Some(Found::Rebuilt(Box::new(rebuilt)))),
            Err(reason) => {
                situation.not_rebuilt = Some(reason.refusal()?);
                Ok(None)
            }
        }
    },
};

/// True where nothing is certified, or what is lost much of the file.
fn is_wanted(climb: &Climb<'_>, situation: &Situation) -> bool {
    if situation.has_tried_rebuilding {
        return false;
    }
    if let Some(certified) = &situation.certified {
        // What was removed as chosen is no loss that a new surface could make good.
        return !certified.fidelity.passes(&climb.options.limits) && !climb.choices.removes();
    }
    situation.last.as_ref().is_some_and(|last| match last.refusal {
        Refusal::NotRepairable { .. } => climb.options.require != Some(Require::None),
        Refusal::NothingToRepair => true,
        _ => false,
    })
}
