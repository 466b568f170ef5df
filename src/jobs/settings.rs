//! What the operator may set.

use std::path::PathBuf;
use std::time::Duration;

use super::attempt::Isolation;
use super::capacity;
use super::child::Sandbox;
use super::webhook::WebhookSettings;
use crate::formats::ReadLimits;

/// Limits and places of the job service. The names are those of the configuration and of `/v1/limits`.
#[derive(Debug, Clone)]
pub struct JobsSettings {
    /// Directory for uploads and results; one server owns it.
    pub data_dir: PathBuf,
    /// Jobs that run at one time. Default: half the cores, because the engine's passes use several themselves.
    pub slots: usize,
    /// Jobs beside those, for small meshes that somebody waits for. Default 1.
    pub interactive_slots: usize,
    /// Largest upload of such a mesh, in bytes. Default 4 MiB.
    pub interactive_bytes_max: u64,
    /// Most memory that all running jobs may take together, as estimated, in bytes. Default: three quarters of the
    /// machine's.
    pub memory_bytes_max: u64,
    /// How webhooks are sent; `None`: not at all. Default: not at all.
    pub webhooks: Option<WebhookSettings>,
    /// Most queued jobs. Default 64.
    pub queue_max: usize,
    /// Most jobs kept, whatever their state; the oldest finished ones go first. Default 20,000.
    pub jobs_max: usize,
    /// Largest upload, in bytes. Default 512 MiB.
    pub upload_bytes_max: u64,
    /// Most bytes of uploads and results on disk; the oldest finished jobs go first. Default 20 GiB.
    pub data_bytes_max: u64,
    /// Bytes of the disk that stay free. Default 256 MiB.
    pub disk_free_bytes_min: u64,
    /// Time after which a job whose executor is not heard of is queued again. Default 30 s.
    pub lease: Duration,
    /// Lost runs after which a job fails. Default 3.
    pub attempts_max: u32,
    /// Time for which a finished job is kept. Default 24 h.
    pub result_ttl: Duration,
    /// Longest run of one job. Default 10 min.
    pub deadline_max: Duration,
    /// Most memory that one job may charge, in bytes. Default 4 GiB.
    pub engine_bytes_max: u64,
    /// Most work units of one job. Default 2^53 - 1, the largest integer that every JSON reader keeps.
    pub engine_work_max: u64,
    /// Engine threads of one job; 0: one for each core, which jobs share that run in threads of the server. Default 0.
    pub engine_threads: usize,
    /// Where a job runs. Default: in a thread, because another program's binary is not one that runs jobs.
    pub isolation: Isolation,
    /// How much of the sandbox there must be around a process that runs a job. Default: what the kernel has.
    pub sandbox: Sandbox,
    /// Limits on counts in a mesh.
    pub read_limits: ReadLimits,
    /// Time that running jobs get when the server shuts down. Default 25 s: less than the 30 s that container
    /// runtimes wait before they kill.
    pub drain_grace: Duration,
}

impl JobsSettings {
    /// The defaults, for the given data directory.
    pub fn new(data_dir: impl Into<PathBuf>) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        Self {
            data_dir: data_dir.into(),
            slots: (cores / 2).max(1),
            interactive_slots: 1,
            interactive_bytes_max: 4 << 20,
            memory_bytes_max: capacity::default_bytes_max(),
            webhooks: None,
            queue_max: 64,
            jobs_max: 20_000,
            upload_bytes_max: 512 << 20,
            data_bytes_max: 20 << 30,
            disk_free_bytes_min: 256 << 20,
            lease: Duration::from_secs(30),
            attempts_max: 3,
            result_ttl: Duration::from_secs(24 * 60 * 60),
            deadline_max: Duration::from_secs(10 * 60),
            engine_bytes_max: 4 << 30,
            engine_work_max: (1 << 53) - 1,
            engine_threads: 0,
            isolation: Isolation::default(),
            sandbox: Sandbox::default(),
            read_limits: ReadLimits::default(),
            drain_grace: Duration::from_secs(25),
        }
    }
}
