//! Where the rows of jobs live: the trait that every store keeps.

mod hint;
mod id;
mod outbox;
mod row;
pub(super) mod tables;
mod tenant;
mod uploads;

use std::collections::HashSet;
use std::pin::Pin;
use std::time::Duration;

use jiff::Timestamp;

use crate::wire::{JobState, Problem};
pub use hint::{Hint, Hints};
pub use id::{JobId, UploadId};
pub use outbox::{Delivery, DeliveryRequest, DeliveryState, DeliveryTry, NextTry, TryOutcome, Webhook};
pub use row::{BlobRef, ClaimRef, Ending, IdempotencyKey, JobRow, Lane, NewJob, ResultRef};
pub use tenant::{Holding, Tenant};
pub use uploads::{NewUpload, UploadRow, UploadStore};

/// Most jobs with the same bytes that are looked at for one that did the same: a caller may send a mesh over and over, each time
/// with other options.
pub(in crate::jobs) const EQUAL_JOBS_LOOKED_AT: u32 = 64;

/// A store that could not do what was asked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StoreError {
    /// The queue is full.
    #[error("{queued} jobs wait already")]
    QueueFull {
        /// How many.
        queued: usize,
    },
    /// As many jobs of this tenant wait as may beside those of others.
    #[error("{queued} jobs of this caller wait already")]
    ShareFull {
        /// How many.
        queued: usize,
        /// How many may.
        limit: usize,
    },
    /// There are as many uploads as may be that no job has taken, or as this tenant may have of them beside others.
    #[error("{open} uploads wait for their jobs already")]
    UploadsFull {
        /// How many there are.
        open: usize,
        /// How many may be.
        limit: usize,
    },
    /// The upload does not go on where a piece was to be appended.
    #[error("the upload goes on at byte {received}")]
    UploadMoved {
        /// Where it goes on.
        received: u64,
    },
    /// There is no such job, delivery or upload.
    #[error("no such job")]
    NotFound,
    /// The claim is not the latest one, or the job has ended.
    #[error("the claim is void")]
    ClaimVoid,
    /// The idempotency key belongs to another request.
    #[error("the idempotency key was used with another request")]
    KeyReused,
    /// There is no room for another row.
    #[error("the store is full: {0}")]
    Full(String),
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
    /// Bytes of the uploads of those.
    pub queued_bytes: u64,
    /// In a slot.
    pub running: usize,
    /// In any state.
    pub all: usize,
    /// For how long the job waits that has waited for longest.
    pub longest_queued: Option<Duration>,
}

/// What became of a job to be admitted.
#[derive(Debug, Clone)]
pub enum Created {
    /// It is a new one.
    New(JobRow),
    /// The same request made this one before.
    Known(JobRow),
}

/// Who asks for a job, and for how long.
#[derive(Debug, Clone)]
pub struct ClaimRequest {
    /// Name of the process that asks.
    pub worker: String,
    /// Time after which others may take the job, unless the claim is renewed.
    pub lease: Duration,
    /// Jobs of this lane come first; those of the other one when there are none.
    pub prefer: Lane,
    /// Those of the other one do not come at all: it is a slot for small jobs.
    pub is_only: bool,
    /// Most jobs of one tenant that run in slots of this kind.
    pub share: usize,
    /// Those of this worker count; otherwise those of all. A store that has one worker need not look.
    pub is_share_of_worker: bool,
}

/// What became of a job whose run was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterLoss {
    /// It waits for a slot again.
    Queued,
    /// It has ended: it was to be cancelled, or it was lost too often.
    Ended,
}

/// Which claims are void.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Leases {
    /// Those whose time is over.
    Expired,
    /// All that this worker made: it has started anew.
    OfWorker(String),
}

/// Which ended jobs are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndedJobs {
    /// Those that still keep files.
    WithFiles,
    /// Those, and the expired ones.
    Any,
}

