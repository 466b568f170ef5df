//! Directions from a point, as unit vectors. Two things that are seen from a point in no common direction have no other
//! point in common.

use super::{Aabb, DVec3};

/// More than rounding moves a coordinate of a unit vector, also one rounded to f32 (2^-24, or 6e-8).
const ROUNDING: f64 = 1e-6;

/// More than rounding makes of the product of three unit vectors that is zero.
const PRODUCT_ROUNDING: f64 = 1e-14;

/// The directions to the points of a cone make at most an angle with this cosine with its middle one.
const COSINE_MIN: f64 = 0.1;

/// The box of all unit vectors.
const EVERYWHERE: Aabb = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };

/// The unit vector from `hub` to `p`; `None` when the difference is zero or out of the range of f64.
#[inline]
pub fn direction(hub: DVec3, p: DVec3) -> Option<DVec3> {
    let difference = p - hub;
    let largest = difference.abs().max_element();
    let is_usual = largest > 0.0 && largest.is_finite();
    is_usual.then(|| (difference / largest).normalize())
}

/// A box around all unit vectors from `hub` to points of the segment `q r`, with a margin for rounding them to f32.
///
/// They form an arc of the unit circle in the triangle's plane. With a chord of length `c` it leaves the chord by at
/// most `1 - sqrt(1 - c^2 / 4)`, which is at most `c^2 / 4`.
pub fn arc_box(hub: DVec3, q: DVec3, r: DVec3) -> Aabb {
    let (Some(u), Some(v)) = (direction(hub, q), direction(hub, r)) else {
        return EVERYWHERE;
    };
    let margin = (u - v).length_squared() / 4.0 + ROUNDING;
    Aabb { min: u.min(v) - margin, max: u.max(v) + margin }
}

/// The directions from a point to the convex hull of a few others.
#[derive(Debug, Clone, Copy)]
pub struct DirectionCone {
    bounds: Aabb,
    /// All directions of the cone are behind the planes across these, within rounding.
    normals: [DVec3; 6],
    count: usize,
}

impl DirectionCone {
    /// The cone over two to four points; `None` when they may be seen all around the hub.
    pub fn over(hub: DVec3, points: impl Iterator<Item = DVec3>) -> Option<Self> {
        let mut units = [DVec3::ZERO; 4];
        let mut len = 0;
        for p in points {
            *units.get_mut(len)? = direction(hub, p)?;
            len += 1;
        }
        let units = &units[..len];
        let middle = units.iter().sum::<DVec3>().try_normalize()?;
        let cosine = units.iter().map(|u| u.dot(middle)).fold(1.0, f64::min);
        if cosine < COSINE_MIN {
            return None;
        }
        let chords = Aabb::of(units.iter().copied());
        // A mean of the units is no shorter than the cosine, and as a unit vector it is farther out by what is missing.
        let margin = 1.0 - cosine + ROUNDING;
        let bounds = Aabb { min: chords.min - margin, max: chords.max + margin };
        let mut cone = Self { bounds, normals: [DVec3::ZERO; 6], count: 0 };
        for (i, u) in units.iter().enumerate() {
            for v in &units[i + 1..] {
                let across = u.cross(*v);
                let is_behind = |n: DVec3| units.iter().all(|w| n.dot(*w) <= PRODUCT_ROUNDING);
                if let Some(normal) = [across, -across].into_iter().find(|&n| is_behind(n)) {
                    cone.normals[cone.count] = normal;
                    cone.count += 1;
                }
            }
        }
        Some(cone)
    }

