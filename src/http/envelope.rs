//! What every request and every answer has in common: a request id, the limits on the head, a caught panic, security
//! headers, one line in the log, and counts.

use std::net::IpAddr;
use std::panic::AssertUnwindSafe;
use std::time::Instant;

use axum::body::HttpBody as _;
use axum::extract::{MatchedPath, Request};
use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use axum::middleware::Next;
use axum::response::Response;
use futures_util::FutureExt as _;
use tracing::Instrument as _;
use uuid::Uuid;

use super::problem::{self, LoggedProblem};
use super::sizes::HEAD_BYTES_MAX;
use super::state::{AboutJob, Caller};
use super::trace;
use super::unread::Unread;
use crate::jobs::JobId;
use crate::wire::{Problem, ProblemCode};

const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

/// Headers of every answer. Pages load nothing from other hosts and are shown in no frame; what is served is what its
/// type says.
const SECURITY: [(HeaderName, HeaderValue); 5] = [
    (
        header::CONTENT_SECURITY_POLICY,
        HeaderValue::from_static(
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; \
             base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        ),
    ),
    (header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff")),
    (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
    (header::X_FRAME_OPTIONS, HeaderValue::from_static("DENY")),
    (HeaderName::from_static("cross-origin-resource-policy"), HeaderValue::from_static("same-origin")),
];

/// The other end of the connection.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peer(pub(super) IpAddr);

/// Wraps every route, the fallbacks included.
pub(super) async fn envelop(mut request: Request, next: Next) -> Response {
    let started = Instant::now();
    let seen = LoggedRequest::of(&request);
    let unread = Unread::watch(&mut request);
    let is_negotiated = request.uri().path().starts_with("/v1/");
    request.extensions_mut().insert(seen.id.clone());
    let mut response = match head_too_large(&request) {
        Some(problem) => problem::respond(problem),
        None => {
            let span = trace::request_span(&request, &seen.id.0, &seen.route);
            answer(request, next).instrument(span).await
        }
    };
    if is_negotiated {
        response.headers_mut().append(header::VARY, HeaderValue::from_static("accept"));
    }
    seen.finish(&mut response, &unread, started);
    response
}

/// Runs the handler; a panic in it is an answer like any other.
async fn answer(request: Request, next: Next) -> Response {
    match AssertUnwindSafe(next.run(request)).catch_unwind().await {
        Ok(response) => response,
        Err(panic) => problem::respond(Problem::new(ProblemCode::Internal, panic_text(panic.as_ref()))),
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text =
        panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("panic: {}", text.unwrap_or("without a text"))
}

fn head_too_large(request: &Request) -> Option<Problem> {
    let field = |(name, value): (&HeaderName, &HeaderValue)| name.as_str().len() + value.len() + 4;
    let uri_bytes = request.uri().path().len() + request.uri().query().map_or(0, str::len);
    let bytes = (uri_bytes + request.headers().iter().map(field).sum::<usize>()) as u64;
    (bytes > HEAD_BYTES_MAX).then(|| {
        let detail = format!("path, query and header fields are over the limit of {HEAD_BYTES_MAX} bytes");
        Problem::new(ProblemCode::HeadTooLarge, detail).with_limit(
            "head_bytes_max",
            HEAD_BYTES_MAX,
            Some(bytes),
        )
    })
}

/// The request id, for handlers that pass it on.
#[derive(Debug, Clone)]
pub(super) struct RequestId(pub(super) String);

/// What of a request its log line tells. Neither query nor body: they are the caller's own.
struct LoggedRequest {
    id: RequestId,
    method: axum::http::Method,
    route: String,
    trace: Option<String>,
    peer: Option<IpAddr>,
    /// The job that the path names.
    job: Option<String>,
    bytes_in: Option<u64>,
}

impl LoggedRequest {
    fn of(request: &Request) -> Self {
        Self {
            id: request_id(request.headers()),
            method: request.method().clone(),
            route: request.extensions().get::<MatchedPath>().map_or("none", MatchedPath::as_str).to_owned(),
            trace: trace::trace_id(request.headers()),
            peer: request.extensions().get::<Peer>().map(|peer| peer.0),
            job: job_of(request.uri().path()),
            bytes_in: announced(request.headers()),
        }
    }

    /// Adds the common headers and writes the log line.
    fn finish(self, response: &mut Response, unread: &Unread, started: Instant) {
        let elapsed = started.elapsed();
        let status = response.status().as_u16();
        let headers = response.headers_mut();
        for (name, value) in SECURITY {
            headers.entry(name).or_insert(value);
        }
        if let Ok(id) = HeaderValue::from_str(&self.id.0) {
            headers.insert(REQUEST_ID, id);
        }
        if let Ok(timing) = HeaderValue::from_str(&format!("total;dur={:.3}", elapsed.as_secs_f64() * 1e3)) {
            headers.append("server-timing", timing);
        }
        if unread.is_so() {
            headers.insert(header::CONNECTION, HeaderValue::from_static("close"));
        }
        let bytes_out = response.body().size_hint().exact();
        let told = response.extensions().get::<LoggedProblem>();
        let caller = response.extensions().get::<Caller>().and_then(|caller| caller.owner.as_deref());
        let made = response.extensions().get::<AboutJob>().map(|about| about.0.as_str());
        super::metrics::count_request(&self.method, &self.route, status, elapsed);
        tracing::info!(
            request = self.id.0,
            method = %self.method,
            route = self.route,
            status,
            ms = elapsed.as_secs_f64() * 1e3,
            bytes_in = self.bytes_in,
            bytes_out,
            caller,
            job = made.or(self.job.as_deref()),
            peer = self.peer.map(tracing::field::display),
            trace = self.trace,
            problem = told.map(|told| told.code.word()),
            "answered"
        );
        if let Some(told) = told.filter(|told| told.code == ProblemCode::Internal) {
            tracing::error!(request = self.id.0, detail = told.detail, "internal error");
        }
    }
}

/// The client's own id when it is short and plain, otherwise a new one.
fn request_id(headers: &HeaderMap) -> RequestId {
    let is_plain = |id: &&str| {
        (1..=128).contains(&id.len()) && id.bytes().all(|b| b.is_ascii_alphanumeric() || b"-_.".contains(&b))
    };
    let given = headers.get(REQUEST_ID).and_then(|value| value.to_str().ok()).filter(is_plain);
    RequestId(given.map_or_else(|| Uuid::now_v7().to_string(), str::to_owned))
}

/// The job that a path names, if it is an id at all.
fn job_of(path: &str) -> Option<String> {
    let id = path.strip_prefix("/v1/jobs/")?.split('/').next()?;
    id.parse::<JobId>().ok().map(|id| id.to_string())
}

/// The size of the body, where the client says it.
fn announced(headers: &HeaderMap) -> Option<u64> {
    headers.get(header::CONTENT_LENGTH)?.to_str().ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::http::router;
    use axum::Router;
    use axum::body::Body;
    use axum::http::StatusCode;
    use axum::routing::get;
    use http_body_util::BodyExt as _;
    use tower::ServiceExt as _;

    async fn panics() -> &'static str {
        panic!("the secret of the handler")
    }

    fn router() -> Router {
        let routes = Router::new().route("/boom", get(panics)).route("/fine", get(|| async { "fine" }));
        router::enveloped(router::complete(routes))
    }

    async fn ask(request: axum::http::request::Builder) -> (StatusCode, HeaderMap, String) {
        let response = router().oneshot(request.body(Body::empty()).unwrap()).await.unwrap();
        let (head, body) = response.into_parts();
        let text = String::from_utf8(body.collect().await.unwrap().to_bytes().to_vec()).unwrap();
        (head.status, head.headers, text)
    }

    #[tokio::test]
    async fn a_panic_in_a_handler_is_an_internal_problem_that_tells_only_the_request_id() {
        let (status, headers, text) = ask(Request::get("/boom").header("x-request-id", "seven")).await;
        assert_eq!(
            (status, &headers[header::CONTENT_TYPE]),
            (StatusCode::INTERNAL_SERVER_ERROR, &problem::PROBLEM_JSON)
        );
        assert_eq!(headers[REQUEST_ID], "seven");
        assert!(text.contains("\"code\":\"internal\"") && !text.contains("secret"), "{text}");
    }

    #[tokio::test]
    async fn every_answer_has_security_headers_a_request_id_and_a_time() {
        for path in ["/fine", "/boom", "/nowhere"] {
            let (_, headers, _) = ask(Request::get(path)).await;
            for (name, value) in &SECURITY {
                assert_eq!(headers.get(name), Some(value), "{path}");
            }
            assert_eq!(headers[REQUEST_ID].len(), 36);
            assert!(headers["server-timing"].to_str().unwrap().starts_with("total;dur="));
        }
    }
}
