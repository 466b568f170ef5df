//! How sharp edges that end at a rim go on through the hole, and the sides that they divide it into.

use super::super::regions::Region;
use super::super::shape::shape;
use super::super::surface::FillSurface;
use super::ends::{End, ends};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};

/// Ends that a division can have, and so curves.
const ENDS_MAX: usize = 8;
/// Two ends are joined when each goes on towards the other within this, as the cosine of the angle (40 degrees).
const TOWARDS_COS_MIN: f64 = 0.766;
/// As above where there are no other ends (75 degrees).
const ALONE_COS_MIN: f64 = 0.26;
/// A curve is a straight edge when its ends go on within this of each other, as the cosine of the angle (1 degree).
const STRAIGHT_COS_MIN: f64 = 0.99985;
/// How far from a point that ends meet in their lines may pass it, and how far away it may be, as shares of the diagonal
/// of the rim's box.
const MISS_MAX: f64 = 0.1;
/// As above for lines that pass so near to one point that this is a corner of the part, also where two of them face each other.
const MISS_OF_CORNER_MAX: f64 = 0.01;
const FAR_MAX: f64 = 1.0;
/// How far the surface at the rim may lean from the plane of a flat side, as the cosine of the angle (1.8 degrees).
const COPLANAR_COS_MIN: f64 = 0.9995;
/// Points of a curve between its ends, at most.
const POINTS_MAX: f64 = 256.0;

/// A hole divided by curves. Points are numbered: the corners of the rim, then those of curves.
pub(in crate::repair::fill) struct HoleDivision {
    pub(super) points: Vec<DVec3>,
    /// For each point of a curve two points that it was born between.
    pub(super) parents: Vec<[u32; 2]>,
    /// The points around each side, in the direction of the rim.
    pub(super) sides: Vec<Vec<u32>>,
    /// For each point the curves that it is on, a bit for each.
    curves_at: Vec<u8>,
}

/// Two ends that are one edge, or one that goes to the point that others go to as well.
#[derive(Clone, Copy)]
enum CurveEnds {
    Join(End, End),
    Meet(End, u32),
}

impl HoleDivision {
    /// `None`: no sharp edge ends at the rim, or nothing tells how they go on.
    pub(in crate::repair::fill) fn of(
        region: &Region,
        surface: &FillSurface,
        budget: &Budget,
    ) -> Result<Option<Self>, Stopped> {
        let ends = ends(region, surface, budget)?;
        Ok(if (2..=ENDS_MAX).contains(&ends.len()) { Self::of_ends(&ends, region, surface) } else { None })
    }

    /// How these ends divide the region.
    fn of_ends(ends: &[End], region: &Region, surface: &FillSurface) -> Option<Self> {
        let points: Vec<DVec3> = region.rim().iter().map(|&h| surface.point(h)).collect();
        let n = points.len() as u32;
        let all: Vec<u32> = (0..n).collect();
        let mut division = Self { points, parents: Vec::new(), sides: vec![all], curves_at: Vec::new() };
        let meeting = |ends: &[End], apex: u32| ends.iter().map(|&end| CurveEnds::Meet(end, apex)).collect();
        let courses: Vec<CurveEnds> = match division.apex(ends, MISS_OF_CORNER_MAX) {
            Some(apex) => meeting(ends, apex),
            None => {
                let (joined, left) = division.matched(ends);
                let apex = division.apex(&left, MISS_MAX);
                let met = apex.map_or_else(Vec::new, |apex| meeting(&left, apex));
                joined.into_iter().map(|[a, b]| CurveEnds::Join(a, b)).chain(met).collect()
            }
        };
        if courses.is_empty() {
            return None;
        }
        // Straight edges between planes need no points: which are such is seen when all are straight.
        let straight: Vec<Vec<u32>> = courses.iter().map(|course| course.ends().to_vec()).collect();
        let plain = division.divided(&straight, &courses)?;
        let is_plain = |curve: &[u32]| {
            let has = |side: &&Vec<u32>| curve.iter().all(|v| side.contains(v));
            plain.iter().filter(has).all(|side| division.plane_of(side, region, surface).is_some())
        };
        let is_bent: Vec<bool> = courses
            .iter()
            .zip(&straight)
            .map(|(course, curve)| !division.is_straight(course) || !is_plain(curve))
            .collect();
        let length = division.perimeter() / f64::from(n);
        let draw = |(course, is_bent)| division.draw(course, if is_bent { length } else { f64::INFINITY });
        let curves: Vec<Vec<u32>> = courses.iter().zip(is_bent).map(draw).collect();
        division.sides = division.divided(&curves, &courses)?;
        division.curves_at.resize(division.points.len(), 0);
        for (number, curve) in curves.iter().enumerate() {
            curve.iter().for_each(|&v| division.curves_at[v as usize] |= 1 << number);
        }
        Some(division)
    }

