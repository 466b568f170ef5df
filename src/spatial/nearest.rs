//! The triangle closest to a point.

use super::Bvh;
use super::bvh::{Leaf, Tree};
use super::star_gaps::{NO_STAR, Sighting, StarGaps};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, closest_point_on_triangle, closest_with_square};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The closest point of a set of triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// A triangle that the point is on.
    pub triangle: u32,
    /// The point.
    pub point: DVec3,
    /// Its distance, in the unit of the coordinates.
    pub distance: f64,
}

/// What a search with a bound on its work found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// A close point.
    pub nearest: Nearest,
    /// True when no triangle is closer; otherwise the true distance is at most that of `nearest`.
    pub is_exact: bool,
    /// Boxes that were looked at.
    pub boxes: usize,
}

/// Triangles prepared for questions about the closest of them.
#[derive(Debug, Clone)]
pub struct NearestSearch<'m> {
    positions: &'m [DVec3],
    triangles: &'m [[u32; 3]],
    bvh: Bvh,
    stars: StarGaps,
}

impl<'m> NearestSearch<'m> {
    /// Prepares `triangles`, whose positions must be finite. O(n log n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn build(
        positions: &'m [DVec3],
        triangles: &'m [[u32; 3]],
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let bvh = Bvh::build(positions, triangles, None, budget)?;
        let stars = StarGaps::of(&bvh, positions, budget)?;
        Ok(Self { positions, triangles, bvh, stars })
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// True when there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The boxes of the triangles.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The corners of triangle `t`.
    pub fn corners(&self, t: u32) -> [DVec3; 3] {
        self.triangles[t as usize].map(|v| self.positions[v as usize])
    }

    /// The closest point of triangle `t` to `p`.
    pub fn on_triangle(&self, p: DVec3, t: u32) -> Nearest {
        let point = closest_point_on_triangle(p, self.corners(t));
        Nearest { triangle: t, point, distance: point.distance(p) }
    }

    /// The closest point to `p`; `hint` is a triangle that may be close. Of several triangles at the same distance any
    /// may be named, but always the same for the same `p` and `hint`. O(log n) for points near the surface.
    ///
    /// `None` when there are no triangles. Differences of coordinates must have squares in the range of f64.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn find(&self, p: DVec3, hint: Option<u32>, budget: &Budget) -> Result<Option<Nearest>, Stopped> {
        Ok(self.find_roughly(p, hint, usize::MAX, budget)?.map(|found| found.nearest))
    }

    /// As [`find`](Self::find), but looks at no more than about `boxes_max` boxes twice: first down into the nearer ones, and
    /// when that is not enough at the nearest of those that are left. So a triangle that reaches far in is found first,
    /// and what is missed in the middle of a ball or on the axis of a cylinder, where everything is as far, is about as
    /// far as what is found. The distance is never less than the true one.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn find_roughly(
        &self,
        p: DVec3,
        hint: Option<u32>,
        boxes_max: usize,
        budget: &Budget,
    ) -> Result<Option<Found>, Stopped> {
        let tree = self.bvh.tree();
        if tree.is_empty() {
            return Ok(None);
        }
        let first = hint.unwrap_or_else(|| self.descend(p));
        let mut query = Query::new(self, p, self.on_triangle(p, first));
        let mut stack = [query.place_of(0, NO_STAR); Tree::DEPTH_MAX + 1];
        let (mut depth, mut visited) = (1, 0usize);
        while depth > 0 {
            depth -= 1;
            let QueuedNode { gap, node: id, star } = stack[depth];
            if visited.is_multiple_of(CHECK_EVERY) {
                let of_boxes = if visited > 0 { BOX_UNITS * CHECK_EVERY as u64 } else { 0 };
                budget.spend(of_boxes + query.units_of_triangles())?;
            }
            if visited == boxes_max {
                let (more, is_exact) = query.look_at_nearest(&stack[..=depth], boxes_max);
                let of_boxes = BOX_UNITS * (visited % CHECK_EVERY + more) as u64;
                budget.spend(of_boxes + query.units_of_triangles())?;
                return Ok(Some(Found { nearest: query.best, is_exact, boxes: visited + more }));
            }
            visited += 1;
            if query.best.distance == 0.0 {
                break;
            }
            if gap > query.reach {
                continue;
            }
            let node = tree.node(id);
            let Some([left, right]) = node.children() else {
                query.look_at(tree.leaf(node));
                continue;
            };
            let places = [left, right].map(|child| query.place_of(child, star));
            let [near, far] = if places[1].gap < places[0].gap { [places[1], places[0]] } else { places };
            for entry in [far, near] {
                if entry.gap <= query.reach {
                    stack[depth] = entry;
                    depth += 1;
                }
            }
        }
        budget.spend(BOX_UNITS * (visited % CHECK_EVERY) as u64 + query.units_of_triangles())?;
        Ok(Some(Found { nearest: query.best, is_exact: true, boxes: visited }))
    }

    /// A triangle that may be close: always down into the nearer box.
    fn descend(&self, p: DVec3) -> u32 {
        let tree = self.bvh.tree();
        let mut query = Query::new(self, p, Nearest { triangle: 0, point: p, distance: f64::INFINITY });
        let mut at = query.place_of(0, NO_STAR);
        while let Some(children) = tree.node(at.node).children() {
            let [left, right] = children.map(|child| query.place_of(child, at.star));
            at = if right.gap < left.gap { right } else { left };
        }
        tree.leaf(tree.node(at.node)).id(0)
    }
}

