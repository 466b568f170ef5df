//! OBJ output.

use super::material_names::{MaterialWriter, NAME_BYTES_MAX, put_libraries};
use crate::budget::Budget;
use crate::formats::WriteError;
use crate::formats::colors::ColorLayout;
use crate::formats::decimals::Text;
use crate::mesh::{Color, NO_POINT, Soup};

/// The only one that other readers know.
const COLORS: ColorLayout = ColorLayout { is_bytes: false, has_alpha: false };

/// The names of material files, if faces have materials, vertices, with red, green and blue after the coordinates of those that have a colour, texture coordinates if there
/// are some, then faces with their materials: polygons as such, unless there is a texture, which belongs to the corners of triangles.
pub(in crate::formats) fn write(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    const VERTEX_BYTES_MAX: usize = 160;
    const FACE_BYTES_MAX: usize = 80;
    const TEXTURE_BYTES_MAX: usize = 60;
    let mut text = Text::new(budget);
    put_libraries(&mut text, &soup.materials);
    for (i, p) in soup.positions.iter().enumerate() {
        text.before_item(i, VERTEX_BYTES_MAX)?;
        text.word("v ");
        text.point(i as u32, *p, "obj")?;
        if let Some(color @ Some(Color::Bytes(..) | Color::Floats(..))) = soup.vertex_colors.get(i) {
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
    if soup.texture.is_empty() {
        put_faces(&mut text, soup)?;
        return Ok(text.into_bytes());
    }
    let name_bytes_max = if soup.materials.is_empty() { 0 } else { NAME_BYTES_MAX + 8 };
    let mut material = MaterialWriter::default();
    for (t, corners) in soup.triangles.iter().enumerate() {
        text.before_item(t, FACE_BYTES_MAX + name_bytes_max)?;
        material.before_face(&mut text, &soup.materials, soup.face_of(t as u32));
        let points = soup.texture.corners.get(t).filter(|points| points[0] != NO_POINT);
        text.word("f");
        for (k, &v) in corners.iter().enumerate() {
            text.word(" ");
            text.integer(i64::from(v) + 1);
            if let Some(points) = points {
                text.word("/");
                text.integer(i64::from(points[k]) + 1);
            }
        }
        text.word("\n");
    }
    Ok(text.into_bytes())
}

fn put_faces(text: &mut Text<'_>, soup: &Soup) -> Result<(), WriteError> {
    /// A number, and a third of what stands around those of a triangle.
    const CORNER_BYTES_MAX: usize = 16;
    let name_bytes_max = if soup.materials.is_empty() { 0 } else { NAME_BYTES_MAX + 8 };
    let (mut corner_count, mut material) = (0, MaterialWriter::default());
    for (first, corners) in soup.faces() {
        material.before_face(text, &soup.materials, soup.face_of(first));
        text.word("f");
        for &v in corners {
            text.before_item(corner_count, CORNER_BYTES_MAX + name_bytes_max)?;
            corner_count += 1;
            text.word(" ");
            text.integer(i64::from(v) + 1);
        }
        text.word("\n");
    }
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
