//! Bodies that pass through each other, as one: the exact arrangement in a search for a repair.

use super::fidelity::Fidelity;
use super::output::{Candidate, NoCandidate};
use super::plan::{Attempt, Step, Uniting, Variant};
use super::remedies::Walls;
use super::repair::{Search, fidelity_of, write};
use super::{Failure, Require};
use crate::analysis::DefectCode;
use crate::budget::{Stage, Stopped};
use crate::certificate::Depth;
use crate::repair::nest::Policy;
use crate::winding::OpenShells;

/// How often what does not hold in float32 is rounded in places, before all is.
const ROUNDINGS_MAX: u32 = 4;

/// A certified result of uniting bodies.
pub(super) struct United {
    pub(super) attempt: Attempt,
    pub(super) candidate: Candidate,
    pub(super) fidelity: Fidelity,
}

/// What uniting one kind of bodies led to.
enum Tried {
    Certified(Box<(Attempt, Candidate)>),
    /// A solid as f64 alone.
    SolidInF64,
    Nothing,
}

impl Search<'_> {
    /// True unless what becomes of bodies that meet was chosen.
    pub(super) fn may_unite(&self) -> bool {
        let choices = self.choices;
        choices.unites && choices.nesting == Policy::AsOriented && choices.shells.is_empty()
    }

    /// True unless it is known that no triangles meet others.
    pub(super) fn has_contacts(&self) -> bool {
        self.input.examination.contacts.as_ref().is_none_or(|contacts| contacts.count > 0)
    }

    /// The bodies that pass through each other as one, if that leads to certified bytes: as they are drawn, as the steps of
    /// `variant` mend them, or with walls. The first that loses little, or else the one that loses least.
    pub(super) fn united(&self, variant: Variant) -> Result<Option<United>, Failure> {
        // A wall behind a sheet without two sides changes sides somewhere; the lattice gives it both.
        if self.has_found(DefectCode::NonOrientable) && self.reads_as_sheets()? {
            return Ok(None);
        }
        let limits = &self.options.limits;
        let mut best: Option<United> = None;
        for uniting in self.kinds()? {
            let tried = self.budget.within_part(3, || self.united_from(uniting, variant))?;
            let Some((attempt, candidate)) = tried.flatten() else { continue };
            let fidelity = fidelity_of(&attempt, &candidate, self)?;
            let passes = fidelity.passes(limits);
            if best.as_ref().is_none_or(|best| passes || !best.fidelity.is_no_worse(&fidelity, limits)) {
                best = Some(United { attempt, candidate, fidelity });
            }
            if passes {
                break;
            }
        }
        Ok(best)
    }

    fn has_found(&self, code: DefectCode) -> bool {
        let findings = self.before.map_or(&[][..], |analysis| &analysis.findings);
        findings.iter().any(|finding| finding.code == code && finding.count > 0)
    }

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

    /// As [`Self::united`], from one kind of bodies. Coordinates become float32 first where only those of the result do not hold.
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
        let mut roundings = ROUNDINGS_MAX;
        let mut tries = Variant::settling(self.options.contact, self.choices).into_iter();
        loop {
            if attempt.draft.triangles.is_empty() {
                return Ok(Tried::Nothing);
            }
            let depth = Depth::FirstViolation;
            let candidate = match write(&attempt.draft, self.input, self.encoding, depth, self.budget) {
                Ok(candidate) => candidate,
                Err(NoCandidate::Refused(_)) => return Ok(Tried::Nothing),
                Err(NoCandidate::Failed(failure)) => return Err(failure),
            };
            if candidate.certificate().is_printable() {
                return Ok(Tried::Certified(Box::new((attempt, candidate))));
            }
            let witness = candidate.certificate().witnesses.first();
            if witness.is_some_and(|violation| violation.reading.is_f32) {
                if !self.choices.rounds || roundings == 0 {
                    return Ok(Tried::SolidInF64);
                }
                roundings -= 1;
                self.go_on(&mut attempt, &[Step::RoundWhereItMatters, Step::Unite])?;
                continue;
            }
            let Some(steps) = tries.next() else { return Ok(Tried::Nothing) };
            self.go_on(&mut attempt, &steps)?;
        }
    }

    fn go_on(&self, attempt: &mut Attempt, steps: &[Step]) -> Result<(), Stopped> {
        self.budget.stage(Stage::Repair, || attempt.run(steps, &self.input.soup, self.before, self.budget))
    }
}
