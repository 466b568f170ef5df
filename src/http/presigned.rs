//! `POST /v1/uploads/presigned`: an upload that the client writes to the bucket by itself.

use axum::Extension;
use axum::extract::Request;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse as _;

use super::body::{BodyLimits, IncomingBody};
use super::problem::Handled;
use super::sizes::JSON_BYTES_MAX;
use super::state::{Caller, State};
use super::{query, representation, uploads};
use crate::jobs::AskedUpload;
use crate::wire::{PresignedRequest, Problem, ProblemCode, PutRequest, UploadInfo};

/// Begin an upload to the bucket.
///
/// The answer says by which request the client writes the mesh to the bucket, without this service in between: exactly these bytes.
/// Then a job may name the upload. `presigned_ttl_s` of `/v1/limits` is 0 where the server gives no such URLs.
#[utoipa::path(post, path = "/v1/uploads/presigned", operation_id = "create_presigned_upload", tag = "uploads",
    request_body = PresignedRequest, responses(
    (status = 201, description = "The upload, with `put`.", body = UploadInfo, headers(
        ("Location" = String, description = "The upload.")))))]
pub(super) async fn create(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    let (head, body) = request.into_parts();
    representation::json_only(&head.headers)?;
    query::none(&head.uri)?;
    let media_type = head.headers.get(header::CONTENT_TYPE).map(|value| value.to_str().unwrap_or_default());
    let essence = media_type.and_then(|text| text.split(';').next()).unwrap_or_default().trim();
    if !essence.eq_ignore_ascii_case("application/json") {
        let problem = Problem::new(ProblemCode::UnsupportedMediaType, "the request is JSON");
        return Err(problem.with_allowed(["application/json"]).into());
    }
    let limits =
        BodyLimits { bytes_max: JSON_BYTES_MAX, bytes_max_name: "json_bytes_max", ..state.upload_limits(0) };
    let asked =
        PresignedRequest::from_json(&IncomingBody::new(&head.headers, body, limits)?.into_bytes().await?)?;
    let digest = asked.digest()?;
    let asked = AskedUpload {
        owner: caller.owner.clone(),
        tenant: caller.tenant.clone(),
        file_name: asked.file_name.filter(|name| !name.is_empty()),
        metadata: None,
        length: asked.length,
    };
    let (row, put) = state.jobs.presign_upload(asked, digest).await?;
    let put = PutRequest {
        url: put.url,
        headers: put.headers.into_iter().collect(),
        valid_s: state.limits().presigned_ttl_s,
    };
    let info = UploadInfo { put: Some(put), ..uploads::info(&row) };
    let headers = [
        (header::LOCATION, format!("/v1/uploads/{}", row.id)),
        (header::CACHE_CONTROL, "no-store".to_owned()),
    ];
    Ok((StatusCode::CREATED, headers, super::answer::json_answer(&info)).into_response())
}
