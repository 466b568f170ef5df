//! Answers about jobs: accepted, as they stand, and finished.

use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use sha2::{Digest as _, Sha256};

use super::both::{CombinedAnswer, OutgoingMesh};
use super::mesh_file;
use super::problem::{Handled, json};
use super::representation::{OCTET_STREAM, Representation, media_type_of_picture};
use super::state::AboutJob;
use crate::jobs::{JobId, Jobs, StoredFile};
use crate::wire::{self, Job, Problem, ProblemCode, Stage};

const JSON: HeaderValue = HeaderValue::from_static("application/json");
const OUTCOME: HeaderName = HeaderName::from_static("meshmend-outcome");
const FIDELITY: HeaderName = HeaderName::from_static("meshmend-fidelity");
const SERVER_TIMING: HeaderName = HeaderName::from_static("server-timing");
const PREFERENCE_APPLIED: HeaderName = HeaderName::from_static("preference-applied");

/// `value` as `application/json`.
pub(super) fn json_answer(value: &impl serde::Serialize) -> Response {
    ([(header::CONTENT_TYPE, JSON)], json(value)).into_response()
}

/// 202: the job is under way, and where it is.
pub(super) fn accepted(job: &Job, applied: Option<HeaderValue>) -> Response {
    let mut response = (StatusCode::ACCEPTED, json_answer(job)).into_response();
    put(response.headers_mut(), header::LOCATION, &job.links.this);
    response.extensions_mut().insert(AboutJob(job.id.clone()));
    tell_applied(&mut response, applied);
    response
}

/// Tells which of the client's preferences were followed.
pub(super) fn tell_applied(response: &mut Response, applied: Option<HeaderValue>) {
    if let Some(applied) = applied {
        response.headers_mut().insert(PREFERENCE_APPLIED, applied);
    }
}

/// Refuses a request about a job that has changed since the client saw it.
pub(super) fn check_job_is(job: &Job, request: &HeaderMap) -> Result<(), Problem> {
    mesh_file::check_if_match(request, &etag_of(&json(job)))
}

fn etag_of(job: &[u8]) -> String {
    let digest: [u8; 32] = Sha256::digest(job).into();
    format!("\"{}\"", mesh_file::base64(&digest[..12]))
}

/// The job as it stands; 304 when the client has seen it so.
pub(super) fn job_as_it_stands(job: &Job, request: &HeaderMap) -> Response {
    let body = json(job);
    let etag = etag_of(&body);
    let mut response = if mesh_file::matches_etag(request, &etag) {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        ([(header::CONTENT_TYPE, JSON)], body).into_response()
    };
    put(response.headers_mut(), header::ETAG, &etag);
    response.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("private, no-cache"));
    response
}

/// A stored report.
pub(super) fn report(stored: Vec<u8>) -> Response {
    ([(header::CONTENT_TYPE, JSON)], stored).into_response()
}

/// A stored picture; 304 when the client has it.
pub(super) fn picture((content, sha256): (Vec<u8>, [u8; 32]), request: &HeaderMap) -> Response {
    let etag = format!("\"{}\"", mesh_file::base64(&sha256));
    let mut response = if mesh_file::matches_etag(request, &etag) {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        ([(header::CONTENT_TYPE, media_type_of_picture(&content))], content).into_response()
    };
    put(response.headers_mut(), header::ETAG, &etag);
    response.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("private, no-cache"));
    response
}

/// A stored report as a page for people, with the picture of the job if it has one.
pub(super) fn report_page(stored: &[u8], picture: Option<&[u8]>) -> Handled {
    let report = serde_json::from_slice(stored).map_err(|error| {
        Problem::new(ProblemCode::Internal, format!("a stored report cannot be read: {error}"))
    })?;
    let headers = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, wire::REPORT_PAGE_CSP),
    ];
    Ok((headers, wire::report_page(&report, picture)).into_response())
}

/// A job that has ended.
pub(super) struct Finished<'j> {
    pub(super) jobs: &'j Jobs,
    pub(super) id: JobId,
    pub(super) job: &'j Job,
}

