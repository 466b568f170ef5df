//! Pieces of triangles that may hold the farthest point, cut smaller until they do not.

use super::bound::{Corner, upper_bound};
use super::target::DistanceTarget;
use super::view::{ScaledSight, VisiblePart};
use super::{FarPoint, VisibilitySearch};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::spatial::Nearest;

/// A part of a triangle and the largest distance that a point of it can have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) corners: [Corner; 3],
    pub(super) triangle: u32,
    pub(super) upper: f64,
    /// Whether something of it is known to count.
    pub(super) is_seen: bool,
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
        to: &DistanceTarget<'_>,
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

/// A piece with an edge so many times as long as another one is cut in two: in four it would stay as thin.
const LONG: f64 = 1.5;

/// How pieces are cut.
pub(super) struct Refining<'r, 'v> {
    pub(super) to: &'r DistanceTarget<'r>,
    pub(super) view: &'r ScaledSight<'v>,
    pub(super) tolerance: Tolerance,
    /// Bound at which a piece can wait until others are no farther.
    pub(super) goal: f64,
    pub(super) budget: &'r Budget,
}

impl Refining<'_, '_> {
    /// Cuts `piece`, always that part which may be farthest, until none can be farther than the goal and the tolerance beyond the
    /// farthest point, or the work is used up.
    pub(super) fn refine(
        &self,
        look: &mut Option<VisibilitySearch<'_>>,
        piece: Piece,
        farthest: Farthest,
    ) -> Result<Refined, Stopped> {
        let mut refined = Refined { farthest, upper: 0.0, left: vec![piece], work: 0 };
        while refined.work < WORK_MAX {
            let by_bound = |a: &(usize, &Piece), b: &(usize, &Piece)| a.1.upper.total_cmp(&b.1.upper);
            let Some((n, &piece)) = refined.left.iter().enumerate().max_by(by_bound) else { break };
            if piece.upper <= self.tolerance.enough(refined.farthest.distance).max(self.goal) {
                break;
            }
            refined.left.swap_remove(n);
            if piece.is_seen {
                self.split(look, &piece, &mut refined)?;
            } else {
                self.ask(look, piece, &mut refined)?;
            }
        }
        let enough = self.tolerance.enough(refined.farthest.distance);
        let (left, aside): (Vec<Piece>, Vec<Piece>) =
            refined.left.into_iter().partition(|piece| piece.upper > enough);
        let upper = aside.into_iter().map(|piece| piece.upper).fold(0.0, f64::max);
        Ok(Refined { left, upper, ..refined })
    }

    /// Leaves a piece out when nothing of it can be seen. Asking takes long: a piece is asked about only when it is to be cut.
    fn ask(
        &self,
        look: &mut Option<VisibilitySearch<'_>>,
        piece: Piece,
        refined: &mut Refined,
    ) -> Result<(), Stopped> {
        match self.view.visible(look, &piece.corners, piece.triangle)? {
            VisiblePart::Nothing => return Ok(()),
            VisiblePart::At(place) => {
                refined.work += 1;
                let hint = piece.corners[0].closest_triangle;
                refined.farthest =
                    refined.farthest.or_seen(self.to, place, piece.triangle, hint, self.budget)?;
            }
            VisiblePart::All => {}
        }
        refined.left.push(Piece { is_seen: true, ..piece });
        Ok(())
    }

    /// Cuts a piece at the middles of its edges in four, a long one at the middle of its longest edge in two.
    fn split(
        &self,
        look: &mut Option<VisibilitySearch<'_>>,
        piece: &Piece,
        refined: &mut Refined,
    ) -> Result<(), Stopped> {
        let Self { to, budget, .. } = *self;
        let mut middle = |a: Corner, b: Corner| {
            let place = (a.place + b.place) / 2.0;
            refined.work += 1;
            let Some(found) = to.find(place, Some(a.closest_triangle), budget)? else { return Ok(a) };
            let nearest = found.nearest;
            let is_farther = found.is_exact && nearest.distance > refined.farthest.distance;
            if is_farther && self.view.counts(look, place, piece.triangle)? {
                refined.farthest = Farthest::at(place, piece.triangle, &nearest);
            }
            Ok(Corner { place, closest_triangle: nearest.triangle, distance: nearest.distance })
        };
        let ([p, q, r], is_long) = longest_edge_first(piece.corners);
        let pq = middle(p, q)?;
        let parts: &[[Corner; 3]] = if is_long {
            &[[p, pq, r], [pq, q, r]]
        } else {
            let (qr, rp) = (middle(q, r)?, middle(r, p)?);
            &[[p, pq, rp], [pq, q, qr], [rp, qr, r], [qr, rp, pq]]
        };
        let enough = self.tolerance.enough(refined.farthest.distance);
        for &corners in parts {
            let mut upper = upper_bound(&to.near, &corners, enough).min(piece.upper);
            if upper > enough {
                let (covered, walked) = covered(to, &corners, upper);
                refined.work += walked / WALKED_FOR_ONE;
                upper = covered;
            }
            refined.left.push(Piece { corners, upper, is_seen: false, ..*piece });
        }
        Ok(())
    }
}

