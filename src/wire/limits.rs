//! The limits that apply, as `/v1/limits` shows them and problems name them.

use serde::Serialize;
use utoipa::ToSchema;

/// Every limit of the service. The names are those of the configuration.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Limits {
    /// Largest upload, in bytes.
    pub upload_bytes_max: u64,
    /// Most uploads by `/v1/uploads` that no job has taken yet; one caller alone has half of them at most.
    pub uploads_max: usize,
    /// Most pieces in which the bytes of one such upload are stored.
    pub upload_pieces_max: usize,
    /// Time for which such an upload is kept after its last bytes came, in seconds.
    pub upload_ttl_s: u64,
    /// Time for which a presigned URL is valid, in seconds; 0: none are given.
    pub presigned_ttl_s: u64,
    /// Most triangles of a mesh after polygons are split.
    pub triangles_max: u32,
    /// Most vertices of a mesh.
    pub vertices_max: u32,
    /// Most corners of one polygon.
    pub polygon_corners_max: u32,
    /// Most memory that one job may charge, in bytes.
    pub engine_bytes_max: u64,
    /// Most work units of one job.
    pub engine_work_max: u64,
    /// Longest run of one job, in seconds.
    pub deadline_max_s: u64,
    /// Longest wait for a job in one request, in seconds.
    pub wait_max_s: u64,
    /// Wait for a job when the request does not say, in seconds.
    pub wait_default_s: u64,
    /// Most queued jobs.
    pub queue_max: usize,
    /// Most queued jobs of one caller (a key, or an address without keys); when others have jobs in the queue, no more than
    /// there are free places.
    pub owner_queue_max: usize,
    /// Most jobs of one caller that run at one time, beside those of `interactive_slots`.
    pub owner_slots_max: usize,
    /// Most jobs of one caller that are kept; when there is no room for more, no caller keeps more than the same number as all
    /// others.
    pub owner_jobs_max: usize,
    /// Most bytes of uploads and results of one caller; when there is no room for more, no caller keeps more than the same
    /// number as all others.
    pub owner_data_bytes_max: u64,
    /// Jobs that run at one time.
    pub slots: usize,
    /// Requests that one key, or one address without keys, may make in a minute; 0: any number.
    pub rate_per_minute: u32,
    /// Requests that one key, or one address without keys, may make at one time; 0: any number.
    pub rate_burst: u32,
    /// Jobs that run beside those of `slots`, for small meshes that somebody waits for.
    pub interactive_slots: usize,
    /// Largest upload that may use an interactive slot, in bytes.
    pub interactive_bytes_max: u64,
    /// Time that a job may take in an interactive slot for each begun MiB of its upload, in seconds; then it goes on in
    /// an ordinary slot.
    pub interactive_deadline_s: f64,
    /// Most memory that all running jobs may take together, as estimated, in bytes.
    pub memory_bytes_max: u64,
    /// Most calls of a webhook for one event; 0: none are made.
    pub webhook_attempts_max: u32,
    /// Most open connections.
    pub connections_max: usize,
    /// Most open connections of one address.
    pub address_connections_max: usize,
    /// Time for a request's header, in seconds.
    pub header_timeout_s: u64,
    /// Longest pause between two pieces of an upload, in seconds.
    pub upload_timeout_s: u64,
    /// Fewest bytes a second of an upload, on average after its first `upload_timeout_s`; 0: any number.
    pub upload_rate_min: u64,
    /// Longest time for a whole upload, in seconds.
    pub upload_total_timeout_s: u64,
    /// Time for which a client may take no byte of an answer, in seconds.
    pub write_timeout_s: u64,
    /// Largest path, query and header fields of a request together, in bytes.
    pub head_bytes_max: u64,
    /// Largest body or part that is JSON, in bytes.
    pub json_bytes_max: u64,
    /// Largest `material` part, in bytes.
    pub material_bytes_max: u64,
    /// Time for which a finished job is kept, in seconds.
    pub result_ttl_s: u64,
    /// Most bytes of uploads and results kept on disk.
    pub data_bytes_max: u64,
    /// Bytes of the disk that stay free.
    pub disk_free_bytes_min: u64,
    /// Most jobs kept, whatever their state.
    pub jobs_max: usize,
    /// Lost runs after which a job fails.
    pub attempts_max: u32,
    /// Most labels of a job.
    pub labels_max: usize,
    /// Most jobs of one page of the list.
    pub page_jobs_max: usize,
}
