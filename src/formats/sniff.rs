//! Which format some bytes are in, by their content.

use super::foreign::foreign;
use super::numbers::{coordinate, integer};
use super::off::header::HeaderWord;
use super::stl::read_binary::announced_length;
use super::words::{Dialect, Words};
use super::{Encoding, Format, Place, Precision, ReadError, ReadErrorKind};

/// Bytes at the start that are looked at where a format has no mark.
const LOOKED_AT_BYTES: usize = 4096;

/// Finds the encoding of `bytes` by content. `named` is the caller's word for the format, which wins where the
/// content leaves it open and is contradicted only by content that certainly is another format (then the error says so).
///
/// In this order: the letters `glTF`; the exact length of a binary STL, whatever its header says (in text the four bytes that count would
/// announce gigabytes); a JSON object with an `asset`; the word `ply`; the header word of OFF; `solid` followed by `facet` or `endsolid`; a binary STL with extra bytes at its end, fewer than its own; a statement of OBJ.
///
/// # Errors
/// Empty or unrecognisable bytes; content that contradicts `named`.
pub fn sniff(bytes: &[u8], named: Option<Format>) -> Result<Encoding, ReadError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ReadError::empty("a mesh in STL, OBJ, OFF, PLY, 3MF or glTF"));
    }
    match (certain(bytes), named) {
        (Some(found), Some(named)) if found.format() != named => {
            let expected = format!("{} as the request says", named.name());
            Err(ReadError::unparseable(Place::Whole, format!("{} content", found.name()), expected))
        }
        (Some(found), _) => Ok(found),
        (None, named) => match (foreign(bytes), named) {
            (Some(name), _) => Err(ReadError::foreign(name)),
            (None, Some(named)) => Ok(layout_of(bytes, named)),
            (None, None) => guess(bytes).ok_or_else(|| unknown(bytes)),
        },
    }
}

/// The encoding, if the content can hardly be anything else.
fn certain(bytes: &[u8]) -> Option<Encoding> {
    let first = first_word(bytes);
    if bytes.starts_with(b"glTF") {
        Some(Encoding::Glb)
    } else if announced_length(bytes) == Some(bytes.len() as u64) {
        Some(Encoding::StlBinary)
    } else if is_gltf_text(bytes) {
        Some(Encoding::Gltf)
    } else if is_package(bytes) {
        Some(Encoding::ThreeMf)
    } else if first.eq_ignore_ascii_case(b"ply") {
        Some(ply_layout(bytes))
    } else if HeaderWord::parse(first).is_some() {
        Some(off_layout(bytes))
    } else if first.eq_ignore_ascii_case(b"solid") && is_text(bytes) && has_word_of_stl(bytes) {
        Some(Encoding::StlAscii)
    } else {
        None
    }
}

/// A JSON object that has what every glTF document must have.
fn is_gltf_text(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    text.starts_with(b"{") && memchr::memmem::find(text, b"\"asset\"").is_some()
}

/// A zip archive with a part that may be the model of a 3MF. Their names stand in front of each entry and at the end.
fn is_package(bytes: &[u8]) -> bool {
    let names_model = |word: &[u8]| memchr::memmem::find(bytes, word).is_some();
    bytes.starts_with(b"PK\x03\x04") && (names_model(b".model") || names_model(b".MODEL"))
}

/// The layout of content that has no mark of `format` but shall be in it.
fn layout_of(bytes: &[u8], format: Format) -> Encoding {
    match format {
        Format::Stl if is_text(bytes) || is_damaged_text(bytes) => Encoding::StlAscii,
        Format::Stl => Encoding::StlBinary,
        Format::Ply => Encoding::PlyAscii,
        Format::Off => Encoding::Off,
        Format::Obj => Encoding::Obj,
        Format::Glb => Encoding::Glb,
        Format::Gltf => Encoding::Gltf,
        Format::ThreeMf => Encoding::ThreeMf,
    }
}

/// The likely encoding of content without a mark.
fn guess(bytes: &[u8]) -> Option<Encoding> {
    if !is_text(bytes) && is_longer_stl(bytes) {
        Some(Encoding::StlBinary)
    } else if is_damaged_text(bytes) {
        Some(Encoding::StlAscii)
    } else if has_obj_statement(bytes) {
        Some(Encoding::Obj)
    } else {
        None
    }
}

/// A binary STL with extra bytes at its end, fewer than its own.
fn is_longer_stl(bytes: &[u8]) -> bool {
    let length = announced_length(bytes).unwrap_or(u64::MAX);
    let size = bytes.len() as u64;
    length <= size && size - length < length
}

