//! Where a mesh comes from that is not in the request.

use serde::{Deserialize, Serialize};
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{AdditionalProperties, ObjectBuilder, Schema, Type};
use utoipa::{PartialSchema, ToSchema};

/// Where a mesh comes from that is not in the request.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum InputRef {
    /// Id of an earlier job, whose upload is used again.
    Job(String),
    /// Id of an upload that was made beforehand.
    Upload(String),
}

impl PartialSchema for InputRef {
    fn schema() -> RefOr<Schema> {
        let id = |about: &str| ObjectBuilder::new().schema_type(Type::String).description(Some(about));
        let object = ObjectBuilder::new()
            .schema_type(Type::Object)
            .description(Some("Where a mesh comes from that is not in the request: exactly one of both."))
            .additional_properties(Some(AdditionalProperties::FreeForm(false)))
            .property("job", id("Id of an earlier job, whose upload is used again."))
            .property("upload", id("Id of an upload that was made beforehand at `/v1/uploads`."))
            .min_properties(Some(1))
            .max_properties(Some(1));
        RefOr::T(Schema::Object(object.build()))
    }
}

impl ToSchema for InputRef {}
