//! What goes, and when: results after their time, the oldest ones when room is needed.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::Duration;

use tokio::task::JoinHandle;

use super::meters;
use super::service::{Service, store_problem};
use super::spool::{Space, claim_of};
use super::store::{AfterLoss, BlobRef, ClaimRef, JobId, Kept, Leases, StoreError, Tenant};
use super::upload::disk_problem;
use crate::wire::{Problem, ProblemCode};

/// Longest pause between two looks for results and leases whose time is over. Whoever asks for such a result finds it
/// expired anyway; this only says how long its bytes may stay on disk.
const SWEEP_EVERY: Duration = Duration::from_secs(10);
/// Shortest pause between two such looks, whatever the lease.
const SWEEP_PAUSE_MIN: Duration = Duration::from_millis(100);
/// Pause between two looks for files that nobody names. There are none unless a write to the store was cut off.
const COLLECT_EVERY: Duration = Duration::from_secs(600);

/// Looks for what is over until the service drains.
pub(super) async fn sweep_forever(service: Arc<Service>) {
    let pause = (service.settings.lease / 3).clamp(SWEEP_PAUSE_MIN, SWEEP_EVERY);
    let mut since_collection = Duration::ZERO;
    loop {
        tokio::select! {
            () = service.draining.cancelled() => return,
            () = tokio::time::sleep(pause) => service.sweep().await,
        }
        since_collection += pause;
        if since_collection >= COLLECT_EVERY {
            since_collection = Duration::ZERO;
            if let Err(error) = service.collect_orphans().await {
                tracing::warn!(error = error.detail, "files that nobody names could not be found");
            }
        }
    }
}

impl Service {
    /// Expires every result whose time is over, and queues every job again whose executor is lost.
    pub(super) async fn sweep(&self) {
        match self.store.due().await {
            Ok(due) => {
                for id in due {
                    self.expire(id).await;
                }
            }
            Err(error) => tracing::error!(%error, "expired jobs could not be found"),
        }
        if let Err(error) = self.recover(Leases::Expired).await {
            tracing::error!(%error, "lost jobs could not be found");
        }
        self.note_load();
    }

    /// Queues jobs again whose executor is lost, or ends them when that was once too often.
    pub(super) async fn recover(&self, leases: Leases) -> Result<(), StoreError> {
        let problem = Problem::new(ProblemCode::WorkerLost, "the process that ran the job went away");
        for (id, after) in self.store.recover(leases, problem, self.settings.attempts_max).await? {
            tracing::warn!(job = %id, ?after, "the executor of a job is lost");
            let row = self.store.get(id).await;
            if let Some(live) = self.live.get(id) {
                live.make_void();
            }
            if let Ok(row) = row {
                meters::lost(row.operation, 1);
                if let Some(ending) = &row.ending {
                    meters::finished(row.operation, ending);
                }
            }
            match after {
                AfterLoss::Queued => self.live.requeue(id),
                AfterLoss::Ended => self.live.end(id),
            }
        }
        self.work.notify_waiters();
        Ok(())
    }

    /// Removes files that no row names and no claim may still name: what a write to the store that was cut off left.
    pub(super) async fn collect_orphans(&self) -> Result<(), Problem> {
        let spool = Arc::clone(&self.spool);
        let listed = on_disk(move || spool.list()).await?;
        let claims: HashSet<ClaimRef> = listed.iter().filter_map(|blob| claim_of(&blob.key)).collect();
        // A file of a run that ends now is named by the time the names are asked for.
        let current =
            self.store.current(claims.into_iter().collect()).await.map_err(|e| store_problem(&e))?;
        let keys = listed.iter().map(|blob| blob.key.clone()).collect();
        let named = self.store.named(keys).await.map_err(|error| store_problem(&error))?;
        let is_live =
            |key: &str| named.contains(key) || claim_of(key).is_some_and(|claim| current.contains(&claim));
        let orphans: Vec<_> = listed.into_iter().filter(|blob| !is_live(&blob.key)).collect();
        let spool = Arc::clone(&self.spool);
        on_disk(move || {
            spool.remove_orphans(&orphans);
            Ok(())
        })
        .await
    }

    /// The files of an ended job go, its row stays.
    pub(super) async fn expire(&self, id: JobId) {
        match self.store.expire(id).await {
            Ok(orphans) => self.remove(&orphans),
            Err(error) => tracing::warn!(job = %id, %error, "a job could not be expired"),
        }
    }

