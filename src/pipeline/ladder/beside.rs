//! Other plans that are tried beside a result of the first one: where it is certified and lost much the closer result is kept.

use super::climb::{Certified, Climb, RungResult, Situation};
use crate::pipeline::plan::Variant;
use crate::pipeline::repair_choices::Walls;
use crate::pipeline::{Failure, Require};
use crate::repair::duplicates::OppositePairs;
use crate::repair::fill::HoleReport;
use crate::winding::OpenShells;

/// Such a plan may take one of so many parts of the work that is left.
const BESIDE_PART: u64 = 2;

/// Share of a result's surface that may be far from the file without bridges being tried.
const INVENTED_MAX: f64 = 0.01;

impl Climb<'_> {
    /// Keeps one of two copies of opposite direction where much is lost without both.
    pub(super) fn with_copies_if_closer(
        &self,
        closed: Box<Certified>,
        situation: &mut Situation,
    ) -> Result<Box<Certified>, Failure> {
        let has_lost = !closed.fidelity.passes(&self.options.limits);
        if !has_lost || !closed.attempt.effects.cancelled_opposite_pairs {
            return Ok(closed);
        }
        let variant = Variant { opposite: OppositePairs::KeepFirst, ..situation.variant };
        self.closer_of(closed, variant, situation)
    }

    /// Closes rims that face each other by one patch between them where that invents less surface than one for each.
    pub(super) fn with_bridges_if_closer(
        &self,
        closed: Box<Certified>,
        situation: &mut Situation,
    ) -> Result<Box<Certified>, Failure> {
        if closed.fidelity.losses.invented <= INVENTED_MAX || !has_several_rims(&closed.attempt.holes) {
            return Ok(closed);
        }
        situation.has_tried_bridging = true;
        let limits = &self.options.limits;
        let invented = |of: &Certified| of.fidelity.losses.invented;
        let is_better = |closed: &Certified, bridged: &Certified| match closed.fidelity.passes(limits) {
            true => bridged.fidelity.passes(limits) && invented(bridged) < invented(closed),
            false => !closed.fidelity.is_no_worse(&bridged.fidelity, limits),
        };
        self.better_of(closed, Variant { bridges: true, ..situation.variant }, is_better, situation)
    }

    /// Gives open parts walls where patches over their openings take much from them.
    pub(super) fn with_walls_if_closer(
        &self,
        closed: Box<Certified>,
        situation: &mut Situation,
    ) -> Result<Box<Certified>, Failure> {
        if !self.may_wall_sheets() || !closed.covers_much(&self.options.limits) {
            return Ok(closed);
        }
        self.closer_of(closed, Variant { thickens: true, ..situation.variant }, situation)
    }

    /// True when open parts that are read as sheets may get walls.
    pub(super) fn may_wall_sheets(&self) -> bool {
        self.choices.walls == Walls::ForSheets
            && self.options.wrap.open_shells != OpenShells::Close
            && self.options.require != Some(Require::None)
    }

    /// Tries a plan that closes more than the last one did; where it leads to nothing, it leaves no trace for further rungs.
    pub(super) fn try_closing(
        &self,
        variant: Variant,
        situation: &mut Situation,
    ) -> Result<Option<RungResult>, Failure> {
        let before =
            (situation.variant, situation.last.take(), situation.fails_in_f32, situation.has_run_out);
        let found = self.try_plan(variant, situation)?;
        if found.is_none() {
            (situation.variant, situation.last, situation.fails_in_f32, situation.has_run_out) = before;
        }
        Ok(found)
    }

    /// Tries a plan beside a certified result that lost much, and gives the closer one.
    fn closer_of(
        &self,
        known: Box<Certified>,
        variant: Variant,
        situation: &mut Situation,
    ) -> Result<Box<Certified>, Failure> {
        let limits = &self.options.limits;
        let is_closer =
            |known: &Certified, tried: &Certified| !known.fidelity.is_no_worse(&tried.fidelity, limits);
        self.better_of(known, variant, is_closer, situation)
    }

    /// Tries a plan beside a certified result, which stays where that takes too much work, and gives the one that
    /// `is_better`.
    fn better_of(
        &self,
        known: Box<Certified>,
        variant: Variant,
        is_better: impl Fn(&Certified, &Certified) -> bool,
        situation: &mut Situation,
    ) -> Result<Box<Certified>, Failure> {
        let before = situation.variant;
        let tried = self.budget.within_part(BESIDE_PART, || self.try_plan(variant, situation))?;
        match tried.flatten() {
            Some(RungResult::Certified(tried)) if is_better(&known, &tried) => Ok(tried),
            _ => {
                situation.variant = before;
                Ok(known)
            }
        }
    }
}

/// True when more than one rim was to be closed.
pub(super) fn has_several_rims(holes: &[HoleReport]) -> bool {
    holes.iter().map(|hole| hole.loops).sum::<u64>() > 1
}
