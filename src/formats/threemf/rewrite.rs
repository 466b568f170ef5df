//! A 3MF with new meshes in the places of some: everything else keeps its bytes.

use super::model::{FaceAttributes, NO_NUMBER, Property};
use super::new_members::{Between, NewMembers};
use super::package::Package;
use super::read::{Body, Project};
use super::read_volumes::{VOLUMES, by_object};
use super::write::{add_entry, not_packed, triangle, vertices};
use super::xml::{Document, RawAttributes};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::formats::decimals::Text;
use crate::formats::{ReadError, WriteError};
use crate::mesh::Soup;
use rustc_hash::FxHashMap;
use std::io::Cursor;
use std::ops::Range;
use std::sync::Arc;
use zip::ZipWriter;

/// The usual level: what is written here is what is sent.
const LEVEL: i64 = 6;

/// What a triangle takes over of a face of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceSource {
    /// Nothing.
    Nothing,
    /// Everything: it is this face, perhaps turned or turned around.
    Whole {
        /// The face.
        face: u32,
        /// The corner of the face at each of its corners.
        corners: [u8; 3],
    },
    /// What is there at one corner of this face, of which it is a part, or beside which it is new. The face has the same at
    /// all corners.
    Corner {
        /// The face.
        face: u32,
        /// The corner.
        corner: u8,
    },
    /// What is between corners of faces, at each of its own.
    Between {
        /// The face behind it, whose attributes it has otherwise.
        face: u32,
        /// Number in the list of [`NewBody::between`].
        number: u32,
    },
}

/// A mesh in the place of another.
#[derive(Debug, Clone)]
pub struct NewBody<'a> {
    /// Number of the body in its project.
    pub body: usize,
    /// Its triangles, which are all finite.
    pub soup: &'a Soup,
    /// For each triangle what it takes over.
    pub sources: &'a [FaceSource],
    /// What corners have that is between those of faces.
    pub between: &'a [Between],
}

/// Why there is no new file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RewriteError {
    /// The old one cannot be read any more.
    #[error("{0}")]
    Unreadable(ReadError),
    /// The new one cannot be written.
    #[error("{0}")]
    Unwritable(#[from] WriteError),
}

impl From<ReadError> for RewriteError {
    fn from(error: ReadError) -> Self {
        Self::Unreadable(error)
    }
}

impl From<Stopped> for RewriteError {
    fn from(stopped: Stopped) -> Self {
        Self::Unwritable(stopped.into())
    }
}

/// The package `bytes`, which holds `project`, with `new` meshes. All other entries keep their packed bytes.
///
/// # Errors
/// A coordinate that is not finite, a stopped budget.
pub fn rewrite_project<'a>(
    bytes: &[u8],
    project: &'a Project,
    new: &[NewBody<'a>],
    budget: &Budget,
) -> Result<Vec<u8>, RewriteError> {
    let mut package = Package::open(bytes, budget)?;
    let mut by_part: FxHashMap<String, Vec<&NewBody<'a>>> = FxHashMap::default();
    for new in new {
        by_part.entry(project.bodies[new.body].part.to_ascii_lowercase()).or_default().push(new);
    }
    let mut texts: FxHashMap<usize, Vec<u8>> = FxHashMap::default();
    let mut charges = Vec::new();
    for number in 0..package.names().len() {
        let part = package.names()[number].clone();
        let of_part = by_part.get(&part.to_ascii_lowercase()).map_or(&[][..], Vec::as_slice);
        let is_of_volumes = part.eq_ignore_ascii_case(VOLUMES) && !project.volumes.is_empty();
        if (of_part.is_empty() && !is_of_volumes) || package.find(&part) != Some(number) {
            continue;
        }
        let (old, charge) = package.inflate(number, budget)?;
        let text = match is_of_volumes {
            true => renumbered(&old, project, &new.iter().collect::<Vec<_>>())?,
            false => rewritten(&part, &old, project, of_part, budget)?,
        };
        charges.push(budget.charge(text.len() as u64)?);
        drop(charge);
        texts.insert(number, text);
    }
    let mut old = package.into_archive();
    let mut archive = ZipWriter::new(Cursor::new(Vec::with_capacity(bytes.len())));
    for number in 0..old.len() {
        budget.check()?;
        let entry = old.by_index_raw(number).map_err(|error| not_packed(&error))?;
        match texts.get(&number) {
            None => archive.raw_copy_file(entry).map_err(|error| not_packed(&error))?,
            Some(text) => {
                let name = entry.name().map_err(|error| not_packed(&error))?.into_owned();
                drop(entry);
                add_entry(&mut archive, &name, text, LEVEL, budget)?;
            }
        }
    }
    Ok(archive.finish().map_err(|error| not_packed(&error))?.into_inner())
}

