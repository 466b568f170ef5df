//! Whether two triangles meet beyond what they share, exactly.
//!
//! Both triangles must have an area. They are closed sets; the *inside* of a triangle is the triangle without its
//! edges. What they share by their indices is nothing, a vertex or an edge, and positions with other indices are
//! elsewhere. Every answer depends on the two point sets alone, so it is the same after swapping the triangles or
//! reordering their corners.

use super::{AxisProjection, DVec3, Sign, ThreePointPlane, are_collinear, orient3d};

/// How two triangles meet beyond a common vertex or edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ContactKind {
    /// Their insides meet, in different planes: they pass through each other.
    Cross,
    /// Their insides meet, in one plane: they share an area (also neighbours folded onto each other).
    Overlap,
    /// Their insides do not meet: a vertex or an edge of one lies on the other.
    Touch,
}

/// What two triangles have in common by their vertex indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shared {
    /// No vertex.
    Nothing,
    /// One vertex: the corners of the first and the second triangle at it.
    Vertex(u8, u8),
    /// Two vertices: the corners of the first and the second triangle opposite the common edge.
    Edge(u8, u8),
    /// All three vertices.
    Triangle,
}

impl Shared {
    /// Compares the corners of two triangles, each of which has three different ones.
    pub fn between(a: [u32; 3], b: [u32; 3]) -> Self {
        let is_same = |bit: usize| u32::from(a[bit / 3] == b[bit % 3]) << bit;
        Self::by_pairs((0..9).map(is_same).sum())
    }

    /// The same by the pairs of equal corners: bit `3 i + j` is set when corner `i` of the first triangle is corner `j`
    /// of the second.
    #[inline]
    pub fn by_pairs(pairs: u32) -> Self {
        BY_PAIRS[pairs as usize & 0x1ff]
    }
}

/// What is shared varies from pair to pair, so branches on it would be guessed wrong; a table has none.
static BY_PAIRS: [Shared; 512] = {
    let mut table = [Shared::Nothing; 512];
    let mut pairs = 0;
    while pairs < 512u32 {
        table[pairs as usize] = shared_by_pairs(pairs);
        pairs += 1;
    }
    table
};

const fn shared_by_pairs(pairs: u32) -> Shared {
    let rows = [pairs & 7, pairs >> 3 & 7, pairs >> 6];
    let used_columns = rows[0] | rows[1] | rows[2];
    let used_rows = (rows[0] != 0) as u32 | ((rows[1] != 0) as u32) << 1 | ((rows[2] != 0) as u32) << 2;
    match used_rows.count_ones() {
        0 => Shared::Nothing,
        1 => Shared::Vertex(used_rows.trailing_zeros() as u8, used_columns.trailing_zeros() as u8),
        2 => Shared::Edge(used_rows.trailing_ones() as u8, used_columns.trailing_ones() as u8),
        _ => Shared::Triangle,
    }
}

/// The corners of a triangle where they are stored; rotating them moves no coordinates.
type TriangleCorners<'p> = [&'p DVec3; 3];

/// How two triangles meet beyond what they share; `None` when they do not. The first is given with its plane, which
/// many questions can use. Triangles with the same three vertices give `None`: they are duplicates, which is another
/// defect.
#[inline]
pub fn contact(a: &ThreePointPlane, b: [&DVec3; 3], shared: Shared) -> Option<ContactKind> {
    match shared {
        Shared::Nothing => apart(a, b),
        Shared::Vertex(i, j) => at_vertex(a, from_corner(a.corners(), i), from_corner(b, j)),
        Shared::Edge(i, j) => at_edge(a, from_corner(a.corners(), i), b[usize::from(j) % 3]),
        Shared::Triangle => None,
    }
}

/// The corners in the same cyclic order, starting with corner `i`.
#[inline]
fn from_corner(corners: TriangleCorners<'_>, i: u8) -> TriangleCorners<'_> {
    let i = usize::from(i) % 3;
    [corners[i], corners[[1, 2, 0][i]], corners[[2, 0, 1][i]]]
}

/// True when all signs are the same and not zero.
fn on_one_side<const N: usize>(signs: [Sign; N]) -> bool {
    !signs[0].is_zero() && signs == [signs[0]; N]
}

fn has_both_sides<const N: usize>(signs: [Sign; N]) -> bool {
    signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative)
}

