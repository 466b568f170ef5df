//! What can be seen from outside, along straight lines.

use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::spatial::Bvh;

/// Sides of a triangle are looked at this far from it, as a share of the longest side of the box around all.
pub(super) const BESIDE: f64 = 1e-6;

/// Gaps are narrower than this share of the longest side.
pub(super) const GAP: f64 = 0.01;

/// Places on a triangle are moved this much of the way to its middle first, so that neighbours do not decide.
const INWARD: f64 = 1e-3;

/// Directions in which a way out is looked for.
const DIRECTIONS: usize = 24;

/// Turn from each direction to the next, which spreads them evenly.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Farther than the diagonal of the box around all, whose longest side is 1.
const OUT: f64 = 2.0;

/// Coordinates in which the longest side of the box around all is 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    center: DVec3,
    scale: f64,
}

impl Unit {
    pub(super) fn around(places: impl Iterator<Item = DVec3>) -> Self {
        let bounds = Aabb::of(places);
        let (center, size) = ((bounds.min + bounds.max) / 2.0, (bounds.max - bounds.min).max_element());
        Self { center, scale: if size > 0.0 && size.is_finite() { 1.0 / size } else { 1.0 } }
    }

    pub(super) fn of(&self, place: DVec3) -> DVec3 {
        (place - self.center) * self.scale
    }

    /// Two places, one on each side of a `place` on a triangle, with the directions to them; none where it has no area.
    pub(super) fn both_sides(&self, place: DVec3, corners: [DVec3; 3]) -> impl Iterator<Item = [DVec3; 2]> {
        let [a, b, c] = corners.map(|p| self.of(p));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let place = self.of(place).lerp((a + b + c) / 3.0, INWARD);
        let sides = [normal, -normal].into_iter().filter(|&side| side != DVec3::ZERO);
        sides.map(move |side| [place + side * BESIDE, side])
    }
}

/// Triangles that are in the way of a look.
#[derive(Debug)]
pub struct Outlook {
    corners: Vec<[DVec3; 3]>,
    bvh: Bvh,
    unit: Unit,
}

impl Outlook {
    /// With all of these triangles in the way whose corners are finite.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn past(triangles: impl Iterator<Item = [DVec3; 3]>, budget: &Budget) -> Result<Self, Stopped> {
        let finite = triangles.filter(|corners| corners.iter().all(|p| p.is_finite()));
        let mut corners: Vec<[DVec3; 3]> = finite.collect();
        let unit = Unit::around(corners.as_flattened().iter().copied());
        corners.as_flattened_mut().iter_mut().for_each(|p| *p = unit.of(*p));
        let names: Vec<[u32; 3]> = (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let bvh = Bvh::build(corners.as_flattened(), &names, None, budget)?;
        Ok(Self { corners, bvh, unit })
    }

