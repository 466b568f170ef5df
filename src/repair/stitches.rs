//! Which boundary edges a stitch made one, in terms of the file.

use super::Draft;
use crate::mesh::{Stitched, edge_of, triangle_of};

/// Pairs of edges of each kind that are listed at most, so that a report stays readable.
pub const LISTED_MAX: usize = 10_000;

/// Two boundary edges that became one, each with the triangle of the soup behind the face that has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Join {
    /// The ends of each edge as its face runs, as vertices of the soup; of welded vertices, the first.
    pub edges: [[u32; 2]; 2],
    /// The triangles.
    pub triangles: [u32; 2],
}

/// The edges that a step joined: at most [`LISTED_MAX`] pairs of each kind, in the order in which they were joined.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Joins {
    /// Pairs that were joined because they match.
    pub explicit: Vec<Join>,
    /// All such pairs, listed or not.
    pub explicit_total: u64,
    /// Pairs that became one because vertices of others were joined.
    pub implicit: Vec<Join>,
    /// All such pairs, listed or not.
    pub implicit_total: u64,
}

impl Joins {
    /// What was `stitched` of the half-edges of `triangles`, which were those of `draft` before.
    pub(super) fn of(draft: &Draft, triangles: &[[u32; 3]], stitched: &Stitched) -> Self {
        let join = |&(g, h): &(u32, u32)| Join {
            edges: [g, h].map(|h| edge_of(triangles, h).map(|v| draft.vertex_origin[v as usize])),
            triangles: [g, h].map(|h| draft.triangle_origin[triangle_of(h) as usize]),
        };
        let listed = |pairs: &[(u32, u32)]| pairs.iter().take(LISTED_MAX).map(join).collect();
        Self {
            explicit: listed(&stitched.explicit),
            explicit_total: stitched.explicit.len() as u64,
            implicit: listed(&stitched.implicit),
            implicit_total: stitched.implicit.len() as u64,
        }
    }

    /// The counts that a step reports.
    pub(super) fn counts(&self) -> [(&'static str, u64); 2] {
        [("edges_joined", self.explicit_total), ("edges_joined_with_others", self.implicit_total)]
    }
}
