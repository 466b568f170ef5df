//! Triangles that fill a hole, and why there are none.

use crate::geom::DVec3;

/// Triangles that fill one or several holes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Patch {
    /// The vertices of the rims first, rim by rim in the order given and with the same bits; then new ones.
    pub points: Vec<DVec3>,
    /// Indices into `points`, counter-clockwise seen from outside. Each edge of a rim has one triangle, which runs
    /// through it in the rim's direction.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a surface was not made into triangles.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Unmeshed {
    /// A rim has fewer than three vertices or one that is not finite, or the cell is not a positive number.
    #[error("a rim needs three finite vertices, and the length asked for must be a positive number")]
    Input,
    /// The surface has more cells or a longer rim than are handled.
    #[error("the surface has more than {cells_max} cells of the size asked for")]
    TooFine {
        /// The most cells.
        cells_max: usize,
    },
    /// What the surface leaves inside of the rims is not one piece with a loop for each rim, also not with smaller cells.
    #[error("the surface inside of the {rims} rims is not one piece with one boundary loop each")]
    Topology {
        /// Rims.
        rims: usize,
    },
}
