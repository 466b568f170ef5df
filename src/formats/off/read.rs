//! OFF text input.

use super::header::HeaderWord;
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::colors::note_color;
use crate::formats::faces::Faces;
use crate::formats::numbers::{coordinate, index, integer};
use crate::formats::words::{Dialect, Words};
use crate::formats::{BYTES_BEHIND, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, Places, Soup};

const DIALECT: Dialect = Dialect { comments: true, continued_lines: false };

/// Reads vertices and faces, with the colours that the header announces for vertices and that may follow any face.
/// Normals, texture coordinates and the number of edges are ignored.
///
/// What one vertex or face needs may go over several lines; each begins on a new line. Colours of all vertices (or of
/// all faces) are taken as bytes if every number of them is an integer up to 255, otherwise as floats.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let mut words = Words::new(bytes, 1, DIALECT);
    let Announced { header, vertices, faces } = Announced::read(&mut words)?;
    options.limits.check_vertices(vertices)?;
    options.limits.check_triangles(faces)?;
    let (positions, vertex_lines, vertex_colors) =
        read_vertices(&mut words, vertices, header, options, budget)?;
    let (faces, face_lines, face_colors) = read_faces(&mut words, faces, options, budget)?;
    let soup = faces.into_soup(positions, &options.limits, budget)?;
    let places = Places { face_lines, vertex_lines };
    let left_out = Some((BYTES_BEHIND, words.behind())).filter(|&(_, bytes)| bytes > 0);
    Ok(Soup {
        places,
        vertex_colors: vertex_colors.finish(),
        face_colors: face_colors.finish(),
        left_out: left_out.into_iter().collect(),
        ..soup
    })
}

/// What stands before the vertices.
struct Announced<'a> {
    header: Option<HeaderWord<'a>>,
    vertices: u64,
    faces: u64,
}

impl<'a> Announced<'a> {
    /// Reads the header word, which may be missing if both counts stand on the first line, and the counts.
    fn read(words: &mut Words<'a>) -> Result<Self, ReadError> {
        let mut first = words.next_word();
        let header = first.and_then(HeaderWord::parse);
        if header.is_some_and(|header| header.has_other_dimension) {
            return Err(words.wrong(first, "OFF with three coordinates for each vertex"));
        }
        if let Some(header) = header {
            first = if header.glued.is_empty() { words.next_word() } else { Some(header.glued) };
        }
        let vertices = count(words, first, "the number of vertices")?;
        let second = if header.is_some() { words.next_word() } else { words.next_in_line() };
        let faces = count(words, second, "the number of faces")?;
        words.next_line();
        Ok(Self { header, vertices, faces })
    }
}

fn count(words: &Words<'_>, word: Option<&[u8]>, expected: &str) -> Result<u64, ReadError> {
    let number = word.and_then(integer).and_then(|number| u64::try_from(number).ok());
    number.ok_or_else(|| words.wrong(word, expected))
}

fn read_vertices<'a>(
    words: &mut Words<'a>,
    count: u64,
    header: Option<HeaderWord<'_>>,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<(Vec<DVec3>, Vec<u32>, ColorList), ReadError> {
    let capacity = capacity(count, words);
    let (mut positions, _charged) = budget.vec::<DVec3>(capacity)?;
    let (mut lines, _charged) = budget.vec::<u32>(capacity)?;
    let mut colors = ColorList::default();
    let mut extras: Vec<&'a [u8]> = Vec::new();
    for i in 0..count {
        if i.is_multiple_of(CHECK_EVERY as u64) {
            budget.check()?;
        }
        let mut xyz = [0.0; 3];
        for (k, c) in xyz.iter_mut().enumerate() {
            let word = words.next_word();
            if k == 0 {
                lines.push(words.line() as u32);
            }
            *c = word
                .and_then(|word| coordinate(word, options.precision))
                .ok_or_else(|| words.wrong(word, &format!("a coordinate of vertex {i} of {count}")))?;
        }
        positions.push(DVec3::from(xyz));
        if let Some(header) = header.filter(|header| header.has_colors) {
            take_rest(words, &mut extras);
            let normal = if header.has_normals { 3 } else { 0 };
            let texture = if header.has_texture { 2 } else { 0 };
            let end = extras.len().saturating_sub(texture);
            colors.push(extras.get(normal..end).unwrap_or_default());
        }
        words.next_line();
    }
    Ok((positions, lines, colors))
}

