//! The texture coordinates of a draft.

use super::seams::are_over_seams;
use super::{Blend, Draft, FIRST_BLEND, NEW};
use crate::geom::{DVec3, closest_point_on_triangle, shares_of_corners};
use crate::mesh::{NO_POINT, Soup, Texture, triangle_of};
use rustc_hash::FxHashMap;

/// How far a corner may be from the triangle of the file that it is a part of, as a share of that triangle's longest side. The
/// lattices of repairs move corners by far less; what is farther away belongs to another triangle of a polygon.
const GAP_MAX: f64 = 1.0 / 64.0;

impl Draft {
    /// The texture of the triangles whose corners are at vertices of their triangle in `source`, or where these were before
    /// they moved; of parts of a triangle, between its corners; and of patches, between the points at their rims, where no
    /// seam runs into them. Other triangles have none.
    pub(super) fn texture(&self, texture: &Texture, source: &Soup) -> Texture {
        if texture.is_empty() {
            return Texture::default();
        }
        let mut points = texture.points.clone();
        let mut parts: FxHashMap<[u32; 2], Option<u32>> = FxHashMap::default();
        let mut of_part = |t: u32, v: u32, was: [DVec3; 3]| {
            *parts.entry([t, v]).or_insert_with(|| {
                let shares = shares(was, self.positions[v as usize])?;
                points.push(mean(texture.of_triangle(t as usize)?.into_iter().zip(shares)));
                Some(points.len() as u32 - 1)
            })
        };
        let place = |v: u32| source.positions.get(v as usize);
        let mut of_triangle = |t: usize| {
            let origin = self.triangle_origin[t];
            let (was, of_corners) =
                (source.triangles.get(origin as usize)?, texture.corners.get(origin as usize)?);
            let mut point = |v: u32| {
                let vertex = self.vertex_origin[v as usize];
                match (0..3).find(|&k| place(was[k]) == place(vertex)) {
                    Some(k) => Some(of_corners[k]),
                    None => of_part(origin, v, source.corners(origin)),
                }
            };
            let [a, b, c] = self.triangles[t];
            Some([point(a)?, point(b)?, point(c)?]).filter(|corners| !corners.contains(&NO_POINT))
        };
        let own: Vec<Option<[u32; 3]>> = (0..self.triangles.len()).map(&mut of_triangle).collect();
        let values = |t: usize| Some(own[t]?.map(|p| points[p as usize]));
        let is_over_seam = are_over_seams(self, values);
        let of_blends: Vec<Option<u32>> =
            self.blends.vertices.iter().map(|blend| blended(blend, texture, &mut points)).collect();
        let at_rim = |origin: u32| {
            let rims = &self.blends.rims;
            let [_, corner] =
                *rims.get(rims.partition_point(|&[v, _]| v < origin)).filter(|r| r[0] == origin)?;
            Some(texture.corners[triangle_of(corner) as usize][(corner % 3) as usize])
                .filter(|&point| point != NO_POINT)
        };
        let of_patch = |t: usize| {
            let point = |v: u32| match self.vertex_origin[v as usize] {
                origin if origin >= FIRST_BLEND => of_blends[(origin - FIRST_BLEND) as usize],
                origin => at_rim(origin),
            };
            let [a, b, c] = self.triangles[t].map(point);
            (self.triangle_origin[t] == NEW && !is_over_seam[t]).then_some([a?, b?, c?])
        };
        let corners = own
            .iter()
            .enumerate()
            .map(|(t, own)| own.or_else(|| of_patch(t)).unwrap_or([NO_POINT; 3]))
            .collect();
        Texture { points, corners }.without_unused_points()
    }
}

/// The shares of the corners of a triangle in the place on it that is nearest to `p`; `None`: that is too far away, or the
/// triangle has no area.
fn shares(corners: [DVec3; 3], p: DVec3) -> Option<[f64; 3]> {
    let [a, b, c] = corners;
    let on = closest_point_on_triangle(p, corners);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if on.distance(p) > GAP_MAX * longest {
        return None;
    }
    shares_of_corners(on, corners)
}

fn mean(points: impl Iterator<Item = ([f64; 2], f64)>) -> [f64; 2] {
    points.fold([0.0; 2], |sum, ([u, v], share)| [sum[0] + share * u, sum[1] + share * v])
}

/// Adds the point of a blend to `points`; gives its number, if all corners of the blend have points.
fn blended(blend: &Blend, texture: &Texture, points: &mut Vec<[f64; 2]>) -> Option<u32> {
    let at = |&(corner, share): &(u32, f64)| {
        Some((texture.of_triangle(triangle_of(corner) as usize)?[(corner % 3) as usize], share))
    };
    let at: Vec<([f64; 2], f64)> = blend.iter().map(at).collect::<Option<_>>()?;
    points.push(mean(at.into_iter()));
    Some(points.len() as u32 - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles, and where its corners are in a picture.
    fn square() -> Soup {
        let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        Soup {
            positions: points.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            face_count: 2,
            texture: Texture {
                points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.75]],
                corners: vec![[0, 1, 2], [0, 2, 3]],
            },
            ..Soup::default()
        }
    }

    #[test]
    fn texture_stays_with_its_triangles_and_points_that_none_has_go() {
        let source = square();
        let (mut draft, _) = Draft::from_soup(&source);
        draft.retain_triangles(&[false, true]);
        draft.triangles.push([0, 1, 2]);
        draft.triangle_origin.push(NEW);
        let written = draft.to_soup(&source).texture;
        assert_eq!(written.points, [[0.0, 0.0], [1.0, 1.0], [0.5, 0.75]]);
        assert_eq!(written.corners, [[0, 1, 2], [NO_POINT; 3]]);
        draft.retain_triangles(&[false, true]);
        assert_eq!(draft.to_soup(&source).texture, Texture::default());
    }

    #[test]
    fn parts_of_a_triangle_have_texture_between_its_corners() {
        let source = square();
        let (mut draft, _) = Draft::from_soup(&source);
        draft.positions.push(DVec3::new(2.0, 2.0, 0.01));
        draft.vertex_origin.push(FIRST_BLEND);
        draft.blends.vertices.push(vec![(0, 1.0)]);
        draft.replace(0, &[[0, 1, 4], [1, 2, 4]]);
        draft.replace(1, &[[0, 4, 3], [4, 2, 3]]);
        let written = draft.to_soup(&source).texture;
        let of = |t: usize| written.of_triangle(t).unwrap();
        assert_eq!((of(0)[2], of(2)[2]), ([0.5, 0.5], [0.5, 0.5]));
        assert_eq!((of(1)[1], of(1)[0], of(3)[0]), ([0.5, 0.5], [0.0, 0.0], [0.5, 0.5]));
        // A corner far away is not of this triangle.
        draft.positions[4].z = 1.0;
        assert_eq!(draft.to_soup(&source).texture, Texture::default());
    }
}