    /// Room for files of a tenant, made by expiring jobs that have ended. When the disk itself is short of room no result
    /// goes for it: whatever fills the disk would take them all, one after the other.
    pub(super) async fn make_room(&self, tenant: &Tenant, bytes: u64) -> Result<Space, Problem> {
        loop {
            if bytes > 0 && self.spool.is_disk_short_of(bytes) {
                return Err(self.storage_full(bytes));
            }
            let first = if self.is_over_own_bytes(tenant, bytes).await? {
                self.store.first_to_go_of(Kept::WithFiles, tenant.clone()).await
            } else if let Some(space) = self.spool.reserve(bytes) {
                return Ok(space);
            } else {
                self.store.first_to_go(Kept::WithFiles, tenant.clone()).await
            };
            let first = first.map_err(|error| store_problem(&error))?;
            let Some(first) = first else { return Err(self.storage_full(bytes)) };
            tracing::info!(job = %first, "expired early to make room");
            match self.store.expire(first).await {
                Ok(orphans) => self.remove(&orphans),
                // Another one, who needs room too, was quicker.
                Err(StoreError::NotFound) => {}
                Err(error) => return Err(store_problem(&error)),
            }
        }
    }

    /// Whether `bytes` more are over what the operator allows one tenant.
    async fn is_over_own_bytes(&self, tenant: &Tenant, bytes: u64) -> Result<bool, Problem> {
        match self.settings.owner_data_bytes_max.filter(|_| bytes > 0 && !tenant.is_nobody()) {
            Some(limit) => Ok(self.holding(tenant).await?.bytes.saturating_add(bytes) > limit),
            None => Ok(false),
        }
    }

    pub(super) fn storage_full(&self, bytes: u64) -> Problem {
        if self.spool.is_disk_short_of(bytes) {
            let limit = self.settings.disk_free_bytes_min;
            return Problem::new(ProblemCode::StorageFull, "the disk is nearly full").with_limit(
                "disk_free_bytes_min",
                limit,
                None,
            );
        }
        let limit = self.spool.bytes_max();
        Problem::new(ProblemCode::StorageFull, "unfinished jobs and uploads fill the data directory")
            .with_limit("data_bytes_max", limit, Some(self.spool.bytes().saturating_add(bytes)))
    }

    /// Makes place for one more row of a tenant: at the limit, a job that has ended goes altogether.
    pub(super) async fn make_place(&self, tenant: &Tenant) -> Result<(), Problem> {
        loop {
            let counts = self.store.counts().await.map_err(|error| store_problem(&error))?;
            let first = if self.is_over_own_jobs(tenant).await? {
                self.store.first_to_go_of(Kept::Any, tenant.clone()).await
            } else if counts.all < self.settings.jobs_max {
                return Ok(());
            } else {
                self.store.first_to_go(Kept::Any, tenant.clone()).await
            };
            // Where none has ended that may go, rows wait or run or are within the share of others: the queue, slots and
            // shares bound them.
            let Some(first) = first.map_err(|error| store_problem(&error))? else { return Ok(()) };
            match self.store.delete(first).await {
                Ok(orphans) => self.remove(&orphans),
                // As above.
                Err(StoreError::NotFound) => {}
                Err(error) => return Err(store_problem(&error)),
            }
        }
    }

    /// Whether one more job is over what the operator allows one tenant.
    async fn is_over_own_jobs(&self, tenant: &Tenant) -> Result<bool, Problem> {
        match self.settings.owner_jobs_max.filter(|_| !tenant.is_nobody()) {
            Some(limit) => Ok(self.holding(tenant).await?.jobs >= limit as u64),
            None => Ok(false),
        }
    }

    /// Removes files that no row names.
    pub(super) fn remove(&self, orphans: &[BlobRef]) {
        for blob in orphans {
            self.spool.remove(blob);
        }
    }
}

/// Runs what waits for the disk on a thread that may wait.
pub(super) async fn on_disk<T: Send + 'static>(
    body: impl FnOnce() -> std::io::Result<T> + Send + 'static,
) -> Result<T, Problem> {
    joined(tokio::task::spawn_blocking(body)).await
}

/// What came of work that waits for the disk on another thread.
pub(super) async fn joined<T>(work: JoinHandle<std::io::Result<T>>) -> Result<T, Problem> {
    let lost = |_| Problem::new(ProblemCode::Internal, "a file could not be written");
    work.await.map_err(lost)?.map_err(|error| disk_problem(&error))
}
