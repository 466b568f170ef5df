//! How vertices move when planes do: linearly, because offsets grow linearly and normals stay.

use super::exact::{IntegerVector, Rational, cross, dot, negative};
use super::plane::Plane;
use super::point::Point;
use super::solid::Solid;
use crate::geom::DVec3;
use crate::mesh::polyhedron::{FaceId, VertexId};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;

/// Planes that move at the same time: the offset of face `f` grows by `rate` for each unit of time. Sorted by face.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    rates: Vec<(FaceId, BigInt)>,
}

impl Motion {
    /// Whole rates, without common divisor, and the time after which the offset of each face has grown as given. `None`
    /// when nothing moves. Several entries for one face add up.
    pub(super) fn of(shifts: &[(FaceId, Rational)]) -> Option<(Self, Rational)> {
        let mut sorted = shifts.to_vec();
        sorted.sort_by_key(|(f, _)| *f);
        let mut sums: Vec<(FaceId, Rational)> = Vec::new();
        for (face, t) in sorted {
            match sums.last_mut() {
                Some((last, sum)) if *last == face => *sum += t,
                _ => sums.push((face, t)),
            }
        }
        sums.retain(|(_, t)| !t.is_zero());
        let common = sums.iter().fold(BigInt::one(), |lcm, (_, t)| lcm.lcm(t.denom()));
        let mut rates: Vec<(FaceId, BigInt)> =
            sums.iter().map(|(f, t)| (*f, t.numer() * (&common / t.denom()))).collect();
        let divisor = rates.iter().fold(BigInt::zero(), |gcd, (_, r)| gcd.gcd(r));
        if divisor.is_zero() {
            return None;
        }
        rates.iter_mut().for_each(|(_, r)| *r = &*r / &divisor);
        Some((Self { rates }, Rational::new(divisor, common)))
    }

    pub(super) fn faces(&self) -> impl Iterator<Item = FaceId> {
        self.rates.iter().map(|(f, _)| *f)
    }

    pub(super) fn rates(&self) -> &[(FaceId, BigInt)] {
        &self.rates
    }

    /// The rate of `f`, if it moves.
    pub(super) fn rate(&self, f: FaceId) -> Option<&BigInt> {
        self.rates.binary_search_by_key(&f, |(g, _)| *g).ok().map(|i| &self.rates[i].1)
    }

    /// The rate of `f`, zero if it does not move.
    pub(super) fn rate_or_zero(&self, f: FaceId) -> BigInt {
        self.rate(f).cloned().unwrap_or_default()
    }
}

/// A vertex at time `s`: `(start + s speed) / w`, with a positive `w`.
#[derive(Debug, Clone)]
pub(super) struct MovingPoint {
    pub(super) start: IntegerVector,
    pub(super) speed: IntegerVector,
    pub(super) w: BigInt,
}

impl MovingPoint {
    /// The point of three planes with independent normals.
    pub(super) fn of(solid: &Solid, motion: &Motion, faces: [FaceId; 3]) -> Self {
        let planes: [&Plane; 3] = faces.map(|f| solid.plane(f));
        let crossed = [
            cross(&planes[1].normal, &planes[2].normal),
            cross(&planes[2].normal, &planes[0].normal),
            cross(&planes[0].normal, &planes[1].normal),
        ];
        let w = dot(&planes[0].normal, &crossed[0]);
        let common = planes.iter().fold(BigInt::one(), |lcm, p| lcm.lcm(p.offset.denom()));
        let starts = planes.map(|p| p.offset.numer() * (&common / p.offset.denom()));
        let rates = faces.map(|f| motion.rate_or_zero(f) * &common);
        let sum = |weights: &[BigInt; 3]| -> IntegerVector {
            std::array::from_fn(|k| {
                &weights[0] * &crossed[0][k] + &weights[1] * &crossed[1][k] + &weights[2] * &crossed[2][k]
            })
        };
        let (start, speed, w) = (sum(&starts), sum(&rates), w * common);
        if w.is_negative() {
            return Self { start: negative(&start), speed: negative(&speed), w: -w };
        }
        Self { start, speed, w }
    }

