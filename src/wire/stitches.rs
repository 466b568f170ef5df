//! The edges that a step of cut-stitch joined, one by one.

use serde::Serialize;
use utoipa::ToSchema;

use crate::pipeline;

/// The boundary edges that a step joined, in the order in which they were joined, at most 10,000 pairs of each kind.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Stitches {
    /// Pairs that were joined because they match.
    pub explicit: Vec<JoinedEdges>,
    /// All such pairs, listed or not.
    pub explicit_total: u64,
    /// Pairs that became one because vertices of others were joined.
    pub implicit: Vec<JoinedEdges>,
    /// All such pairs, listed or not.
    pub implicit_total: u64,
}

/// Two boundary edges that became one.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct JoinedEdges {
    /// The two edges as the file has them, each by the numbers of its two vertices from 0, in the direction of its face.
    pub edges: [[u32; 2]; 2],
    /// The face of each edge, by its number in the file from 0.
    pub faces: [u32; 2],
}

impl From<&pipeline::Stitches> for Stitches {
    fn from(inner: &pipeline::Stitches) -> Self {
        let stitches = |pairs: &[pipeline::JoinedEdges]| {
            pairs.iter().map(|pair| JoinedEdges { edges: pair.edges, faces: pair.faces }).collect()
        };
        Self {
            explicit: stitches(&inner.explicit),
            explicit_total: inner.explicit_total,
            implicit: stitches(&inner.implicit),
            implicit_total: inner.implicit_total,
        }
    }
}
