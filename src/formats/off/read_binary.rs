//! Binary OFF input: the header line, then 32-bit integers and floats, most significant byte first.

use super::header::HeaderWord;
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::colors::note_color;
use crate::formats::cursor::Cursor;
use crate::formats::faces::Faces;
use crate::formats::numbers::index;
use crate::formats::words::{Dialect, Words};
use crate::formats::{BYTES_BEHIND, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, Soup};

/// Reads vertices and faces with their colours; normals and texture coordinates are ignored.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let mut words = Words::new(bytes, 1, Dialect { comments: true, continued_lines: false });
    let first = words.next_word();
    let header = first.and_then(HeaderWord::parse).filter(|header| !header.has_other_dimension);
    let header = header.ok_or_else(|| words.wrong(first, "OFF with three coordinates for each vertex"))?;
    let second = words.next_in_line();
    if second != Some(b"BINARY") || !words.next_line() {
        return Err(words.wrong(second, "BINARY and the end of the line"));
    }

    let mut cursor = Cursor::new(bytes, bytes.len() - words.remaining().len());
    let vertex_count = count(&mut cursor, "the number of vertices")?;
    let face_count = count(&mut cursor, "the number of faces")?;
    cursor.skip(4, "the number of edges")?;
    options.limits.check_vertices(vertex_count.into())?;
    options.limits.check_triangles(face_count.into())?;
    let (positions, vertex_colors) = read_vertices(&mut cursor, vertex_count, header, budget)?;
    let (faces, face_colors) = read_faces(&mut cursor, face_count, options, budget)?;
    let soup = faces.into_soup(positions, &options.limits, budget)?;
    let left_out = Some((BYTES_BEHIND, cursor.behind())).filter(|&(_, bytes)| bytes > 0);
    Ok(Soup { vertex_colors, face_colors, left_out: left_out.into_iter().collect(), ..soup })
}

fn read_vertices(
    cursor: &mut Cursor<'_>,
    count: u32,
    header: HeaderWord<'_>,
    budget: &Budget,
) -> Result<(Vec<DVec3>, Vec<Option<Color>>), ReadError> {
    let skipped = [(header.has_normals, 12), (header.has_texture, 8)];
    let bytes_after_position: usize = skipped.iter().filter(|s| s.0).map(|s| s.1).sum();
    let item_bytes = 12 + bytes_after_position + if header.has_colors { 16 } else { 0 };
    let fitting = (count as usize).min(cursor.remaining() / item_bytes);
    let (mut positions, _charged) = budget.vec::<DVec3>(fitting)?;
    let (mut colors, _charged) = budget.vec::<Option<Color>>(if header.has_colors { fitting } else { 0 })?;
    for i in 0..count as usize {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        positions.push(DVec3::from(floats::<3>(cursor, "a vertex")?.map(f64::from)));
        if header.has_normals {
            cursor.skip(12, "a normal")?;
        }
        if header.has_colors {
            let [r, g, b, a] = floats(cursor, "a colour")?;
            colors.push(Some(Color::Floats([r, g, b], Some(a))));
        }
        if header.has_texture {
            cursor.skip(8, "texture coordinates")?;
        }
    }
    Ok((positions, colors))
}

