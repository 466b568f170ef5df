//! Health and metrics, on a listener of their own that is not for the public.

use std::sync::Arc;

use axum::Router;
use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use axum::routing::get;

use super::metrics;
use super::problem::{Handled, ProblemAnswer};
use super::router;
use super::state::{HttpService, State};
use crate::wire::ProblemCode;

/// The routes of the admin listener.
pub(super) fn router(service: Arc<HttpService>) -> Router {
    let routes = Router::new()
        .route("/livez", get(live))
        .route("/readyz", get(ready))
        .route("/metrics", get(render))
        .with_state(service);
    router::enveloped(router::complete(routes))
}

/// The process answers.
async fn live() -> &'static str {
    "live\n"
}

/// The service takes jobs.
async fn ready(state: State) -> Handled {
    if state.jobs.is_draining() {
        return Err(ProblemAnswer::new(ProblemCode::Draining, "the server is shutting down"));
    }
    Ok("ready\n".into_response())
}

/// Counts and durations in the text format of Prometheus.
async fn render(state: State) -> Response {
    // The age of the queue grows while nothing happens.
    state.jobs.load().await;
    let text =
        metrics::recorder().map(metrics_exporter_prometheus::PrometheusHandle::render).unwrap_or_default();
    ([(header::CONTENT_TYPE, "text/plain; version=0.0.4")], text).into_response()
}
