//! What is inside of any triangles, and what of them can be seen: shells read as boundaries or sheets, generalized
//! winding numbers (Jacobson, Kavan and Sorkine-Hornung 2013).
//!
//! An open surface S and a cone C over its rim are closed together, so the winding number of S is that of both, an integer
//! which crossings of a line decide exactly, less that of C, which has as few triangles as S has rim edges.

mod angles;
mod covered;
mod outlook;
mod rims;
mod shells;
mod solid;
mod tree;

pub use outlook::{LookedFrom, Outlook};
pub use shells::{Shells, are_sheets, sort};
pub use solid::WindingSolid;
pub use tree::{WindingTree, turned};

/// How open shells are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum OpenShells {
    /// Those that nearly bound a volume are closed, others become walls.
    #[default]
    Auto,
    /// As the boundary of a volume, open only by mistake.
    Close,
    /// As walls of no thickness.
    Thicken,
}
