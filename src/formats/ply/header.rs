//! The header of a PLY file.

use crate::formats::ReadError;
use crate::formats::numbers::integer;
use crate::formats::words::{Dialect, Words};

/// How values are laid out after the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DataEncoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// True for what can count or name something.
    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// Type of a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PropertyType {
    One(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct HeaderProperty<'a> {
    pub(super) name: &'a [u8],
    pub(super) kind: PropertyType,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct PlyElement<'a> {
    pub(super) name: &'a [u8],
    pub(super) count: u64,
    pub(super) properties: Vec<HeaderProperty<'a>>,
    /// Line of the header.
    pub(super) line: u64,
}

impl PlyElement<'_> {
    /// Fewest bytes that one of it takes in any layout.
    pub(super) fn bytes_min(&self, layout: DataEncoding) -> usize {
        let bytes = |property: &HeaderProperty<'_>| match (layout, property.kind) {
            // A digit and a blank.
            (DataEncoding::Ascii, _) => 2,
            (_, PropertyType::One(scalar) | PropertyType::List { count: scalar, .. }) => scalar.width(),
        };
        self.properties.iter().map(bytes).sum()
    }

    /// The property of one of `names`.
    pub(super) fn find(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.iter().any(|name| p.name == name.as_bytes()))
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header<'a> {
    pub(super) layout: DataEncoding,
    pub(super) elements: Vec<PlyElement<'a>>,
    /// Where the values begin.
    pub(super) end: usize,
    /// The line on which they begin, if they are text.
    pub(super) end_line: u64,
}

impl<'a> Header<'a> {
    /// Reads the header of `bytes`. Lines that begin with an unknown word are taken as comments.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        /// More than any file needs; a bound on what a header can make us store.
        const PROPERTIES_MAX: usize = 4096;
        let mut words = Words::new(bytes, 1, Dialect::default());
        let magic = words.next_word();
        if !magic.is_some_and(|word| word.eq_ignore_ascii_case(b"ply")) {
            return Err(words.wrong(magic, "ply"));
        }
        let mut layout = None;
        let mut elements: Vec<PlyElement<'a>> = Vec::new();
        let mut properties = 0;
        while words.next_line() {
            match words.next_in_line() {
                Some(b"format") => layout = Some(read_layout(&mut words)?),
                Some(b"element") => elements.push(read_element(&mut words)?),
                Some(b"property") => {
                    let property = read_property(&mut words)?;
                    let Some(element) = elements.last_mut() else {
                        return Err(words.wrong(Some(b"property"), "an element before its properties"));
                    };
                    element.properties.push(property);
                }
                Some(b"end_header") => {
                    let layout =
                        layout.ok_or_else(|| words.wrong(Some(b"end_header"), "a format before it"))?;
                    words.rest_of_line();
                    let end = bytes.len() - words.remaining().len() + break_width(bytes, words.remaining());
                    return Ok(Self { layout, elements, end, end_line: words.line() + 1 });
                }
                _ => continue,
            }
            properties += 1;
            if properties > PROPERTIES_MAX {
                let found = format!("more than {PROPERTIES_MAX} lines about elements");
                return Err(ReadError::unparseable(words.place(), found, "end_header"));
            }
        }
        Err(words.wrong(None, "end_header"))
    }
}

/// Width of the line break at the start of `rest`. Values may begin with a byte that looks like a part of it, so it is
/// as wide as the first of the file.
fn break_width(bytes: &[u8], rest: &[u8]) -> usize {
    let first = bytes.iter().position(|&b| matches!(b, b'\r' | b'\n')).unwrap_or(bytes.len());
    if bytes[first..].starts_with(b"\r\n") && rest.starts_with(b"\r\n") { 2 } else { rest.len().min(1) }
}

fn read_layout(words: &mut Words<'_>) -> Result<DataEncoding, ReadError> {
    match words.next_in_line() {
        Some(b"ascii") => Ok(DataEncoding::Ascii),
        Some(b"binary_little_endian") => Ok(DataEncoding::LittleEndian),
        Some(b"binary_big_endian") => Ok(DataEncoding::BigEndian),
        found => Err(words.wrong(found, "ascii, binary_little_endian or binary_big_endian")),
    }
}

