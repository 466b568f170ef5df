//! What can be wrong with a half-edge mesh: one variant for each broken invariant, with the elements that show it.

use super::{FaceId, HalfEdgeId, VertexId};

/// No more than this many faults are listed.
pub const FAULTS_MAX: usize = 1000;

/// What a mesh is said to be, beyond being a half-edge mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Claims {
    /// It has no boundary.
    pub is_closed: bool,
    /// All its faces are triangles.
    pub is_triangular: bool,
    /// Its number of vertices minus edges plus faces.
    pub euler: Option<i64>,
}

/// An element that a fault is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultElement {
    /// A vertex.
    Vertex(VertexId),
    /// A half-edge.
    HalfEdge(HalfEdgeId),
    /// A face.
    Face(FaceId),
}

/// What an element refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceField {
    /// The half-edge after.
    Next,
    /// The half-edge before.
    Prev,
    /// The other half-edge of the edge.
    Twin,
    /// The vertex where it starts.
    Origin,
    /// The face on its left.
    Face,
    /// The half-edge that a vertex knows.
    Leaving,
    /// The half-edge that a face knows.
    Side,
}

/// A broken invariant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// A reference names an element that is not there (out of range or removed).
    #[error("{of:?}: its {field:?} is not there")]
    OutOfRange {
        /// Whose reference.
        of: FaultElement,
        /// Which one.
        field: ReferenceField,
    },
    /// A half-edge is its own twin.
    #[error("half-edge {} is its own twin", .half_edge.index())]
    TwinOfItself {
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// The twin of the twin is another half-edge.
    #[error("half-edge {} is not the twin of its twin {}", .half_edge.index(), .twin.index())]
    TwinNotMutual {
        /// The half-edge.
        half_edge: HalfEdgeId,
        /// Its twin.
        twin: HalfEdgeId,
    },
    /// The one before the next is another half-edge.
    #[error("half-edge {} is not before its next {}", .half_edge.index(), .next.index())]
    NextNotInverse {
        /// The half-edge.
        half_edge: HalfEdgeId,
        /// The one after it.
        next: HalfEdgeId,
    },
    /// The one after the previous is another half-edge.
    #[error("half-edge {} is not after its previous {}", .half_edge.index(), .prev.index())]
    PrevNotInverse {
        /// The half-edge.
        half_edge: HalfEdgeId,
        /// The one before it.
        prev: HalfEdgeId,
    },
    /// Two consecutive half-edges have different faces.
    #[error("half-edge {} and the next, {}, have different faces", .half_edge.index(), .next.index())]
    LoopFaceDiffers {
        /// The half-edge.
        half_edge: HalfEdgeId,
        /// The one after it.
        next: HalfEdgeId,
    },
    /// The half-edge that a face knows has another face.
    #[error("face {} knows half-edge {}, which is not its own", .face.index(), .half_edge.index())]
    SideOfOtherFace {
        /// The face.
        face: FaceId,
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// A half-edge has a face whose loop it is not on.
    #[error("half-edge {} is not on the loop of its face {}", .half_edge.index(), .face.index())]
    SecondLoop {
        /// The face.
        face: FaceId,
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// A half-edge does not end where the next one starts.
    #[error("half-edge {} does not end where the next, {}, starts", .half_edge.index(), .next.index())]
    OriginNotDestination {
        /// The half-edge.
        half_edge: HalfEdgeId,
        /// The one after it.
        next: HalfEdgeId,
    },
    /// A half-edge ends where it starts.
    #[error("half-edge {} starts and ends at vertex {}", .half_edge.index(), .vertex.index())]
    EdgeWithOneEnd {
        /// The half-edge.
        half_edge: HalfEdgeId,
        /// The vertex.
        vertex: VertexId,
    },
    /// A half-edge starts at a vertex that knows none.
    #[error("half-edge {} starts at vertex {}, which knows no half-edge", .half_edge.index(), .vertex.index())]
    NoLeaving {
        /// The vertex.
        vertex: VertexId,
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// The half-edge that a vertex knows starts elsewhere.
    #[error("vertex {} knows half-edge {}, which starts elsewhere", .vertex.index(), .half_edge.index())]
    LeavingStartsElsewhere {
        /// The vertex.
        vertex: VertexId,
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// A vertex on a boundary knows a half-edge with a face.
    #[error("vertex {} does not know its boundary half-edge {}", .vertex.index(), .boundary.index())]
    LeavingNotBoundary {
        /// The vertex.
        vertex: VertexId,
        /// The half-edge without a face that leaves it.
        boundary: HalfEdgeId,
    },
    /// A half-edge starts at a vertex and is not reached from the one that the vertex knows.
    #[error("half-edge {} is in a second fan of vertex {}", .half_edge.index(), .vertex.index())]
    SecondFan {
        /// The vertex.
        vertex: VertexId,
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// Two edges have the same ends.
    #[error("half-edges {} and {} have the same ends", .half_edges[0].index(), .half_edges[1].index())]
    EdgeTwice {
        /// A half-edge of each, in the same direction.
        half_edges: [HalfEdgeId; 2],
    },
    /// Both sides of an edge are empty.
    #[error("the edge of half-edge {} has no face", .half_edge.index())]
    EdgeWithoutFace {
        /// The smaller of its half-edges.
        half_edge: HalfEdgeId,
    },
    /// A face has a vertex at two of its corners.
    #[error("face {} has vertex {} twice", .face.index(), .vertex.index())]
    RepeatedVertex {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// The mesh is said to be closed, and a half-edge has no face.
    #[error("half-edge {} is on a boundary of a closed mesh", .half_edge.index())]
    BoundaryOfClosed {
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// The mesh is said to be triangular, and a face is not a triangle. Also reported for faces with fewer than three
    /// sides, whatever is said.
    #[error("face {} has {sides} sides", .face.index())]
    WrongSides {
        /// The face.
        face: FaceId,
        /// How many sides it has.
        sides: usize,
    },
    /// The Euler characteristic is not the one that is said.
    #[error("the Euler characteristic is {is}, not {claimed}")]
    Euler {
        /// What it is.
        is: i64,
        /// What it is said to be.
        claimed: i64,
    },
}
