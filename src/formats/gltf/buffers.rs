//! The bytes behind a glTF document: buffers and the views into them.

use super::meshopt::{self, Compressed};
use super::part::{List, LocatedValue};
use crate::budget::{Budget, Charge, Stopped};
use crate::formats::{Place, ReadError, ReadErrorKind};
use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::borrow::Cow;
use std::cell::OnceCell;

/// Padding is left out by some writers.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Buffers of a document and what the views into them are.
pub(super) struct Buffers<'a> {
    buffers: Vec<Buffer<'a>>,
    views: List<'a>,
    /// What compressed views hold, once it was needed.
    decoded: Vec<OnceCell<(Vec<u8>, Charge<'a>)>>,
    budget: &'a Budget,
    _charges: Vec<Charge<'a>>,
}

enum Buffer<'a> {
    Bytes(Cow<'a, [u8]>),
    /// Is not in the file; an error only where it is needed.
    Missing(ReadError),
}

/// Bytes of a buffer view.
#[derive(Debug, Clone, Copy)]
pub(super) struct BufferView<'v> {
    pub(super) bytes: &'v [u8],
    /// Bytes from one element to the next, where they are not packed.
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// The buffers of the document `root`, of which the first is `binary` if it names no other place.
    pub(super) fn of(
        root: &LocatedValue<'a>,
        binary: Option<&'a [u8]>,
        budget: &'a Budget,
    ) -> Result<Self, ReadError> {
        let mut charges = Vec::new();
        let mut buffers = Vec::new();
        for (i, buffer) in root.list("buffers")?.items().enumerate() {
            buffers.push(match (buffer.get("uri"), binary) {
                (None, Some(binary)) if i == 0 => Buffer::Bytes(Cow::Borrowed(binary)),
                (None, _) => Buffer::Missing(buffer.wrong_with("a buffer without bytes", IN_THE_FILE)),
                (Some(uri), _) => match decode(&uri, budget)? {
                    Ok((bytes, charge)) => {
                        charges.push(charge);
                        Buffer::Bytes(Cow::Owned(bytes))
                    }
                    Err(error) => Buffer::Missing(error),
                },
            });
        }
        let views = root.list("bufferViews")?;
        let decoded = (0..views.len()).map(|_| OnceCell::new()).collect();
        Ok(Self { buffers, views, decoded, budget, _charges: charges })
    }

    /// How many of the views are compressed.
    pub(super) fn compressed_views(&self) -> u64 {
        self.views.items().filter(|view| meshopt::extension(view).is_some()).count() as u64
    }

    /// How many bytes the view that `part` names by its number is said to hold, if it is compressed: no more than its stream
    /// can make.
    pub(super) fn decoded_bytes(&self, part: &LocatedValue<'_>) -> Result<Option<u64>, ReadError> {
        let view = self.views.item(part.as_index(&self.views)?);
        let Some(compressed) = Compressed::of(&view)? else { return Ok(None) };
        compressed.check_length(self.bytes_of(&compressed.part)?)?;
        Ok(Some(compressed.decoded_bytes))
    }

    /// The view that `part` names by its number.
    pub(super) fn view(&self, part: &LocatedValue<'_>) -> Result<BufferView<'_>, ReadError> {
        let number = part.as_index(&self.views)?;
        let view = self.views.item(number);
        let stride = view.count("byteStride")?.filter(|&stride| stride != 0).map(|stride| stride as usize);
        let bytes = match Compressed::of(&view)? {
            None => self.bytes_of(&view)?,
            Some(compressed) => self.decoded(number, &compressed)?,
        };
        Ok(BufferView { bytes, stride })
    }

    /// What the view number `number` holds.
    fn decoded(&self, number: usize, compressed: &Compressed<'_>) -> Result<&[u8], ReadError> {
        if let Some((bytes, _)) = self.decoded[number].get() {
            return Ok(bytes);
        }
        let decoded = compressed.decode(self.bytes_of(&compressed.part)?, self.budget)?;
        Ok(&self.decoded[number].get_or_init(|| decoded).0)
    }

    /// The bytes of a buffer that `view` names.
    fn bytes_of(&self, view: &LocatedValue<'_>) -> Result<&[u8], ReadError> {
        let buffer = view.need("buffer")?;
        let number = buffer.value.as_u64().filter(|&i| i < self.buffers.len() as u64);
        let number = number.ok_or_else(|| buffer.wrong("the number of a buffer"))?;
        let bytes = match &self.buffers[number as usize] {
            Buffer::Bytes(bytes) => bytes,
            Buffer::Missing(error) => return Err(error.clone()),
        };
        let begin = view.count("byteOffset")?.unwrap_or(0);
        let length = view.need("byteLength")?;
        let length = view.count("byteLength")?.ok_or_else(|| length.wrong("a number of bytes"))?;
        let range = begin..begin.saturating_add(length);
        match bytes.get(range.start as usize..range.end as usize) {
            Some(bytes) if range.end < u64::MAX => Ok(bytes),
            _ => Err(ReadError::truncated(
                Place::Whole,
                format!(
                    "{} bytes in buffer {number} for {}, which has {}",
                    range.end,
                    view.pointer,
                    bytes.len()
                ),
            )),
        }
    }
}

const IN_THE_FILE: &str = "a file that holds all of its buffers: GLB, or data URIs in base64";

/// True when `part` uses the extension.
pub(super) fn has_extension(part: &LocatedValue<'_>, name: &str) -> bool {
    part.get("extensions").is_some_and(|extensions| extensions.get(name).is_some())
}

/// The file is compressed in a way that is not read.
pub(super) fn compressed_by_draco() -> ReadError {
    let name = "glTF with Draco compression (KHR_draco_mesh_compression)";
    let expected = "the same model exported without compression".to_owned();
    ReadError { kind: ReadErrorKind::Foreign { name }, place: Place::Whole, expected }
}

/// The bytes of a data URI; the inner error: it names something that is not in the file.
#[allow(clippy::type_complexity, reason = "two ways to fail, of which one may not matter")]
pub(super) fn decode<'b>(
    uri: &LocatedValue<'_>,
    budget: &'b Budget,
) -> Result<Result<(Vec<u8>, Charge<'b>), ReadError>, Stopped> {
    budget.check()?;
    let Some(text) = uri.value.as_str() else { return Ok(Err(uri.wrong("a text"))) };
    let Some(data) = text.strip_prefix("data:") else {
        let name: String = text.chars().take(80).collect();
        return Ok(Err(uri.wrong_with(&format!("the external file `{name}`"), IN_THE_FILE)));
    };
    let Some((_, encoded)) = data.split_once(";base64,") else {
        return Ok(Err(uri.wrong_with("a data URI that is not in base64", IN_THE_FILE)));
    };
    let (mut bytes, charge) = budget.vec::<u8>(base64::decoded_len_estimate(encoded.len()))?;
    Ok(match BASE64.decode_vec(encoded, &mut bytes) {
        Ok(()) => Ok((bytes, charge)),
        Err(error) => Err(uri.wrong_with(&format!("broken base64 ({error})"), "base64")),
    })
}
