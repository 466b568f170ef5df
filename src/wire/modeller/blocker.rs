//! Faces that move, and what is in their way.

use serde::Serialize;
use utoipa::ToSchema;

use super::words::BlockerKind;
use crate::geom::DVec3;
use crate::pipeline;

/// A face and how far it moved or may move.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct MovedFace {
    /// The face.
    pub face: u32,
    /// How far outward, in millimetres.
    pub by_mm: f64,
}

impl MovedFace {
    pub(super) fn of((face, by): (u32, f64), millimetres: f64) -> Self {
        Self { face, by_mm: by * millimetres }
    }
}

/// Elements that are in the way.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Blocker {
    /// How they would meet.
    pub kind: BlockerKind,
    /// Their faces.
    pub faces: Vec<u32>,
    /// Where their vertices are before the move, in the unit of the file.
    pub places: Vec<[f64; 3]>,
}

impl From<&pipeline::Blocker> for Blocker {
    fn from(inner: &pipeline::Blocker) -> Self {
        Self {
            kind: inner.kind.into(),
            faces: inner.faces.clone(),
            places: inner.places.iter().map(DVec3::to_array).collect(),
        }
    }
}

impl Blocker {
    /// What would happen, in a sentence.
    pub(super) fn sentence(&self) -> String {
        let faces = self.faces.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        let place = self.places.first().map(|[x, y, z]| format!(" at {x}, {y}, {z}")).unwrap_or_default();
        match self.kind {
            BlockerKind::EdgeVanishes => {
                format!("the edge between the faces {faces} would lose its length")
            }
            BlockerKind::VertexFace => format!("the vertex{place} would reach face {faces}"),
            BlockerKind::EdgeEdge => format!("edges of the faces {faces} would cross"),
            BlockerKind::LoopLoop => format!("two loops of face {faces} would touch at the vertex{place}"),
            BlockerKind::NoSplit => format!("the vertex{place} has no good split"),
        }
    }
}
