//! Where the rows of jobs live: what a row holds, and the trait that every store keeps.

use std::fmt;
use std::pin::Pin;
use std::str::FromStr;

use jiff::Timestamp;
use uuid::Uuid;

use crate::wire::{Encoding, JobState, Operation, Options, Outcome, Problem, Progress, TimingMs};

/// Id of a job. Later jobs of one process have larger ids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct JobId(Uuid);

impl JobId {
    /// An id that no other job has.
    pub fn unique() -> Self {
        Self(Uuid::now_v7())
    }
}

impl fmt::Display for JobId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for JobId {
    type Err = uuid::Error;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Uuid::from_str(text).map(Self)
    }
}

/// A file of the spool.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BlobRef {
    /// Name in the spool.
    pub key: String,
    /// Number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
}

/// The mesh of a finished job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResultRef {
    /// The file. It is the upload itself when the same bytes are returned.
    pub blob: BlobRef,
    /// How its bytes are laid out.
    pub encoding: Encoding,
}

/// All that is kept about a job.
#[derive(Debug, Clone)]
pub struct JobRow {
    /// Its id.
    pub id: JobId,
    /// What it does.
    pub operation: Operation,
    /// How.
    pub options: Options,
    /// Name of the uploaded file, if the caller gave one.
    pub file_name: Option<String>,
    /// Who submitted it, by the name of the key.
    pub owner: Option<String>,
    /// The uploaded bytes.
    pub input: BlobRef,
    /// The MTL file that came with them.
    pub material: Option<BlobRef>,
    /// Where it stands.
    pub state: JobState,
    /// Number of times it was claimed; only the latest claim may finish it.
    pub epoch: u32,
    /// When it was accepted.
    pub created_at: Timestamp,
    /// When it came into a slot.
    pub started_at: Option<Timestamp>,
    /// How it ended; `None` before that.
    pub finish: Option<Finish>,
    /// The result is that of an earlier job with the same bytes, options and engine.
    pub is_cached: bool,
}

/// How a job ended.
#[derive(Debug, Clone)]
pub struct Finish {
    /// A final state.
    pub state: JobState,
    /// When.
    pub at: Timestamp,
    /// When the job goes, at the latest.
    pub expires_at: Timestamp,
    /// How far it came.
    pub progress: Progress,
    /// What became of the file.
    pub outcome: Option<Outcome>,
    /// Why it failed.
    pub problem: Option<Problem>,
    /// Time of each pass.
    pub timing_ms: Option<TimingMs>,
    /// Its report.
    pub report: Option<BlobRef>,
    /// Its mesh.
    pub result: Option<ResultRef>,
    /// The meshes of further targets of a simplification.
    pub levels: Vec<ResultRef>,
}

impl Finish {
    /// Its meshes.
    pub fn results(&self) -> impl Iterator<Item = &ResultRef> {
        self.result.iter().chain(&self.levels)
    }
}

impl JobRow {
    /// True when `other` has the same input and asks for the same.
    pub fn does_the_same_as(&self, other: &Self) -> bool {
        let digest = |blob: &BlobRef| blob.sha256;
        self.operation == other.operation
            && self.input.sha256 == other.input.sha256
            && self.material.as_ref().map(digest) == other.material.as_ref().map(digest)
            && self.options.give_the_same_as(&other.options)
    }

    /// The files it keeps; none once it has expired.
    pub fn blobs(&self) -> Vec<&BlobRef> {
        if self.state == JobState::Expired {
            return Vec::new();
        }
        let report = self.finish.iter().filter_map(|finish| finish.report.as_ref());
        let results = self.finish.iter().flat_map(Finish::results).map(|result| &result.blob);
        std::iter::once(&self.input).chain(&self.material).chain(report).chain(results).collect()
    }
}

/// A store that could not do what was asked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StoreError {
    /// As many jobs wait as may.
    #[error("{queued} jobs wait already")]
    QueueFull {
        /// How many.
        queued: usize,
    },
    /// There is no such job.
    #[error("no such job")]
    NotFound,
    /// The claim is not the latest one, or the job has ended.
    #[error("the claim is void")]
    ClaimVoid,
    /// The store does not answer.
    #[error("{0}")]
    Unavailable(String),
}

/// Answer of a store, which may have to wait for a disk or a network.
pub type StoreFuture<'s, T> = Pin<Box<dyn Future<Output = Result<T, StoreError>> + Send + 's>>;

/// Numbers of jobs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct JobCounts {
    /// Waiting for a slot.
    pub queued: usize,
    /// In a slot.
    pub running: usize,
    /// In any state.
    pub all: usize,
}

/// Which ended jobs are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// Those that still keep files.
    WithFiles,
    /// Those, and the expired ones.
    Any,
}

/// Rows of jobs. Every method is atomic.
///
/// Several rows may name one blob. A method that drops rows, or what they name, returns the blobs that no row names
/// any longer, and the caller removes those files.
pub trait JobStore: Send + Sync {
    /// Adds a row. A queued one is refused with [`StoreError::QueueFull`] when `queue_max` jobs are queued already. A
    /// row that names blobs of another job names it in `source`; when that job is gone or expired: [`StoreError::NotFound`].
    fn create(&self, row: JobRow, source: Option<JobId>, queue_max: usize) -> StoreFuture<'_, ()>;

    /// The row.
    fn get(&self, id: JobId) -> StoreFuture<'_, JobRow>;

    /// The oldest queued job becomes running; `None`: nothing is queued.
    fn claim(&self, now: Timestamp) -> StoreFuture<'_, Option<JobRow>>;

    /// Ends a running job. [`StoreError::ClaimVoid`] when `epoch` is not that of its latest claim, or it is gone.
    fn finish(&self, id: JobId, epoch: u32, finish: Finish) -> StoreFuture<'_, ()>;

    /// Ends a job if it is still queued. Whether it was.
    fn finish_queued(&self, id: JobId, finish: Finish) -> StoreFuture<'_, bool>;

    /// An ended job keeps its row and loses its files. Orphaned blobs.
    fn expire(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// Removes the row, whatever its state. Orphaned blobs.
    fn delete(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// Ended jobs that should have expired by `now`.
    fn due(&self, now: Timestamp) -> StoreFuture<'_, Vec<JobId>>;

    /// The job that ended first.
    fn oldest_ended(&self, kept: Kept) -> StoreFuture<'_, Option<JobId>>;

    /// A succeeded job with files that did the same as `row` is to do, with the same bytes.
    fn find_equal(&self, row: &JobRow) -> StoreFuture<'_, Option<JobRow>>;

    /// Numbers of jobs.
    fn counts(&self) -> StoreFuture<'_, JobCounts>;
}
