//! Whether a collapse moves surface through other surface.
//!
//! A collapse is two moves: one end of the edge goes to the new place, then the other. Each move sweeps the tetrahedra
//! of its old place, the new place and the edges around it. No triangle outside may meet them except where it shares the
//! edges around: neither their sides, which are the triangles before and after and the walls between, nor the inside.
//! Triangles before are known to meet nothing. What meets no side is wholly in a tetrahedron or in none, so one point
//! of it decides.

use super::allowance::FREE_MAX;
use crate::geom::{
    Aabb, DVec3, DirectionCone, Shared, Sign, ThreePointPlane, are_collinear, contact, orient3d,
};
use crate::simplify::report::SimplifyRefusal;

/// One triangle of the star before: its vertex that moves, and the side that stays.
#[derive(Debug, Clone, Copy)]
struct MovingTriangle {
    from: DVec3,
    /// The other two corners, in the order of the triangle.
    side: [DVec3; 2],
    /// Their numbers.
    ids: [u32; 2],
    /// The collapse does not remove it.
    stays: bool,
}

/// The two moves of a collapse. Kept from one to the next, so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(super) struct Sweep {
    sectors: Vec<MovingTriangle>,
    to: DVec3,
    /// Number of the merged vertex.
    merged: u32,
    /// The other vertices of the stars; some come twice.
    rim: Vec<u32>,
    /// Where they are, and then the places of what moves.
    points: Vec<DVec3>,
    /// The middle of the points.
    middle: DVec3,
}

/// A triangle that is not in the stars of the edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outside {
    /// Numbers of the corners; they only need to be the same where vertices are.
    pub(super) ids: [u32; 3],
    pub(super) corners: [DVec3; 3],
}

impl Sweep {
    /// Begins with a collapse that moves both ends to `to`; the vertex there is called `merged`.
    pub(super) fn begin(&mut self, to: DVec3, merged: u32) {
        self.sectors.clear();
        self.rim.clear();
        self.points.clear();
        (self.to, self.merged) = (to, merged);
    }

    /// Adds a triangle of the star of the vertex at `from`. `stays`: the collapse does not remove it.
    #[inline]
    pub(super) fn add(&mut self, from: DVec3, side: [DVec3; 2], ids: [u32; 2], stays: bool) {
        if from == self.to {
            return;
        }
        self.sectors.push(MovingTriangle { from, side, ids, stays });
        // Most triangles follow one another around their vertex.
        if self.rim.last() != Some(&ids[0]) {
            self.rim.push(ids[0]);
            self.points.push(side[0]);
        }
        self.rim.push(ids[1]);
        self.points.push(side[1]);
    }

    /// To be called after the last triangle: the box of all that is swept.
    pub(super) fn finish(&mut self) -> Aabb {
        let mut last = self.to;
        for sector in &self.sectors {
            if sector.from != last {
                last = sector.from;
                self.points.push(last);
            }
        }
        if self.sectors.is_empty() {
            return Aabb::EMPTY;
        }
        self.points.push(self.to);
        self.middle = self.points.iter().sum::<DVec3>() / self.points.len() as f64;
        Aabb::of(self.points.iter().copied())
    }

    /// The directions from vertex `hub`, which does not move and is at `place`, to all that is swept; false where they
    /// may be all, or are many.
    pub(super) fn seen_from(&self, hub: u32, place: DVec3, cones: &mut Vec<DirectionCone>) -> bool {
        cones.clear();
        if self.sectors.len() > FREE_MAX {
            return false;
        }
        // What has the hub as a corner is seen from there as its other corners are.
        cones.extend(self.sectors.iter().map_while(|sector| {
            let side = sector.side.into_iter().zip(sector.ids).filter(|(_, id)| *id != hub);
            DirectionCone::over(place, [sector.from, self.to].into_iter().chain(side.map(|(p, _)| p)))
        }));
        cones.len() == self.sectors.len()
    }

