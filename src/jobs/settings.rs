//! What the operator may set.

use std::path::PathBuf;
use std::time::Duration;

use super::belonging::LostStore;
use super::child::Sandbox;
use super::memory;
use super::shared::SharedStores;
use super::webhook::WebhookSettings;
use crate::formats::ReadLimits;
use crate::wire::{Options, Problem, ProblemCode};

/// Where a job runs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Isolation {
    /// In a process of its own: the same binary, whose `main` calls [`run_job`](super::run_job).
    Process,
    /// In a thread of the server, which ends with it when it runs out of memory or overflows its stack.
    #[default]
    Thread,
}

/// Limits and places of the job service. The names are those of the configuration and of `/v1/limits`.
#[derive(Debug, Clone)]
pub struct JobsSettings {
    /// Directory for uploads and results; one server owns it.
    pub data_dir: PathBuf,
    /// Where rows and files are instead, when several servers share them. Default: in the directory.
    pub shared: Option<SharedStores>,
    /// Jobs that run at one time. Default: half the cores, because the engine's passes use several themselves, and one more,
    /// which no tenant has alone.
    pub slots: usize,
    /// Jobs beside those, for small meshes that somebody waits for. Default 2.
    pub interactive_slots: usize,
    /// Largest upload that may use an interactive slot, in bytes. Default 4 MiB.
    pub interactive_bytes_max: u64,
    /// Most memory that all running jobs may take together, as estimated, in bytes. Default: three quarters of the
    /// machine's.
    pub memory_bytes_max: u64,
    /// Time that a job may take in such a slot for each begun MiB of its upload; then it goes on as a large one. Default
    /// 10 s.
    pub interactive_deadline: Duration,
    /// What to do when the store of the stored files is gone. Default: not to start.
    pub lost_store: LostStore,
    /// The file of the key that seals secrets in the store. Default: `store.key` in the data directory.
    pub store_key_file: Option<PathBuf>,
    /// How webhooks are sent; `None`: not at all. Default: not at all.
    pub webhooks: Option<WebhookSettings>,
    /// Most queued jobs. Default 128.
    pub queue_max: usize,
    /// Most of them that are charged to one tenant, beside the rule that a tenant has no more than there are free places.
    /// Default: no further limit.
    pub owner_queue_max: Option<usize>,
    /// Most slots of each kind that jobs of one tenant have at one time, on all servers together. Default: all but one of each
    /// server.
    pub owner_slots_max: Option<usize>,
    /// Most jobs of one tenant that are kept; its oldest finished ones go first. Default: what others leave.
    pub owner_jobs_max: Option<usize>,
    /// Most bytes of uploads and results of one tenant; its oldest finished jobs go first. Default: what others leave.
    pub owner_data_bytes_max: Option<u64>,
    /// Most jobs kept, whatever their state; the oldest finished ones go first. Default 20,000.
    pub jobs_max: usize,
    /// Largest upload, in bytes. Default 512 MiB.
    pub upload_bytes_max: u64,
    /// Most uploads in pieces that no job has taken yet; one tenant has half of them at most. Default 1,000.
    pub uploads_max: usize,
    /// Time for which an upload in pieces is kept after its last bytes came. Default 24 h.
    pub upload_ttl: Duration,
    /// Time for which a presigned URL of the bucket is valid; `None`: none are given. Default: none.
    pub presigned_ttl: Option<Duration>,
    /// Most bytes of uploads and results on disk; the oldest finished jobs go first. Default 20 GiB.
    pub data_bytes_max: u64,
    /// Bytes of the disk that stay free. Default 256 MiB.
    pub disk_free_bytes_min: u64,
    /// Time after which a job is queued again whose server has stopped reporting. Default 30 s.
    pub lease: Duration,
    /// Longest time between two looks at what other servers do while these are heard. Default 5 s.
    pub look_every: Duration,
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
            shared: None,
            slots: (cores / 2).max(1) + 1,
            interactive_slots: 2,
            interactive_bytes_max: 4 << 20,
            interactive_deadline: Duration::from_secs(10),
            lost_store: LostStore::default(),
            store_key_file: None,
            memory_bytes_max: memory::default_bytes_max(),
            webhooks: None,
            queue_max: 128,
            owner_queue_max: None,
            owner_slots_max: None,
            owner_jobs_max: None,
            owner_data_bytes_max: None,
            jobs_max: 20_000,
            upload_bytes_max: 512 << 20,
            uploads_max: 1000,
            upload_ttl: Duration::from_secs(24 * 60 * 60),
            presigned_ttl: None,
            data_bytes_max: 20 << 30,
            disk_free_bytes_min: 256 << 20,
            lease: Duration::from_secs(30),
            look_every: Duration::from_secs(5),
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

    /// How many places of the queue one tenant may have when so many are free.
    pub(super) fn queue_share(&self, free: usize) -> usize {
        self.owner_queue_max.unwrap_or(usize::MAX).min(free)
    }

    /// How many of `slots` one tenant may have: of several one stays free for others.
    pub fn slots_share(&self, slots: usize) -> usize {
        self.owner_slots_max.unwrap_or(slots.saturating_sub(1)).max(1)
    }

    /// How long a job with an upload of that size may stay in a slot for small ones.
    pub(super) fn interactive_patience(&self, upload_bytes: u64) -> Duration {
        let begun = u32::try_from(upload_bytes.div_ceil(1 << 20)).unwrap_or(u32::MAX).max(1);
        self.interactive_deadline.saturating_mul(begun)
    }

    /// Time for which the files of a job are kept: the server's, or the caller's when that is shorter.
    pub(super) fn keep_for(&self, options: &Options) -> Duration {
        let asked = options.result_ttl.map(Duration::from_secs).unwrap_or(Duration::MAX);
        asked.min(self.result_ttl)
    }

    /// Refuses an upload of this size, or one that has reached it.
    pub(super) fn check_upload_size(&self, bytes: u64) -> Result<(), Problem> {
        let limit = self.upload_bytes_max;
        if bytes <= limit {
            return Ok(());
        }
        let detail = format!("the upload is over {limit} bytes");
        Err(Problem::new(ProblemCode::BodyTooLarge, detail).with_limit(
            "upload_bytes_max",
            limit,
            Some(bytes),
        ))
    }
}
