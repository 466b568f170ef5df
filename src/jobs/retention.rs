//! What goes after its time: results, and files that nobody names.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::Duration;

use super::disk::on_disk;
use super::problems::store_problem;
use super::service::Service;
use super::spool::claim_of;
use super::store::{ClaimRef, JobId, JobRow, Leases, StoreError, UploadId};
use crate::wire::Problem;

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
        match self.store.due_uploads().await {
            Ok(due) => {
                for id in due {
                    self.drop_upload(id).await;
                }
            }
            Err(error) => tracing::error!(%error, "expired uploads could not be found"),
        }
        if let Err(error) = self.recover(Leases::Expired).await {
            tracing::error!(%error, "lost jobs could not be found");
        }
        self.note_load();
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
            Ok(orphans) => self.spool.remove_all(&orphans),
            Err(error) => tracing::warn!(job = %id, %error, "a job could not be expired"),
        }
    }

    /// An upload whose time is over goes with its files.
    async fn drop_upload(&self, id: UploadId) {
        match self.store.drop_due_upload(id).await {
            Ok(orphans) => self.remove_pieces(orphans).await,
            // More of it has come, a job has taken it, or its owner or another server was quicker.
            Err(StoreError::NotFound) => {}
            Err(error) => tracing::warn!(upload = %id, %error, "an upload could not be removed"),
        }
    }

    /// The row; one whose time is over has expired, whether or not the sweep has come by.
    pub(super) async fn row(&self, id: JobId) -> Result<JobRow, Problem> {
        let row = self.store.get(id).await.map_err(|error| store_problem(&error))?;
        if !row.is_due {
            return Ok(row);
        }
        self.expire(id).await;
        self.store.get(id).await.map_err(|error| store_problem(&error))
    }
}
