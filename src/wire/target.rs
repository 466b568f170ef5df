//! Targets of a simplification, as a list of options says them: `{"faces":N}`, `{"ratio":X}` or `{"error_mm":X}`.

use serde::{Deserialize, Serialize};
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{AdditionalProperties, ObjectBuilder, OneOfBuilder, Schema, Type};
use utoipa::{PartialSchema, ToSchema};

use super::whole_number::whole;
use crate::simplify;

/// Most targets of one run.
const TARGETS_MAX: usize = 16;

/// How far to simplify.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TargetSpec {
    /// To at most this many triangles.
    Faces(#[serde(deserialize_with = "whole")] u32),
    /// To at most this share of the triangles, from 0 to 1.
    Ratio(f64),
    /// As far as no collapse has an error above this, in millimetres.
    ErrorMm(f64),
}

impl TargetSpec {
    fn is_valid(self) -> bool {
        match self {
            Self::Faces(count) => count > 0,
            Self::Ratio(ratio) => (0.0..=1.0).contains(&ratio),
            Self::ErrorMm(error) => (0.0..=1e30).contains(&error),
        }
    }

    /// The engine's target; `millimetres`: length of the unit of the file.
    pub(super) fn to_engine(self, millimetres: f64) -> simplify::Target {
        match self {
            Self::Faces(count) => simplify::Target::Faces(count as usize),
            Self::Ratio(ratio) => simplify::Target::Ratio(ratio),
            Self::ErrorMm(error) => simplify::Target::Error(error / millimetres),
        }
    }

    /// The public form of the engine's target; `millimetres`: length of the unit of the file.
    pub(super) fn of(target: simplify::Target, millimetres: f64) -> Self {
        match target {
            simplify::Target::Faces(count) => Self::Faces(count as u32),
            simplify::Target::Ratio(ratio) => Self::Ratio(ratio),
            simplify::Target::Error(error) => Self::ErrorMm(error * millimetres),
        }
    }
}

impl PartialSchema for TargetSpec {
    fn schema() -> RefOr<Schema> {
        let number = |kind| ObjectBuilder::new().schema_type(kind);
        let one = |name: &str, value: ObjectBuilder, about: &str| {
            ObjectBuilder::new()
                .schema_type(Type::Object)
                .property(name, value.description(Some(about)))
                .required(name)
                .additional_properties(Some(AdditionalProperties::FreeForm(false)))
        };
        let faces = number(Type::Integer).minimum(Some(1)).maximum(Some(u32::MAX));
        let ratio = number(Type::Number).minimum(Some(0)).maximum(Some(1));
        let error = number(Type::Number).minimum(Some(0)).maximum(Some(1e30));
        let targets = OneOfBuilder::new()
            .description(Some("How far to simplify: one member."))
            .item(one("faces", faces, "To at most this many triangles."))
            .item(one("ratio", ratio, "To at most this share of the triangles."))
            .item(one("error_mm", error, "As far as no collapse has an error above this, in millimetres."));
        RefOr::T(Schema::OneOf(targets.build()))
    }
}

impl ToSchema for TargetSpec {}

/// The targets of a JSON list; `None` when it is no such list.
pub(super) fn targets_from_json(text: &str) -> Option<Vec<TargetSpec>> {
    let targets: Vec<TargetSpec> = serde_json::from_str(text).ok()?;
    let is_valid =
        (1..=TARGETS_MAX).contains(&targets.len()) && targets.iter().all(|target| target.is_valid());
    is_valid.then_some(targets)
}
