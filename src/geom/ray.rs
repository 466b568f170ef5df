//! Crossings of vertical rays with triangles, for exact containment.

use super::{AxisProjection, DVec3, Sign, orient3d};

/// Whether the ray from `p` towards +z crosses the triangle, and how: `Positive` through its back (the normal points
/// along the ray: the ray leaves a solid whose normals point outward), `Negative` through its front (the ray enters).
///
/// The ray is moved by an infinitesimal `(i, i^2, 0)`, so that it meets no edge, no vertex and no vertical triangle:
/// each edge belongs to exactly one of the triangles beside it, and the crossings of a closed surface, `Positive`
/// counted 1 and `Negative` -1, sum up to the winding number of `p`. Exact. `p` must not lie on the triangle; the
/// triangle may be degenerate.
///
/// Simulation of simplicity after Edelsbrunner and Mücke (1990), for the ray alone.
pub fn upward_crossing(p: DVec3, [a, b, c]: [DVec3; 3]) -> Option<Sign> {
    let turn = moved_turn(a, b, p);
    if turn.is_zero() || moved_turn(b, c, p) != turn || moved_turn(c, a, p) != turn {
        return None;
    }
    // Seen from above, the moved ray is strictly inside. It starts below when the triangle, turned counter-clockwise,
    // has `p` on its negative side; the side is never zero because `p` is not on the triangle.
    let is_below = orient3d(a, b, c, p) * turn == Sign::Negative;
    is_below.then_some(turn)
}

/// How `a`, `b`, `p` turn seen from above after `p` has moved by `(i, i^2)`: the turn itself, else the sign of its
/// derivative by `p.x`, else by `p.y`. Zero only when `a` and `b` are at one place in this view; then no turn of the
/// triangle decides, because the three turns sum up to twice its area, which is zero.
fn moved_turn(a: DVec3, b: DVec3, p: DVec3) -> Sign {
    AxisProjection::ALONG_Z
        .turn(a, b, p)
        .or_else(|| Sign::of_difference(a.y, b.y))
        .or_else(|| Sign::of_difference(b.x, a.x))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of the cube from -1 to 1 and its twelve triangles, outward.
    fn cube() -> Vec<[DVec3; 3]> {
        let corner = |i: usize| {
            let side = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            DVec3::new(side(0), side(1), side(2))
        };
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
            .into_iter()
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
            .map(|t| t.map(corner))
            .collect()
    }

    fn winding(p: DVec3, surface: &[[DVec3; 3]]) -> i32 {
        surface
            .iter()
            .filter_map(|&t| upward_crossing(p, t))
            .map(|s| if s == Sign::Positive { 1 } else { -1 })
            .sum()
    }

    #[test]
    fn rays_through_edges_vertices_and_walls_count_each_surface_once() {
        let cube = cube();
        for x in [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0] {
            for y in [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0] {
                let is_on_wall = f64::abs(x) == 1.0 || f64::abs(y) == 1.0;
                let is_inside = f64::abs(x) < 1.0 && f64::abs(y) < 1.0;
                if !is_on_wall {
                    assert_eq!(winding(DVec3::new(x, y, 0.0), &cube), i32::from(is_inside), "{x} {y}");
                }
                assert_eq!(winding(DVec3::new(x, y, -3.0), &cube), 0, "{x} {y} from below");
                assert_eq!(winding(DVec3::new(x, y, 3.0), &cube), 0, "{x} {y} from above");
            }
        }
    }

    #[test]
    fn the_sign_is_that_of_the_normal() {
        let up = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let below = DVec3::new(0.25, 0.25, -1.0);
        assert_eq!(upward_crossing(below, up), Some(Sign::Positive));
        assert_eq!(upward_crossing(below, [up[0], up[2], up[1]]), Some(Sign::Negative));
        assert_eq!(upward_crossing(DVec3::new(0.25, 0.25, 1.0), up), None);
    }
}