    fn perimeter(&self) -> f64 {
        let rim = &self.points[..self.sides[0].len()];
        rim.iter().zip(rim.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum()
    }

    /// Pairs of ends that go on towards each other, the best first, none across another; and the ends that are left.
    fn matched(&self, ends: &[End]) -> (Vec<[End; 2]>, Vec<End>) {
        let least = if ends.len() == 2 { ALONE_COS_MIN } else { TOWARDS_COS_MIN };
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for i in 0..ends.len() {
            for k in i + 1..ends.len() {
                let cos = self.towards(ends[i], ends[k]);
                // Neighbours in the rim have no room between them.
                let gap = ends[k].corner - ends[i].corner;
                if cos >= least && gap > 1 && gap + 1 < self.sides[0].len() as u32 {
                    pairs.push((cos, i, k));
                }
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut taken: Vec<[usize; 2]> = Vec::new();
        for (_, i, k) in pairs {
            let is_clear = |&[a, b]: &[usize; 2]| {
                let is_between = |x: usize| i < x && x < k;
                ![a, b].contains(&i) && ![a, b].contains(&k) && is_between(a) == is_between(b)
            };
            if taken.iter().all(is_clear) {
                taken.push([i, k]);
            }
        }
        let left = (0..ends.len()).filter(|i| !taken.as_flattened().contains(i)).map(|i| ends[i]).collect();
        (taken.into_iter().map(|pair| pair.map(|i| ends[i])).collect(), left)
    }

    /// How well two ends go on towards each other: the cosine of the larger angle between a direction and the line.
    fn towards(&self, a: End, b: End) -> f64 {
        let line = (self.points[b.corner as usize] - self.points[a.corner as usize]).normalize_or_zero();
        a.direction.dot(line).min(-b.direction.dot(line))
    }

    /// Adds the point that three or more ends go to, the nearest to all their lines, which may pass it by `miss` of the size
    /// of the hole.
    fn apex(&mut self, ends: &[End], miss: f64) -> Option<u32> {
        if ends.len() < 3 {
            return None;
        }
        let at = |end: &End| self.points[end.corner as usize];
        let middle = ends.iter().map(at).sum::<DVec3>() / ends.len() as f64;
        // The sum of the projections along the lines, row by row, and of what they leave of the points.
        let (mut rows, mut right) = ([DVec3::ZERO; 3], DVec3::ZERO);
        for end in ends {
            let d = end.direction;
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            for (row, axis) in rows.iter_mut().zip(axes) {
                *row += axis - d * d.dot(axis);
            }
            let p = at(end) - middle;
            right += p - d * d.dot(p);
        }
        let determinant = rows[0].dot(rows[1].cross(rows[2]));
        let apex = middle
            + (rows[1].cross(rows[2]) * right.x
                + rows[2].cross(rows[0]) * right.y
                + rows[0].cross(rows[1]) * right.z)
                / determinant;
        let size = Aabb::of(self.points.iter().copied()).diagonal();
        let is_met = |end: &End| {
            let to = apex - at(end);
            let along = to.dot(end.direction);
            along > 0.0 && along <= FAR_MAX * size && (to - along * end.direction).length() <= miss * size
        };
        if !ends.iter().all(is_met) {
            return None;
        }
        self.points.push(apex);
        self.parents.push([ends[0].corner, ends[1].corner]);
        Some(self.points.len() as u32 - 1)
    }

    fn is_straight(&self, course: &CurveEnds) -> bool {
        match *course {
            CurveEnds::Join(a, b) => self.towards(a, b) >= STRAIGHT_COS_MIN,
            CurveEnds::Meet(..) => true,
        }
    }

    /// Adds the points of a curve, at about `length` from each other; gives all from end to end.
    fn draw(&mut self, course: &CurveEnds, length: f64) -> Vec<u32> {
        let [from, to] = course.ends();
        let [p, q] = [from, to].map(|v| self.points[v as usize]);
        let chord = p.distance(q);
        let steps = (chord / length).round().clamp(1.0, POINTS_MAX) as u32;
        let [leaving, arriving] = match *course {
            CurveEnds::Join(a, b) => [a.direction, -b.direction].map(|d| d * chord),
            CurveEnds::Meet(..) => [q - p; 2],
        };
        let mut curve = vec![from];
        for step in 1..steps {
            let t = f64::from(step) / f64::from(steps);
            let s = 1.0 - t;
            // The cubic with these ends and directions (Hermite).
            let at = p * (s * s * (1.0 + 2.0 * t)) + q * (t * t * (1.0 + 2.0 * s)) + leaving * (t * s * s)
                - arriving * (t * t * s);
            curve.push(self.points.len() as u32);
            self.points.push(at);
            self.parents.push([curve[curve.len() - 2], to]);
        }
        curve.push(to);
        curve
    }

    /// The sides that `curves` divide the rim into; `None` when one has fewer than three points.
    fn divided(&self, curves: &[Vec<u32>], courses: &[CurveEnds]) -> Option<Vec<Vec<u32>>> {
        let mut sides = vec![self.sides[0].clone()];
        let (joins, spokes): (Vec<_>, Vec<_>) =
            curves.iter().zip(courses).partition(|(_, course)| matches!(course, CurveEnds::Join(..)));
        for (curve, _) in joins {
            let (from, to) = (curve[0], curve[curve.len() - 1]);
            let which = sides.iter().position(|side| side.contains(&from) && side.contains(&to))?;
            let side = sides.swap_remove(which);
            let inner = &curve[1..curve.len() - 1];
            let mut one = between(&side, from, to);
            one.extend(inner.iter().rev());
            let mut other = between(&side, to, from);
            other.extend(inner);
            sides.extend([one, other]);
        }
        if !spokes.is_empty() {
            let which =
                sides.iter().position(|side| spokes.iter().all(|(spoke, _)| side.contains(&spoke[0])))?;
            let side = sides.swap_remove(which);
            // In the order of the side, which may begin anywhere in the rim.
            let place = |spoke: &Vec<u32>| side.iter().position(|&v| v == spoke[0]);
            let mut ordered: Vec<&Vec<u32>> = spokes.iter().map(|&(spoke, _)| spoke).collect();
            ordered.sort_by_key(|spoke| place(spoke));
            for (i, spoke) in ordered.iter().enumerate() {
                let next = ordered[(i + 1) % ordered.len()];
                let mut own = between(&side, spoke[0], next[0]);
                own.extend(&next[1..]);
                own.extend(spoke[1..spoke.len() - 1].iter().rev());
                sides.push(own);
            }
        }
        sides.iter().all(|side| side.len() >= 3).then_some(sides)
    }

    /// The normal of the plane of a side, if it lies in one in which the surface goes on.
    pub(super) fn plane_of(&self, side: &[u32], region: &Region, surface: &FillSurface) -> Option<DVec3> {
        let seen = shape(side.iter().map(|&v| self.points[v as usize]).collect());
        let mut normals = (0..side.len()).map(|i| normal_beyond(side, i, region, surface));
        let goes_on = |n: DVec3| n == DVec3::ZERO || n.dot(seen.normal) >= COPLANAR_COS_MIN;
        (seen.is_flat && normals.all(goes_on)).then_some(seen.normal)
    }

    pub(super) fn is_on_curve(&self, v: u32) -> bool {
        self.curves_at[v as usize] != 0
    }

    pub(super) fn are_on_one_curve(&self, a: u32, b: u32) -> bool {
        self.curves_at[a as usize] & self.curves_at[b as usize] != 0
    }
}

impl CurveEnds {
    fn ends(&self) -> [u32; 2] {
        match *self {
            Self::Join(a, b) => [a.corner, b.corner],
            Self::Meet(end, apex) => [end.corner, apex],
        }
    }
}

/// The points of a side from one to another.
fn between(side: &[u32], from: u32, to: u32) -> Vec<u32> {
    let start = side.iter().position(|&v| v == from).unwrap_or(0);
    let mut own = Vec::new();
    for &v in side[start..].iter().chain(&side[..start]) {
        own.push(v);
        if v == to {
            break;
        }
    }
    own
}

/// The unit normal of the surface beyond the `i`th edge of a side; zero beyond a curve.
pub(super) fn normal_beyond(side: &[u32], i: usize, region: &Region, surface: &FillSurface) -> DVec3 {
    let (from, to) = (side[i], side[(i + 1) % side.len()]);
    let rim = region.rim();
    let is_of_rim = (from as usize) < rim.len() && (from as usize + 1) % rim.len() == to as usize;
    if is_of_rim { surface.normal(rim[from as usize]) } else { DVec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A round rim of 12 corners, the first at the right.
    fn rim() -> HoleDivision {
        let corner = |i: u32| {
            let (y, x) = (f64::from(i) * std::f64::consts::TAU / 12.0).sin_cos();
            DVec3::new(x, y, 0.0)
        };
        let points = (0..12).map(corner).collect();
        HoleDivision { points, parents: Vec::new(), sides: vec![(0..12).collect()], curves_at: Vec::new() }
    }

    fn end(corner: u32, x: f64, y: f64) -> End {
        End { corner, direction: DVec3::new(x, y, 0.0).normalize() }
    }

    /// The corners of the pairs and of the ends that are left.
    fn matched(ends: &[End]) -> (Vec<[u32; 2]>, Vec<u32>) {
        let (joined, left) = rim().matched(ends);
        let corners = |pair: &[End; 2]| pair.map(|end| end.corner);
        let mut pairs: Vec<[u32; 2]> = joined.iter().map(corners).collect();
        pairs.sort_unstable();
        (pairs, left.iter().map(|end| end.corner).collect())
    }

    #[test]
    fn two_edges_side_by_side_go_on_each_as_itself() {
        let ends = [end(1, -1.0, 0.0), end(5, 1.0, 0.0), end(7, 1.0, 0.0), end(11, -1.0, 0.0)];
        assert_eq!(matched(&ends), (vec![[1, 5], [7, 11]], vec![]));
    }

    #[test]
    fn of_two_edges_that_cross_the_straighter_one_goes_on() {
        let ends = [end(0, -1.0, 0.2), end(3, 0.0, -1.0), end(6, 1.0, 0.0), end(9, 0.0, 1.0)];
        assert_eq!(matched(&ends), (vec![[3, 9]], vec![0, 6]));
    }

    #[test]
    fn edges_that_go_past_each_other_are_joined_only_where_they_are_alone() {
        // Each is 60 degrees off the line between them.
        let [one, other] = [end(0, -0.5, 0.75f64.sqrt()), end(6, 0.5, 0.75f64.sqrt())];
        assert_eq!(matched(&[one, other]), (vec![[0, 6]], vec![]));
        assert_eq!(matched(&[one, end(3, 0.0, 1.0), other]), (vec![], vec![0, 3, 6]));
    }

    /// The point that ends go to, if they do.
    fn corner_of(ends: &[End]) -> Option<DVec3> {
        let mut division = rim();
        let apex = division.apex(ends, MISS_OF_CORNER_MAX)?;
        Some(division.points[apex as usize])
    }

    #[test]
    fn edges_whose_lines_pass_one_point_meet_there_even_where_two_face_each_other() {
        let t = [end(0, -1.0, 0.0), end(3, 0.0, -1.0), end(6, 1.0, 0.0)];
        assert!(corner_of(&t).is_some_and(|apex| apex.length() < 1e-12));
        let cross = [end(0, -1.0, 0.0), end(3, 0.0, -1.0), end(6, 1.0, 0.0), end(9, 0.0, 1.0)];
        assert!(corner_of(&cross).is_some_and(|apex| apex.length() < 1e-12));
        let side_by_side = [end(1, -1.0, 0.0), end(5, 1.0, 0.0), end(7, 1.0, 0.0), end(11, -1.0, 0.0)];
        assert_eq!(corner_of(&side_by_side), None);
        let passing = [end(0, -1.0, 0.0), end(3, 0.1, -1.0), end(6, 1.0, 0.4)];
        assert_eq!(corner_of(&passing), None);
        assert_eq!(corner_of(&t[..2]), None);
    }

    #[test]
    fn ends_at_neighbours_in_the_rim_or_that_look_away_from_each_other_are_not_joined() {
        assert_eq!(matched(&[end(0, 0.0, 1.0), end(1, 0.0, -1.0)]), (vec![], vec![0, 1]));
        assert_eq!(matched(&[end(0, 0.0, -1.0), end(11, 0.0, 1.0)]), (vec![], vec![0, 11]));
        assert_eq!(matched(&[end(0, 1.0, 0.0), end(6, -1.0, 0.0)]), (vec![], vec![0, 6]));
    }
}
