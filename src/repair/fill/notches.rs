//! Closes the notches of a jagged rim first, in the planes of the triangles beside them.
//!
//! A rim along whole triangles goes in and out. Seen from across the hole, a fan of triangles to such a rim folds over itself;
//! once the notches are closed, the rim runs straight and long triangles can end at it.

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A triangle closes a notch when it bends from the surface by at most 15 degrees at both its sides (a cosine).
const FLAT_COS_MIN: f64 = 0.965_925_826_289_068_3;
/// Corners that are looked at for each triangle, as each must not be inside it: those of the loop within so many steps.
const CORNERS_NEAR: usize = 256;

/// What is left of a loop when its notches are closed.
#[derive(Debug)]
pub(super) struct Smoothed {
    /// Triangles in the notches, by corners of the loop.
    pub(super) triangles: Vec<[usize; 3]>,
    /// The corners that are left, in the order of the loop.
    pub(super) corners: Vec<usize>,
    /// The unit normal beyond the side from each of them to the next.
    pub(super) rim_normals: Vec<DVec3>,
}

/// A loop whose corners go one after the other.
struct LinkedLoop<'a> {
    points: &'a [DVec3],
    rim_normals: Vec<DVec3>,
    next: Vec<usize>,
    before: Vec<usize>,
    is_left: Vec<bool>,
}

/// Closes notches, those with the shortest mouth first, as long as three corners are left. `rim_normals[i]` is the unit
/// normal of the surface beyond the side from corner `i` on; `is_free(i, k)` says whether an edge may run between two corners.
pub(super) fn close_notches(
    points: &[DVec3],
    rim_normals: &[DVec3],
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Smoothed, Stopped> {
    let n = points.len();
    let mut ring = LinkedLoop {
        points,
        rim_normals: rim_normals.to_vec(),
        next: (0..n).map(|i| (i + 1) % n).collect(),
        before: (0..n).map(|i| (i + n - 1) % n).collect(),
        is_left: vec![true; n],
    };
    let mut open: BinaryHeap<Reverse<(u64, [usize; 3])>> = (0..n).filter_map(|i| ring.notch(i)).collect();
    let (mut triangles, mut left) = (Vec::new(), n);
    while left > 3
        && let Some(Reverse((_, ear))) = open.pop()
    {
        let [a, b, c] = ear;
        let is_current = ear.iter().all(|&i| ring.is_left[i]) && ring.next[a] == b && ring.next[b] == c;
        if !is_current || !is_free(a, c) {
            continue;
        }
        budget.spend(CORNERS_NEAR as u64 / 16)?;
        if !ring.is_empty(ear) {
            continue;
        }
        ring.cut(ear);
        triangles.push(ear);
        left -= 1;
        open.extend([a, c].into_iter().filter_map(|i| ring.notch(i)));
    }
    let corners: Vec<usize> = (0..n).filter(|&i| ring.is_left[i]).collect();
    let rim_normals = corners.iter().map(|&i| ring.rim_normals[i]).collect();
    Ok(Smoothed { triangles, corners, rim_normals })
}

impl LinkedLoop<'_> {
    /// Unit normal of a triangle; zero when it has no area.
    fn normal(&self, ear: [usize; 3]) -> DVec3 {
        let [a, b, c] = ear.map(|i| self.points[i]);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The triangle at corner `b`, if it lies in the surface beside it; by the length of the side that it makes.
    fn notch(&self, b: usize) -> Option<Reverse<(u64, [usize; 3])>> {
        let (a, c) = (self.before[b], self.next[b]);
        let normal = self.normal([a, b, c]);
        let beside = [self.rim_normals[a], self.rim_normals[b]];
        let is_flat = beside.iter().all(|beyond| normal.dot(*beyond) >= FLAT_COS_MIN);
        let length = self.points[a].distance_squared(self.points[c]);
        // The bits of numbers above zero have their order.
        (is_flat && length > 0.0).then(|| Reverse((length.to_bits(), [a, b, c])))
    }

    /// True when no corner of the loop nearby is inside a triangle, as seen along its normal.
    fn is_empty(&self, ear: [usize; 3]) -> bool {
        let [a, _, c] = ear;
        let corners = ear.map(|i| self.points[i]);
        let normal = self.normal(ear);
        let reach = corners[0].distance(corners[2]).max(corners[0].distance(corners[1]));
        let is_inside = |p: DVec3| {
            let is_left = |k: usize| {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                (to - from).cross(p - from).dot(normal) >= 0.0
            };
            (p - corners[0]).dot(normal).abs() < reach && (0..3).all(is_left)
        };
        let (mut forward, mut back) = (self.next[c], self.before[a]);
        for _ in 0..CORNERS_NEAR / 2 {
            if forward == a || back == c {
                break;
            }
            if [forward, back].into_iter().any(|i| is_inside(self.points[i])) {
                return false;
            }
            (forward, back) = (self.next[forward], self.before[back]);
        }
        true
    }

    fn cut(&mut self, [a, b, c]: [usize; 3]) {
        self.rim_normals[a] = self.normal([a, b, c]);
        self.is_left[b] = false;
        self.next[a] = c;
        self.before[c] = a;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rim of a square hole in the plane z = 0 whose sides are saws, and a corner far above it.
    fn saw(teeth: usize) -> Vec<DVec3> {
        let mut points = Vec::new();
        for side in 0..4 {
            for tooth in 0..2 * teeth {
                let along = tooth as f64 / (2 * teeth) as f64;
                let across = if tooth % 2 == 1 { -0.4 / teeth as f64 } else { 0.0 };
                let (x, y) = (along, across);
                points.push(match side {
                    0 => DVec3::new(x, y, 0.0),
                    1 => DVec3::new(1.0 - y, x, 0.0),
                    2 => DVec3::new(1.0 - x, 1.0 - y, 0.0),
                    _ => DVec3::new(y, 1.0 - x, 0.0),
                });
            }
        }
        points
    }

    #[test]
    fn the_notches_of_a_saw_are_closed_and_a_bent_rim_is_left_alone() {
        let points = saw(10);
        let n = points.len();
        let normals = vec![DVec3::Z; n];
        let flat = close_notches(&points, &normals, |_, _| true, &Budget::unlimited()).unwrap();
        assert_eq!((flat.corners.len(), flat.triangles.len()), (3, n - 3));
        // Nothing goes on in the plane: the triangles would stand on end.
        let normals = vec![DVec3::X; n];
        let bent = close_notches(&points, &normals, |_, _| true, &Budget::unlimited()).unwrap();
        assert_eq!((bent.corners.len(), bent.triangles.len()), (n, 0));
        let barred = close_notches(&points, &vec![DVec3::Z; n], |_, _| false, &Budget::unlimited()).unwrap();
        assert_eq!(barred.corners.len(), n);
    }

    #[test]
    fn no_triangle_covers_a_corner_that_juts_into_it() {
        let points: Vec<DVec3> = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [3.0, 1.0], [0.0, 4.0]]
            .map(|[x, y]: [f64; 2]| DVec3::new(x, y, 0.0))
            .to_vec();
        let found = close_notches(&points, &[DVec3::Z; 5], |_, _| true, &Budget::unlimited()).unwrap();
        let area = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| points[i]);
            (b - a).cross(c - a).z / 2.0
        };
        assert!(found.triangles.iter().all(|t| area(t) > 0.0), "{found:?}");
        let rest = [found.corners[0], found.corners[1], found.corners[2]];
        assert_eq!(found.triangles.iter().map(area).sum::<f64>() + area(&rest), 10.0, "{found:?}");
    }
}
