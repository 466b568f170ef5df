//! OBJ output.

use super::material_names::{MaterialWriter, put_libraries};
use super::object_names::{ObjectWriter, faces_by_object};
use crate::budget::Budget;
use crate::formats::WriteError;
use crate::formats::colors::ColorLayout;
use crate::formats::decimals::Text;
use crate::mesh::{Color, NO_POINT, Soup};
use std::ops::Range;

/// The only one that other readers know.
const COLORS: ColorLayout = ColorLayout { is_bytes: false, has_alpha: false };

/// The names of material files, if faces have materials, vertices, with red, green and blue after the coordinates of those
/// that have a colour, texture coordinates if there are some, then faces with their materials, those of each object together:
/// polygons as such, unless they have texture at some corners and not at all, or several at one.
pub(in crate::formats) fn write(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    const VERTEX_BYTES_MAX: usize = 160;
    const TEXTURE_BYTES_MAX: usize = 60;
    let mut text = Text::new(budget);
    put_libraries(&mut text, &soup.materials);
    for (i, p) in soup.positions.iter().enumerate() {
        text.before_item(i, VERTEX_BYTES_MAX)?;
        text.word("v ");
        text.point(i as u32, *p, "obj")?;
        if let Some(color @ Some(Color::Bytes(..) | Color::Floats(..) | Color::Linear(..))) =
            soup.vertex_colors.get(i)
        {
            text.color(*color, COLORS);
        }
        text.word("\n");
    }
    for (i, point) in soup.texture.points.iter().enumerate() {
        text.before_item(i, TEXTURE_BYTES_MAX)?;
        text.word("vt");
        for &c in point {
            text.word(" ");
            // A point that cannot be used keeps its number.
            text.coordinate(if c.is_finite() { c } else { 0.0 });
        }
        text.word("\n");
    }
    let (mut corner_count, mut material, mut object) =
        (0, MaterialWriter::default(), ObjectWriter::default());
    let (by_object, _charge) = match soup.objects.is_empty() {
        true => (None, None),
        false => faces_by_object(soup, budget).map(|(faces, charge)| (Some(faces), Some(charge)))?,
    };
    let faces: &mut dyn Iterator<Item = (u32, &[u32])> = match by_object {
        Some(faces) => &mut faces.into_iter(),
        None => &mut soup.faces(),
    };
    for (t, corners) in faces {
        object.before_face(&mut text, &soup.objects, soup.face_of(t))?;
        material.before_face(&mut text, &soup.materials, soup.face_of(t))?;
        let triangles = t as usize..t as usize + corners.len() - 2;
        match points_of(soup, corners, &triangles) {
            Some(points) => put_face(&mut text, &mut corner_count, corners, &points)?,
            None => {
                for t in triangles {
                    let points = &soup.texture.corners[t];
                    put_face(&mut text, &mut corner_count, &soup.triangles[t], points)?;
                }
            }
        }
    }
    Ok(text.into_bytes())
}

/// The texture points at the corners of a face of these triangles, or [`NO_POINT`] at each; `None` when its triangles do not
/// agree.
fn points_of(soup: &Soup, corners: &[u32], triangles: &Range<usize>) -> Option<Vec<u32>> {
    if soup.texture.is_empty() {
        return Some(Vec::new());
    }
    let of_triangles = &soup.texture.corners[triangles.clone()];
    if let [points] = of_triangles {
        return Some(points.to_vec());
    }
    let vertices = soup.triangles[triangles.clone()].as_flattened().iter().copied();
    let mut points: Vec<(u32, u32)> = vertices.zip(of_triangles.as_flattened().iter().copied()).collect();
    points.sort_unstable();
    points.dedup();
    let has_none = points.iter().all(|&(_, point)| point == NO_POINT);
    let has_all = points.iter().all(|&(_, point)| point != NO_POINT);
    let is_unique = points.windows(2).all(|pair| pair[0].0 != pair[1].0);
    let point = |v: &u32| points.binary_search_by_key(v, |&(u, _)| u).ok().map(|i| points[i].1);
    if is_unique && (has_none || has_all) { corners.iter().map(point).collect() } else { None }
}

/// `points` are those of the corners, or empty.
fn put_face(
    text: &mut Text<'_>,
    corner_count: &mut usize,
    corners: &[u32],
    points: &[u32],
) -> Result<(), WriteError> {
    /// Two numbers, and a third of what stands around those of a triangle.
    const CORNER_BYTES_MAX: usize = 28;
    text.word("f");
    for (k, &v) in corners.iter().enumerate() {
        text.before_item(*corner_count, CORNER_BYTES_MAX)?;
        *corner_count += 1;
        text.word(" ");
        text.integer(i64::from(v) + 1);
        if let Some(&point) = points.get(k).filter(|&&point| point != NO_POINT) {
            text.word("/");
            text.integer(i64::from(point) + 1);
        }
    }
    text.word("\n");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Encoding, ReadOptions, read};
    use crate::geom::DVec3;
    use crate::mesh::Polygons;

    #[test]
    fn text_is_short_and_exact_and_colours_follow() {
        let soup = Soup {
            positions: vec![DVec3::new(-0.0, 0.1, 1e-20), DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            vertex_colors: vec![Some(Color::Bytes([255, 0, 51], Some(9))), None, Some(Color::Index(3))],
            ..Soup::default()
        };
        let text = String::from_utf8(write(&soup, &Budget::unlimited()).unwrap()).unwrap();
        assert_eq!(text, "v -0 0.1 1e-20 1.0 0.0 0.2\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }

    #[test]
    fn polygons_are_written_as_such_and_read_back() {
        let polygons = Polygons {
            faces: vec![1],
            starts: vec![0, 4],
            corners: vec![0, 1, 2, 3],
            first_triangles: vec![1],
            not_fans: vec![],
        };
        let soup = Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y, DVec3::Z],
            triangles: vec![[0, 4, 1], [0, 1, 2], [0, 2, 3], [0, 3, 4]],
            triangle_face: vec![0, 1, 1, 2],
            face_count: 3,
            polygons,
            ..Soup::default()
        };
        let bytes = write(&soup, &Budget::unlimited()).unwrap();
        let text = std::str::from_utf8(&bytes).unwrap();
        assert!(text.ends_with("f 1 5 2\nf 1 2 3 4\nf 1 4 5\n"), "{text}");
        let back = read(&bytes, Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!((&back.triangles, &back.polygons), (&soup.triangles, &soup.polygons));
        let off = crate::formats::write(&soup, Encoding::Off, &Budget::unlimited()).unwrap();
        let text = std::str::from_utf8(&off).unwrap();
        assert!(
            text.starts_with("OFF\n5 3 0\n") && text.ends_with("3 0 4 1\n4 0 1 2 3\n3 0 3 4\n"),
            "{text}"
        );
        for encoding in [Encoding::Off, Encoding::OffBinary] {
            let bytes = crate::formats::write(&soup, encoding, &Budget::unlimited()).unwrap();
            let back = read(&bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
            assert_eq!((&back.triangles, &back.polygons), (&soup.triangles, &soup.polygons));
        }
    }

    #[test]
    fn nan_cannot_be_written() {
        let soup = Soup { positions: vec![DVec3::NAN], ..Soup::default() };
        assert!(matches!(
            write(&soup, &Budget::unlimited()),
            Err(WriteError::NotRepresentable { vertex: 0, .. })
        ));
    }
}
