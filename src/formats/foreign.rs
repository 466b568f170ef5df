//! Formats that are not read here, known by their first bytes, so that the answer can name them.

/// Bytes at the start in which a mark may stand.
const LOOKED_AT_BYTES: usize = 4096;

/// What bytes at the very beginning mean.
const MARKS: &[(&[u8], &str)] = &[
    (b"Kaydara FBX Binary", "binary FBX"),
    (b"; FBX", "FBX text"),
    (b"ISO-10303-21", "STEP"),
    (b"DBRep_DrawableShape", "OpenCASCADE BREP"),
    (b"CASCADE Topology", "OpenCASCADE BREP"),
    (b"#VRML", "VRML"),
    (b"BLENDER", "a Blender file"),
    (b"PXR-USDC", "USD"),
    (b"#usda", "USD"),
    (b"DRACO", "Draco"),
    (b"AutoCAD Binary DXF", "binary DXF"),
    (b"AC10", "DWG"),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a compound document, such as a SolidWorks part"),
    (b"\x1f\x8b", "gzip"),
    (b"\x28\xb5\x2f\xfd", "Zstandard"),
    (b"BZh", "bzip2"),
    (b"\xfd7zXZ\0", "xz"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive"),
    (b"Rar!\x1a\x07", "a RAR archive"),
    (b"\x89PNG\r\n\x1a\n", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"%PDF-", "a PDF document"),
];

/// What words near the beginning mean in text, in lower case.
const WORDS: &[(&[u8], &str)] = &[
    (b"<amf", "AMF"),
    (b"<collada", "COLLADA"),
    (b"<x3d", "X3D"),
    (b"<model", "the XML of a 3MF"),
    (b"<!doctype html", "a web page"),
    (b"<html", "a web page"),
];

/// The name of the format of `bytes`, if it is one that is known and not read.
pub(super) fn foreign(bytes: &[u8]) -> Option<&'static str> {
    let start = &bytes[..bytes.len().min(LOOKED_AT_BYTES)];
    if start.starts_with(b"PK\x03\x04") || start.starts_with(b"PK\x05\x06") {
        return Some(archive(bytes));
    }
    if let Some(name) = wide_text(start) {
        return Some(name);
    }
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    let of = |rows: &'static [(&[u8], &str)], is: &dyn Fn(&[u8]) -> bool| {
        rows.iter().find(|(mark, _)| is(mark)).map(|&(_, name)| name)
    };
    let marked = of(MARKS, &|mark| start.starts_with(mark) || text.starts_with(mark));
    marked.or_else(|| {
        let lower = text.to_ascii_lowercase();
        match lower.starts_with(b"<") {
            true => of(WORDS, &|word| has(&lower, word)),
            false => dxf(&lower),
        }
    })
}

/// What is in a zip archive, by the names at its start.
fn archive(bytes: &[u8]) -> &'static str {
    let lower = bytes[..bytes.len().min(LOOKED_AT_BYTES)].to_ascii_lowercase();
    // What lists the entries ends with this mark, which a comment may follow.
    if memchr::memmem::rfind(bytes, b"PK\x05\x06").is_none() {
        "a zip archive whose end is missing"
    } else if has(&lower, b"[content_types].xml") {
        "an Office document or another package without a 3MF model"
    } else if has(&lower, b".amf") {
        "compressed AMF"
    } else {
        "a zip archive"
    }
}

/// Text in letters of more than one byte, which bytes as they are would tell as another mesh.
pub(super) fn wide_text(start: &[u8]) -> Option<&'static str> {
    utf_32(start).or_else(|| utf_16(start))
}

/// Text of four bytes a letter, with its mark, or without one where three of four bytes are zero.
fn utf_32(start: &[u8]) -> Option<&'static str> {
    let is_marked = start.starts_with(b"\xff\xfe\0\0") || start.starts_with(b"\0\0\xfe\xff");
    let letters = &start[..start.len() / 4 * 4];
    let count = letters.len() / 4;
    let is_text = |letter: usize| {
        let plain = |four: &&[u8]| {
            (0..4).all(|k| k == letter || four[k] == 0) && matches!(four[letter], 9 | 10 | 13 | 32..=126)
        };
        count >= 8 && letters.chunks(4).filter(plain).count() >= count - count / 8
    };
    (is_marked || is_text(0) || is_text(3)).then_some("text in UTF-32")
}

