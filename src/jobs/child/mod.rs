//! Jobs in processes of their own: the same binary, started again for one job, confined, watched and cleared away.
//!
//! Parent: [`starter::Starter`] starts children, [`watch::watch`] gives one its task, hears it, ends it when it must end,
//! and says how it ended. Child:
//! [`run_job`] limits itself, opens what it needs, gives up the rest, runs the engine and leaves files in a folder that
//! the parent takes over. They speak JSON: a [`task::Task`] on standard input, a line for each
//! [`task::ChildMessage`] on standard output. No mesh goes through a pipe. `docs/isolation.md` says what is limited.

mod answer;
mod calls;
mod death;
mod files;
mod hearing;
mod launch;
mod limits;
mod memory_kills;
mod processes;
mod run;
mod sandbox;
mod starter;
mod task;
mod trial;
mod watch;
mod workspace;

pub(super) use processes::Processes;
pub use run::{RUN_JOB, run_job};
pub use sandbox::Sandbox;
pub use trial::TrialError;
pub(super) use workspace::MadeFile;
