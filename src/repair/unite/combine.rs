//! Set operations on solids: one exact arrangement of all of them, and of its cells those that the operation keeps by the winding
//! numbers there. A place is in a solid where its surface winds around it at least once.

use super::{arranged_by, placed, replace};
use crate::arrangement::{Arrangement, ArrangementError};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::signed_volume;
use crate::repair::{Changes, Draft};

/// What becomes of several solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SetOperation {
    /// What is in any of them.
    #[default]
    Union,
    /// What is in all of them.
    Intersection,
    /// What is in the first and in no other.
    Difference,
}

/// Why triangles are no solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotSolid {
    /// Along so many edges, after division, they do not balance.
    Open {
        /// Number of such edges.
        edges: u64,
    },
    /// Somewhere the surface winds around a place the wrong way.
    InsideOut,
    /// There is no place inside.
    Flat,
}

/// Why there is no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotCombined {
    /// The budget stops the run.
    Stopped(Stopped),
    /// An input is no solid.
    NotSolid {
        /// Its place among the inputs, from 0.
        input: usize,
        /// Why.
        why: NotSolid,
    },
    /// Nothing is left.
    Empty,
    /// More pairs of triangles meet than are divided.
    TooManyPairs {
        /// How many meet at least.
        count: u64,
        /// How many may.
        limit: u64,
    },
    /// Triangles cross each other inside of others at more points than are found.
    TooManyCrossings {
        /// At how many they may.
        limit: u64,
    },
    /// Float32 does not go so far.
    BeyondFloat32,
    /// What must hold by construction does not: a fault of the arrangement.
    Fault(&'static str),
}

impl From<Stopped> for NotCombined {
    fn from(stopped: Stopped) -> Self {
        Self::Stopped(stopped)
    }
}

impl From<ArrangementError> for NotCombined {
    fn from(error: ArrangementError) -> Self {
        match error {
            ArrangementError::Stopped(stopped) => Self::Stopped(stopped),
            ArrangementError::TooManyPairs { count, limit } => Self::TooManyPairs { count, limit },
            ArrangementError::TooManyCrossings { limit } => Self::TooManyCrossings { limit },
            ArrangementError::NotClosed { operand, edges } => {
                Self::NotSolid { input: usize::from(operand), why: NotSolid::Open { edges } }
            }
            ArrangementError::NotFinite { .. } => Self::Fault("a corner has no finite position"),
            ArrangementError::Inconsistent(fault) => Self::Fault(fault),
        }
    }
}

impl SetOperation {
    /// Name in options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
        }
    }

    /// Whether a place with these winding numbers, one for each solid, stays.
    fn keeps(self, windings: &[i32]) -> bool {
        let is_in = |&winding: &i32| winding >= 1;
        match self {
            Self::Union => windings.iter().any(is_in),
            Self::Intersection => windings.iter().all(is_in),
            Self::Difference => windings
                .split_first()
                .is_some_and(|(first, others)| is_in(first) && !others.iter().any(is_in)),
        }
    }
}

/// Makes one solid of the inputs of which the triangles of `draft` are. `firsts`: the first triangle of the soup of each input,
/// ascending, at most 255. Inputs may overlap themselves, but each must be closed and nowhere inside out. Gives the volume before
/// the new vertices were rounded, too, in cubic units of the file.
///
/// # Errors
/// See [`NotCombined`]; the draft is then as it was.
pub fn combine(
    draft: &mut Draft,
    firsts: &[u32],
    operation: SetOperation,
    budget: &Budget,
) -> Result<(Changes, f64), NotCombined> {
    let origins = &draft.triangle_origin;
    let input_of =
        |t: u32| firsts.partition_point(|&first| first <= origins[t as usize]).saturating_sub(1) as u8;
    let arrangement = arranged_by(draft, firsts.len() as u8, input_of, budget)?;
    check_solid(&arrangement, firsts.len(), budget)?;
    let boundary = arrangement.boundary(|windings| operation.keeps(windings));
    if boundary.pieces.is_empty() {
        return Err(NotCombined::Empty);
    }
    budget.spend(boundary.pieces.len() as u64)?;
    let corners = boundary.pieces.iter().map(|piece| piece.corners.map(|p| arrangement.position(p)));
    let volume = signed_volume(corners);
    let placed = placed(draft, &arrangement, boundary, budget)?.ok_or(NotCombined::BeyondFloat32)?;
    drop(arrangement);
    Ok((replace(draft, placed), volume))
}

