//! The triangulation of a loop in space whose triangles bend least, and among those the smallest.
//!
//! Liepa, "Filling holes in meshes" (2003), after Barequet and Sharir (1995): dynamic programming over the polygons
//! that a chord cuts off, O(n³) for n corners where every chord may be taken. The worst bend is measured by one minus the
//! cosine of the angle between neighbouring triangles, which orders as the angle does. As in Liepa, the best of what a chord
//! cuts off is chosen before it is known how it bends over that chord, so that the worst bend of all may not be the least
//! there is.

use super::chords::{All, Chords};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Corners up to which every chord of a loop is looked at; about 350,000 weighings.
pub(super) const CORNERS_MAX: usize = 128;

/// Triangles without area of a triangulation, its worst bend, and its area.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Weight(u32, f64, f64);

const IMPOSSIBLE: Weight = Weight(u32::MAX, f64::INFINITY, f64::INFINITY);
const NOTHING: Weight = Weight(0, 0.0, 0.0);

/// How much two neighbouring triangles bend, from 0 to 2; 0 where one has no normal, so that a rim without one does not
/// hide how all others bend.
pub(super) fn bend(normal: DVec3, other: DVec3) -> f64 {
    if normal == DVec3::ZERO || other == DVec3::ZERO { 0.0 } else { 1.0 - normal.dot(other) }
}

/// What the best triangulation has least of, after triangles without area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Least {
    /// Its worst bend, then its area.
    Bend,
    /// Its area.
    Area,
}

/// A table over chords: the best triangulation of the polygon from corner `i` to corner `k`.
struct ChordTable<'a, C> {
    points: &'a [DVec3],
    rim_normals: &'a [DVec3],
    chords: &'a C,
    least: Least,
    weight: Vec<Weight>,
    /// The third corner of the triangle on the chord from `i` to `k`.
    apex: Vec<usize>,
    /// The unit normal of that triangle, or that of the surface beyond a side of the loop; zero when it has none.
    normal: Vec<DVec3>,
}

/// Triangles of the loop through `points`, in its direction, all with an area; `None` when there are none or the loop is too
/// long. `rim_normals[i]` is the unit normal of the surface beyond the edge from corner `i` on; `is_free(i, k)` says whether a
/// chord may run between two corners.
pub(super) fn triangulate(
    points: &[DVec3],
    rim_normals: &[DVec3],
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    if points.len() > CORNERS_MAX {
        return Ok(None);
    }
    let all = All { corners: points.len() };
    let found = with_least_caps(points, rim_normals, &all, Least::Bend, is_free, budget)?;
    Ok(found.filter(|found| found.caps == 0).map(|found| found.triangles))
}

/// A triangulation, and how many of its triangles have no area.
pub(super) struct MinimalTriangulation {
    pub(super) triangles: Vec<[usize; 3]>,
    caps: u32,
}

