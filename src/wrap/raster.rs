//! The cubes and columns that a triangle goes through. Places are in lattice units.

use crate::geom::{Aabb, DVec3};

/// What rounding may hide: cubes that a triangle misses by less are taken too.
const SLACK: f64 = 1e-6;

/// A triangle with less area than this share of its longest side's square has no plane to go by.
const FLAT: f64 = 1e-9;

/// The extent of a polygon in the plane, between two lines across its first axis; `None` where it does not reach.
fn span_between(corners: [[f64; 2]; 3], from: f64, to: f64) -> Option<[f64; 2]> {
    let mut span = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |y: f64| span = [span[0].min(y), span[1].max(y)];
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let ([x0, y0], [x1, y1]) = (corners[a], corners[b]);
        if (from..=to).contains(&x0) {
            add(y0);
        }
        for line in [from, to] {
            if (x0 < line) != (x1 < line) && x0 != x1 {
                add(y0 + (y1 - y0) * ((line - x0) / (x1 - x0)).clamp(0.0, 1.0));
            }
        }
    }
    (span[0] <= span[1]).then_some(span)
}

/// Calls `visit` with the first two coordinates of each column of vertices that the triangle may cross: all that it does
/// and few others.
pub(super) fn columns(corners: [DVec3; 3], dims: [usize; 3], mut visit: impl FnMut(usize, usize)) {
    let bounds = Aabb::of(corners);
    let flat = corners.map(|p| [p.x, p.y]);
    for i in whole_between(bounds.min.x, bounds.max.x, dims[0]) {
        let x = i as f64;
        if let Some([from, to]) = span_between(flat, x - SLACK, x + SLACK) {
            whole_between(from, to, dims[1]).for_each(|j| visit(i, j));
        }
    }
}

/// Whole numbers below `len` between two places, with slack.
fn whole_between(from: f64, to: f64, len: usize) -> std::ops::Range<usize> {
    let first = (from - SLACK).ceil().max(0.0) as usize;
    let end = ((to + SLACK).floor() + 1.0).max(0.0) as usize;
    first.min(len)..end.min(len)
}

/// Cells `n..n + 1` below `len` that meet an interval, with slack.
fn cells_between(from: f64, to: f64, len: usize) -> std::ops::Range<usize> {
    let first = (from - SLACK).floor().max(0.0) as usize;
    let end = ((to + SLACK).floor() + 1.0).max(0.0) as usize;
    first.min(len)..end.min(len)
}

/// Calls `visit` with the lowest corner of each cube that the triangle may meet: all that it does and few others.
pub(super) fn cubes(corners: [DVec3; 3], dims: [usize; 3], mut visit: impl FnMut([usize; 3])) {
    let bounds = Aabb::of(corners);
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let size = normal.abs().to_array();
    let depth = if size[0] >= size[1] && size[0] >= size[2] {
        0
    } else if size[1] >= size[2] {
        1
    } else {
        2
    };
    let (u, v) = ((depth + 1) % 3, (depth + 2) % 3);
    let flat = corners.map(|p| [p[u], p[v]]);
    // Depth as a function of the other two coordinates; slopes are at most 1 because the normal is largest here.
    let longest = (bounds.max - bounds.min).max_element();
    let slopes = if size[depth] > FLAT * longest * longest {
        [-normal[u] / normal[depth], -normal[v] / normal[depth]]
    } else {
        [f64::NAN; 2]
    };
    let cells = dims.map(|n| n - 1);
    for cu in cells_between(bounds.min[u], bounds.max[u], cells[u]) {
        let Some([from, to]) = span_between(flat, cu as f64 - SLACK, (cu + 1) as f64 + SLACK) else {
            continue;
        };
        for cv in cells_between(from, to, cells[v]) {
            let middle = corners[0][depth]
                + slopes[0] * (cu as f64 + 0.5 - corners[0][u])
                + slopes[1] * (cv as f64 + 0.5 - corners[0][v]);
            let half = 0.5 * (slopes[0].abs() + slopes[1].abs());
            // Without an area (NaN) the whole extent; `max` and `min` drop the NaN.
            let low = (middle - half).max(bounds.min[depth]);
            let high = (middle + half).min(bounds.max[depth]);
            for cd in cells_between(low, high, cells[depth]) {
                let mut cube = [0; 3];
                (cube[u], cube[v], cube[depth]) = (cu, cv, cd);
                visit(cube);
            }
        }
    }
}

/// About how many cubes and columns the triangle goes through; at least what it takes to find that out.
pub(super) fn cost(corners: [DVec3; 3]) -> u64 {
    let bounds = Aabb::of(corners);
    let [a, b, c] = (bounds.max - bounds.min).to_array().map(|x| x + 1.0);
    (a * b).max(b * c).max(c * a) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::closest_point_on_triangle;

    #[test]
    fn every_cube_that_a_sample_of_the_triangle_is_in_is_visited_and_none_far_from_it() {
        let mut state = 7u32;
        let mut unit = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        for round in 0..200 {
            let mut point = || DVec3::new(unit(), unit(), unit()) * 10.0 + 1.0;
            let (a, b) = (point(), point());
            let c = match round % 4 {
                0 => a.lerp(b, 0.3),
                1 => DVec3::new(a.x, b.y, a.z),
                _ => point(),
            };
            let mut visited = Vec::new();
            cubes([a, b, c], [13; 3], |cube| visited.push(cube));
            for i in 0..=30 {
                for j in 0..=30 - i {
                    let p = a + (b - a) * (f64::from(i) / 30.0) + (c - a) * (f64::from(j) / 30.0);
                    assert!(visited.contains(&p.to_array().map(|x| x as usize)), "{round}: {p}");
                }
            }
            // Without an area a triangle has no plane, and its whole extent is taken.
            for cube in visited.into_iter().filter(|_| round % 4 != 0) {
                let middle = DVec3::from_array(cube.map(|n| n as f64 + 0.5));
                assert!(closest_point_on_triangle(middle, [a, b, c]).distance(middle) < 2.2, "{round}");
            }
        }
    }
}
