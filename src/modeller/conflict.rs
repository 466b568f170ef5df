//! Elements of a polyhedron that would meet.

use crate::mesh::polyhedron::{FaceId, VertexId};

/// Elements that would meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Conflict {
    /// An edge loses its length.
    EdgeVanishes {
        /// The faces beside it.
        faces: [FaceId; 2],
        /// Its ends.
        vertices: [VertexId; 2],
    },
    /// A vertex reaches a face that it is not at.
    VertexFace {
        /// The vertex.
        vertex: VertexId,
        /// The face.
        face: FaceId,
    },
    /// Two edges cross.
    EdgeEdge {
        /// The faces beside one.
        first: [FaceId; 2],
        /// The faces beside the other.
        second: [FaceId; 2],
    },
    /// Two loops of one face touch, at this vertex of one of them.
    LoopLoop {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
}
