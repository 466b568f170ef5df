//! What the modeller found and did.

use serde::Serialize;
use utoipa::ToSchema;

use super::blocker::{Blocker, MovedFace};
use super::names::{FaceRef, Length};
use super::operators::{EditSpec, FaceMove, ShiftSpec};
use super::refusal::RefusedOperator;
use super::words::{EditKind, ModelRule};
use crate::modeller::Validity;
use crate::pipeline;
use crate::wire::finite::finite;

/// What the modeller found and did.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Modeller {
    /// The polyhedron as it was read; null: the mesh could not be read as one.
    #[schema(required)]
    pub polyhedron: Option<ModelValidity>,
    /// Within which distance of one plane neighbours were one face, in the unit of the file; 0: exactly.
    pub tolerance: f64,
    /// Faces that were joined within the tolerance and not exactly.
    pub tolerant_faces: u64,
    /// Vertices that moved onto the planes of their faces.
    pub vertices_moved: u64,
    /// The largest of these moves, in the unit of the file.
    pub move_max: f64,
    /// The operators that were applied, in their order.
    pub steps: Vec<ModellerStep>,
    /// The operator that was refused; null: none was.
    #[schema(required)]
    pub refused: Option<RefusedOperator>,
    /// The intervals that `ranges` asked for, in its order.
    pub ranges: Vec<FaceRangeInfo>,
    /// The faces after the operators, when `list_faces` asks for them.
    pub faces: Vec<FaceInfo>,
    /// The largest move by which a vertex was rounded to float32, in the unit of the file; null: nothing was written.
    #[schema(required)]
    pub rounded_by: Option<f64>,
}

/// The check of a whole polyhedron.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct ModelValidity {
    /// No rule is broken.
    pub is_valid: bool,
    /// The rules that are broken.
    pub broken: Vec<ModelRule>,
    /// Vertices, V.
    pub vertices: u64,
    /// Edges, E.
    pub edges: u64,
    /// Faces, F.
    pub faces: u64,
    /// Interior loops, R.
    pub interior_loops: u64,
    /// Shells, S.
    pub shells: u64,
    /// Through-holes, H of V - E + F - R = 2 (S - H); null: there is no such number.
    #[schema(required)]
    pub through_holes: Option<u64>,
}

/// A face of the polyhedron.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FaceInfo {
    /// Its number.
    pub face: u32,
    /// Its unit normal, outward.
    pub normal: [f64; 3],
    /// The distance of its plane from the origin along the normal, in the unit of the file.
    pub distance: f64,
    /// Sides of all its loops.
    pub sides: u64,
    /// Interior loops.
    pub interior_loops: u64,
    /// One of its corners, in the unit of the file.
    pub corner: [f64; 3],
}

/// An operator that was applied.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct ModellerStep {
    /// Which.
    pub operator: EditKind,
    /// The faces that moved.
    pub moved: Vec<MovedFace>,
    /// Edges that became vertices.
    pub merged: u64,
    /// Vertices that became edges.
    pub split: u64,
    /// The whole polyhedron after it.
    pub validity: ModelValidity,
    /// The operator that leads back to the same planes and topology, tried before it is told; null: no single one does,
    /// and `{"undo":{}}` after it takes it back.
    #[schema(required)]
    pub undo: Option<EditSpec>,
}

/// By how much faces may move together without an event: an open interval.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FaceRangeInfo {
    /// The faces and their speeds.
    pub faces: Vec<FaceSpeed>,
    /// The unit normal of the first of them.
    pub normal: [f64; 3],
    /// Against their speeds: a single face inward.
    pub inward: RangeSideInfo,
    /// With their speeds: a single face outward.
    pub outward: RangeSideInfo,
}

/// A face and its speed.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FaceSpeed {
    /// The face.
    pub face: u32,
    /// Its speed outward.
    pub rate: f64,
}