    /// Whether a `place` on a triangle is seen from outside: a straight way out leads from one of its sides, in one of many
    /// directions. What was in the way from a place nearby is looked at first, and the way out from there.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn sees(
        &self,
        place: DVec3,
        corners: [DVec3; 3],
        nearby: &mut LookedFrom,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        let known = nearby.way_out.and_then(|[side, k]| {
            let [beside, side] = self.unit.both_sides(place, corners).nth(side)?;
            Some([beside, beside + Hemisphere::around(side).direction(k) * OUT])
        });
        if let Some(way) = known
            && met(&self.bvh, &self.corners, way, budget)?.is_none()
        {
            return Ok(true);
        }
        for (n, [beside, side]) in self.unit.both_sides(place, corners).enumerate() {
            let known = &mut nearby.in_the_way[n];
            let is_closed = |k: usize, direction| {
                is_closed(&self.bvh, &self.corners, [beside, direction], (k, &mut *known), budget)
            };
            if let Some(k) = way_out(side, is_closed)? {
                nearby.way_out = Some([n, k]);
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// What was in the way in each direction.
pub(super) type InTheWay = [Option<u32>; DIRECTIONS];

/// A direction of the spiral, and so many before it those that are near it: what is in the way there mostly is here.
const NEAR_DIRECTIONS: [usize; 4] = [0, 3, 5, 8];

/// What a look from a place nearby found.
#[derive(Debug, Default)]
pub struct LookedFrom {
    /// What was in the way on both sides.
    in_the_way: [InTheWay; 2],
    /// What of a solid was.
    pub(super) in_the_gap: [InTheWay; 2],
    /// What of a solid was opposite.
    pub(super) opposite: [Option<u32>; 2],
    /// The side and the direction in which nothing was.
    way_out: Option<[usize; 2]>,
}

/// The directions on the side of a plane that its normal points to, in a fixed order.
struct Hemisphere {
    normal: DVec3,
    across: [DVec3; 2],
}

impl Hemisphere {
    fn around(normal: DVec3) -> Self {
        let (u, v) = normal.any_orthonormal_pair();
        Self { normal, across: [u, v] }
    }

    /// One of a spiral around the hemisphere, steepest first.
    fn direction(&self, k: usize) -> DVec3 {
        let [u, v] = self.across;
        let height = 1.0 - (k as f64 + 0.5) / DIRECTIONS as f64;
        let (sin, cos) = libm::sincos(k as f64 * GOLDEN_ANGLE);
        self.normal * height + (u * cos + v * sin) * (1.0 - height * height).sqrt()
    }
}

/// Which of many directions on the side of a plane that `normal` points to is the first that is not closed.
pub(super) fn way_out(
    normal: DVec3,
    mut is_closed: impl FnMut(usize, DVec3) -> Result<bool, Stopped>,
) -> Result<Option<usize>, Stopped> {
    let hemisphere = Hemisphere::around(normal);
    for k in 0..DIRECTIONS {
        if !is_closed(k, hemisphere.direction(k))? {
            return Ok(Some(k));
        }
    }
    Ok(None)
}

/// Whether one of the first triangles of a tree, those with `corners`, is in the way out from a place in direction `k`. What is
/// known to have been in the way nearby is looked at first.
pub(super) fn is_closed(
    bvh: &Bvh,
    corners: &[[DVec3; 3]],
    [place, direction]: [DVec3; 2],
    (k, known): (usize, &mut InTheWay),
    budget: &Budget,
) -> Result<bool, Stopped> {
    let out = place + direction * OUT;
    for before in NEAR_DIRECTIONS {
        let Some(t) = k.checked_sub(before).and_then(|k| known[k]) else { continue };
        budget.spend(1)?;
        if corners.get(t as usize).is_some_and(|&corners| meets(place, out, corners)) {
            known[k] = Some(t);
            return Ok(true);
        }
    }
    known[k] = first_met(bvh, corners, [place, direction], budget)?;
    Ok(known[k].is_some())
}

/// One of the first triangles of a tree, those with `corners`, that is in the way out from a place in a direction.
fn first_met(
    bvh: &Bvh,
    corners: &[[DVec3; 3]],
    [place, direction]: [DVec3; 2],
    budget: &Budget,
) -> Result<Option<u32>, Stopped> {
    // What is in the way is mostly near.
    for length in [4.0 * GAP, OUT] {
        let found = met(bvh, corners, [place, place + direction * length], budget)?;
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}

/// Whether one of the first triangles of a tree, those with `corners`, meets a segment. The one that is `known` to meet one nearby
/// is looked at first.
pub(super) fn is_met(
    bvh: &Bvh,
    corners: &[[DVec3; 3]],
    segment: [DVec3; 2],
    known: &mut Option<u32>,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let [from, to] = segment;
    let before = known.and_then(|t| corners.get(t as usize));
    if before.is_some_and(|&corners| meets(from, to, corners)) {
        budget.spend(1)?;
        return Ok(true);
    }
    *known = met(bvh, corners, segment, budget)?;
    Ok(known.is_some())
}

/// One of the first triangles of a tree, those with `corners`, that a segment meets.
fn met(
    bvh: &Bvh,
    corners: &[[DVec3; 3]],
    [from, to]: [DVec3; 2],
    budget: &Budget,
) -> Result<Option<u32>, Stopped> {
    let mut met = None;
    bvh.visit_segment([from, to], budget, |t| {
        met = corners.get(t as usize).is_some_and(|&corners| meets(from, to, corners)).then_some(t);
        met.is_none()
    })?;
    Ok(met)
}

/// Whether a segment meets a triangle, rounded.
fn meets(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let (ab, ac, along) = (b - a, c - a, to - from);
    let normal = ab.cross(ac);
    let slope = normal.dot(along);
    let offset = from - a;
    let share = -normal.dot(offset) / slope;
    let turn = along.cross(offset);
    let (v, w) = (ac.dot(turn) / slope, -ab.dot(turn) / slope);
    (0.0..=1.0).contains(&share) && v >= 0.0 && w >= 0.0 && v + w <= 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The squares of a box from 0 to 4 along each axis.
    const SQUARES: [[[f64; 3]; 4]; 6] = [
        [[0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 0.0], [4.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 0.0, 4.0], [0.0, 0.0, 4.0]],
        [[0.0, 4.0, 0.0], [0.0, 4.0, 4.0], [4.0, 4.0, 4.0], [4.0, 4.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 4.0], [0.0, 4.0, 4.0], [0.0, 4.0, 0.0]],
        [[4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [4.0, 4.0, 4.0], [4.0, 0.0, 4.0]],
        [[0.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 4.0, 4.0], [0.0, 4.0, 4.0]],
    ];

    #[test]
    fn the_inside_of_a_box_is_seen_through_an_opening_only() {
        let triangles = |squares: usize| {
            let corners = SQUARES[..squares].iter().map(|square| square.map(DVec3::from));
            corners.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect::<Vec<_>>()
        };
        // Of a triangle in the middle, and of a side of the box.
        let middle = [[1.0, 2.0, 1.0], [3.0, 2.0, 1.0], [2.0, 2.0, 3.0]].map(DVec3::from);
        let of = |corners: [DVec3; 3]| corners.iter().sum::<DVec3>() / 3.0;
        let (budget, nothing) = (Budget::unlimited(), LookedFrom::default);
        for (squares, is_seen) in [(6, false), (5, true)] {
            let way = triangles(squares).into_iter().chain([middle]);
            let outlook = Outlook::past(way, &budget).unwrap();
            assert_eq!(outlook.sees(of(middle), middle, &mut nothing(), &budget), Ok(is_seen), "{squares}");
            let side = triangles(1)[0];
            assert_eq!(outlook.sees(of(side), side, &mut nothing(), &budget), Ok(true), "{squares}");
            assert_eq!(
                outlook.sees(DVec3::ONE, [DVec3::ONE; 3], &mut nothing(), &budget),
                Ok(false),
                "no area"
            );
        }
    }

    #[test]
    fn what_was_in_the_way_nearby_changes_no_answer() {
        let all = SQUARES.iter().map(|square| square.map(DVec3::from));
        let triangles: Vec<[DVec3; 3]> =
            all.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).take(11).collect();
        let budget = Budget::unlimited();
        let outlook = Outlook::past(triangles.into_iter(), &budget).unwrap();
        let (mut kept, mut seen) = (LookedFrom::default(), 0);
        for i in 0..1000 {
            let place = DVec3::new((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64) * 0.39 + 0.2;
            let corners = [place, place + DVec3::new(0.01, 0.02, 0.0), place + DVec3::new(0.0, 0.01, 0.03)];
            let is_seen = outlook.sees(place, corners, &mut LookedFrom::default(), &budget).unwrap();
            assert_eq!(outlook.sees(place, corners, &mut kept, &budget), Ok(is_seen), "{place}");
            seen += u32::from(is_seen);
        }
        assert!((50..950).contains(&seen), "{seen}");
    }
}
