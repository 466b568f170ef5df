//! What is known of uploaded bytes before their mesh is looked at.

use crate::formats::Encoding;
use crate::mesh::Units;

/// Facts about the uploaded bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputFacts {
    /// How the bytes are laid out.
    pub encoding: Encoding,
    /// Number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
    /// Unit of the coordinates.
    pub units: Units,
    /// True when the caller or the format stated the unit, false when it is assumed.
    pub units_are_stated: bool,
    /// Unit of the result, and of all lengths, areas, volumes and places of the report but those of the certificate of the
    /// uploaded bytes.
    pub result_units: Units,
}
