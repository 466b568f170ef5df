//! A point where two triangles meet.

use crate::geom::DVec3;

/// Alternating projections after which the point is taken. For triangles that meet they converge to a common point;
/// the rate depends on the angle between them, and a report needs a place to look at, not the last digit.
const STEPS: usize = 64;

/// A point that is, as nearly as 64 alternating projections bring it, in both triangles (von Neumann's method, which
/// converges for any two convex sets that meet). Not finite when distances overflow.
pub(super) fn meeting_point(a: [DVec3; 3], b: [DVec3; 3]) -> DVec3 {
    // Begin in the middle of what the boxes have in common.
    let low = a[0].min(a[1]).min(a[2]).max(b[0].min(b[1]).min(b[2]));
    let high = a[0].max(a[1]).max(a[2]).min(b[0].max(b[1]).max(b[2]));
    let mut point = low / 2.0 + high / 2.0;
    for _ in 0..STEPS {
        let next = closest_point(a, closest_point(b, point));
        if next == point {
            break;
        }
        point = next;
    }
    point
}

/// The point of triangle `abc` that is nearest to `p`, by the region of the plane in which `p` lies (Ericson 2005,
/// section 5.1.5).
fn closest_point([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (at_c, at_b, at_a) = (d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4);
    if at_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if at_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if at_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = at_a + at_b + at_c;
    a + ab * (at_b / sum) + ac * (at_c / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossing_triangles_meet_on_their_common_segment() {
        let flat = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        let steep = [DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.2, 3.0, 0.5)];
        let place = meeting_point(flat, steep);
        assert!(closest_point(flat, place).distance(place) < 1e-9);
        assert!(closest_point(steep, place).distance(place) < 1e-9);
    }

    #[test]
    fn the_nearest_point_is_found_in_every_region() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for (p, nearest) in [
            ((-1.0, -1.0, 0.0), (0.0, 0.0, 0.0)),
            ((2.0, -1.0, 0.0), (1.0, 0.0, 0.0)),
            ((-1.0, 2.0, 0.0), (0.0, 1.0, 0.0)),
            ((0.5, -1.0, 1.0), (0.5, 0.0, 0.0)),
            ((-1.0, 0.5, 1.0), (0.0, 0.5, 0.0)),
            ((1.0, 1.0, 0.0), (0.5, 0.5, 0.0)),
            ((0.25, 0.25, 7.0), (0.25, 0.25, 0.0)),
        ] {
            assert!(closest_point(triangle, DVec3::from(p)).distance(DVec3::from(nearest)) < 1e-15, "{p:?}");
        }
    }
}
