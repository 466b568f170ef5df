//! The triangulation of a loop in space whose triangles bend least, and among those the smallest.
//!
//! Liepa, "Filling holes in meshes" (2003), after Barequet and Sharir (1995): dynamic programming over the polygons
//! that a diagonal cuts off, O(n³) for n corners. The worst bend is measured by one minus the cosine of the angle between
//! neighbouring triangles, which orders as the angle does.

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Most corners of a loop that is triangulated this way; about 350,000 weighings.
pub(super) const CORNERS_MAX: usize = 128;

/// Worst bend of a triangulation, then its area.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Weight(f64, f64);

const IMPOSSIBLE: Weight = Weight(f64::INFINITY, f64::INFINITY);
const NOTHING: Weight = Weight(0.0, 0.0);

/// How much two neighbouring triangles bend, from 0 to 2; 0 where one has no normal, so that a rim without one does not
/// hide how all others bend.
pub(super) fn bend(normal: DVec3, other: DVec3) -> f64 {
    if normal == DVec3::ZERO || other == DVec3::ZERO { 0.0 } else { 1.0 - normal.dot(other) }
}

/// A table over the pairs `i < k` of corners: the best triangulation of the polygon from corner `i` to corner `k`.
struct Table<'a> {
    points: &'a [DVec3],
    rim_normals: &'a [DVec3],
    weight: Vec<Weight>,
    /// The third corner of the triangle on the diagonal from `i` to `k`.
    apex: Vec<usize>,
}

/// Triangles of the loop through `points`, in its direction; `None` when there are none or the loop is too long.
/// `rim_normals[i]` is the unit normal of the surface beyond the edge from corner `i` on; `is_free(i, k)` says whether a
/// diagonal may run between two corners.
pub(super) fn triangulate(
    points: &[DVec3],
    rim_normals: &[DVec3],
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let n = points.len();
    if !(3..=CORNERS_MAX).contains(&n) {
        return Ok(None);
    }
    let mut table = Table { points, rim_normals, weight: vec![NOTHING; n * n], apex: vec![0; n * n] };
    for span in 2..n {
        for i in 0..n - span {
            budget.spend(span as u64 / 8)?;
            let k = i + span;
            let is_rim = span == n - 1;
            (table.weight[i * n + k], table.apex[i * n + k]) =
                if is_rim || is_free(i, k) { table.best(i, k) } else { (IMPOSSIBLE, 0) };
        }
    }
    Ok((table.weight[n - 1] < IMPOSSIBLE).then(|| table.triangles()))
}

impl Table<'_> {
    fn n(&self) -> usize {
        self.points.len()
    }

    /// The best triangle on the diagonal from `i` to `k`, and the weight of all it cuts off.
    fn best(&self, i: usize, k: usize) -> (Weight, usize) {
        let mut best = (IMPOSSIBLE, 0);
        for m in i + 1..k {
            let weight = self.weigh(i, m, k);
            if weight < best.0 {
                best = (weight, m);
            }
        }
        best
    }

    fn weigh(&self, i: usize, m: usize, k: usize) -> Weight {
        let n = self.n();
        let (Weight(bend_a, area_a), Weight(bend_b, area_b)) =
            (self.weight[i * n + m], self.weight[m * n + k]);
        let Some((normal, area)) = self.facing(i, m, k) else { return IMPOSSIBLE };
        let bend = |other: DVec3| bend(normal, other);
        let mut worst = bend_a.max(bend_b).max(bend(self.beyond(i, m))).max(bend(self.beyond(m, k)));
        if k - i == n - 1 {
            worst = worst.max(bend(self.rim_normals[k]));
        }
        Weight(worst, area_a + area_b + area)
    }

    /// Unit normal and area of a triangle; `None` when it has no area.
    fn facing(&self, a: usize, b: usize, c: usize) -> Option<(DVec3, f64)> {
        let cross = (self.points[b] - self.points[a]).cross(self.points[c] - self.points[a]);
        let length = cross.length();
        (length > 0.0 && length.is_finite()).then(|| (cross / length, length / 2.0))
    }

    /// Normal of the triangle beyond the edge from `a` to `b`, in the patch or on the rim.
    fn beyond(&self, a: usize, b: usize) -> DVec3 {
        if b == a + 1 {
            return self.rim_normals[a];
        }
        let apex = self.apex[a * self.n() + b];
        self.facing(a, apex, b).map_or(DVec3::ZERO, |(normal, _)| normal)
    }

    /// The triangles of the best triangulation of all.
    fn triangles(&self) -> Vec<[usize; 3]> {
        let n = self.n();
        let mut triangles = Vec::with_capacity(n - 2);
        let mut open = vec![(0, n - 1)];
        while let Some((i, k)) = open.pop() {
            if k > i + 1 {
                let m = self.apex[i * n + k];
                triangles.push([i, m, k]);
                open.extend([(i, m), (m, k)]);
            }
        }
        triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(points: &[[f64; 3]], is_free: impl Fn(usize, usize) -> bool) -> Option<Vec<[usize; 3]>> {
        let points: Vec<DVec3> = points.iter().copied().map(DVec3::from_array).collect();
        let rim_normals = vec![DVec3::ZERO; points.len()];
        triangulate(&points, &rim_normals, is_free, &Budget::unlimited()).unwrap()
    }

    const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];

    #[test]
    fn a_bent_square_gets_two_triangles_that_avoid_a_diagonal_in_use() {
        assert_eq!(triangles(&SQUARE, |i, k| (i, k) != (0, 2)), Some(vec![[0, 1, 3], [1, 2, 3]]));
        assert_eq!(triangles(&SQUARE, |i, k| (i, k) != (1, 3)), Some(vec![[0, 2, 3], [0, 1, 2]]));
        assert_eq!(triangles(&SQUARE, |_, _| false), None);
    }

    #[test]
    fn a_corner_on_the_line_of_its_neighbours_gets_no_flat_triangle() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        assert_eq!(triangles(&points, |_, _| true), Some(vec![[0, 1, 3], [1, 2, 3]]));
    }
}
