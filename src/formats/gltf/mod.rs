//! glTF 2.0 (ISO/IEC 12113), as GLB and as JSON with data URIs.
//!
//! The document is read by `serde_json` into a tree, because an error can then name its place as a JSON pointer and the
//! tree can be charged before it is made; the crates for glTF deserialize into types of their own and have neither.

mod accessor;
mod buffers;
mod colored;
mod container;
mod looks;
mod materials;
mod meshopt;
mod part;
mod primitive;
mod references;
mod scene;
mod vertices;

pub(super) mod read;
pub(super) mod write;

pub use colored::two_sided_materials;
pub(super) use looks::stored_order;