/// Text of two bytes a letter, with its mark, or without one where every other byte is zero.
fn utf_16(start: &[u8]) -> Option<&'static str> {
    let is_marked = start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff");
    let letters = &start[..start.len() / 2 * 2];
    let count = letters.len() / 2;
    // Nearly all letters are ASCII; names and comments may hold others.
    let is_text = |zero: usize| {
        let plain = |pair: &&[u8]| pair[zero] == 0 && matches!(pair[1 - zero], 9 | 10 | 13 | 32..=126);
        count >= 8 && letters.chunks(2).filter(plain).count() >= count - count / 8
    };
    (is_marked || is_text(0) || is_text(1)).then_some("text in UTF-16")
}

/// A DXF begins with a group code 0 or 999 and its value on lines of their own.
fn dxf(lower: &[u8]) -> Option<&'static str> {
    let mut lines = lower.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let is_code = lines.next() == Some(b"0");
    (is_code && lines.next() == Some(b"section")).then_some("DXF")
}

fn has(text: &[u8], word: &[u8]) -> bool {
    memchr::memmem::find(text, word).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_read_is_known_by_its_first_bytes() {
        let utf_32: Vec<u8> =
            "solid a\nfacet normal 0 0 1\n".chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
        let utf_16: Vec<u8> = "v 0 0 0\nv 1 0 0\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        let named: Vec<u8> =
            "# größe μ\no Würfel\nv 0 0 0\nv 1 0 0\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = "OFF\n4 4 0\n0 0 0\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
        let marked = [&b"\xff\xfe"[..], &utf_16].concat();
        for (bytes, name) in [
            (
                &b"PK\x03\x04\x14\0\0\0\x08\0________________\x13\0\0\0[Content_Types].xml___PK\x05\x06"[..],
                "an Office document or another package without a 3MF model",
            ),
            (b"PK\x03\x04\x14\0\0\0\x08\0________________\x08\0\0\0part.stl___PK\x05\x06", "a zip archive"),
            (
                b"PK\x03\x04\x14\0\0\0\x08\0________________\x13\0\0\0[Content_Types].xml",
                "a zip archive whose end is missing",
            ),
            (b"ISO-10303-21;\nHEADER;", "STEP"),
            (b"Kaydara FBX Binary  \0\x1a\0", "binary FBX"),
            (b"; FBX 7.7.0 project file", "FBX text"),
            (b"\xef\xbb\xbf<?xml version=\"1.0\"?>\n<amf unit=\"mm\">", "AMF"),
            (b"<?xml version=\"1.0\"?><COLLADA>", "COLLADA"),
            (b"\x1f\x8b\x08\0", "gzip"),
            (b"  0\r\nSECTION\r\n", "DXF"),
            (b"\n<!DOCTYPE html><title>403</title>", "a web page"),
            (&utf_16, "text in UTF-16"),
            (&utf_32, "text in UTF-32"),
            (&marked, "text in UTF-16"),
            (&named, "text in UTF-16"),
            (&big, "text in UTF-16"),
        ] {
            assert_eq!(foreign(bytes), Some(name), "{}", String::from_utf8_lossy(bytes));
        }
    }

    #[test]
    fn what_is_read_is_not_foreign() {
        for bytes in [
            &b"solid part\nfacet normal"[..],
            b"v 0 0 0\nv 1 0 0\n",
            b"OFF\n4 4 0\n",
            b"ply\nformat ascii 1.0\n",
            b"# <html> in a comment\nv 0 0 0\n",
            b"0\n",
            b"",
            &[0; 200],
        ] {
            assert_eq!(foreign(bytes), None, "{}", String::from_utf8_lossy(bytes));
        }
    }
}
