//! `/v1/jobs/{id}` and below: the life of a job after it was accepted.

use axum::Extension;
use axum::extract::{Path, Request};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::IntoResponse as _;

use super::prefer::Wait;
use super::problem::{Handled, ProblemAnswer};
use super::representation::{OCTET_STREAM, PNG, json_only, media_type_of_picture, one_of};
use super::state::{Caller, HttpService, State};
use super::{answer, mesh_file, query};
use crate::jobs::JobId;
use crate::wire::{Format, Job, Problem, ProblemCode, Report, media_type_of};

/// Media type of a report for people.
const HTML: &str = "text/html";

/// The `{id}` of a path. What does not decode to text cannot be an id.
pub(super) type Id = Result<Path<String>, axum::extract::rejection::PathRejection>;

/// Show a job.
///
/// With `wait`, the answer comes when the job has ended or after that many seconds, at most 300.
#[utoipa::path(get, path = "/v1/jobs/{id}", operation_id = "get_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job."),
           ("wait" = Option<usize>, Query, description = "Seconds to wait for the job's end, at most 300; more are taken for 300. Default: 0.")),
    responses((status = 200, description = "The job.", body = Job), (status = 304, description = "Not changed.")))]
pub(super) async fn show(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    json_only(request.headers())?;
    let wait = Wait::of_seconds(query::wait(request.uri())?);
    let id = visible(&state, &caller, id).await?;
    let job = state.jobs.wait(id, wait.duration).await?;
    answer::check_job_is(&job, request.headers())?;
    let mut response = answer::job_as_it_stands(&job, request.headers());
    answer::tell_applied(&mut response, wait.applied_header());
    Ok(response)
}

/// Cancel a job.
///
/// A queued job ends at once, a running one within moments; one that has ended stays as it is.
#[utoipa::path(post, path = "/v1/jobs/{id}/cancel", operation_id = "cancel_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses((status = 200, description = "The job has ended.", body = Job),
              (status = 202, description = "The job will end.", body = Job)))]
pub(super) async fn cancel(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    json_only(request.headers())?;
    query::none(request.uri())?;
    let id = unchanged(&state, &caller, id, request.headers()).await?;
    let job = state.jobs.cancel(id).await?;
    let status = if job.state.is_final() { StatusCode::OK } else { StatusCode::ACCEPTED };
    Ok((status, answer::json_answer(&job)).into_response())
}

/// Delete a job.
///
/// The job goes with its upload, report and result; one that is running is cancelled first.
#[utoipa::path(delete, path = "/v1/jobs/{id}", operation_id = "delete_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses((status = 204, description = "The job is gone.")))]
pub(super) async fn delete(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    query::none(request.uri())?;
    let id = unchanged(&state, &caller, id, request.headers()).await?;
    state.jobs.delete(id).await?;
    Ok(StatusCode::NO_CONTENT.into_response())
}

/// Read a job's report.
///
/// Also of a refused repair, whose report says why. As JSON, or with `Accept: text/html` as a page for people: one file
/// that loads nothing, with the job's picture if it has one.
#[utoipa::path(get, path = "/v1/jobs/{id}/report", operation_id = "get_job_report", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses((status = 200, description = "The report.", body = Report)))]
pub(super) async fn report(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    let media_type = one_of(request.headers(), &["application/json", HTML])?;
    query::none(request.uri())?;
    let id = visible(&state, &caller, id).await?;
    let stored = state.jobs.report(id).await?;
    if media_type != HTML {
        return Ok(answer::report(stored));
    }
    // A job without a picture has a page all the same.
    let picture = state.jobs.picture(id).await.ok();
    answer::report_page(&stored, picture.as_ref().map(|(content, _)| content.as_slice()))
}

/// Download a job's picture.
///
/// Of a job that was made with `thumbnail=true`: the mesh with its defects, and beside it the result with its new
/// triangles. Of a job that draws: what it has drawn.
#[utoipa::path(get, path = "/v1/jobs/{id}/thumbnail.png", operation_id = "get_job_thumbnail", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")))]
pub(super) async fn thumbnail(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    query::none(request.uri())?;
    let id = visible(&state, &caller, id).await?;
    picture(&state, id, request.headers(), PNG).await
}

/// Download a job's picture that is a mesh.
///
/// Of a job that draws with `picture_format=glb`.
#[utoipa::path(get, path = "/v1/jobs/{id}/thumbnail.glb", operation_id = "get_job_thumbnail_mesh", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")))]
pub(super) async fn thumbnail_mesh(
    state: State,
    caller: Extension<Caller>,
    id: Id,
    request: Request,
) -> Handled {
    query::none(request.uri())?;
    let id = visible(&state, &caller, id).await?;
    picture(&state, id, request.headers(), media_type_of(Format::Glb)).await
}

/// The picture of a job, which must be of this media type.
async fn picture(state: &State, id: JobId, headers: &HeaderMap, media_type: &'static str) -> Handled {
    one_of(headers, &[media_type])?;
    let stored = state.jobs.picture(id).await?;
    let own = media_type_of_picture(&stored.0);
    if own != media_type {
        let detail = format!("the job's picture is of the type {own}: its link `thumbnail` names it");
        return Err(Problem::new(ProblemCode::NotFound, detail).into());
    }
    Ok(answer::picture(stored, headers))
}

/// Download a job's mesh.
///
/// Whole or in part (`Range`); of a refused repair the same problem that the repair was answered with. With `redirect` the answer
/// is a presigned URL of the bucket, where the server gives any.
#[utoipa::path(get, path = "/v1/jobs/{id}/result", operation_id = "get_job_result", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job."),
           ("level" = Option<usize>, Query, minimum = 1,
            description = "Which target's mesh of a simplification, from 1. Default: 1."),
           ("redirect" = Option<bool>, Query,
            description = "Whether to answer with 307 and a URL of the bucket in `Location`, from which the mesh comes without this service in between. Default: false.")),
    responses((status = 307, description = "`Location` is where the mesh is, for as long as `presigned_ttl_s` of `/v1/limits` says.",
        headers(("Location" = String, description = "A presigned URL.")))))]
pub(super) async fn result(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    let query::AskedResult { level, redirect } = query::result(request.uri())?;
    if redirect {
        let id = visible(&state, &caller, id).await?;
        let url = state.jobs.presign_level(id, level - 1, mesh_file::disposition).await?;
        let headers = [(header::LOCATION, url), (header::CACHE_CONTROL, "no-store".to_owned())];
        return Ok((StatusCode::TEMPORARY_REDIRECT, headers).into_response());
    }
    let stored = state.jobs.level(visible(&state, &caller, id).await?, level - 1).await?;
    let media_type = one_of(request.headers(), &[mesh_file::media_type(&stored), OCTET_STREAM])?;
    Ok(mesh_file::asked_for(stored, media_type, request.headers()).await)
}

/// The job, if it is as the client saw it (`If-Match`).
async fn unchanged(
    service: &HttpService,
    caller: &Caller,
    id: Id,
    headers: &HeaderMap,
) -> Result<JobId, ProblemAnswer> {
    let id = visible(service, caller, id).await?;
    if headers.contains_key(header::IF_MATCH) {
        answer::check_job_is(&service.jobs.get(id).await?, headers)?;
    }
    Ok(id)
}

pub(super) async fn visible(service: &HttpService, caller: &Caller, id: Id) -> Result<JobId, ProblemAnswer> {
    let Ok(Path(text)) = id else {
        return Err(ProblemAnswer::new(ProblemCode::NotFound, "there is no such job"));
    };
    Ok(service.visible(&text, caller).await?)
}
