//! Which edges lie side by side, so that they may be one.

use crate::geom::DVec3;
use crate::mesh::triangle_of;

/// Two edges lie side by side only where their ends are closer than this share of both their lengths.
const SHARE_OF_EDGE: f64 = 0.125;

/// Cosine of the angle between two triangles below which they lie back to back, as the inside and the outside of a cup at its lip:
/// 20 degrees.
const BACK_TO_BACK: f64 = 0.94;

/// A vertex lies beside an edge only where its distance is at most this share of the heights of the triangles there.
const SHARE_OF_HEIGHT: f64 = 0.25;

/// Cosine of the angle between two edges up to which they go along each other: 30 degrees.
const ALONG: f64 = 0.866;

/// Edges that one, or a vertex, is compared with at most. Where more are as close, they do not say which belong together.
pub(super) const NEAR_MAX: usize = 256;

/// Which boundary edges may be joined.
#[derive(Debug, Clone, Copy)]
pub(super) struct JoinReach {
    /// Largest distance of ends.
    pub(super) epsilon: f64,
    /// Only edges that lie side by side, unless they coincide.
    pub(super) by_edge: bool,
}

/// A boundary edge from its first end to its second, and the third corner of its triangle.
pub(super) type Flank = [DVec3; 3];

impl JoinReach {
    /// How far from an end of an edge to look.
    pub(super) fn of_edge(self, [from, to]: [DVec3; 2]) -> f64 {
        if self.by_edge { self.epsilon.min(SHARE_OF_EDGE * from.distance(to)) } else { self.epsilon }
    }

    /// True when edges within reach of each other may be joined, the first end of one to the first of the other.
    pub(super) fn may_join(self, a: Flank, b: Flank) -> bool {
        !self.by_edge || (a[0] == b[0] && a[1] == b[1]) || lie_side_by_side(a, b)
    }
}

/// True when two edges are little apart for their lengths and their triangles do not lie back to back.
pub(super) fn lie_side_by_side(a: Flank, b: Flank) -> bool {
    let apart = a[0].distance(b[0]).max(a[1].distance(b[1]));
    let least = a[0].distance(a[1]).min(b[0].distance(b[1]));
    apart <= SHARE_OF_EDGE * least && inward(a).dot(inward(b)) < BACK_TO_BACK
}

/// The ends of a half-edge and the third corner of its triangle.
pub(super) fn flank_of(triangles: &[[u32; 3]], h: u32) -> [u32; 3] {
    let corners = triangles[triangle_of(h) as usize];
    [0, 1, 2].map(|k| corners[(h as usize + k) % 3])
}

/// How far from the inside of an edge a vertex is, where it lies beside it: at most `most` and little for the lengths and the
/// heights of the triangles, farther than `off_ends` from the ends, and with an edge of its own that goes along and whose triangle
/// does not lie back to back. `own`: the boundary edges at the vertex.
pub(super) fn vertex_beside(
    place: DVec3,
    own: &[Flank],
    edge: Flank,
    most: f64,
    off_ends: f64,
) -> Option<f64> {
    let [from, to, _] = edge;
    let along = (to - from).normalize_or_zero();
    let length = from.distance(to);
    let share = (place - from).dot(along);
    let apart = place.distance(from + along * share);
    let is_little = |of: Flank| SHARE_OF_HEIGHT * height(of) >= apart;
    let goes_along = |own: &Flank| {
        let direction = (own[1] - own[0]).normalize_or_zero();
        direction.dot(along).abs() >= ALONG
            && is_little(*own)
            && inward(*own).dot(inward(edge)) < BACK_TO_BACK
    };
    let is_inside = share > 0.0 && share < length;
    let is_off_the_ends = place.distance(from).min(place.distance(to)) > off_ends.max(2.0 * apart);
    let is_beside = is_inside
        && is_off_the_ends
        && apart <= most.min(SHARE_OF_EDGE * length)
        && is_little(edge)
        && own.iter().any(goes_along);
    is_beside.then_some(apart)
}

/// The distance of the third corner of a triangle from the line of the edge.
fn height([from, to, third]: Flank) -> f64 {
    let along = (to - from).normalize_or_zero();
    let side = third - from;
    (side - along * side.dot(along)).length()
}

/// The direction from an edge into its triangle.
fn inward([from, to, third]: Flank) -> DVec3 {
    let along = (to - from).normalize_or_zero();
    let side = (third - from).normalize_or_zero();
    (side - along * side.dot(along)).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flank(y: f64, third: [f64; 3]) -> Flank {
        [DVec3::new(0.0, y, 0.0), DVec3::new(1.0, y, 0.0), DVec3::from_array(third)]
    }

    #[test]
    fn sheets_that_go_on_lie_side_by_side_and_those_that_turn_back_do_not() {
        let first = flank(0.0, [0.5, -1.0, 0.0]);
        for (third, is_beside) in [
            ([0.5, 1.0, 0.0], true),
            ([3.0, 1.0, 0.0], true),
            ([0.5, 0.01, 1.0], true),
            ([0.5, -0.7, 0.7], true),
            ([0.5, -1.0, 0.1], false),
            ([-2.0, -1.0, 0.01], false),
        ] {
            assert_eq!(lie_side_by_side(first, flank(0.01, third)), is_beside, "{third:?}");
        }
    }

    #[test]
    fn edges_are_side_by_side_only_where_they_are_longer_than_eight_times_their_distance() {
        let first = flank(0.0, [0.5, -1.0, 0.0]);
        assert!(lie_side_by_side(first, flank(0.125, [0.5, 1.0, 0.0])));
        assert!(!lie_side_by_side(first, flank(0.126, [0.5, 1.0, 0.0])));
        let by_edge = JoinReach { epsilon: 1.0, by_edge: true };
        assert_eq!(by_edge.of_edge([DVec3::ZERO, DVec3::X]), 0.125);
        assert!(by_edge.may_join(first, first), "edges that coincide are one");
        assert!(!by_edge.may_join(first, flank(0.01, [0.5, -1.0, 0.01])));
        assert!(JoinReach { epsilon: 1.0, by_edge: false }.may_join(first, flank(0.01, [0.5, -1.0, 0.01])));
    }

    #[test]
    fn a_vertex_lies_beside_an_edge_where_its_sheet_goes_on_from_there() {
        let edge = flank(0.0, [0.5, -1.0, 0.0]);
        let place = DVec3::new(0.5, 0.01, 0.0);
        let beside = |to: [f64; 3], third: [f64; 3], most: f64, off_ends: f64| {
            let own = [place, DVec3::from_array(to), DVec3::from_array(third)];
            vertex_beside(place, &[own], edge, most, off_ends)
        };
        let (along, beyond) = ([1.5, 0.01, 0.0], [1.0, 1.0, 0.0]);
        assert_eq!(beside(along, beyond, 0.1, 0.1), Some(0.01));
        assert_eq!(beside(along, [1.0, -1.0, 0.1], 0.1, 0.1), None, "back to back");
        assert_eq!(beside([0.5, 1.0, 0.0], [1.5, 1.0, 0.0], 0.1, 0.1), None, "its edge goes across");
        assert_eq!(beside(along, [1.0, 0.04, 0.0], 0.1, 0.1), None, "little higher than it is apart");
        assert_eq!(beside(along, beyond, 0.009, 0.1), None, "too far");
        assert_eq!(beside(along, beyond, 0.1, 0.6), None, "too near to an end");
    }
}
