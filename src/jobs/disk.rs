//! Work that waits for the disk, off the threads that serve connections.

use std::io;

use tokio::task::JoinHandle;

use super::problems::{disk_problem, internal};
use crate::wire::Problem;

/// Runs what waits for the disk on a thread that may wait.
pub(super) async fn on_disk<T: Send + 'static>(
    body: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> Result<T, Problem> {
    joined(tokio::task::spawn_blocking(body)).await
}

/// What came of work that waits for the disk on another thread.
pub(super) async fn joined<T>(work: JoinHandle<io::Result<T>>) -> Result<T, Problem> {
    let lost = |_| internal(&"a file could not be written");
    work.await.map_err(lost)?.map_err(|error| disk_problem(&error))
}
