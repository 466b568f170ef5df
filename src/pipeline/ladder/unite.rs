//! Bodies that pass through each other, as one: the exact arrangement.

use super::climb::{Certified, Climb, Found, Judged, Situation};
use super::{Kind, Rung};
use crate::analysis::DefectCode;
use crate::budget::Stopped;
use crate::pipeline::output::Candidate;
use crate::pipeline::plan::{Attempt, Uniting, Variant};
use crate::pipeline::repair_choices::Walls;
use crate::pipeline::step::Step;
use crate::pipeline::{Failure, Refusal, Require};
use crate::repair::nest::Policy;
use crate::winding::OpenShells;

/// Where triangles of the file meet.
pub(super) const WHERE_BODIES_MEET: Rung = Rung {
    name: "unite",
    kind: Kind::Union,
    applies: |climb, situation| Ok(climb.has_contacts() && may_unite(climb, situation)),
    tries: |climb, situation| unite(climb, situation),
};

/// Where they do not, after all that moves no triangle through another.
pub(super) const BEFORE_TRIANGLES_GO: Rung = Rung {
    name: "unite-what-mending-made",
    kind: Kind::Union,
    applies: |climb, situation| Ok(may_unite(climb, situation)),
    tries: |climb, situation| unite(climb, situation),
};

/// How often what does not hold in float32 is rounded in places, before all is.
const ROUNDINGS_MAX: u32 = 4;

/// One kind of bodies may take one of so many parts of the work that is left.
const KIND_PART: u64 = 3;

/// What uniting bodies led to.
pub(in crate::pipeline) enum Tried {
    Certified(Box<(Attempt, Candidate)>),
    /// A solid as f64 alone.
    SolidInF64,
    Nothing,
}

/// True unless it was tried, or what becomes of bodies that meet was chosen.
fn may_unite(climb: &Climb<'_>, situation: &Situation) -> bool {
    let choices = climb.choices;
    !situation.has_tried_uniting
        && choices.unites
        && choices.nesting == Policy::AsOriented
        && choices.shells.is_empty()
}

/// The bodies that pass through each other as one, if that leads to certified bytes: as they are drawn, as the steps of the
/// last plan mend them, or with walls. The first that loses little, or else the one that loses least.
fn unite(climb: &Climb<'_>, situation: &mut Situation) -> Result<Option<Found>, Failure> {
    situation.has_tried_uniting = true;
    // A wall behind a sheet without two sides changes sides somewhere; the lattice gives it both.
    if climb.has_found(DefectCode::NonOrientable) && climb.reads_as_sheets()? {
        return Ok(None);
    }
    let limits = &climb.options.limits;
    let mut best: Option<Certified> = None;
    for uniting in climb.kinds()? {
        // What takes too much work is left to the next kind.
        let tried =
            climb.budget.within_part(KIND_PART, || climb.united_from(uniting, situation.variant))?.flatten();
        let Some((attempt, candidate)) = tried else { continue };
        let certified = Certified::measured(attempt, candidate, climb)?;
        let passes = certified.fidelity.passes(limits);
        if best.as_ref().is_none_or(|best| passes || !best.fidelity.is_no_worse(&certified.fidelity, limits))
        {
            best = Some(certified);
        }
        if passes {
            break;
        }
    }
    Ok(best.map(|best| Found::Certified(Box::new(best))))
}

impl Climb<'_> {
    /// The kinds of bodies to try, in their order. Where no solid is required, nothing is invented to make one.
    fn kinds(&self) -> Result<Vec<Uniting>, Stopped> {
        let mut kinds = vec![Uniting::AsDrawn];
        if self.options.require == Some(Require::None) {
            return Ok(kinds);
        }
        let walls = self.choices.walls;
        let is_sheets = walls == Walls::First || self.reads_as_sheets()?;
        let may_wall = walls != Walls::Never && self.options.wrap.open_shells != OpenShells::Close;
        let mut walled = Vec::new();
        walled.extend(is_sheets.then_some(Uniting::Thickened));
        walled.extend(may_wall.then_some(Uniting::Walled));
        let mut filled = Vec::new();
        if walls != Walls::First {
            filled.push(Uniting::Mended);
            filled.extend(self.choices.fills_all_holes().then_some(Uniting::Spanned));
        }
        kinds.extend(if is_sheets { [walled, filled].concat() } else { [filled, walled].concat() });
        Ok(kinds)
    }

    /// One kind of bodies as one. Coordinates become float32 first where only those of the result do not hold.
    fn united_from(
        &self,
        uniting: Uniting,
        variant: Variant,
    ) -> Result<Option<(Attempt, Candidate)>, Failure> {
        match self.try_uniting(uniting, variant)? {
            Tried::Certified(found) => Ok(Some(*found)),
            Tried::SolidInF64 if self.choices.rounds && !variant.rounds && !self.input.soup.is_f32_exact => {
                match self.try_uniting(uniting, Variant { rounds: true, ..variant })? {
                    Tried::Certified(found) => Ok(Some(*found)),
                    _ => Ok(None),
                }
            }
            _ => Ok(None),
        }
    }

    /// Unites the bodies, and where the result touches itself, joins or parts that.
    fn try_uniting(&self, uniting: Uniting, variant: Variant) -> Result<Tried, Failure> {
        let steps = variant.uniting(uniting, self.choices);
        let mut attempt = Attempt::start(&self.input.soup, self.before);
        let _charge = self.budget.charge(2 * attempt.draft.bytes())?;
        self.go_on(&mut attempt, &steps)?;
        if !attempt.has_united() {
            return Ok(Tried::Nothing);
        }
        self.settled(attempt)
    }

    /// Goes on with united bodies until their bytes are certified; where nothing helps, from coarser places of what touches itself.
    pub(in crate::pipeline) fn settled(&self, united: Attempt) -> Result<Tried, Failure> {
        let _charge = self.budget.charge(2 * united.draft.bytes())?;
        let settling = Variant::settling(self.options.contact, self.choices);
        let mut last = united.clone();
        let mut tried = self.settled_by(&settling, &mut last)?;
        for steps in Variant::coarsening() {
            if !matches!(tried, Tried::Nothing) || !self.choices.rounds {
                break;
            }
            let mut attempt = united.clone();
            self.go_on(&mut attempt, &steps)?;
            if attempt.draft != united.draft {
                tried = self.settled_by(&settling, &mut attempt)?;
            }
        }
        match tried {
            Tried::Nothing => self.settled_by(&Variant::boring(), &mut last),
            tried => Ok(tried),
        }
    }

    /// Rounds where it matters, and runs these steps until the bytes are certified.
    fn settled_by(&self, tries: &[Vec<Step>], attempt: &mut Attempt) -> Result<Tried, Failure> {
        let mut roundings = ROUNDINGS_MAX;
        let mut tries = tries.iter();
        loop {
            let judged = self.judge(attempt)?;
            if judged.fails_in_f32() {
                if !self.choices.rounds || roundings == 0 {
                    return Ok(Tried::SolidInF64);
                }
                roundings -= 1;
                self.go_on(attempt, &[Step::RoundWhereItMatters, Step::Unite])?;
                continue;
            }
            match judged {
                Judged::Certified(candidate) => {
                    return Ok(Tried::Certified(Box::new((attempt.clone(), *candidate))));
                }
                Judged::Not(Refusal::NotRepairable { .. }) => {}
                Judged::Not(_) => return Ok(Tried::Nothing),
            }
            let Some(steps) = tries.next() else { return Ok(Tried::Nothing) };
            self.go_on(attempt, steps)?;
        }
    }
}
