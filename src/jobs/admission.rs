//! Admission: from a request to a queued job, to the answer of an earlier one, or to a refusal.

use std::future::poll_fn;
use std::sync::Arc;
use std::task::Poll;
use std::time::Duration;

use sha2::{Digest as _, Sha256};

use super::handle::Jobs;
use super::heartbeat::end_overdue;
use super::meters;
use super::problems::{expired, internal, not_found, store_problem};
use super::service::Service;
use super::soundness::Unsound;
use super::store::{
    BlobRef, Created, Ending, IdempotencyKey, JobId, JobRow, Lane, NewJob, StoreError, Tenant, Webhook,
};
use super::trace::TraceParent;
use super::upload::{StoredUpload, Uploaded};
use super::view;
use crate::wire::{InputRef, Job, JobState, Labels, Operation, Options, Problem, ProblemCode};

/// What is asked for.
#[derive(Debug)]
pub struct Submission {
    /// What to do.
    pub operation: Operation,
    /// How. `options.input` names the earlier job whose upload is used when `upload` is `None`, or the upload that `upload` or
    /// `taken_by` is of.
    pub options: Options,
    /// The mesh.
    pub upload: Option<Uploaded>,
    /// The job that has taken the upload which `options.input` names.
    pub taken_by: Option<JobId>,
    /// The MTL file of an OBJ.
    pub material: Option<Uploaded>,
    /// Name of the uploaded file, if the caller gave one.
    pub file_name: Option<String>,
    /// Words of the caller, by which jobs are listed.
    pub labels: Labels,
    /// Whom to tell of the end.
    pub webhook: Option<Webhook>,
    /// Somebody waits for the answer.
    pub is_waited_for: bool,
    /// Time from now after which the job must have ended (`Cancel-After`).
    pub cancel_after: Option<Duration>,
    /// The key under which the request may be repeated (`Idempotency-Key`).
    pub key: Option<String>,
    /// Who asks, by the name of the key; `None`: anybody.
    pub owner: Option<String>,
    /// Whom the job is charged to.
    pub tenant: Tenant,
    /// Where the request belongs in a trace.
    pub trace: Option<TraceParent>,
}

impl Submission {
    /// An operation on nothing yet, asked for by anybody.
    pub fn new(operation: Operation, options: Options) -> Self {
        Self {
            operation,
            options,
            upload: None,
            taken_by: None,
            material: None,
            file_name: None,
            labels: Labels::new(),
            webhook: None,
            is_waited_for: false,
            cancel_after: None,
            key: None,
            owner: None,
            tenant: Tenant::nobody(),
            trace: None,
        }
    }

    /// Digest of all that makes the job what it is.
    fn fingerprint(&self, input: &BlobRef, material: Option<&BlobRef>) -> Result<[u8; 32], Problem> {
        let asked = (
            self.operation,
            &self.options,
            &self.labels,
            &self.webhook,
            input.sha256,
            material.map(|blob| blob.sha256),
        );
        let mut text = serde_json::to_vec(&asked).map_err(|error| internal(&error))?;
        if !input.files.is_empty() {
            text.extend(serde_json::to_vec(&input.files).map_err(|error| internal(&error))?);
        }
        Ok(Sha256::digest(text).into())
    }
}

impl Jobs {
    /// Admits a job, or gives the one that the same request with the same key made before. It is kept from then on: it
    /// ends, whatever becomes of this process.
    ///
    /// # Errors
    /// `queue-full`, `draining`, `invalid-parameter` (no mesh, or not as many as the operation takes), `not-found` or `expired` (of `options.input`),
    /// `idempotency-key-reused`, `storage-full`, `store-unavailable`.
    pub async fn submit(&self, submission: Submission) -> Result<Job, Problem> {
        let service = Arc::clone(&self.0);
        service.check_open().inspect_err(meters::refused)?;
        // The caller may go away, but what is begun is done: a row must not name a file that goes with its upload.
        let admitting = tokio::spawn(async move { service.admit(submission).await });
        let admitted = admitting.await.map_err(|error| internal(&error))?;
        let row = admitted.inspect_err(meters::refused)?;
        Ok(view::job(&row, self.0.live.get(row.id).as_deref()))
    }

