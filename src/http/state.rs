//! What handlers share.

use std::sync::Arc;

use axum::body::Bytes;

use super::body::BodyLimits;
use super::prefer::{WAIT_DEFAULT, WAIT_MAX};
use super::rate::Rates;
use super::settings::HttpSettings;
use super::sizes;
use crate::jobs::{JobId, Jobs, Tenant, UPLOAD_PIECES_MAX};
use crate::wire::{LABELS_MAX, Limits, Problem, ProblemCode};

/// The state of the router.
pub(super) type State = axum::extract::State<Arc<HttpService>>;

/// The service as handlers see it.
#[derive(Debug)]
pub(super) struct HttpService {
    pub(super) jobs: Jobs,
    pub(super) settings: HttpSettings,
    /// How many requests callers have made, if that is limited.
    pub(super) rates: Option<Rates>,
    /// The contract, as YAML.
    pub(super) openapi: Bytes,
    /// The contract, as JSON.
    pub(super) openapi_json: Bytes,
    /// The contract, as a page.
    pub(super) docs: Bytes,
}

/// Who sent a request. Jobs of one owner are invisible to others.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Caller {
    /// The name of the key; `None`: nobody by name.
    pub(super) owner: Option<String>,
    /// Whom what it asks for is charged to.
    pub(super) tenant: Tenant,
}

/// The job that an answer is about, for the request log.
#[derive(Debug, Clone)]
pub(super) struct AboutJob(pub(super) String);

impl HttpService {
    /// Limits of a body that brings a mesh and `extra` bytes beside it.
    pub(super) fn upload_limits(&self, extra: u64) -> BodyLimits {
        BodyLimits {
            idle_timeout: self.settings.upload_timeout,
            total_timeout: self.settings.upload_total_timeout,
            rate_min: self.settings.upload_rate_min,
            bytes_max: self.jobs.settings().upload_bytes_max.saturating_add(extra),
            bytes_max_name: "upload_bytes_max",
        }
    }

    /// The id that `text` is, if the caller may see such a job.
    pub(super) async fn visible(&self, text: &str, caller: &Caller) -> Result<JobId, Problem> {
        let unknown = || Problem::new(ProblemCode::NotFound, "there is no such job");
        let id = text.parse::<JobId>().map_err(|_| unknown())?;
        let owner = self.jobs.owner(id).await?;
        if owner == caller.owner { Ok(id) } else { Err(unknown()) }
    }

    /// Every limit, as `/v1/limits` shows them.
    pub(super) fn limits(&self) -> Limits {
        let (jobs, http) = (self.jobs.settings(), &self.settings);
        Limits {
            upload_bytes_max: jobs.upload_bytes_max,
            uploads_max: jobs.uploads_max,
            upload_pieces_max: UPLOAD_PIECES_MAX,
            upload_ttl_s: jobs.upload_ttl.as_secs(),
            presigned_ttl_s: jobs.presigned_ttl.map_or(0, |lasts| lasts.as_secs().max(1)),
            triangles_max: jobs.read_limits.triangles_max,
            vertices_max: jobs.read_limits.vertices_max,
            polygon_corners_max: jobs.read_limits.polygon_corners_max,
            engine_bytes_max: jobs.engine_bytes_max,
            engine_work_max: jobs.engine_work_max,
            deadline_max_s: jobs.deadline_max.as_secs(),
            wait_max_s: WAIT_MAX.as_secs(),
            wait_default_s: WAIT_DEFAULT.as_secs(),
            queue_max: jobs.queue_max,
            owner_queue_max: jobs.owner_queue_max.unwrap_or(jobs.queue_max.div_ceil(2)).min(jobs.queue_max),
            owner_slots_max: jobs.slots_share(jobs.slots),
            owner_jobs_max: jobs.owner_jobs_max.unwrap_or(jobs.jobs_max).min(jobs.jobs_max),
            owner_data_bytes_max: jobs
                .owner_data_bytes_max
                .unwrap_or(jobs.data_bytes_max)
                .min(jobs.data_bytes_max),
            slots: jobs.slots,
            interactive_slots: jobs.interactive_slots,
            interactive_bytes_max: jobs.interactive_bytes_max,
            interactive_deadline_s: jobs.interactive_deadline.as_secs_f64(),
            memory_bytes_max: jobs.memory_bytes_max,
            webhook_attempts_max: jobs.webhooks.as_ref().map_or(0, |webhooks| webhooks.retry.attempts_max),
            rate_per_minute: http.rate.map_or(0, |rate| rate.per_minute.get()),
            rate_burst: http.rate.map_or(0, |rate| rate.burst.get()),
            connections_max: http.connections_max,
            address_connections_max: http.connections_share(),
            header_timeout_s: http.header_timeout.as_secs(),
            upload_timeout_s: http.upload_timeout.as_secs(),
            upload_rate_min: http.upload_rate_min,
            upload_total_timeout_s: http.upload_total_timeout.as_secs(),
            write_timeout_s: http.write_timeout.as_secs(),
            head_bytes_max: sizes::HEAD_BYTES_MAX,
            json_bytes_max: sizes::JSON_BYTES_MAX,
            material_bytes_max: sizes::MATERIAL_BYTES_MAX,
            result_ttl_s: jobs.result_ttl.as_secs(),
            data_bytes_max: jobs.data_bytes_max,
            disk_free_bytes_min: jobs.disk_free_bytes_min,
            jobs_max: jobs.jobs_max,
            attempts_max: jobs.attempts_max,
            labels_max: LABELS_MAX,
            page_jobs_max: sizes::PAGE_MAX,
        }
    }
}