fn read_faces<'a>(
    words: &mut Words<'a>,
    count: u64,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<(Faces, Vec<u32>, ColorList), ReadError> {
    let capacity = capacity(count, words);
    let (mut lines, _charged) = budget.vec::<u32>(capacity)?;
    let mut faces = Faces::default();
    let _charged = faces.reserve(capacity, budget)?;
    let mut charges = Vec::new();
    let mut colors = ColorList::default();
    let mut corners = Vec::new();
    let mut extras: Vec<&'a [u8]> = Vec::new();
    for i in 0..count {
        if i.is_multiple_of(CHECK_EVERY as u64) {
            budget.check()?;
        }
        let word = words.next_word();
        lines.push(words.line() as u32);
        let size = self::count(words, word, &format!("the number of corners of face {i} of {count}"))?;
        options.limits.check_polygon(size, words.place())?;
        corners.clear();
        for _ in 0..size {
            let word = words.next_word();
            let id = word.and_then(integer).ok_or_else(|| words.wrong(word, "a vertex index"))?;
            corners.push(index(id));
        }
        faces.push(&corners);
        if faces.is_due() {
            charges.push(faces.settle(&options.limits, budget)?);
        }
        take_rest(words, &mut extras);
        colors.push(&extras);
        words.next_line();
    }
    Ok((faces, lines, colors))
}

/// Room for `count` vertices or faces, as far as the rest of the file can hold them: none takes less than six bytes,
/// except faces without corners.
fn capacity(count: u64, words: &Words<'_>) -> usize {
    const ITEM_BYTES_MIN: usize = 6;
    count.min((words.remaining().len() / ITEM_BYTES_MIN + 1) as u64) as usize
}

fn take_rest<'a>(words: &mut Words<'a>, rest: &mut Vec<&'a [u8]>) {
    /// More than a normal, a colour and texture coordinates have.
    const WORDS_MAX: usize = 10;
    rest.clear();
    while let Some(word) = words.next_in_line().filter(|_| rest.len() < WORDS_MAX) {
        rest.push(word);
    }
}

/// Colours of vertices or faces whose kind is known only at the end.
struct ColorList {
    /// Channels as they stand in the file, whatever they are.
    colors: Vec<Option<Color>>,
    are_bytes: bool,
    len: usize,
}

impl Default for ColorList {
    fn default() -> Self {
        Self { colors: Vec::new(), are_bytes: true, len: 0 }
    }
}

impl ColorList {
    /// Adds the colour of the next element: three or four channels, an index, or nothing that is a colour.
    fn push(&mut self, words: &[&[u8]]) {
        let channel = |k: usize| fast_float2::parse::<f32, _>(words[k]).ok();
        let color = match words.len() {
            1 => integer(words[0]).map(|id| Color::Index(id.clamp(i32::MIN.into(), i32::MAX.into()) as i32)),
            3 | 4 => (|| {
                let rgb = [channel(0)?, channel(1)?, channel(2)?];
                let alpha = if words.len() == 4 { Some(channel(3)?) } else { None };
                Some(Color::Floats(rgb, alpha))
            })(),
            _ => None,
        };
        if matches!(color, Some(Color::Floats(..))) {
            let is_byte = |word: &&[u8]| integer(word).is_some_and(|id| (0..=255).contains(&id));
            self.are_bytes &= words.iter().all(is_byte);
        }
        note_color(&mut self.colors, self.len, color);
        self.len += 1;
    }