/// Triangles without a common vertex.
///
/// If neither plane has the other triangle strictly on one side, and the planes differ, each triangle meets the line
/// of both planes in an interval. Its ends are where two edges, `p q` and `p r` from a corner `p` that is alone on its
/// side, reach the other plane. Choose axes with the line as x, plane `a` as z = 0 and plane `b` as y = 0: an edge
/// `p1 q1` of `a` reaches the line at `x1`, an edge `p2 q2` of `b` at `x2`, and `det(q1 - p1, p2 - p1, q2 - p1)` is
/// `s (x1 - x2)`. The sign of `s` depends only on the sides of `p1` and `p2`, hence is the same for the four pairs of
/// ends. So the intervals are disjoint exactly when the four signs are equal and not zero, and their insides, if both
/// have one, meet exactly when both strict signs occur. The inside of a triangle reaches the line in the inside of its
/// interval when its corners are strictly on both sides, and otherwise not at all.
fn apart(plane_a: &ThreePointPlane, b: TriangleCorners<'_>) -> Option<ContactKind> {
    let a = plane_a.corners();
    let sides_b = b.map(|&p| plane_a.side(p));
    if on_one_side(sides_b) {
        return None;
    }
    let plane_b = ThreePointPlane::through(b.map(|p| *p));
    let sides_a = a.map(|&p| plane_b.side(p));
    if on_one_side(sides_a) {
        return None;
    }
    if sides_b == [Sign::Zero; 3] {
        return in_one_plane(a, b);
    }
    let [p1, q1, r1] = from_corner(a, lone_corner(sides_a));
    let [p2, q2, r2] = from_corner(b, lone_corner(sides_b));
    let order = |e1: &DVec3, e2: &DVec3| orient3d(*p1, *e1, *p2, *e2);
    let orders = [order(q1, q2), order(q1, r2), order(r1, q2), order(r1, r2)];
    if on_one_side(orders) {
        None
    } else if has_both_sides(sides_a) && has_both_sides(sides_b) && has_both_sides(orders) {
        Some(ContactKind::Cross)
    } else {
        Some(ContactKind::Touch)
    }
}

/// The corner that the plane separates, weakly, from both others: strictly on a side on which no other is, or else on
/// the plane. The signs are neither all equal and strict nor all zero.
fn lone_corner(sides: [Sign; 3]) -> u8 {
    let is_alone =
        |i: usize| !sides[i].is_zero() && sides[(i + 1) % 3] != sides[i] && sides[(i + 2) % 3] != sides[i];
    // Without such a corner two are on one side and the third is on the plane.
    let is_on_plane = |i: usize| sides[i].is_zero();
    (0..3).find(|&i| is_alone(i)).or_else(|| (0..3).find(|&i| is_on_plane(i))).unwrap_or(0) as u8
}

/// Triangles `p q r` and `p s t` with one common vertex.
///
/// They meet beyond `p` exactly when they have a common ray from `p`, because each holds a piece of every ray that its
/// angle at `p` holds. If the planes differ, such a ray is on their line. Plane `b` cuts the angle of `a` in a ray
/// exactly when `q` and `r` are not strictly on one side of it, and likewise for `b`; what remains is whether both rays
/// run the same way.
///
/// Let `u = q - p`, `v = r - p`, `n = u x v`, and `m` the normal of plane `b`. Then `n x m = (m.u) v - (m.v) u`. When `q`
/// is on the positive side (`m.u > 0 >= m.v`), both factors are not negative: the ray of `a` is the direction `n x m`;
/// when `q` is on the negative side it is the opposite. Likewise the ray of `b` is `m x n` when `s` is on the positive
/// side. So the rays agree exactly when [`ray_direction`] differs.
fn at_vertex(
    plane_a: &ThreePointPlane,
    [p, q, r]: TriangleCorners<'_>,
    [_, s, t]: TriangleCorners<'_>,
) -> Option<ContactKind> {
    let sides_b = [plane_a.side(*s), plane_a.side(*t)];
    if on_one_side(sides_b) {
        return None;
    }
    let plane_b = ThreePointPlane::through([*p, *s, *t]);
    let sides_a = [plane_b.side(*q), plane_b.side(*r)];
    if on_one_side(sides_a) {
        return None;
    }
    if sides_b == [Sign::Zero; 2] {
        let kind = in_one_plane([p, q, r], [p, s, t])?;
        let is_beyond_p = kind == ContactKind::Overlap || shares_ray(*p, [*q, *r], [*s, *t]);
        return is_beyond_p.then_some(kind);
    }
    if ray_direction(sides_a) == ray_direction(sides_b) {
        return None;
    }
    let do_insides_meet = has_both_sides(sides_a) && has_both_sides(sides_b);
    Some(if do_insides_meet { ContactKind::Cross } else { ContactKind::Touch })
}

