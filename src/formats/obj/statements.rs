//! The statements of a part of an OBJ file that make its mesh.

use super::material_names::MaterialStatements;
use super::object_names::ObjectStatements;
use super::texture::{TextureStatements, read_texture_point, texture_index};
use crate::budget::Stopped;
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::colors::note_color;
use crate::formats::faces::Faces;
use crate::formats::numbers::{coordinate, index, integer};
use crate::formats::words::{Dialect, Words};
use crate::formats::{Precision, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, Segment};
use memchr::memchr;

/// How OBJ text is cut into words.
pub(super) const DIALECT: Dialect = Dialect { comments: true, continued_lines: true };

/// Lines, vertices and faces of a part of a file, or of all parts before one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct StatementCounts {
    pub(super) lines: u64,
    pub(super) vertices: u64,
    pub(super) faces: u64,
    pub(super) texture_points: u64,
    /// Words of `f` statements.
    pub(super) corners: u64,
    /// Words of `l` statements, of which segments have one fewer.
    pub(super) line_corners: u64,
    /// `usemtl` and `mtllib` statements.
    pub(super) materials: u64,
    /// `o` and `g` statements.
    pub(super) objects: u64,
}

impl StatementCounts {
    /// Counts what stands in `part`, which begins at the start of a line and ends with a line break or the file.
    pub(super) fn of(part: &[u8], budget: &Budget) -> Result<Self, Stopped> {
        let mut counts = Self::default();
        let mut words = Words::new(part, 0, DIALECT);
        let mut statements = 0usize;
        while let Some(keyword) = words.next_word() {
            match keyword {
                b"v" => counts.vertices += 1,
                b"f" => {
                    counts.faces += 1;
                    let line = words.remaining();
                    words.next_line();
                    counts.corners += words_in(&line[..line.len() - words.remaining().len()]);
                    statements += 1;
                    if statements.is_multiple_of(CHECK_EVERY) {
                        budget.check()?;
                    }
                    continue;
                }
                b"vt" => counts.texture_points += 1,
                b"usemtl" | b"mtllib" => counts.materials += 1,
                b"o" | b"g" => counts.objects += 1,
                b"l" => {
                    while words.next_in_line().is_some() {
                        counts.line_corners += 1;
                    }
                }
                _ => {}
            }
            words.next_line();
            statements += 1;
            if statements.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
        }
        counts.lines = words.line();
        Ok(counts)
    }

    /// Corners of polygons beyond those of triangles, about.
    pub(super) fn further_corners(self) -> u64 {
        self.corners.saturating_sub(3 * self.faces)
    }

    /// The counts of both.
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            lines: self.lines + other.lines,
            vertices: self.vertices + other.vertices,
            faces: self.faces + other.faces,
            corners: self.corners + other.corners,
            texture_points: self.texture_points + other.texture_points,
            line_corners: self.line_corners + other.line_corners,
            materials: self.materials + other.materials,
            objects: self.objects + other.objects,
        }
    }
}

/// Number of words in a line, joined lines included, without a comment.
fn words_in(line: &[u8]) -> u64 {
    let line = memchr(b'#', line).map_or(line, |comment| &line[..comment]);
    // A backslash that joins lines is no word.
    let begins = |pair: &[u8; 2]| pair[0] <= b' ' && pair[1] > b' ' && pair[1] != b'\\';
    line.array_windows().filter(|pair| begins(pair)).count() as u64
}

/// Vertices and faces of a part of a file.
#[derive(Debug, Default)]
pub(super) struct Statements<'a> {
    pub(super) positions: Vec<DVec3>,
    pub(super) vertex_lines: Vec<u32>,
    /// As long as `positions` from the first colour on; empty without one.
    pub(super) colors: Vec<Option<Color>>,
    pub(super) faces: Faces,
    pub(super) face_lines: Vec<u32>,
    pub(super) texture: TextureStatements,
    /// Of vertices that may be missing.
    pub(super) segments: Vec<Segment>,
    pub(super) materials: MaterialStatements<'a>,
    pub(super) objects: ObjectStatements<'a>,
}

