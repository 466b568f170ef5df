//! Why there is no arrangement.

use crate::budget::Stopped;

/// Why there is no arrangement, or no solid in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ArrangementError {
    /// The budget stops the run.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// More pairs of triangles meet than the caller allows.
    #[error("{count} or more pairs of triangles meet, more than {limit}")]
    TooManyPairs {
        /// How many meet at least.
        count: u64,
        /// How many may.
        limit: u64,
    },
    /// Triangles that pass through others cross each other there at more points than the caller allows.
    #[error("triangles cross each other inside of others at more than {limit} points")]
    TooManyCrossings {
        /// At how many they may.
        limit: u64,
    },
    /// A corner of a triangle has no finite coordinates, or does not exist.
    #[error("triangle {triangle} has a corner without a finite position")]
    NotFinite {
        /// The triangle.
        triangle: u32,
    },
    /// The triangles bound no volume: along an edge they do not balance.
    #[error("the surface is not closed along {edges} edges of the arrangement")]
    NotClosed {
        /// The first operand of which that is so.
        operand: u8,
        /// Number of edges at which its triangles do not balance.
        edges: u64,
    },
    /// What must hold by construction does not: a fault of this module, or of its numbers.
    #[error("internal: {0}")]
    Inconsistent(&'static str),
}