/// The text of a part with new meshes in it.
fn rewritten<'a>(
    part: &str,
    old: &[u8],
    project: &'a Project,
    new: &[&NewBody<'a>],
    budget: &Budget,
) -> Result<Vec<u8>, RewriteError> {
    let document = Document::of(part, old)?;
    let mut edits = Vec::new();
    let mut objects = objects(project, new);
    if let Some(object) = objects.first() {
        let groups = Arc::clone(&object.pieces[0].body.groups);
        let mut new_members = NewMembers::of(&groups);
        for piece in objects.iter_mut().flat_map(|object| &mut object.pieces) {
            piece.find_members(&mut new_members, budget)?;
        }
        let new = new_members.edits(document.text, budget)?;
        edits = new.into_iter().map(|(at, text)| (at..at, text)).collect();
    }
    for object in objects {
        let body = object.pieces[0].body;
        let [vertices_at, triangles_at] = body.spans.clone();
        let start = start_tag(document.text, &vertices_at);
        let mut text = Text::new(budget);
        text.word(&start.tag);
        for piece in &object.pieces {
            vertices(&mut text, piece.soup, start.prefix)?;
        }
        text.word(&start.end_tag);
        edits.push((vertices_at, text.into_bytes()));
        let start = start_tag(document.text, &triangles_at);
        // Pieces of one object have one list of texts, or none.
        let texts =
            object.pieces.iter().map(|piece| &piece.body.attributes.texts).find(|texts| !texts.is_empty());
        let longest = texts.into_iter().flat_map(|texts| texts.iter()).map(String::len).max().unwrap_or(0);
        let mut text = Text::new(budget);
        text.word(&start.tag);
        let mut first_vertex = 0;
        for piece in &object.pieces {
            triangles(&mut text, piece, first_vertex, start.prefix, longest)?;
            first_vertex += piece.soup.positions.len() as u32;
        }
        text.word(&start.end_tag);
        edits.push((triangles_at, text.into_bytes()));
        edits.extend(body.extra_spans.iter().map(|span| (span.clone(), Vec::new())));
    }
    Ok(edited(old, &document, edits))
}

/// The bytes of a part with some of its spans replaced.
fn edited(old: &[u8], document: &Document<'_>, mut edits: Vec<(Range<usize>, Vec<u8>)>) -> Vec<u8> {
    edits.sort_by_key(|(span, _)| span.start);
    let mark = old.len() - document.text.len();
    let mut text = old[..mark].to_vec();
    let mut at = 0;
    for (span, new) in edits {
        text.extend_from_slice(&document.text.as_bytes()[at..span.start]);
        text.extend_from_slice(&new);
        at = span.end;
    }
    text.extend_from_slice(&document.text.as_bytes()[at..]);
    text
}

/// The mesh of an object as it is written: one piece, or one for each of its volumes.
struct NewObject<'a> {
    pieces: Vec<VolumePiece<'a>>,
}

struct VolumePiece<'a> {
    body: &'a Body,
    soup: &'a Soup,
    /// `None`: its faces stay as they are.
    sources: Option<&'a [FaceSource]>,
    between: &'a [Between],
    /// The members at the corners that are between others, as in `between`.
    members: Vec<[u32; 3]>,
}

impl VolumePiece<'_> {
    /// Finds the members at corners that are between others, in the order of triangles.
    fn find_members<'g>(&mut self, members: &mut NewMembers<'g>, budget: &'g Budget) -> Result<(), Stopped> {
        self.members = vec![[NO_NUMBER; 3]; self.between.len()];
        for (t, source) in self.sources.into_iter().flatten().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let FaceSource::Between { face, number } = *source else { continue };
            if let Some(between) = self.between.get(number as usize) {
                self.members[number as usize] = members.at_corners(self.body, face, between);
                members.charge(budget)?;
            }
        }
        Ok(())
    }
}

