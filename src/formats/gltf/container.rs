//! The JSON text and the binary chunk of a GLB file, and the tree of the text.

use crate::budget::{Budget, Charge};
use crate::formats::{Place, ReadError};
use serde_json::Value;

const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// What a file consists of.
pub(super) struct ContainerContent<'a> {
    json: &'a [u8],
    /// Where the JSON text begins in the file.
    json_begin: usize,
    /// The binary chunk.
    pub(super) binary: Option<&'a [u8]>,
}

impl<'a> ContainerContent<'a> {
    /// The chunks of a GLB file; others than the two that are known are skipped, as well as bytes after the announced length.
    pub(super) fn of_glb(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let word =
            |at: usize| bytes.get(at..at + 4).and_then(|b| b.first_chunk()).map(|&b| u32::from_le_bytes(b));
        let end = Place::Byte(bytes.len() as u64);
        let (Some(version), Some(length)) = (word(4), word(8)) else {
            return Err(ReadError::truncated(end, "a GLB header of 12 bytes"));
        };
        if version != 2 {
            return Err(ReadError::unparseable(
                Place::Byte(4),
                format!("GLB of version {version}"),
                "version 2",
            ));
        }
        if length as usize > bytes.len() {
            return Err(ReadError::truncated(end, format!("{length} bytes, as announced at byte 8")));
        }
        let mut at = HEADER_BYTES;
        let (mut json, mut binary) = (None, None);
        while at + CHUNK_HEADER_BYTES <= length as usize {
            let (size, kind) = (word(at).unwrap_or_default() as usize, word(at + 4).unwrap_or_default());
            let begin = at + CHUNK_HEADER_BYTES;
            let Some(chunk) = bytes.get(begin..begin + size) else {
                return Err(ReadError::truncated(
                    end,
                    format!("a chunk of {size} bytes from byte {begin} on"),
                ));
            };
            match kind {
                JSON if json.is_none() => json = Some((chunk, begin)),
                BIN if binary.is_none() => binary = Some(chunk),
                _ => {}
            }
            at = begin + size;
        }
        let (json, json_begin) = json.ok_or_else(|| {
            ReadError::unparseable(Place::Byte(HEADER_BYTES as u64), "no JSON chunk", "a chunk of JSON text")
        })?;
        Ok(Self { json, json_begin, binary })
    }

    /// A file that is JSON text.
    pub(super) fn of_text(bytes: &'a [u8]) -> Self {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Self { json, json_begin: bytes.len() - json.len(), binary: None }
    }

    /// The tree of the text, which is charged before it is made.
    pub(super) fn tree<'b>(&self, budget: &'b Budget) -> Result<(Value, Charge<'b>), ReadError> {
        budget.check()?;
        let charge = budget.charge(tree_bytes(self.json))?;
        let text = without_zeros_at_end(self.json);
        let tree = serde_json::from_slice(text).map_err(|error| {
            let expected = "a glTF document in JSON";
            let lines = || text.split_inclusive(|&b| b == b'\n').take(error.line().saturating_sub(1));
            let before: usize = lines().map(<[u8]>::len).sum();
            let byte = self.json_begin + before + error.column().saturating_sub(1);
            let why = error.to_string();
            // The place is told in bytes of the file.
            let why = why.split(" at line ").next().unwrap_or_default().to_owned();
            match error.classify() {
                serde_json::error::Category::Eof => ReadError::truncated(Place::Byte(byte as u64), expected),
                _ => {
                    let found = format!("text that is no JSON ({why})");
                    ReadError::unparseable(Place::Byte(byte as u64), found, expected)
                }
            }
        })?;
        Ok((tree, charge))
    }
}

/// The text without what some writers pad it with instead of blanks.
fn without_zeros_at_end(text: &[u8]) -> &[u8] {
    &text[..text.iter().rposition(|&b| b != 0).map_or(0, |last| last + 1)]
}

/// At most so many bytes the tree of a JSON text takes: its letters, and for each value, of which there is one more than
/// there are marks between values, its own size with the slack of growing lists and a key with its place in a table.
fn tree_bytes(json: &[u8]) -> u64 {
    const PER_VALUE: u64 = 2 * (size_of::<Value>() + size_of::<String>() + 48) as u64;
    let marks = json.iter().filter(|byte| matches!(byte, b',' | b'[' | b'{')).count() as u64;
    json.len() as u64 + (marks + 1) * PER_VALUE
}
