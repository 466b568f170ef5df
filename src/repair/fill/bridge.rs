//! Makes one polygon of several loops, by cuts that it passes twice, so that what closes a loop closes them.

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Pairs of corners that are looked at for a cut; of larger loops every so many corners are.
const PAIRS_MAX: usize = 1 << 20;

/// The corners of the polygon that goes around the first loop and, at the nearest corner of what there is so far, around
/// each other one. `None` when no cut is free.
///
/// ```text
///   ┌───────┐            ┌───────┐
///   │  ┌─┐  │            │  ┌─┐  │
///   │  │ │  │   becomes  │  │ │  │
///   │  └─┘  │            │  └┐│  │
///   └───────┘            └───┘└──┘
/// ```
pub(super) fn one_polygon(
    points: &[DVec3],
    loops: &[std::ops::Range<usize>],
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<usize>>, Stopped> {
    let mut polygon: Vec<usize> = loops[0].clone().collect();
    let mut left: Vec<std::ops::Range<usize>> = loops[1..].to_vec();
    while !left.is_empty() {
        let stride =
            (polygon.len() * left.iter().map(ExactSizeIterator::len).sum::<usize>()).div_ceil(PAIRS_MAX);
        let mut best: Option<(f64, usize, usize, usize)> = None;
        for (which, island) in left.iter().enumerate() {
            for to in island.clone().step_by(stride) {
                budget.spend(polygon.len() as u64 / 64 + 1)?;
                for (at, &from) in polygon.iter().enumerate() {
                    let distance = points[from].distance_squared(points[to]);
                    if best.is_none_or(|best| distance < best.0) && is_free(from, to) {
                        best = Some((distance, at, which, to));
                    }
                }
            }
        }
        let Some((_, at, which, to)) = best else { return Ok(None) };
        let island = left.remove(which);
        let from = polygon[at];
        let around = (to..island.end).chain(island.start..=to);
        let inserted: Vec<usize> = around.chain([from]).collect();
        polygon.splice(at + 1..at + 1, inserted);
    }
    Ok(Some(polygon))
}

/// Triangles between two loops that run against each other, from the nearest pair of corners on: of the two next
/// triangles always the one with the shorter new side. O(n).
pub(super) fn zip(
    points: &[DVec3],
    [outer, inner]: [std::ops::Range<usize>; 2],
    budget: &Budget,
) -> Result<Vec<[usize; 3]>, Stopped> {
    let stride = (outer.len() * inner.len()).div_ceil(PAIRS_MAX);
    let mut best = (f64::INFINITY, outer.start, inner.start);
    for a in outer.clone().step_by(stride) {
        budget.spend(inner.len() as u64 / 64 + 1)?;
        for b in inner.clone() {
            let distance = points[a].distance_squared(points[b]);
            if distance < best.0 {
                best = (distance, a, b);
            }
        }
    }
    let (mut a, mut b) = (best.1, best.2);
    let (mut left_a, mut left_b) = (outer.len(), inner.len());
    let mut triangles = Vec::with_capacity(left_a + left_b);
    while left_a + left_b > 0 {
        let next_a = if a + 1 == outer.end { outer.start } else { a + 1 };
        let next_b = if b == inner.start { inner.end - 1 } else { b - 1 };
        let (of_a, of_b) =
            (points[next_a].distance_squared(points[b]), points[a].distance_squared(points[next_b]));
        if left_b == 0 || (left_a > 0 && of_a <= of_b) {
            triangles.push([a, next_a, b]);
            (a, left_a) = (next_a, left_a - 1);
        } else {
            triangles.push([next_b, b, a]);
            (b, left_b) = (next_b, left_b - 1);
        }
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_passes_every_side_of_the_loops_once_and_the_cuts_twice() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let points = [
            at(0.0, 0.0),
            at(9.0, 0.0),
            at(9.0, 9.0),
            at(0.0, 9.0),
            at(1.0, 1.0),
            at(1.0, 2.0),
            at(2.0, 1.0),
        ];
        let polygon = one_polygon(&points, &[0..4, 4..7], |_, _| true, &Budget::unlimited()).unwrap();
        assert_eq!(polygon, Some(vec![0, 4, 5, 6, 4, 0, 1, 2, 3]));
        let none = one_polygon(&points, &[0..4, 4..7], |_, _| false, &Budget::unlimited()).unwrap();
        assert_eq!(none, None);
    }
}
