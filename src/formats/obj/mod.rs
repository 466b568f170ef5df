//! Wavefront OBJ: statements, one a line.

pub(super) mod materials;
pub(super) mod read;
pub(super) mod read_with_tobj;
mod statements;
pub(super) mod write;
