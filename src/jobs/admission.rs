//! Admission: from a request to a queued job, to the answer of an earlier one, or to a refusal.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::clock::StageClock;
use super::drain::draining;
use super::live::Live;
use super::meters;
use super::service::{Jobs, Service, not_found, now, store_problem};
use super::store::{Finish, JobId, JobRow, StoreError};
use super::upload::Uploaded;
use super::view::{self, expired};
use crate::budget::Stopped;
use crate::wire::{Job, JobState, Operation, Options, Problem, ProblemCode};

/// What is asked for.
#[derive(Debug)]
pub struct Submission {
    /// What to do.
    pub operation: Operation,
    /// How. `options.input` names the earlier job whose upload is used when `upload` is `None`.
    pub options: Options,
    /// The mesh.
    pub upload: Option<Uploaded>,
    /// The MTL file of an OBJ.
    pub material: Option<Uploaded>,
    /// Name of the uploaded file, if the caller gave one.
    pub file_name: Option<String>,
    /// Time from now after which the job must have ended (`Cancel-After`).
    pub cancel_after: Option<Duration>,
    /// Who asks, by the name of the key; `None`: anybody.
    pub owner: Option<String>,
}

impl Jobs {
    /// Admits a job.
    ///
    /// # Errors
    /// `queue-full`, `draining`, `invalid-parameter` (no mesh, or two), `not-found` or `expired` (of `options.input`).
    pub async fn submit(&self, submission: Submission) -> Result<Job, Problem> {
        let service = &self.0;
        service.check_open()?;
        service.make_place().await?;
        let source = service.source_of(&submission).await?;
        let input = match (&submission.upload, &source) {
            (Some(upload), None) => upload.blob().cloned(),
            (None, Some(source)) => Some(source.input.clone()),
            _ => None,
        };
        let Some(input) = input else { return Err(no_single_mesh()) };
        let Submission { operation, options, upload, material, file_name, cancel_after, owner } = submission;
        let own_material = material.as_ref().and_then(Uploaded::blob).cloned();
        let mut row = JobRow {
            id: JobId::unique(),
            operation,
            options,
            file_name: file_name.or_else(|| source.as_ref()?.file_name.clone()),
            owner,
            input,
            material: own_material.or_else(|| source.as_ref()?.material.clone()),
            state: JobState::Queued,
            epoch: 0,
            created_at: now(),
            started_at: None,
            finish: None,
            is_cached: false,
        };
        if let Some(job) = service.answer_from_cache(&mut row).await {
            return Ok(job);
        }
        let (id, source_id) = (row.id, source.map(|source| source.id));
        let live = service.live.insert(id);
        if let Err(error) = service.store.create(row.clone(), source_id, service.settings.queue_max).await {
            service.live.end(id);
            return Err(service.not_admitted(&error));
        }
        // From here on the row owns the files.
        [upload, material].into_iter().flatten().for_each(|upload| drop(upload.keep()));
        if let Some(patience) = cancel_after {
            tokio::spawn(end_after(Arc::clone(service), row.clone(), live, patience));
        }
        service.work.notify_one();
        if service.draining.is_cancelled() {
            // The drain may have looked at the queue before this job was in it.
            service.end_queued(&row, JobState::Failed, draining()).await;
        }
        service.tell_load().await;
        self.get(id).await
    }
}

impl Service {
    /// The earlier job whose upload is used again, if the request names one.
    async fn source_of(&self, submission: &Submission) -> Result<Option<JobRow>, Problem> {
        let Some(input) = &submission.options.input else { return Ok(None) };
        let about_input = |problem: Problem| Problem { parameter: Some("input".to_owned()), ..problem };
        let id = input.job.parse().map_err(|_| about_input(not_found()))?;
        let row = self.row(id).await.map_err(about_input)?;
        if row.state == JobState::Expired { Err(about_input(expired())) } else { Ok(Some(row)) }
    }

    /// A new job that ends at once, because an earlier one did the same with the same bytes.
    async fn answer_from_cache(&self, row: &mut JobRow) -> Option<Job> {
        let equal = self.store.find_equal(row).await.ok()??;
        let found = equal.finish?;
        let at = now();
        let finish = Finish { at, expires_at: self.expiry(row, at), ..found };
        let cached = JobRow {
            input: equal.input,
            material: equal.material,
            state: finish.state,
            started_at: Some(at),
            finish: Some(finish),
            is_cached: true,
            ..row.clone()
        };
        let job = view::job(&cached, None);
        // The earlier job may be gone by now: then the new one runs.
        self.store.create(cached, Some(equal.id), usize::MAX).await.ok()?;
        meters::cached(row.operation);
        self.tell_load().await;
        Some(job)
    }

    fn not_admitted(&self, error: &StoreError) -> Problem {
        match *error {
            StoreError::QueueFull { queued } => Problem {
                retry_after_s: Some(self.retry_after_s()),
                ..Problem::new(ProblemCode::QueueFull, error.to_string()).with_limit(
                    "queue_max",
                    self.settings.queue_max as u64,
                    Some(queued as u64 + 1),
                )
            },
            StoreError::NotFound => expired(),
            _ => store_problem(error),
        }
    }

    /// Time until a slot takes the next job from the queue, as far as the latest runs tell.
    fn retry_after_s(&self) -> u64 {
        let between_claims_ms = self.mean_run_ms.load(Ordering::Relaxed) / self.settings.slots.max(1) as u64;
        between_claims_ms.div_ceil(1000).clamp(1, self.settings.deadline_max.as_secs().max(1))
    }

    /// Counts a run into the mean, with a weight of one eighth.
    pub(super) fn note_run_time(&self, clock: &StageClock) {
        let ms = clock.timing_ms().total as u64;
        let mean = |old: u64| Some((old * 7 + ms) / 8);
        // The update never refuses.
        let _ = self.mean_run_ms.fetch_update(Ordering::Relaxed, Ordering::Relaxed, mean);
    }
}

/// Ends the job when `patience` is over, unless it has ended by then.
async fn end_after(service: Arc<Service>, row: JobRow, live: Arc<Live>, patience: Duration) {
    if tokio::time::timeout(patience, live.ended.cancelled()).await.is_ok() {
        return;
    }
    live.stop.pass_deadline();
    service.end_queued(&row, JobState::Failed, Problem::from(&Stopped::Deadline)).await;
}

fn no_single_mesh() -> Problem {
    Problem {
        parameter: Some("input".to_owned()),
        ..Problem::new(
            ProblemCode::InvalidParameter,
            "send one mesh, or name an earlier job in `input`, not both",
        )
    }
}
