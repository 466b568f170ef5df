//! The life of a job: every operation is one, and "synchronous" only means "wait for it".
//!
//! [`Jobs`] takes uploads onto disk ([`Upload`]), admits jobs to a bounded queue, runs them in slots on the blocking
//! pool, and keeps reports and results for a while. Rows live in a [`JobStore`], files in the spool of the data
//! directory. A job's panic is a failed job, never a dead slot.

mod admission;
mod clock;
mod drain;
mod live;
mod memory;
mod meters;
mod retention;
mod service;
mod settings;
mod slot;
mod spool;
mod store;
mod upload;
mod view;
mod webhook;

#[cfg(test)]
mod tests;

pub use admission::Submission;
pub use clock::StageClock;
pub use memory::MemoryStore;
pub use service::{Jobs, Load, StartError};
pub use settings::JobsSettings;
pub use slot::Engine;
pub use store::{
    BlobRef, Finish, JobCounts, JobId, JobRow, JobStore, Kept, ResultRef, StoreError, StoreFuture,
};
pub use upload::{Upload, Uploaded};
pub use view::StoredFile;
pub use webhook::{PrivateHosts, RetryPlan, SecretError, Target, TargetError, URL_BYTES_MAX, WebhookSecret};