/// As [`triangulate`], by the given chords only, and with triangles without area where there is no other way: the corners of
/// a straight piece of a rim.
pub(super) fn with_least_caps(
    points: &[DVec3],
    rim_normals: &[DVec3],
    chords: &impl Chords,
    least: Least,
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<MinimalTriangulation>, Stopped> {
    let n = points.len();
    if n < 3 {
        return Ok(None);
    }
    let mut table = ChordTable {
        points,
        rim_normals,
        chords,
        least,
        weight: vec![NOTHING; chords.len()],
        apex: vec![0; chords.len()],
        normal: vec![DVec3::ZERO; chords.len()],
    };
    let mut spent = 0;
    for (i, k) in chords.shortest_first(budget)? {
        if k == i + 1 {
            if let Some(chord) = chords.find(i, k) {
                table.normal[chord] = rim_normals[i];
            }
            continue;
        }
        let is_rim = k - i == n - 1;
        let (best, looked) = if is_rim || is_free(i, k) { table.best(i, k) } else { ((IMPOSSIBLE, 0), 1) };
        if let Some(chord) = chords.find(i, k) {
            (table.weight[chord], table.apex[chord]) = best;
            table.normal[chord] = table.facing(i, best.1, k).map_or(DVec3::ZERO, |(normal, _)| normal);
        }
        spent += looked;
        budget.spend(spent / 8)?;
        spent %= 8;
    }
    let Some(Weight(caps, ..)) = table.weight_of(0, n - 1).filter(|&weight| weight < IMPOSSIBLE) else {
        return Ok(None);
    };
    Ok(Some(MinimalTriangulation { triangles: table.triangles(), caps }))
}

impl<C: Chords> ChordTable<'_, C> {
    fn weight_of(&self, i: usize, k: usize) -> Option<Weight> {
        self.chords.find(i, k).map(|chord| self.weight[chord])
    }

    /// The best triangle on the chord from `i` to `k` with the weight of all it cuts off, and how many were weighed.
    fn best(&self, i: usize, k: usize) -> ((Weight, usize), u64) {
        let (mut best, mut looked) = ((IMPOSSIBLE, 0), 0);
        self.chords.visit_thirds(i, k, |m, chords| {
            looked += 1;
            let weight = self.weigh([i, m, k], chords, best.0);
            if weight < best.0 {
                best = (weight, m);
            }
        });
        (best, looked)
    }

    /// `chords` are those from `i` to `m` and from `m` to `k`. What cannot be less than `best` may be impossible.
    #[inline]
    fn weigh(&self, [i, m, k]: [usize; 3], chords: [usize; 2], best: Weight) -> Weight {
        let [Weight(caps_a, bend_a, area_a), Weight(caps_b, bend_b, area_b)] =
            chords.map(|chord| self.weight[chord]);
        if caps_a == IMPOSSIBLE.0 || caps_b == IMPOSSIBLE.0 {
            return IMPOSSIBLE;
        }
        // The triangle between them adds to each, so most need no look at it.
        let (caps, bent) = (caps_a + caps_b, bend_a.max(bend_b));
        if caps >= best.0 && (caps > best.0 || bent > best.1 || (bent == best.1 && area_a + area_b >= best.2))
        {
            return IMPOSSIBLE;
        }
        let (cap, (normal, area)) = match self.facing(i, m, k) {
            Some(facing) => (0, facing),
            None => (1, (DVec3::ZERO, 0.0)),
        };
        if self.least == Least::Area {
            return Weight(caps + cap, 0.0, area_a + area_b + area);
        }
        let bend = |other: DVec3| bend(normal, other);
        let beyond = chords.map(|chord| bend(self.normal[chord]));
        let mut worst = bent.max(beyond[0]).max(beyond[1]);
        if k - i == self.points.len() - 1 {
            worst = worst.max(bend(self.rim_normals[k]));
        }
        Weight(caps + cap, worst, area_a + area_b + area)
    }

    /// Unit normal and area of a triangle; `None` when it has no area.
    fn facing(&self, a: usize, b: usize, c: usize) -> Option<(DVec3, f64)> {
        let cross = (self.points[b] - self.points[a]).cross(self.points[c] - self.points[a]);
        let length = cross.length();
        (length > 0.0 && length.is_finite()).then(|| (cross / length, length / 2.0))
    }

    /// The triangles of the best triangulation of all.
    fn triangles(&self) -> Vec<[usize; 3]> {
        let n = self.points.len();
        let mut triangles = Vec::with_capacity(n - 2);
        let mut open = vec![(0, n - 1)];
        while let Some((i, k)) = open.pop() {
            if k > i + 1
                && let Some(chord) = self.chords.find(i, k)
            {
                let m = self.apex[chord];
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

    /// Worst bend, then area, of triangles with the rim.
    fn weigh(points: &[DVec3], normals: &[DVec3], triangles: &[[usize; 3]]) -> (f64, f64) {
        let n = points.len();
        let facing = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| points[i]);
            (b - a).cross(c - a)
        };
        let (mut worst, mut area) = (0.0f64, 0.0);
        for t in triangles {
            area += facing(t).length() / 2.0;
            for c in 0..3 {
                let (from, to) = (t[c], t[(c + 1) % 3]);
                let beyond = match to == (from + 1) % n {
                    true => normals[from],
                    false => {
                        let has = |u: &&[usize; 3]| (0..3).any(|c| (u[c], u[(c + 1) % 3]) == (to, from));
                        facing(triangles.iter().find(has).unwrap()).normalize()
                    }
                };
                worst = worst.max(bend(facing(t).normalize(), beyond));
            }
        }
        (worst, area)
    }

    fn sorted(triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
        let mut sorted = triangles.to_vec();
        sorted.sort_unstable();
        sorted
    }

    /// All triangulations of the polygon from corner `i` to corner `k`.
    fn all(i: usize, k: usize) -> Vec<Vec<[usize; 3]>> {
        if k < i + 2 {
            return vec![Vec::new()];
        }
        let mut every = Vec::new();
        for m in i + 1..k {
            for left in all(i, m) {
                for right in all(m, k) {
                    every.push([&left[..], &right[..], &[[i, m, k]]].concat());
                }
            }
        }
        every
    }

    #[test]
    fn no_triangulation_of_four_corners_is_better_and_larger_loops_have_all_their_sides() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        for case in 0..120 {
            let n = 3 + case % 7;
            let mut point = |i: usize| {
                let turn = i as f64 * std::f64::consts::TAU / n as f64;
                DVec3::new(turn.cos() + 0.5 * next(), turn.sin() + 0.5 * next(), next())
            };
            let points: Vec<DVec3> = (0..n).map(&mut point).collect();
            let normals: Vec<DVec3> = (0..n).map(|i| (point(i) + DVec3::Z * 2.0).normalize()).collect();
            let found = triangulate(&points, &normals, |_, _| true, &Budget::unlimited()).unwrap().unwrap();
            let (bend, area) = weigh(&points, &normals, &found);
            let sides = |t: &[usize; 3]| (0..3).filter(|&c| t[(c + 1) % 3] == (t[c] + 1) % n).count();
            assert_eq!(found.iter().map(sides).sum::<usize>(), n, "case {case}");
            assert!(all(0, n - 1).iter().any(|other| sorted(other) == sorted(&found)), "case {case}");
            // Beyond, the best of what a chord cuts off is chosen without regard to how it bends over the chord.
            for other in all(0, n - 1).iter().filter(|_| n <= 4) {
                let (other_bend, other_area) = weigh(&points, &normals, other);
                assert!(bend <= other_bend + 1e-12, "case {case}: {bend} {other_bend}");
                assert!(other_bend > bend + 1e-12 || area <= other_area + 1e-12, "case {case}");
            }
        }
    }
}
