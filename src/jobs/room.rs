//! Room for rows and files, made by what may go.

use std::sync::Arc;

use super::disk::on_disk;
use super::problems::{internal, store_problem};
use super::product::Content;
use super::service::Service;
use super::spool::{ReservedSpace, Written};
use super::store::{BlobRef, EndedJobs, Holding, JobRow, StoreError, Tenant};
use crate::wire::{Problem, ProblemCode};

impl Service {
    /// Keeps a file of a run, making room for it, and adds it to those that no row names yet.
    pub(super) async fn keep(
        &self,
        row: &JobRow,
        name: String,
        content: Content,
        written: &mut Vec<Written>,
    ) -> Result<BlobRef, Problem> {
        let (spool, claim) = (Arc::clone(&self.spool), row.claim());
        let file = match content {
            Content::Kept(file) => file,
            Content::Bytes(bytes) => {
                let space = self.make_room(&row.tenant, bytes.len() as u64).await?;
                on_disk(move || spool.write(claim, &name, &bytes, space)).await?
            }
            Content::File(file) => {
                let space = self.make_room(&row.tenant, file.bytes).await?;
                on_disk(move || spool.adopt(claim, &file, space)).await?
            }
        };
        let blob = file.blob().cloned();
        written.push(file);
        blob.ok_or_else(|| internal(&"a file could not be kept"))
    }

    /// Room for files of a tenant, made by expiring jobs that have ended. When the disk itself is short of room no result
    /// goes for it: whatever fills the disk would take them all, one after the other.
    pub(super) async fn make_room(&self, tenant: &Tenant, bytes: u64) -> Result<ReservedSpace, Problem> {
        loop {
            if bytes > 0 && self.spool.is_disk_short_of(bytes) {
                return Err(self.storage_full(bytes));
            }
            if let Some(space) = self.room_or_one_fewer(tenant, bytes).await? {
                return Ok(space);
            }
        }
    }

    /// The same for a file that does not come to the disk of this machine.
    pub(super) async fn make_room_in_store(
        &self,
        tenant: &Tenant,
        bytes: u64,
    ) -> Result<ReservedSpace, Problem> {
        loop {
            if let Some(space) = self.room_or_one_fewer(tenant, bytes).await? {
                return Ok(space);
            }
        }
    }

    /// Room, if there is; otherwise a job that has ended has expired.
    async fn room_or_one_fewer(&self, tenant: &Tenant, bytes: u64) -> Result<Option<ReservedSpace>, Problem> {
        let first = if self.is_over_own_bytes(tenant, bytes).await? {
            self.store.first_to_go_of(EndedJobs::WithFiles, tenant.clone()).await
        } else if let Some(space) = self.spool.reserve(bytes) {
            return Ok(Some(space));
        } else {
            self.store.first_to_go(EndedJobs::WithFiles, tenant.clone()).await
        };
        let first = first.map_err(|error| store_problem(&error))?;
        let Some(first) = first else { return Err(self.storage_full(bytes)) };
        tracing::info!(job = %first, "expired early to make room");
        match self.store.expire(first).await {
            Ok(orphans) => self.spool.remove_all(&orphans),
            // Another one, who needs room too, was quicker.
            Err(StoreError::NotFound) => {}
            Err(error) => return Err(store_problem(&error)),
        }
        Ok(None)
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
                self.store.first_to_go_of(EndedJobs::Any, tenant.clone()).await
            } else if counts.all < self.settings.jobs_max {
                return Ok(());
            } else {
                self.store.first_to_go(EndedJobs::Any, tenant.clone()).await
            };
            // Where none has ended that may go, rows wait or run or are within the share of others: the queue, slots and
            // shares bound them.
            let Some(first) = first.map_err(|error| store_problem(&error))? else { return Ok(()) };
            match self.store.delete(first).await {
                Ok(orphans) => self.spool.remove_all(&orphans),
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

    /// What a tenant has.
    async fn holding(&self, tenant: &Tenant) -> Result<Holding, Problem> {
        self.store.holding(tenant.clone()).await.map_err(|error| store_problem(&error))
    }
}
