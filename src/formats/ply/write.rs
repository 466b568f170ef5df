//! PLY output, text and binary.

use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::colors::{ColorLayout, as_bytes, as_floats};
use crate::formats::decimals::Text;
use crate::formats::{Encoding, WriteError};
use crate::mesh::{Color, Soup};

/// Vertices and faces with their colours, polygons as such; face colours that are numbers of a colour map are the property
/// `color_index`, which is -1 for the others. Coordinates are `float` if that holds all of them exactly, otherwise `double`.
pub(in crate::formats) fn write(
    soup: &Soup,
    encoding: Encoding,
    budget: &Budget,
) -> Result<Vec<u8>, WriteError> {
    let plan = PropertyTypes::new(soup);
    match encoding {
        Encoding::PlyBinaryLittleEndian => binary::<false>(soup, &plan, encoding, budget),
        Encoding::PlyBinaryBigEndian => binary::<true>(soup, &plan, encoding, budget),
        _ => text(soup, &plan, encoding, budget),
    }
}

/// The types of all properties.
struct PropertyTypes {
    is_float32: bool,
    is_signed_index: bool,
    /// The number of corners of a face takes one byte, as older readers expect.
    is_byte_size: bool,
    faces: usize,
    corners: usize,
    vertex_colors: Option<ColorLayout>,
    face_colors: Option<ColorLayout>,
    /// Some face colour is a number of a colour map.
    has_color_index: bool,
}

impl PropertyTypes {
    fn new(soup: &Soup) -> Self {
        let is_exact = |&c: &f64| f64::from(c as f32) == c;
        let sizes = || soup.faces().map(|(_, corners)| corners.len());
        Self {
            is_byte_size: sizes().all(|size| size <= usize::from(u8::MAX)),
            faces: sizes().count(),
            corners: sizes().sum(),
            is_float32: soup.positions.iter().all(|p| p.to_array().iter().all(is_exact)),
            // Older readers know no other type.
            is_signed_index: i32::try_from(soup.positions.len()).is_ok(),
            vertex_colors: ColorLayout::of(&soup.vertex_colors),
            face_colors: ColorLayout::of(&soup.face_colors),
            has_color_index: soup.face_colors.iter().any(|color| matches!(color, Some(Color::Index(_)))),
        }
    }

    fn header(&self, soup: &Soup, encoding: Encoding) -> String {
        let layout = match encoding {
            Encoding::PlyBinaryLittleEndian => "binary_little_endian",
            Encoding::PlyBinaryBigEndian => "binary_big_endian",
            _ => "ascii",
        };
        let real = if self.is_float32 { "float" } else { "double" };
        let index = if self.is_signed_index { "int" } else { "uint" };
        let size = if self.is_byte_size { "uchar" } else { "uint" };
        format!(
            "ply\nformat {layout} 1.0\n\
            element vertex {}\nproperty {real} x\nproperty {real} y\nproperty {real} z\n{}\
            element face {}\nproperty list {size} {index} vertex_indices\n{}{}\
            end_header\n",
            soup.positions.len(),
            color_properties(self.vertex_colors),
            self.faces,
            color_properties(self.face_colors),
            if self.has_color_index { "property int color_index\n" } else { "" },
        )
    }
}

fn color_properties(layout: Option<ColorLayout>) -> String {
    let Some(layout) = layout else { return String::new() };
    let kind = if layout.is_bytes { "uchar" } else { "float" };
    let names = &["red", "green", "blue", "alpha"][..layout.channels()];
    names.iter().map(|name| format!("property {kind} {name}\n")).collect()
}

fn vertex_color(soup: &Soup, vertex: usize) -> Option<Color> {
    soup.vertex_colors.get(vertex).copied().flatten()
}

fn face_color(soup: &Soup, triangle: usize) -> Option<Color> {
    soup.face_colors.get(soup.face_of(triangle as u32) as usize).copied().flatten()
}

/// The number in a colour map; -1 when the colour is none.
fn color_index(soup: &Soup, triangle: usize) -> i32 {
    match face_color(soup, triangle) {
        Some(Color::Index(index)) => index,
        _ => -1,
    }
}