impl Finished<'_> {
    /// What the job was asked for, or its problem.
    pub(super) async fn respond(&self, representation: Representation) -> Handled {
        let mut response = match representation {
            Representation::Report => self.report().await?,
            Representation::Picture => picture(self.jobs.picture(self.id).await?, &HeaderMap::new()),
            Representation::Mesh { is_opaque, .. } => {
                let mesh = self.jobs.result(self.id).await?;
                let media_type = if is_opaque { OCTET_STREAM } else { mesh_file::media_type(&mesh) };
                mesh_file::whole(mesh, media_type)
            }
            Representation::Multipart => {
                // Nobody who chose the mesh knew the id, so the boundary does not occur in it.
                let boundary = format!("meshmend-{}", self.id);
                let (body, len) = self.both().await?.into_multipart(&boundary);
                let media_type = format!("multipart/mixed; boundary={boundary}");
                let headers = [(header::CONTENT_TYPE, media_type), (header::CONTENT_LENGTH, len.to_string())];
                (headers, body).into_response()
            }
            Representation::Zip => {
                let both = self.both().await?;
                let first = both.meshes.first().map_or("mesh", |mesh| &mesh.file_name);
                let disposition = mesh_file::disposition(&format!("{first}.zip"));
                let headers = [
                    (header::CONTENT_TYPE, "application/zip".to_owned()),
                    (header::CONTENT_DISPOSITION, disposition),
                ];
                let body = both.into_zip().map_err(|error| {
                    Problem::new(ProblemCode::Internal, format!("the archive cannot be begun: {error}"))
                })?;
                (headers, body).into_response()
            }
        };
        self.describe(response.headers_mut());
        response.extensions_mut().insert(AboutJob(self.job.id.clone()));
        Ok(response)
    }

    /// The report; of a job that failed, its problem, which has the report inside.
    async fn report(&self) -> Handled {
        if self.job.problem.is_some() {
            let of_result = self.jobs.result(self.id).await.err();
            return Err(of_result.or_else(|| self.job.problem.clone()).unwrap_or_else(unfinished).into());
        }
        Ok(report(self.jobs.report(self.id).await?))
    }

    async fn both(&self) -> Result<CombinedAnswer<tokio::fs::File>, Problem> {
        let stored = self.jobs.results(self.id).await?;
        let report = self.jobs.report(self.id).await?;
        let mesh = |stored: StoredFile| OutgoingMesh {
            media_type: mesh_file::media_type(&stored),
            len: stored.bytes,
            file_name: stored.file_name,
            content: stored.file,
        };
        Ok(CombinedAnswer { report, meshes: stored.into_iter().map(mesh).collect() })
    }

    /// Adds what is known about the job: its outcome, where its report is, and how long its passes took.
    fn describe(&self, headers: &mut HeaderMap) {
        if let Some(outcome) = self.job.outcome {
            put(headers, OUTCOME, outcome.word());
        }
        if let Some(fidelity) = self.job.fidelity {
            put(headers, FIDELITY, fidelity.word());
        }
        if let Some(report) = &self.job.links.report {
            put(headers, header::LINK, &format!("<{report}>; rel=\"describedby\""));
        }
        if let Some(timing) = &self.job.timing_ms {
            let pass = |&stage: &Stage| Some(format!("{};dur={:.3}", stage.word(), timing.of(stage)?));
            let passes: Vec<_> = Stage::ALL.iter().filter_map(pass).collect();
            put(
                headers,
                SERVER_TIMING,
                &[passes, vec![format!("engine;dur={:.3}", timing.total)]].concat().join(", "),
            );
        }
    }
}

fn unfinished() -> Problem {
    Problem::new(ProblemCode::Internal, "a failed job without a problem")
}

/// Sets a header; what is no header text (it never is) is left out.
fn put(headers: &mut HeaderMap, name: HeaderName, value: &str) {
    if let Ok(value) = HeaderValue::from_str(value) {
        headers.insert(name, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_style_of_a_report_is_the_one_that_its_policy_allows() {
        let page = wire::report_page(&serde_json::Value::Null, None);
        let style = page.split("<style>").nth(1).and_then(|rest| rest.split("</style>").next()).unwrap();
        let digest = mesh_file::base64(&Sha256::digest(style.as_bytes()));
        assert!(wire::REPORT_PAGE_CSP.contains(&format!("'sha256-{digest}'")), "{digest}");
        assert!(page.contains(wire::REPORT_PAGE_CSP));
    }
}
