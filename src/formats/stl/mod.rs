//! Stereolithography: three coordinates for every corner of every triangle, as text or binary, and no indices.

pub(super) mod read_ascii;
pub(super) mod read_binary;
pub(super) mod write;
