//! The public words of the modeller.

use crate::wire::words::{mirror, words};
use crate::{modeller, pipeline};

mirror! { modeller::Embedding =>
    /// Where the dual has the vertex of a face with the plane n . x = d.
    DualEmbedding {
        /// n / d, the pole; exact.
        Polar = "polar",
        /// n (d + 1), with a unit normal.
        OffsetNormal = "offset-normal",
        /// n d / n.n, the foot of the origin.
        Foot = "foot",
        /// The centroid of the area of the face.
        Centroid = "centroid",
    }
}

mirror! { pipeline::EditKind =>
    /// An operator.
    EditKind {
        /// Faces move along their normals.
        Shift = "shift",
        /// A vertex becomes several.
        Split = "split",
        /// An edge becomes a vertex.
        Merge = "merge",
        /// The faces at the ends of an edge become neighbours.
        Flip = "flip",
        /// The last operator is taken back.
        Undo = "undo",
    }
}

mirror! { modeller::Rule =>
    /// A rule that a valid polyhedron keeps.
    ModelRule {
        /// Every edge has two faces: the surface is closed, manifold and without border.
        Closed = "closed",
        /// Each vertex is the one point of the planes of all its faces.
        Vertices = "vertices",
        /// Each edge has two different ends and two planes that are not parallel.
        Edges = "edges",
        /// The loops of a face do not touch themselves.
        LoopsSimple = "loops-simple",
        /// The loops of a face do not touch each other, and the interior ones lie inside the exterior one.
        LoopsNested = "loops-nested",
        /// Exterior loops turn counter-clockwise around the normal, interior ones clockwise.
        Orientation = "orientation",
        /// V - E + F - R = 2 (S - H) has a whole solution H that is not negative.
        Euler = "euler",
        /// No face meets another but in common vertices and edges.
        Disjoint = "disjoint",
        /// One shell points outward, and all others bound cavities inside it.
        OneVolume = "one-volume",
    }
}

mirror! { pipeline::BlockerKind =>
    /// How elements would meet.
    BlockerKind {
        /// An edge would lose its length.
        EdgeVanishes = "edge-vanishes",
        /// A vertex would reach a face.
        VertexFace = "vertex-face",
        /// Two edges would cross.
        EdgeEdge = "edge-edge",
        /// Two loops of a face would touch.
        LoopLoop = "loop-loop",
        /// A vertex of more than three faces has no good split in this direction.
        NoSplit = "no-split",
    }
}

words! {
    /// Why an operator is refused.
    OperatorReason {
        /// No face moves.
        NothingMoves = "nothing-moves",
        /// An event is in the way.
        Limit = "limit",
        /// No split of a vertex opens every new edge and keeps its faces apart.
        NoSplit = "no-split",
        /// A face would shrink to a segment or a point.
        FaceVanishes = "face-vanishes",
        /// A face would touch itself at the merged vertex.
        LinkNotADisk = "link-not-a-disk",
        /// The vertex has three faces only.
        VertexIsTrihedral = "vertex-is-trihedral",
        /// The face is not at the vertex, or moves no end of the edge.
        NotThere = "not-there",
        /// The edge never loses its length, however far the face moves.
        EdgeStays = "edge-stays",
        /// The faces at both ends of the edge are one face.
        EndsAreOneFace = "ends-are-one-face",
        /// The faces at both ends of the edge have an edge there already.
        EndsAreNeighbours = "ends-are-neighbours",
        /// A face beside the edge has three sides, which vanish together: a merge and no flip.
        FaceHasThreeSides = "face-has-three-sides",
        /// The flipped edge would have no positive length.
        DoesNotOpen = "does-not-open",
        /// Other edges lose their lengths at the same time.
        SeveralVanish = "several-vanish",
        /// More events than one operator passes.
        TooManyEvents = "too-many-events",
        /// A rule would be broken.
        Invalid = "invalid",
        /// It names an element that the polyhedron does not have.
        UnknownElement = "unknown-element",
        /// There is no operator left to take back.
        NothingToUndo = "nothing-to-undo",
    }
}

impl From<&modeller::OperatorRefusal> for OperatorReason {
    fn from(refusal: &modeller::OperatorRefusal) -> Self {
        use modeller::OperatorRefusal;
        match refusal {
            OperatorRefusal::NothingMoves => Self::NothingMoves,
            OperatorRefusal::Limit { .. } => Self::Limit,
            OperatorRefusal::NoSplit { .. } => Self::NoSplit,
            OperatorRefusal::FaceVanishes { .. } => Self::FaceVanishes,
            OperatorRefusal::LinkNotADisk { .. } => Self::LinkNotADisk,
            OperatorRefusal::VertexIsTrihedral { .. } => Self::VertexIsTrihedral,
            OperatorRefusal::NotThere { .. } => Self::NotThere,
            OperatorRefusal::EdgeStays => Self::EdgeStays,
            OperatorRefusal::EndsAreOneFace { .. } => Self::EndsAreOneFace,
            OperatorRefusal::EndsAreNeighbours { .. } => Self::EndsAreNeighbours,
            OperatorRefusal::FaceHasThreeSides { .. } => Self::FaceHasThreeSides,
            OperatorRefusal::DoesNotOpen { .. } => Self::DoesNotOpen,
            OperatorRefusal::SeveralVanish { .. } => Self::SeveralVanish,
            OperatorRefusal::TooManyEvents { .. } => Self::TooManyEvents,
            OperatorRefusal::Invalid(_) => Self::Invalid,
        }
    }
}
