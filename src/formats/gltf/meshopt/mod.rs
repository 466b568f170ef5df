//! Buffer views that `KHR_meshopt_compression` or its forerunner `EXT_meshopt_compression` has compressed.
//!
//! Written from the text of the extensions (Khronos glTF repository, appendices A and B). The two differ by version 1 of
//! attributes and the filter for colours, which only the former has; a stream says its version, so both are read under
//! either name.

mod data;
mod filters;
mod indices;
mod vertices;

use self::data::Data;
use self::filters::Filter;
use super::part::LocatedValue;
use crate::budget::{Budget, Charge};
use crate::formats::{Place, ReadError};

/// The names, of which a view has one.
const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// Decoded bytes that count as one unit of work: a byte takes 1 to 2 ns.
const BYTES_OF_WORK: usize = 16;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CompressionMode {
    Attributes,
    Triangles,
    Indices,
}

/// How a buffer view is compressed.
pub(super) struct Compressed<'a> {
    /// The extension, which names the bytes of the stream as a buffer view does.
    pub(super) part: LocatedValue<'a>,
    mode: CompressionMode,
    filter: Filter,
    count: u64,
    /// Bytes of an element.
    stride: usize,
    /// Bytes of all elements.
    pub(super) decoded_bytes: u64,
}

impl<'a> Compressed<'a> {
    /// The compression of the buffer view `view`, if it has one, by the rules of the extension.
    pub(super) fn of(view: &LocatedValue<'a>) -> Result<Option<Self>, ReadError> {
        let Some(part) = extension(view) else { return Ok(None) };
        let mode = part.need("mode")?;
        let mode = match mode.value.as_str() {
            Some("ATTRIBUTES") => CompressionMode::Attributes,
            Some("TRIANGLES") => CompressionMode::Triangles,
            Some("INDICES") => CompressionMode::Indices,
            _ => return Err(mode.wrong("ATTRIBUTES, TRIANGLES or INDICES")),
        };
        let stride = number(&part, "byteStride")?;
        let is_for_mode = match mode {
            CompressionMode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
            CompressionMode::Triangles | CompressionMode::Indices => matches!(stride, 2 | 4),
        };
        if !is_for_mode {
            let expected = "a multiple of 4 up to 256 for ATTRIBUTES, and 2 or 4 for TRIANGLES and INDICES";
            return Err(part.need("byteStride")?.wrong(expected));
        }
        let filter = match part.get("filter") {
            Some(filter) => Filter::of(&filter, mode == CompressionMode::Attributes, stride)?,
            None => Filter::None,
        };
        let count = number(&part, "count")?;
        if mode == CompressionMode::Triangles && !count.is_multiple_of(3) {
            return Err(part.need("count")?.wrong("three indices for each triangle"));
        }
        let (length, decoded) = (number(view, "byteLength")?, count.checked_mul(stride));
        let Some(decoded_bytes) = decoded.filter(|&decoded| decoded == length) else {
            let expected = format!("{count} elements of {stride} bytes, as {} says", part.pointer);
            return Err(view.need("byteLength")?.wrong(&expected));
        };
        Ok(Some(Self { part, mode, filter, count, stride: stride as usize, decoded_bytes }))
    }

    /// Checks that `stream` is no shorter than any stream of so many elements: what a small file claims is not believed.
    pub(super) fn check_length(&self, stream: &[u8]) -> Result<(), ReadError> {
        let bytes_min = match self.mode {
            CompressionMode::Attributes => vertices::stream_bytes_min(stream, self.count, self.stride as u64),
            CompressionMode::Triangles => indices::triangles_bytes_min(self.count),
            CompressionMode::Indices => indices::sequence_bytes_min(self.count),
        };
        if stream.len() as u64 >= bytes_min {
            return Ok(());
        }
        let expected = format!(
            "at least {bytes_min} bytes in the stream of {} elements at {}",
            self.count, self.part.pointer
        );
        let found = format!("a stream of {} bytes", stream.len());
        Err(ReadError::unparseable(Place::Whole, found, expected))
    }

    /// The elements of `stream`.
    pub(super) fn decode<'b>(
        &self,
        stream: &[u8],
        budget: &'b Budget,
    ) -> Result<(Vec<u8>, Charge<'b>), ReadError> {
        self.check_length(stream)?;
        // The stream is at least a thousandth of it.
        let len = self.decoded_bytes as usize;
        let (mut elements, charge) = budget.vec::<u8>(len)?;
        let data = Data::of(stream, &self.part.pointer);
        match self.mode {
            CompressionMode::Attributes => {
                elements.resize(len, 0);
                vertices::decode(data, self.stride, &mut elements, budget)?;
                filters::apply(self.filter, self.stride, &mut elements, budget)?;
            }
            CompressionMode::Triangles => {
                indices::triangles_into(&mut elements, data, self.count, self.stride, budget)?;
            }
            CompressionMode::Indices => {
                indices::sequence_into(&mut elements, data, self.count, self.stride, budget)?;
            }
        }
        Ok((elements, charge))
    }
}

/// The extension of the buffer view `view` by which it is compressed.
pub(super) fn extension<'a>(view: &LocatedValue<'a>) -> Option<LocatedValue<'a>> {
    let extensions = view.get("extensions")?;
    NAMES.into_iter().find_map(|name| extensions.get(name))
}

fn number(part: &LocatedValue<'_>, key: &str) -> Result<u64, ReadError> {
    let value = part.need(key)?;
    part.count(key)?.ok_or_else(|| value.wrong("a whole number of 0 or more"))
}