    /// Whether this key of this owner made a job before, the same or another one than would be asked for now: no new one
    /// comes of it.
    ///
    /// # Errors
    /// `store-unavailable`.
    pub async fn has_made(&self, owner: Option<String>, key: String) -> Result<bool, Problem> {
        // No request is known yet: this fingerprint is of none.
        let key = IdempotencyKey { key, fingerprint: [0; 32] };
        match self.0.store.find_keyed(owner, key).await {
            Ok(known) => Ok(known.is_some()),
            Err(StoreError::KeyReused) => Ok(true),
            Err(error) => Err(store_problem(&error)),
        }
    }
}

impl Service {
    async fn create(&self, new: NewJob) -> Result<Created, StoreError> {
        let mut creating = self.store.create(new, self.settings.queue_max);
        match poll_fn(|context| Poll::Ready(creating.as_mut().poll(context))).await {
            Poll::Ready(created) => created,
            Poll::Pending => {
                // A slot that asks for work now asks a store that has been told of the job: its claim becomes durable
                // with the job, not after it.
                self.work.notify_one();
                creating.await
            }
        }
    }

    async fn admit(self: &Arc<Self>, submission: Submission) -> Result<JobRow, Problem> {
        let source = self.source_of(&submission).await?;
        let input = match (&submission.upload, &source) {
            (Some(upload), None) => upload.blob().cloned(),
            (None, Some(source)) => Some(source.input.clone()),
            _ => None,
        };
        let Some(input) = input else { return Err(no_single_mesh()) };
        submission.operation.check_mesh_count(input.file_count())?;
        let own_material = submission.material.as_ref().and_then(Uploaded::blob).cloned();
        let material = own_material.or_else(|| source.as_ref()?.material.clone());
        let fingerprint = submission.fingerprint(&input, material.as_ref())?;
        let key = submission.key.map(|key| IdempotencyKey { key, fingerprint });
        if let Some(key) = &key
            && let Some(known) = self.find_keyed(submission.owner.clone(), key.clone()).await?
        {
            return Ok(known);
        }
        self.make_place(&submission.tenant).await?;
        let is_small = input.bytes <= self.settings.interactive_bytes_max;
        let lane = if is_small && submission.is_waited_for { Lane::Interactive } else { Lane::Bulk };
        let new = NewJob {
            id: JobId::unique(),
            operation: submission.operation,
            keep_for: self.settings.keep_for(&submission.options),
            options: submission.options,
            file_name: submission.file_name.or_else(|| source.as_ref()?.file_name.clone()),
            owner: submission.owner,
            tenant: submission.tenant,
            trace: submission.trace,
            labels: submission.labels,
            webhook: submission.webhook.map(|webhook| self.sealed(webhook)).transpose()?,
            input,
            material,
            lane,
            cancel_after: submission.cancel_after,
            key,
            source: source.map(|source| source.id),
            taken: submission.upload.as_ref().and_then(Uploaded::taken),
            ending: None,
        };
        match self.answer_from_cache(&new).await {
            Some(Created::New(row)) => {
                if let Some(upload) = submission.upload {
                    upload.not_needed();
                }
                return Ok(row);
            }
            Some(Created::Known(row)) => return Ok(row),
            None => {}
        }
        let mut upload = stored_if_any(submission.upload).await?;
        let own_material = stored_if_any(submission.material).await?;
        let mut created = self.create(new.clone()).await;
        if let (Err(StoreError::NotFound), Some(taken)) = (&created, new.taken) {
            // Another request that names the upload was quicker: it is the same as to name its job.
            let row = self.upload_of(taken, new.owner.as_deref()).await;
            let job = row.map_err(|_| taken_meanwhile())?.job.ok_or_else(taken_meanwhile)?;
            let source = self.store.get(job).await.map_err(|error| store_problem(&error))?;
            upload = None;
            created = self
                .create(NewJob { input: source.input, source: Some(source.id), taken: None, ..new })
                .await;
        }
        let files = [upload, own_material].into_iter().flatten();
        let row = match created {
            Ok(Created::Known(row)) => return Ok(row),
            Ok(Created::New(row)) => row,
            Err(error) => {
                if matches!(error, StoreError::Unavailable(_)) {
                    // The row may be there all the same, and name them; otherwise they are found as orphans.
                    files.for_each(StoredUpload::maybe_named);
                }
                return Err(self.not_admitted(&error));
            }
        };
        // From here on the row owns the files.
        files.for_each(StoredUpload::named);
        if let Some(left) = row.time_left {
            tokio::spawn(end_overdue(Arc::clone(self), row.id, left));
        }
        if self.live.get(row.id).is_none_or(|live| live.epoch == 0) {
            // Not in a slot yet.
            self.work.notify_waiters();
        }
        self.note_load();
        Ok(row)
    }