    fn finish(mut self) -> Vec<Option<Color>> {
        if self.are_bytes {
            for color in self.colors.iter_mut().flatten() {
                if let Color::Floats(rgb, alpha) = *color {
                    *color = Color::Bytes(rgb.map(|c| c as u8), alpha.map(|a| a as u8));
                }
            }
        }
        self.colors
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::FaceFaultReason;

    fn read(text: &str) -> Result<Soup, ReadError> {
        super::read(text.as_bytes(), &ReadOptions::default(), &Budget::unlimited())
    }

    fn error(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    const BODY: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

    #[test]
    fn every_form_of_header_and_counts_is_read() {
        for header in [
            "OFF\n4 2 5\n",
            "OFF\n4 2\n",
            "OFF 4 2 5\n",
            "OFF4 2 5\n",
            "off\r\n4 2 0\r\n",
            "# c\n\nOFF # d\n# e\n\n4 2 5 # f\n#g\n\n",
            "4 2 5\n",
        ] {
            let soup = read(&format!("{header}{BODY}")).unwrap();
            assert_eq!(soup.triangles, [[0, 1, 2], [0, 2, 3]], "{header}");
            assert!(soup.vertex_colors.is_empty() && soup.face_colors.is_empty());
        }
    }

    #[test]
    fn what_stands_behind_the_announced_faces_is_counted() {
        let left_out = |text: &str| read(text).unwrap().left_out;
        assert_eq!(left_out(&format!("OFF 4 1\n{BODY}")), [(BYTES_BEHIND, 8)]);
        for rest in ["", "\n", " # a comment\n\n"] {
            assert_eq!(left_out(&format!("OFF 4 2\n{BODY}{rest}")), [], "{rest}");
        }
    }

    #[test]
    fn other_dimensions_are_refused_clearly() {
        for word in ["4OFF", "nOFF", "C4nOFF"] {
            let text = format!("{word}\n1 0 0\n0 0 0 0\n");
            let expected =
                format!("line 1: found \"{word}\"; expected OFF with three coordinates for each vertex");
            assert_eq!(error(&text), expected);
        }
    }

    #[test]
    fn each_vertex_has_what_the_header_announces() {
        let rgb = |r, g, b| Some(Color::Bytes([r, g, b], None));
        let soup = read("COFF\n2 0\n0 0 0 255 0 7\n1 0 0\n").unwrap();
        assert_eq!(soup.vertex_colors, [rgb(255, 0, 7), None]);
        let soup = read("CNOFF\n1 0\n0 0 0 0 0 1 9 8 7\n").unwrap();
        assert_eq!(soup.vertex_colors, [rgb(9, 8, 7)]);
        let soup = read("STCNOFF\n1 0\n0 0 0 0 0 1 9 8 7 0.5 0.5\n").unwrap();
        assert_eq!(soup.vertex_colors, [rgb(9, 8, 7)]);
        let soup = read("COFF\n2 0\n0 0 0 1 0 1 1\n1 0 0 0 0.5 0 1\n").unwrap();
        assert_eq!(soup.vertex_colors[0], Some(Color::Floats([1.0, 0.0, 1.0], Some(1.0))));
        assert!(read("NOFF\n1 0\n0 0 0 0 0 1\n").unwrap().vertex_colors.is_empty());
    }

    #[test]
    fn a_face_may_have_a_colour_of_one_three_or_four_numbers() {
        let body = BODY.replace("3 0 1 2", "3 0 1 2 7").replace("3 0 2 3", "3 0 2 3 1 2 3 255 # c");
        let soup = read(&format!("OFF 4 2\n{body}")).unwrap();
        assert_eq!(soup.face_colors, [Some(Color::Index(7)), Some(Color::Bytes([1, 2, 3], Some(255)))]);
        let body = BODY.replace("3 0 2 3", "3 0 2 3 1 0.5 256");
        let soup = read(&format!("OFF 4 2\n{body}")).unwrap();
        assert_eq!(soup.face_colors, [None, Some(Color::Floats([1.0, 0.5, 256.0], None))]);
    }

    #[test]
    fn a_vertex_or_face_may_go_over_several_lines_and_lines_are_known() {
        let soup = read("OFF\n3 1 0\n0 0\n0\n\n1 0 0\n0 1 0\n3\n0 1\n2\n").unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2]]);
        assert_eq!((soup.places.vertex_lines, soup.places.face_lines), (vec![3, 6, 7], vec![8]));
    }

    #[test]
    fn polygons_and_bad_indices_are_kept_apart() {
        let soup = read("OFF\n4 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 4\n3 -1 0 1\n").unwrap();
        assert_eq!((soup.triangles.len(), &soup.polygons.faces[..]), (2, &[0][..]));
        assert!(soup.face_faults.iter().all(|f| f.reason == FaceFaultReason::IndexOutOfRange));
        assert_eq!(soup.face_faults.len(), 2);
    }

    #[test]
    fn what_is_missing_or_wrong_is_named_with_its_line() {
        assert_eq!(
            error("OFF\n2 0 0\n0 0 0\n1 0"),
            "line 4: the file ends here; expected a coordinate of vertex 1 of 2"
        );
        assert_eq!(
            error("OFF\n1 1\n0 0 0\nx 0"),
            "line 4: found \"x\"; expected the number of corners of face 0 of 1"
        );
        assert_eq!(error("OFF\n-1 1\n"), "line 2: found \"-1\"; expected the number of vertices");
        assert_eq!(error("8\n6\n"), "line 1: found the end of the line; expected the number of faces");
        assert!(error("OFF\n4294967295 4294967295 0\n").contains("vertices_max"));
        assert!(
            error("OFF\n1 1 0\n0 0 0\n4294967295 0").contains("line 4: 4294967295 corners of one polygon")
        );
        assert!(error("OFF\n200000000 1 0\n0 0 0\n").contains("vertex 1 of 200000000"));
    }
}
