//! Marks of edges in a corner table.

/// Marks an edge along which vertices must stay: a border, a crease, or a border between face groups.
pub(super) const LINE: u8 = 1;
