//! Sums of weighted squared distances from planes, as ten numbers.
//!
//! Garland and Heckbert, "Surface simplification using quadric error metrics" (1997), with the weights of Garland's
//! thesis (1999): the area of the triangle behind each plane. Two deviations. A quadric is kept *about a point of its
//! owner's choice* (a vertex: its own position) and moved when it is added to another, so that its accuracy follows
//! the size of the edges and not the distance from the file's origin. And where the planes do not fix a point (flat
//! and cylindrical areas) the minimum is sought only across the directions that they fix, as Lindstrom, "Out-of-core
//! simplification of large polygonal models" (2000), does with a singular value decomposition; the three eigenspaces
//! of a 3 x 3 matrix that matter are found here without iteration, so that no library of transcendental functions and
//! no convergence test takes part.

use crate::geom::DVec3;
use std::ops::{Add, AddAssign, Mul};

/// Below this share of the largest eigenvalue an eigenvalue counts as zero: planes within about `1e-2` radians of one
/// another fix no point along their common directions, they only amplify noise. Of 1e-3 to 1e-8 it gave the least
/// distances on 70 models of the corpus.
const NEGLIGIBLE: f64 = 1e-4;

/// `f(x) = x A x + 2 b x + c` with a symmetric, positive semidefinite `A`; `x` is counted from a point that the owner
/// of the quadric knows. `f` is a sum of weights times squared distances, and `A`'s trace is the sum of the weights.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Quadric {
    /// `A`: xx, yy, zz, xy, xz, yz.
    a: [f64; 6],
    b: DVec3,
    c: f64,
}

/// Where a quadric is smallest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// The place, counted from the quadric's point.
    pub position: DVec3,
    /// Number of directions (0 to 3) along which the planes decided; along the others it is the start's coordinate.
    pub rank: u8,
}

impl Quadric {
    /// The sum of nothing.
    pub const ZERO: Self = Self { a: [0.0; 6], b: DVec3::ZERO, c: 0.0 };

