//! The face of the job service.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

use jiff::{SignedDuration, Timestamp};
use tokio::sync::Notify;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::attempt::{Engine, Executor};
use super::child::TrialError;
use super::drain::draining;
use super::live::LiveJobs;
use super::memory::MemoryStore;
use super::settings::JobsSettings;
use super::slot;
use super::spool::{OpenError, Spool};
use super::store::{Finish, JobId, JobRow, JobStore, StoreError};
use super::upload::Upload;
use super::view::{self, StoredFile, expired};
use super::{meters, retention};
use crate::budget::Stopped;
use crate::wire::{Job, JobState, Problem, ProblemCode, Progress};

/// The job service. Clones share it.
#[derive(Debug, Clone)]
pub struct Jobs(pub(super) Arc<Service>);

/// What the parts of the service share.
pub(super) struct Service {
    pub(super) settings: JobsSettings,
    pub(super) store: Arc<dyn JobStore>,
    pub(super) spool: Arc<Spool>,
    pub(super) executor: Executor,
    pub(super) live: LiveJobs,
    /// Wakes slots when a job is queued.
    pub(super) work: Notify,
    /// Raised when no more jobs are taken.
    pub(super) draining: CancellationToken,
    pub(super) slots: TaskTracker,
    /// Mean time of a run, in milliseconds, the latest ones counting most.
    pub(super) mean_run_ms: AtomicU64,
}

impl fmt::Debug for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Service").field("settings", &self.settings).finish_non_exhaustive()
    }
}

/// How busy the service is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Load {
    /// Jobs that wait.
    pub queued: usize,
    /// Jobs that run.
    pub running: usize,
    /// Bytes on disk.
    pub data_bytes: u64,
}

/// A service that cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The data directory cannot be used.
    #[error("data directory {path}: {source}")]
    DataDir {
        /// The directory.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Jobs cannot run as the settings ask.
    #[error(transparent)]
    Isolation(TrialError),
    /// Another server uses the data directory.
    #[error("data directory {path} is in use by another server")]
    DataDirInUse {
        /// The directory.
        path: PathBuf,
    },
}

impl Jobs {
    /// Opens the data directory (files of an earlier run go) and starts the slots. To be called inside a tokio runtime.
    ///
    /// # Errors
    /// The data directory cannot be used, another server uses it, or jobs cannot run as the settings ask.
    pub fn start(settings: JobsSettings) -> Result<Self, StartError> {
        Self::open(settings, Arc::<MemoryStore>::default(), Executor::of)
    }

