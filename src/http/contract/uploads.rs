//! What the contract says of uploads that come before their job.

use utoipa::openapi::path::{Operation, Parameter};
use utoipa::openapi::request_body::RequestBodyBuilder;
use utoipa::openapi::schema::{ObjectBuilder, Type};
use utoipa::openapi::{Content, RefOr, Required};

use super::{JOB, add_parameter, add_problems, binary, header_parameter, text};
use crate::wire::ProblemCode;

/// Problems of bytes that come in.
const BYTES: &[ProblemCode] = &[
    ProblemCode::BodyIncomplete,
    ProblemCode::UploadTimeout,
    ProblemCode::BodyTooLarge,
    ProblemCode::Draining,
    ProblemCode::StoreUnavailable,
    ProblemCode::StorageFull,
];

/// Adds what the handlers of uploads share.
pub(super) fn complete(id: &str, operation: &mut Operation) {
    if id == "create_presigned_upload" {
        return add_problems(operation, &[BYTES, &[ProblemCode::PresignedRefused]].concat());
    }
    add_parameter(operation, version());
    add_problems(operation, &[ProblemCode::UnsupportedVersion, ProblemCode::StoreUnavailable]);
    match id {
        "create_upload" => {
            add_parameter(operation, required(bytes("Upload-Length", "Bytes that the upload is to have.")));
            let pairs = text().pattern(Some("^(filename ([A-Za-z0-9+/]{4}){1,16})?$"));
            let about =
                "Pairs of a name and a value in base64, with commas in between; `filename` names the file.";
            add_parameter(operation, header_parameter("Upload-Metadata", about, pairs));
            add_problems(operation, BYTES);
            operation.request_body = Some(RefOr::T(body(Required::False)));
        }
        "append_to_upload" => {
            add_parameter(operation, required(bytes("Upload-Offset", "Where the upload stands.")));
            add_problems(operation, &[JOB, BYTES, &[ProblemCode::UploadConflict]].concat());
            operation.request_body = Some(RefOr::T(body(Required::True)));
        }
        _ => add_problems(operation, JOB),
    }
}

fn version() -> Parameter {
    let version = text().enum_values(Some(["1.0.0"]));
    required(header_parameter("Tus-Resumable", "The version of the protocol.", version))
}

fn bytes(name: &str, about: &str) -> Parameter {
    header_parameter(name, about, ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0)))
}

fn required(mut parameter: Parameter) -> Parameter {
    parameter.required = Required::True;
    parameter
}

fn body(required: Required) -> utoipa::openapi::request_body::RequestBody {
    RequestBodyBuilder::new()
        .description(Some("Bytes of the upload."))
        .required(Some(required))
        .content("application/offset+octet-stream", Content::new(Some(binary())))
        .build()
}
