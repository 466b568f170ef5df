//! The XML of a part: elements with their namespaces and places, under limits. No document types, no entities of its own.

use super::package::shortened;
use crate::budget::Budget;
use crate::formats::{Place, ReadError};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::borrow::Cow;

/// Deepest nesting of elements.
const DEPTH_MAX: usize = 64;
/// Most attributes of an element.
const ATTRIBUTES_MAX: usize = 200;

/// Namespaces that are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Namespace {
    Core,
    Material,
    Production,
    Slice,
    BeamLattice,
    TriangleSets,
    /// `xmlns` without a value, or a name without a prefix where none is declared.
    None,
    /// Any other.
    Other,
}

impl Namespace {
    /// The namespace of this URI.
    pub(super) fn of(uri: &str) -> Self {
        match uri {
            "" => Self::None,
            "http://schemas.microsoft.com/3dmanufacturing/core/2015/02" => Self::Core,
            "http://schemas.microsoft.com/3dmanufacturing/material/2015/02" => Self::Material,
            "http://schemas.microsoft.com/3dmanufacturing/production/2015/06" => Self::Production,
            "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07" => Self::Slice,
            "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"
            | "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07" => Self::BeamLattice,
            "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07" => Self::TriangleSets,
            _ => Self::Other,
        }
    }
}

/// A part as text.
pub(super) struct Document<'x> {
    /// Its name.
    pub(super) part: &'x str,
    /// Without a byte order mark.
    pub(super) text: &'x str,
}

impl<'x> Document<'x> {
    /// `bytes` as UTF-8 without its mark.
    ///
    /// # Errors
    /// Bytes that are no UTF-8.
    pub(super) fn of(part: &'x str, bytes: &'x [u8]) -> Result<Self, ReadError> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        match std::str::from_utf8(text) {
            Ok(text) => Ok(Self { part, text }),
            Err(_) if text.starts_with(b"\xff\xfe") || text.starts_with(b"\xfe\xff") => {
                let found = format!("text in UTF-16 in {part}");
                Err(ReadError::unparseable(Place::Whole, found, "text in UTF-8"))
            }
            Err(error) => {
                let found = format!("bytes that are no UTF-8 in {part}");
                Err(ReadError::unparseable(Place::Byte(error.valid_up_to() as u64), found, "text in UTF-8"))
            }
        }
    }

    /// That `found` stands at byte `at` of this part.
    pub(super) fn error(&self, at: usize, found: &str, expected: impl Into<String>) -> ReadError {
        let before = self.text.as_bytes().get(..at).unwrap_or(self.text.as_bytes());
        let line = memchr::memchr_iter(b'\n', before).count() as u64 + 1;
        let found = format!("{found} (byte {at} of {})", self.part);
        ReadError::unparseable(Place::Line(line), found, expected)
    }
}

/// An element as it begins.
#[derive(Clone, Copy)]
pub(super) struct XmlElement<'x> {
    pub(super) namespace: Namespace,
    /// Name without its prefix.
    pub(super) local: &'x str,
    /// Name as written.
    pub(super) name: &'x str,
    /// The attributes as written.
    pub(super) attributes: &'x str,
    /// Byte at which it begins.
    pub(super) at: usize,
    /// It has no content and no end tag.
    pub(super) is_empty: bool,
}

/// What stands in a document.
pub(super) enum XmlEvent<'x> {
    Open(XmlElement<'x>),
    Close,
    End,
}

/// Reads a document from its start to its end.
pub(super) struct Scanner<'x> {
    pub(super) document: &'x Document<'x>,
    reader: Reader<&'x [u8]>,
    /// Declared prefixes with the depth of their element.
    bindings: Vec<(usize, &'x str, Namespace)>,
    pub(super) depth: usize,
    budget: &'x Budget,
}

impl<'x> Scanner<'x> {
    pub(super) fn new(document: &'x Document<'x>, budget: &'x Budget) -> Self {
        let mut reader = Reader::from_reader(document.text.as_bytes());
        reader.config_mut().trim_text(true);
        Self { document, reader, bindings: Vec::new(), depth: 0, budget }
    }

    /// The byte after what was read last.
    pub(super) fn position(&self) -> usize {
        self.reader.buffer_position() as usize
    }

