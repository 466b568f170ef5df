//! What goes, and when: results after their time, the oldest ones when room is needed.

use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;

use super::service::{Service, now, store_problem};
use super::spool::Space;
use super::store::{BlobRef, JobId, JobRow, Kept};
use super::upload::disk_problem;
use crate::wire::{Problem, ProblemCode};

/// Pause between two looks for results whose time is over. Whoever asks for such a result finds it expired anyway;
/// this only says how long its bytes may stay on disk.
const SWEEP_EVERY: Duration = Duration::from_secs(10);

/// Looks for results whose time is over until the service drains.
pub(super) async fn sweep_forever(service: Arc<Service>) {
    loop {
        tokio::select! {
            () = service.draining.cancelled() => return,
            () = tokio::time::sleep(SWEEP_EVERY) => service.sweep(now()).await,
        }
    }
}

impl Service {
    /// Expires every result whose time is over at `now`.
    pub(super) async fn sweep(&self, now: Timestamp) {
        match self.store.due(now).await {
            Ok(due) => {
                for id in due {
                    self.expire(id).await;
                }
            }
            Err(error) => tracing::error!(%error, "expired jobs could not be found"),
        }
        self.tell_load().await;
    }

    /// The files of an ended job go, its row stays.
    pub(super) async fn expire(&self, id: JobId) {
        match self.store.expire(id).await {
            Ok(orphans) => self.remove(&orphans),
            Err(error) => tracing::warn!(job = %id, %error, "a job could not be expired"),
        }
    }

    /// Room on disk, made by expiring the jobs that ended first.
    pub(super) async fn make_room(&self, bytes: u64) -> Result<Space, Problem> {
        loop {
            if let Some(space) = self.spool.reserve(bytes) {
                return Ok(space);
            }
            let oldest =
                self.store.oldest_ended(Kept::WithFiles).await.map_err(|error| store_problem(&error))?;
            let Some(oldest) = oldest else { return Err(self.storage_full(bytes)) };
            tracing::info!(job = %oldest, "expired early to make room");
            let orphans = self.store.expire(oldest).await.map_err(|error| store_problem(&error))?;
            self.remove(&orphans);
        }
    }

    pub(super) fn storage_full(&self, bytes: u64) -> Problem {
        let limit = self.spool.bytes_max();
        Problem::new(ProblemCode::StorageFull, "unfinished jobs and uploads fill the data directory")
            .with_limit("data_bytes_max", limit, Some(self.spool.bytes().saturating_add(bytes)))
    }

    /// Makes place for one more row: at the limit, the job that ended first goes altogether.
    pub(super) async fn make_place(&self) -> Result<(), Problem> {
        loop {
            let counts = self.store.counts().await.map_err(|error| store_problem(&error))?;
            if counts.all < self.settings.jobs_max {
                return Ok(());
            }
            let oldest = self.store.oldest_ended(Kept::Any).await.map_err(|error| store_problem(&error))?;
            // Without an ended job all rows wait or run, and `queue_max` and `slots` bound them.
            let Some(oldest) = oldest else { return Ok(()) };
            match self.store.delete(oldest).await {
                Ok(orphans) => self.remove(&orphans),
                Err(error) => return Err(store_problem(&error)),
            }
        }
    }

    /// Writes a file, making room for it.
    pub(super) async fn write(&self, content: Vec<u8>) -> Result<BlobRef, Problem> {
        let space = self.make_room(content.len() as u64).await?;
        let spool = Arc::clone(&self.spool);
        match tokio::task::spawn_blocking(move || spool.write(&content, space)).await {
            Ok(written) => written.map_err(|error| disk_problem(&error)),
            Err(_) => Err(Problem::new(ProblemCode::Internal, "a file could not be written")),
        }
    }

    /// Removes files that no row names.
    pub(super) fn remove(&self, orphans: &[BlobRef]) {
        for blob in orphans {
            self.spool.remove(blob);
        }
    }

    /// Removes files that a job wrote and no row names yet; its input is not its own.
    pub(super) fn remove_own<'b>(&self, row: &JobRow, written: impl Iterator<Item = &'b BlobRef>) {
        for blob in written.filter(|blob| blob.key != row.input.key) {
            self.spool.remove(blob);
        }
    }
}
