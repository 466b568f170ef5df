//! Where a request belongs in a trace (W3C Trace Context).

use axum::extract::Request;
use axum::http::{HeaderMap, HeaderName};
use tracing::Span;

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

/// The trace id of a valid `traceparent`.
pub(super) fn trace_id(headers: &HeaderMap) -> Option<String> {
    let value = headers.get(TRACEPARENT)?.to_str().ok()?;
    let mut parts = value.split('-');
    let (version, trace, parent, flags) = (parts.next()?, parts.next()?, parts.next()?, parts.next()?);
    let is_hex = |text: &str, len| {
        text.len() == len && text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b))
    };
    let is_zero = |text: &str| text.bytes().all(|b| b == b'0');
    let is_form = is_hex(version, 2) && is_hex(trace, 32) && is_hex(parent, 16) && is_hex(flags, 2);
    let is_valid = is_form && version != "ff" && !is_zero(trace) && !is_zero(parent);
    is_valid.then(|| trace.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    #[test]
    fn a_trace_id_is_read_from_a_valid_traceparent_only() {
        let trace = |value: &'static str| {
            trace_id(&HeaderMap::from_iter([(TRACEPARENT, HeaderValue::from_static(value))]))
        };
        let valid = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
        assert_eq!(trace(valid).as_deref(), Some("4bf92f3577b34da6a3ce929d0e0e4736"));
        for broken in [
            "",
            "00",
            "00-xyz-00f067aa0ba902b7-01",
            "00-4bf92f3577b34da6a3ce929d0e0e4736-0-01",
            "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01",
            "00-00000000000000000000000000000000-00f067aa0ba902b7-01",
            "00-4bf92f3577b34da6a3ce929d0e0e4736-0000000000000000-01",
            "ff-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
        ] {
            assert_eq!(trace(broken), None, "{broken}");
        }
    }
}
