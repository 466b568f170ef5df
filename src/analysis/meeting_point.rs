//! A point where two triangles meet.

use crate::geom::{DVec3, closest_point_on_triangle};

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
        let next = closest_point_on_triangle(closest_point_on_triangle(point, b), a);
        if next == point {
            break;
        }
        point = next;
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossing_triangles_meet_on_their_common_segment() {
        let flat = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        let steep = [DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.2, 3.0, 0.5)];
        let place = meeting_point(flat, steep);
        assert!(closest_point_on_triangle(place, flat).distance(place) < 1e-9);
        assert!(closest_point_on_triangle(place, steep).distance(place) < 1e-9);
    }
}
