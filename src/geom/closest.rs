//! The point of a triangle that is closest to another point.

use super::DVec3;

/// Sines of angles below this are not told from zero: the triangle is taken as its three edges, which moves no point
/// of it by more than this share of its longest edge.
const SINE_MIN: f64 = 1e-10;

/// The point of the triangle closest to `p`, rounded. Degenerate triangles are segments or points.
///
/// Whatever the rounding, the answer is a convex combination of the corners up to a few units in the last place of
/// their coordinates, so its distance to `p` is never less than the true one by more than that. Differences whose
/// squares leave the range of f64 give infinities or zeros.
///
/// Where `p` projects outside, the closest point is on an edge that separates the projection from the triangle
/// (necessary condition of a nearest point of a convex set), so only those edges are looked at.
pub fn closest_point_on_triangle(p: DVec3, corners: [DVec3; 3]) -> DVec3 {
    closest_with_square(p, corners).0
}

/// As [`closest_point_on_triangle`], with the square of its distance.
#[inline]
pub(crate) fn closest_with_square(p: DVec3, [a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    let mut closest = Closest { to: p, point: DVec3::INFINITY, square: f64::INFINITY };
    if square <= SINE_MIN * SINE_MIN * ab.length_squared() * ac.length_squared() {
        closest.first(on_edge(p, a, b));
        closest.or(on_edge(p, b, c));
        closest.or(on_edge(p, c, a));
        return (closest.point, closest.square);
    }
    let of_c = normal.dot(ab.cross(ap));
    let of_b = normal.dot(ap.cross(ac));
    let of_a = normal.dot((c - b).cross(p - b));
    if of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0 {
        let sum = of_a + of_b + of_c;
        closest.first(a + ab * (of_b / sum) + ac * (of_c / sum));
        return (closest.point, closest.square);
    }
    for (weight, from, to) in [(of_c, a, b), (of_a, b, c), (of_b, c, a)] {
        if weight < 0.0 {
            closest.or(on_edge(p, from, to));
        }
    }
    (closest.point, closest.square)
}

/// The closest of some points.
struct Closest {
    to: DVec3,
    point: DVec3,
    square: f64,
}

impl Closest {
    #[inline]
    fn first(&mut self, point: DVec3) {
        (self.point, self.square) = (point, point.distance_squared(self.to));
    }

    /// Takes `point` where it is closer.
    #[inline]
    fn or(&mut self, point: DVec3) {
        let square = point.distance_squared(self.to);
        if square < self.square {
            (self.point, self.square) = (point, square);
        }
    }
}

/// The shares of the corners of a triangle in the point `on` it: they are not negative and have the sum 1, and the mean of the
/// corners with these weights is the point. `None` when the triangle has no area.
pub fn shares_of_corners(on: DVec3, [a, b, c]: [DVec3; 3]) -> Option<[f64; 3]> {
    let normal = (b - a).cross(c - a);
    let part = |q: DVec3, r: DVec3| (q - on).cross(r - on).dot(normal).max(0.0);
    let parts = [part(b, c), part(c, a), part(a, b)];
    let sum: f64 = parts.iter().sum();
    (sum > 0.0 && sum.is_finite()).then(|| parts.map(|part| part / sum))
}

#[inline]
fn on_edge(p: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let along = to - from;
    let square = along.length_squared();
    let share = (p - from).dot(along) / square;
    if share >= 1.0 {
        to
    } else if share > 0.0 {
        from + along * share
    } else {
        // Also the NaN of an edge without length.
        from
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];

    #[test]
    fn each_region_around_a_triangle_has_its_closest_point() {
        for (p, closest) in [
            ([1.0, 1.0, 5.0], [1.0, 1.0, 0.0]),
            ([-1.0, -2.0, 3.0], [0.0, 0.0, 0.0]),
            ([9.0, -1.0, 0.0], [4.0, 0.0, 0.0]),
            ([-1.0, 7.0, 1.0], [0.0, 4.0, 0.0]),
            ([2.0, -3.0, 1.0], [2.0, 0.0, 0.0]),
            ([-3.0, 1.0, 1.0], [0.0, 1.0, 0.0]),
            ([4.0, 4.0, 2.0], [2.0, 2.0, 0.0]),
        ] {
            assert_eq!(closest_point_on_triangle(p.into(), CORNERS), DVec3::from(closest), "{p:?}");
        }
    }

    #[test]
    fn shares_have_the_sum_1_and_give_the_point_again() {
        assert_eq!(shares_of_corners(DVec3::new(1.0, 1.0, 0.0), CORNERS), Some([0.5, 0.25, 0.25]));
        assert_eq!(shares_of_corners(CORNERS[2], CORNERS), Some([0.0, 0.0, 1.0]));
        assert_eq!(shares_of_corners(DVec3::ZERO, [DVec3::ZERO, DVec3::X, DVec3::X]), None);
    }

    #[test]
    fn no_point_of_a_fine_grid_on_the_triangle_is_closer() {
        let mut state = 1u32;
        let mut random = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) * 2.0 - 1.0
        };
        for round in 0..2_000 {
            let mut point = || DVec3::new(random(), random(), random());
            let (p, mut corners) = (point(), [point(), point(), point()]);
            if round % 5 == 0 {
                // Obtuse, down to degenerate.
                corners[2] = corners[0].lerp(corners[1], 0.3) + point() * f64::powi(0.01, round % 8);
            }
            let found = closest_point_on_triangle(p, corners).distance(p);
            let [a, b, c] = corners;
            let sampled = (0..=40).flat_map(|i| (0..=40 - i).map(move |j| (i, j))).map(|(i, j)| {
                (a + (b - a) * (f64::from(i) / 40.0) + (c - a) * (f64::from(j) / 40.0)).distance(p)
            });
            let sampled = sampled.fold(f64::INFINITY, f64::min);
            assert!(found <= sampled + 1e-9, "{round}: {found} > {sampled}");
            assert!(sampled - found < 0.1, "{round}: {found} is off the triangle, {sampled}");
        }
    }

    #[test]
    fn segments_and_points_are_triangles_too() {
        let (a, b) = (DVec3::ZERO, DVec3::X * 2.0);
        assert_eq!(closest_point_on_triangle(DVec3::new(1.5, 1.0, 0.0), [a, b, a]), DVec3::X * 1.5);
        assert_eq!(closest_point_on_triangle(DVec3::new(1.5, 1.0, 0.0), [a, DVec3::X, b]), DVec3::X * 1.5);
        assert_eq!(closest_point_on_triangle(DVec3::Y, [b; 3]), b);
    }
}
