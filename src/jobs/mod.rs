//! The life of a job: every operation is one, and "synchronous" only means "wait for it".
//!
//! [`Jobs`] takes uploads onto disk ([`Upload`]), admits jobs to a bounded queue, runs them in slots, each in a process of
//! its own or in a thread ([`Isolation`]), and keeps reports and results for a while. Rows live in a [`JobStore`], files in
//! a [`BlobStore`]; both outlast the process, so a job that was accepted ends even when the server is killed. A run that
//! fails, however it does, is a lost run, never a dead slot.

mod admission;
mod arrivals;
mod belonging;
mod blobs;
mod capacity;
mod child;
mod clock;
mod data_dir;
mod disk;
mod drain;
mod estimate;
mod events;
mod executor;
mod giving;
mod handle;
mod heartbeat;
mod live;
mod load;
mod memory;
mod meters;
mod migrate;
mod neighbours;
mod pace;
mod pieces;
mod postgres;
mod presigned;
mod problems;
mod product;
mod retention;
mod room;
mod s3;
mod service;
mod settings;
mod settle;
mod shared;
mod shares;
mod slot;
mod soundness;
mod spool;
mod sqlite;
mod start;
mod store;
mod stores;
mod take_over;
mod trace;
mod upload;
mod view;
mod webhook;

#[cfg(test)]
mod tests;

pub use admission::Submission;
pub use belonging::LostStore;
pub use blobs::{BlobStore, BlobWriter, LocalBlobs, PresignedPut, PresignedUrls, StoredBlob};
pub use child::{RUN_JOB, Sandbox, TrialError, run_job};
pub use clock::StageClock;
pub use data_dir::DataDirLock;
pub use events::{EventId, Happened, JobEvent, JobEventStream, NoEventId};
pub use executor::Engine;
pub use handle::Jobs;
pub use load::Load;
pub use meters::describe as describe_metrics;
pub use migrate::{MigrateError, Migrated, migrate};
pub use pieces::{AskedUpload, NamedUpload, UPLOAD_PIECES_MAX, UploadPieces};
pub use postgres::{DatabaseAccess, PostgresOpenError, PostgresStore};
pub use s3::{BucketAccess, BucketError, S3Blobs};
pub use settings::{Isolation, JobsSettings};
pub use shared::SharedStores;
pub use sqlite::{SqliteOpenError, SqliteStore, StoreClock, StoreFile};
pub use start::StartError;
pub use store::{
    AfterLoss, BlobRef, ClaimRef, ClaimRequest, Created, Delivery, DeliveryRequest, DeliveryState,
    DeliveryTry, EndedJobs, Ending, Hint, Hints, Holding, IdempotencyKey, JobCounts, JobId, JobRow, JobStore,
    Lane, Leases, ListQuery, NewJob, NewUpload, NextTry, ResultRef, Sealer, StateChange, StoreError,
    StoreFuture, Tenant, TryOutcome, UploadId, UploadRow, UploadStore, Webhook,
};
pub use stores::{Stores, StoresError};
pub use trace::TraceParent;
pub use upload::{Upload, Uploaded};
pub use view::StoredFile;
pub use webhook::{
    PrivateHosts, RetryPlan, SecretError, TargetError, URL_BYTES_MAX, VaultError, WebhookSecret,
    WebhookSettings, WebhookTarget,
};
