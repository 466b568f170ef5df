//! Problems as answers: every answer that is not a success is `application/problem+json` with a stable code.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::wire::{Problem, ProblemCode};

/// Media type of problems (RFC 9457).
pub(super) const PROBLEM_JSON: HeaderValue = HeaderValue::from_static("application/problem+json");

/// A problem that a handler answers with.
#[derive(Debug)]
pub(super) struct ProblemAnswer(Box<Problem>);

/// What a handler gives.
pub(super) type Handled = Result<Response, ProblemAnswer>;

/// Left in the answer's extensions for the request log.
#[derive(Debug, Clone)]
pub(super) struct LoggedProblem {
    pub(super) code: ProblemCode,
    pub(super) detail: String,
}

impl ProblemAnswer {
    /// A problem of this code; `detail` is a sentence about this case.
    pub(super) fn new(code: ProblemCode, detail: impl Into<String>) -> Self {
        Self::from(Problem::new(code, detail))
    }
}

impl From<Problem> for ProblemAnswer {
    fn from(problem: Problem) -> Self {
        Self(Box::new(problem))
    }
}

impl IntoResponse for ProblemAnswer {
    fn into_response(self) -> Response {
        respond(*self.0)
    }
}

/// The answer that tells `problem`.
pub(super) fn respond(mut problem: Problem) -> Response {
    let told = LoggedProblem { code: problem.code, detail: problem.detail.clone() };
    if problem.code == ProblemCode::Internal {
        // What went wrong inside is for the log, where the request id leads.
        problem.detail = "a fault of the server".to_owned();
    }
    let status = StatusCode::from_u16(problem.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
    let mut response = (status, [(header::CONTENT_TYPE, PROBLEM_JSON)], json(&problem)).into_response();
    let headers = response.headers_mut();
    if let Some(seconds) = problem.retry_after_s {
        headers.insert(header::RETRY_AFTER, HeaderValue::from(seconds));
    }
    if problem.code == ProblemCode::Unauthenticated {
        headers.insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer realm=\"meshmend\""));
    }
    response.extensions_mut().insert(told);
    response
}

/// `value` as JSON. The wire types have no keys that are not text, so this cannot fail.
pub(super) fn json(value: &impl serde::Serialize) -> Vec<u8> {
    serde_json::to_vec(value).unwrap_or_default()
}
