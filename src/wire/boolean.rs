//! Why solids cannot be combined, in sentences.

use super::words::ReasonCode;
use crate::pipeline::{BooleanRefusal, NotCombined, NotSolid, SetOperation};

/// The kind of reason, and the reason in a sentence.
pub(super) fn told(refusal: &BooleanRefusal) -> (ReasonCode, String) {
    match refusal.reason {
        NotCombined::NotSolid { input, why } => {
            let why = match why {
                NotSolid::Open { edges } => {
                    format!(
                        "its surface is not closed along {edges} edges, counted where the meshes divide each other"
                    )
                }
                NotSolid::InsideOut => "it is inside out, as a whole or in parts".to_owned(),
                NotSolid::Flat => "it has no inside".to_owned(),
            };
            let message = format!("mesh {} is no closed solid: {why}; repair it first", input + 1);
            (ReasonCode::InputNotSolid, message)
        }
        NotCombined::Empty => {
            let why = match refusal.operation {
                SetOperation::Difference => "the other meshes cover the first one",
                SetOperation::Intersection => "the meshes have no volume in common",
                SetOperation::Union => "the meshes have no volume",
            };
            (ReasonCode::EmptyResult, format!("the {} is empty: {why}", refusal.operation.name()))
        }
        NotCombined::TooManyPairs { count, limit } => {
            let message = format!("{count} or more pairs of triangles meet, and {limit} at most are divided");
            (ReasonCode::NotCombined, message)
        }
        NotCombined::TooManyCrossings { limit } => {
            let message = format!("triangles cross each other inside of others at more than {limit} points");
            (ReasonCode::NotCombined, message)
        }
        NotCombined::BeyondFloat32 => {
            (ReasonCode::NotRepresentable, "the coordinates are beyond those of float32".to_owned())
        }
        NotCombined::Fault(fault) => {
            (ReasonCode::NotCombined, format!("the meshes could not be divided, which is our error: {fault}"))
        }
        // A run that is stopped has no report.
        NotCombined::Stopped(stopped) => (ReasonCode::NotCombined, stopped.to_string()),
    }
}
