//! Closes a loop in space by cutting off its corners, the one with the shortest diagonal first. For long loops that are
//! neither flat nor short enough for a search of all triangulations.

use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, are_collinear};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A length whose order is that of its bits, as it is not negative.
fn order_of(length: f64) -> u64 {
    length.to_bits()
}

/// Triangles of the loop through `points`, in its direction; `None` when it cannot be closed this way. `is_free(i, k)`
/// says whether a diagonal may run between two corners. O(n log n).
pub(super) fn triangulate(
    points: &[DVec3],
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let n = points.len();
    let mut next: Vec<usize> = (0..n).map(|i| (i + 1) % n).collect();
    let mut prev: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    let diagonal = |a: usize, c: usize| order_of(points[a].distance_squared(points[c]));
    let mut ears: BinaryHeap<_> =
        (0..n).map(|b| Reverse((diagonal(prev[b], next[b]), b, prev[b], next[b]))).collect();
    let mut triangles = Vec::with_capacity(n.saturating_sub(2));
    while triangles.len() + 2 < n {
        budget.spend(1)?;
        let Some(Reverse((_, b, a, c))) = ears.pop() else { return Ok(None) };
        let is_stale = prev[b] != a || next[b] != c;
        let is_last = triangles.len() + 3 == n;
        if is_stale || are_collinear(points[a], points[b], points[c]) || !(is_last || is_free(a, c)) {
            continue;
        }
        triangles.push([a, b, c]);
        (next[a], prev[c]) = (c, a);
        // A corner that is cut off has no neighbours, so that its old entries are stale.
        (next[b], prev[b]) = (b, b);
        for i in [a, c] {
            ears.push(Reverse((diagonal(prev[i], next[i]), i, prev[i], next[i])));
        }
    }
    Ok(Some(triangles))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zigzag_loop_is_closed_with_two_triangles_less_than_corners() {
        let points: Vec<DVec3> = (0..8)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::FRAC_PI_4;
                DVec3::new(angle.cos(), angle.sin(), f64::from(i % 2) / 4.0)
            })
            .collect();
        let triangles = triangulate(&points, |_, _| true, &Budget::unlimited()).unwrap().unwrap();
        assert_eq!(triangles.len(), 6);
        for step in 0..8 {
            let has = |t: &&[usize; 3]| (0..3).any(|c| [t[c], t[(c + 1) % 3]] == [step, (step + 1) % 8]);
            assert_eq!(triangles.iter().filter(has).count(), 1);
        }
    }

    #[test]
    fn a_loop_whose_diagonals_are_all_in_use_is_not_closed() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        assert_eq!(triangulate(&points, |_, _| false, &Budget::unlimited()).unwrap(), None);
    }
}
