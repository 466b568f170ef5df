//! Bodies that pass through each other, as one: the exact arrangement.

use super::climb::{Certified, Climb, Judgement, Openness, RungResult, Situation};
use super::{Rung, RungKind};
use crate::analysis::DefectCode;
use crate::geom::{DVec3, print_pitch};
use crate::pipeline::output::Candidate;
use crate::pipeline::plan::{Attempt, Uniting, Variant};
use crate::pipeline::repair_choices::Walls;
use crate::pipeline::size::diagonal;
use crate::pipeline::step::Step;
use crate::pipeline::{Failure, Refusal, Require};
use crate::repair::nest::{NestOptions, NestingPolicy};
use crate::winding::OpenShells;

/// Where triangles of the file meet.
pub(super) const WHERE_BODIES_MEET: Rung = Rung {
    name: "unite",
    kind: RungKind::Union,
    applies: |climb, situation| Ok(climb.has_contacts() && may_unite(climb, situation)),
    tries: |climb, situation| unite(climb, situation),
};

/// Where they do not, after all that moves no triangle through another.
pub(super) const BEFORE_TRIANGLES_GO: Rung = Rung {
    name: "unite-what-mending-made",
    kind: RungKind::Union,
    applies: |climb, situation| Ok(may_unite(climb, situation)),
    tries: |climb, situation| unite(climb, situation),
};

/// How often what does not hold in float32 is rounded in places, before all is.
const ROUNDINGS_MAX: u32 = 4;

/// Steps of the coarser lattices that are tried, as shares of the diagonal: at the second, rounding moves a corner by no more than
/// 2^-14 of it.
const COARSER: [f64; 2] = [1.0 / (1u64 << 18) as f64, 1.0 / (1u64 << 14) as f64];

/// Contacts that may be left for large bodies to be bored.
const CONTACTS_MAX: u64 = 8;

/// What encloses something has at least so many triangles for each open edge: what spans many rims would hide what can be seen.
const TRIANGLES_PER_OPEN_EDGE: u64 = 20;

/// One kind of bodies may take one of so many parts of the work that is left.
const KIND_PART: u64 = 3;

/// Bodies of a closed surface may take all but one of so many parts of it.
const CLOSED_PART: u64 = 8;

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
        && choices.nesting != NestingPolicy::Alternate
        && choices.shells.is_empty()
}

