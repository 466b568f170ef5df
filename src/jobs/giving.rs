//! Files of jobs that are given to their owners: whole, and as they were made.

use std::fs::File;
use std::io::Read as _;
use std::sync::Arc;

use super::disk::on_disk;
use super::handle::Jobs;
use super::meters;
use super::problems::{disk_problem, expired, upload_gone};
use super::service::Service;
use super::soundness::Unsound;
use super::store::{BlobRef, Ending, JobId, JobRow, ResultRef};
use super::view::{self, StoredFile};
use crate::wire::{JobState, Problem, ProblemCode};

impl Jobs {
    /// The job's report (JSON), also of a refused repair.
    ///
    /// # Errors
    /// `not-found`, `job-not-finished`, `expired`, or the problem for which the job has no report.
    pub async fn report(&self, id: JobId) -> Result<Vec<u8>, Problem> {
        let row = self.0.row(id).await?;
        match &ended(&row)?.report {
            Some(blob) => self.0.read(&row, blob).await,
            None => Err(reason_for_nothing(&row, "report")),
        }
    }

    /// The job's mesh; of several, the first.
    ///
    /// # Errors
    /// `not-found` (also when the operation gives no mesh), `job-not-finished`, `expired`, or the problem for which
    /// the job has none (with the report of a refused repair inside).
    pub async fn result(&self, id: JobId) -> Result<StoredFile, Problem> {
        self.level(id, 0).await
    }

    /// One of the job's meshes, by the place of its target, from 0.
    ///
    /// # Errors
    /// As [`result`](Self::result); `not-found` when there are fewer.
    pub async fn level(&self, id: JobId, level: usize) -> Result<StoredFile, Problem> {
        let (row, result) = self.result_at(id, level).await?;
        let name = view::result_name(&row, result.encoding, level);
        let file = self.0.open_file(&row, &result.blob).await?;
        Ok(StoredFile::of(file, &result, name))
    }

    /// The file of one of the job's meshes, and the name that it is given under.
    pub(super) async fn level_of(&self, id: JobId, level: usize) -> Result<(BlobRef, String), Problem> {
        let (row, result) = self.result_at(id, level).await?;
        let name = view::result_name(&row, result.encoding, level);
        Ok((result.blob, name))
    }

    async fn result_at(&self, id: JobId, level: usize) -> Result<(JobRow, ResultRef), Problem> {
        let row = self.0.row(id).await?;
        let ending = ended(&row)?;
        if ending.result.is_none() {
            return Err(self.with_report(reason_for_nothing(&row, "mesh"), id).await);
        }
        let count = ending.results().count();
        let result = ending.results().nth(level).cloned();
        match result {
            Some(result) => Ok((row, result)),
            None => Err(Problem::new(ProblemCode::NotFound, format!("the job has {count} meshes"))),
        }
    }

    /// All of the job's meshes.
    ///
    /// # Errors
    /// As [`result`](Self::result).
    pub async fn results(&self, id: JobId) -> Result<Vec<StoredFile>, Problem> {
        let mut files = vec![self.result(id).await?];
        let row = self.0.row(id).await?;
        for level in 1..ended(&row)?.results().count() {
            files.push(self.level(id, level).await?);
        }
        Ok(files)
    }

    /// The job's picture (PNG or GLB), with its digest.
    ///
    /// # Errors
    /// `not-found` (also when none was asked for), `job-not-finished`, `expired`, or the problem for which the job has none.
    pub async fn picture(&self, id: JobId) -> Result<(Vec<u8>, [u8; 32]), Problem> {
        let row = self.0.row(id).await?;
        match &ended(&row)?.picture {
            Some(blob) => Ok((self.0.read(&row, blob).await?, blob.sha256)),
            None => {
                let problem = row.ending.as_ref().and_then(|ending| ending.problem.clone());
                let detail = "the job has no picture: ask for one with `thumbnail=true`, or have it drawn by \
                              `POST /v1/render` with the job as `input`";
                let none = || Problem::new(ProblemCode::NotFound, detail);
                Err(problem.unwrap_or_else(none).with_instance(format!("/v1/jobs/{}", row.id)))
            }
        }
    }

