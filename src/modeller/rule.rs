//! The rules that a valid solid keeps.

use crate::mesh::polyhedron::{FaceId, VertexId};

/// A rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Rule {
    /// Half-edges, loops and fans are sound: every edge has two faces, so the surface is closed, manifold and without
    /// border.
    Closed,
    /// Each vertex is the one point of the planes of all its faces.
    Vertices,
    /// Each edge has two different ends and two planes that are not parallel.
    Edges,
    /// The loops of a face do not touch themselves.
    LoopsSimple,
    /// The loops of a face do not touch each other, and the interior ones lie inside the exterior one.
    LoopsNested,
    /// The exterior loop of a face turns counter-clockwise around its normal, the interior ones clockwise.
    Orientation,
    /// V - E + F - R = 2 (S - H) has a whole solution H that is not negative.
    Euler,
    /// No face meets another but in common vertices and edges.
    Disjoint,
    /// One shell points outward, and all others bound cavities inside it.
    OneVolume,
}

impl Rule {
    /// All rules, in the order in which they are checked.
    pub const ALL: [Self; 9] = [
        Self::Closed,
        Self::Vertices,
        Self::Edges,
        Self::LoopsSimple,
        Self::LoopsNested,
        Self::Orientation,
        Self::Euler,
        Self::Disjoint,
        Self::OneVolume,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closed => "closed",
            Self::Vertices => "vertices",
            Self::Edges => "edges",
            Self::LoopsSimple => "loops-simple",
            Self::LoopsNested => "loops-nested",
            Self::Orientation => "orientation",
            Self::Euler => "euler",
            Self::Disjoint => "disjoint",
            Self::OneVolume => "one-volume",
        }
    }
}

/// A broken rule, with the first elements that show it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BrokenRule {
    /// The rule.
    pub rule: Rule,
    /// Faces that show it.
    pub faces: Vec<FaceId>,
    /// Vertices that show it.
    pub vertices: Vec<VertexId>,
}
