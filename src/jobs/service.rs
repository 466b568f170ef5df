//! What the parts of the service share.

use std::fmt;
use std::sync::Arc;

use tokio::sync::Notify;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::arrivals::Arrivals;
use super::capacity::Capacity;
use super::data_dir::DataDirLock;
use super::executor::Executor;
use super::live::LiveJobs;
use super::pace::Pace;
use super::problems::{draining, expired, store_problem};
use super::settings::JobsSettings;
use super::shares::Incoming;
use super::spool::Spool;
use super::store::{JobStore, StoreError};
use super::webhook::Vault;
use crate::wire::{Problem, ProblemCode};

/// The state of a service. It knows its parts, and none of them knows it; what it does with them stands in the files of
/// its uses: admission, running, keeping and giving.
pub(super) struct Service {
    pub(super) settings: Arc<JobsSettings>,
    pub(super) store: Arc<dyn JobStore>,
    pub(super) spool: Arc<Spool>,
    pub(super) executor: Executor,
    /// Memory for runs.
    pub(super) capacity: Capacity,
    /// Name of this service in the store.
    pub(super) worker: String,
    pub(super) live: LiveJobs,
    pub(super) arrivals: Arc<Arrivals>,
    pub(super) incoming: Arc<Incoming>,
    pub(super) pace: Arc<Pace>,
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
    /// Held as long as the stores are used.
    pub(super) _lock: Option<DataDirLock>,
}

impl fmt::Debug for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Service").field("settings", &self.settings).finish_non_exhaustive()
    }
}

impl Service {
    pub(super) fn check_open(&self) -> Result<(), Problem> {
        if self.draining.is_cancelled() { Err(draining()) } else { Ok(()) }
    }

    /// The load has changed.
    pub(super) fn note_load(&self) {
        self.arrivals.forget();
        self.load_changed.notify_one();
    }

    /// Why a job or an upload has no place in the queue.
    pub(super) fn not_admitted(&self, error: &StoreError) -> Problem {
        let (limit_name, limit, queued) = match *error {
            StoreError::QueueFull { queued } => ("queue_max", self.settings.queue_max, queued),
            StoreError::ShareFull { queued, limit } => ("owner_queue_max", limit, queued),
            StoreError::NotFound => return expired(),
            _ => return store_problem(error),
        };
        let full = Problem::new(ProblemCode::QueueFull, error.to_string());
        Problem {
            retry_after_s: Some(self.pace.retry_after_s()),
            ..full.with_limit(limit_name, limit as u64, Some(queued as u64 + 1))
        }
    }
}
