//! The face of the job service.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

use tokio::sync::Notify;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::arrivals::Arrivals;
use super::attempt::{Engine, Executor};
use super::belonging::open_together;
use super::capacity::Capacity;
use super::child::TrialError;
use super::drain::draining;
use super::heartbeat::end_overdue;
use super::live::LiveJobs;
use super::settings::JobsSettings;
use super::shares::Incoming;
use super::slot::{self, SlotKind};
use super::spool::{OpenError, SpaceLimits, Spool};
use super::store::{Ending, JobId, JobRow, JobStore, Leases, ListQuery, StoreError, Tenant, Webhook};
use super::upload::Upload;
use super::view;
use super::webhook::{Sender, Vault, WebhookSettings};
use super::{load, meters, retention, webhook};
use crate::budget::Stopped;
use crate::wire::{Delivery, Job, JobState, Options, Problem, ProblemCode, WebhookRequest};

/// The job service. Clones share it.
#[derive(Debug, Clone)]
pub struct Jobs(pub(super) Arc<Service>);

/// What the parts of the service share.
pub(super) struct Service {
    pub(super) settings: JobsSettings,
    pub(super) store: Arc<dyn JobStore>,
    pub(super) spool: Arc<Spool>,
    pub(super) executor: Executor,
    /// Memory for runs.
    pub(super) capacity: Capacity,
    /// Name of this process in the store.
    pub(super) worker: String,
    pub(super) live: LiveJobs,
    pub(super) arrivals: Arrivals,
    pub(super) incoming: Incoming,
    /// Seals the secrets of jobs; `None`: no webhooks are sent.
    pub(super) vault: Option<Arc<Vault>>,
    /// Wakes slots when a job is queued.
    pub(super) work: Notify,
    /// Asks for the load to be told anew.
    pub(super) load_changed: Notify,
    /// Raised when no more jobs are taken.
    pub(super) draining: CancellationToken,
    /// Raised when no job runs any more.
    pub(super) stopping: CancellationToken,
    pub(super) slots: TaskTracker,
    /// Mean time of a run, in milliseconds, the latest ones counting most.
    pub(super) mean_run_ms: AtomicU64,
}

