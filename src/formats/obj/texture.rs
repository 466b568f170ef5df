//! Texture coordinates of an OBJ file.
//!
//! They say nothing of the shape, so nothing in them makes a file unreadable: what cannot be used is taken as absent.

use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::formats::faces::Faces;
use crate::formats::numbers::{index, integer};
use crate::formats::words::Words;
use crate::mesh::{NO_POINT, Soup, Texture};

/// In the place of a point that the file does not spell as two finite numbers.
const ABSENT: [f64; 2] = [f64::NAN; 2];

/// Texture coordinates of a part of a file.
#[derive(Debug, Default)]
pub(super) struct TextureStatements {
    pub(super) points: Vec<[f64; 2]>,
    /// As the faces of the part, with numbers of points for those of vertices.
    pub(super) faces: Faces,
}

/// `u`, `u v` or `u v w`; `v` is 0 when it is left out, `w` is ignored.
pub(super) fn read_texture_point(words: &mut Words<'_>) -> [f64; 2] {
    let mut number =
        || words.next_in_line().map(|word| fast_float2::parse::<f64, _>(word).unwrap_or(f64::NAN));
    match [number(), number()] {
        [Some(u), v] if u.is_finite() && v.is_none_or(f64::is_finite) => [u, v.unwrap_or(0.0)],
        _ => ABSENT,
    }
}

/// The number of the point in `vt`, `vt/vn` or `/vn`, which stands after the vertex; [`NO_POINT`] when there is none.
pub(super) fn texture_index(word: &[u8], points_before: i64) -> u32 {
    let end = word.iter().position(|&b| b == b'/').unwrap_or(word.len());
    match integer(&word[..end]) {
        None | Some(0) => NO_POINT,
        Some(number) => index(if number < 0 { points_before + number } else { number - 1 }),
    }
}

/// The texture coordinates of a whole file, part by part.
#[derive(Debug, Default)]
pub(super) struct TextureOfFile {
    points: Vec<[f64; 2]>,
    faces: Faces,
}

impl TextureOfFile {
    /// Makes room for the faces and points of a file.
    pub(super) fn reserve<'b>(
        &mut self,
        faces: usize,
        points: usize,
        budget: &'b Budget,
    ) -> Result<[Charge<'b>; 2], Stopped> {
        Ok([self.faces.reserve(faces, budget)?, budget.reserve(&mut self.points, points)?])
    }

    pub(super) fn append(&mut self, part: &TextureStatements) {
        self.points.extend_from_slice(&part.points);
        self.faces.append(&part.faces);
    }

    /// The texture of the triangles of `soup`, which was made of faces with as many corners each.
    pub(super) fn into_texture(self, soup: &Soup, budget: &Budget) -> Result<Texture, Stopped> {
        let is_there = |&i: &u32| self.points.get(i as usize).is_some_and(|p| p[0].is_finite());
        let mut corners = self.faces.corners_of(soup, budget)?;
        let mut has_any = false;
        for (t, points) in corners.iter_mut().enumerate() {
            if t.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            if points.iter().all(is_there) {
                has_any = true;
            } else {
                *points = [NO_POINT; 3];
            }
        }
        Ok(if has_any { Texture { points: self.points, corners } } else { Texture::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Encoding, ReadOptions, read};

    fn texture(text: &str) -> Texture {
        let soup =
            read(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!(soup.check(), Vec::<String>::new());
        soup.texture
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn corners_of_triangles_and_polygons_have_their_points() {
        let points = "vt 0 0\nvt 0.5 0\nvt 0.5 1 7\nvt 0.25\n";
        let want = vec![[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.25, 0.0]];
        let read =
            texture(&format!("{SQUARE}{points}f 1/1 2/2 3/3\nf 4/-1/1 3/-2 2/2/ 1/1//\nf 1/1 2/2 1\nf 1 2"));
        assert_eq!(read.points, want);
        assert_eq!(read.corners, [[0, 1, 2], [3, 2, 1], [3, 1, 0], [NO_POINT; 3]]);
        // Points may come later, and a concave polygon is not split as a fan.
        let concave = "v 0.25 0.25 0\nf 1/1 2/2 5/3 4/4\n";
        let read = texture(&format!("{SQUARE}{concave}{points}"));
        let area = |[a, b, c]: [u32; 3]| [a, b, c].iter().map(|&i| 1u32 << i).sum::<u32>();
        assert_eq!(read.corners.iter().map(|&t| area(t)).sum::<u32>(), 0b1111 + (1 << 0) + (1 << 2));
    }

    #[test]
    fn what_cannot_be_used_is_absent_and_costs_nothing() {
        for rest in [
            "f 1/1 2/2 3/3",
            "vt a b\nvt 0 0\nf 1/1 2/2 3/2",
            "vt 0 0\nf 1/1 2/1 3/9",
            "vt nan 0\nf 1/1 2/1 3/1",
            "vt 0 0\nf 1 2 3",
            "vt 0 inf\nf 1/1 2/1 3/1",
            "vt 0 0\nf 1/x 2/1 3/1",
            "vt 0 0\nf 1/0 2/-2 3/1",
        ] {
            assert_eq!(texture(&format!("{SQUARE}{rest}\n")), Texture::default(), "{rest}");
        }
    }
}