    /// As [`start`](Self::start) with another store, and an engine that runs in threads of this process.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_with(
        settings: JobsSettings,
        store: Arc<dyn JobStore>,
        engine: Engine,
    ) -> Result<Self, StartError> {
        Self::open(settings, store, |_| Ok(Executor::Thread(engine)))
    }

    fn open(
        settings: JobsSettings,
        store: Arc<dyn JobStore>,
        executor: impl FnOnce(&JobsSettings) -> Result<Executor, TrialError>,
    ) -> Result<Self, StartError> {
        let path = settings.data_dir.clone();
        let spool = Spool::open(&path, settings.data_bytes_max).map_err(|error| match error {
            OpenError::InUse => StartError::DataDirInUse { path },
            OpenError::Io(source) => StartError::DataDir { path, source },
        })?;
        // With the spool this server owns the directory.
        let executor = executor(&settings).map_err(StartError::Isolation)?;
        let service = Arc::new(Service {
            settings,
            store,
            spool,
            executor,
            live: LiveJobs::default(),
            work: Notify::new(),
            draining: CancellationToken::new(),
            slots: TaskTracker::new(),
            mean_run_ms: AtomicU64::new(1000),
        });
        for _ in 0..service.settings.slots {
            service.slots.spawn(slot::serve(Arc::clone(&service)));
        }
        service.slots.spawn(retention::sweep_forever(Arc::clone(&service)));
        service.slots.close();
        Ok(Self(service))
    }

    /// The settings in force.
    pub fn settings(&self) -> &JobsSettings {
        &self.0.settings
    }

    /// Begins an upload; `announced` is its size where the caller says it.
    ///
    /// # Errors
    /// `body-too-large` (before any byte is taken), `storage-full`, `draining`.
    pub async fn upload(&self, announced: Option<u64>) -> Result<Upload, Problem> {
        self.0.check_open()?;
        if let Some(bytes) = announced {
            self.0.check_upload_size(bytes)?;
            if bytes > self.0.spool.bytes_max() {
                return Err(self.0.storage_full(bytes));
            }
        }
        Upload::begin(Arc::clone(&self.0)).await
    }

    /// Who submitted the job. Callers see only their own jobs.
    ///
    /// # Errors
    /// `not-found`.
    pub async fn owner(&self, id: JobId) -> Result<Option<String>, Problem> {
        Ok(self.0.row(id).await?.owner)
    }

    /// The job as it is now.
    ///
    /// # Errors
    /// `not-found`.
    pub async fn get(&self, id: JobId) -> Result<Job, Problem> {
        let row = self.0.row(id).await?;
        Ok(view::job(&row, self.0.live.get(id).as_deref()))
    }

    /// The job when it has ended, or as it is after `patience`.
    ///
    /// # Errors
    /// `not-found`, also when it is deleted meanwhile.
    pub async fn wait(&self, id: JobId, patience: Duration) -> Result<Job, Problem> {
        if let Some(live) = self.0.live.get(id) {
            // Either way the row says how the job is.
            let _ = tokio::time::timeout(patience, live.ended.cancelled()).await;
        }
        self.get(id).await
    }

    /// Asks the job to end; a queued one ends at once, a running one within moments, an ended one stays as it is.
    ///
    /// # Errors
    /// `not-found`.
    pub async fn cancel(&self, id: JobId) -> Result<Job, Problem> {
        let row = self.0.row(id).await?;
        if let Some(live) = self.0.live.get(id) {
            live.stop.cancel();
        }
        self.0.end_queued(&row, JobState::Cancelled, Problem::from(&Stopped::Cancelled)).await;
        self.get(id).await
    }

    /// Removes the job and its files; one that is running is cancelled first.
    ///
    /// # Errors
    /// `not-found`.
    pub async fn delete(&self, id: JobId) -> Result<(), Problem> {
        if let Some(live) = self.0.live.get(id) {
            live.stop.cancel();
        }
        let orphans = self.0.store.delete(id).await.map_err(|error| store_problem(&error))?;
        self.0.live.end(id);
        self.0.remove(&orphans);
        self.0.tell_load().await;
        Ok(())
    }

    /// The job's report (JSON), also of a refused repair.
    ///
    /// # Errors
    /// `not-found`, `job-not-finished`, `expired`, or the problem for which the job has no report.
    pub async fn report(&self, id: JobId) -> Result<StoredFile, Problem> {
        let row = self.0.row(id).await?;
        match &ended(&row)?.report {
            Some(blob) => StoredFile::open(&self.0.spool, blob, None, view::report_name(&row)).await,
            None => Err(reason_for_nothing(&row, "report")),
        }
    }

    /// The job's mesh; of several, the first.
    ///
    /// # Errors
    /// `not-found` (also when the operation gives no mesh), `job-not-finished`, `expired`, or the problem for which
    /// the job has none (with the report of a refused repair inside).
    pub async fn result(&self, id: JobId) -> Result<StoredFile, Problem> {
        self.level(id, 0).await
    }

    /// One of the job's meshes, by the place of its target, from 0.
    ///
    /// # Errors
    /// As [`result`](Self::result); `not-found` when there are fewer.
    pub async fn level(&self, id: JobId, level: usize) -> Result<StoredFile, Problem> {
        let row = self.0.row(id).await?;
        let finish = ended(&row)?;
        if finish.result.is_none() {
            return Err(self.with_report(reason_for_nothing(&row, "mesh"), id).await);
        }
        match finish.results().nth(level) {
            Some(result) => {
                let name = view::result_name(&row, result.encoding, level);
                StoredFile::open(&self.0.spool, &result.blob, Some(result.encoding), name).await
            }
            None => {
                let detail = format!("the job has {} meshes", finish.results().count());
                Err(Problem::new(ProblemCode::NotFound, detail))
            }
        }
    }

    /// All of the job's meshes.
    ///
    /// # Errors
    /// As [`result`](Self::result).
    pub async fn results(&self, id: JobId) -> Result<Vec<StoredFile>, Problem> {
        let mut files = vec![self.result(id).await?];
        let row = self.0.row(id).await?;
        for level in 1..ended(&row)?.results().count() {
            files.push(self.level(id, level).await?);
        }
        Ok(files)
    }

    /// The same problem with the job's report inside, when it is a refusal.
    async fn with_report(&self, problem: Problem, id: JobId) -> Problem {
        let is_refusal = matches!(problem.code, ProblemCode::NotRepairable | ProblemCode::MeshNonFinite);
        if !is_refusal {
            return problem;
        }
        let report = async { serde_json::from_slice(&self.report(id).await.ok()?.read().await.ok()?).ok() };
        Problem { report: report.await, ..problem }
    }

    /// How busy the service is.
    pub async fn load(&self) -> Load {
        let counts = self.0.store.counts().await.unwrap_or_default();
        Load { queued: counts.queued, running: counts.running, data_bytes: self.0.spool.bytes() }
    }

    #[cfg(test)]
    pub(super) fn service(&self) -> &Service {
        &self.0
    }
}

