//! Wavefront OBJ: statements, one a line.

mod material_names;
pub(super) mod materials;
pub(super) mod read;
pub(super) mod read_with_tobj;
mod statements;
mod texture;
pub(super) mod write;
