//! The measures of one loop.

use crate::analysis::best_plane::BestPlane;
use crate::geom::{Aabb, DVec3};

/// How large and how flat a loop is, in the unit of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LoopShape {
    /// Number of edges.
    pub(super) edges: u32,
    /// Sum of their lengths.
    pub(super) length: f64,
    /// Area inside of the loop in the view in which that is largest: that of a flat patch.
    pub(super) area: f64,
    /// Largest distance of a vertex from the plane that fits them best.
    pub(super) deviation: f64,
    /// Unit normal of that plane.
    pub(super) normal: DVec3,
    /// Distance of two vertices that are far from each other: the farthest from the middle, and the farthest from that
    /// one. At least the largest distance of any two by the square root of 3.
    pub(super) diameter: f64,
    /// How far apart the two sides of the loop are at most, at equal shares of their lengths: those between these two
    /// vertices, or, if that is less, those from the sharpest turn on to half of the length.
    pub(super) width: f64,
    /// The faces are beyond the sides of the loop rather than between them.
    pub(super) is_around: bool,
}

/// Two sides of a loop from one vertex to another.
struct Sides<'p> {
    points: &'p [DVec3],
    /// Length of the loop from its first point to each point, and all around.
    along: Vec<f64>,
    /// The point where the first side ends.
    far: usize,
}

impl LoopShape {
    /// The measures of the closed chain through `points`; `apexes[i]` is the third corner of the triangle at the edge from
    /// point `i` on.
    pub(super) fn of(points: &[DVec3], apexes: &[DVec3]) -> Self {
        let plane = BestPlane::of(points.iter().copied());
        let bounds = Aabb::of(points.iter().copied());
        let origin = bounds.min / 2.0 + bounds.max / 2.0;
        let half = (bounds.max / 2.0 - bounds.min / 2.0).max_element();
        let mut shape = Self {
            edges: points.len() as u32,
            length: 0.0,
            area: 0.0,
            deviation: plane.deviation,
            normal: plane.normal,
            diameter: 0.0,
            width: 0.0,
            is_around: true,
        };
        if half.is_nan() || half <= 0.0 {
            return shape;
        }
        // From -1 to 1, so that squares neither overflow nor vanish.
        let unit: Vec<DVec3> = points.iter().map(|p| (p - origin) / half).collect();
        let doubled: DVec3 = unit.iter().zip(unit.iter().cycle().skip(1)).map(|(p, q)| p.cross(*q)).sum();
        shape.area = doubled.length() / 2.0 * half * half;
        let middle = unit.iter().sum::<DVec3>() / unit.len() as f64;
        let apexes: Vec<DVec3> = apexes.iter().map(|p| (p - origin) / half).collect();
        let from = |tip: usize, of: &[DVec3]| [&of[tip..], &of[..tip]].concat();
        // A straight crack ends where the loop is longest, one that winds where the loop turns back.
        let (tip, turn) = (farthest(&unit, middle), sharpest_turn(&unit));
        let (from_tip, from_turn) = (from(tip, &unit), from(turn, &unit));
        let by_distance = Sides::of(&from_tip, farthest(&from_tip, from_tip[0]));
        let by_length = Sides::halves(&from_turn);
        shape.length = by_distance.along[points.len()] * half;
        shape.diameter = from_tip[0].distance(from_tip[by_distance.far]) * half;
        let widths = [by_distance.width(&from(tip, &apexes)), by_length.width(&from(turn, &apexes))];
        let (width, is_around) = if widths[1].0 < widths[0].0 { widths[1] } else { widths[0] };
        (shape.width, shape.is_around) = (width * half, is_around);
        shape
    }

    /// Mean length of an edge.
    pub(super) fn mean_edge(&self) -> f64 {
        self.length / f64::from(self.edges)
    }
}

/// The first of the points that are farthest from `from`.
fn farthest(points: &[DVec3], from: DVec3) -> usize {
    let distance = |i: usize| points[i].distance_squared(from);
    (1..points.len()).fold(0, |best, i| if distance(i) > distance(best) { i } else { best })
}

/// The first of the points where the loop turns most; none turns where two are at one place.
fn sharpest_turn(points: &[DVec3]) -> usize {
    let n = points.len();
    let cosine = |i: usize| {
        let [before, after] = [points[i] - points[(i + n - 1) % n], points[(i + 1) % n] - points[i]];
        if before == DVec3::ZERO || after == DVec3::ZERO {
            1.0
        } else {
            before.normalize().dot(after.normalize())
        }
    };
    let cosines: Vec<f64> = (0..n).map(cosine).collect();
    (1..n).fold(0, |best, i| if cosines[i] < cosines[best] { i } else { best })
}

