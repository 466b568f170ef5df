//! The winding number beside a piece, by a vertical ray from inside it.

use super::Arrangement;
use super::ball::Ball;
use super::exact::{self, Homogeneous, IntegerVector, sign_of};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, AxisProjection, DVec3, Sign};
use crate::spatial::Bvh;
use num_bigint::BigInt;

/// The middle of a piece.
struct RayStart {
    near: DVec3,
    /// How far the middle is from `near` at most, in each coordinate.
    error: f64,
    place: Homogeneous,
    /// `place` is in units of two to this power.
    low: i32,
}

/// True when the side of the piece that the ray starts on is the one from which it turns counter-clockwise, and the winding number
/// of each operand there.
///
/// The ray goes up from the middle of the piece and is moved by an infinitesimal `(i, i^2, 0)`, as in
/// [`upward_crossing`](crate::geom::upward_crossing), so that it meets no edge and no vertical triangle. It starts above the piece,
/// or, where that is vertical, on the side to which it is moved. The triangles that cover the piece are not crossed.
pub(super) fn beside(
    arrangement: &Arrangement,
    piece: usize,
    triangles: &[[u32; 3]],
    operand_of: &impl Fn(u32) -> u8,
    bvh: &Bvh,
    budget: &Budget,
) -> Result<(bool, Vec<i32>), Stopped> {
    let start = RayStart::middle(arrangement, arrangement.pieces[piece]);
    let corners = |t: u32| triangles[t as usize].map(|v| arrangement.positions[v as usize]);
    let [a, b, c] = corners(arrangement.planes[piece]);
    let [along_x, along_y, along_z] = AxisProjection::ALL.map(|view| view.turn(a, b, c));
    let is_front = along_z.or_else(|| along_x).or_else(|| along_y) == Sign::Positive;
    let margin = DVec3::splat(start.error);
    let (min, max) = (start.near - margin, start.near + margin);
    let query = Aabb { min, max: max.with_z(f64::MAX) };
    let mut windings = vec![0; arrangement.operands];
    let own = arrangement.sources(piece);
    bvh.visit_box(query, budget, |t| {
        if own.iter().any(|&(source, _)| source == t) {
            return;
        }
        let turn = match start.upward_crossing(corners(t)) {
            Some(Sign::Positive) => 1,
            Some(Sign::Negative) => -1,
            _ => return,
        };
        if let Some(winding) = windings.get_mut(usize::from(operand_of(t))) {
            *winding += turn;
        }
    })?;
    Ok((is_front, windings))
}

impl RayStart {
    fn middle(arrangement: &Arrangement, corners: [u32; 3]) -> Self {
        let places = corners.map(|p| arrangement.absolute(p));
        let low = places.iter().map(|(_, low)| *low).min().unwrap_or(0);
        let [a, b, c] =
            places.map(|(place, own)| Homogeneous { x: place.x.map(|x| x << (own - low)), w: place.w });
        let (bc, ca, ab) = (&b.w * &c.w, &c.w * &a.w, &a.w * &b.w);
        let x: IntegerVector = std::array::from_fn(|k| &a.x[k] * &bc + &b.x[k] * &ca + &c.x[k] * &ab);
        let w = BigInt::from(3) * &a.w * &bc;
        let near = DVec3::from_array(x.each_ref().map(|x| exact::quotient(x, &w, low)));
        let error = near.abs().max_element() * (8.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        Self { near, error, place: Homogeneous { x, w }, low }
    }

    /// See [`crate::geom::upward_crossing`].
    fn upward_crossing(&self, [a, b, c]: [DVec3; 3]) -> Option<Sign> {
        let turn = self.moved_turn(a, b);
        if turn.is_zero() || self.moved_turn(b, c) != turn || self.moved_turn(c, a) != turn {
            return None;
        }
        (self.side([a, b, c]) * turn == Sign::Negative).then_some(turn)
    }

    fn moved_turn(&self, a: DVec3, b: DVec3) -> Sign {
        self.turn(a, b).or_else(|| Sign::of_difference(a.y, b.y)).or_else(|| Sign::of_difference(b.x, a.x))
    }

    fn ball(&self, k: usize) -> Ball {
        Ball { mid: self.near[k], rad: self.error }
    }

    /// How `a`, `b` and the start turn, seen from above.
    fn turn(&self, a: DVec3, b: DVec3) -> Sign {
        let e = Ball::exactly;
        let near = (e(b.x) - e(a.x)) * (self.ball(1) - e(a.y)) - (e(b.y) - e(a.y)) * (self.ball(0) - e(a.x));
        near.sign().unwrap_or_else(|| {
            let ([a, b], p) = self.with([a, b]);
            let to = |k: usize| &p.x[k] - &a[k] * &p.w;
            sign_of(&((&b[0] - &a[0]) * to(1) - (&b[1] - &a[1]) * to(0)))
        })
    }

    /// The side of a triangle on which the start is.
    fn side(&self, corners: [DVec3; 3]) -> Sign {
        let [a, b, c] = corners.map(|p| p.to_array().map(Ball::exactly));
        let normal = super::ball::cross(super::ball::minus(b, a), super::ball::minus(c, a));
        let to = super::ball::minus([0, 1, 2].map(|k| self.ball(k)), a);
        super::ball::dot(normal, to).sign().unwrap_or_else(|| {
            let ([a, b, c], p) = self.with(corners);
            let normal = exact::cross(&exact::minus(&b, &a), &exact::minus(&c, &a));
            let to = std::array::from_fn(|k| &p.x[k] - &a[k] * &p.w);
            sign_of(&exact::dot(&normal, &to))
        })
    }

    /// Points of the input and the start in one unit.
    fn with<const N: usize>(&self, points: [DVec3; N]) -> ([IntegerVector; N], Homogeneous) {
        let (points, own) = exact::integers(points);
        let low = own.min(self.low);
        let points = points.map(|p| p.map(|x| x << (own - low)));
        let x = self.place.x.each_ref().map(|x| x << (self.low - low));
        (points, Homogeneous { x, w: self.place.w.clone() })
    }
}
