//! The modeller in the public words: operators and names that come in, what was found and done that goes out.

mod blocker;
mod names;
mod operators;
mod refusal;
mod report;
mod words;

pub use blocker::{Blocker, MovedFace};
pub use names::{EdgeRef, FaceByNormal, FaceByRay, FaceRef, Length, PickingRay, Vector};
pub use operators::{
    EditSpec, FaceMove, FaceRate, FlipSpec, MergeSpec, RangeSpec, ShiftSpec, SplitSpec, TogetherSpec,
    UndoSpec,
};
pub(in crate::wire) use operators::{edits_from_json, edits_schema, ranges_from_json, ranges_schema};
pub use refusal::RefusedOperator;
pub(in crate::wire) use refusal::sentence;
pub use report::{FaceInfo, FaceRangeInfo, FaceSpeed, ModelValidity, Modeller, ModellerStep, RangeSideInfo};
pub use words::{BlockerKind, DualEmbedding, EditKind, ModelRule, OperatorReason};
