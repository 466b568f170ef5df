//! Texture coordinates on their way through a simplification, which knows points and no table of them.

use crate::mesh::{NO_POINT, Soup, Texture};
use crate::simplify::{NO_TEXTURE, Simplified};
use rustc_hash::FxHashMap;

/// The points at the corners of all triangles; empty when none has some.
pub(super) fn points_of(mesh: &Soup) -> Vec<[[f64; 2]; 3]> {
    let points = |t: usize| mesh.texture.of_triangle(t).unwrap_or([NO_TEXTURE; 3]);
    (0..mesh.texture.corners.len()).map(points).collect()
}

/// The texture of a simplified `mesh`: triangles have points where those have some from which they come.
pub(super) fn texture_on(result: &Simplified, mesh: &Soup) -> Texture {
    let has_points = |t: u32| mesh.texture.corners.get(t as usize).is_some_and(|of| of[0] != NO_POINT);
    if mesh.texture.is_empty() {
        return Texture::default();
    }
    let points = |(&points, &origin)| if has_points(origin) { points } else { [NO_TEXTURE; 3] };
    let corners: Vec<_> = result.texture.iter().zip(&result.triangle_origin).map(points).collect();
    texture_of(&corners)
}

/// The table of the points at corners, each once, in the order of their first use.
fn texture_of(corners: &[[[f64; 2]; 3]]) -> Texture {
    let mut texture = Texture::default();
    let mut numbers = FxHashMap::default();
    let mut number = |point: [f64; 2]| {
        if point == NO_TEXTURE {
            return NO_POINT;
        }
        *numbers.entry(point.map(f64::to_bits)).or_insert_with(|| {
            texture.points.push(point);
            texture.points.len() as u32 - 1
        })
    };
    let corners: Vec<[u32; 3]> = corners.iter().map(|points| points.map(&mut number)).collect();
    texture.corners = corners;
    texture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_listed_once_and_come_back_the_same() {
        let (a, b, c) = ([0.0, 0.5], [1.0, 0.1], [0.25, 1.0]);
        let corners = [[a, b, c], [NO_TEXTURE; 3], [c, b, a]];
        let texture = texture_of(&corners);
        assert_eq!(
            (&texture.points[..], &texture.corners[..]),
            (&[a, b, c][..], &[[0, 1, 2], [NO_POINT; 3], [2, 1, 0]][..])
        );
        assert_eq!(points_of(&Soup { texture, ..Soup::default() }), corners);
        assert!(texture_of(&[]).is_empty() && points_of(&Soup::default()).is_empty());
    }
}
