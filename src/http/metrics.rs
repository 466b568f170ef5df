//! Counts and durations for Prometheus.

use std::sync::OnceLock;
use std::time::Duration;

use axum::http::Method;
use metrics::{counter, describe_counter, describe_gauge, describe_histogram, gauge, histogram};
use metrics_exporter_prometheus::{PrometheusBuilder, PrometheusHandle};

const REQUESTS: &str = "meshmend_http_requests_total";
const SECONDS: &str = "meshmend_http_request_seconds";
const CONNECTIONS: &str = "meshmend_http_connections";
const CLOSED_AT_ONCE: &str = "meshmend_http_connections_closed_total";

/// Upper ends of the buckets of [`SECONDS`]: from an answer at once to the longest wait.
const SECONDS_BUCKETS: [f64; 10] = [0.005, 0.02, 0.1, 0.5, 2.0, 10.0, 30.0, 60.0, 120.0, 300.0];

/// Time between two [`keep_up`] rounds.
const UPKEEP: Duration = Duration::from_secs(5);

static RECORDER: OnceLock<Option<PrometheusHandle>> = OnceLock::new();

/// Starts to count, once for the process; gives what renders the counts. `None` when another recorder is in place.
pub(super) fn recorder() -> Option<&'static PrometheusHandle> {
    RECORDER.get_or_init(install).as_ref()
}

fn install() -> Option<PrometheusHandle> {
    let handle = PrometheusBuilder::new().set_buckets(&SECONDS_BUCKETS).ok()?.install_recorder().ok()?;
    describe_counter!(REQUESTS, "Requests answered, by method, route and status.");
    describe_histogram!(SECONDS, "Time from a request's head to its answer's head, in seconds.");
    describe_gauge!(CONNECTIONS, "Open connections.");
    describe_counter!(
        CLOSED_AT_ONCE,
        "Connections closed at once because their address had as many as it may."
    );
    crate::jobs::describe_metrics();
    Some(handle)
}

/// Sums up the samples of durations now and then, so that they do not pile up where nobody asks for them. Never ends.
pub(super) async fn keep_up() {
    loop {
        if let Some(recorder) = recorder() {
            recorder.run_upkeep();
        }
        tokio::time::sleep(UPKEEP).await;
    }
}

/// Counts an answer.
pub(super) fn count_request(method: &Method, route: &str, status: u16, elapsed: Duration) {
    // Methods of the client's own invention must not become series.
    let known = [
        Method::GET,
        Method::HEAD,
        Method::POST,
        Method::PUT,
        Method::DELETE,
        Method::OPTIONS,
        Method::PATCH,
    ];
    let method = known.iter().find(|known| *known == method).map_or("other", Method::as_str).to_owned();
    counter!(REQUESTS, "method" => method, "route" => route.to_owned(), "status" => status.to_string())
        .increment(1);
    histogram!(SECONDS, "route" => route.to_owned()).record(elapsed.as_secs_f64());
}

/// Counts a connection over the share of its address.
pub(super) fn count_closed_at_once() {
    counter!(CLOSED_AT_ONCE).increment(1);
}

/// An open connection, counted until dropped.
pub(super) struct OpenConnection;

impl OpenConnection {
    pub(super) fn new() -> Self {
        gauge!(CONNECTIONS).increment(1.0);
        Self
    }
}

impl Drop for OpenConnection {
    fn drop(&mut self) {
        gauge!(CONNECTIONS).decrement(1.0);
    }
}
