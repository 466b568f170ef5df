//! Geomview's object file format: counts, vertices, faces.

pub(super) mod header;
pub(super) mod read;
pub(super) mod read_binary;
pub(super) mod write;