fn text(
    soup: &Soup,
    plan: &PropertyTypes,
    encoding: Encoding,
    budget: &Budget,
) -> Result<Vec<u8>, WriteError> {
    const VERTEX_BYTES_MAX: usize = 160;
    /// A number, and a third of what stands around those of a triangle, which may have a colour.
    const CORNER_BYTES_MAX: usize = 52;
    let mut text = Text::new(budget);
    text.word(&plan.header(soup, encoding));
    for (i, p) in soup.positions.iter().enumerate() {
        text.before_item(i, VERTEX_BYTES_MAX)?;
        text.point(i as u32, *p, encoding.name())?;
        if let Some(layout) = plan.vertex_colors {
            text.color(vertex_color(soup, i), layout);
        }
        text.word("\n");
    }
    let mut corner_count = 0;
    for (t, corners) in soup.faces() {
        text.integer(corners.len() as i64);
        for &v in corners {
            text.before_item(corner_count, CORNER_BYTES_MAX)?;
            corner_count += 1;
            text.word(" ");
            text.integer(i64::from(v));
        }
        if let Some(layout) = plan.face_colors {
            text.color(face_color(soup, t as usize), layout);
        }
        if plan.has_color_index {
            text.word(" ");
            text.integer(i64::from(color_index(soup, t as usize)));
        }
        text.word("\n");
    }
    Ok(text.into_bytes())
}

fn binary<const BIG: bool>(
    soup: &Soup,
    plan: &PropertyTypes,
    encoding: Encoding,
    budget: &Budget,
) -> Result<Vec<u8>, WriteError> {
    let header = plan.header(soup, encoding);
    let vertex_bytes = if plan.is_float32 { 12 } else { 24 } + color_bytes(plan.vertex_colors);
    let face_bytes = if plan.is_byte_size { 1 } else { 4 }
        + color_bytes(plan.face_colors)
        + if plan.has_color_index { 4 } else { 0 };
    let faces_bytes = face_bytes * plan.faces + 4 * plan.corners;
    let length = header.len() + vertex_bytes * soup.positions.len() + faces_bytes;
    let (mut out, _charged) = budget.vec::<u8>(length)?;
    out.extend_from_slice(header.as_bytes());
    for (i, p) in soup.positions.iter().enumerate() {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        for value in p.to_array() {
            if !value.is_finite() {
                let encoding = encoding.name();
                return Err(WriteError::NotRepresentable { vertex: i as u32, value, encoding });
            }
            if plan.is_float32 {
                put::<BIG, 4>(&mut out, (value as f32).to_le_bytes());
            } else {
                put::<BIG, 8>(&mut out, value.to_le_bytes());
            }
        }
        put_color::<BIG>(&mut out, plan.vertex_colors, || vertex_color(soup, i));
    }
    for (t, corners) in soup.faces() {
        if t.is_multiple_of(CHECK_EVERY as u32) {
            budget.check()?;
        }
        match plan.is_byte_size {
            true => out.push(corners.len() as u8),
            false => put::<BIG, 4>(&mut out, (corners.len() as u32).to_le_bytes()),
        }
        for v in corners {
            put::<BIG, 4>(&mut out, v.to_le_bytes());
        }
        put_color::<BIG>(&mut out, plan.face_colors, || face_color(soup, t as usize));
        if plan.has_color_index {
            put::<BIG, 4>(&mut out, color_index(soup, t as usize).to_le_bytes());
        }
    }
    Ok(out)
}

fn color_bytes(layout: Option<ColorLayout>) -> usize {
    layout.map_or(0, |layout| layout.channels() * if layout.is_bytes { 1 } else { 4 })
}

fn put_color<const BIG: bool>(
    out: &mut Vec<u8>,
    layout: Option<ColorLayout>,
    color: impl FnOnce() -> Option<Color>,
) {
    match layout {
        None => {}
        Some(layout) if layout.is_bytes => out.extend_from_slice(&as_bytes(color())[..layout.channels()]),
        Some(layout) => {
            for channel in &as_floats(color())[..layout.channels()] {
                put::<BIG, 4>(out, channel.to_le_bytes());
            }
        }
    }
}