    /// The same problem with the job's report inside, when it is a refusal.
    async fn with_report(&self, problem: Problem, id: JobId) -> Problem {
        let is_refusal = matches!(
            problem.code,
            ProblemCode::NotRepairable | ProblemCode::MeshNonFinite | ProblemCode::OverBudget
        );
        if !is_refusal {
            return problem;
        }
        let report = async { serde_json::from_slice(&self.report(id).await.ok()?).ok() };
        Problem { report: report.await, ..problem }
    }
}

impl Service {
    /// Opens a file of an ended job. When it is lost or damaged the job expires, so that nobody is answered with it again
    /// and the same mesh makes a new run.
    async fn open_file(&self, row: &JobRow, blob: &BlobRef) -> Result<File, Problem> {
        match self.open_sound(blob).await {
            Err(Unsound::Disk(error)) => Err(disk_problem(&error)),
            Err(unsound) => {
                self.give_up_files(row, &unsound).await;
                Err(expired())
            }
            Ok(file) => Ok(file),
        }
    }

    /// The content of a small file of an ended job.
    async fn read(&self, row: &JobRow, blob: &BlobRef) -> Result<Vec<u8>, Problem> {
        let mut file = self.open_file(row, blob).await?;
        let read = move || {
            let mut content = Vec::new();
            file.read_to_end(&mut content).map(|_| content)
        };
        on_disk(read).await
    }

    /// Opens a file of which every byte is what it was.
    pub(super) async fn open_sound(&self, blob: &BlobRef) -> Result<File, Unsound> {
        let (spool, blob) = (Arc::clone(&self.spool), blob.clone());
        looking(move || spool.open_sound(&blob)).await
    }

    /// Whether every byte of these files is what it was; of those that are not, why the first one is not.
    pub(super) async fn check_sound(&self, blobs: Vec<BlobRef>) -> Result<(), Unsound> {
        let spool = Arc::clone(&self.spool);
        looking(move || blobs.iter().try_for_each(|blob| spool.open_sound(blob).map(drop))).await
    }

    /// A job with a file that is lost or damaged has expired, if it has not gone in the meantime.
    pub(super) async fn give_up_files(&self, row: &JobRow, unsound: &Unsound) {
        let is_there = self.store.get(row.id).await.is_ok_and(|row| row.state != JobState::Expired);
        if is_there {
            tracing::error!(job = %row.id, "{unsound}: the job has expired");
            meters::unsound(unsound);
            self.expire(row.id).await;
        }
    }

    /// Whether the upload of a job is as it was sent, and what came with it.
    pub(super) async fn check_upload(&self, row: &JobRow) -> Result<(), Problem> {
        let sent = [&row.input].into_iter().chain(&row.material).cloned();
        match self.check_sound(sent.collect()).await {
            Ok(()) => Ok(()),
            Err(Unsound::Disk(error)) => Err(disk_problem(&error)),
            Err(unsound) => {
                tracing::error!(job = %row.id, "{unsound}: the job cannot run");
                meters::unsound(&unsound);
                Err(upload_gone())
            }
        }
    }
}

/// Looks at files on a thread that may wait for the disk.
async fn looking<T: Send + 'static>(
    look: impl FnOnce() -> Result<T, Unsound> + Send + 'static,
) -> Result<T, Unsound> {
    let looked = tokio::task::spawn_blocking(look).await;
    looked.unwrap_or_else(|error| Err(Unsound::Disk(std::io::Error::other(error))))
}

/// How the job ended, if it has and its files are kept.
fn ended(row: &JobRow) -> Result<&Ending, Problem> {
    match (&row.ending, row.state) {
        (_, JobState::Expired) => Err(expired()),
        (Some(ending), _) => Ok(ending),
        (None, state) => {
            let problem = Problem::new(ProblemCode::JobNotFinished, format!("the job is {state}"));
            Err(problem.with_instance(format!("/v1/jobs/{}", row.id)))
        }
    }
}

/// Why an ended job lacks a file: its problem, or that its operation gives none.
fn reason_for_nothing(row: &JobRow, what: &str) -> Problem {
    let problem = row.ending.as_ref().and_then(|ending| ending.problem.clone());
    let none =
        || Problem::new(ProblemCode::NotFound, format!("the operation {} gives no {what}", row.operation));
    problem.unwrap_or_else(none).with_instance(format!("/v1/jobs/{}", row.id))
}