/// Units of work that a box counts, and a triangle.
const BOX_UNITS: u64 = 2;
const TRIANGLE_UNITS: u64 = 3;

/// More than twice the relative error of a coordinate rounded to f32, and of the few f32 operations behind a gap.
const ROUNDING_32: f32 = 1e-6;

/// A node that may be looked into.
#[derive(Debug, Clone, Copy)]
struct QueuedNode {
    /// The squared distance of what it holds is at least this, in the coordinates of the boxes.
    gap: f32,
    node: u32,
    /// The star that it is in, or [`NO_STAR`].
    star: u32,
}

/// A search that is under way.
struct Query<'q> {
    search: &'q NearestSearch<'q>,
    p: DVec3,
    /// `p` in the coordinates of the boxes.
    place: [f32; 3],
    /// How far the rounding of `p` and of a box no farther from the origin than `p` can move them in relation to each
    /// other. What a box is farther away grows its rounding and its gap alike; the factor in [`Self::shrink`] covers it.
    blur: f32,
    best: Nearest,
    /// The square of the distance of `best`, before its root was taken.
    square: f64,
    /// Boxes with larger squared gaps hold nothing closer than `best`.
    reach: f32,
    /// `p` as it is seen from the last star.
    sighting: Option<Sighting>,
    /// Triangles whose distance was taken and that are not counted yet.
    triangles: u64,
}

impl<'q> Query<'q> {
    fn new(search: &'q NearestSearch<'q>, p: DVec3, best: Nearest) -> Self {
        let place = search.bvh.frame().map(p);
        let blur = place.iter().fold(f32::MIN_POSITIVE, |most, x| most.max(x.abs())) * ROUNDING_32;
        let square =
            if best.distance < f64::INFINITY { best.point.distance_squared(p) } else { f64::INFINITY };
        let reach = f32::INFINITY;
        let mut query = Self { search, p, place, blur, best, square, reach, sighting: None, triangles: 0 };
        query.shrink();
        query
    }

    /// Units of work for the triangles since the last time.
    fn units_of_triangles(&mut self) -> u64 {
        TRIANGLE_UNITS * std::mem::take(&mut self.triangles)
    }

    fn shrink(&mut self) {
        let reach = (self.search.bvh.frame().scaled(self.best.distance) as f32 + self.blur * 2.0)
            * (1.0 + 4.0 * ROUNDING_32);
        self.reach = reach * reach;
    }

