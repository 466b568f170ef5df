//! The six tests of vertices, edges and faces against each other.

/// Which kinds of features meet or are near each other, lowest dimension first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ProximityTest {
    /// Two vertices.
    VertexVertex,
    /// A vertex and an edge.
    VertexEdge,
    /// A vertex and a face.
    VertexFace,
    /// Two edges.
    EdgeEdge,
    /// An edge and a face.
    EdgeFace,
    /// Two faces.
    FaceFace,
}
