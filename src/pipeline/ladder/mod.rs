//! The ladder: what is tried to make a certified solid of a broken file, least invasive first.

mod as_drawn;
mod beside;
mod bridges;
mod chordal_gaps;
mod climb;
mod contacts;
mod crossing;
mod flat_shells;
mod float32;
mod keep_first;
mod noise;
mod rebuild;
mod rims;
mod sheets;
mod sheets_left;
mod unite;
mod unsnapped;

pub(super) use self::climb::{Certified, Climb};
use self::climb::{RungResult, Situation};
pub(super) use self::unite::Tried;
use super::plan::Attempt;
use super::rebuild::Rebuilt;
use super::{Action, Failure, Refusal};
use crate::budget::Stopped;

/// Changing the surface of the file may take one of so many parts of the work that is left; the rest is for a new one.
const CHANGES_PART: u64 = 2;

/// What a rung does to the surface of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RungKind {
    /// Changes it by the steps of a plan.
    Plan,
    /// Unites its bodies.
    Union,
    /// Makes a new one.
    NewSurface,
}

/// One thing to try.
struct Rung {
    /// As in reports and `docs/ladder.md`.
    name: &'static str,
    kind: RungKind,
    /// Whether it can make a difference.
    applies: fn(&Climb<'_>, &Situation) -> Result<bool, Stopped>,
    /// Tries it and notes in the situation what it left.
    tries: fn(&Climb<'_>, &mut Situation) -> Result<Option<RungResult>, Failure>,
}

/// After each attempt that fails, the first of these that applies comes next.
const RUNGS: [&Rung; 14] = [
    &as_drawn::RUNG,
    &chordal_gaps::RUNG,
    &unite::WHERE_BODIES_MEET,
    &keep_first::RUNG,
    &bridges::RUNG,
    &sheets_left::RUNG,
    &unsnapped::RUNG,
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
    let gap = rims::gap_between_rims(climb)?;
    let mut situation = Situation::at_the_foot(climb, gap)?;
    let mut tried = Vec::new();
    change_the_surface(climb, &mut situation, &mut tried)?;
    if rims::may_have_joined_across_walls(&situation, gap) {
        let mut apart = Situation::at_the_foot(climb, 0.0)?;
        tried.push("rims-apart");
        change_the_surface(climb, &mut apart, &mut tried)?;
        if rims::is_true(&apart, climb) {
            situation = apart;
        }
    }
    climb_by(makes_a_surface, climb, &mut situation, &mut tried)?;
    Ok((situation.outcome(climb), tried))
}

fn makes_a_surface(kind: RungKind) -> bool {
    kind == RungKind::NewSurface
}

/// Climbs by the rungs that change the surface of the file.
fn change_the_surface(
    climb: &Climb<'_>,
    situation: &mut Situation,
    tried: &mut Vec<&'static str>,
) -> Result<(), Failure> {
    let changing = || climb_by(|kind| !makes_a_surface(kind), climb, situation, tried);
    let has_run_out = climb.budget.within_part(CHANGES_PART, changing)?.is_none();
    situation.has_run_out |= has_run_out;
    Ok(())
}

/// Climbs by the rungs of these kinds until none applies.
fn climb_by(
    is_one: impl Fn(RungKind) -> bool,
    climb: &Climb<'_>,
    situation: &mut Situation,
    tried: &mut Vec<&'static str>,
) -> Result<(), Failure> {
    while let Some(rung) = next(&is_one, climb, situation)? {
        tried.push(rung.name);
        let found = (rung.tries)(climb, situation)?;
        situation.keep_closest(found, climb);
    }
    Ok(())
}

/// The first of those rungs that applies.
fn next(
    is_one: impl Fn(RungKind) -> bool,
    climb: &Climb<'_>,
    situation: &Situation,
) -> Result<Option<&'static Rung>, Stopped> {
    for rung in RUNGS {
        if is_one(rung.kind) && situation.may_try(rung.kind) && (rung.applies)(climb, situation)? {
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
        assert!(
            RUNGS.iter().enumerate().all(|(at, rung)| (rung.kind == RungKind::NewSurface) == (at == last))
        );
    }
}