    /// A node below one of `star`, if that is one.
    #[inline]
    fn place_of(&mut self, node: u32, star: u32) -> QueuedNode {
        let of = self.search.bvh.tree().node(node);
        let gap = of.bounds.squared_gap(self.place);
        if star == NO_STAR && !of.is_star() {
            return QueuedNode { gap, node, star };
        }
        let stars = &self.search.stars;
        let star = if star == NO_STAR { stars.star_at(node) } else { star };
        let sighting = match self.sighting.filter(|sighting| sighting.star == star) {
            Some(sighting) => sighting,
            None => *self.sighting.insert(Sighting::new(stars, star, self.p)),
        };
        let by_direction = self.search.bvh.frame().scaled(sighting.gap(stars, node)) as f32;
        QueuedNode { gap: gap.max(by_direction * by_direction), node, star }
    }

    /// Looks into the `boxes`, each with its squared gap, the nearest first, and into at most `boxes_max` of what they hold:
    /// how many it looked at, and whether nothing closer can be in the others.
    fn look_at_nearest(&mut self, boxes: &[QueuedNode], boxes_max: usize) -> (usize, bool) {
        let tree = self.search.bvh.tree();
        // Squares are not negative, so that their bits are in the order of the numbers.
        let entry = |place: &QueuedNode| Reverse((place.gap.to_bits(), place.node, place.star));
        let mut left: BinaryHeap<Reverse<(u32, u32, u32)>> = boxes.iter().map(entry).collect();
        for looked_at in 0..boxes_max {
            let Some(Reverse((gap, id, star))) = left.pop() else { return (looked_at, true) };
            if f32::from_bits(gap) > self.reach {
                return (looked_at, true);
            }
            let node = tree.node(id);
            match node.children() {
                None => self.look_at(tree.leaf(node)),
                Some(children) => {
                    for child in children {
                        let place = self.place_of(child, star);
                        if place.gap <= self.reach {
                            left.push(entry(&place));
                        }
                    }
                }
            }
        }
        (boxes_max, left.is_empty())
    }

