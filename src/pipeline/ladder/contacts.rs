//! Bodies that touch are joined or drawn apart, as the option `contact` says; where joining fails they are drawn apart.

use super::climb::{Climb, Situation};
use super::{Rung, RungKind};
use crate::pipeline::Contact;
use crate::pipeline::plan::Variant;

pub(super) const RUNG: Rung = Rung {
    name: "contacts",
    kind: RungKind::Plan,
    applies: |climb, situation| Ok(contact(climb, situation).is_some()),
    tries: |climb, situation| {
        let variant = Variant {
            contact: contact(climb, situation),
            thickens: false,
            noise: situation.first_noise,
            opposite: climb.choices.opposite,
            ..situation.variant
        };
        climb.try_plan(variant, situation)
    },
};

/// What to do next about bodies that touch.
fn contact(climb: &Climb<'_>, situation: &Situation) -> Option<Contact> {
    // Bodies that lie on each other would be parted by a gap that nobody wants.
    let only_touches = climb.before.is_some_and(|before| before.properties.is_embedded == Some(true));
    let has_copied = || situation.last.as_ref().is_some_and(|last| last.effects.copied_vertices);
    match situation.variant.contact {
        None => (only_touches && has_copied()).then_some(climb.options.contact),
        Some(Contact::Join) => Some(Contact::Open),
        Some(Contact::Open) => None,
    }
}