/// An ASCII STL with zero bytes in it, which its reader tells with their place.
fn is_damaged_text(bytes: &[u8]) -> bool {
    let is_solid = first_word(bytes).eq_ignore_ascii_case(b"solid") && has_facet(bytes);
    is_solid && !is_text(bytes) && !is_longer_stl(bytes)
}

fn unknown(bytes: &[u8]) -> ReadError {
    let mut expected = "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF, or the format's name".to_owned();
    if let Some(length) = announced_length(bytes).filter(|_| !is_text(bytes)) {
        expected += &format!("; as binary STL the file would have {length} bytes instead of {}", bytes.len());
    }
    ReadError { kind: ReadErrorKind::UnknownFormat, place: Place::Whole, expected }
}

const COMMENTS: Dialect = Dialect { comments: true, continued_lines: false };

fn first_word(bytes: &[u8]) -> &[u8] {
    Words::new(bytes, 1, COMMENTS).next_word().unwrap_or_default()
}

/// True unless the start holds control bytes that no text has.
fn is_text(bytes: &[u8]) -> bool {
    let is_control = |&b: &u8| matches!(b, 0..=8 | 14..=26 | 28..=31);
    !start(bytes).iter().any(is_control)
}

fn start(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.len().min(LOOKED_AT_BYTES)]
}

fn has_facet(bytes: &[u8]) -> bool {
    has_word(bytes, b"facet")
}

/// Whether a word comes that follows `solid` in an STL; where there are no facets it ends at once.
fn has_word_of_stl(bytes: &[u8]) -> bool {
    has_facet(bytes) || has_word(bytes, b"endsolid")
}

fn has_word(bytes: &[u8], word: &[u8]) -> bool {
    start(bytes).windows(word.len()).any(|window| window.eq_ignore_ascii_case(word))
}

/// The layout that the header's `format` line names; text if there is none, for the reader to complain about.
fn ply_layout(bytes: &[u8]) -> Encoding {
    let mut words = Words::new(bytes, 1, Dialect::default());
    while words.next_line() {
        match words.next_in_line() {
            Some(b"format") => {
                return match words.next_in_line() {
                    Some(b"binary_little_endian") => Encoding::PlyBinaryLittleEndian,
                    Some(b"binary_big_endian") => Encoding::PlyBinaryBigEndian,
                    _ => Encoding::PlyAscii,
                };
            }
            Some(b"end_header" | b"element") => break,
            _ => {}
        }
    }
    Encoding::PlyAscii
}

fn off_layout(bytes: &[u8]) -> Encoding {
    let mut words = Words::new(bytes, 1, COMMENTS);
    words.next_word();
    match words.next_in_line() {
        Some(b"BINARY") => Encoding::OffBinary,
        _ => Encoding::Off,
    }
}