impl Service {
    pub(super) fn check_open(&self) -> Result<(), Problem> {
        if self.draining.is_cancelled() { Err(draining()) } else { Ok(()) }
    }

    /// Refuses an upload of this size, or one that has reached it.
    pub(super) fn check_upload_size(&self, bytes: u64) -> Result<(), Problem> {
        let limit = self.settings.upload_bytes_max;
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

    /// The row; one whose time is over has expired, whether or not the sweep has come by.
    pub(super) async fn row(&self, id: JobId) -> Result<JobRow, Problem> {
        let row = self.store.get(id).await.map_err(|error| store_problem(&error))?;
        let is_due = row.finish.as_ref().is_some_and(|finish| finish.expires_at <= now());
        if !is_due || row.state == JobState::Expired {
            return Ok(row);
        }
        self.expire(id).await;
        self.store.get(id).await.map_err(|error| store_problem(&error))
    }

    /// The end of `row` without files, now.
    pub(super) fn finish(&self, row: &JobRow, state: JobState, problem: Option<Problem>) -> Finish {
        let at = now();
        Finish {
            state,
            at,
            expires_at: self.expiry(row, at),
            progress: Progress { stage: None, fraction: 0.0 },
            outcome: None,
            problem,
            timing_ms: None,
            report: None,
            result: None,
            levels: Vec::new(),
        }
    }

    /// When a job that ends `at` must go: the server's time, or the caller's when that is shorter.
    pub(super) fn expiry(&self, row: &JobRow, at: Timestamp) -> Timestamp {
        let asked = row.options.result_ttl.map(Duration::from_secs).unwrap_or(Duration::MAX);
        let kept = asked.min(self.settings.result_ttl);
        at.saturating_add(SignedDuration::try_from(kept).unwrap_or(SignedDuration::MAX))
            .unwrap_or(Timestamp::MAX)
    }

    /// Ends the job if it is still queued.
    pub(super) async fn end_queued(&self, row: &JobRow, state: JobState, problem: Problem) {
        let finish = self.finish(row, state, Some(problem));
        match self.store.finish_queued(row.id, finish.clone()).await {
            Ok(true) => {
                self.live.end(row.id);
                meters::finished(row.operation, &finish);
            }
            Ok(false) => {}
            Err(error) => tracing::warn!(job = %row.id, %error, "a queued job could not be ended"),
        }
        self.tell_load().await;
    }

    /// Tells the metrics recorder how busy the service is.
    pub(super) async fn tell_load(&self) {
        if let Ok(counts) = self.store.counts().await {
            meters::load(counts, self.spool.bytes());
        }
    }
}

/// The time, to the millisecond.
pub(super) fn now() -> Timestamp {
    let now = Timestamp::now();
    now.round(jiff::Unit::Millisecond).unwrap_or(now)
}

/// How the job ended, if it has and its files are kept.
fn ended(row: &JobRow) -> Result<&Finish, Problem> {
    match (&row.finish, row.state) {
        (_, JobState::Expired) => Err(expired()),
        (Some(finish), _) => Ok(finish),
        (None, state) => {
            let problem = Problem::new(ProblemCode::JobNotFinished, format!("the job is {state}"));
            Err(problem.with_instance(format!("/v1/jobs/{}", row.id)))
        }
    }
}

/// Why an ended job lacks a file: its problem, or that its operation gives none.
fn reason_for_nothing(row: &JobRow, what: &str) -> Problem {
    let problem = row.finish.as_ref().and_then(|finish| finish.problem.clone());
    let none =
        || Problem::new(ProblemCode::NotFound, format!("the operation {} gives no {what}", row.operation));
    problem.unwrap_or_else(none).with_instance(format!("/v1/jobs/{}", row.id))
}

pub(super) fn not_found() -> Problem {
    Problem::new(ProblemCode::NotFound, "there is no such job")
}

/// A store's failure as the caller hears it.
pub(super) fn store_problem(error: &StoreError) -> Problem {
    match error {
        StoreError::NotFound => not_found(),
        StoreError::Unavailable(_) => {
            Problem::new(ProblemCode::StoreUnavailable, "the job store does not answer")
        }
        StoreError::QueueFull { .. } | StoreError::ClaimVoid => {
            Problem::new(ProblemCode::Internal, error.to_string())
        }
    }
}
