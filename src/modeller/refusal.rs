//! Why an operator does nothing.

use super::conflict::Conflict;
use super::exact::Rational;
use super::rule::BrokenRule;
use crate::mesh::polyhedron::{FaceId, VertexId};

/// Why an operator does nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum OperatorRefusal {
    /// No plane moves.
    NothingMoves,
    /// An event is in the way; the offsets of the faces may grow by less than this.
    Limit {
        /// The growth of each moving face at the event.
        limits: Vec<(FaceId, Rational)>,
        /// What would meet.
        blocking: Vec<Conflict>,
    },
    /// No split of the vertex opens every new edge and keeps its faces apart, in this direction.
    NoSplit {
        /// The vertex.
        vertex: VertexId,
        /// Its faces.
        faces: Vec<FaceId>,
    },
    /// A face would shrink to a segment or a point.
    FaceVanishes {
        /// The face.
        face: FaceId,
    },
    /// A face would touch itself at the merged vertex, whose link would be no circle.
    LinkNotADisk {
        /// The face.
        face: FaceId,
    },
    /// The vertex has three faces only.
    VertexIsTrihedral {
        /// The vertex.
        vertex: VertexId,
    },
    /// The face is not at the vertex, or moves no end of the edge.
    NotThere {
        /// The face.
        face: FaceId,
    },
    /// The edge never loses its length, however far the face moves.
    EdgeStays,
    /// The faces at both ends of the edge are one face.
    EndsAreOneFace {
        /// The face.
        face: FaceId,
    },
    /// The faces at both ends of the edge have an edge there already.
    EndsAreNeighbours {
        /// The faces.
        faces: [FaceId; 2],
    },
    /// A face beside the edge has three sides: its edges vanish together, which is a merge and no flip.
    FaceHasThreeSides {
        /// The face.
        face: FaceId,
    },
    /// The flipped edge would have no positive length: the determinants of the end faces with either face beside the
    /// edge have the same sign.
    DoesNotOpen {
        /// The faces at the ends.
        faces: [FaceId; 2],
    },
    /// Other edges lose their lengths at the same time.
    SeveralVanish {
        /// How many in all.
        count: usize,
    },
    /// More events than one operator passes.
    TooManyEvents {
        /// The limit.
        limit: usize,
    },
    /// The check after the edit found a broken rule.
    Invalid(BrokenRule),
}
