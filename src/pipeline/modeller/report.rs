//! What the modeller found, did and refused. Lengths and places are in the unit of the result.

use crate::geom::DVec3;
use crate::mesh::polyhedron::{FaceId, VertexId};
use crate::modeller::{self, Conflict, ImportRefusal, Solid, Validity};

use super::choices::EditKind;

/// What the modeller found and did.
#[derive(Debug, Clone, PartialEq)]
pub struct ModellerReport {
    /// The polyhedron as it was read, checked as a whole.
    pub validity: Validity,
    /// Within which distance of one plane neighbours were one face; 0: exactly.
    pub tolerance: f64,
    /// Faces that were joined within the tolerance, not exactly.
    pub tolerant_faces: usize,
    /// Vertices that moved onto their planes.
    pub vertices_moved: usize,
    /// The largest of these moves.
    pub move_max: f64,
    /// The operators that were applied.
    pub steps: Vec<ModellerStep>,
    /// The intervals that were asked for.
    pub ranges: Vec<FaceRange>,
    /// The faces, when they were asked for.
    pub faces: Vec<ModelFace>,
    /// The largest move by which a vertex was rounded to float32; `None` when nothing was written.
    pub rounded_by: Option<f64>,
}

/// A face of the polyhedron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelFace {
    /// Its number.
    pub face: u32,
    /// The unit normal, outward.
    pub normal: DVec3,
    /// The distance of its plane from the origin along the normal.
    pub distance: f64,
    /// Sides of all its loops.
    pub sides: usize,
    /// Interior loops.
    pub interior_loops: usize,
    /// One of its corners.
    pub corner: DVec3,
}

/// An operator that was applied.
#[derive(Debug, Clone, PartialEq)]
pub struct ModellerStep {
    /// Which.
    pub operator: EditKind,
    /// The faces that moved and how far outward.
    pub moved: Vec<(u32, f64)>,
    /// Edges that became vertices.
    pub merged: usize,
    /// Vertices that became edges.
    pub split: usize,
    /// The whole solid after it.
    pub validity: Validity,
    /// The shifts that lead back to the same planes and topology, and whether they pass events; `None` when no single
    /// shift does.
    pub undo: Option<(Vec<(u32, f64)>, bool)>,
}

/// By how much faces may move together.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceRange {
    /// The faces and their speeds outward.
    pub faces: Vec<(u32, f64)>,
    /// The unit normal of the first.
    pub normal: DVec3,
    /// Against these speeds, then with them.
    pub sides: [RangeSide; 2],
}

/// One side of an open interval.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeSide {
    /// How far a face of speed 1 may move, never beyond the true limit; `None`: no limit.
    pub limit: Option<f64>,
    /// What would meet there.
    pub blocking: Vec<Blocker>,
}

/// How elements would meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BlockerKind {
    /// An edge would lose its length.
    EdgeVanishes,
    /// A vertex would reach a face.
    VertexFace,
    /// Two edges would cross.
    EdgeEdge,
    /// Two loops of a face would touch.
    LoopLoop,
    /// A vertex of more than three faces has no good split in this direction.
    NoSplit,
}

/// Elements that are in the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocker {
    /// How they would meet.
    pub kind: BlockerKind,
    /// Their faces.
    pub faces: Vec<u32>,
    /// Where their vertices are before the move.
    pub places: Vec<DVec3>,
}

impl Blocker {
    pub(super) fn of(solid: &Solid, contact: &Conflict) -> Self {
        let (kind, faces, vertices) = match contact {
            Conflict::EdgeVanishes { faces, vertices } => {
                (BlockerKind::EdgeVanishes, faces.to_vec(), vertices.to_vec())
            }
            Conflict::VertexFace { vertex, face } => (BlockerKind::VertexFace, vec![*face], vec![*vertex]),
            Conflict::EdgeEdge { first, second } => {
                (BlockerKind::EdgeEdge, [*first, *second].concat(), Vec::new())
            }
            Conflict::LoopLoop { face, vertex } => (BlockerKind::LoopLoop, vec![*face], vec![*vertex]),
        };
        Self::with(solid, kind, &faces, &vertices)
    }

    pub(super) fn with(solid: &Solid, kind: BlockerKind, faces: &[FaceId], vertices: &[VertexId]) -> Self {
        // A vertex that a split would have made is not there yet.
        let topology = solid.topology();
        let is_there = |v: &&VertexId| v.index() < topology.vertex_bound() && topology.leaving(**v).is_some();
        Self {
            kind,
            faces: numbers(faces),
            places: vertices.iter().filter(is_there).map(|v| solid.point(*v).rounded()).collect(),
        }
    }
}

pub(super) fn numbers(faces: &[FaceId]) -> Vec<u32> {
    faces.iter().map(|f| f.index() as u32).collect()
}

/// Why a name names nothing that can be edited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameFault {
    /// There is no face of this number.
    NoFace(u32),
    /// The polyhedron has no face.
    NoFaces,
    /// A normal is zero.
    NoNormal,
    /// A ray has no direction.
    NoDirection,
    /// A ray meets no face from outside.
    RayMisses,
    /// The two faces have no edge in common.
    NoEdge([u32; 2]),
    /// The polyhedron has no vertex.
    NoVertex,
    /// One face is named twice.
    FaceTwice(u32),
    /// An operator is named that takes back and does nothing by itself.
    NoOperator,
}

/// Why the modeller has no result.
#[derive(Debug, Clone, PartialEq)]
pub enum ModellerRefusal {
    /// The triangles are no polyhedron.
    Import(ImportRefusal),
    /// A name that names nothing.
    Name {
        /// Which operator; `None`: one of the ranges.
        operator: Option<usize>,
        /// What is wrong with it.
        fault: NameFault,
    },
    /// There is no operator left to take back.
    NothingToUndo {
        /// Which operator asks for it.
        operator: usize,
    },
    /// An operator was refused.
    Operator {
        /// Which.
        operator: usize,
        /// Why.
        reason: modeller::OperatorRefusal,
        /// The distances of the limit, by face, where there is one.
        limits: Vec<(u32, f64)>,
        /// What would meet there.
        blocking: Vec<Blocker>,
    },
    /// The polyhedron cannot be rounded to float32.
    Export(modeller::ExportRefusal),
    /// It has no dual.
    Dual(modeller::DualRefusal),
}
