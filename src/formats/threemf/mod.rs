//! 3MF: a project of several meshes in a zip package, which is kept around what is repaired of it.
//!
//! Follows the 3MF core specification 1.3 with the materials and production extensions; slices, beam lattices, sets of
//! triangles and the marks of painting programs are kept as bytes.

mod model;
mod model_reader;
mod models;
mod negative;
mod new_members;
mod package;
pub(super) mod read;
mod read_mesh;
mod read_model;
mod read_properties;
mod read_purposes;
mod read_relationships;
mod read_volumes;
mod regions;
mod rewrite;
mod scene;
mod split;
mod transform;
pub(super) mod write;
mod xml;

pub use model::{FaceAttributes, NO_NUMBER, ObjectKind, Property};
pub use negative::{NegativeParts, read_negative_parts};
pub use new_members::Between;
pub use read::{Body, Project, read_project, read_scene};
pub use rewrite::{FaceSource, NewBody, RewriteError, rewrite_project};
pub use scene::PlacedObject;