    /// Number of triangles that move.
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.sectors.len()
    }

    /// Whether `other` stays untouched.
    #[inline]
    pub(super) fn passes(&self, other: &Outside) -> Result<(), SimplifyRefusal> {
        if self.is_beside(other) {
            return Ok(());
        }
        self.meets_nothing_of(other, |sector| self.has_beside(sector, other))
    }

    /// True when a plane has all that moves on one side and the rest of `other` on the other. For most there is one.
    fn is_beside(&self, other: &Outside) -> bool {
        Moving { points: &self.points, ids: &self.rim, middle: self.middle }.is_beside(other)
    }

    /// As [`is_beside`](Self::is_beside) for what a triangle sweeps.
    fn has_beside(&self, sector: &MovingTriangle, other: &Outside) -> bool {
        let [q, r] = sector.side;
        let points = [q, r, sector.from, self.to];
        let middle = points.iter().sum::<DVec3>() / 4.0;
        Moving { points: &points, ids: &sector.ids, middle }.is_beside(other)
    }

    /// Exactly; `is_beside` may say of what a triangle sweeps that it meets nothing.
    fn meets_nothing_of(
        &self,
        other: &Outside,
        is_beside: impl Fn(&MovingTriangle) -> bool,
    ) -> Result<(), SimplifyRefusal> {
        let bounds = Aabb::of(other.corners);
        // A point of it that does not move with the star, and what the star is multiplied with to match.
        let on_rim = |id: &u32| self.rim.contains(id);
        let free = (0..3).find(|&k| !on_rim(&other.ids[k]));
        let (point, factor) = match free {
            Some(k) => (other.corners[k], 1.0),
            None => (other.corners.iter().sum(), 3.0),
        };
        for sector in &self.sectors {
            let [q, r] = sector.side;
            if !overlap(bounds, Aabb::of([sector.from, self.to, q, r])) || is_beside(sector) {
                continue;
            }
            if sector.stays && has_area(other.corners) {
                let ids = [self.merged, sector.ids[0], sector.ids[1]];
                let plane = ThreePointPlane::through([self.to, q, r]);
                if contact(&plane, other.corners.each_ref(), Shared::between(ids, other.ids)).is_some() {
                    return Err(SimplifyRefusal::SelfIntersection);
                }
            }
            for (q, id) in sector.side.into_iter().zip(sector.ids) {
                let wall = [sector.from, self.to, q];
                // The merged vertex and the one that moves are no corners of `other`.
                let shared = Shared::between([self.merged, self.merged, id], other.ids);
                if has_area(wall)
                    && has_area(other.corners)
                    && contact(&ThreePointPlane::through(wall), other.corners.each_ref(), shared).is_some()
                {
                    return Err(SimplifyRefusal::Swept);
                }
            }
            let tetrahedron = [sector.from * factor, self.to * factor, q * factor, r * factor];
            if is_inside(point, tetrahedron) {
                return Err(SimplifyRefusal::Swept);
            }
        }
        Ok(())
    }
}

/// The corners of something convex that a move sweeps.
struct Moving<'m> {
    points: &'m [DVec3],
    /// Numbers of the first ones, which do not move; the others are no corners of anything outside.
    ids: &'m [u32],
    middle: DVec3,
}

impl Moving<'_> {
    /// True when there is a plane, through the vertex or the edge that `other` shares with this if it does, that has this on one side
    /// and the rest of `other` on the other: they meet nowhere else.
    #[inline]
    fn is_beside(&self, other: &Outside) -> bool {
        let [a, b, c] = other.corners;
        let shared = other.ids.map(|id| is_among(self.ids, id));
        let (base, edge) = match shared {
            [false, false, false] => return self.is_apart([a, b, c]),
            [true, false, false] => (a, DVec3::ZERO),
            [false, true, false] => (b, DVec3::ZERO),
            [false, false, true] => (c, DVec3::ZERO),
            [true, true, false] => (a, b - a),
            [false, true, true] => (b, c - b),
            [true, false, true] => (c, a - c),
            [true, true, true] => return false,
        };
        let inward = self.middle - base;
        let outward = (other.corners[0] + other.corners[1] + other.corners[2]) / 3.0 - base;
        // The plane across the way to the middle, or the one halfway between the two.
        self.is_parted(other, shared, base, edge, inward)
            || self.is_parted(other, shared, base, edge, halfway(edge, inward, outward))
    }

    /// True when the plane through `base` and along `edge` across `normal` has all that moves on one side and the rest
    /// of `other` on the other.
    #[inline]
    fn is_parted(
        &self,
        other: &Outside,
        shared: [bool; 3],
        base: DVec3,
        edge: DVec3,
        mut normal: DVec3,
    ) -> bool {
        let length_squared = edge.length_squared();
        // What rounding can make of a product with a difference, by far, and what the edge is off the plane.
        let mut doubt = 1e-13 * size(normal);
        if length_squared > 0.0 {
            normal -= edge * (normal.dot(edge) / length_squared);
            doubt += 2.0 * normal.dot(edge).abs() / length_squared.sqrt();
        }
        let is_within = |p: DVec3| normal.dot(p - base) > doubt * size(p - base);
        let is_beyond = |p: DVec3| -normal.dot(p - base) > doubt * size(p - base);
        let is_shared = |i: usize| self.ids.get(i).is_some_and(|id| other.ids.contains(id));
        (0..3).all(|k| shared[k] || is_beyond(other.corners[k]))
            && self.points.iter().enumerate().all(|(i, &p)| is_within(p) || is_shared(i))
    }

    /// True when a plane between the middle of this and that of the triangle has them on its two sides.
    #[inline]
    fn is_apart(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let normal = (a + b + c) / 3.0 - self.middle;
        let beyond = |p: DVec3| normal.dot(p - self.middle);
        let nearest = beyond(a).min(beyond(b)).min(beyond(c));
        let reach = size(a - self.middle).max(size(b - self.middle)).max(size(c - self.middle));
        let doubt = |p: DVec3| 1e-13 * size(normal) * (reach + size(p - self.middle));
        self.points.iter().all(|&p| nearest - beyond(p) > doubt(p))
    }
}