/// The objects of which some volume is new.
fn objects<'a>(project: &'a Project, new: &[&NewBody<'a>]) -> Vec<NewObject<'a>> {
    let mut objects = Vec::new();
    let bodies = &project.bodies;
    let same = |a: &Body, b: &Body| a.part == b.part && a.object == b.object;
    let by_body: FxHashMap<usize, &NewBody<'a>> = new.iter().map(|&new| (new.body, new)).collect();
    let mut at = 0;
    while at < bodies.len() {
        let end = at + bodies[at..].iter().take_while(|body| same(body, &bodies[at])).count();
        let of = |i: usize| by_body.get(&i);
        if (at..end).any(|i| of(i).is_some()) {
            let piece = |i: usize| match of(i) {
                Some(new) => VolumePiece {
                    body: &bodies[i],
                    soup: new.soup,
                    sources: Some(new.sources),
                    between: new.between,
                    members: Vec::new(),
                },
                None => VolumePiece {
                    body: &bodies[i],
                    soup: &bodies[i].soup,
                    sources: None,
                    between: &[],
                    members: Vec::new(),
                },
            };
            objects.push(NewObject { pieces: (at..end).map(piece).collect() });
        }
        at = end;
    }
    objects
}

/// The text of the part that notes volumes, with the ranges of `new` triangles.
fn renumbered(old: &[u8], project: &Project, new: &[&NewBody<'_>]) -> Result<Vec<u8>, RewriteError> {
    let document = Document::of(VOLUMES, old)?;
    let by_object = by_object(&project.volumes);
    let mut edits = Vec::new();
    for object in objects(project, new) {
        let of_object = by_object.get(&object.pieces[0].body.object).map_or(&[][..], Vec::as_slice);
        if of_object.len() != object.pieces.len() || object.pieces[0].body.part != project.root {
            continue;
        }
        let mut first = 0;
        for (volume, piece) in of_object.iter().zip(&object.pieces) {
            let end = first + piece.soup.triangles.len();
            let tag = &document.text[volume.tag.clone()];
            let (inside, close) = match tag.strip_suffix("/>") {
                Some(inside) => (inside, "/>"),
                None => (tag.trim_end_matches('>'), ">"),
            };
            let name_length = inside.find(|c: char| c.is_ascii_whitespace()).unwrap_or(inside.len());
            let mut text = inside[..name_length].to_owned();
            for (key, value) in RawAttributes::of(&inside[name_length..]).flatten() {
                let quote = if value.contains('"') { '\'' } else { '"' };
                let number = match key {
                    "firstid" => Some(first),
                    "lastid" => Some(end.saturating_sub(1)),
                    _ => None,
                };
                let value = number.map_or(value.to_owned(), |number| number.to_string());
                text += &format!(" {key}={quote}{value}{quote}");
            }
            text += close;
            edits.push((volume.tag.clone(), text.into_bytes()));
            first = end;
        }
    }
    Ok(edited(old, &document, edits))
}

/// How the list in a span of a text begins and ends.
struct StartTag<'x> {
    /// Prefix of its names, with the colon.
    prefix: &'x str,
    tag: String,
    end_tag: String,
}

fn start_tag<'x>(text: &'x str, span: &Range<usize>) -> StartTag<'x> {
    let element = &text[span.clone()];
    let end = memchr::memchr(b'>', element.as_bytes()).unwrap_or(element.len().saturating_sub(1));
    let inside = element[1..end].trim_end_matches('/');
    let name = inside.split(|c: char| c.is_ascii_whitespace()).next().unwrap_or_default();
    let prefix = name.find(':').map_or("", |colon| &name[..=colon]);
    StartTag { prefix, tag: format!("<{inside}>\n"), end_tag: format!("</{name}>") }
}

