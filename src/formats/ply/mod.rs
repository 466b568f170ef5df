//! Polygon file format: a header that describes elements and their properties, then their values.

mod announced;
mod header;
pub(super) mod read;
mod roles;
mod values;
pub(super) mod write;

pub(super) use announced::header_triangles_at_most;