    /// False only when no direction of the cone is in the box, which must have a margin for the rounding of its own.
    #[inline]
    pub fn may_meet(&self, directions: &Aabb) -> bool {
        let Self { bounds, normals, count } = self;
        if !(bounds.min.cmple(directions.max).all() && directions.min.cmple(bounds.max).all()) {
            return false;
        }
        // A unit vector of the cone is a sum of the units, whose factors are together at most the reciprocal of the
        // cosine: in front of a plane by no more than rounding times that.
        let doubt = PRODUCT_ROUNDING * 4.0 / COSINE_MIN;
        normals[..*count].iter().all(|n| {
            let least = n.min(DVec3::ZERO).dot(directions.max) + n.max(DVec3::ZERO).dot(directions.min);
            least <= doubt
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Numbers(u64);

    impl Numbers {
        /// From -1 to 1 (Knuth's MMIX generator).
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.next(), self.next(), self.next())
        }
    }

    fn holds(bounds: Aabb, p: DVec3) -> bool {
        bounds.min.cmple(p).all() && p.cmple(bounds.max).all()
    }

    #[test]
    fn the_box_holds_every_direction_to_the_far_edge() {
        let hub = DVec3::new(1.0, 2.0, 3.0);
        for (q, r) in [
            (DVec3::X, DVec3::Y),
            (DVec3::new(1.0, 0.01, 0.0), DVec3::new(-1.0, 0.01, 0.0)),
            (DVec3::splat(1e-9), DVec3::new(5.0, -3.0, 1e5)),
        ] {
            let bounds = arc_box(hub, hub + q, hub + r);
            for i in 0..=100 {
                let unit = q.lerp(r, f64::from(i) / 100.0).normalize();
                assert!(holds(bounds, unit.as_vec3().as_dvec3()), "{q} {r} {i}");
            }
        }
        assert_eq!(arc_box(DVec3::splat(-f64::MAX), DVec3::MAX, DVec3::X), EVERYWHERE);
        assert_eq!(arc_box(DVec3::X, DVec3::X, DVec3::Y), EVERYWHERE);
    }

    #[test]
    fn a_cone_meets_every_box_that_holds_one_of_its_directions() {
        let mut numbers = Numbers(3);
        let (mut cones, mut missed) = (0, 0);
        for case in 0..20_000 {
            let hub = numbers.point() * [0.0, 1.0, 1e6][case % 3];
            let scale = [1.0, 1e-30, 1e30][case / 3 % 3];
            let flat = [1.0, 1e-4, 0.0][case / 9 % 3];
            let mut points = [(); 4].map(|()| DVec3::X * 1.5 + numbers.point() * DVec3::new(1.0, 1.0, flat));
            if case % 5 == 0 {
                points[3] = points[0];
            }
            let points = points.map(|p| (hub + p) * scale);
            let hub = hub * scale;
            let count = 2 + case % 3;
            let Some(cone) = DirectionCone::over(hub, points[..count].iter().copied()) else { continue };
            cones += 1;
            let shares = [(); 4].map(|()| numbers.next().abs());
            let sum: f64 = shares[..count].iter().sum();
            let inside: DVec3 = (0..count).map(|k| (points[k] - hub) * (shares[k] / sum)).sum();
            let Some(unit) = direction(DVec3::ZERO, inside) else { continue };
            let away = numbers.point().abs() * 0.01;
            let around = Aabb { min: unit - away - ROUNDING, max: unit + ROUNDING };
            assert!(cone.may_meet(&around), "{case}");
            let other = numbers.point().normalize();
            missed += u32::from(!cone.may_meet(&Aabb { min: other - 0.01, max: other + 0.01 }));
        }
        assert!(cones > 10_000 && missed > cones * 3 / 4, "{missed} of {cones}");
    }

    #[test]
    fn what_is_all_around_has_no_cone_and_a_thin_one_misses_its_neighbours() {
        let around = [DVec3::X, DVec3::new(-1.0, 1.0, 0.0), DVec3::new(-1.0, -1.0, 0.0)];
        assert!(DirectionCone::over(DVec3::ZERO, around.into_iter()).is_none());
        assert!(DirectionCone::over(DVec3::X, around.into_iter()).is_none(), "the hub is one of the points");
        // From the axis to a rim, in a diagonal half-plane.
        let rim = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
        let cone = DirectionCone::over(DVec3::ZERO, [rim(0.8), rim(0.801), DVec3::Z].into_iter());
        let meets = |angle: f64| {
            cone.is_none_or(|c| c.may_meet(&arc_box(DVec3::ZERO, rim(angle), rim(angle + 1e-3))))
        };
        assert!(meets(0.8) && meets(0.7995) && meets(0.8005));
        assert!(!meets(0.798) && !meets(0.802) && !meets(1.2) && !meets(4.0));
    }
}
