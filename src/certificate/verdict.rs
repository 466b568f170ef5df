//! What has been found so far, over all readings.

use super::{Condition, Depth, Reading, Violation, ViolationCounts};

const CONDITIONS: usize = Condition::Alternating as usize + 1;

const P0: [Condition; 6] = [
    Condition::Usable,
    Condition::NonDegenerate,
    Condition::Distinct,
    Condition::TwoTrianglesPerEdge,
    Condition::OppositeDirections,
    Condition::OneFanPerVertex,
];

/// Counts of every condition and the witnesses of those that are broken.
pub(super) struct ConditionCounts {
    /// Witnesses to keep of each condition.
    samples: usize,
    /// Whether the first violation ends the check.
    is_brief: bool,
    /// Largest count of each condition over the readings.
    most: [u64; CONDITIONS],
    /// Conditions that some reading left open.
    is_open: [bool; CONDITIONS],
    /// Some contacts were not counted.
    contacts_are_at_least: bool,
    pub(super) witnesses: Vec<Violation>,
    pub(super) readings: Vec<Reading>,
}

impl ConditionCounts {
    pub(super) fn new(depth: Depth) -> Self {
        let (samples, is_brief) = match depth {
            Depth::FirstViolation => (1, true),
            Depth::Count { samples } => (samples, false),
        };
        Self {
            samples,
            is_brief,
            most: [0; CONDITIONS],
            is_open: [false; CONDITIONS],
            contacts_are_at_least: false,
            witnesses: Vec::new(),
            readings: Vec::new(),
        }
    }

    /// Notes that `condition` is broken `count` times in the reading at hand. `witnesses` makes at most as many
    /// violations as it is asked for; it is not asked when an earlier reading gave some.
    pub(super) fn note(
        &mut self,
        condition: Condition,
        count: u64,
        witnesses: impl FnOnce(usize) -> Vec<Violation>,
    ) {
        let is_news = count > 0 && self.most[condition as usize] == 0 && !self.has_ended();
        if is_news && self.samples > 0 {
            self.witnesses.extend(witnesses(self.samples));
        }
        let most = &mut self.most[condition as usize];
        *most = count.max(*most);
    }

    /// Notes that there may be more contacts than are counted; some are.
    pub(super) fn leave_contacts_uncounted(&mut self) {
        self.contacts_are_at_least = true;
    }

    /// Notes that the reading at hand leaves `condition` open.
    pub(super) fn leave_open(&mut self, condition: Condition) {
        self.is_open[condition as usize] = true;
    }

    /// Witnesses to keep of each condition.
    pub(super) fn samples(&self) -> usize {
        self.samples
    }

    /// Whether the check is to end at its first violation.
    pub(super) fn is_brief(&self) -> bool {
        self.is_brief
    }

    /// Whether nothing more is to be found out.
    pub(super) fn has_ended(&self) -> bool {
        self.is_brief && self.most.iter().any(|&n| n > 0)
    }

    fn count(&self, condition: Condition) -> Option<u64> {
        let (most, is_open) = (self.most[condition as usize], self.is_open[condition as usize]);
        if most == 0 && is_open { None } else { Some(most) }
    }

    pub(super) fn p0(&self) -> bool {
        P0.into_iter().all(|condition| self.count(condition) == Some(0))
    }

    pub(super) fn p1(&self) -> Option<bool> {
        self.count(Condition::Embedded).map(|n| n == 0)
    }

    pub(super) fn p2(&self) -> Option<bool> {
        match [Condition::NotEmpty, Condition::Alternating].map(|condition| self.count(condition)) {
            [Some(0), Some(0)] => Some(true),
            [None | Some(0), None | Some(0)] => None,
            _ => Some(false),
        }
    }

    pub(super) fn is_valid(&self) -> bool {
        self.p0() && self.p1() == Some(true) && self.p2() == Some(true)
    }

    pub(super) fn counts(&self) -> ViolationCounts {
        ViolationCounts {
            unusable: self.count(Condition::Usable),
            degenerate: self.count(Condition::NonDegenerate),
            duplicate: self.count(Condition::Distinct),
            edges_without_two_triangles: self.count(Condition::TwoTrianglesPerEdge),
            edges_in_one_direction: self.count(Condition::OppositeDirections),
            singular_vertices: self.count(Condition::OneFanPerVertex),
            contacts: self.count(Condition::Embedded),
            contacts_are_at_least: self.contacts_are_at_least,
            misnested_shells: self.count(Condition::Alternating),
        }
    }
}

/// The counts of several parts as one: the sum of each, `None` where a part left it open and none found any.
pub(super) fn sum_of(parts: &[&ViolationCounts]) -> ViolationCounts {
    let sum = |of: fn(&ViolationCounts) -> Option<u64>| {
        let known: u64 = parts.iter().filter_map(|part| of(part)).sum();
        let is_open = parts.iter().any(|part| of(part).is_none());
        if known == 0 && is_open { None } else { Some(known) }
    };
    ViolationCounts {
        unusable: sum(|part| part.unusable),
        degenerate: sum(|part| part.degenerate),
        duplicate: sum(|part| part.duplicate),
        edges_without_two_triangles: sum(|part| part.edges_without_two_triangles),
        edges_in_one_direction: sum(|part| part.edges_in_one_direction),
        singular_vertices: sum(|part| part.singular_vertices),
        contacts: sum(|part| part.contacts),
        contacts_are_at_least: parts.iter().any(|part| part.contacts_are_at_least),
        misnested_shells: sum(|part| part.misnested_shells),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_left_open_in_one_reading_is_not_proved_by_another() {
        let mut verdict = ConditionCounts::new(Depth::Count { samples: 1 });
        verdict.note(Condition::NotEmpty, 0, |_| Vec::new());
        verdict.note(Condition::Alternating, 0, |_| Vec::new());
        assert_eq!(verdict.p2(), Some(true));
        verdict.leave_open(Condition::Alternating);
        assert_eq!(verdict.p2(), None);
        verdict.note(Condition::Alternating, 2, |_| Vec::new());
        assert_eq!(verdict.p2(), Some(false));
        assert_eq!(verdict.counts().misnested_shells, Some(2));
    }
}
