//! Problems that several parts of the service tell callers of.

use std::fmt;
use std::io;

use super::store::StoreError;
use crate::wire::{Problem, ProblemCode};

/// There is no such job.
pub(super) fn not_found() -> Problem {
    Problem::new(ProblemCode::NotFound, "there is no such job")
}

/// What is asked for is no longer kept.
pub(super) fn expired() -> Problem {
    Problem::new(ProblemCode::Expired, "the job's files are no longer kept")
}

/// The disk has not kept the upload of a job.
pub(super) fn upload_gone() -> Problem {
    Problem::new(
        ProblemCode::Expired,
        "the upload was lost or damaged where the server stores it, or is not what its SHA-256 says; send the mesh again",
    )
}

/// A server that ends is asked for something new.
pub(super) fn draining() -> Problem {
    Problem::new(ProblemCode::Draining, "the server is shutting down")
}

/// The engine panicked.
pub(super) fn engine_crashed() -> Problem {
    Problem::new(ProblemCode::EngineCrashed, "the engine failed on this mesh")
}

/// Something failed that is not the caller's doing; `why` is told to the caller.
pub(super) fn internal(why: &dyn fmt::Display) -> Problem {
    Problem::new(ProblemCode::Internal, why.to_string())
}

/// A failure of the disk, told to the caller without paths and to the log with them.
pub(super) fn disk_problem(error: &io::Error) -> Problem {
    tracing::error!(%error, "the data directory failed");
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            Problem::new(ProblemCode::StorageFull, "the disk is full")
        }
        // No disk says so, but a bucket; the second one where it took a file and its answer was lost: no name is given twice.
        io::ErrorKind::HostUnreachable | io::ErrorKind::AlreadyExists => {
            Problem::new(ProblemCode::StoreUnavailable, "the store of files does not answer")
        }
        _ => Problem::new(ProblemCode::Internal, "the data directory failed"),
    }
}

/// A failure in the folder of a process. One that somebody removed costs the job a run.
pub(super) fn workspace_problem(error: &io::Error) -> Problem {
    match error.kind() {
        // The sandbox of a process does not know a folder that was made again.
        io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied => {
            tracing::error!(%error, "the folder of a process was removed");
            Problem::new(ProblemCode::WorkerLost, "the folder of the process that ran the job was removed")
        }
        _ => disk_problem(error),
    }
}

/// A store's failure as the caller hears it.
pub(super) fn store_problem(error: &StoreError) -> Problem {
    match error {
        StoreError::NotFound => not_found(),
        StoreError::Unavailable(_) => {
            tracing::error!(%error, "the job store does not answer");
            Problem::new(ProblemCode::StoreUnavailable, "the job store does not answer")
        }
        StoreError::Full(_) => {
            Problem::new(ProblemCode::StorageFull, "the disk is full: the job store cannot write")
        }
        StoreError::KeyReused => Problem::new(
            ProblemCode::IdempotencyKeyReused,
            "the `Idempotency-Key` was used with another mesh, operation or options",
        ),
        StoreError::UploadMoved { received } => Problem::new(
            ProblemCode::UploadConflict,
            format!("the upload goes on at byte {received}"),
        ),
        StoreError::UploadsFull { limit, .. } => Problem::new(
            ProblemCode::StorageFull,
            "there are as many unfinished uploads as may be, or as this caller may have beside those of others; finish or delete some",
        )
        .with_limit("uploads_max", *limit as u64, None),
        StoreError::QueueFull { .. } | StoreError::ShareFull { .. } | StoreError::ClaimVoid => {
            internal(error)
        }
    }
}