/// Which jobs to list.
#[derive(Debug, Clone, Default)]
pub struct ListQuery {
    /// Whose.
    pub owner: Option<String>,
    /// In this state.
    pub state: Option<JobState>,
    /// With all of these labels.
    pub labels: Vec<(String, String)>,
    /// Older than this one.
    pub before: Option<JobId>,
    /// At most this many.
    pub limit: usize,
}

/// A change of a job's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StateChange {
    /// Which of the job's changes, from 1.
    pub number: u64,
    /// The state that the job came into.
    pub state: JobState,
    /// Number of its claims then.
    pub epoch: u32,
    /// When.
    pub at: Timestamp,
}

/// Seals a secret; `None`: it is sealed already.
pub type Sealer = Box<dyn Fn(&str) -> Option<String> + Send>;

/// Rows of jobs. Every method is atomic, and what it has changed outlasts the process when it returns.
///
/// Times are those of the store's clock, so that the clocks of several workers need not agree; what is to happen at some time
/// is told as the time that is left. A job runs under a
/// claim with a lease; each claim has a larger epoch than the one before, and only the latest one may end the job.
///
/// Several rows may name one blob. A method that drops rows, or what they name, returns the blobs that no row names
/// any longer, and the caller removes those files. Files are written before the row that names them.
pub trait JobStore: UploadStore {
    /// Admits a job, unless its key made one before. A job that must run is refused with [`StoreError::QueueFull`] when
    /// `queue_max` jobs are queued already, and with [`StoreError::ShareFull`] when its tenant has as many in the queue as
    /// there are free places: one tenant alone has half of them at most, two a third each, and there is always room for
    /// another one. When its source is gone or expired, or the upload that
    /// it is to take is gone or taken: [`StoreError::NotFound`].
    fn create(&self, job: NewJob, queue_max: usize) -> StoreFuture<'_, Created>;

    /// The row.
    fn get(&self, id: JobId) -> StoreFuture<'_, JobRow>;

    /// The job that the same request of this owner made before. [`StoreError::KeyReused`] when it was another request.
    fn find_keyed(&self, owner: Option<String>, key: IdempotencyKey) -> StoreFuture<'_, Option<JobRow>>;

    /// A succeeded job of the same owner with files that this engine ended and that did the same as `job` is to do, with
    /// the same bytes; one of the latest 64 that had these bytes.
    fn find_equal(&self, job: &NewJob) -> StoreFuture<'_, Option<JobRow>>;

    /// Jobs, the latest first.
    fn list(&self, query: ListQuery) -> StoreFuture<'_, Vec<JobRow>>;

    /// Queued jobs that must have ended at some time, and how long that is from now.
    fn deadlines(&self) -> StoreFuture<'_, Vec<(JobId, Duration)>>;

    /// Changes of a job's state after the one of that number, the first one first.
    fn changes(&self, id: JobId, after: u64) -> StoreFuture<'_, Vec<StateChange>>;

    /// Those of the jobs that have ended or are gone.
    fn ended(&self, jobs: Vec<JobId>) -> StoreFuture<'_, Vec<JobId>>;

    /// Whether other processes change these rows too, so that what they do has to be looked for.
    fn is_shared(&self) -> bool;

    /// What other processes tell of what they do, where they do.
    fn hints(&self) -> Option<Hints> {
        None
    }

    /// Numbers of jobs.
    fn counts(&self) -> StoreFuture<'_, JobCounts>;

    /// What a tenant has.
    fn holding(&self, tenant: Tenant) -> StoreFuture<'_, Holding>;

    /// A queued job becomes running: the oldest one of the tenant with the fewest running jobs, of several that whose turn
    /// was longest ago. `None`: nothing is queued, or all that is belongs to tenants with their share of running jobs.
    fn claim(&self, request: ClaimRequest) -> StoreFuture<'_, Option<JobRow>>;

    /// Extends a claim by `lease` from now. True: the job is to be cancelled. [`StoreError::ClaimVoid`]: the run is in
    /// vain.
    fn renew(&self, claim: ClaimRef, lease: Duration) -> StoreFuture<'_, bool>;

