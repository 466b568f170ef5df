//! Polygon file format: a header that describes elements and their properties, then their values.

mod header;
pub(super) mod read;
mod roles;
mod values;
pub(super) mod write;
