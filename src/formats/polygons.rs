//! Splits a polygon into triangles.

use super::obstacles::Obstacles;
use super::ring_set::RingSet;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec2, DVec3, Sign, orient2d};

/// Splits polygons; keeps its buffers from one to the next.
///
/// A polygon is seen along the coordinate axis nearest to its normal, so that its coordinates stay as they are and
/// all turns are decided exactly. If the fan around its first corner covers it properly there, that is the answer.
/// Otherwise ears are clipped (Meisters 1975), first those beside a straight corner: that way a vertex on a side gets
/// a triangle with area. What is not a simple polygon and has no ear left is given as a fan after all, and so is one whose ears
/// take more than [`STEPS_PER_CORNER`] to find.
#[derive(Debug, Default)]
pub(super) struct Splitter {
    flat: Vec<DVec2>,
    previous: Vec<u32>,
    next: Vec<u32>,
    turn: Vec<Turn>,
    rank: Vec<Rank>,
    /// The ears beside a straight corner.
    beside_straight: RingSet,
    /// The other ears.
    ears: RingSet,
    /// The straight corners.
    straight: RingSet,
    /// Corners that were not convex at the start, by x.
    obstacles: Vec<u32>,
    /// The same in a tree, where they are many.
    tree: Obstacles,
    /// Steps not yet paid for.
    steps: u64,
    /// Steps that may still be made for this polygon.
    steps_left: u64,
}

/// Steps for each corner of a polygon, at most. A step looks at a corner or a box of corners, in a few nanoseconds; polygons of ten
/// thousand corners in a row of teeth or a spiral take some dozens.
const STEPS_PER_CORNER: u64 = 4096;

/// Obstacles from which on they are put into a tree.
const TREE_FROM: usize = 48;

/// How the boundary turns at a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turn {
    Convex,
    Straight,
    Reflex,
    /// The corner was clipped.
    Gone,
}

/// How welcome a corner is as the next ear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rank {
    NoEar,
    Ear,
    EarBesideStraight,
}

/// Appends triangles over the polygon with these `corners` (three or more) to `triangles`. All positions are finite.
///
/// # Errors
/// When the budget stops the run.
pub fn split_polygon(
    corners: &[u32],
    positions: &[DVec3],
    triangles: &mut Vec<[u32; 3]>,
    budget: &Budget,
) -> Result<(), Stopped> {
    Splitter::default().split(corners, positions, triangles, budget).map(|_| ())
}