    /// The next begin or end of an element.
    ///
    /// # Errors
    /// What is no XML, a document type, an encoding other than UTF-8, or too many levels.
    pub(super) fn next(&mut self) -> Result<XmlEvent<'x>, ReadError> {
        loop {
            self.budget.spend(1)?;
            let from = self.position();
            let event = match self.reader.read_event() {
                Ok(event) => event,
                Err(error) => {
                    let at = self.reader.error_position() as usize;
                    return Err(self.document.error(at, &format!("no XML: {error}"), "well-formed XML"));
                }
            };
            match event {
                Event::Start(_) => return self.open(from, false).map(XmlEvent::Open),
                Event::Empty(_) => return self.open(from, true).map(XmlEvent::Open),
                Event::End(_) => {
                    while self.bindings.last().is_some_and(|&(depth, ..)| depth == self.depth) {
                        self.bindings.pop();
                    }
                    self.depth = self.depth.saturating_sub(1);
                    return Ok(XmlEvent::Close);
                }
                Event::DocType(_) => {
                    return Err(self.document.error(from, "a document type definition", "XML without one"));
                }
                Event::Decl(declaration) => {
                    let named = declaration.encoding().and_then(Result::ok);
                    if let Some(other) = named.filter(|name| !name.eq_ignore_ascii_case("utf-8")) {
                        let found = format!("the encoding {}", shortened(&other));
                        return Err(self.document.error(from, &found, "UTF-8"));
                    }
                }
                Event::Eof if self.depth > 0 => {
                    let expected =
                        format!("the end tags of {} elements in {}", self.depth, self.document.part);
                    return Err(ReadError::truncated(Place::Byte(from as u64), expected));
                }
                Event::Eof => return Ok(XmlEvent::End),
                _ => {}
            }
        }
    }

    /// The element whose tag was read last, from byte `from` on, with what it declares.
    fn open(&mut self, from: usize, is_empty: bool) -> Result<XmlElement<'x>, ReadError> {
        let text = self.document.text;
        let end = self.position();
        let at = from + memchr::memchr(b'<', &text.as_bytes()[from..end]).unwrap_or(0);
        let inside = text.get(at + 1..end - if is_empty { 2 } else { 1 }).unwrap_or_default();
        let name_length = inside.find(|c: char| c.is_ascii_whitespace()).unwrap_or(inside.len());
        let (name, attributes) = inside.split_at(name_length);
        let depth = self.depth + 1;
        if depth > DEPTH_MAX {
            let found = format!("more than {DEPTH_MAX} elements in each other");
            return Err(self.document.error(at, &found, "fewer levels"));
        }
        let mut declared = Vec::new();
        if memchr::memmem::find(attributes.as_bytes(), b"xmlns").is_some() {
            for attribute in RawAttributes::of(attributes) {
                let (key, value) = attribute.map_err(|()| self.bad_attributes(at, name))?;
                if key == "xmlns" {
                    declared.push((depth, "", Namespace::of(value)));
                } else if let Some(prefix) = key.strip_prefix("xmlns:") {
                    declared.push((depth, prefix, Namespace::of(value)));
                }
            }
        }
        self.bindings.extend(declared.iter().copied());
        let (prefix, local) = name.split_once(':').unwrap_or(("", name));
        let Some(namespace) = self.namespace(prefix) else {
            let found = format!("the prefix {prefix:?}, which is not declared,");
            return Err(self.document.error(at, &found, "a declared namespace"));
        };
        if is_empty {
            self.bindings.truncate(self.bindings.len() - declared.len());
        } else {
            self.depth = depth;
        }
        Ok(XmlElement { namespace, local, name, attributes, at, is_empty })
    }

    fn bad_attributes(&self, at: usize, name: &str) -> ReadError {
        self.document.error(at, &format!("attributes that cannot be read in <{name}>"), "name=\"value\"")
    }

    /// The namespace that a prefix stands for here.
    pub(super) fn namespace(&self, prefix: &str) -> Option<Namespace> {
        let bound = self.bindings.iter().rev().find(|&&(_, declared, _)| declared == prefix);
        match (bound, prefix) {
            (Some(&(.., namespace)), _) => Some(namespace),
            (None, "") => Some(Namespace::None),
            (None, "xml") => Some(Namespace::Other),
            (None, _) => None,
        }
    }

    /// Passes over the content of `element`, to its end.
    pub(super) fn skip(&mut self, element: &XmlElement<'x>) -> Result<(), ReadError> {
        if element.is_empty {
            return Ok(());
        }
        let outside = self.depth - 1;
        while self.depth > outside {
            self.next()?;
        }
        Ok(())
    }

    /// The attributes of `element` with the namespaces of their prefixes; each name at most once.
    ///
    /// # Errors
    /// What is no list of attributes, a name that comes twice, a reference that XML does not define.
    pub(super) fn attributes(&self, element: &XmlElement<'x>) -> Result<Vec<Attribute<'x>>, ReadError> {
        let mut all: Vec<Attribute<'x>> = Vec::new();
        for attribute in RawAttributes::of(element.attributes) {
            let (key, raw) = attribute.map_err(|()| self.bad_attributes(element.at, element.name))?;
            if all.len() >= ATTRIBUTES_MAX {
                let found = format!("more than {ATTRIBUTES_MAX} attributes in <{}>", element.name);
                return Err(self.document.error(element.at, &found, "fewer"));
            }
            if all.iter().any(|other| other.key == key) {
                let found = format!("the attribute {key} twice in <{}>", element.name);
                return Err(self.document.error(element.at, &found, "each attribute once"));
            }
            let Ok(value) = quick_xml::escape::unescape(raw) else {
                let found = format!("a reference that XML does not define in {key} of <{}>", element.name);
                return Err(self.document.error(element.at, &found, "one of XML's own"));
            };
            let (namespace, local) = match key.split_once(':') {
                None => (Namespace::None, key),
                Some((prefix, local)) => (self.namespace(prefix).unwrap_or(Namespace::Other), local),
            };
            all.push(Attribute { namespace, local, key, value });
        }
        Ok(all)
    }
}