fn read_faces(
    cursor: &mut Cursor<'_>,
    count: u32,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<(Faces, Vec<Option<Color>>), ReadError> {
    /// The numbers of corners and of colour channels.
    const FACE_BYTES_MIN: usize = 8;
    let mut faces = Faces::default();
    let _charged = faces.reserve((count as usize).min(cursor.remaining() / FACE_BYTES_MIN), budget)?;
    let mut charges = Vec::new();
    let mut colors = Vec::new();
    let mut corners = Vec::new();
    for i in 0..count as usize {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let place = cursor.place();
        let size = self::count(cursor, "the number of corners of a face")?;
        options.limits.check_polygon(size.into(), place)?;
        corners.clear();
        for _ in 0..size {
            corners.push(index(i32::from_be_bytes(cursor.take("a vertex index")?).into()));
        }
        faces.push(&corners);
        if faces.is_due() {
            charges.push(faces.settle(&options.limits, budget)?);
        }
        note_color(&mut colors, i, read_color(cursor)?);
    }
    Ok((faces, colors))
}

/// The number of channels and the channels. One channel, an index into some map, is no colour here.
fn read_color(cursor: &mut Cursor<'_>) -> Result<Option<Color>, ReadError> {
    let place = cursor.place();
    match count(cursor, "the number of colour channels")? {
        0 => Ok(None),
        1 => cursor.skip(4, "a colour").map(|()| None),
        3 => Ok(Some(Color::Floats(floats(cursor, "a colour")?, None))),
        4 => {
            let [r, g, b, a] = floats(cursor, "a colour")?;
            Ok(Some(Color::Floats([r, g, b], Some(a))))
        }
        other => Err(ReadError::unparseable(place, other.to_string(), "0, 1, 3 or 4 colour channels")),
    }
}

fn count(cursor: &mut Cursor<'_>, expected: &str) -> Result<u32, ReadError> {
    Ok(u32::from_be_bytes(cursor.take(expected)?))
}

fn floats<const N: usize>(cursor: &mut Cursor<'_>, expected: &str) -> Result<[f32; N], ReadError> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = f32::from_be_bytes(cursor.take(expected)?);
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, numbers: &[&[u8]]) -> Vec<u8> {
        [header.as_bytes(), &numbers.concat()].concat()
    }

    fn ints(values: &[i32]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_be_bytes()).collect()
    }

    fn reals(values: &[f32]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_be_bytes()).collect()
    }

    fn read(bytes: &[u8]) -> Result<Soup, ReadError> {
        super::read(bytes, &ReadOptions::default(), &Budget::unlimited())
    }

    #[test]
    fn vertices_faces_and_colours_are_read_whatever_else_stands_with_them() {
        let vertex = |x: f32, y: f32| {
            reals(&[
                x, y, 0.1, /* normal */ 0.0, 0.0, 1.0, /* colour */ 1.0, 0.5, 0.0, 1.0,
                /* texture */ 9.0, 9.0,
            ])
        };
        let faces =
            [ints(&[3, 0, 1, 2, 0]), ints(&[3, 0, 1, 9, 3]), reals(&[0.5, 0.5, 1.0]), ints(&[2, 0, 1, 1, 7])];
        let parts = [ints(&[3, 3, 0]), vertex(0.0, 0.0), vertex(1.0, 0.0), vertex(0.0, 1.0), faces.concat()];
        let bytes = file("STCNOFF BINARY\n", &[&parts.concat()]);
        let soup = read(&bytes).unwrap();
        assert_eq!((soup.triangles.clone(), soup.face_faults.len()), (vec![[0, 1, 2]], 2));
        assert_eq!(soup.positions[1], DVec3::new(1.0, 0.0, f64::from(0.1f32)));
        assert_eq!(soup.vertex_colors, [Some(Color::Floats([1.0, 0.5, 0.0], Some(1.0))); 3]);
        assert_eq!(soup.face_colors, [None, Some(Color::Floats([0.5, 0.5, 1.0], None)), None]);
        for keep in 0..bytes.len() {
            assert!(read(&bytes[..keep]).is_err(), "{keep} bytes");
        }
    }

    #[test]
    fn absurd_counts_are_errors_without_allocation() {
        let too_many = file("OFF BINARY\n", &[&ints(&[-1, -1, -1])]);
        assert!(read(&too_many).unwrap_err().to_string().contains("vertices_max"));
        let too_few_bytes = file("OFF BINARY\n", &[&ints(&[100_000_000, 0, 0])]);
        assert!(
            read(&too_few_bytes).unwrap_err().to_string().contains("the file ends here; expected a vertex")
        );
        let polygon = file("OFF BINARY\n", &[&ints(&[0, 1, 0, 100_000])]);
        assert!(read(&polygon).unwrap_err().to_string().contains("polygon_corners_max"));
        let channels = file("OFF BINARY\n", &[&ints(&[0, 1, 0, 0, 2])]);
        assert_eq!(
            read(&channels).unwrap_err().to_string(),
            "byte 27: found 2; expected 0, 1, 3 or 4 colour channels"
        );
    }
}