/// Whether `id` is among `ids`. All are compared: several at once.
#[inline]
fn is_among(ids: &[u32], id: u32) -> bool {
    ids.iter().fold(false, |is_among, &other| is_among | (other == id))
}

/// The difference of the directions `inward` and `outward`, both across `edge`.
fn halfway(edge: DVec3, inward: DVec3, outward: DVec3) -> DVec3 {
    let length_squared = edge.length_squared();
    let across = |v: DVec3| if length_squared > 0.0 { v - edge * (v.dot(edge) / length_squared) } else { v };
    across(inward).normalize_or_zero() - across(outward).normalize_or_zero()
}

/// The sum of the magnitudes of the coordinates.
#[inline]
fn size(v: DVec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

#[inline]
fn overlap(a: Aabb, b: Aabb) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

/// True unless the corners are exactly on a line.
#[inline]
fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    let (u, v) = (b - a, c - a);
    // A sine that rounding cannot have made of zero.
    u.cross(v).length_squared() > 1e-24 * u.length_squared() * v.length_squared() || !are_collinear(a, b, c)
}

/// True when `p` is in the tetrahedron or on its border. Nothing is in one without a volume.
fn is_inside(p: DVec3, [a, b, c, d]: [DVec3; 4]) -> bool {
    let bounds = Aabb::of([a, b, c, d]);
    if !overlap(bounds, Aabb { min: p, max: p }) {
        return false;
    }
    let turn = orient3d(a, b, c, d);
    let agrees = |sign: Sign| sign == turn || sign == Sign::Zero;
    turn != Sign::Zero
        && agrees(orient3d(p, b, c, d))
        && agrees(orient3d(a, p, c, d))
        && agrees(orient3d(a, b, p, d))
        && agrees(orient3d(a, b, c, p))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pyramid without its base: the apex goes from height 1 to `height`.
    fn pyramid(height: f64) -> Sweep {
        let rim = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
        let mut sweep = Sweep::default();
        sweep.begin(DVec3::Z * height, 9);
        for k in 0..4 {
            sweep.add(DVec3::Z, [rim[k], rim[(k + 1) % 4]], [k as u32, (k as u32 + 1) % 4], true);
        }
        sweep.finish();
        sweep
    }

    fn triangle(at: DVec3, size: f64) -> Outside {
        Outside { ids: [20, 21, 22], corners: [at, at + DVec3::X * size, at + DVec3::Y * size] }
    }

    #[test]
    fn what_lies_in_the_swept_volume_is_swept_and_what_is_cut_is_met() {
        let down = pyramid(-1.0);
        assert_eq!(down.passes(&triangle(DVec3::new(0.1, 0.1, 0.0), 0.1)), Err(SimplifyRefusal::Swept));
        assert_eq!(
            down.passes(&triangle(DVec3::new(0.1, 0.1, -0.3), 9.0)),
            Err(SimplifyRefusal::SelfIntersection)
        );
        assert_eq!(down.passes(&triangle(DVec3::new(0.0, 0.0, 1.1), 9.0)), Ok(()));
        assert_eq!(down.passes(&triangle(DVec3::new(0.5, 0.5, -0.6), 0.1)), Ok(()));
        // The same above what remains.
        let little = pyramid(0.9);
        assert_eq!(little.passes(&triangle(DVec3::new(0.1, 0.1, 0.0), 0.1)), Ok(()));
        assert_eq!(little.passes(&triangle(DVec3::new(0.0, 0.0, 0.95), 0.001)), Err(SimplifyRefusal::Swept));
    }

    #[test]
    fn what_shares_the_rim_may_stay_where_it_is() {
        let neighbour =
            |z: f64| Outside { ids: [1, 0, 30], corners: [DVec3::Y, DVec3::X, DVec3::new(1.0, 1.0, z)] };
        let floor = Outside { ids: [0, 2, 1], corners: [DVec3::X, -DVec3::X, DVec3::Y] };
        for height in [0.5, 0.01, 3.0] {
            let sweep = pyramid(height);
            assert_eq!(sweep.passes(&neighbour(0.0)), Ok(()));
            assert_eq!(sweep.passes(&neighbour(-5.0)), Ok(()));
            assert_eq!(sweep.passes(&floor), Ok(()));
        }
        assert_eq!(
            pyramid(-1.0).passes(&floor),
            Err(SimplifyRefusal::Swept),
            "all its corners are on the rim"
        );
        let inner = Outside { ids: [1, 0, 30], corners: [DVec3::Y, DVec3::X, DVec3::ZERO] };
        assert_eq!(pyramid(-0.5).passes(&inner), Err(SimplifyRefusal::Swept));
        assert_eq!(pyramid(0.5).passes(&inner), Ok(()));
    }

    #[test]
    fn what_is_passed_sideways_is_swept_too() {
        let rim = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
        let mut sweep = Sweep::default();
        sweep.begin(DVec3::new(3.0, 0.0, 2.0), 9);
        for k in 0..4 {
            let ids = [k as u32, (k as u32 + 1) % 4];
            sweep.add(DVec3::new(-3.0, 0.0, 2.0), [rim[k], rim[(k + 1) % 4]], ids, true);
        }
        assert!(!sweep.finish().is_empty());
        // A pole across the way of the apex, between the places that the pyramid has before and after.
        let at = [DVec3::new(0.0, -9.0, 1.5), DVec3::new(0.0, 9.0, 1.5), DVec3::new(0.0, 9.0, 1.6)];
        assert_eq!(sweep.passes(&Outside { ids: [20, 21, 22], corners: at }), Err(SimplifyRefusal::Swept));
        let above = at.map(|p| p + DVec3::Z);
        assert_eq!(sweep.passes(&Outside { ids: [20, 21, 22], corners: above }), Ok(()));
    }

    #[test]
    fn planes_let_pass_only_what_meets_nothing() {
        let mut state = 7u64;
        let mut below = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        let (mut passed, mut refused) = (0, 0);
        for _ in 0..20_000 {
            // Places of a small grid, the first few around the vertex that moves, of which a triangle may have some as corners.
            let mut place = || DVec3::from_array([(); 3].map(|()| below(5) as f64));
            let places: Vec<DVec3> = (0..8).map(|_| place()).collect();
            let (from, to) = (place(), place());
            let mut sweep = Sweep::default();
            sweep.begin(to, 99);
            for k in 0..5u32 {
                let ids = [k, (k + 1) % 5];
                sweep.add(from, ids.map(|v| places[v as usize]), ids, below(4) > 0);
            }
            if sweep.finish().is_empty() {
                continue;
            }
            let ids = [below(8), below(8), below(8)].map(|v| v as u32);
            let other = Outside { ids, corners: ids.map(|v| places[v as usize]) };
            if ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0] || !has_area(other.corners) {
                continue;
            }
            let exactly = sweep.meets_nothing_of(&other, |_| false);
            assert_eq!(sweep.passes(&other), exactly, "{sweep:?} {other:?}");
            passed += u32::from(exactly.is_ok());
            refused += u32::from(exactly.is_err());
        }
        assert!(passed > 1000 && refused > 5000, "{passed} {refused}");
    }

    #[test]
    fn a_vertex_that_stays_sweeps_nothing() {
        let mut sweep = pyramid(1.0);
        assert!(sweep.finish().is_empty());
        assert_eq!(sweep.passes(&triangle(DVec3::new(-1.0, -1.0, 0.5), 9.0)), Ok(()));
    }
}