fn read_element<'a>(words: &mut Words<'a>) -> Result<PlyElement<'a>, ReadError> {
    let name = words.next_in_line().ok_or_else(|| words.wrong(None, "the element's name"))?;
    let word = words.next_in_line();
    let count = word.and_then(integer).and_then(|count| u64::try_from(count).ok());
    let count = count.ok_or_else(|| words.wrong(word, "the number of elements"))?;
    Ok(PlyElement { name, count, properties: Vec::new(), line: words.line() })
}

fn read_property<'a>(words: &mut Words<'a>) -> Result<HeaderProperty<'a>, ReadError> {
    let word = words.next_in_line();
    let kind = if word == Some(b"list") {
        let count = read_scalar(words)?;
        if !count.is_integer() {
            return Err(words.wrong(Some(b"a list counted in floats"), "an integer type"));
        }
        PropertyType::List { count, item: read_scalar(words)? }
    } else {
        PropertyType::One(scalar(words, word)?)
    };
    let name = words.next_in_line().ok_or_else(|| words.wrong(None, "the property's name"))?;
    Ok(HeaderProperty { name, kind })
}

fn read_scalar(words: &mut Words<'_>) -> Result<Scalar, ReadError> {
    let word = words.next_in_line();
    scalar(words, word)
}

fn scalar(words: &Words<'_>, word: Option<&[u8]>) -> Result<Scalar, ReadError> {
    let expected = "char, uchar, short, ushort, int, uint, float, double or list";
    word.and_then(Scalar::from_name).ok_or_else(|| words.wrong(word, expected))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat ascii 1.0\ncomment element x\nobj_info y\nCreated by z\nelement vertex 8\n\
        property float32 x\nproperty double y\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";

    #[test]
    fn elements_and_their_properties_are_listed_whatever_stands_between() {
        let header = Header::read(HEADER.as_bytes()).unwrap();
        assert_eq!((header.layout, header.end, header.end_line), (DataEncoding::Ascii, HEADER.len(), 12));
        let [vertex, face] = &header.elements[..] else { panic!("two elements") };
        assert_eq!((vertex.name, vertex.count, vertex.line), (&b"vertex"[..], 8, 6));
        assert_eq!(vertex.properties[1], HeaderProperty { name: b"y", kind: PropertyType::One(Scalar::F64) });
        assert_eq!(face.properties[0].kind, PropertyType::List { count: Scalar::U8, item: Scalar::I32 });
        assert_eq!((vertex.find(&["a", "y"]), vertex.find(&["z"])), (Some(1), None));
    }

    #[test]
    fn values_begin_after_one_line_break_of_the_kind_that_the_file_uses() {
        for line_break in ["\n", "\r\n", "\r"] {
            let text = HEADER.replace('\n', line_break);
            for first_value in ["\n", "\r", "0"] {
                let header = Header::read(&[text.as_bytes(), first_value.as_bytes()].concat()).map(|h| h.end);
                assert_eq!(header, Ok(text.len()), "{line_break:?} before {first_value:?}");
            }
        }
        assert_eq!(Header::read(HEADER.trim_end().as_bytes()).unwrap().end, HEADER.len() - 1);
    }

    #[test]
    fn what_is_wrong_in_a_header_is_named_with_its_line() {
        let error =
            |from: &str, to: &str| Header::read(HEADER.replace(from, to).as_bytes()).unwrap_err().to_string();
        assert!(error("ascii", "utf8").starts_with("line 2: found \"utf8\"; expected ascii"));
        assert!(error("double", "long").starts_with("line 8: found \"long\"; expected char"));
        assert!(error("list uchar", "list float").starts_with("line 10:"));
        assert!(error("vertex 8", "vertex -8").starts_with("line 6: found \"-8\""));
        assert!(error("element vertex 8", "").starts_with("line 7: found \"property\""));
        assert!(error("format", "fromat").starts_with("line 11: found \"end_header\"; expected a format"));
        assert_eq!(error("end_header\n", ""), "line 11: the file ends here; expected end_header");
        assert!(Header::read(b"plx").is_err());
    }
}
