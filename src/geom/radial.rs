//! The order of triangles around a common edge.

use std::cmp::Ordering;

use super::{AxisProjection, DVec3, Sign, ThreePointPlane};

/// The places of `apexes` in the order in which a half-plane that turns about the line from `a` to `b` passes them,
/// counter-clockwise for whoever looks from `b` to `a`, starting with the first. `None` when two lie in one half-plane
/// or one lies on the line. Exact.
///
/// ```text
///        1                      looking from b to a, which is the point in the middle:
///        |
///    2---ab---0                 0, 1, 2, 3
///        |
///        3
/// ```
pub fn radial_order(a: DVec3, b: DVec3, apexes: &[DVec3]) -> Option<Vec<usize>> {
    let &start = apexes.first()?;
    let (view, turn) = AxisProjection::showing([a, b, start])?;
    let plane = ThreePointPlane::through([a, b, start]);
    // Which part of the turn an apex is in: the half-plane of the first, the half before its opposite, the opposite one,
    // the half after it.
    let part = |p: DVec3| match plane.side(p) {
        Sign::Positive => Some(1),
        Sign::Negative => Some(3),
        Sign::Zero => match view.turn(a, b, p) {
            Sign::Zero => None,
            same if same == turn => Some(0),
            _ => Some(2),
        },
    };
    let mut placed = Vec::with_capacity(apexes.len());
    for (i, &p) in apexes.iter().enumerate() {
        placed.push((part(p)?, i));
    }
    let after = |i: usize, j: usize| ThreePointPlane::through([a, b, apexes[i]]).side(apexes[j]);
    placed.sort_by(|&(s, i), &(t, j)| {
        let within = || match after(i, j) {
            Sign::Positive => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Greater,
        };
        s.cmp(&t).then_with(within)
    });
    let is_shared =
        |pair: &[(i32, usize)]| pair[0].0 == pair[1].0 && after(pair[0].1, pair[1].1) != Sign::Positive;
    let is_apart = !placed.windows(2).any(is_shared);
    is_apart.then(|| placed.into_iter().map(|(_, i)| i).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around_z(degrees: &[f64]) -> Option<Vec<usize>> {
        let apexes: Vec<DVec3> =
            degrees.iter().map(|d| DVec3::new(d.to_radians().cos(), d.to_radians().sin(), 0.3 * d)).collect();
        radial_order(DVec3::ZERO, DVec3::Z, &apexes)
    }

    #[test]
    fn apexes_are_ordered_by_their_angle_from_the_first_whatever_their_height() {
        assert_eq!(around_z(&[0.0, 90.0, 200.0, 300.0]), Some(vec![0, 1, 2, 3]));
        assert_eq!(around_z(&[100.0, 20.0, 101.0, 99.0, 250.0, 300.0]), Some(vec![0, 2, 4, 5, 1, 3]));
        assert_eq!(around_z(&[270.0, 10.0]), Some(vec![0, 1]));
    }

    #[test]
    fn opposite_half_planes_are_apart_and_equal_ones_are_not() {
        let square = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y];
        let order = radial_order(DVec3::ZERO, DVec3::Z, &square);
        assert_eq!(order, Some(vec![0, 2, 1, 3]));
        for twice in [[DVec3::X, DVec3::X * 2.0 + DVec3::Z], [-DVec3::Y, -DVec3::Y]] {
            assert_eq!(radial_order(DVec3::ZERO, DVec3::Z, &twice), None);
            assert_eq!(radial_order(DVec3::ZERO, DVec3::Z, &[DVec3::Y, twice[0], twice[1]]), None);
        }
        assert_eq!(radial_order(DVec3::ZERO, DVec3::Z, &[DVec3::X, DVec3::Z * 2.0]), None);
    }
}
