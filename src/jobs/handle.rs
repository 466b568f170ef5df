//! The handle by which callers reach the service.

use std::sync::Arc;
use std::time::Duration;

use super::meters;
use super::problems::store_problem;
use super::service::Service;
use super::store::{Ending, JobId, ListQuery, StoreError, Tenant, Webhook};
use super::upload::{Upload, UploadPurpose};
use super::webhook::{self, WebhookSettings};
use super::{settings::JobsSettings, view};
use crate::budget::Stopped;
use crate::wire::{Delivery, Job, JobState, Problem, ProblemCode, WebhookRequest};

/// The job service. Clones share it.
#[derive(Debug, Clone)]
pub struct Jobs(pub(super) Arc<Service>);

impl Jobs {
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
            Upload::begin(Arc::clone(&self.0), tenant, UploadPurpose::of_mesh(false)).await
        };
        begin.await.inspect_err(meters::refused)
    }

    async fn begin_upload(&self, tenant: Tenant, announced: Option<u64>) -> Result<Upload, Problem> {
        self.0.check_open()?;
        // Told now, the refusal costs neither the caller the upload nor this server the disk.
        let place = self.0.arrivals.check(&tenant).await;
        place.map_err(|error| self.0.not_admitted(&error))?;
        if let Some(bytes) = announced {
            self.0.settings.check_upload_size(bytes)?;
            if bytes > self.0.spool.bytes_max() || self.0.spool.is_disk_short_of(bytes) {
                return Err(self.0.storage_full(bytes));
            }
            self.0.incoming.check(&tenant, 0, 0, bytes).await?;
        }
        Upload::begin(Arc::clone(&self.0), tenant, UploadPurpose::of_mesh(true)).await
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
            if row.is_due {
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
        self.0.spool.remove_all(&orphans);
        self.0.note_load();
        Ok(())
    }

    #[cfg(test)]
    pub(super) fn service(&self) -> &Service {
        &self.0
    }
}