    /// `weight` times the squared distance from the plane through `point` (counted from the quadric's point) that is
    /// perpendicular to the unit vector `normal`.
    #[inline]
    pub fn of_plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let distance = -normal.dot(point);
        let n = normal * weight;
        Self {
            a: [
                n.x * normal.x,
                n.y * normal.y,
                n.z * normal.z,
                n.x * normal.y,
                n.x * normal.z,
                n.y * normal.z,
            ],
            b: n * distance,
            c: weight * distance * distance,
        }
    }

    /// The squared distance from the plane of the points whose product with `normal` is `height`, weighted with the
    /// squared length of `normal`.
    #[inline]
    pub(super) fn of_normal(normal: DVec3, height: f64) -> Self {
        let n = normal;
        Self {
            a: [n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z],
            b: n * -height,
            c: height * height,
        }
    }

    /// The plane of a triangle, weighted with its area, about the first corner; [`ZERO`](Self::ZERO) when the triangle
    /// has no area in f64.
    #[inline]
    pub fn of_triangle([p, q, r]: [DVec3; 3]) -> Self {
        let cross = (q - p).cross(r - p);
        let twice_area = cross.length();
        if twice_area == 0.0 || !twice_area.is_finite() {
            return Self::ZERO;
        }
        Self::of_plane(cross / twice_area, DVec3::ZERO, 0.5 * twice_area)
    }

    /// The wall on the edge from `p` to `q`: the plane through both that is perpendicular to the face with the (not
    /// necessarily unit) `face_normal`, weighted with `weight` times the squared length of the edge, about `p`. It
    /// holds a border or a crease in place across the edge. [`ZERO`](Self::ZERO) when no such plane is defined.
    #[inline]
    pub fn of_wall(p: DVec3, q: DVec3, face_normal: DVec3, weight: f64) -> Self {
        let across = (q - p).cross(face_normal);
        let length = across.length();
        if length == 0.0 || !length.is_finite() {
            return Self::ZERO;
        }
        Self::of_plane(across / length, DVec3::ZERO, weight * p.distance_squared(q))
    }

    /// The same function about another point: `shift` from the present one.
    #[inline]
    #[must_use]
    pub fn about(&self, shift: DVec3) -> Self {
        let a_shift = self.times(shift);
        Self {
            a: self.a,
            b: self.b + a_shift,
            // The true value is not negative; rounding must not make it so.
            c: (self.c + 2.0 * self.b.dot(shift) + shift.dot(a_shift)).max(0.0),
        }
    }

    /// The value at `x`, counted from the quadric's point; never negative.
    #[inline]
    pub fn value(&self, x: DVec3) -> f64 {
        (x.dot(self.times(x)) + 2.0 * self.b.dot(x) + self.c).max(0.0)
    }

    /// Sum of the weights of its planes.
    #[inline]
    pub fn weight(&self) -> f64 {
        self.a[0] + self.a[1] + self.a[2]
    }

    /// The value at the quadric's own point.
    #[inline]
    pub fn value_here(&self) -> f64 {
        self.c
    }

    #[inline]
    fn times(&self, x: DVec3) -> DVec3 {
        let [xx, yy, zz, xy, xz, yz] = self.a;
        DVec3::new(
            xx * x.x + xy * x.y + xz * x.z,
            xy * x.x + yy * x.y + yz * x.z,
            xz * x.x + yz * x.y + zz * x.z,
        )
    }

    /// Where the quadric is smallest, sought from `start` only across the directions that the planes fix: of the
    /// points with the least value, the nearest to `start`. Both are counted from the quadric's point.
    #[inline]
    pub fn minimum(&self, start: DVec3) -> Minimum {
        let trace = self.weight();
        let half_gradient = self.times(start) + self.b;
        let minors = Minors::of(&self.a);
        // With eigenvalues p >= q >= r: p + q + r, pq + pr + qr, pqr. So minors / trace is about q, and
        // determinant / minors about r, as soon as they are small.
        let second = minors.sum();
        if second.is_nan() || second <= NEGLIGIBLE * trace * trace {
            return self.minimum_across_one_direction(start, half_gradient, trace);
        }
        if minors.determinant(&self.a) > NEGLIGIBLE * trace * second {
            let step = minors.solve(&self.a, half_gradient);
            return Minimum { position: start - step, rank: 3 };
        }
        self.minimum_across_two_directions(start, half_gradient, trace, &minors)
    }

    /// All planes are nearly parallel: move along their normal.
    fn minimum_across_one_direction(&self, start: DVec3, half_gradient: DVec3, trace: f64) -> Minimum {
        let [xx, yy, zz, xy, xz, yz] = self.a;
        let columns = [DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz)];
        let normal = longest(columns);
        let eigenvalue = normal.dot(self.times(normal));
        // A quadric without planes, or one that overflowed, moves nothing.
        if eigenvalue.is_nan() || eigenvalue < 0.25 * trace || trace == 0.0 {
            return Minimum { position: start, rank: 0 };
        }
        Minimum { position: start - normal * (normal.dot(half_gradient) / eigenvalue), rank: 1 }
    }

    /// All planes are nearly parallel to one line: move perpendicular to it.
    fn minimum_across_two_directions(
        &self,
        start: DVec3,
        half_gradient: DVec3,
        trace: f64,
        minors: &Minors,
    ) -> Minimum {
        let line = longest(minors.columns());
        // A third plane across the line makes the system regular and leaves the other two directions alone.
        let regular = *self + Self::of_plane(line, DVec3::ZERO, trace);
        let across = half_gradient - line * line.dot(half_gradient);
        let step = Minors::of(&regular.a).solve(&regular.a, across);
        Minimum { position: start - (step - line * line.dot(step)), rank: 2 }
    }

    /// Where the quadric is smallest on the plane through `start` that is perpendicular to the unit vector `normal`,
    /// sought from `start` only along the directions that the planes fix.
    pub fn minimum_on_plane(&self, normal: DVec3, start: DVec3) -> DVec3 {
        let u = normal.any_orthonormal_vector();
        let w = normal.cross(u);
        let (a_u, a_w) = (self.times(u), self.times(w));
        let (uu, uw, ww) = (u.dot(a_u), u.dot(a_w), w.dot(a_w));
        let half_gradient = self.times(start) + self.b;
        let (g_u, g_w) = (u.dot(half_gradient), w.dot(half_gradient));
        let (sum, determinant) = (uu + ww, uu * ww - uw * uw);
        if sum.is_nan() || sum <= NEGLIGIBLE * self.weight() {
            return start;
        }
        if determinant > NEGLIGIBLE * sum * sum {
            let (x, y) = (ww * g_u - uw * g_w, uu * g_w - uw * g_u);
            return start - (u * x + w * y) / determinant;
        }
        // One direction: that of the longer column, with the sum as its eigenvalue.
        let (x, y) = if uu > ww { (uu, uw) } else { (uw, ww) };
        let step = (x * g_u + y * g_w) / ((x * x + y * y) * sum);
        start - (u * x + w * y) * step
    }
}

/// The longest of three vectors, as a unit vector; zero when all are.
fn longest(vectors: [DVec3; 3]) -> DVec3 {
    let [x, y, z] = vectors;
    let first = if y.length_squared() > x.length_squared() { y } else { x };
    let longest = if z.length_squared() > first.length_squared() { z } else { first };
    longest.normalize_or_zero()
}

