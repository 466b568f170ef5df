//! The life of a job: every operation is one, and "synchronous" only means "wait for it".
//!
//! [`Jobs`] takes uploads onto disk ([`Upload`]), admits jobs to a bounded queue, runs them in slots, each in a process of
//! its own or in a thread ([`Isolation`]), and keeps reports and results for a while. Rows live in a [`JobStore`], files in
//! a [`BlobStore`]; both outlast the process, so a job that was accepted ends even when the server is killed. A run that
//! fails, however it does, is a lost run, never a dead slot.

mod admission;
mod arrivals;
mod attempt;
mod belonging;
mod blobs;
mod capacity;
mod child;
mod clock;
mod drain;
mod estimate;
mod events;
mod giving;
mod heartbeat;
mod live;
mod load;
mod meters;
mod product;
mod retention;
mod service;
mod settings;
mod settle;
mod shares;
mod slot;
mod soundness;
mod spool;
mod sqlite;
mod store;
mod trace;
mod upload;
mod view;
mod wall;
mod webhook;

#[cfg(test)]
mod tests;

pub use admission::Submission;
pub use attempt::{Engine, Isolation};
pub use belonging::LostStore;
pub use blobs::{BlobStore, BlobWriter, LocalBlobs, StoredBlob};
pub use child::{RUN_JOB, Sandbox, TrialError, run_job};
pub use clock::StageClock;
pub use events::{EventId, Events, Happened, JobEvent, NoEventId};
pub use load::Load;
pub use meters::describe as describe_metrics;
pub use service::{Jobs, StartError};
pub use settings::JobsSettings;
pub use sqlite::{OpenError as SqliteOpenError, SqliteStore, StoreClock, StoreFile};
pub use store::{
    AfterLoss, BlobRef, Change, ClaimRef, ClaimRequest, Created, Delivery, DeliveryRequest, DeliveryState,
    DeliveryTry, Ending, Holding, IdempotencyKey, JobCounts, JobId, JobRow, JobStore, Kept, Lane, Leases,
    ListQuery, NewJob, NextTry, ResultRef, Sealer, StoreError, StoreFuture, Tenant, TryOutcome, Webhook,
};
pub use trace::TraceParent;
pub use upload::{Upload, Uploaded};
pub use view::StoredFile;
pub use webhook::{
    PrivateHosts, RetryPlan, SecretError, Target, TargetError, URL_BYTES_MAX, VaultError, WebhookSecret,
    WebhookSettings,
};