/// Which way an angle's ray in the other plane runs, by the sides of the two legs; see [`at_vertex`].
fn ray_direction([first, second]: [Sign; 2]) -> Sign {
    first.or_else(|| -second)
}

/// True when a leg from `p` to one of `a` and a leg to one of `b` run in the same direction.
fn shares_ray(p: DVec3, a: [DVec3; 2], b: [DVec3; 2]) -> bool {
    let direction = |q: DVec3| [0, 1, 2].map(|k| Sign::of_difference(q[k], p[k]));
    let is_shared = |q, s| direction(q) == direction(s) && are_collinear(p, q, s);
    a.into_iter().any(|q| b.into_iter().any(|s| is_shared(q, s)))
}

/// Triangle `r p q` and the triangle of its edge `p q` with `s`.
///
/// In different planes they have only the line through `p` and `q` in common, on which both are the edge. In one plane
/// they lie on different sides of it and meet in the edge alone, or on the same side and overlap.
fn at_edge(plane_a: &ThreePointPlane, [_, p, q]: TriangleCorners<'_>, s: &DVec3) -> Option<ContactKind> {
    if !plane_a.side(*s).is_zero() {
        return None;
    }
    let (view, turn) = AxisProjection::showing(plane_a.corners().map(|p| *p))?;
    (view.turn(*p, *q, *s) == turn).then_some(ContactKind::Overlap)
}

