//! The life of a job: every operation is one, and "synchronous" only means "wait for it".
//!
//! [`Jobs`] takes uploads onto disk ([`Upload`]), admits jobs to a bounded queue, runs them in slots, each in a process of
//! its own or in a thread ([`Isolation`]), and keeps reports and results for a while. Rows live in a [`JobStore`], files in
//! the spool of the data directory. A job's end, whatever it is, is that of one job, never of a slot.

mod admission;
mod attempt;
mod child;
mod clock;
mod drain;
mod live;
mod memory;
mod meters;
mod product;
mod retention;
mod service;
mod settings;
mod slot;
mod spool;
mod store;
mod upload;
mod view;

#[cfg(test)]
mod tests;

pub use admission::Submission;
pub use attempt::{Engine, Isolation};
pub use child::{RUN_JOB, Sandbox, TrialError, run_job};
pub use clock::StageClock;
pub use memory::MemoryStore;
pub use service::{Jobs, Load, StartError};
pub use settings::JobsSettings;
pub use store::{
    BlobRef, Finish, JobCounts, JobId, JobRow, JobStore, Kept, ResultRef, StoreError, StoreFuture,
};
pub use upload::{Upload, Uploaded};
pub use view::StoredFile;
