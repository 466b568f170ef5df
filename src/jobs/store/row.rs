//! What is kept about a job.

use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::id::{JobId, UploadId};
use super::outbox::Webhook;
use super::tenant::Tenant;
use crate::jobs::trace::TraceParent;
use crate::wire::{
    Encoding, Fidelity, JobState, Labels, Operation, Options, Outcome, Problem, Progress, TimingMs,
};

/// A stored file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlobRef {
    /// Its name in the blob store.
    pub key: String,
    /// Number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
    /// Sizes in bytes of the files that stand in it one behind the other; none: it is one file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<u64>,
}

impl BlobRef {
    /// Number of files in it.
    pub fn file_count(&self) -> usize {
        self.files.len().max(1)
    }
}

/// The mesh of a finished job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultRef {
    /// The file. It is the upload itself when the same bytes are returned.
    pub blob: BlobRef,
    /// How its bytes are laid out.
    pub encoding: Encoding,
}

/// Which queue a job waits in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Lane {
    /// Small jobs that somebody waits for.
    #[default]
    Interactive,
    /// Large ones.
    Bulk,
}

/// What makes a request the same as an earlier one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IdempotencyKey {
    /// The key that the client gave.
    pub key: String,
    /// Digest of all that the request asks for.
    pub fingerprint: [u8; 32],
}

/// A job to be admitted. Times in the row are those of the store's clock.
#[derive(Debug, Clone)]
pub struct NewJob {
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
    /// Whom it is charged to.
    pub tenant: Tenant,
    /// Where its request belongs in a trace.
    pub trace: Option<TraceParent>,
    /// Words of the caller.
    pub labels: Labels,
    /// Whom to tell of its end.
    pub webhook: Option<Webhook>,
    /// The uploaded bytes.
    pub input: BlobRef,
    /// The MTL file that came with them.
    pub material: Option<BlobRef>,
    /// Where it waits.
    pub lane: Lane,
    /// Time from now after which it must have ended.
    pub cancel_after: Option<Duration>,
    /// Time for which its files are kept once it has ended.
    pub keep_for: Duration,
    /// The key under which the request may be repeated.
    pub key: Option<IdempotencyKey>,
    /// The earlier job whose files it names; when that is gone or expired, there is nothing to run.
    pub source: Option<JobId>,
    /// The upload whose files become its own, or are replaced by them.
    pub taken: Option<UploadId>,
    /// It has ended already: the answer of `source`.
    pub ending: Option<Ending>,
}

impl NewJob {
    /// The files it names.
    pub fn blobs(&self) -> impl Iterator<Item = &BlobRef> {
        std::iter::once(&self.input).chain(&self.material).chain(self.ending.iter().flat_map(Ending::blobs))
    }
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
    /// Whom it is charged to.
    pub tenant: Tenant,
    /// Where its request belongs in a trace.
    pub trace: Option<TraceParent>,
    /// Words of the caller.
    pub labels: Labels,
    /// Whom to tell of its end.
    pub webhook: Option<Webhook>,
    /// The uploaded bytes.
    pub input: BlobRef,
    /// The MTL file that came with them.
    pub material: Option<BlobRef>,
    /// Where it waits.
    pub lane: Lane,
    /// A run of it took more memory than was thought.
    pub is_outgrown: bool,
    /// Where it stands.
    pub state: JobState,
    /// Number of times it was claimed; only the latest claim may finish it.
    pub epoch: u32,
    /// Number of its runs that were lost with whoever made them.
    pub attempts: u32,
    /// When it was accepted.
    pub created_at: Timestamp,
    /// Time that was left until it must have ended, when the row was read.
    pub time_left: Option<Duration>,
    /// When it came into a slot, the last time.
    pub started_at: Option<Timestamp>,
    /// When it ended.
    pub finished_at: Option<Timestamp>,
    /// When its files go, at the latest.
    pub expires_at: Option<Timestamp>,
    /// Its files should have gone when the row was read, and were still there.
    pub is_due: bool,
    /// How it ended; `None` before that.
    pub ending: Option<Ending>,
    /// The result is that of an earlier job with the same bytes, options and engine.
    pub is_cached: bool,
}

impl JobRow {
    /// The claim by which it runs.
    pub fn claim(&self) -> ClaimRef {
        ClaimRef { id: self.id, epoch: self.epoch }
    }

    /// True when `job` has the same input and asks for the same.
    pub fn does_the_same_as(&self, job: &NewJob) -> bool {
        let digest = |blob: &BlobRef| blob.sha256;
        self.operation == job.operation
            && (self.input.sha256, &self.input.files) == (job.input.sha256, &job.input.files)
            && self.material.as_ref().map(digest) == job.material.as_ref().map(digest)
            && self.options.give_the_same_as(&job.options)
    }
}

/// One claim of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ClaimRef {
    /// The job.
    pub id: JobId,
    /// Which of its claims, from 1.
    pub epoch: u32,
}

/// How a job ended.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ending {
    /// A final state.
    pub state: JobState,
    /// How far it came.
    pub progress: Progress,
    /// What became of the file.
    pub outcome: Option<Outcome>,
    /// How true the result is to the file.
    #[serde(default)]
    pub fidelity: Option<Fidelity>,
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
    /// Its picture, as PNG or GLB.
    #[serde(default)]
    pub picture: Option<BlobRef>,
}

impl Ending {
    /// An end without files.
    pub fn without_files(state: JobState, problem: Option<Problem>) -> Self {
        Self {
            state,
            progress: Progress { stage: None, fraction: 0.0 },
            outcome: None,
            fidelity: None,
            problem,
            timing_ms: None,
            report: None,
            result: None,
            levels: Vec::new(),
            picture: None,
        }
    }

    /// Its meshes.
    pub fn results(&self) -> impl Iterator<Item = &ResultRef> {
        self.result.iter().chain(&self.levels)
    }

    /// Its files.
    pub fn blobs(&self) -> impl Iterator<Item = &BlobRef> {
        self.report.iter().chain(self.results().map(|result| &result.blob)).chain(&self.picture)
    }
}