/// The corners, turned so that the first two are the ends of the longest edge, and whether that is long.
fn longest_edge_first(corners: [Corner; 3]) -> ([Corner; 3], bool) {
    let [p, q, r] = corners.map(|corner| corner.place);
    let lengths = [p.distance(q), q.distance(r), r.distance(p)];
    let (longest, shortest) =
        (lengths.into_iter().fold(0.0, f64::max), lengths.into_iter().fold(f64::MAX, f64::min));
    let mut turned = corners;
    turned.rotate_left(lengths.iter().position(|&length| length == longest).unwrap_or(0));
    (turned, longest > LONG * shortest)
}

/// Triangles that are walked over in the time that it takes to find a closest point.
const WALKED_FOR_ONE: u64 = 4;

/// The bound of what covers a piece, if it is less than `upper`, and the triangles that were walked over. The walk starts
/// where a corner is closest, the farthest corner first, and looks along the way from there.
fn covered(to: &DistanceTarget<'_>, piece: &[Corner; 3], upper: f64) -> (f64, u64) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::{DistanceOptions, Surface, directed_distance};

    /// The directed distance from a triangle to the ground, of what is no higher than `seen_below`, with so many refinements.
    fn from_ground(corners: &[DVec3; 3], seen_below: f64, refinements_max: u64) -> [f64; 2] {
        let ground = [[-100.0, -100.0], [200.0, -100.0], [-100.0, 200.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let look = || -> VisibilitySearch<'_> {
            Box::new(move |mut places, _| Ok(Iterator::find(&mut places, |place| place.z <= seen_below)))
        };
        let options = DistanceOptions { samples: 0, refinements_max, ..DistanceOptions::default() };
        let [from, to] = [corners, &ground].map(|positions| Surface { positions, triangles: &[[0, 1, 2]] });
        let budget = Budget::unlimited();
        let found = directed_distance(from, to, Some(&look), &options, &budget).unwrap().unwrap();
        [found.lower, found.upper]
    }

    #[test]
    fn what_may_be_farthest_is_cut_first() {
        let rising = [DVec3::ZERO, DVec3::new(9.0, 0.0, 9.0), DVec3::new(0.0, 9.0, 9.0)];
        let [lower, upper] = from_ground(&rising, 2.0, 10);
        assert!(lower <= 2.0 && (2.0..2.1).contains(&upper), "{lower} {upper}");
    }

    #[test]
    fn a_long_piece_is_cut_in_two() {
        let sliver = [DVec3::ZERO, DVec3::new(9.0, 0.0, 9.0), DVec3::new(0.0, 0.1, 0.0)];
        let [lower, upper] = from_ground(&sliver, 2.0, 48);
        assert!(lower <= 2.0 && (2.0..2.1).contains(&upper), "{lower} {upper}");
    }

    #[test]
    fn the_longest_edge_of_a_piece_comes_first() {
        let corner =
            |x: f64, y: f64| Corner { place: DVec3::new(x, y, 0.0), closest_triangle: 0, distance: 0.0 };
        let [a, b, c] = [corner(0.0, 0.0), corner(0.0, 1.0), corner(2.0, 0.0)];
        for corners in [[a, b, c], [b, c, a], [c, a, b]] {
            let (turned, is_long) = longest_edge_first(corners);
            assert_eq!(turned.map(|corner| corner.place), [b, c, a].map(|corner| corner.place));
            assert!(is_long);
        }
        assert!(!longest_edge_first([a, b, corner(1.0, 0.0)]).1);
        assert!(longest_edge_first([a, a, b]).1, "no area");
    }
}
