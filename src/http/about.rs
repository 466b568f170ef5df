//! What the service says about itself.

use axum::extract::Request;
use axum::http::header;
use axum::response::IntoResponse as _;

use super::answer::json_answer;
use super::problem::Handled;
use super::query;
use super::representation::json_only;
use super::state::State;
use crate::wire::{self, ErrorInfo, FormatInfo, Limits, PolicyInfo, Version};

/// List the problems there are.
#[utoipa::path(get, path = "/v1/errors", operation_id = "list_errors", tag = "service",
    responses((status = 200, description = "Every stable code, with its status and what to do.", body = Vec<ErrorInfo>)))]
pub(super) async fn errors(request: Request) -> Handled {
    json(&request, &wire::errors())
}

/// Show the limits.
#[utoipa::path(get, path = "/v1/limits", operation_id = "get_limits", tag = "service",
    responses((status = 200, description = "Every limit, under the name that problems use.", body = Limits)))]
pub(super) async fn limits(state: State, request: Request) -> Handled {
    json(&request, &state.limits())
}

/// List the formats.
#[utoipa::path(get, path = "/v1/formats", operation_id = "list_formats", tag = "service",
    responses((status = 200, description = "Every format, with its media types.", body = Vec<FormatInfo>)))]
pub(super) async fn formats(request: Request) -> Handled {
    json(&request, &wire::formats())
}

/// List the printing policies.
///
/// The limits of each process that the option `policy` names, in millimetres and degrees, with where they are from.
#[utoipa::path(get, path = "/v1/policies", operation_id = "list_policies", tag = "service",
    responses((status = 200, description = "Every policy, with every limit.", body = Vec<PolicyInfo>)))]
pub(super) async fn policies(request: Request) -> Handled {
    json(&request, &wire::policies())
}

/// Show the version.
#[utoipa::path(get, path = "/v1/version", operation_id = "get_version", tag = "service",
    responses((status = 200, description = "The version that runs.", body = Version)))]
pub(super) async fn version(request: Request) -> Handled {
    json(&request, &Version::current())
}

fn json(request: &Request, value: &impl serde::Serialize) -> Handled {
    json_only(request.headers())?;
    query::none(request.uri())?;
    Ok(json_answer(value))
}

/// This contract.
#[utoipa::path(get, path = "/openapi.yaml", operation_id = "get_openapi_yaml", tag = "service",
    responses((status = 200, description = "The contract, generated from routes and types.", content_type = "application/yaml", body = Object)))]
pub(super) async fn openapi(state: State) -> Handled {
    Ok(([(header::CONTENT_TYPE, "application/yaml")], state.openapi.clone()).into_response())
}

/// This contract as JSON.
#[utoipa::path(get, path = "/openapi.json", operation_id = "get_openapi_json", tag = "service",
    responses((status = 200, description = "The contract, generated from routes and types.", content_type = "application/json", body = Object)))]
pub(super) async fn openapi_json(state: State) -> Handled {
    Ok(([(header::CONTENT_TYPE, "application/json")], state.openapi_json.clone()).into_response())
}
