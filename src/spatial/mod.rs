//! Search structures over ids and boxes; they know no mesh, only positions and index triples.

mod bvh;
mod coincident;
mod contacts;
mod near;
mod nearest;
mod nesting;
mod octree;
mod pairs;
mod star_gaps;

pub use crate::geom::ContactKind;
pub use bvh::Bvh;
pub use coincident::{Coincident, coincident_f32, coincident_f64};
pub use contacts::{Contacts, Search, Terrains, TriangleContact, self_contacts};
pub use near::{NearInput, NearKind, NearPair, NearPairs, near_pairs};
pub use nearest::{Found, Nearest, NearestSearch};
pub use nesting::{NO_SHELL, ShellNesting, ShellTriangles, nest};
pub use octree::{Octree, is_within};