/// The bodies that pass through each other as one, if that leads to certified bytes: as they are drawn, as the steps of the
/// last plan mend them, or with walls. The first that loses little, or else the one that loses least.
fn unite(climb: &Climb<'_>, situation: &mut Situation) -> Result<Option<RungResult>, Failure> {
    situation.has_tried_uniting = true;
    // A wall behind a sheet without two sides changes sides somewhere; the lattice gives it both.
    let openness = climb.openness(situation)?;
    if climb.has_found(DefectCode::NonOrientable) && openness.is_sheets {
        return Ok(None);
    }
    let is_closed = openness.boundary_edges == 0;
    let limits = &climb.options.limits;
    let mut best: Option<Certified> = None;
    for uniting in climb.kinds(openness) {
        // Parts that seem to bound a volume become walls only where patches over their openings cover much that is seen.
        let is_last_resort = uniting == Uniting::Thickened && !climb.reads_sheets(openness);
        if is_last_resort && !best.as_ref().is_some_and(|best| best.covers_much(limits)) {
            continue;
        }
        // What takes too much work is left to the next kind, but of a closed surface all kinds take as much. Walls as the last
        // resort may take more; the rest measures them.
        let united = || climb.united_from(uniting, situation.variant);
        let tried = match (is_closed, is_last_resort) {
            (true, _) => climb.budget.within_all_but(CLOSED_PART, united)?,
            (_, true) => climb.budget.within_all_but(KIND_PART, united)?,
            _ => climb.budget.within_part(KIND_PART, united)?,
        };
        if tried.is_none() && is_closed {
            break;
        }
        let Some((attempt, candidate)) = tried.flatten() else { continue };
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
    Ok(best.map(|best| RungResult::Certified(Box::new(best))))
}

impl Climb<'_> {
    /// Unites bodies where a certified result lost much without both of two copies of opposite direction. A wall between two cavities
    /// bounds nothing: a union knows what it leaves out, where the loss of it would have the surface rebuilt and the cavities filled.
    pub(super) fn with_union_if_closer(
        &self,
        closed: Box<Certified>,
        situation: &mut Situation,
    ) -> Result<Box<Certified>, Failure> {
        let limits = &self.options.limits;
        let has_lost = !closed.fidelity.passes(limits);
        if !has_lost || !closed.attempt.effects.cancelled_opposite_pairs || !may_unite(self, situation) {
            return Ok(closed);
        }
        match unite(self, situation)? {
            Some(RungResult::Certified(united)) if !closed.fidelity.is_no_worse(&united.fidelity, limits) => {
                Ok(united)
            }
            _ => Ok(closed),
        }
    }

    /// The kinds of bodies to try, in their order. Where no solid is required, nothing is invented to make one.
    fn kinds(&self, openness: Openness) -> Vec<Uniting> {
        let mut kinds = vec![Uniting::AsDrawn];
        if self.options.require == Some(Require::None) {
            return kinds;
        }
        let walls = self.choices.walls;
        let Openness { boundary_edges, triangles, .. } = openness;
        let is_sheets = self.reads_sheets(openness);
        let is_open = boundary_edges > triangles / TRIANGLES_PER_OPEN_EDGE;
        let may_wall = walls != Walls::Never && self.options.wrap.open_shells != OpenShells::Close;
        let mut walled = Vec::new();
        walled.extend(is_sheets.then_some(Uniting::Thickened));
        walled.extend(may_wall.then_some(Uniting::Walled));
        let mut filled = Vec::new();
        if walls != Walls::First {
            filled.push(Uniting::Mended);
            filled.extend(self.choices.fills_all_holes().then_some(Uniting::Spanned));
        }
        // Whichever way triangles turn: after all that goes by their directions, except that walls come last for what is no sheet.
        let encloses = walls != Walls::First && self.choices.fills_all_holes() && !is_open;
        let enclosed = |kind| encloses.then_some(kind);
        let by_direction = if is_sheets { [walled, filled].concat() } else { filled };
        kinds.extend(by_direction.into_iter().chain(enclosed(Uniting::Enclosed)));
        if !is_sheets {
            kinds.extend(may_wall.then_some(Uniting::Walled));
            kinds.extend((is_open && may_wall && walls != Walls::First).then_some(Uniting::Thickened));
        }
        kinds.extend(enclosed(Uniting::EnclosedAndWalled).filter(|_| may_wall));
        kinds
    }

    /// True when open parts are walls in the first place.
    fn reads_sheets(&self, openness: Openness) -> bool {
        self.choices.walls == Walls::First || openness.is_sheets
    }

    /// One kind of bodies as one. Coordinates become float32 first where only those of the result do not hold.
    fn united_from(
        &self,
        uniting: Uniting,
        variant: Variant,
    ) -> Result<Option<(Attempt, Candidate)>, Failure> {
        match self.settled(|coarse| self.united(uniting, Variant { coarse, ..variant }))? {
            Tried::Certified(found) => Ok(Some(*found)),
            Tried::SolidInF64 if self.choices.rounds && !variant.rounds && !self.input.soup.is_f32_exact => {
                let rounded = |coarse| self.united(uniting, Variant { rounds: true, coarse, ..variant });
                match self.settled(rounded)? {
                    Tried::Certified(found) => Ok(Some(*found)),
                    _ => Ok(None),
                }
            }
            _ => Ok(None),
        }
    }

    /// The bodies as one, if they can be united.
    fn united(&self, uniting: Uniting, variant: Variant) -> Result<Option<Attempt>, Failure> {
        let steps = variant.uniting(uniting, self.choices);
        let mut attempt = Attempt::start(&self.input.soup, self.before);
        let _charge = self.budget.charge(2 * attempt.draft.bytes())?;
        self.go_on(&mut attempt, &steps)?;
        Ok(attempt.has_united().then_some(attempt))
    }

    /// Settles united bodies, which are made with triangles that all but meet on ever coarser lattices (0: where they are), until
    /// that leads to certified bytes. What touches is bored a little each time, and more where nothing else helps.
    pub(in crate::pipeline) fn settled(
        &self,
        united: impl Fn(u32) -> Result<Option<Attempt>, Failure>,
    ) -> Result<Tried, Failure> {
        let mut unsettled = Vec::new();
        for coarse in [0].into_iter().chain(self.coarser_lattices()) {
            let Some(attempt) = united(coarse)? else { return Ok(Tried::Nothing) };
            let charge = self.budget.charge(2 * attempt.draft.bytes())?;
            let tries = [Variant::settling(self.options.contact, self.choices), Variant::boring_a_little()];
            match self.settle(attempt, tries.concat())? {
                Ok(tried) => return Ok(tried),
                Err(attempt) => unsettled.push((attempt, charge)),
            }
        }
        let is_hopeful = |attempt: &Attempt| {
            attempt.effects.bored_contacts.is_none_or(|contacts| contacts <= CONTACTS_MAX)
        };
        for (attempt, _charge) in unsettled.into_iter().filter(|(attempt, _)| is_hopeful(attempt)) {
            if let Ok(tried) = self.settle(*attempt, Variant::boring_more())? {
                return Ok(tried);
            }
        }
        Ok(Tried::Nothing)
    }

    /// The steps of lattices to which what all but meets may go, in steps of the print lattice.
    fn coarser_lattices(&self) -> Vec<u32> {
        let Some(pitch) = print_pitch(self.reach()).filter(|_| self.choices.rounds) else {
            return Vec::new();
        };
        let size = diagonal(&self.input.soup);
        let steps = |share: f64| libm::exp2(libm::log2(size * share / pitch).floor());
        COARSER
            .map(steps)
            .into_iter()
            .filter(|steps| (4.0..=65_536.0).contains(steps))
            .map(|steps| steps as u32)
            .collect()
    }

    /// Rounds where it matters, and runs these steps until the bytes are certified; the attempt where they never are.
    fn settle(
        &self,
        mut attempt: Attempt,
        tries: Vec<Vec<Step>>,
    ) -> Result<Result<Tried, Box<Attempt>>, Failure> {
        let mut roundings = ROUNDINGS_MAX;
        let mut tries = tries.into_iter();
        loop {
            if self.choices.nesting == NestingPolicy::Fill {
                let fill = NestOptions { policy: NestingPolicy::Fill, ..NestOptions::default() };
                self.go_on(&mut attempt, &[Step::Nest(fill)])?;
            }
            // What is known to meet, and is float32 already, needs no judgement.
            if attempt.effects.meeting_pairs == 0 || !is_float32(&attempt.draft.positions) {
                let judged = self.judge(&attempt)?;
                if judged.fails_in_f32() {
                    if !self.choices.rounds || roundings == 0 {
                        return Ok(Ok(Tried::SolidInF64));
                    }
                    roundings -= 1;
                    self.go_on(&mut attempt, &[Step::RoundWhereItMatters, Step::Unite])?;
                    continue;
                }
                match judged {
                    Judgement::Certified(candidate) => {
                        return Ok(Ok(Tried::Certified(Box::new((attempt, *candidate)))));
                    }
                    Judgement::Not(Refusal::NotRepairable { .. }) => {}
                    Judgement::Not(_) => return Ok(Ok(Tried::Nothing)),
                }
            }
            let Some(steps) = tries.next() else { return Ok(Err(Box::new(attempt))) };
            self.go_on(&mut attempt, &steps)?;
        }
    }
}

/// Whether no coordinate is rounded where all are written as float32.
fn is_float32(positions: &[DVec3]) -> bool {
    positions.iter().all(|p| p.as_vec3().as_dvec3() == *p)
}
