//! OFF output, text and binary.

use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::colors::{ColorLayout, as_floats};
use crate::formats::decimals::Text;
use crate::formats::{WriteError, float32};
use crate::mesh::{Color, Soup};

/// OFF, or COFF if vertices have colours; faces have theirs after the indices.
pub(in crate::formats) fn text(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    const VERTEX_BYTES_MAX: usize = 160;
    /// A number, and a third of what stands around those of a triangle, which may have a colour.
    const CORNER_BYTES_MAX: usize = 52;
    let mut text = Text::new(budget);
    // Readers take four channels from each vertex of a COFF.
    let with_alpha = |layout| ColorLayout { has_alpha: true, ..layout };
    let vertex_layout = ColorLayout::of(&soup.vertex_colors).map(with_alpha);
    text.before_item(0, VERTEX_BYTES_MAX)?;
    text.word(if vertex_layout.is_some() { "COFF\n" } else { "OFF\n" });
    text.integer(soup.positions.len() as i64);
    text.word(" ");
    text.integer(soup.faces().count() as i64);
    text.word(" 0\n");
    for (i, p) in soup.positions.iter().enumerate() {
        text.before_item(i, VERTEX_BYTES_MAX)?;
        text.point(i as u32, *p, "off")?;
        if let Some(layout) = vertex_layout {
            text.color(soup.vertex_colors.get(i).copied().flatten(), layout);
        }
        text.word("\n");
    }
    let face_layout = ColorLayout::of(&soup.face_colors);
    let mut corner_count = 0;
    for (t, corners) in soup.faces() {
        text.integer(corners.len() as i64);
        for &v in corners {
            text.before_item(corner_count, CORNER_BYTES_MAX)?;
            corner_count += 1;
            text.word(" ");
            text.integer(i64::from(v));
        }
        put_face_color(&mut text, face_color(soup, t as usize), face_layout);
        text.word("\n");
    }
    Ok(text.into_bytes())
}

/// A face has no channel that its colour lacks.
fn put_face_color(text: &mut Text<'_>, color: Option<Color>, layout: Option<ColorLayout>) {
    let has_alpha = match color {
        None => return,
        Some(Color::Index(id)) => {
            text.word(" ");
            text.integer(id.into());
            return;
        }
        Some(Color::Bytes(_, alpha)) => alpha.is_some(),
        Some(Color::Floats(_, alpha) | Color::Linear(_, alpha)) => alpha.is_some(),
    };
    if let Some(layout) = layout {
        text.color(color, ColorLayout { has_alpha, ..layout });
    }
}

fn face_color(soup: &Soup, triangle: usize) -> Option<Color> {
    soup.face_colors.get(soup.face_of(triangle as u32) as usize).copied().flatten()
}

/// Binary OFF, or COFF if vertices have colours. Coordinates are rounded to float32, colours become floats, and the
/// indices of colours in maps are left out.
pub(in crate::formats) fn binary(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    /// Position and colour.
    const VERTEX_BYTES_MAX: usize = 28;
    /// Two counts, four channels.
    const FACE_BYTES_MAX: usize = 24;
    const CORNER_BYTES: usize = 4;
    const HEADER_BYTES_MAX: usize = 32;
    let has_colors = ColorLayout::of(&soup.vertex_colors).is_some();
    let (faces, corners) =
        soup.faces().fold((0, 0), |(faces, corners), (_, face)| (faces + 1, corners + face.len()));
    let bytes_max = HEADER_BYTES_MAX
        + VERTEX_BYTES_MAX * soup.positions.len()
        + FACE_BYTES_MAX * faces
        + CORNER_BYTES * corners;
    let (mut out, _charged) = budget.vec::<u8>(bytes_max)?;
    out.extend_from_slice(if has_colors { b"COFF BINARY\n" } else { b"OFF BINARY\n" });
    put_integers(&mut out, &[soup.positions.len() as u32, faces as u32, 0]);
    for (i, p) in soup.positions.iter().enumerate() {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        put_floats(&mut out, &float32::rounded(i as u32, *p, "off-binary")?);
        if has_colors {
            put_floats(&mut out, &as_floats(soup.vertex_colors.get(i).copied().flatten()));
        }
    }
    for (t, corners) in soup.faces() {
        if t.is_multiple_of(CHECK_EVERY as u32) {
            budget.check()?;
        }
        put_integers(&mut out, &[corners.len() as u32]);
        put_integers(&mut out, corners);
        match face_color(soup, t as usize) {
            color
            @ Some(Color::Bytes(_, Some(_)) | Color::Floats(_, Some(_)) | Color::Linear(_, Some(_))) => {
                put_integers(&mut out, &[4]);
                put_floats(&mut out, &as_floats(color));
            }
            color @ Some(Color::Bytes(..) | Color::Floats(..) | Color::Linear(..)) => {
                put_integers(&mut out, &[3]);
                put_floats(&mut out, &as_floats(color)[..3]);
            }
            Some(Color::Index(_)) | None => put_integers(&mut out, &[0]),
        }
    }
    Ok(out)
}

fn put_integers(out: &mut Vec<u8>, values: &[u32]) {
    for value in values {
        out.extend_from_slice(&value.to_be_bytes());
    }
}

fn put_floats(out: &mut Vec<u8>, values: &[f32]) {
    for value in values {
        out.extend_from_slice(&value.to_be_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn soup() -> Soup {
        Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y * 0.1],
            triangles: vec![[0, 1, 2], [2, 1, 0], [1, 2, 0]],
            face_count: 3,
            face_colors: vec![Some(Color::Bytes([1, 2, 3], Some(4))), Some(Color::Index(7)), None],
            ..Soup::default()
        }
    }

    #[test]
    fn text_has_colours_after_what_they_belong_to() {
        let mut soup = soup();
        let plain = String::from_utf8(text(&soup, &Budget::unlimited()).unwrap()).unwrap();
        assert_eq!(plain, "OFF\n3 3 0\n0 0 0\n1 0 0\n0 0.1 0\n3 0 1 2 1 2 3 4\n3 2 1 0 7\n3 1 2 0\n");
        soup.vertex_colors =
            vec![Some(Color::Floats([1.0, 0.5, 0.0], None)), None, Some(Color::Bytes([0, 51, 255], None))];
        let colored = String::from_utf8(text(&soup, &Budget::unlimited()).unwrap()).unwrap();
        let vertices = "0 0 0 1.0 0.5 0.0 1.0\n1 0 0 1.0 1.0 1.0 1.0\n0 0.1 0 0.0 0.2 1.0 1.0\n";
        assert!(colored.starts_with(&format!("COFF\n3 3 0\n{vertices}3 0 1 2")), "{colored}");
    }

    #[test]
    fn binary_has_the_size_of_its_parts() {
        let bytes = binary(&soup(), &Budget::unlimited()).unwrap();
        assert_eq!(bytes.len(), "OFF BINARY\n".len() + 12 + 3 * 12 + 3 * 20 + 16);
        assert_eq!(&bytes[11..23], [0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 0]);
    }
}