impl fmt::Debug for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Service").field("settings", &self.settings).finish_non_exhaustive()
    }
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
    /// The rows of jobs cannot be read.
    #[error("job store {path}: {why}")]
    Store {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// Jobs cannot run as the settings ask.
    #[error(transparent)]
    Isolation(#[from] TrialError),
    /// Webhooks cannot be sent.
    #[error("webhooks cannot be sent: {why}")]
    Webhooks {
        /// Why.
        why: String,
    },
    /// Another server uses the data directory.
    #[error("data directory {path} is in use by another server")]
    DataDirInUse {
        /// The directory.
        path: PathBuf,
    },
}

/// The file of rows in the data directory.
const STORE_FILE: &str = "jobs.sqlite3";
/// The file of the key of secrets, when the operator names no other.
const KEY_FILE: &str = "store.key";

/// What seals secrets, and what sends webhooks.
type Sending = (Arc<Vault>, Arc<Sender>);

/// What webhooks need; `None`: none are sent.
fn webhooks(settings: &JobsSettings) -> Result<Option<Sending>, String> {
    let Some(webhooks) = settings.webhooks.clone() else { return Ok(None) };
    let path = settings.store_key_file.clone().unwrap_or_else(|| settings.data_dir.join(KEY_FILE));
    let vault = Arc::new(Vault::open(&path).map_err(|error| error.to_string())?);
    let sender = Sender::new(webhooks, Arc::clone(&vault)).map_err(|error| error.to_string())?;
    Ok(Some((vault, Arc::new(sender))))
}

impl Jobs {
    /// Opens the data directory and starts the slots: jobs of an earlier run go on. To be called inside a tokio runtime.
    ///
    /// # Errors
    /// The data directory cannot be used, another server uses it, or jobs cannot run as the settings ask.
    pub async fn start(settings: JobsSettings) -> Result<Self, StartError> {
        Self::open(settings, None).await
    }

    /// As [`start`](Self::start) with another engine, which runs in threads of this process.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub async fn start_with(settings: JobsSettings, engine: Engine) -> Result<Self, StartError> {
        Self::open(settings, Some(Executor::Thread(engine))).await
    }

    async fn open(settings: JobsSettings, executor: Option<Executor>) -> Result<Self, StartError> {
        let path = settings.data_dir.clone();
        let space =
            SpaceLimits { bytes_max: settings.data_bytes_max, free_bytes_min: settings.disk_free_bytes_min };
        let spool = Spool::take_over(&path, space).await.map_err(|error| match error {
            OpenError::InUse => StartError::DataDirInUse { path: path.clone() },
            OpenError::Io(source) => StartError::DataDir { path: path.clone(), source },
        })?;
        let executor = match executor {
            Some(executor) => executor,
            None => Executor::of(&settings).await?,
        };
        let data_dir = path;
        let path = data_dir.join(STORE_FILE);
        let unusable = |why: String| StartError::Store { path: path.clone(), why };
        let store = open_together(&data_dir, &path, &spool, settings.lost_store)
            .map_err(|error| unusable(error.to_string()))?;
        let (vault, sender) = webhooks(&settings).map_err(|why| StartError::Webhooks { why })?.unzip();
        let service = Arc::new(Service {
            capacity: Capacity::of(&settings),
            settings,
            store: Arc::new(store),
            spool,
            executor,
            worker: uuid::Uuid::now_v7().to_string(),
            live: LiveJobs::default(),
            arrivals: Arrivals::default(),
            incoming: Incoming::default(),
            vault,
            work: Notify::new(),
            load_changed: Notify::new(),
            draining: CancellationToken::new(),
            stopping: CancellationToken::new(),
            slots: TaskTracker::new(),
            mean_run_ms: AtomicU64::new(1000),
        });
        service.take_over().await.map_err(|problem| unusable(problem.detail))?;
        let general = std::iter::repeat_n(SlotKind::General, service.settings.slots);
        let interactive = std::iter::repeat_n(SlotKind::Interactive, service.settings.interactive_slots);
        for kind in general.chain(interactive) {
            service.slots.spawn(slot::serve(Arc::clone(&service), kind));
        }
        if let Some(sender) = sender {
            tokio::spawn(sender.send_forever(Arc::clone(&service)));
        }
        service.slots.spawn(retention::sweep_forever(Arc::clone(&service)));
        service.slots.spawn(load::tell_forever(Arc::clone(&service)));
        service.slots.close();
        Ok(Self(service))
    }

    /// The settings in force.
    pub fn settings(&self) -> &JobsSettings {
        &self.0.settings
    }

    /// Begins the upload of a mesh; `announced` is its size where the caller says it.
    ///
    /// # Errors
    /// `body-too-large` (before any byte is taken), `queue-full`, `storage-full`, `draining`.
    pub async fn upload(&self, announced: Option<u64>) -> Result<Upload, Problem> {
        self.upload_of(Tenant::nobody(), announced).await
    }

    /// As [`upload`](Self::upload), charged to a tenant.
    ///
    /// # Errors
    /// As [`upload`](Self::upload), and when the tenant has its share of what is left.
    pub async fn upload_of(&self, tenant: Tenant, announced: Option<u64>) -> Result<Upload, Problem> {
        self.begin_upload(tenant, announced).await.inspect_err(meters::refused)
    }

    /// Begins the upload of what belongs to a mesh: it needs no place of its own in the queue.
    ///
    /// # Errors
    /// `storage-full`, `draining`.
    pub async fn upload_beside(&self, tenant: Tenant) -> Result<Upload, Problem> {
        let begin = async {
            self.0.check_open()?;
            Upload::begin(Arc::clone(&self.0), tenant, false).await
        };
        begin.await.inspect_err(meters::refused)
    }

    async fn begin_upload(&self, tenant: Tenant, announced: Option<u64>) -> Result<Upload, Problem> {
        self.0.check_open()?;
        // Told now, the refusal costs neither the caller the upload nor this server the disk.
        self.0.check_queue(&tenant).await?;
        if let Some(bytes) = announced {
            self.0.check_upload_size(bytes)?;
            if bytes > self.0.spool.bytes_max() || self.0.spool.is_disk_short_of(bytes) {
                return Err(self.0.storage_full(bytes));
            }
            self.0.check_open_bytes(&tenant, 0, bytes).await?;
        }
        Upload::begin(Arc::clone(&self.0), tenant, true).await
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

    /// The job when it has ended, or as it is after `patience`, or when the server ends before it.
    ///
    /// # Errors
    /// `not-found`, also when it is deleted meanwhile.
    pub async fn wait(&self, id: JobId, patience: Duration) -> Result<Job, Problem> {
        let service = &self.0;
        let patience = tokio::time::sleep(patience);
        tokio::pin!(patience);
        loop {
            let is_draining = service.draining.is_cancelled();
            let live = service.live.watch(id);
            let row = service.row(id).await.inspect_err(|_| service.live.end(id))?;
            if row.state.is_final() {
                service.live.end(id);
                return Ok(view::job(&row, None));
            }
            if (is_draining && row.state == JobState::Queued) || service.stopping.is_cancelled() {
                return Ok(view::job(&row, Some(&live)));
            }
            tokio::select! {
                () = live.job.ended.cancelled() => {}
                () = service.draining.cancelled(), if !is_draining => {}
                () = service.stopping.cancelled() => {}
                () = &mut patience => return self.get(id).await,
            }
        }
    }

    /// Jobs of one owner, the latest first.
    ///
    /// # Errors
    /// `store-unavailable`.
    pub async fn list(&self, query: ListQuery) -> Result<Vec<Job>, Problem> {
        let rows = self.0.store.list(query).await.map_err(|error| store_problem(&error))?;
        let mut jobs = Vec::with_capacity(rows.len());
        for mut row in rows {
            if row.is_due() {
                self.0.expire(row.id).await;
                row.state = JobState::Expired;
            }
            jobs.push(view::job(&row, self.0.live.get(row.id).as_deref()));
        }
        Ok(jobs)
    }

    /// Asks the job to end; a queued one ends at once, a running one within moments, an ended one stays as it is.
    ///
    /// # Errors
    /// `not-found`.
    pub async fn cancel(&self, id: JobId) -> Result<Job, Problem> {
        let service = &self.0;
        let row = service.row(id).await?;
        let problem = Problem::from(&Stopped::Cancelled);
        let ending = Ending::without_files(JobState::Cancelled, Some(problem));
        if !row.state.is_final() {
            // Also a slot that claims the job in this moment is to hear of it.
            service.live.cancel(id);
            let was_queued =
                service.store.cancel(id, ending.clone()).await.map_err(|error| store_problem(&error))?;
            if was_queued {
                meters::finished(row.operation, &ending);
            }
        }
        let row = service.row(id).await.inspect_err(|_| service.live.end(id))?;
        if row.state.is_final() {
            service.live.end(id);
            service.note_load();
        }
        Ok(view::job(&row, service.live.get(id).as_deref()))
    }

    /// Takes a webhook that a caller asks for.
    ///
    /// # Errors
    /// `webhook-refused`.
    pub fn admit_webhook(&self, asked: WebhookRequest) -> Result<Webhook, Problem> {
        WebhookSettings::admit(self.0.settings.webhooks.as_ref(), asked)
    }

    /// The webhooks of a job.
    ///
    /// # Errors
    /// `store-unavailable`.
    pub async fn deliveries(&self, id: JobId) -> Result<Vec<Delivery>, Problem> {
        let found = self.0.store.deliveries(id).await.map_err(|error| store_problem(&error))?;
        Ok(found.iter().map(webhook::view).collect())
    }

    /// Makes a webhook of a job due again.
    ///
    /// # Errors
    /// `not-found`, `store-unavailable`.
    pub async fn redeliver(&self, id: JobId, delivery: String) -> Result<Delivery, Problem> {
        let due = self.0.store.redeliver(id, delivery).await.map_err(|error| match error {
            StoreError::NotFound => Problem::new(ProblemCode::NotFound, "there is no such delivery"),
            error => store_problem(&error),
        })?;
        Ok(webhook::view(&due))
    }

    /// Removes the job and its files; one that is running is cancelled first.
    ///
    /// # Errors
    /// `not-found`.
    pub async fn delete(&self, id: JobId) -> Result<(), Problem> {
        if let Some(live) = self.0.live.get(id) {
            live.make_void();
        }
        let orphans = self.0.store.delete(id).await.map_err(|error| store_problem(&error))?;
        self.0.live.end(id);
        self.0.remove(&orphans);
        self.0.note_load();
        Ok(())
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

    /// What an earlier run of the server left: its runs are lost, its files are named by rows or go.
    async fn take_over(self: &Arc<Self>) -> Result<(), Problem> {
        self.recover(Leases::All).await.map_err(|error| store_problem(&error))?;
        self.collect_orphans().await?;
        self.seal_old_secrets().await?;
        for (id, at) in self.store.deadlines().await.map_err(|error| store_problem(&error))? {
            tokio::spawn(end_overdue(Arc::clone(self), id, at));
        }
        Ok(())
    }

    /// Secrets that an older program stored as they are.
    async fn seal_old_secrets(&self) -> Result<(), Problem> {
        let Some(vault) = self.vault.clone() else { return Ok(()) };
        let seal = Box::new(move |secret: &str| vault.seal_if_plain(secret).ok().flatten());
        let sealed = self.store.seal_secrets(seal).await.map_err(|error| store_problem(&error))?;
        if sealed > 0 {
            tracing::info!(sealed, "webhook secrets in the store are sealed now");
        }
        Ok(())
    }

    /// The row; one whose time is over has expired, whether or not the sweep has come by.
    pub(super) async fn row(&self, id: JobId) -> Result<JobRow, Problem> {
        let row = self.store.get(id).await.map_err(|error| store_problem(&error))?;
        if !row.is_due() {
            return Ok(row);
        }
        self.expire(id).await;
        self.store.get(id).await.map_err(|error| store_problem(&error))
    }

    /// Time for which the files of a job are kept: the server's, or the caller's when that is shorter.
    pub(super) fn keep_for(&self, options: &Options) -> Duration {
        let asked = options.result_ttl.map(Duration::from_secs).unwrap_or(Duration::MAX);
        asked.min(self.settings.result_ttl)
    }

    /// Ends the job if it is still queued.
    pub(super) async fn end_queued(&self, row: &JobRow, state: JobState, problem: Problem) {
        let ending = Ending::without_files(state, Some(problem));
        match self.store.end_queued(row.id, ending.clone()).await {
            Ok(true) => {
                self.live.end(row.id);
                meters::finished(row.operation, &ending);
            }
            Ok(false) => {}
            Err(error) => tracing::warn!(job = %row.id, %error, "a queued job could not be ended"),
        }
        self.note_load();
    }
}

pub(super) fn not_found() -> Problem {
    Problem::new(ProblemCode::NotFound, "there is no such job")
}

/// A store's failure as the caller hears it.
pub(super) fn store_problem(error: &StoreError) -> Problem {
    match error {
        StoreError::NotFound => not_found(),
        StoreError::Unavailable(_) => {
            tracing::error!(%error, "the job store does not answer");
            Problem::new(ProblemCode::StoreUnavailable, "the job store does not answer")
        }
        StoreError::Full(_) => {
            Problem::new(ProblemCode::StorageFull, "the disk is full: the job store cannot write")
        }
        StoreError::KeyReused => Problem::new(
            ProblemCode::IdempotencyKeyReused,
            "the `Idempotency-Key` was used with another mesh, operation or options",
        ),
        StoreError::QueueFull { .. } | StoreError::ShareFull { .. } | StoreError::ClaimVoid => {
            Problem::new(ProblemCode::Internal, error.to_string())
        }
    }
}
