//! A 3MF of one mesh, made new.

use crate::budget::Budget;
use crate::formats::colors::as_bytes;
use crate::formats::decimals::Text;
use crate::formats::{Encoding, WriteError};
use crate::mesh::{Color, Soup, Units};
use rustc_hash::FxHashMap;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

const CONTENT_TYPES: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\
<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\
<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\
</Types>\n";
const RELATIONSHIPS: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" \
Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\
</Relationships>\n";
/// Id of the colour group and of the object.
const COLORS: &str = "1";
const OBJECT: &str = "2";
/// Most bytes of a vertex and of a triangle as text.
const VERTEX_BYTES_MAX: usize = 110;
const TRIANGLE_BYTES_MAX: usize = 110;
/// Packing is half of the time at the usual level, and a mesh that is tried and dropped is packed too.
const LEVEL: i64 = 1;

/// The triangles of `soup` as one object, with their colours or else those of their vertices; texture coordinates and
/// materials are left out. Millimetres unless the soup says otherwise.
pub(in crate::formats) fn write(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    let model = model(soup, budget)?;
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let entries = [
        ("[Content_Types].xml", CONTENT_TYPES.as_bytes()),
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", &model),
    ];
    for (name, content) in entries {
        add_entry(&mut archive, name, content, LEVEL, budget)?;
    }
    let bytes = archive.finish().map_err(|error| not_packed(&error))?.into_inner();
    Ok(bytes)
}

/// Adds a deflated entry, which carries no time.
pub(super) fn add_entry(
    archive: &mut ZipWriter<Cursor<Vec<u8>>>,
    name: &str,
    content: &[u8],
    level: i64,
    budget: &Budget,
) -> Result<(), WriteError> {
    const PIECE_BYTES: usize = 1 << 20;
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(level))
        .last_modified_time(DateTime::default())
        .large_file(content.len() as u64 >= u64::from(u32::MAX));
    archive.start_file(name, options).map_err(|error| not_packed(&error))?;
    for piece in content.chunks(PIECE_BYTES) {
        budget.check()?;
        archive.write_all(piece).map_err(|error| WriteError::Package { reason: error.to_string() })?;
    }
    Ok(())
}

pub(super) fn not_packed(error: &zip::result::ZipError) -> WriteError {
    WriteError::Package { reason: error.to_string() }
}

/// The colours of a mesh as members of a group.
#[derive(Default)]
struct ColorGroup {
    list: Vec<[u8; 4]>,
    numbers: FxHashMap<[u8; 4], u32>,
}

impl ColorGroup {
    fn number(&mut self, color: [u8; 4]) -> u32 {
        *self.numbers.entry(color).or_insert_with(|| {
            self.list.push(color);
            self.list.len() as u32 - 1
        })
    }
}

/// The members at the corners of each triangle, or `None` where it has no colour; empty when none has.
fn members(soup: &Soup, colors: &mut ColorGroup) -> Vec<Option<[u32; 3]>> {
    let is_color = |color: &Option<Color>| !matches!(color, None | Some(Color::Index(_)));
    let of_face = |t: usize| soup.face_colors.get(soup.face_of(t as u32) as usize).copied().flatten();
    if soup.face_colors.iter().any(is_color) {
        // What has no colour is white.
        colors.number([u8::MAX; 4]);
        let member = |t: usize| Some(of_face(t)).filter(is_color).map(|c| [colors.number(as_bytes(c)); 3]);
        return (0..soup.triangles.len()).map(member).collect();
    }
    if soup.vertex_colors.iter().any(is_color) {
        let white = colors.number([u8::MAX; 4]);
        let mut of_vertex = |v: u32| match soup.vertex_colors.get(v as usize).copied() {
            Some(color) if is_color(&color) => colors.number(as_bytes(color)),
            _ => white,
        };
        return soup.triangles.iter().map(|corners| Some(corners.map(&mut of_vertex))).collect();
    }
    Vec::new()
}

fn model(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    let mut colors = ColorGroup::default();
    let members = members(soup, &mut colors);
    let mut text = Text::new(budget);
    text.word("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"");
    text.word(unit(soup.units.unwrap_or_default()));
    text.word("\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"");
    if !members.is_empty() {
        text.word(" xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"");
    }
    text.word(">\n<resources>\n");
    let mut property = String::new();
    if !members.is_empty() {
        text.word(&format!("<m:colorgroup id=\"{COLORS}\">\n"));
        for (i, &[r, g, b, a]) in colors.list.iter().enumerate() {
            text.before_item(i, 40)?;
            text.word(&format!("<m:color color=\"#{r:02X}{g:02X}{b:02X}{a:02X}\"/>\n"));
        }
        text.word("</m:colorgroup>\n");
        property = format!(" pid=\"{COLORS}\" pindex=\"0\"");
    }
    text.word(&format!("<object id=\"{OBJECT}\" type=\"model\"{property}>\n<mesh>\n<vertices>\n"));
    vertices(&mut text, soup, "")?;
    text.word("</vertices>\n<triangles>\n");
    for (t, &corners) in soup.triangles.iter().enumerate() {
        text.before_item(t, TRIANGLE_BYTES_MAX)?;
        triangle(&mut text, "", corners);
        if let Some(&Some([a, b, c])) = members.get(t) {
            text.word(&format!(" pid=\"{COLORS}\" p1=\"{a}\""));
            if [b, c] != [a, a] {
                text.word(&format!(" p2=\"{b}\" p3=\"{c}\""));
            }
        }
        text.word("/>\n");
    }
    text.word("</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n");
    text.word(&format!("<item objectid=\"{OBJECT}\"/>\n</build>\n</model>\n"));
    Ok(text.into_bytes())
}

/// The vertices of `soup` as elements whose names have `prefix`.
pub(super) fn vertices(text: &mut Text<'_>, soup: &Soup, prefix: &str) -> Result<(), WriteError> {
    let encoding = Encoding::ThreeMf.name();
    for (v, p) in soup.positions.iter().enumerate() {
        text.before_item(v, VERTEX_BYTES_MAX)?;
        text.word("<");
        text.word(prefix);
        text.word("vertex");
        for (name, value) in [" x=\"", " y=\"", " z=\""].into_iter().zip(p.to_array()) {
            if !value.is_finite() {
                return Err(WriteError::NotRepresentable { vertex: v as u32, value, encoding });
            }
            text.word(name);
            text.coordinate(value);
            text.word("\"");
        }
        text.word("/>\n");
    }
    Ok(())
}

/// The beginning of a triangle.
pub(super) fn triangle(text: &mut Text<'_>, prefix: &str, corners: [u32; 3]) {
    text.word("<");
    text.word(prefix);
    text.word("triangle");
    for (name, v) in [" v1=\"", " v2=\"", " v3=\""].into_iter().zip(corners) {
        text.word(name);
        text.integer(v.into());
        text.word("\"");
    }
}

fn unit(units: Units) -> &'static str {
    match units {
        Units::Micrometre => "micron",
        Units::Millimetre => "millimeter",
        Units::Centimetre => "centimeter",
        Units::Metre => "meter",
        Units::Inch => "inch",
        Units::Foot => "foot",
    }
}
