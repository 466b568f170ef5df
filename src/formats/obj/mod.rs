//! Wavefront OBJ: statements, one a line.

mod material_names;
pub(super) mod materials;
mod object_names;
pub(super) mod read;
pub(super) mod read_with_tobj;
mod statements;
mod texture;
pub(super) mod write;

pub(super) use object_names::stored_order;
