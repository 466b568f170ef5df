//! `POST /v1/analyze`, `/v1/repair`, `/v1/cut-stitch`, `/v1/fill-holes`, … and `/v1/jobs`: a mesh comes in and becomes a job.
//!
//! There is one model: every request makes a job, and all but `/v1/jobs` wait for it a while.

use std::time::Duration;

use axum::Extension;
use axum::extract::Request;
use axum::http::{HeaderMap, header, request};

use super::agreed::{about_operation, agreed, agreed_member};
use super::answer::{self, Finished};
use super::entrance::Intake;
use super::intake;
use super::prefer::{Wait, seconds_of};
use super::problem::Handled;
use super::query;
use super::representation::{PNG, Representation, json_only, one_of};
use super::state::{Caller, HttpService, State};
use super::trace;
use crate::jobs::{JobId, Jobs, NamedUpload, Submission};
use crate::wire::{
    Format, InputRef, Job, Operation, Options, PictureFormat, Problem, ProblemCode, media_type_of,
};

/// Describe a mesh.
///
/// Mesh in, report out: counts, measures, defects with witnesses, and the certificate of the file as it is.
#[utoipa::path(post, path = "/v1/analyze", tag = "operations")]
pub(super) async fn analyze(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    report_of(&state, &caller, Operation::Analyze, request).await
}

/// Judge a mesh as it is.
///
/// Mesh in, report with its certificate out: which of P0, P1 and P2 hold, and the first violations.
#[utoipa::path(post, path = "/v1/verify", tag = "operations")]
pub(super) async fn verify(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    report_of(&state, &caller, Operation::Verify, request).await
}

/// Plan a repair.
///
/// Mesh in, report out, with a `plan`: what a repair would do about each defect, what else could be done, and how sure
/// that is. Edit it and send it to `/v1/repair` as `plan`.
#[utoipa::path(post, path = "/v1/plan", tag = "operations")]
pub(super) async fn plan(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    report_of(&state, &caller, Operation::Plan, request).await
}

/// Repair a mesh.
///
/// Mesh in, certified mesh out, or a refusal that says why. `Accept` chooses the mesh, the report, or both.
#[utoipa::path(post, path = "/v1/repair", tag = "operations")]
pub(super) async fn repair(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::Repair, request).await
}

/// Write a mesh in another format.
///
/// The same mesh in `output_format`; its certificate states what holds.
#[utoipa::path(post, path = "/v1/convert", tag = "operations")]
pub(super) async fn convert(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::Convert, request).await
}

/// Simplify a mesh.
///
/// Fewer triangles of the same shape, of the same topology after singular edges were cut; the certificate states what
/// holds. With several `targets` the mesh is the first of them, and `multipart/mixed` and `application/zip` hold all.
#[utoipa::path(post, path = "/v1/simplify", tag = "operations")]
pub(super) async fn simplify(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::Simplify, request).await
}

/// Cut and stitch a mesh.
///
/// Singular edges and vertices are cut, so that a coherently oriented manifold with boundary is left; then boundary
/// edges are joined, as `stitch` says. The certificate states what holds: readers that weld join cut vertices again.
#[utoipa::path(post, path = "/v1/cut-stitch", tag = "operations")]
pub(super) async fn cut_stitch(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::CutStitch, request).await
}

/// Fill the holes of a mesh.
///
/// All boundary loops, or those that `holes` lists, are closed by patches that add no defect; no vertex moves and every
/// triangle stays. The report says in `holes` what became of each, and the certificate what holds.
#[utoipa::path(post, path = "/v1/fill-holes", tag = "operations")]
pub(super) async fn fill_holes(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::FillHoles, request).await
}

/// Edit a polyhedron by its planes.
///
/// The mesh, which must be a closed solid, is read as a polyhedron with exact planes; `operators` move faces, split and
/// merge vertices and flip edges, and the whole solid is checked after each. `ranges` tells how far faces may move. The
/// report says in `modeller` what was done and what takes it back, and the certificate what holds.
#[utoipa::path(post, path = "/v1/modeller", tag = "operations")]
pub(super) async fn modeller(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::Modeller, request).await
}

/// Combine solids.
///
/// Two or more meshes, each a part `mesh` of a form, become one certified solid: their union, their intersection, or the first
/// without all others, as `set_operation` says. Each must be a closed solid; otherwise the refusal says which is not, and why.
#[utoipa::path(post, path = "/v1/boolean", tag = "operations")]
pub(super) async fn boolean(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    result_of(&state, &caller, Operation::Boolean, request).await
}

