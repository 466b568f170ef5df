//! What a file says of its faces, as regions of a surface.

/// In the place of the number of what is at a corner: the whole triangle has one.
pub const NO_VALUE: u32 = u32::MAX;

/// The regions of a surface in which a file says the same of all triangles. Both lists are empty when there is one region only.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Regions {
    /// For each triangle the number of its region.
    pub of_triangle: Vec<u32>,
    /// For each triangle the numbers of what is at its corners, where that differs between them, or [`NO_VALUE`] three
    /// times; empty when no triangle has such corners. Where triangles have other numbers at a common edge, a seam is between
    /// them.
    pub at_corners: Vec<[u32; 3]>,
}

impl Regions {
    /// True when nothing is to be told apart.
    pub fn is_empty(&self) -> bool {
        self.of_triangle.is_empty()
    }
}
