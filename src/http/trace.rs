//! Where a request belongs in a trace (W3C Trace Context).

use axum::extract::Request;
use axum::http::{HeaderMap, HeaderName};
use tracing::Span;

use crate::jobs::TraceParent;

const TRACEPARENT: HeaderName = HeaderName::from_static("traceparent");

/// The span of a request. With the feature `otel` it continues the caller's trace and leaves with it.
pub(super) fn request_span(request: &Request, id: &str, route: &str) -> Span {
    let method = request.method().as_str();
    let span = tracing::info_span!("request", id);
    #[cfg(feature = "otel")]
    super::otel::describe_request(&span, request.headers(), method, route);
    #[cfg(not(feature = "otel"))]
    let _ = (method, route);
    span
}

/// Where a job belongs that this request asks for: below the request's own span where there is one, else beside it.
pub(super) fn of_job(headers: &HeaderMap) -> Option<TraceParent> {
    #[cfg(feature = "otel")]
    if let Some(own) = super::otel::current().and_then(|text| TraceParent::parse(&text)) {
        return Some(own);
    }
    traceparent(headers)
}

/// The trace id of a valid `traceparent`.
pub(super) fn trace_id(headers: &HeaderMap) -> Option<String> {
    traceparent(headers).map(|parent| parent.trace_id().to_owned())
}

fn traceparent(headers: &HeaderMap) -> Option<TraceParent> {
    TraceParent::parse(headers.get(TRACEPARENT)?.to_str().ok()?)
}