/// Looks for a vertex or face among the first statements.
fn has_obj_statement(bytes: &[u8]) -> bool {
    const STATEMENTS_MAX: usize = 1000;
    let mut words = Words::new(bytes, 1, Dialect { comments: true, continued_lines: true });
    for _ in 0..STATEMENTS_MAX {
        let Some(keyword) = words.next_word() else { return false };
        let mut next_is = |is: fn(&[u8]) -> bool| words.next_in_line().is_some_and(is);
        let is_number = |word: &[u8]| coordinate(word, Precision::F32).is_some();
        let is_index =
            |word: &[u8]| word.split(|&b| b == b'/').next().is_some_and(|id| integer(id).is_some());
        let is_obj = match keyword {
            b"v" | b"vn" => next_is(is_number) && next_is(is_number) && next_is(is_number),
            b"vt" => next_is(is_number),
            b"f" => next_is(is_index) && next_is(is_index),
            _ => false,
        };
        if is_obj {
            return true;
        }
        words.next_line();
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary_stl(header: &[u8], count: u32, triangles: usize) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, 0);
        bytes.extend(count.to_le_bytes());
        bytes.resize(84 + 50 * triangles, 0);
        bytes
    }

    #[test]
    fn each_format_is_known_by_its_content() {
        let cases: [(&[u8], Encoding); 19] = [
            (b"glTF\x02\0\0\0", Encoding::Glb),
            (b"{\n  \"asset\": {\"version\": \"2.0\"}}", Encoding::Gltf),
            (b"\xef\xbb\xbf{\"meshes\": [], \"asset\": {}}", Encoding::Gltf),
            (b"ply\nformat ascii 1.0\n", Encoding::PlyAscii),
            (b"ply\r\ncomment x\r\nformat binary_big_endian 1.0\r\n", Encoding::PlyBinaryBigEndian),
            (b"ply\nformat binary_little_endian 1.0\nelement", Encoding::PlyBinaryLittleEndian),
            (b"OFF\n0 0 0", Encoding::Off),
            (b"# first\n\nSTCNOFF 1 1 1", Encoding::Off),
            (b"OFF BINARY\n\0\0", Encoding::OffBinary),
            (b"OFF8 6 0", Encoding::Off),
            (b"solid a\nfacet normal", Encoding::StlAscii),
            (b"\n SOLID\r  FACET", Encoding::StlAscii),
            (b"# x\nmtllib a.mtl\no a\nv 1 2 3", Encoding::Obj),
            (b"vt 0 1\nf", Encoding::Obj),
            (b"g x\nf 1//1 2//2 3//3", Encoding::Obj),
            (&binary_stl(b"", 2, 2), Encoding::StlBinary),
            (&binary_stl(b"solid facet", 1, 1), Encoding::StlBinary),
            (&binary_stl(b"ply\nformat ascii 1.0\n", 1, 1), Encoding::StlBinary),
            (&[binary_stl(b"", 2, 2), vec![1; 100]].concat(), Encoding::StlBinary),
        ];
        for (bytes, encoding) in cases {
            assert_eq!(sniff(bytes, None), Ok(encoding), "{}", bytes.escape_ascii());
            assert_eq!(sniff(bytes, Some(encoding.format())), Ok(encoding));
        }
    }

    #[test]
    fn nothing_and_blanks_are_empty_whatever_is_named() {
        for named in [None, Some(Format::Obj), Some(Format::Stl)] {
            assert_eq!(sniff(b"", named).unwrap_err().kind, ReadErrorKind::Empty);
            assert_eq!(sniff(b" \r\n\t ", named).unwrap_err().kind, ReadErrorKind::Empty);
        }
    }

    #[test]
    fn the_name_decides_where_content_does_not() {
        let truncated = &binary_stl(b"solid", 9, 2);
        assert_eq!(sniff(truncated, Some(Format::Stl)), Ok(Encoding::StlBinary));
        let error = sniff(truncated, None).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::UnknownFormat);
        assert!(error.expected.ends_with("534 bytes instead of 184"), "{error}");
        assert_eq!(sniff(b"8 6 0\n", Some(Format::Off)), Ok(Encoding::Off));
        assert_eq!(sniff(b"solid\n", Some(Format::Stl)), Ok(Encoding::StlAscii));
        assert_eq!(sniff(b"solid x\nendsolid x\n", None), Ok(Encoding::StlAscii));
        assert_eq!(sniff(b"hello", Some(Format::Obj)), Ok(Encoding::Obj));
        assert_eq!(sniff(b"<xml>", None).unwrap_err().kind, ReadErrorKind::UnknownFormat);
        let page = sniff(b"<html>", Some(Format::Stl)).unwrap_err();
        assert_eq!(page.kind, ReadErrorKind::Foreign { name: "a web page" });
        assert_eq!(
            page.to_string(),
            "this is a web page, which is not read here; expected a mesh in STL, OBJ, OFF, PLY, 3MF or glTF"
        );
    }

    #[test]
    fn formats_that_are_not_read_are_named_with_a_hint() {
        let cases: [(&[u8], &str, &str); 4] = [
            (b"ISO-10303-21;\nHEADER;", "STEP", "CAD program"),
            (b"<?xml version=\"1.0\"?><amf unit=\"millimeter\">", "AMF", "save an AMF as 3MF"),
            (b"#VRML V2.0 utf8\n", "VRML", "PLY keeps"),
            (b"<?xml version=\"1.0\"?><COLLADA>", "COLLADA", "export the scene as OBJ"),
        ];
        for (bytes, name, hint) in cases {
            let error = sniff(bytes, None).unwrap_err();
            assert_eq!(error.kind, ReadErrorKind::Foreign { name });
            assert!(error.expected.contains(hint), "{error}");
        }
    }

    #[test]
    fn content_that_certainly_is_another_format_contradicts_the_name() {
        let error = sniff(b"ply\nformat ascii 1.0\n", Some(Format::Stl)).unwrap_err().to_string();
        assert_eq!(error, "found ply-ascii content; expected stl as the request says");
        assert!(sniff(&binary_stl(b"", 1, 1), Some(Format::Obj)).is_err());
    }
}