    /// A point that stays.
    pub(super) fn still(p: &Point) -> Self {
        Self { start: p.x.clone(), speed: [BigInt::ZERO, BigInt::ZERO, BigInt::ZERO], w: p.w.clone() }
    }

    /// Where it is at time `s`.
    pub(super) fn at(&self, s: &Rational) -> Point {
        let x = std::array::from_fn(|k| &self.start[k] * s.denom() + &self.speed[k] * s.numer());
        Point::new(x, &self.w * s.denom())
    }

    /// The speed, rounded.
    pub(super) fn near_speed(&self) -> DVec3 {
        DVec3::from_array(self.speed.each_ref().map(|x| super::exact::quotient(x, &self.w)))
    }

    /// True when plane `f`, which holds the point now, holds it at all times.
    pub(super) fn stays_on(&self, solid: &Solid, motion: &Motion, f: FaceId) -> bool {
        dot(&solid.plane(f).normal, &self.speed) == motion.rate_or_zero(f) * &self.w
    }
}

/// The vertices that move, ascending, each with its motion, and where they are at a time.
#[derive(Debug)]
pub(super) struct Moving {
    pub(super) vertices: Vec<(VertexId, MovingPoint)>,
}

impl Moving {
    /// The vertices of moving faces; `Err` with one whose planes do not stay concurrent.
    pub(super) fn of(solid: &Solid, motion: &Motion) -> Result<Self, VertexId> {
        let mut ids: Vec<VertexId> =
            motion.faces().flat_map(|f| solid.topology.sides(f)).map(|h| solid.topology.origin(h)).collect();
        ids.sort_unstable();
        ids.dedup();
        let mut vertices = Vec::with_capacity(ids.len());
        for v in ids {
            let faces: Vec<FaceId> = solid.topology.faces_around(v).collect();
            let defining = solid.defining_faces(&faces).ok_or(v)?;
            let point = MovingPoint::of(solid, motion, defining);
            if faces.len() > 3 && !faces.iter().all(|&f| point.stays_on(solid, motion, f)) {
                return Err(v);
            }
            vertices.push((v, point));
        }
        Ok(Self { vertices })
    }

    /// The vertices of moving faces whose planes do not stay concurrent, ascending.
    pub(super) fn unsettled(solid: &Solid, motion: &Motion) -> Vec<VertexId> {
        let mut ids: Vec<VertexId> = motion
            .faces()
            .flat_map(|f| solid.topology.sides(f))
            .map(|h| solid.topology.origin(h))
            .filter(|&v| solid.topology.faces_around(v).nth(3).is_some())
            .collect();
        ids.sort_unstable();
        ids.dedup();
        let is_settled = |&v: &VertexId| {
            let faces: Vec<FaceId> = solid.topology.faces_around(v).collect();
            solid.defining_faces(&faces).is_some_and(|defining| {
                let point = MovingPoint::of(solid, motion, defining);
                faces.iter().all(|&f| point.stays_on(solid, motion, f))
            })
        };
        ids.retain(|v| !is_settled(v));
        ids
    }

    pub(super) fn get(&self, v: VertexId) -> Option<&MovingPoint> {
        self.vertices.binary_search_by_key(&v, |(w, _)| *w).ok().map(|i| &self.vertices[i].1)
    }

    /// Where `v` is at time `s`.
    pub(super) fn at(&self, solid: &Solid, v: VertexId, s: &Rational) -> Point {
        self.get(v).map_or_else(|| solid.point(v).clone(), |m| m.at(s))
    }
}

/// The time at which `c0 + s c1` is zero, if it is after 0.
pub(super) fn root_after_zero(c0: &BigInt, c1: &BigInt) -> Option<Rational> {
    let (a, b) = (super::exact::sign(c0), super::exact::sign(c1));
    if a == Ordering::Equal || b == Ordering::Equal || a == b {
        return None;
    }
    Some(Rational::new(c0.abs(), c1.abs()))
}