/// Every input must have an inside and no place with a negative winding number. Every cell has a piece beside it, so that looking at both
/// sides of all pieces is looking everywhere.
fn check_solid(arrangement: &Arrangement, inputs: usize, budget: &Budget) -> Result<(), NotCombined> {
    let mut range = vec![(0, 0); inputs];
    for piece in 0..arrangement.pieces().len() {
        if piece % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        for windings in arrangement.windings(piece) {
            for ((least, most), &winding) in range.iter_mut().zip(windings) {
                (*least, *most) = (winding.min(*least), winding.max(*most));
            }
        }
    }
    let broken = range.iter().enumerate().find_map(|(input, &(least, most))| match (least, most) {
        (..0, _) => Some(NotCombined::NotSolid { input, why: NotSolid::InsideOut }),
        (_, ..=0) => Some(NotCombined::NotSolid { input, why: NotSolid::Flat }),
        _ => None,
    });
    broken.map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::*;
    use crate::geom::DVec3;

    /// The volume of what cubes from these corners on become, each an input.
    fn volume(of: &[(DVec3, f64, bool)], operation: SetOperation) -> Result<f64, NotCombined> {
        let mut draft = cubes(of);
        let firsts: Vec<u32> = (0..of.len() as u32).map(|i| 12 * i).collect();
        combine(&mut draft, &firsts, operation, &Budget::unlimited())?;
        assert_eq!(draft.check(), Vec::<String>::new());
        Ok(volume_times_6(&draft) / 6.0)
    }

    #[test]
    fn cells_are_kept_by_the_winding_number_of_each_input() {
        let three =
            [(DVec3::ZERO, 4.0, false), (DVec3::splat(2.0), 4.0, false), (DVec3::splat(3.0), 1.0, false)];
        assert_eq!(volume(&three[..2], SetOperation::Union), Ok(128.0 - 8.0));
        assert_eq!(volume(&three[..2], SetOperation::Intersection), Ok(8.0));
        assert_eq!(volume(&three[..2], SetOperation::Difference), Ok(64.0 - 8.0));
        assert_eq!(volume(&three, SetOperation::Intersection), Ok(1.0));
        assert_eq!(volume(&three, SetOperation::Difference), Ok(64.0 - 8.0));
        assert_eq!(volume(&three, SetOperation::Union), Ok(128.0 - 8.0));
    }

    #[test]
    fn what_is_no_solid_is_named_and_an_empty_result_is_told() {
        let turned = [(DVec3::ZERO, 1.0, false), (DVec3::splat(3.0), 1.0, true)];
        let why = NotSolid::InsideOut;
        assert_eq!(volume(&turned, SetOperation::Union), Err(NotCombined::NotSolid { input: 1, why }));
        let apart = [(DVec3::ZERO, 1.0, false), (DVec3::splat(3.0), 1.0, false)];
        assert_eq!(volume(&apart, SetOperation::Intersection), Err(NotCombined::Empty));
        let equal = [apart[0], apart[0]];
        assert_eq!(volume(&equal, SetOperation::Difference), Err(NotCombined::Empty));
        let mut open = cubes(&apart);
        open.triangles.pop();
        open.triangle_origin.pop();
        let before = open.clone();
        let broken = combine(&mut open, &[0, 12], SetOperation::Union, &Budget::unlimited());
        let why = NotSolid::Open { edges: 3 };
        assert_eq!(broken, Err(NotCombined::NotSolid { input: 1, why }));
        assert_eq!(open, before);
        // A triangle and its copy turned around bound nothing.
        let mut flat = cubes(&apart[..1]);
        flat.triangles.extend([[0, 1, 2], [0, 2, 1]]);
        flat.triangle_origin.extend([12, 13]);
        let broken = combine(&mut flat, &[0, 12], SetOperation::Union, &Budget::unlimited());
        assert_eq!(broken, Err(NotCombined::NotSolid { input: 1, why: NotSolid::Flat }));
    }
}