/// One side of an interval.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct RangeSideInfo {
    /// By less than this, in millimetres, negative inward, for a face of speed 1; null: as far as one likes.
    #[schema(required)]
    pub limit_mm: Option<f64>,
    /// What is in the way there.
    pub blocking: Vec<Blocker>,
}

impl From<&Validity> for ModelValidity {
    fn from(inner: &Validity) -> Self {
        Self {
            is_valid: inner.is_valid(),
            broken: inner.faults.iter().map(|f| f.rule.into()).collect(),
            vertices: inner.counts.vertices as u64,
            edges: inner.counts.edges as u64,
            faces: inner.counts.faces as u64,
            interior_loops: inner.counts.interior_loops as u64,
            shells: inner.counts.shells as u64,
            through_holes: inner.genus.map(|h| h as u64),
        }
    }
}

impl Modeller {
    /// The public form, lengths of edits in millimetres; none when the modeller was not asked.
    pub(in crate::wire) fn of(inner: &pipeline::Report, millimetres: f64) -> Option<Self> {
        let refusal = match &inner.refusal {
            Some(pipeline::Refusal::Modeller { reason, .. }) => Some(&**reason),
            _ => None,
        };
        if inner.modeller.is_none() && refusal.is_none() {
            return None;
        }
        let told = inner.modeller.as_deref();
        let steps = told.map_or(&[][..], |m| &m.steps);
        let ranges = told.map_or(&[][..], |m| &m.ranges);
        let faces = told.map_or(&[][..], |m| &m.faces);
        Some(Self {
            polyhedron: told.map(|m| ModelValidity::from(&m.validity)),
            tolerance: told.map_or(0.0, |m| m.tolerance),
            tolerant_faces: told.map_or(0, |m| m.tolerant_faces as u64),
            vertices_moved: told.map_or(0, |m| m.vertices_moved as u64),
            move_max: told.map_or(0.0, |m| m.move_max),
            steps: steps.iter().map(|step| ModellerStep::of(step, millimetres)).collect(),
            refused: refusal.and_then(|r| RefusedOperator::of(r, millimetres)),
            ranges: ranges.iter().map(|range| FaceRangeInfo::of(range, millimetres)).collect(),
            faces: faces.iter().map(FaceInfo::from).collect(),
            rounded_by: told.and_then(|m| finite(m.rounded_by?)),
        })
    }
}

impl From<&pipeline::ModelFace> for FaceInfo {
    fn from(inner: &pipeline::ModelFace) -> Self {
        Self {
            face: inner.face,
            normal: inner.normal.to_array(),
            distance: inner.distance,
            sides: inner.sides as u64,
            interior_loops: inner.interior_loops as u64,
            corner: inner.corner.to_array(),
        }
    }
}

impl ModellerStep {
    fn of(inner: &pipeline::ModellerStep, millimetres: f64) -> Self {
        let undo = inner.undo.as_ref().map(|(faces, passes)| {
            let back = |&(face, by): &(u32, f64)| FaceMove {
                face: FaceRef::Id(face),
                by_mm: Length(by * millimetres),
            };
            EditSpec::Shift(ShiftSpec { faces: faces.iter().map(back).collect(), pass_events: *passes })
        });
        Self {
            operator: inner.operator.into(),
            moved: inner.moved.iter().map(|m| MovedFace::of(*m, millimetres)).collect(),
            merged: inner.merged as u64,
            split: inner.split as u64,
            validity: ModelValidity::from(&inner.validity),
            undo,
        }
    }
}

impl FaceRangeInfo {
    fn of(inner: &pipeline::FaceRange, millimetres: f64) -> Self {
        let side = |side: &pipeline::RangeSide| RangeSideInfo {
            limit_mm: side.limit.and_then(|limit| finite(limit * millimetres)),
            blocking: side.blocking.iter().map(Blocker::from).collect(),
        };
        Self {
            faces: inner.faces.iter().map(|&(face, rate)| FaceSpeed { face, rate }).collect(),
            normal: inner.normal.to_array(),
            inward: side(&inner.sides[0]),
            outward: side(&inner.sides[1]),
        }
    }
}