/// The adjugate of a symmetric matrix, in the order xx, yy, zz, xy, xz, yz.
struct Minors([f64; 6]);

impl Minors {
    #[inline]
    fn of(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> Self {
        Self([
            yy * zz - yz * yz,
            xx * zz - xz * xz,
            xx * yy - xy * xy,
            xz * yz - xy * zz,
            xy * yz - xz * yy,
            xy * xz - xx * yz,
        ])
    }

    /// The sum of the products of two eigenvalues.
    #[inline]
    fn sum(&self) -> f64 {
        self.0[0] + self.0[1] + self.0[2]
    }

    #[inline]
    fn determinant(&self, a: &[f64; 6]) -> f64 {
        a[0] * self.0[0] + a[3] * self.0[3] + a[4] * self.0[4]
    }

    /// The solution `x` of `A x = right`.
    #[inline]
    fn solve(&self, a: &[f64; 6], right: DVec3) -> DVec3 {
        Quadric { a: self.0, b: DVec3::ZERO, c: 0.0 }.times(right) / self.determinant(a)
    }

    fn columns(&self) -> [DVec3; 3] {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        [DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz)]
    }
}

impl AddAssign for Quadric {
    /// Adds a quadric about the same point.
    #[inline]
    fn add_assign(&mut self, other: Self) {
        for (x, y) in self.a.iter_mut().zip(other.a) {
            *x += y;
        }
        self.b += other.b;
        self.c += other.c;
    }
}

impl Add for Quadric {
    type Output = Self;

    /// The sum of two quadrics about the same point.
    #[inline]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Mul<f64> for Quadric {
    type Output = Self;