    fn look_at(&mut self, leaf: &Leaf) {
        let gaps = leaf.squared_gaps(self.place);
        for (k, &gap) in gaps.iter().enumerate().take(leaf.len()) {
            if gap <= self.reach {
                self.triangles += 1;
                let corners = leaf.corners(k).map(|v| self.search.positions[v as usize]);
                let (point, square) = closest_with_square(self.p, corners);
                // A root for those that may be closer only.
                if square <= self.square {
                    let distance = square.sqrt();
                    if distance < self.best.distance {
                        self.best = Nearest { triangle: leaf.id(k), point, distance };
                        self.square = square;
                        self.shrink();
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u32);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(self.0 >> 8) / f64::from(1 << 24)
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.unit(), self.unit(), self.unit())
        }
    }

    fn triangles_of(count: u32) -> Vec<[u32; 3]> {
        (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()
    }

    #[test]
    fn the_tree_finds_what_looking_at_every_triangle_finds_at_every_place_and_scale() {
        let mut random = Random(5);
        for (origin, scale) in [(0.0, 1.0), (1e6, 1.0), (-3e3, 1e-3), (0.0, 1e30), (0.0, 1e-30), (1e9, 1e-2)]
        {
            for count in [1, 3, 40, 500] {
                let mut at = |spread: f64| (random.point() * spread + origin / scale) * scale;
                let positions: Vec<DVec3> = (0..count).flat_map(|_| [at(1.0), at(0.3), at(0.05)]).collect();
                let triangles = triangles_of(count);
                let search = NearestSearch::build(&positions, &triangles, &Budget::unlimited()).unwrap();
                for i in 0..60 {
                    let p = if i % 3 == 0 { positions[i % positions.len()] } else { at(1.5) };
                    let hint = (i % 2 == 0).then_some(i as u32 % count);
                    let found = search.find(p, hint, &Budget::unlimited()).unwrap().unwrap();
                    let least =
                        (0..count).map(|t| search.on_triangle(p, t).distance).fold(f64::MAX, f64::min);
                    assert_eq!(found.distance, least, "{origin} {scale} {count} {i}");
                    assert_eq!(search.on_triangle(p, found.triangle), found);
                }
            }
        }
    }

    #[test]
    fn a_rough_search_is_exact_where_few_boxes_are_near_and_close_where_all_are_as_far() {
        // Triangles on a ball around the origin; one spike reaches to a quarter of its radius.
        let on_ball = |i: u32, turn: u32| {
            let height = 1.0 - 2.0 * (f64::from(i) + 0.5) / 4000.0;
            let angle = f64::from(i) * 2.399_963 + f64::from(turn) * 0.05;
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let radius = (1.0 - height * height).sqrt();
            DVec3::new(cos * radius, sin * radius, height)
        };
        let mut positions: Vec<DVec3> =
            (0..4000).flat_map(|i| [on_ball(i, 0), on_ball(i, 1), on_ball((i + 3979) % 4000, 0)]).collect();
        let spike = DVec3::new(0.1, 0.2, -0.1).normalize();
        positions.extend([spike * 0.25, spike * 1.1 + DVec3::X * 0.01, spike * 1.1]);
        for (count, least) in [(4000u32, 1.0), (4001, 0.25)] {
            let triangles = triangles_of(count);
            let search = NearestSearch::build(&positions, &triangles, &Budget::unlimited()).unwrap();
            let rough = |p| search.find_roughly(p, Some(7), 128, &Budget::unlimited()).unwrap().unwrap();
            let exact = |p| search.find(p, Some(7), &Budget::unlimited()).unwrap().unwrap();
            let middle = rough(DVec3::ZERO);
            let truth = exact(DVec3::ZERO).distance;
            let distance = middle.nearest.distance;
            assert!(distance >= truth && distance <= truth * 1.02, "{distance} for {truth}, of {count}");
            assert!(truth <= least && middle.boxes <= 256, "{truth}, {}", middle.boxes);
            assert!(middle.is_exact || count == 4000, "the spike stands out");
            for p in [DVec3::X * 1.01, DVec3::Y * 0.98, DVec3::splat(0.57)] {
                assert_eq!(rough(p).nearest.distance, exact(p).distance);
                assert!(rough(p).is_exact);
            }
        }
    }

    #[test]
    fn a_stray_triangle_far_away_does_not_hide_a_near_one() {
        let mut random = Random(9);
        let mut positions: Vec<DVec3> = (0..300).map(|_| random.point()).collect();
        positions.extend([DVec3::splat(1e30), DVec3::splat(-1e30), DVec3::splat(1e20)]);
        let triangles = triangles_of(101);
        let search = NearestSearch::build(&positions, &triangles, &Budget::unlimited()).unwrap();
        for p in [DVec3::splat(0.5), DVec3::splat(1e29), DVec3::new(1e20, -1e20, 0.0)] {
            let found = search.find(p, None, &Budget::unlimited()).unwrap().unwrap();
            let least = (0..101).map(|t| search.on_triangle(p, t).distance).fold(f64::MAX, f64::min);
            assert_eq!(found.distance, least);
        }
    }

    #[test]
    fn nothing_has_no_closest_triangle_and_a_raised_flag_ends_the_search() {
        let search = NearestSearch::build(&[], &[], &Budget::unlimited()).unwrap();
        assert!(search.is_empty());
        assert_eq!(search.find(DVec3::ZERO, None, &Budget::unlimited()), Ok(None));
        let stop = crate::budget::StopFlag::default();
        stop.cancel();
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let search = NearestSearch::build(&positions, &[[0, 1, 2]], &Budget::unlimited()).unwrap();
        assert!(search.find(DVec3::ZERO, None, &Budget::new(stop, 1, 1)).is_err());
    }
}