impl Splitter {
    /// Appends `corners.len() - 2` triangles over `corners` to `triangles`; true if they are the fan around the first
    /// corner. All positions are finite. O(n log n) steps on most n-gons, at most
    /// [`STEPS_PER_CORNER`] for each corner.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn split(
        &mut self,
        corners: &[u32],
        positions: &[DVec3],
        triangles: &mut Vec<[u32; 3]>,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        self.flatten(corners, positions);
        let first = triangles.len();
        if self.is_fan_proper() || !self.clip_ears(corners, triangles, budget)? {
            triangles.truncate(first);
            triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
            return Ok(true);
        }
        Ok(false)
    }

    /// Drops the coordinate in which the normal is largest, so that the polygon runs counter-clockwise.
    fn flatten(&mut self, corners: &[u32], positions: &[DVec3]) {
        let at = |v: u32| positions[v as usize];
        let origin = at(corners[0]);
        let from_origin = |v: u32| at(v) - origin;
        // Lengths of at most 1 keep the products in range.
        let longest = corners.iter().map(|&v| from_origin(v).abs().max_element()).fold(0.0, f64::max);
        let area = |pair: &[u32]| (from_origin(pair[0]) / longest).cross(from_origin(pair[1]) / longest);
        let normal: DVec3 = corners[1..].windows(2).map(area).sum();
        let size = normal.abs();
        let (right, up, height) = if size.x >= size.y && size.x >= size.z {
            (1, 2, normal.x)
        } else if size.y >= size.z {
            (2, 0, normal.y)
        } else {
            (0, 1, normal.z)
        };
        let (x, y) = if height < 0.0 { (up, right) } else { (right, up) };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|&v| DVec2::new(at(v)[x], at(v)[y])));
    }

    fn area_sign(&self, a: u32, b: u32, c: u32) -> Sign {
        orient2d(self.flat[a as usize], self.flat[b as usize], self.flat[c as usize])
    }

    /// In a simple polygon the triangles of the fan have the right area in sum, so if all of them run
    /// counter-clockwise, none overlaps another.
    fn is_fan_proper(&self) -> bool {
        (1..self.flat.len() as u32 - 1).all(|i| self.area_sign(0, i, i + 1) == Sign::Positive)
    }

    /// Appends triangles until the polygon is used up; false if it has no ear before that.
    fn clip_ears(
        &mut self,
        corners: &[u32],
        triangles: &mut Vec<[u32; 3]>,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        self.link(budget)?;
        let mut from = 0;
        for clipped in 2..corners.len() {
            let Some(ear) = self.find_ear(from).filter(|_| self.steps_left > 0) else { return Ok(false) };
            let is_without_area = clipped == 2 && self.rank[ear as usize] == Rank::NoEar;
            if is_without_area {
                return Ok(false);
            }
            let (a, c) = (self.previous[ear as usize], self.next[ear as usize]);
            triangles.push([a, ear, c].map(|i| corners[i as usize]));
            self.clip(ear);
            from = c;
            self.pay(budget)?;
        }
        Ok(true)
    }

    /// Counts the steps made, once they are many enough.
    fn pay(&mut self, budget: &Budget) -> Result<(), Stopped> {
        if self.steps < CHECK_EVERY as u64 {
            return Ok(());
        }
        self.steps_left = self.steps_left.saturating_sub(self.steps);
        budget.spend(std::mem::take(&mut self.steps))
    }

    fn link(&mut self, budget: &Budget) -> Result<(), Stopped> {
        let n = self.flat.len() as u32;
        self.steps_left = STEPS_PER_CORNER * u64::from(n);
        self.previous.clear();
        self.previous.extend((0..n).map(|i| if i == 0 { n - 1 } else { i - 1 }));
        self.next.clear();
        self.next.extend((0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }));
        [&mut self.beside_straight, &mut self.ears, &mut self.straight]
            .into_iter()
            .for_each(|set| set.reset(n as usize));
        self.turn.clear();
        for i in 0..n {
            let turn = self.turn_of(i);
            self.turn.push(turn);
            if turn == Turn::Straight {
                self.straight.insert(i);
            }
        }
        self.obstacles.clear();
        self.obstacles.extend((0..n).filter(|&i| self.turn[i as usize] != Turn::Convex));
        self.obstacles.sort_unstable_by(|&i, &j| self.flat[i as usize].x.total_cmp(&self.flat[j as usize].x));
        let many = self.obstacles.iter().copied().filter(|_| self.obstacles.len() >= TREE_FROM);
        self.tree.reset(&self.flat, many);
        self.rank.clear();
        self.rank.resize(n as usize, Rank::NoEar);
        for i in 0..n {
            self.update_rank(i);
            self.pay(budget)?;
        }
        Ok(())
    }

    fn turn_of(&self, i: u32) -> Turn {
        match self.area_sign(self.previous[i as usize], i, self.next[i as usize]) {
            Sign::Positive => Turn::Convex,
            Sign::Zero => Turn::Straight,
            Sign::Negative => Turn::Reflex,
        }
    }

    fn update_rank(&mut self, i: u32) {
        let rank = self.rank_of(i);
        self.set_rank(i, rank);
    }

    fn set_rank(&mut self, i: u32, rank: Rank) {
        let before = std::mem::replace(&mut self.rank[i as usize], rank);
        if before == rank {
            return;
        }
        match before {
            Rank::EarBesideStraight => self.beside_straight.remove(i),
            Rank::Ear => self.ears.remove(i),
            Rank::NoEar => {}
        }
        match rank {
            Rank::EarBesideStraight => self.beside_straight.insert(i),
            Rank::Ear => self.ears.insert(i),
            Rank::NoEar => {}
        }
    }

    fn set_turn(&mut self, i: u32, turn: Turn) {
        let before = std::mem::replace(&mut self.turn[i as usize], turn);
        match (before == Turn::Straight, turn == Turn::Straight) {
            (true, false) => self.straight.remove(i),
            (false, true) => self.straight.insert(i),
            _ => {}
        }
        let blocks = |turn| matches!(turn, Turn::Reflex | Turn::Straight);
        if !self.tree.is_empty() && blocks(before) != blocks(turn) {
            self.tree.change(i, blocks(turn));
        }
    }

    /// The first of the most welcome ears from `from` on; the last straight corner before it if there is no ear.
    fn find_ear(&mut self, from: u32) -> Option<u32> {
        self.steps += 1;
        let ear = self.beside_straight.next(from).or_else(|| self.ears.next(from));
        ear.or_else(|| self.straight.previous(from))
    }

    fn clip(&mut self, ear: u32) {
        let (a, c) = (self.previous[ear as usize], self.next[ear as usize]);
        self.set_turn(ear, Turn::Gone);
        self.next[a as usize] = c;
        self.previous[c as usize] = a;
        // The ear's own rank is left behind for good.
        self.set_rank(ear, Rank::NoEar);
        for i in [a, c] {
            self.set_turn(i, self.turn_of(i));
        }
        for i in [self.previous[a as usize], a, c, self.next[c as usize]] {
            self.update_rank(i);
        }
    }

    fn rank_of(&mut self, ear: u32) -> Rank {
        let (a, c) = (self.previous[ear as usize], self.next[ear as usize]);
        if self.turn[ear as usize] != Turn::Convex || self.is_blocked(a, ear, c) {
            return Rank::NoEar;
        }
        let is_beside = [a, c].iter().any(|&i| self.turn[i as usize] == Turn::Straight);
        if is_beside { Rank::EarBesideStraight } else { Rank::Ear }
    }

    /// True if another corner lies in the closed triangle. If any does, one that is not convex does. Corners at the
    /// place of the triangle's own (where a boundary touches itself) do not count.
    fn is_blocked(&mut self, a: u32, b: u32, c: u32) -> bool {
        let own = [a, b, c].map(|i| self.flat[i as usize]);
        let blocks = |turn| matches!(turn, Turn::Reflex | Turn::Straight);
        if !self.tree.is_empty() {
            let counts = |i: u32| blocks(self.turn[i as usize]);
            return self.tree.is_one_in(&self.flat, own, counts, &mut self.steps);
        }
        let left = own[0].x.min(own[1].x).min(own[2].x);
        let right = own[0].x.max(own[1].x).max(own[2].x);
        let from = self.obstacles.partition_point(|&i| self.flat[i as usize].x < left);
        for &i in &self.obstacles[from..] {
            self.steps += 1;
            let p = self.flat[i as usize];
            if p.x > right {
                return false;
            }
            if blocks(self.turn[i as usize])
                && !own.contains(&p)
                && self.area_sign(a, b, i) != Sign::Negative
                && self.area_sign(b, c, i) != Sign::Negative
                && self.area_sign(c, a, i) != Sign::Negative
            {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(points: &[[f64; 2]]) -> (bool, Vec<[u32; 3]>) {
        let positions: Vec<DVec3> = points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect();
        split_in_space(&positions)
    }

    fn split_in_space(positions: &[DVec3]) -> (bool, Vec<[u32; 3]>) {
        let corners: Vec<u32> = (0..positions.len() as u32).collect();
        let mut triangles = Vec::new();
        let budget = Budget::unlimited();
        let is_fan = Splitter::default().split(&corners, positions, &mut triangles, &budget).unwrap();
        assert_eq!(triangles.len(), positions.len() - 2);
        (is_fan, triangles)
    }

    fn doubled_area(p: &[[f64; 2]], [a, b, c]: [u32; 3]) -> f64 {
        let [a, b, c] = [a, b, c].map(|i| p[i as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// Positive triangles whose area is the polygon's cover it exactly once.
    fn assert_covered(points: &[[f64; 2]], triangles: &[[u32; 3]]) {
        let areas: Vec<f64> = triangles.iter().map(|&t| doubled_area(points, t)).collect();
        assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
        let fan = (1..points.len() as u32 - 1).map(|i| doubled_area(points, [0, i, i + 1]));
        let whole: f64 = fan.sum();
        let sum: f64 = areas.iter().sum();
        assert!((sum - whole).abs() <= 1e-9 * whole, "{sum} instead of {whole}");
    }

    #[test]
    fn a_convex_polygon_is_a_fan_however_it_lies_in_space() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [2.0, 2.0], [0.0, 2.0]];
        for place in [
            |p: [f64; 2]| DVec3::new(p[0], p[1], 0.0),
            |p: [f64; 2]| DVec3::new(p[1], p[0], 0.0),
            |p: [f64; 2]| DVec3::new(1.0, p[0], p[1]),
            |p: [f64; 2]| DVec3::new(p[0], p[0], p[1]),
        ] {
            let (is_fan, triangles) = split_in_space(&corners.map(place));
            assert!(is_fan);
            assert_eq!(triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        }
    }

    #[test]
    fn a_dart_is_split_at_its_reflex_corner_whichever_corner_comes_first() {
        let dart = [[0.0, 0.0], [4.0, -3.0], [1.0, 0.0], [4.0, 3.0]];
        for first in 0..4 {
            let mut points = dart;
            points.rotate_left(first);
            let (is_fan, triangles) = split(&points);
            assert_covered(&points, &triangles);
            assert_eq!(is_fan, first % 2 == 0, "only the diagonal between the corners 0 and 2 lies inside");
        }
    }

    #[test]
    fn huge_and_tiny_polygons_are_split_like_others() {
        for size in [1e-300, 1e-200, 1e300] {
            let dart = [[4.0, -3.0], [1.0, 0.0], [4.0, 3.0], [0.0, 0.0]].map(|p| p.map(|c| c * size));
            assert_eq!(split(&dart), (false, vec![[3, 0, 1], [3, 1, 2]]), "{size}");
        }
    }

    #[test]
    fn a_straight_corner_gets_triangles_with_area() {
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
        for first in 0..6 {
            let mut points = square;
            points.rotate_left(first);
            assert_covered(&points, &split(&points).1);
        }
    }

    #[test]
    fn a_ring_bridged_by_a_double_edge_is_covered() {
        let ring = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        assert_covered(&ring, &split(&ring).1);
    }

    #[test]
    fn a_repeated_corner_costs_one_flat_triangle() {
        let points = [[0.0, 0.0], [4.0, -3.0], [4.0, -3.0], [1.0, 0.0], [4.0, 3.0]];
        let (_, triangles) = split(&points);
        let flat = triangles.iter().filter(|&&t| doubled_area(&points, t) == 0.0).count();
        assert_eq!(flat, 1);
        assert!(triangles.iter().all(|&t| doubled_area(&points, t) >= 0.0));
    }

    #[test]
    fn what_is_no_simple_polygon_becomes_a_fan() {
        let fan = [[0, 1, 2], [0, 2, 3]];
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
        for points in [bow_tie, line, [[1.0, 1.0]; 4]] {
            assert_eq!(split(&points), (true, fan.to_vec()));
        }
    }

    #[test]
    fn a_spiral_of_many_corners_is_covered() {
        const TURNS: usize = 200;
        let outer = (0..TURNS * 4).map(|i| corner_of_spiral(i as f64, 0.0));
        let inner = (0..TURNS * 4).rev().map(|i| corner_of_spiral(i as f64, 0.4));
        let points: Vec<[f64; 2]> = outer.chain(inner).collect();
        let (is_fan, triangles) = split(&points);
        assert!(!is_fan);
        assert_covered(&points, &triangles);
    }

    fn corner_of_spiral(i: f64, inset: f64) -> [f64; 2] {
        let radius = 1.0 + i / 4.0 - inset;
        let (x, y) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][i as usize % 4];
        [x * radius, y * radius]
    }

    #[test]
    fn random_star_shaped_polygons_are_covered() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1u32 << 31)
        };
        for _ in 0..500 {
            let n = 4 + (random() * 30.0) as usize;
            let points: Vec<[f64; 2]> = (0..n)
                .map(|i| {
                    let (sin, cos) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
                    let radius = 0.1 + random();
                    [cos * radius, sin * radius]
                })
                .collect();
            assert_covered(&points, &split(&points).1);
        }
    }
}
