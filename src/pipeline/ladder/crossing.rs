//! Few triangles that meet others go, with ever more rings around them, and what they leave is filled.

use super::climb::Climb;
use super::{Rung, RungKind};
use crate::pipeline::plan::Variant;

/// Rings that are removed around triangles that meet others, at most.
const RINGS_MAX: u32 = 2;

/// Most triangles may meet others, as one in so many of all.
const ONE_IN_MIN: u64 = 20;

pub(super) const RUNG: Rung = Rung {
    name: "crossing",
    kind: RungKind::Plan,
    applies: |climb, situation| Ok(situation.variant.removes_crossing.is_none() && may_remove(climb)),
    tries: |climb, situation| {
        let variant = Variant {
            thickens: false,
            noise: situation.first_noise,
            opposite: climb.choices.opposite,
            ..situation.variant
        };
        for rings in 0..=RINGS_MAX {
            let removes_crossing = Some(rings);
            let mends_thin_faces = situation.variant.mends_thin_faces;
            let found =
                climb.try_plan(Variant { removes_crossing, mends_thin_faces, ..variant }, situation)?;
            let has_removed = situation.last.as_ref().is_some_and(|last| last.effects.removed_crossing);
            if found.is_some() || !situation.may_try(RungKind::Plan) || !has_removed {
                return Ok(found);
            }
        }
        Ok(None)
    },
};

/// True unless it is known that no triangles meet others, or that a large share of them does.
fn may_remove(climb: &Climb<'_>) -> bool {
    let most = climb.input.soup.triangles.len() as u64 / ONE_IN_MIN;
    let contacts = climb.input.examination.contacts.as_ref();
    climb.choices.removes_crossing && contacts.is_none_or(|contacts| (1..=most).contains(&contacts.count))
}
