//! The ladder: what is tried to make a certified solid of a broken file, least invasive first.

mod as_drawn;
mod climb;
mod contacts;
mod crossing;
mod float32;
mod keep_first;
mod noise;
mod rebuild;
mod sheets;
mod unite;

pub(super) use self::climb::{Certified, Climb};
use self::climb::{Found, Situation};
pub(super) use self::unite::Tried;
use super::plan::Attempt;
use super::rebuild::Rebuilt;
use super::{Action, Failure, Refusal};
use crate::budget::Stopped;

/// One thing to try.
struct Rung {
    /// As in reports and `docs/ladder.md`.
    name: &'static str,
    /// True for the rung that makes a new surface. The others change the surface of the file; they are tried until one is
    /// certified.
    is_new_surface: bool,
    /// Whether it can make a difference.
    applies: fn(&Climb<'_>, &Situation) -> Result<bool, Stopped>,
    /// Tries it and notes in the situation what it left.
    tries: fn(&Climb<'_>, &mut Situation) -> Result<Option<Found>, Failure>,
}

/// After each attempt that fails, the first of these that applies comes next.
const RUNGS: [&Rung; 10] = [
    &as_drawn::RUNG,
    &unite::WHERE_BODIES_MEET,
    &keep_first::RUNG,
    &float32::RUNG,
    &noise::RUNG,
    &sheets::RUNG,
    &contacts::RUNG,
    &unite::BEFORE_TRIANGLES_GO,
    &crossing::RUNG,
    &rebuild::RUNG,
];

/// Where a climb ended.
pub(super) enum Climbed {
    /// The surface of the file, changed by steps.
    Certified(Box<Certified>),
    /// A new surface.
    Rebuilt(Box<Rebuilt>),
    /// Nothing is certified; the mended mesh, which was asked for in that case.
    Mended(Box<Attempt>),
    /// Nothing, with what the last attempt did.
    Refused { refusal: Refusal, actions: Vec<Action> },
}

/// Climbs until a result is certified that loses little; where one loses much, the closest to the file wins. Gives the names of
/// the rungs that were tried as well.
pub(super) fn climb(climb: &Climb<'_>) -> Result<(Climbed, Vec<&'static str>), Failure> {
    let mut situation = Situation::at_the_foot(climb)?;
    let mut tried = Vec::new();
    while let Some(rung) = next(climb, &situation)? {
        tried.push(rung.name);
        let found = (rung.tries)(climb, &mut situation)?;
        situation.keep_closest(found, climb);
    }
    Ok((situation.outcome(), tried))
}

/// The first rung that applies.
fn next(climb: &Climb<'_>, situation: &Situation) -> Result<Option<&'static Rung>, Stopped> {
    for rung in RUNGS {
        if (rung.is_new_surface || situation.may_change_the_surface()) && (rung.applies)(climb, situation)? {
            return Ok(Some(rung));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_rung_makes_a_new_surface() {
        let last = RUNGS.len() - 1;
        assert!(RUNGS.iter().enumerate().all(|(at, rung)| rung.is_new_surface == (at == last)));
    }
}
