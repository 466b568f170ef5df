//! What the modeller is asked to do. Lengths and places are in the unit of the result, but the tolerance in that of the file.

use crate::geom::DVec3;
use crate::modeller::{Embedding, EventPolicy};

/// What the modeller is to do.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModellerChoices {
    /// The operators, one after the other.
    pub operators: Vec<Edit>,
    /// Faces whose allowed intervals are told, after the operators.
    pub ranges: Vec<RangeName>,
    /// Within which distance of one plane neighbours are one face, in the unit of the file; `None`: eight float32 steps at the
    /// largest coordinate.
    pub tolerance: Option<f64>,
    /// Tell the faces with their numbers, after the operators.
    pub lists_faces: bool,
    /// Return the dual instead of the polyhedron.
    pub dual: Option<Embedding>,
    /// Take the middle of the box around the polyhedron as the origin of the dual.
    pub is_dual_recentered: bool,
    /// Write faces as polygons where the format has them and every reader splits them alike.
    pub writes_polygons: bool,
}

/// A face, by what a caller knows of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FaceName {
    /// Its number in the report.
    Id(u32),
    /// The one with the nearest normal, and of those the nearest to a place.
    Normal {
        /// The direction.
        normal: DVec3,
        /// The place.
        at: DVec3,
    },
    /// The first that a ray meets from outside.
    Ray {
        /// Where the ray starts.
        from: DVec3,
        /// Where it goes.
        direction: DVec3,
    },
}

/// Faces that move together, each with its speed outward.
pub type RangeName = Vec<(FaceName, f64)>;

/// An edge, by the faces beside it and a place near it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeName {
    /// The faces.
    pub faces: [FaceName; 2],
    /// Which of several.
    pub at: Option<DVec3>,
}

/// An operator in the caller's words; see [`Operator`](crate::modeller::Operator).
#[derive(Debug, Clone, PartialEq)]
pub enum Edit {
    /// Face Shift.
    Shift {
        /// Each face and how far it moves outward.
        faces: Vec<(FaceName, f64)>,
        /// Go on past events where that is good.
        events: EventPolicy,
    },
    /// Point Split.
    Split {
        /// A place near the vertex.
        at: DVec3,
        /// The face that moves.
        face: FaceName,
        /// How far it moves outward.
        by: f64,
    },
    /// Point Merge.
    Merge {
        /// The edge.
        edge: EdgeName,
        /// The face that moves.
        face: FaceName,
    },
    /// Edge Flip.
    Flip {
        /// The edge.
        edge: EdgeName,
        /// The face that moves.
        face: FaceName,
        /// How far it moves outward.
        by: Option<f64>,
    },
    /// The last operator that is not taken back is taken back: the same planes and topology as before it.
    Undo,
}

/// The kinds of operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EditKind {
    /// Faces move along their normals.
    Shift,
    /// A vertex becomes several.
    Split,
    /// An edge becomes a vertex.
    Merge,
    /// The faces at the ends of an edge become neighbours.
    Flip,
    /// The last operator is taken back.
    Undo,
}

impl Edit {
    /// Which operator it is.
    pub fn kind(&self) -> EditKind {
        match self {
            Self::Shift { .. } => EditKind::Shift,
            Self::Split { .. } => EditKind::Split,
            Self::Merge { .. } => EditKind::Merge,
            Self::Flip { .. } => EditKind::Flip,
            Self::Undo => EditKind::Undo,
        }
    }

    fn scaled(&self, factor: f64) -> Self {
        let face = |name: &FaceName| name.scaled(factor);
        match self {
            Self::Shift { faces, events } => Self::Shift {
                faces: faces.iter().map(|(name, by)| (face(name), by * factor)).collect(),
                events: *events,
            },
            Self::Split { at, face: name, by } => {
                Self::Split { at: *at * factor, face: face(name), by: by * factor }
            }
            Self::Merge { edge, face: name } => Self::Merge { edge: edge.scaled(factor), face: face(name) },
            Self::Flip { edge, face: name, by } => {
                Self::Flip { edge: edge.scaled(factor), face: face(name), by: by.map(|by| by * factor) }
            }
            Self::Undo => Self::Undo,
        }
    }
}

impl FaceName {
    fn scaled(&self, factor: f64) -> Self {
        match *self {
            Self::Id(id) => Self::Id(id),
            Self::Normal { normal, at } => Self::Normal { normal, at: at * factor },
            Self::Ray { from, direction } => Self::Ray { from: from * factor, direction },
        }
    }
}

impl EdgeName {
    fn scaled(&self, factor: f64) -> Self {
        Self { faces: self.faces.map(|name| name.scaled(factor)), at: self.at.map(|at| at * factor) }
    }
}

impl ModellerChoices {
    /// The same for a mesh that is so many times as large.
    pub(in crate::pipeline) fn scaled(&self, factor: f64) -> Self {
        let range =
            |range: &RangeName| range.iter().map(|(name, rate)| (name.scaled(factor), *rate)).collect();
        Self {
            operators: self.operators.iter().map(|edit| edit.scaled(factor)).collect(),
            ranges: self.ranges.iter().map(range).collect(),
            tolerance: self.tolerance.map(|length| length * factor),
            ..self.clone()
        }
    }
}