/// Draw a mesh.
///
/// Mesh in, PNG out: from one side or several, defects coloured and marked, backs red, or turning as an animated PNG. Or GLB out,
/// which viewers turn: `Accept: model/gltf-binary` or `picture_format=glb`. `Accept: application/json` gives the report of what was
/// found.
#[utoipa::path(post, path = "/v1/render", tag = "operations")]
pub(super) async fn render(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    let (head, body) = request.into_parts();
    let operation = Operation::Render;
    let options = query::options(&head.uri, operation)?;
    drawn(&head.headers, options.picture_format)?;
    let intake = intake::receive(&state, &caller, &head.headers, body, Some(operation)).await?;
    let mut submission = submission(&state, &caller, operation, options, intake, &head.headers).await?;
    let (representation, format) = drawn(&head.headers, submission.options.picture_format)?;
    submission.options.picture_format = format;
    // Choices for pixels do not go with a mesh that only `Accept` asks for.
    submission.options.check(operation).map_err(|error| Problem::from(&error))?;
    finish(&state, submission, representation, &head).await
}

/// What `Accept` asks for, and in which format a picture is drawn; `format`: the one that the options ask for.
fn drawn(
    headers: &HeaderMap,
    format: Option<PictureFormat>,
) -> Result<(Representation, Option<PictureFormat>), Problem> {
    let glb = media_type_of(Format::Glb);
    let offers = match format {
        Some(PictureFormat::Png) => &[PNG, "application/json"][..],
        Some(PictureFormat::Glb) => &[glb, "application/json"],
        None => &[PNG, glb, "application/json"],
    };
    Ok(match one_of(headers, offers)? {
        PNG => (Representation::Picture, format),
        media_type if media_type == glb => (Representation::Picture, Some(PictureFormat::Glb)),
        _ => (Representation::Report, format),
    })
}

/// Make a job and do not wait for it.
#[utoipa::path(post, path = "/v1/jobs", tag = "jobs", params(
    ("operation" = Option<Operation>, Query, description = "What to do, unless the body says it."),
    ("labels" = Option<String>, Query, pattern = r#"^\{"[a-z]{1,20}":"[A-Za-z0-9]{0,20}"\}$"#,
     description = "What to write on the job, by name, unless the body says it: JSON text of an object of texts.")))]
pub(super) async fn create_job(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    let (head, body) = request.into_parts();
    json_only(&head.headers)?;
    let asked = query::job_request(&head.uri)?;
    let mut intake = intake::receive(&state, &caller, &head.headers, body, None).await?;
    let operation = agreed(asked.operation, intake.operation)?;
    intake.labels = agreed_member("labels", asked.labels, intake.labels)?;
    let operation = operation.ok_or_else(|| about_operation("`operation` is missing"))?;
    let submission = submission(&state, &caller, operation, asked.options, intake, &head.headers).await?;
    let job = state.jobs.submit(submission).await?;
    Ok(answer::accepted(&job, None))
}

/// The answer of an operation whose product is its report.
async fn report_of(
    service: &HttpService,
    caller: &Caller,
    operation: Operation,
    request: Request,
) -> Handled {
    let (head, body) = request.into_parts();
    json_only(&head.headers)?;
    let options = query::options(&head.uri, operation)?;
    let intake = intake::receive(service, caller, &head.headers, body, Some(operation)).await?;
    let submission = submission(service, caller, operation, options, intake, &head.headers).await?;
    finish(service, submission, Representation::Report, &head).await
}

/// The answer of an operation whose product is a mesh.
async fn result_of(
    service: &HttpService,
    caller: &Caller,
    operation: Operation,
    request: Request,
) -> Handled {
    let (head, body) = request.into_parts();
    let options = query::options(&head.uri, operation)?;
    // Asked before the upload, so that a client that cannot be served does not send it in vain.
    Representation::choose(&head.headers, options.output_format)?;
    let intake = intake::receive(service, caller, &head.headers, body, Some(operation)).await?;
    let mut submission = submission(service, caller, operation, options, intake, &head.headers).await?;
    let representation = Representation::choose(&head.headers, submission.options.output_format)?;
    if let Representation::Mesh { format: Some(format), .. } = representation {
        submission.options.output_format = Some(format);
    }
    finish(service, submission, representation, &head).await
}

/// Submits the job, waits for it, and answers with what there is then.
async fn finish(
    service: &HttpService,
    submission: Submission,
    representation: Representation,
    head: &request::Parts,
) -> Handled {
    let wait = Wait::from_headers(&head.headers);
    let submission = Submission { is_waited_for: !wait.duration.is_zero(), ..submission };
    // With a key the client can come back for the job that it does not know the id of.
    let can_come_back = submission.key.is_some();
    let job = service.jobs.submit(submission).await?;
    let id = id_of(&job)?;
    if wait.duration.is_zero() {
        return Ok(answer::accepted(&job, wait.applied_header()));
    }
    let abandoned = CancelWhenDropped { jobs: &service.jobs, id: (!can_come_back).then_some(id) };
    let job = service.jobs.wait(id, wait.duration).await;
    abandoned.disarm();
    let job = job?;
    let mut response = if job.state.is_final() {
        Finished { jobs: &service.jobs, id, job: &job }.respond(representation).await?
    } else {
        answer::accepted(&job, None)
    };
    if let Some(applied) = wait.applied_header() {
        response.headers_mut().insert("preference-applied", applied);
    }
    Ok(response)
}

