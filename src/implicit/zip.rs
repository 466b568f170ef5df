//! A strip of triangles between two loops that run side by side.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;

/// The most pairs of vertices of two loops that are looked at; a bit each.
const PAIRS_MAX: usize = 1 << 27;

/// The strip between `outer` and `inner` (vertices of `points`, both counter-clockwise around the hole) whose edges
/// between the loops have the least sum of squared lengths, given the closest pair of vertices as one of them (Fuchs,
/// Kedem and Uselton 1977). Each edge of `outer` is run through forward and each of `inner` backward. `None` when the
/// loops are too long.
pub(super) fn zip(
    points: &[DVec3],
    outer: &[u32],
    inner: &[u32],
    budget: &Budget,
) -> Result<Option<Vec<[u32; 3]>>, Stopped> {
    let (n, m) = (outer.len(), inner.len());
    if (n + 1) * (m + 1) > PAIRS_MAX {
        return Ok(None);
    }
    let (i0, j0) = closest(points, outer, inner, budget)?;
    let rim = |i: usize| outer[(i0 + i) % n];
    let ring = |j: usize| inner[(j0 + j) % m];
    let square = |i: usize, j: usize| points[rim(i) as usize].distance_squared(points[ring(j) as usize]);
    // What was advanced last at (i, j): true for the outer loop.
    let (mut was_outer, _charge) = budget.vec::<bool>((n + 1) * (m + 1))?;
    let mut costs = vec![f64::INFINITY; m + 1];
    for i in 0..=n {
        for j in 0..=m {
            let (by_outer, by_inner) = (
                if i > 0 { costs[j] } else { f64::INFINITY },
                if j > 0 { costs[j - 1] } else { f64::INFINITY },
            );
            was_outer.push(by_outer <= by_inner);
            costs[j] = square(i, j) + if i + j == 0 { 0.0 } else { by_outer.min(by_inner) };
        }
        budget.spend(m as u64 / 64 + 1)?;
    }
    let (mut i, mut j) = (n, m);
    let mut strip = Vec::with_capacity(n + m);
    while i + j > 0 {
        if was_outer[i * (m + 1) + j] {
            strip.push([rim(i - 1), rim(i), ring(j)]);
            i -= 1;
        } else {
            strip.push([rim(i), ring(j), ring(j - 1)]);
            j -= 1;
        }
    }
    Ok(Some(strip))
}

fn closest(
    points: &[DVec3],
    outer: &[u32],
    inner: &[u32],
    budget: &Budget,
) -> Result<(usize, usize), Stopped> {
    let mut best = (f64::INFINITY, 0, 0);
    for (i, &r) in outer.iter().enumerate() {
        for (j, &s) in inner.iter().enumerate() {
            let square = points[r as usize].distance_squared(points[s as usize]);
            if square < best.0 {
                best = (square, i, j);
            }
        }
        if i.is_multiple_of(CHECK_EVERY / 64) {
            budget.check()?;
        }
    }
    Ok((best.1, best.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strip_between_two_circles_uses_each_edge_once() {
        let circle = |count: u32, radius: f64| {
            (0..count).map(move |i| {
                let turn = std::f64::consts::TAU * f64::from(i) / f64::from(count);
                DVec3::new(libm::cos(turn), libm::sin(turn), 0.0) * radius
            })
        };
        let points: Vec<DVec3> = circle(12, 1.0).chain(circle(17, 0.7)).collect();
        let (outer, inner): (Vec<u32>, Vec<u32>) = ((0..12).collect(), (12..29).collect());
        let strip = zip(&points, &outer, &inner, &Budget::unlimited()).unwrap().unwrap();
        assert_eq!(strip.len(), 29);
        let has = |a: u32, b: u32| {
            strip.iter().filter(|t| (0..3).any(|c| t[c] == a && t[(c + 1) % 3] == b)).count()
        };
        assert!((0..12).all(|i| has(i, (i + 1) % 12) == 1));
        assert!((0..17).all(|j| has(12 + (j + 1) % 17, 12 + j) == 1));
        for t in &strip {
            let [a, b, c] = t.map(|v| points[v as usize]);
            assert!((b - a).cross(c - a).z > 0.0, "{t:?}");
        }
    }
}
