//! An upper bound of the distance of every point of a piece of a triangle from a surface.
//!
//! Three facts are used. The distance from a surface changes by at most as much as the point moves, and no point of a
//! triangle is farther from all its corners than `1 / sqrt(3)` of the longest edge (Jung's theorem for acute triangles,
//! half the longest edge for others). The distance from a surface is at most that from one of its triangles. And the
//! distance from one triangle, a convex set, is a convex function, so over a convex piece it is largest at a corner.
//!
//! ```text
//!          p0             Where the corners are closest to different triangles T0, T1, T2, the piece is cut where the
//!         /  \            distances from two of them are about the same, and each part is bounded by its own triangle:
//!       x01   x02         any cut gives a bound, a good cut a tight one.
//!       /  \ /  \
//!      /    m    \
//!    p1----x12----p2
//! ```

use crate::geom::DVec3;
use crate::spatial::NearestSearch;

/// A corner of a piece, and what is closest to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) place: DVec3,
    /// Triangle of the other surface.
    pub(super) closest_triangle: u32,
    pub(super) distance: f64,
}

/// Steps to find where the distances from two triangles are the same.
const CUT_STEPS: usize = 3;

/// No point of the piece is farther from the surface than this, up to the rounding of `to`. Ends early with a bound that
/// is not larger than `enough`.
pub(super) fn upper_bound(to: &NearestSearch<'_>, piece: &[Corner; 3], enough: f64) -> f64 {
    let [p, q, r] = piece;
    let largest = p.distance.max(q.distance).max(r.distance);
    let longest = p.place.distance(q.place).max(q.place.distance(r.place)).max(r.place.distance(p.place));
    let by_size = largest + longest * 0.577_350_27;
    if by_size <= enough {
        return by_size;
    }
    let by_cut = match [p, q, r].map(|corner| corner.closest_triangle) {
        [a, b, c] if a == b && b == c => largest,
        [a, b, _] if a == b => cut_once(to, r, [p, q], enough),
        [_, b, c] if b == c => cut_once(to, p, [q, r], enough),
        [a, _, c] if a == c => cut_once(to, q, [r, p], enough),
        _ => cut_thrice(to, piece, enough),
    };
    by_size.min(by_cut.max(largest))
}

/// One corner is closest to another triangle than both others.
fn cut_once(to: &NearestSearch<'_>, lone: &Corner, others: [&Corner; 2], enough: f64) -> f64 {
    others.into_iter().map(|other| cut(to, lone, other, enough).1).fold(0.0, f64::max)
}

/// All corners are closest to different triangles.
fn cut_thrice(to: &NearestSearch<'_>, [p, q, r]: &[Corner; 3], enough: f64) -> f64 {
    let cuts = [(p, q), (q, r), (r, p)].map(|(a, b)| cut(to, a, b, enough));
    let middle = (cuts[0].0 + cuts[1].0 + cuts[2].0) / 3.0;
    let at_middle = [p, q, r].map(|corner| to.on_triangle(middle, corner.closest_triangle).distance);
    at_middle.into_iter().chain(cuts.map(|(_, bound)| bound)).fold(0.0, f64::max)
}

/// A point of the edge about as far from one corner's triangle as from the other's, and the larger of both distances.
fn cut(to: &NearestSearch<'_>, from: &Corner, other: &Corner, enough: f64) -> (DVec3, f64) {
    let at = |share: f64| {
        let place = from.place + (other.place - from.place) * share;
        let distances = [from, other].map(|c| to.on_triangle(place, c.closest_triangle).distance);
        (place, distances[0] - distances[1], distances[0].max(distances[1]))
    };
    let (mut low, mut high) = (0.0, 1.0);
    let mut excess_low = from.distance - to.on_triangle(from.place, other.closest_triangle).distance;
    let mut excess_high = to.on_triangle(other.place, from.closest_triangle).distance - other.distance;
    let mut best = (from.place, f64::INFINITY);
    for _ in 0..CUT_STEPS {
        let width = excess_high - excess_low;
        let share = if width > 0.0 { low - (high - low) * (excess_low / width) } else { (low + high) / 2.0 };
        let share = share.clamp(low, high);
        let (place, excess, bound) = at(share);
        if bound < best.1 {
            best = (place, bound);
        }
        if best.1 <= enough {
            break;
        }
        if excess < 0.0 {
            (low, excess_low) = (share, excess);
        } else {
            (high, excess_high) = (share, excess);
        }
    }
    best
}