/// Appends a value that is given with the least significant byte first.
fn put<const BIG: bool, const N: usize>(out: &mut Vec<u8>, mut bytes: [u8; N]) {
    if BIG {
        bytes.reverse();
    }
    out.extend_from_slice(&bytes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn soup(x: f64) -> Soup {
        Soup {
            positions: vec![DVec3::ZERO, DVec3::X * x, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            face_count: 1,
            ..Soup::default()
        }
    }

    fn header_of(bytes: &[u8]) -> String {
        let text = String::from_utf8_lossy(bytes);
        text[..text.find("end_header\n").unwrap()].to_owned()
    }

    #[test]
    fn coordinates_are_float_only_if_that_is_exact() {
        let bytes = |x| write(&soup(x), Encoding::PlyBinaryLittleEndian, &Budget::unlimited()).unwrap();
        assert!(header_of(&bytes(0.5)).contains("property float x\n"));
        assert!(header_of(&bytes(0.1)).contains("property double x\n"));
        assert_eq!(bytes(0.1).len() - bytes(0.5).len(), 36 + 3);
    }

    #[test]
    fn text_has_colours_after_what_they_belong_to() {
        let mut soup = soup(0.1);
        soup.vertex_colors =
            vec![Some(Color::Bytes([1, 2, 3], None)), None, Some(Color::Bytes([4, 5, 6], None))];
        soup.face_colors = vec![Some(Color::Floats([1.0, 0.5, 0.0], Some(0.25)))];
        let bytes = write(&soup, Encoding::PlyAscii, &Budget::unlimited()).unwrap();
        let header = header_of(&bytes);
        assert!(header.contains("property uchar blue\nelement face 1\n"), "{header}");
        assert!(header.ends_with("property float alpha\n"), "{header}");
        let body = String::from_utf8_lossy(&bytes)[header.len() + "end_header\n".len()..].to_owned();
        assert_eq!(body, "0 0 0 1 2 3\n0.1 0 0 255 255 255\n0 1 0 4 5 6\n3 0 1 2 1.0 0.5 0.0 0.25\n");
    }

    #[test]
    fn face_colours_that_are_numbers_come_back_beside_others() {
        let bytes = Color::Bytes([1, 2, 3], None);
        for colors in
            [[Some(Color::Index(7)), None, Some(Color::Index(0))], [Some(Color::Index(7)), Some(bytes), None]]
        {
            let soup = Soup {
                triangles: vec![[0, 1, 2]; 3],
                face_count: 3,
                face_colors: colors.to_vec(),
                ..soup(0.1)
            };
            for encoding in
                [Encoding::PlyAscii, Encoding::PlyBinaryLittleEndian, Encoding::PlyBinaryBigEndian]
            {
                let written = write(&soup, encoding, &Budget::unlimited()).unwrap();
                let options = crate::formats::ReadOptions::default();
                let read = crate::formats::read(&written, encoding, &options, &Budget::unlimited()).unwrap();
                // Beside colours with channels what has none is white.
                let white = colors.contains(&Some(bytes)).then_some(Color::Bytes([255; 3], None));
                assert_eq!(read.face_colors, colors.map(|color| color.or(white)), "{encoding:?}");
            }
        }
    }

    #[test]
    fn polygons_are_written_as_such_and_read_back_whatever_their_size() {
        for size in [5, 255, 256] {
            let at = |i: u32| {
                let (y, x) = libm::sincos(f64::from(i) / f64::from(size) * 6.0);
                DVec3::new(x, y, 0.0)
            };
            let mut text: String = (0..size).map(at).map(|p| format!("v {} {} 0\n", p.x, p.y)).collect();
            let all: Vec<String> = (1..=size).map(|i| i.to_string()).collect();
            text.push_str(&format!("f 3 2 1\nf {}\nf 1 2 3\n", all.join(" ")));
            let budget = Budget::unlimited();
            let read = |bytes: &[u8], encoding| {
                crate::formats::read(bytes, encoding, &crate::formats::ReadOptions::default(), &budget)
                    .unwrap()
            };
            let soup = read(text.as_bytes(), Encoding::Obj);
            for encoding in
                [Encoding::PlyAscii, Encoding::PlyBinaryLittleEndian, Encoding::PlyBinaryBigEndian]
            {
                let bytes = write(&soup, encoding, &budget).unwrap();
                assert_eq!(header_of(&bytes).contains("list uchar"), size < 256);
                let back = read(&bytes, encoding);
                assert_eq!((&back.positions, &back.triangles), (&soup.positions, &soup.triangles));
                assert_eq!(back.polygons, soup.polygons, "{size} corners");
            }
        }
    }

    #[test]
    fn nan_cannot_be_written() {
        for encoding in [Encoding::PlyAscii, Encoding::PlyBinaryBigEndian] {
            assert!(write(&soup(f64::NAN), encoding, &Budget::unlimited()).is_err());
        }
    }
}