fn id_of(job: &Job) -> Result<JobId, Problem> {
    job.id.parse().map_err(|_| Problem::new(ProblemCode::Internal, "a job has no valid id"))
}

/// A client that goes away while its job is waited for never learned the job's id, so nobody can want the result.
struct CancelWhenDropped<'s> {
    jobs: &'s Jobs,
    id: Option<JobId>,
}

impl CancelWhenDropped<'_> {
    fn disarm(mut self) {
        self.id = None;
    }
}

impl Drop for CancelWhenDropped<'_> {
    fn drop(&mut self) {
        if let Some(id) = self.id {
            let jobs = self.jobs.clone();
            tokio::spawn(async move { jobs.cancel(id).await.map(drop) });
        }
    }
}

/// Joins what path, query, headers and body say.
async fn submission(
    service: &HttpService,
    caller: &Caller,
    operation: Operation,
    in_query: Options,
    intake: Intake,
    headers: &HeaderMap,
) -> Result<Submission, Problem> {
    let mut options = in_query.join(intake.options).map_err(|error| Problem::from(&error))?;
    options.check(operation).map_err(|error| Problem::from(&error))?;
    options.format = options.format.or(intake.named);
    let (mut upload, mut file_name, mut taken_by) = (intake.upload, intake.file_name, None);
    match (&upload, &options.input) {
        (None, None) => return Err(no_mesh(headers)),
        (_, Some(InputRef::Job(job))) => drop(service.visible(job, caller).await?),
        (None, Some(InputRef::Upload(id))) => {
            let owner = caller.owner.as_deref();
            match service.jobs.take_upload(id, owner, intake.is_repeat).await? {
                NamedUpload::Mesh(mesh, name) => {
                    upload = Some(*mesh);
                    file_name = file_name.or(name);
                }
                NamedUpload::TakenBy(job) => taken_by = Some(job),
            }
        }
        (Some(_), Some(InputRef::Upload(_))) => return Err(mesh_twice()),
        (Some(_), None) => {}
    }
    Ok(Submission {
        key: intake.key,
        upload,
        taken_by,
        material: intake.material,
        file_name,
        labels: intake.labels.unwrap_or_default(),
        cancel_after: cancel_after(headers)?,
        owner: caller.owner.clone(),
        tenant: caller.tenant.clone(),
        trace: trace::of_job(headers),
        webhook: intake.webhook.map(|asked| service.jobs.admit_webhook(asked)).transpose()?,
        ..Submission::new(operation, options)
    })
}

fn mesh_twice() -> Problem {
    let detail = "send one mesh, or name an upload in `input`, not both";
    Problem { parameter: Some("input".to_owned()), ..Problem::new(ProblemCode::InvalidParameter, detail) }
}

fn no_mesh(headers: &HeaderMap) -> Problem {
    let content_type =
        headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    if content_type.starts_with("multipart/form-data") {
        let detail = "the form has no part `mesh`, or it is empty; send the file there, or name an earlier job or upload in `input`";
        return Problem {
            parameter: Some("mesh".to_owned()),
            ..Problem::new(ProblemCode::InvalidParameter, detail)
        };
    }
    if content_type.starts_with("application/json") {
        let detail = "JSON brings options only: name an earlier job or upload in `input`, or send the mesh itself as the body";
        return Problem {
            parameter: Some("input".to_owned()),
            ..Problem::new(ProblemCode::InvalidParameter, detail)
        };
    }
    Problem::new(
        ProblemCode::MeshEmpty,
        "the request has no body; send the mesh, for example with `curl --data-binary @FILE`",
    )
}

/// The seconds of `Cancel-After`.
fn cancel_after(headers: &HeaderMap) -> Result<Option<Duration>, Problem> {
    let Some(value) = headers.get("cancel-after") else { return Ok(None) };
    match value.to_str().ok().map(str::trim).and_then(seconds_of) {
        Some(seconds) => Ok(Some(Duration::from_secs(seconds))),
        None => Err(Problem {
            parameter: Some("Cancel-After".to_owned()),
            ..Problem::new(ProblemCode::InvalidParameter, "`Cancel-After` is a whole number of seconds")
        }),
    }
}