/// Triangles in one plane.
///
/// Two convex polygons are disjoint, or only their insides are, exactly when an edge of one of them has the other
/// polygon strictly, or weakly, on its outer side: the edges of their Minkowski difference are parallel to theirs.
fn in_one_plane(a: TriangleCorners<'_>, b: TriangleCorners<'_>) -> Option<ContactKind> {
    let (view, turn_a) = AxisProjection::showing(a.map(|p| *p))?;
    let turn_b = view.turn(*b[0], *b[1], *b[2]);
    let mut kind = ContactKind::Overlap;
    for (corners, turn, others) in [(a, turn_a, b), (b, turn_b, a)] {
        for k in 0..3 {
            let inward = others.map(|p| view.turn(*corners[k], *corners[(k + 1) % 3], *p) * turn);
            if inward == [Sign::Negative; 3] {
                return None;
            }
            if !inward.contains(&Sign::Positive) {
                kind = ContactKind::Touch;
            }
        }
    }
    Some(kind)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactKind::{Cross, Overlap, Touch};

    fn points<const N: usize>(coordinates: [[i32; 3]; N]) -> [DVec3; N] {
        coordinates.map(|p| DVec3::from_array(p.map(f64::from)))
    }

    const FLOOR: [[i32; 3]; 3] = [[0, 0, 0], [4, 0, 0], [0, 4, 0]];

    /// The kind for every order of the corners and of the triangles, which must be the same.
    #[track_caller]
    fn kind(a: [[i32; 3]; 3], b: [[i32; 3]; 3]) -> Option<ContactKind> {
        const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        let all: Vec<[i32; 3]> = [a, b].concat();
        let ids = |t: [[i32; 3]; 3]| t.map(|p| all.iter().position(|&q| q == p).unwrap() as u32);
        let kind_in_order = |a, b| {
            contact(
                &ThreePointPlane::through(points(a)),
                points(b).each_ref(),
                Shared::between(ids(a), ids(b)),
            )
        };
        let mut kinds = Vec::new();
        for order_a in ORDERS {
            for order_b in ORDERS {
                let (a, b) = (order_a.map(|i| a[i]), order_b.map(|i| b[i]));
                kinds.push(kind_in_order(a, b));
                kinds.push(kind_in_order(b, a));
            }
        }
        assert!(kinds.iter().all(|k| *k == kinds[0]), "{kinds:?}");
        kinds[0]
    }

    #[test]
    fn triangles_without_a_common_vertex() {
        for (b, expected) in [
            ([[1, 1, 1], [2, 1, 1], [1, 2, 3]], None),
            ([[1, 1, -1], [1, 1, 1], [9, 9, 0]], Some(Cross)),
            ([[1, 1, -1], [1, 1, 1], [2, 1, 1]], Some(Cross)),
            ([[1, 1, 0], [1, 1, 1], [2, 1, 1]], Some(Touch)),
            ([[1, 1, 0], [2, 1, 0], [1, 1, 5]], Some(Touch)),
            ([[9, 9, -1], [9, 9, 1], [2, 2, 0]], Some(Touch)),
            ([[9, 9, -1], [9, 9, 1], [3, 2, 0]], None),
            ([[2, 0, -1], [2, 0, 1], [2, -5, 0]], Some(Touch)),
            ([[2, 0, -1], [2, 0, 1], [2, 5, 0]], Some(Cross)),
            ([[1, 1, 0], [2, 1, 0], [1, 2, 0]], Some(Overlap)),
            ([[-9, -9, 0], [30, -9, 0], [-9, 30, 0]], Some(Overlap)),
            ([[1, 0, 0], [2, 0, 0], [1, -1, 0]], Some(Touch)),
            ([[2, 2, 0], [5, 2, 0], [5, 5, 0]], Some(Touch)),
            ([[3, 3, 0], [5, 2, 0], [5, 5, 0]], None),
        ] {
            assert_eq!(kind(FLOOR, b), expected, "{b:?}");
        }
    }

    #[test]
    fn triangles_with_a_common_vertex() {
        let p = [0, 0, 0];
        for (b, expected) in [
            ([p, [1, 1, 1], [1, 1, -1]], Some(Cross)),
            ([p, [-1, -1, 1], [-1, -1, -1]], None),
            ([p, [9, 9, 9], [9, 9, -9]], Some(Cross)),
            ([p, [1, 1, 0], [1, 1, -1]], Some(Touch)),
            ([p, [2, 0, 0], [1, 0, -1]], Some(Touch)),
            ([p, [8, 0, 3], [8, 0, -1]], Some(Touch)),
            ([p, [-2, 0, 0], [1, 0, -1]], None),
            ([p, [1, 1, 3], [1, 1, 1]], None),
            ([p, [8, 1, 0], [1, 8, 0]], Some(Overlap)),
            ([p, [2, 0, 0], [2, -1, 0]], Some(Touch)),
            ([p, [-4, 0, 0], [-2, -1, 0]], None),
            ([p, [8, 0, 0], [0, 8, 0]], Some(Overlap)),
        ] {
            assert_eq!(kind(FLOOR, b), expected, "{b:?}");
        }
    }

    #[test]
    fn triangles_with_a_common_edge_meet_beyond_it_only_when_folded_flat() {
        let (p, q) = ([0, 0, 0], [4, 0, 0]);
        for (s, expected) in [
            ([0, 4, 1], None),
            ([0, 0, 9], None),
            ([2, -3, 0], None),
            ([9, 9, 0], Some(Overlap)),
            ([1, 1, 0], Some(Overlap)),
        ] {
            assert_eq!(kind(FLOOR, [p, q, s]), expected, "{s:?}");
        }
        assert_eq!(kind(FLOOR, FLOOR), None);
    }

    #[test]
    fn common_corners_are_found_in_every_order() {
        assert_eq!(Shared::between([1, 2, 3], [4, 5, 6]), Shared::Nothing);
        assert_eq!(Shared::between([1, 2, 3], [4, 2, 6]), Shared::Vertex(1, 1));
        assert_eq!(Shared::between([1, 2, 3], [3, 2, 6]), Shared::Edge(0, 2));
        assert_eq!(Shared::between([1, 2, 3], [2, 6, 1]), Shared::Edge(2, 1));
        assert_eq!(Shared::between([1, 2, 3], [3, 1, 2]), Shared::Triangle);
    }
}