    /// Ends a running job.
    fn finish(&self, claim: ClaimRef, ending: Ending) -> StoreFuture<'_, ()>;

    /// Gives a running job back, as if it had not been claimed, but for the epoch.
    fn release(&self, claim: ClaimRef) -> StoreFuture<'_, AfterLoss>;

    /// As [`release`](Self::release), and the job waits among the large ones from then on. `is_outgrown`: its run took more
    /// memory than was thought.
    fn demote(&self, claim: ClaimRef, is_outgrown: bool) -> StoreFuture<'_, AfterLoss>;

    /// The run is lost with whoever made it. The job is queued again, or ends with `problem` when that was its
    /// `attempts_max`th run to be lost.
    fn lose(&self, claim: ClaimRef, problem: Problem, attempts_max: u32) -> StoreFuture<'_, AfterLoss>;

    /// As [`lose`](Self::lose) for every job whose claim is void.
    fn recover(
        &self,
        leases: Leases,
        problem: Problem,
        attempts_max: u32,
    ) -> StoreFuture<'_, Vec<(JobId, AfterLoss)>>;

    /// Ends a job if it is still queued. Whether it was.
    fn end_queued(&self, id: JobId, ending: Ending) -> StoreFuture<'_, bool>;

    /// Ends a job if it is still queued; the claim of a running one hears of it when it is renewed, and should the run
    /// be lost, the job ends so. Whether it was queued.
    fn cancel(&self, id: JobId, ending: Ending) -> StoreFuture<'_, bool>;

    /// An ended job keeps its row and loses its files. Orphaned blobs.
    fn expire(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// Removes the row, whatever its state. Orphaned blobs.
    fn delete(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// Ended jobs that should have expired by now.
    fn due(&self) -> StoreFuture<'_, Vec<JobId>>;

    /// The job that is to go so that there is room for one of `asker`: the one that ended first, of `asker` itself when it
    /// has its share (the same for all tenants) or more, otherwise of the tenant that has most: nobody loses what is within
    /// its share to others. By number of jobs, or of bytes when only jobs with files are meant. Jobs whose webhook is still
    /// to be sent come last.
    fn first_to_go(&self, kept: EndedJobs, asker: Tenant) -> StoreFuture<'_, Option<JobId>>;

    /// The ended job of this tenant that is to go first.
    fn first_to_go_of(&self, kept: EndedJobs, tenant: Tenant) -> StoreFuture<'_, Option<JobId>>;

    /// Those of the claims by which a job runs now.
    fn current(&self, claims: Vec<ClaimRef>) -> StoreFuture<'_, HashSet<ClaimRef>>;

    /// Puts sealed secrets in the place of plain ones, which an older program left: `seal` gives nothing for one that is
    /// sealed already. How many there were.
    fn seal_secrets(&self, seal: Sealer) -> StoreFuture<'_, usize>;

    /// Those of the blobs that a row names, by their keys.
    fn named(&self, keys: Vec<String>) -> StoreFuture<'_, HashSet<String>>;

    /// Deliveries that are due, the longest due first, so that no receiver is sent more than its share at one time.
    fn claim_deliveries(&self, request: DeliveryRequest) -> StoreFuture<'_, Vec<Delivery>>;

    /// Notes a try of a delivery that was claimed, and what is next. False when `epoch` is not that of its latest claim: the
    /// try is kept, and decides nothing.
    fn note_try(
        &self,
        delivery: String,
        epoch: u32,
        outcome: TryOutcome,
        next: NextTry,
    ) -> StoreFuture<'_, bool>;

    /// The deliveries of a job.
    fn deliveries(&self, job: JobId) -> StoreFuture<'_, Vec<Delivery>>;

    /// Makes a delivery of a job due again, whatever became of it.
    fn redeliver(&self, job: JobId, delivery: String) -> StoreFuture<'_, Delivery>;

    /// When the next delivery is due, if one is pending.
    fn next_delivery(&self) -> StoreFuture<'_, Option<Timestamp>>;
}
