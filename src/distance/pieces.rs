//! Pieces of triangles that may hold the farthest point, cut smaller until they do not.

use super::bound::{Corner, upper_bound};
use super::target::Target;
use super::view::{View, Visible};
use super::{FarPoint, Look};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::spatial::Nearest;

/// A part of a triangle and the largest distance that a point of it can have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) corners: [Corner; 3],
    pub(super) triangle: u32,
    pub(super) upper: f64,
}

/// The farthest point known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Farthest {
    pub(super) distance: f64,
    pub(super) point: FarPoint,
}

impl Farthest {
    /// Farther than nothing, so that the first point replaces it.
    pub(super) const NONE: Self = Self {
        distance: f64::NEG_INFINITY,
        point: FarPoint { place: DVec3::ZERO, triangle: 0, closest: DVec3::ZERO, closest_triangle: 0 },
    };

    pub(super) fn at(place: DVec3, triangle: u32, nearest: &Nearest) -> Self {
        let (closest, closest_triangle) = (nearest.point, nearest.triangle);
        Self { distance: nearest.distance, point: FarPoint { place, triangle, closest, closest_triangle } }
    }

    /// A place on a triangle that can be seen, if it is farther than this. The search for what is closest begins at `hint`.
    pub(super) fn or_seen(
        self,
        to: &Target<'_>,
        place: DVec3,
        triangle: u32,
        hint: u32,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let found = to.find(place, Some(hint), budget)?.filter(|found| found.is_exact);
        Ok(found.map_or(self, |found| self.or(Self::at(place, triangle, &found.nearest))))
    }

    /// The farther one, or this one when both are as far.
    pub(super) fn or(self, other: Self) -> Self {
        if other.distance > self.distance { other } else { self }
    }
}

/// The bounds that end a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tolerance {
    pub(super) relative: f64,
    pub(super) absolute: f64,
}

impl Tolerance {
    /// Pieces that stay below this cannot raise the distance by more than the tolerance.
    pub(super) fn enough(self, lower: f64) -> f64 {
        lower + (lower * self.relative).max(self.absolute)
    }
}

/// What a piece turned out to hold.
#[derive(Debug, Clone)]
pub(super) struct Refined {
    pub(super) farthest: Farthest,
    /// Largest upper bound among the pieces that were put aside.
    pub(super) upper: f64,
    /// Pieces that were not looked at.
    pub(super) left: Vec<Piece>,
    /// Closest points that were found, and triangles that were walked over in the place of some.
    pub(super) work: u64,
}

/// Work on a piece before what is left of it is handed back.
pub(super) const WORK_MAX: u64 = 48;

/// Cuts `piece` until no part can be farther than the tolerance beyond the farthest point, or the work is used up.
pub(super) fn refine(
    to: &Target<'_>,
    view: &View<'_>,
    look: &mut Option<Look<'_>>,
    piece: Piece,
    farthest: Farthest,
    tolerance: Tolerance,
    budget: &Budget,
) -> Result<Refined, Stopped> {
    let mut refined = Refined { farthest, upper: 0.0, left: vec![piece], work: 0 };
    while refined.work < WORK_MAX {
        let Some(piece) = refined.left.pop() else { break };
        if piece.upper <= tolerance.enough(refined.farthest.distance) {
            refined.upper = refined.upper.max(piece.upper);
        } else {
            split(to, view, look, &piece, &mut refined, tolerance, budget)?;
        }
    }
    Ok(refined)
}

/// Cuts a piece at the middles of its edges in four.
fn split(
    to: &Target<'_>,
    view: &View<'_>,
    look: &mut Option<Look<'_>>,
    piece: &Piece,
    refined: &mut Refined,
    tolerance: Tolerance,
    budget: &Budget,
) -> Result<(), Stopped> {
    let [p, q, r] = piece.corners;
    let mut middle = |a: Corner, b: Corner| {
        let place = (a.place + b.place) / 2.0;
        refined.work += 1;
        let Some(found) = to.find(place, Some(a.closest_triangle), budget)? else { return Ok(a) };
        let nearest = found.nearest;
        let is_farther = found.is_exact && nearest.distance > refined.farthest.distance;
        if is_farther && view.counts(look, place, piece.triangle)? {
            refined.farthest = Farthest::at(place, piece.triangle, &nearest);
        }
        Ok(Corner { place, closest_triangle: nearest.triangle, distance: nearest.distance })
    };
    let (pq, qr, rp) = (middle(p, q)?, middle(q, r)?, middle(r, p)?);
    let enough = tolerance.enough(refined.farthest.distance);
    for corners in [[p, pq, rp], [pq, q, qr], [rp, qr, r], [qr, rp, pq]] {
        let mut upper = upper_bound(&to.near, &corners, enough).min(piece.upper);
        if upper > enough {
            let (covered, walked) = covered(to, &corners, upper);
            refined.work += walked / WALKED_FOR_ONE;
            upper = covered;
        }
        if upper > enough {
            match view.visible(look, &corners, piece.triangle)? {
                Visible::Nothing => continue,
                Visible::At(place) => {
                    refined.work += 1;
                    let hint = corners[0].closest_triangle;
                    refined.farthest = refined.farthest.or_seen(to, place, piece.triangle, hint, budget)?;
                }
                Visible::All => {}
            }
        }
        refined.left.push(Piece { corners, upper, ..*piece });
    }
    Ok(())
}

/// Triangles that are walked over in the time that it takes to find a closest point.
const WALKED_FOR_ONE: u64 = 4;

/// The bound of what covers a piece, if it is less than `upper`, and the triangles that were walked over. The walk starts
/// where a corner is closest, the farthest corner first, and looks along the way from there.
fn covered(to: &Target<'_>, piece: &[Corner; 3], upper: f64) -> (f64, u64) {
    let mut corners = *piece;
    corners.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    let along = to.near.on_triangle(corners[0].place, corners[0].closest_triangle).point - corners[0].place;
    let mut walked = 0;
    for (i, corner) in corners.iter().enumerate() {
        if corners[..i].iter().any(|before| before.closest_triangle == corner.closest_triangle) {
            continue;
        }
        let (bound, more) = to.cloth.bound(piece, along, corner.closest_triangle, upper);
        walked += more;
        if let Some(bound) = bound {
            return (bound.min(upper), walked);
        }
    }
    (upper, walked)
}
