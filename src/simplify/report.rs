//! What a run did and what it did not.

use super::options::Target;
use crate::mesh::corner_table::LinkRefusal;

/// Why a collapse was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SimplifyRefusal {
    /// The surface would change its topology or be no simplicial complex.
    Link(LinkRefusal),
    /// Both ends are held: by borders, creases, borders between groups, or by their position.
    Held,
    /// The normal of a face would turn too far.
    NormalTurns,
    /// A face would be exactly degenerate.
    Degenerate,
    /// A face would be too thin.
    Aspect,
    /// A face would leave the envelope.
    Envelope,
    /// The error would exceed the target's.
    Error,
    /// The cost or the position is not a finite number.
    NotFinite,
    /// A face would meet another (guarded mode). Where only coordinates rounded to f32 do, what was merged is taken back,
    /// and counted by vertices.
    SelfIntersection,
    /// The surface would pass through a part of itself or another shell, though it would meet nothing after (guarded
    /// mode).
    Swept,
    /// A closed shell was inside out or had others around it, so what was merged here was taken back (guarded mode;
    /// counted by vertices).
    Nesting,
}

impl SimplifyRefusal {
    /// Every reason, in the order of the report.
    pub const ALL: [Self; 15] = [
        Self::Link(LinkRefusal::InnerEdgeBetweenBoundaries),
        Self::Link(LinkRefusal::CommonNeighbour),
        Self::Link(LinkRefusal::Ear),
        Self::Link(LinkRefusal::Tetrahedron),
        Self::Link(LinkRefusal::DoubleFace),
        Self::Held,
        Self::NormalTurns,
        Self::Degenerate,
        Self::Aspect,
        Self::Envelope,
        Self::Error,
        Self::NotFinite,
        Self::SelfIntersection,
        Self::Swept,
        Self::Nesting,
    ];

    /// The reason's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Link(LinkRefusal::InnerEdgeBetweenBoundaries) => "inner_edge_between_boundaries",
            Self::Link(LinkRefusal::CommonNeighbour) => "common_neighbour",
            Self::Link(LinkRefusal::Ear) => "ear",
            Self::Link(LinkRefusal::Tetrahedron) => "tetrahedron",
            Self::Link(LinkRefusal::DoubleFace) => "double_face",
            Self::Held => "held",
            Self::NormalTurns => "normal_turns",
            Self::Degenerate => "degenerate",
            Self::Aspect => "aspect",
            Self::Envelope => "envelope",
            Self::Error => "error",
            Self::NotFinite => "not_finite",
            Self::SelfIntersection => "self_intersection",
            Self::Swept => "swept",
            Self::Nesting => "nesting",
        }
    }

    fn index(self) -> usize {
        match self {
            Self::Link(LinkRefusal::InnerEdgeBetweenBoundaries) => 0,
            Self::Link(LinkRefusal::CommonNeighbour) => 1,
            Self::Link(LinkRefusal::Ear) => 2,
            Self::Link(LinkRefusal::Tetrahedron) => 3,
            Self::Link(LinkRefusal::DoubleFace) => 4,
            Self::Held => 5,
            Self::NormalTurns => 6,
            Self::Degenerate => 7,
            Self::Aspect => 8,
            Self::Envelope => 9,
            Self::Error => 10,
            Self::NotFinite => 11,
            Self::SelfIntersection => 12,
            Self::Swept => 13,
            Self::Nesting => 14,
        }
    }
}

/// How often each reason refused a collapse; an edge that is tried again and refused again counts again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Refusals([u64; SimplifyRefusal::ALL.len()]);

impl Refusals {
    /// Counts one more.
    #[inline]
    pub fn add(&mut self, reason: SimplifyRefusal) {
        self.0[reason.index()] += 1;
    }

    /// Counts `times` more.
    pub fn add_times(&mut self, reason: SimplifyRefusal, times: u64) {
        self.0[reason.index()] += times;
    }

    /// Counts all of `other` too.
    pub fn add_all(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(sum, more)| *sum += more);
    }

    /// How often for this reason.
    pub fn count(&self, reason: SimplifyRefusal) -> u64 {
        self.0[reason.index()]
    }

    /// How often for any reason.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }
}

/// The state of a run at one of its targets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TargetReport {
    /// The target.
    pub target: Target,
    /// False when no more collapses were possible before it was reached.
    pub is_reached: bool,
    /// Faces at the start.
    pub faces_before: usize,
    /// Faces now.
    pub faces_after: usize,
    /// Collapses so far.
    pub collapses: u64,
    /// Collapses refused so far.
    pub refusals: Refusals,
    /// The largest error of a collapse so far, by the criterion's own measure, in the unit of the coordinates.
    pub error_max: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_has_its_own_name_and_count() {
        let mut refusals = Refusals::default();
        for (i, reason) in SimplifyRefusal::ALL.into_iter().enumerate() {
            (0..=i).for_each(|_| refusals.add(reason));
        }
        for (i, reason) in SimplifyRefusal::ALL.into_iter().enumerate() {
            assert_eq!(refusals.count(reason), i as u64 + 1);
            assert_eq!(SimplifyRefusal::ALL.iter().filter(|r| r.name() == reason.name()).count(), 1);
        }
        assert_eq!(refusals.total(), 120);
    }
}
