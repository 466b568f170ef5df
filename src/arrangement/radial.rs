//! The order of pieces around a common edge, from the input planes.
//!
//! Let `d` be the direction of the edge and `n` the normal of a piece, turned so that the piece runs along the edge in that direction.
//! It lies in the direction `m = n x d` of the edge. For two pieces `m1 x m2 = d (d . (n1 x n2))` and, as both normals are
//! perpendicular to `d`, `m1 . m2 = (n1 . n2) (d . d)`. So the order around `d` is decided by the sign of `d . (n1 x n2)`, where
//! `n1 x n2` is a multiple of `d`: any coordinate of it that is not zero, with that of `d`. Only the signs of the coordinates of
//! `d` are needed, and no product of coordinates of new points.

use super::Arrangement;
use super::ball::{self, Ball};
use super::exact::{self, IntegerVector, sign_of};
use crate::geom::{DVec3, Sign};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// The normal of a piece, turned along an edge.
#[derive(Debug)]
pub(super) struct Normal {
    corners: [DVec3; 3],
    is_turned: bool,
    near: [Ball; 3],
    exact: OnceCell<Box<IntegerVector>>,
}

impl Normal {
    /// The normal of a triangle, or its opposite.
    pub(super) fn of(corners: [DVec3; 3], is_turned: bool) -> Self {
        let [a, b, c] = corners.map(|p| p.to_array().map(Ball::exactly));
        let (u, v) = (ball::minus(b, a), ball::minus(c, a));
        let near = if is_turned { ball::cross(v, u) } else { ball::cross(u, v) };
        Self { corners, is_turned, near, exact: OnceCell::new() }
    }

    /// A positive multiple of it in integers.
    fn exact(&self) -> &IntegerVector {
        self.exact.get_or_init(|| {
            let ([a, b, c], _) = exact::integers(self.corners);
            let (u, v) = (exact::minus(&b, &a), exact::minus(&c, &a));
            Box::new(if self.is_turned { exact::cross(&v, &u) } else { exact::cross(&u, &v) })
        })
    }
}

/// The sign of `d . (n1 x n2)` for the direction `d` of the edge from point `from` to point `to`.
fn turn(arrangement: &Arrangement, [from, to]: [u32; 2], n1: &Normal, n2: &Normal) -> Sign {
    let direction = |k: usize| match arrangement.compare(k, from, to) {
        Ordering::Less => Sign::Positive,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Negative,
    };
    let near = ball::cross(n1.near, n2.near);
    let is_certain = |k: &usize| near[*k].sign().is_some();
    if let Some((k, sign)) = (0..3).find(is_certain).and_then(|k| Some((k, near[k].sign()?))) {
        return sign * direction(k);
    }
    let crossed = exact::cross(n1.exact(), n2.exact());
    (0..3)
        .map(|k| (k, sign_of(&crossed[k])))
        .find(|(_, sign)| !sign.is_zero())
        .map_or(Sign::Zero, |(k, sign)| sign * direction(k))
}

/// The order of pieces with these normals counter-clockwise around an edge, for whoever looks against its direction; begins
/// with the first. `None` when two lie in one half-plane.
pub(super) fn around(arrangement: &Arrangement, edge: [u32; 2], normals: &[Normal]) -> Option<Vec<usize>> {
    let first = normals.first()?;
    // Which part of the turn: the first, the half before its opposite, the opposite, the half after it.
    let mut placed = Vec::with_capacity(normals.len());
    placed.push((0, 0));
    for (i, normal) in normals.iter().enumerate().skip(1) {
        let part = match turn(arrangement, edge, first, normal) {
            Sign::Positive => 1,
            Sign::Negative => 3,
            Sign::Zero if sign_of(&exact::dot(first.exact(), normal.exact())) == Sign::Negative => 2,
            Sign::Zero => return None,
        };
        placed.push((part, i));
    }
    placed.sort_by(|&(s, i), &(t, j)| {
        let within = || match turn(arrangement, edge, &normals[i], &normals[j]) {
            _ if i == j => Ordering::Equal,
            Sign::Positive => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Greater,
        };
        s.cmp(&t).then_with(within)
    });
    let is_shared = |pair: &[(i32, usize)]| {
        pair[0].0 == pair[1].0
            && turn(arrangement, edge, &normals[pair[0].1], &normals[pair[1].1]) != Sign::Positive
    };
    let is_apart = !placed.windows(2).any(is_shared);
    is_apart.then(|| placed.into_iter().map(|(_, i)| i).collect())
}
