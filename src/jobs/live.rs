//! The jobs of this process that have not ended: how to stop them and how to wait for them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use tokio_util::sync::CancellationToken;

use super::clock::StageClock;
use super::store::JobId;
use crate::budget::StopFlag;

/// A job that has not ended.
#[derive(Debug, Default)]
pub(super) struct Live {
    pub(super) stop: StopFlag,
    /// Set when the server, not the caller, ends the job.
    pub(super) is_drained: OnceLock<()>,
    /// Set when a slot takes the job.
    pub(super) clock: OnceLock<StageClock>,
    /// Raised when the job has ended or is gone.
    pub(super) ended: CancellationToken,
}

/// All of them.
#[derive(Debug, Default)]
pub(super) struct LiveJobs(Mutex<HashMap<JobId, Arc<Live>>>);

impl LiveJobs {
    pub(super) fn insert(&self, id: JobId) -> Arc<Live> {
        let live = Arc::new(Live::default());
        self.lock().insert(id, Arc::clone(&live));
        live
    }

    pub(super) fn get(&self, id: JobId) -> Option<Arc<Live>> {
        self.lock().get(&id).cloned()
    }

    /// The job has ended: those who wait for it go on.
    pub(super) fn end(&self, id: JobId) {
        let live = self.lock().remove(&id);
        if let Some(live) = live {
            live.ended.cancel();
        }
    }

    pub(super) fn all(&self) -> Vec<(JobId, Arc<Live>)> {
        self.lock().iter().map(|(&id, live)| (id, Arc::clone(live))).collect()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<JobId, Arc<Live>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
