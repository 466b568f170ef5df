//! Traces for OpenTelemetry: spans of requests and jobs leave as OTLP over HTTP (feature `otel`).
//!
//! Where they go is said by the standard variables: without `OTEL_EXPORTER_OTLP_ENDPOINT` or
//! `OTEL_EXPORTER_OTLP_TRACES_ENDPOINT` none leave. They are sent in batches by a thread of their own, so that a collector
//! that does not answer costs spans, not requests.

use std::collections::HashMap;
use std::sync::OnceLock;

use axum::http::HeaderMap;
use opentelemetry::propagation::{Extractor, TextMapPropagator as _};
use opentelemetry::trace::TracerProvider as _;
use opentelemetry_sdk::Resource;
use opentelemetry_sdk::propagation::TraceContextPropagator;
use opentelemetry_sdk::trace::SdkTracerProvider;
use tracing::{Span, Subscriber};
use tracing_opentelemetry::OpenTelemetrySpanExt as _;
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::registry::LookupSpan;

const ENDPOINTS: [&str; 2] = ["OTEL_EXPORTER_OTLP_ENDPOINT", "OTEL_EXPORTER_OTLP_TRACES_ENDPOINT"];

static PROVIDER: OnceLock<SdkTracerProvider> = OnceLock::new();

/// The layer that sends spans; `None` where no collector is named.
pub(super) fn layer<S>() -> Option<Box<dyn Layer<S> + Send + Sync>>
where
    S: Subscriber + for<'span> LookupSpan<'span> + Send + Sync,
{
    if !ENDPOINTS.iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty())) {
        return None;
    }
    // The exporter's client may speak TLS.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let exporter = match opentelemetry_otlp::SpanExporter::builder().with_http().build() {
        Ok(exporter) => exporter,
        Err(error) => {
            tracing::warn!(%error, "traces cannot be sent");
            return None;
        }
    };
    let resource = Resource::builder().with_service_name("meshmend").build();
    let provider = SdkTracerProvider::builder().with_batch_exporter(exporter).with_resource(resource).build();
    let tracer = provider.tracer("meshmend");
    let _ = PROVIDER.set(provider);
    // Only spans of this program: those of the exporter's own client would make spans without end.
    let own = Targets::new().with_target("meshmend", LevelFilter::INFO);
    Some(tracing_opentelemetry::layer().with_tracer(tracer).with_filter(own).boxed())
}

/// Sends what is left, when the service ends.
pub(super) fn flush() {
    if let Some(provider) = PROVIDER.get() {
        // A collector that does not answer is no reason to stay.
        let _ = provider.shutdown();
    }
}

/// Names the span of a request by the conventions, and makes it a child of the caller's.
pub(super) fn describe_request(span: &Span, headers: &HeaderMap, method: &str, route: &str) {
    let parent = TraceContextPropagator::new().extract(&Headers(headers));
    let _ = span.set_parent(parent);
    span.set_attribute("otel.name", format!("{method} {route}"));
    span.set_attribute("http.request.method", method.to_owned());
    span.set_attribute("http.route", route.to_owned());
}

/// The span that this is called in, as a `traceparent`; `None` where no spans leave.
pub(super) fn current() -> Option<String> {
    let mut carrier = HashMap::new();
    TraceContextPropagator::new().inject_context(&Span::current().context(), &mut carrier);
    carrier.remove("traceparent")
}

struct Headers<'h>(&'h HeaderMap);

impl Extractor for Headers<'_> {
    fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key)?.to_str().ok()
    }

    fn keys(&self) -> Vec<&str> {
        self.0.keys().map(axum::http::HeaderName::as_str).collect()
    }
}