impl<'a> Statements<'a> {
    /// Reads `part`, before which the file holds `before` and in which it holds `inside`; `has_texture`: somewhere in it
    /// are texture coordinates.
    pub(super) fn read(
        part: &'a [u8],
        before: StatementCounts,
        inside: StatementCounts,
        has_texture: bool,
        options: &ReadOptions,
        budget: &Budget,
    ) -> Result<Self, ReadError> {
        let (vertices, faces) = (inside.vertices as usize, inside.faces as usize);
        let mut read = Self {
            positions: Vec::with_capacity(vertices),
            vertex_lines: Vec::with_capacity(vertices),
            faces: Faces::of_triangles(Vec::with_capacity(faces)),
            face_lines: Vec::with_capacity(faces),
            segments: Vec::with_capacity(inside.line_corners as usize),
            ..Self::default()
        };
        let mut corners = Vec::new();
        let mut texture_corners = has_texture.then(Vec::new);
        let mut words = Words::new(part, before.lines + 1, DIALECT);
        let mut statements = 0usize;
        while let Some(keyword) = words.next_word() {
            let line = words.line() as u32;
            match keyword {
                b"v" => {
                    read.vertex_lines.push(line);
                    read.read_vertex(&mut words, options.precision)?;
                }
                b"f" => {
                    read.face_lines.push(line);
                    let vertices_before = before.vertices as i64 + read.positions.len() as i64;
                    let points_before = before.texture_points as i64 + read.texture.points.len() as i64;
                    if let Some(points) = &mut texture_corners {
                        points.clear();
                    }
                    let mut texture = texture_corners.as_mut().map(|list| (points_before, list));
                    read_corners(&mut words, vertices_before, options, &mut corners, &mut texture)?;
                    read.faces.push(&corners);
                    if let Some(points) = &texture_corners {
                        read.texture.faces.push(points);
                    }
                }
                b"l" => read.read_line(&mut words, before.vertices as i64 + read.positions.len() as i64),
                b"usemtl" => read.materials.use_from(read.faces.len() as u32, words.name_in_line()),
                b"o" => read.objects.object_from(read.faces.len() as u32, words.name_in_line()),
                b"g" => read.objects.group_from(read.faces.len() as u32, words.name_in_line()),
                b"mtllib" => read.materials.libraries.push(words.name_in_line()),
                b"vt" if has_texture => read.texture.points.push(read_texture_point(&mut words)),
                _ => {}
            }
            words.next_line();
            statements += 1;
            if statements.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
        }
        Ok(read)
    }

    /// The segments of `v1 v2 v3 ...`, each corner `v` or `v/vt`; a word that is no index ends one and begins none.
    fn read_line(&mut self, words: &mut Words<'_>, vertices_before: i64) {
        let line = Some(words.line() as u32);
        let mut last = None;
        while let Some(word) = words.next_in_line() {
            let end = word.iter().position(|&b| b == b'/').unwrap_or(word.len());
            let corner = integer(&word[..end]).map(|number| vertex_index(number, vertices_before));
            if let (Some(from), Some(to)) = (last, corner) {
                self.segments.push(Segment { ends: [from, to], line });
            }
            last = corner;
        }
    }

    /// `x y z`, `x y z w`, `x y z r g b` or `x y z r g b a`; the weight and anything else after z are ignored.
    fn read_vertex(&mut self, words: &mut Words<'_>, precision: Precision) -> Result<(), ReadError> {
        let mut xyz = [0.0; 3];
        for c in &mut xyz {
            let word = words.next_in_line();
            *c = word
                .and_then(|word| coordinate(word, precision))
                .ok_or_else(|| words.wrong(word, "a coordinate"))?;
        }
        self.positions.push(DVec3::from(xyz));
        note_color(&mut self.colors, self.positions.len() - 1, read_color(words));
        Ok(())
    }
}

/// The colour that stands after a position, if there is one.
fn read_color(words: &mut Words<'_>) -> Option<Color> {
    let mut channel = || words.next_in_line().and_then(|word| fast_float2::parse::<f32, _>(word).ok());
    let rgb = [channel()?, channel()?, channel()?];
    Some(Color::Floats(rgb, channel()))
}

/// The vertex that a number in the file means; 0 is nobody's and becomes one that is out of range.
fn vertex_index(number: i64, vertices_before: i64) -> u32 {
    index(if number < 0 { vertices_before + number } else { number - 1 })
}

/// The corners of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`, of which `v` matters, and `vt` for `texture`: the number of
/// texture points before the face, and the list for those of the corners. Negative numbers count back from the last
/// before the face.
fn read_corners(
    words: &mut Words<'_>,
    vertices_before: i64,
    options: &ReadOptions,
    corners: &mut Vec<u32>,
    texture: &mut Option<(i64, &mut Vec<u32>)>,
) -> Result<(), ReadError> {
    corners.clear();
    while let Some(word) = words.next_in_line() {
        let end = word.iter().position(|&b| b == b'/').unwrap_or(word.len());
        let number = integer(&word[..end]).ok_or_else(|| words.wrong(Some(word), "a vertex index"))?;
        corners.push(vertex_index(number, vertices_before));
        if let Some((points_before, points)) = texture {
            points.push(texture_index(word.get(end + 1..).unwrap_or_default(), *points_before));
        }
        if corners.len() as u64 > u64::from(options.limits.polygon_corners_max) {
            options.limits.check_polygon(corners.len() as u64, words.place())?;
        }
    }
    Ok(())
}
