//! How fine the lattices are on which a surface is rebuilt.

/// How fine and so how long to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Effort {
    /// The coarsest lattice that usually shows what is to be seen.
    Low,
    /// That, and a finer one where too much is lost.
    #[default]
    Normal,
    /// Ever finer ones.
    High,
}

impl Effort {
    /// The lattices to try, one after the other: cells along the longest side, and most cubes for the area.
    pub(super) fn lattices(self) -> &'static [(u32, f64)] {
        const ALL: [(u32, f64); 3] = [(256, 3e4), (512, 1.5e5), (1024, 6e5)];
        match self {
            Self::Low => &ALL[..1],
            Self::Normal => &ALL[..2],
            Self::High => &ALL,
        }
    }
}

/// Coarser lattices than all that an effort begins with, for what takes too much work on those.
const COARSER: [(u32, f64); 3] = [(128, 7.5e3), (64, 1.9e3), (32, 500.0)];

/// The coarser lattices below one of so many cells.
pub(super) fn coarser_than(cells: u32) -> &'static [(u32, f64)] {
    let first = COARSER.iter().position(|&(coarser, _)| coarser < cells).unwrap_or(COARSER.len());
    &COARSER[first..]
}