/// An attribute of an element.
pub(super) struct Attribute<'x> {
    /// That of its prefix; [`Namespace::None`] without one.
    pub(super) namespace: Namespace,
    pub(super) local: &'x str,
    key: &'x str,
    pub(super) value: Cow<'x, str>,
}

impl Attribute<'_> {
    /// The name as written.
    pub(super) fn key(&self) -> &str {
        self.key
    }
}

/// The value of the attribute `name` without a prefix.
pub(super) fn value<'a>(attributes: &'a [Attribute<'_>], name: &str) -> Option<&'a str> {
    value_in(attributes, Namespace::None, name)
}

/// The value of the attribute `name` of a namespace.
pub(super) fn value_in<'a>(
    attributes: &'a [Attribute<'_>],
    namespace: Namespace,
    name: &str,
) -> Option<&'a str> {
    let is_it = |a: &&Attribute<'_>| a.namespace == namespace && a.local == name;
    attributes.iter().find(is_it).map(|attribute| attribute.value.as_ref())
}

/// The attributes in a tag as written, one by one: names and values with their references.
pub(super) struct RawAttributes<'x> {
    rest: &'x str,
}

impl<'x> RawAttributes<'x> {
    pub(super) fn of(raw: &'x str) -> Self {
        Self { rest: raw }
    }
}

impl<'x> Iterator for RawAttributes<'x> {
    type Item = Result<(&'x str, &'x str), ()>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.rest.trim_ascii_start();
        if rest.is_empty() {
            return None;
        }
        self.rest = "";
        let Some(equals) = memchr::memchr(b'=', rest.as_bytes()) else { return Some(Err(())) };
        let key = rest[..equals].trim_ascii_end();
        let after = rest[equals + 1..].trim_ascii_start();
        let Some(quote) = after.bytes().next().filter(|&quote| quote == b'"' || quote == b'\'') else {
            return Some(Err(()));
        };
        let Some(length) = memchr::memchr(quote, &after.as_bytes()[1..]) else { return Some(Err(())) };
        if key.is_empty() || key.bytes().any(|b| b.is_ascii_whitespace()) {
            return Some(Err(()));
        }
        self.rest = &after[length + 2..];
        Some(Ok((key, &after[1..length + 1])))
    }
}
