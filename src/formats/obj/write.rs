//! OBJ output.

use crate::budget::Budget;
use crate::formats::WriteError;
use crate::formats::colors::ColorLayout;
use crate::formats::decimals::Text;
use crate::mesh::{Color, NO_POINT, Soup};

/// The only one that other readers know.
const COLORS: ColorLayout = ColorLayout { is_bytes: false, has_alpha: false };

/// Vertices, with red, green and blue after the coordinates of those that have a colour, texture coordinates if there
/// are some, then faces.
pub(in crate::formats) fn write(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    const VERTEX_BYTES_MAX: usize = 160;
    const FACE_BYTES_MAX: usize = 80;
    const TEXTURE_BYTES_MAX: usize = 60;
    let mut text = Text::new(budget);
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
    for (t, corners) in soup.triangles.iter().enumerate() {
        text.before_item(t, FACE_BYTES_MAX)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

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
    fn nan_cannot_be_written() {
        let soup = Soup { positions: vec![DVec3::NAN], ..Soup::default() };
        assert!(matches!(
            write(&soup, &Budget::unlimited()),
            Err(WriteError::NotRepresentable { vertex: 0, .. })
        ));
    }
}