    /// All weights times `factor`.
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self { a: self.a.map(|x| x * factor), b: self.b * factor, c: self.c * factor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fixed sequence of numbers in -1..1.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 * 2f64.powi(-52) - 1.0
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.next(), self.next(), self.next())
        }

        fn unit(&mut self) -> DVec3 {
            self.point().normalize()
        }
    }

    fn sum(planes: &[(DVec3, DVec3, f64)]) -> Quadric {
        planes.iter().fold(Quadric::ZERO, |q, &(n, p, w)| q + Quadric::of_plane(n, p, w))
    }

    fn naive(planes: &[(DVec3, DVec3, f64)], x: DVec3) -> f64 {
        planes.iter().map(|&(n, p, w)| w * n.dot(x - p).powi(2)).sum()
    }

    #[test]
    fn the_value_is_the_sum_of_weighted_squared_distances_about_any_point() {
        let mut numbers = Numbers(1);
        for _ in 0..1000 {
            let planes: Vec<_> =
                (0..6).map(|_| (numbers.unit(), numbers.point(), numbers.next().abs())).collect();
            let (quadric, x, shift) = (sum(&planes), numbers.point(), numbers.point());
            let want = naive(&planes, x);
            assert!((quadric.value(x) - want).abs() < 1e-12);
            assert!((quadric.about(shift).value(x - shift) - want).abs() < 1e-12);
            assert!((quadric.about(x).value_here() - want).abs() < 1e-12);
            assert!((quadric.weight() - planes.iter().map(|p| p.2).sum::<f64>()).abs() < 1e-12);
            assert!(((quadric * 3.0).value(x) - 3.0 * want).abs() < 1e-11);
        }
    }

    #[test]
    fn three_planes_in_general_position_meet_in_the_minimum() {
        let mut numbers = Numbers(2);
        for _ in 0..1000 {
            let meeting = numbers.point();
            let planes: Vec<_> = [DVec3::X, DVec3::Y, DVec3::Z]
                .map(|n| ((n + 0.4 * numbers.point()).normalize(), meeting, 1.0))
                .into();
            let minimum = sum(&planes).minimum(numbers.point());
            assert_eq!(minimum.rank, 3);
            assert!(minimum.position.distance(meeting) < 1e-10, "{minimum:?} {meeting}");
        }
    }

    #[test]
    fn no_point_nearby_is_lower_than_the_minimum() {
        let mut numbers = Numbers(3);
        for case in 0..2000 {
            // From planes in all directions to planes within 1e-4 radians of one or of a line's.
            let spread = 10f64.powi(-(case % 5));
            let (axis, line) = (numbers.unit(), numbers.unit());
            let across = axis.cross(line).normalize();
            let planes: Vec<_> = (0..5)
                .map(|_| {
                    let wide =
                        if case % 2 == 0 { axis } else { axis * numbers.next() + across * numbers.next() };
                    ((wide.normalize() + spread * numbers.point()).normalize(), numbers.point() * 0.1, 1.0)
                })
                .collect();
            let (quadric, start) = (sum(&planes), numbers.point());
            let minimum = quadric.minimum(start);
            let lowest = quadric.value(minimum.position);
            assert!(lowest <= quadric.value(start) + 1e-12);
            for _ in 0..20 {
                let step = numbers.point() * 0.01 * quadric.weight().sqrt();
                let gain = lowest - quadric.value(minimum.position + step);
                // What the neglected directions could still give.
                assert!(
                    gain <= 4.0 * NEGLIGIBLE.sqrt() * quadric.weight(),
                    "case {case}: {gain} {minimum:?}"
                );
                if minimum.rank == 3 {
                    assert!(gain <= 1e-9, "case {case}: {gain}");
                }
            }
        }
    }

    #[test]
    fn on_a_flat_area_the_start_moves_only_onto_the_plane() {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let on_plane = DVec3::new(0.3, -0.2, 0.9);
        let quadric = sum(&[(normal, on_plane, 2.0), (-normal, on_plane, 0.5)]);
        let start = DVec3::new(4.0, 5.0, 6.0);
        let minimum = quadric.minimum(start);
        assert_eq!(minimum.rank, 1);
        let foot = start - normal * normal.dot(start - on_plane);
        assert!(minimum.position.distance(foot) < 1e-14);
    }

    #[test]
    fn along_a_fold_the_start_keeps_its_place_on_the_line() {
        let mut numbers = Numbers(4);
        for _ in 0..500 {
            let (line, through) = (numbers.unit(), numbers.point());
            let n = line.any_orthonormal_vector();
            let m = (n + 0.5 * line.cross(n)).normalize();
            let start = numbers.point();
            let minimum = sum(&[(n, through, 1.0), (m, through, 3.0)]).minimum(start);
            assert_eq!(minimum.rank, 2);
            let foot = through + line * line.dot(start - through);
            assert!(minimum.position.distance(foot) < 1e-12, "{minimum:?} {foot}");
        }
    }

    #[test]
    fn on_a_plane_the_minimum_is_the_lowest_point_of_that_plane() {
        let mut numbers = Numbers(5);
        for case in 0..1000 {
            let planes: Vec<_> = (0..1 + case % 5)
                .map(|_| (numbers.unit(), numbers.point(), numbers.next().abs() + 0.1))
                .collect();
            let (quadric, normal, start) = (sum(&planes), numbers.unit(), numbers.point());
            let lowest = quadric.minimum_on_plane(normal, start);
            assert!(normal.dot(lowest - start).abs() < 1e-9, "case {case}");
            for _ in 0..20 {
                let step = normal.cross(numbers.point()) * 0.1;
                let gain = quadric.value(lowest) - quadric.value(lowest + step);
                // What a neglected direction could still give: its slope is at most the root of value times eigenvalue.
                let slope = (quadric.value(lowest) * NEGLIGIBLE * quadric.weight()).sqrt();
                assert!(gain <= 2.0 * slope * step.length() + 1e-9, "case {case}: {gain}");
            }
        }
        assert_eq!(Quadric::ZERO.minimum_on_plane(DVec3::X, DVec3::ONE), DVec3::ONE);
    }

    #[test]
    fn without_planes_nothing_moves() {
        let start = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(Quadric::ZERO.minimum(start), Minimum { position: start, rank: 0 });
        assert_eq!(Quadric::of_triangle([start, start, start]), Quadric::ZERO);
        assert_eq!(Quadric::of_wall(start, start, DVec3::X, 1.0), Quadric::ZERO);
    }

    #[test]
    fn triangles_are_weighted_with_their_area_and_walls_with_their_squared_length() {
        let corners = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 3.0];
        let quadric = Quadric::of_triangle(corners);
        assert_eq!(quadric.weight(), 3.0);
        assert_eq!(quadric.value(DVec3::new(9.0, 9.0, 0.5)), 0.75);
        let wall = Quadric::of_wall(corners[0], corners[1], DVec3::Z, 10.0);
        assert_eq!(wall.value(DVec3::new(5.0, 0.0, 7.0)), 0.0);
        assert_eq!(wall.value(DVec3::new(1.0, 0.5, 0.0)), 10.0);
    }

    #[test]
    fn far_from_the_origin_of_the_file_nothing_is_lost_about_a_near_point() {
        // A corner of a cube a million away, sought to a millionth: squares of the coordinates would need 24 digits.
        let corner = DVec3::new(1e6, -1e6, 1e6);
        let at = corner + DVec3::new(1e-3, 2e-3, -1e-3);
        let quadric = [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .fold(Quadric::ZERO, |q, n| q + Quadric::of_plane(n, corner - at, 1e-6));
        let minimum = quadric.minimum(DVec3::ZERO);
        assert!((at + minimum.position).distance(corner) < 1e-9);
        assert!(quadric.value(minimum.position) < 1e-24);
    }
}
