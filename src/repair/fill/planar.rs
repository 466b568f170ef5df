//! Triangulates a flat region, with islands, in its view along an axis.

use crate::geom::{DVec2, DVec3, triangulate_region};

/// Most corners of a region; a triangulation of so many takes some 20 ms and cannot be stopped inside.
pub(super) const CORNERS_MAX: usize = 1 << 14;

/// The view of a plane with this normal along the axis that is nearest to it, mirrored if need be so that what turns
/// counter-clockwise around the normal does so in the view. Coordinates are not changed, so the view is exact.
pub(super) fn view(normal: DVec3) -> impl Fn(DVec3) -> DVec2 {
    let size = normal.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
    move |p| DVec2::new(p[u], p[v])
}

/// Triangles of the region to the left of the `loops` (the outer one and those of islands) as they are seen along
/// `normal`; corners are numbered through all loops. `None` when the loops touch or cross in the view.
pub(super) fn triangulate(loops: &[Vec<DVec3>], normal: DVec3) -> Option<Vec<[usize; 3]>> {
    if loops.iter().map(Vec::len).sum::<usize>() > CORNERS_MAX {
        return None;
    }
    let view = view(normal);
    let seen: Vec<Vec<DVec2>> =
        loops.iter().map(|corners| corners.iter().map(|&p| view(p)).collect()).collect();
    triangulate_region(&seen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_turn_around_the_normal_whichever_it_is() {
        for normal in [DVec3::X, DVec3::NEG_Y, DVec3::new(0.4, -0.7, 0.9)] {
            let u = normal.any_orthogonal_vector().normalize();
            let v = normal.cross(u).normalize();
            let corners = [u, v, -u, -v].to_vec();
            let triangles = triangulate(std::slice::from_ref(&corners), normal).unwrap();
            assert_eq!(triangles.len(), 2);
            for [a, b, c] in triangles.iter().map(|t| t.map(|i| corners[i])) {
                assert!((b - a).cross(c - a).dot(normal) > 0.0, "{normal}");
            }
        }
    }
}