/// Writes the triangles of a piece; `longest`: bytes of the longest text of other attributes.
fn triangles(
    text: &mut Text<'_>,
    piece: &VolumePiece<'_>,
    first_vertex: u32,
    prefix: &str,
    longest: usize,
) -> Result<(), WriteError> {
    let (attributes, old) = (&piece.body.attributes, &piece.body.soup);
    for (t, &corners) in piece.soup.triangles.iter().enumerate() {
        // A tag takes so many bytes without other attributes.
        text.before_item(t, 170 + longest)?;
        let source = match piece.sources {
            Some(sources) => sources.get(t).copied().unwrap_or(FaceSource::Nothing),
            None => FaceSource::Whole { face: old.face_of(t as u32), corners: [0, 1, 2] },
        };
        let (corners, source) = turned(corners, source);
        triangle(text, prefix, corners.map(|v| first_vertex + v));
        let face = match source {
            FaceSource::Nothing => {
                text.word("/>\n");
                continue;
            }
            FaceSource::Whole { face, .. }
            | FaceSource::Corner { face, .. }
            | FaceSource::Between { face, .. } => face as usize,
        };
        if let Some(&property) = attributes.properties.get(face) {
            write_property(text, property, source, &piece.members);
        }
        let number = attributes.others.get(face).copied().filter(|&number| number != NO_NUMBER);
        if let Some(other) = number.map(|number| &attributes.texts[number as usize]) {
            let is_same = matches!(source, FaceSource::Whole { corners: [0, 1, 2], .. });
            if is_same {
                text.word(" ");
                text.word(other);
            } else {
                for (key, value) in RawAttributes::of(other).flatten().filter(|&(k, v)| !is_of_corners(k, v))
                {
                    let quote = if value.contains('"') { "'" } else { "\"" };
                    for piece in [" ", key, "=", quote, value, quote] {
                        text.word(piece);
                    }
                }
            }
        }
        text.word("/>\n");
    }
    Ok(())
}

/// The same triangle from the corner that was the first of its face.
fn turned(corners: [u32; 3], source: FaceSource) -> ([u32; 3], FaceSource) {
    let FaceSource::Whole { face, corners: order } = source else { return (corners, source) };
    let first = order.iter().position(|&corner| corner == 0).unwrap_or(0);
    let turn = |k: usize| (first + k) % 3;
    let order = [0, 1, 2].map(|k| order[turn(k)]);
    ([0, 1, 2].map(|k| corners[turn(k)]), FaceSource::Whole { face, corners: order })
}

/// Writes the property of a triangle; `between`: members at the corners of those that are between others.
fn write_property(text: &mut Text<'_>, property: Property, source: FaceSource, between: &[[u32; 3]]) {
    let Property { group, members } = property;
    let at = |corner: u8| match members[usize::from(corner)] {
        NO_NUMBER => members[0],
        member => member,
    };
    let members = match source {
        FaceSource::Whole { corners, .. } => corners.map(at),
        FaceSource::Corner { corner, .. } => [at(corner); 3],
        FaceSource::Between { number, .. } => between[number as usize],
        FaceSource::Nothing => return,
    };
    let [first, second, third] = members;
    let mut put = |name: &str, number: u32| {
        if number != NO_NUMBER {
            text.word(name);
            text.integer(number.into());
            text.word("\"");
        }
    };
    put(" pid=\"", group);
    put(" p1=\"", first);
    if [second, third] != [first, first] {
        put(" p2=\"", second);
        put(" p3=\"", third);
    }
}

/// True when an attribute is the paint of a part of a triangle, which is stated from its first corner on: the tree of such a
/// paint begins at the end of the text, and the lower two bits of its first digit say how often it is divided.
fn is_of_corners(key: &str, value: &str) -> bool {
    let local = key.rsplit(':').next().unwrap_or(key);
    let is_paint = local.starts_with("paint_")
        || matches!(local, "mmu_segmentation" | "custom_supports" | "custom_seam" | "fuzzy_skin");
    let root = value.chars().last().and_then(|digit| digit.to_digit(16));
    is_paint && root.is_none_or(|digit| digit & 3 != 0)
}

impl FaceAttributes {
    /// True when the other attributes of this number hold paint that is stated by corners.
    pub fn is_divided(&self, number: u32) -> bool {
        RawAttributes::of(&self.texts[number as usize])
            .flatten()
            .any(|(key, value)| is_of_corners(key, value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_written_from_the_corner_that_was_its_first() {
        let whole = |corners| FaceSource::Whole { face: 7, corners };
        assert_eq!(turned([10, 11, 12], whole([2, 0, 1])), ([11, 12, 10], whole([0, 1, 2])));
        assert_eq!(turned([10, 11, 12], whole([1, 0, 2])), ([11, 12, 10], whole([0, 2, 1])));
    }

    #[test]
    fn paint_of_a_whole_triangle_belongs_to_no_corner() {
        for value in ["4", "8", "0C", "1C"] {
            assert!(!is_of_corners("paint_color", value), "{value}");
        }
        for value in ["4843", "", "x"] {
            assert!(is_of_corners("slic3rpe:mmu_segmentation", value), "{value}");
        }
        assert!(!is_of_corners("face_property", "3"));
    }
}