/// The direction from the edge `a` to `b` into its triangle; zero where it has no height.
pub(super) fn inward(a: DVec3, b: DVec3, apex: DVec3) -> DVec3 {
    let along = (b - a).normalize_or_zero();
    let up = apex - a;
    (up - along * up.dot(along)).normalize_or_zero()
}

impl<'p> Sides<'p> {
    /// The two sides from the first point to point `far`.
    fn of(points: &'p [DVec3], far: usize) -> Self {
        let mut along = vec![0.0];
        let mut sum = 0.0;
        for (p, q) in points.iter().zip(points.iter().cycle().skip(1)) {
            sum += p.distance(*q);
            along.push(sum);
        }
        Self { points, along, far }
    }

    /// The two sides from the first point, parted at the point where they are most nearly of one length.
    fn halves(points: &'p [DVec3]) -> Self {
        let mut sides = Self::of(points, 0);
        let half = sides.along[points.len()] / 2.0;
        let uneven = |i: usize| (sides.along[i] - half).abs();
        sides.far = (1..points.len()).fold(0, |best, i| if uneven(i) < uneven(best) { i } else { best });
        sides
    }

    /// The point of the loop at this length from the first.
    fn at(&self, length: f64) -> DVec3 {
        let n = self.points.len();
        let i = self.along.partition_point(|&l| l <= length).clamp(1, n) - 1;
        let step = self.along[i + 1] - self.along[i];
        let share = if step > 0.0 { (length - self.along[i]) / step } else { 0.0 };
        self.points[i].lerp(self.points[(i + 1) % n], share.clamp(0.0, 1.0))
    }

    /// The largest distance of a point from the other side at the same share of its length, and whether the faces are
    /// mostly on the far side of it.
    fn width(&self, apexes: &[DVec3]) -> (f64, bool) {
        let n = self.points.len();
        let (all, first) = (self.along[n], self.along[self.far]);
        let second = all - first;
        if first <= 0.0 || second <= 0.0 {
            return (0.0, true);
        }
        let (mut width, mut side) = (0.0f64, 0.0);
        for (i, &p) in self.points.iter().enumerate() {
            let length = self.along[i];
            let opposite = match i <= self.far {
                true => all - length / first * second,
                false => (all - length) / second * first,
            };
            let across = self.at(opposite) - p;
            width = width.max(across.length());
            side += across.dot(inward(p, self.points[(i + 1) % n], apexes[i]));
        }
        (width, side <= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shape of a loop whose triangles all have their third corner at `apex`.
    fn shape(points: &[[f64; 2]], apex: impl Fn(DVec3) -> DVec3) -> LoopShape {
        let points: Vec<DVec3> = points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
        let middle = |i: usize| (points[i] + points[(i + 1) % points.len()]) / 2.0;
        let apexes: Vec<DVec3> = (0..points.len()).map(|i| apex(middle(i))).collect();
        LoopShape::of(&points, &apexes)
    }

    #[test]
    fn a_square_has_its_length_area_and_diagonal_at_any_scale_and_from_any_corner() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for scale in [1e-200, 1.0, 1e150] {
            for first in 0..4 {
                let corners: Vec<[f64; 2]> =
                    (0..4).map(|i| square[(first + i) % 4].map(|x| x * scale)).collect();
                let of = shape(&corners, |p| p * 2.0);
                let is_near = |a: f64, b: f64| (a / scale - b).abs() < 1e-12;
                assert!(is_near(of.length, 4.0) && is_near(of.diameter, 2f64.sqrt()), "{of:?}");
                assert!(is_near(of.width, 2f64.sqrt()) && is_near(of.deviation, 0.0), "{of:?}");
                // That of the smallest square is below all f64.
                assert!((of.area - scale * scale).abs() <= 1e-12 * scale * scale, "{of:?}");
            }
        }
    }

    #[test]
    fn a_slit_is_as_wide_as_it_is_open_and_a_strip_has_its_faces_between_its_sides() {
        let mut slit: Vec<[f64; 2]> = (0..=10).map(|i| [f64::from(i), 0.0]).collect();
        slit.extend((1..10).rev().map(|i| [f64::from(i), 0.01]));
        let slit = slit;
        let around = shape(&slit, |p| p + DVec3::Y * if p.y > 0.004 { 5.0 } else { -5.0 });
        assert!((around.width - 0.01).abs() < 1e-6 && around.is_around, "{around:?}");
        let between = shape(&slit, |p| p + DVec3::Y * if p.y > 0.004 { -5.0 } else { 5.0 });
        assert!(!between.is_around, "{between:?}");
    }

    #[test]
    fn a_loop_at_one_place_has_no_size() {
        let of = LoopShape::of(&[DVec3::ONE; 3], &[DVec3::ZERO; 3]);
        assert_eq!((of.length, of.area, of.diameter, of.width), (0.0, 0.0, 0.0, 0.0));
    }
}