    /// The earlier job whose upload is used again, if the request names one.
    async fn source_of(&self, submission: &Submission) -> Result<Option<JobRow>, Problem> {
        let Some(input) = &submission.options.input else { return Ok(None) };
        let about_input = |problem: Problem| Problem { parameter: Some("input".to_owned()), ..problem };
        let id = match (input, submission.taken_by) {
            (InputRef::Job(id), _) => id.parse().map_err(|_| about_input(not_found()))?,
            (InputRef::Upload(_), Some(job)) => job,
            (InputRef::Upload(_), None) => return Ok(None),
        };
        let row = self.row(id).await.map_err(about_input)?;
        if row.state == JobState::Expired {
            return Err(about_input(expired()));
        }
        self.check_upload(&row).await.map_err(about_input)?;
        Ok(Some(row))
    }

    async fn find_keyed(
        &self,
        owner: Option<String>,
        key: IdempotencyKey,
    ) -> Result<Option<JobRow>, Problem> {
        self.store.find_keyed(owner, key).await.map_err(|error| store_problem(&error))
    }

    /// The webhook as it is stored.
    fn sealed(&self, webhook: Webhook) -> Result<Webhook, Problem> {
        let Webhook { url, secret } = webhook;
        let sealed = match (&self.vault, secret) {
            (Some(vault), Some(secret)) => Some(vault.sealed(&secret).map_err(|error| internal(&error))?),
            (_, secret) => secret,
        };
        Ok(Webhook { url, secret: sealed })
    }

    /// A job that did the same with the same bytes and whose files are all as they were. One that has lost some expires, and
    /// is asked for no more.
    async fn find_sound_equal(&self, new: &NewJob) -> Option<JobRow> {
        loop {
            let equal = self.store.find_equal(new).await.ok()??;
            let result = equal.ending.iter().flat_map(Ending::blobs);
            let files = result.chain([&equal.input]).chain(&equal.material).cloned();
            match self.check_sound(files.collect()).await {
                Ok(()) => return Some(equal),
                Err(Unsound::Disk(_)) => return None,
                Err(unsound) => self.give_up_files(&equal, &unsound).await,
            }
            // It would be found again.
            if self.store.get(equal.id).await.is_ok_and(|row| row.state != JobState::Expired) {
                return None;
            }
        }
    }

    /// A new job that ends at once, because an earlier one did the same with the same bytes.
    async fn answer_from_cache(&self, new: &NewJob) -> Option<Created> {
        let equal = self.find_sound_equal(new).await?;
        let cached = NewJob {
            input: equal.input,
            material: equal.material,
            source: Some(equal.id),
            ending: Some(equal.ending?),
            ..new.clone()
        };
        // The earlier job may be gone by now: then the new one runs.
        let created = self.store.create(cached, usize::MAX).await.ok()?;
        if let Created::New(row) = &created {
            meters::cached(row.operation);
            self.note_load();
        }
        Some(created)
    }
}

async fn stored_if_any(upload: Option<Uploaded>) -> Result<Option<StoredUpload>, Problem> {
    match upload {
        Some(upload) => upload.stored().await.map(Some),
        None => Ok(None),
    }
}

fn taken_meanwhile() -> Problem {
    let detail = "another request has taken or deleted the upload meanwhile; send this one again";
    Problem { parameter: Some("input".to_owned()), ..Problem::new(ProblemCode::UploadConflict, detail) }
}

fn no_single_mesh() -> Problem {
    Problem {
        parameter: Some("input".to_owned()),
        ..Problem::new(
            ProblemCode::InvalidParameter,
            "send one mesh, or name an earlier job or upload in `input`, not both",
        )
    }
}
