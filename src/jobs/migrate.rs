//! What a server has in its data directory goes to stores that several servers share: files first, each compared with its
//! digest there and here, then all rows at once. What it comes from stays as it is.
//!
//! Cut off before the end, it leaves files that no row names and no row at all, and the next try goes on from there.

use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tokio::sync::mpsc;

use super::blobs::BlobStore as _;
use super::data_dir::{DataDirLock, LockError};
use super::postgres::{PostgresStore, Rows};
use super::s3::S3Blobs;
use super::shared::{SharedError, SharedStores};
use super::soundness::{Unsound, open_sound};
use super::sqlite::Export;
use super::store::tables::{TABLES, Table};
use super::store::{BlobRef, StoreError};
use super::stores::{BLOBS_DIR, ROWS_FILE};

/// Rows that go together.
const ROWS_AT_ONCE: usize = 200;

/// What was carried over.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Migrated {
    /// Jobs, whatever their state.
    pub jobs: u64,
    /// Files, and their bytes.
    pub files: u64,
    /// Bytes of all files.
    pub bytes: u64,
    /// Those files of them that an earlier try had carried over.
    pub files_of_earlier_tries: u64,
    /// Files that rows name and that are lost or damaged: their jobs are carried over without them.
    pub unsound: Vec<String>,
}

/// Why nothing was carried over, or not all.
#[derive(Debug, thiserror::Error)]
pub enum MigrateError {
    /// There is nothing to be carried over.
    #[error("data directory {path}: it holds no jobs ({ROWS_FILE})")]
    NoSource {
        /// The directory.
        path: PathBuf,
    },
    /// A server uses the data directory.
    #[error("data directory {path} is in use by a server: end it first")]
    SourceInUse {
        /// The directory.
        path: PathBuf,
    },
    /// The data directory cannot be read.
    #[error("data directory {path}: {why}")]
    Source {
        /// The directory.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// There are jobs already.
    #[error("the database holds {jobs} jobs already: name an empty one")]
    RowsInTarget {
        /// How many.
        jobs: i64,
    },
    /// There are other files already.
    #[error(
        "the bucket holds files that are none of this data directory, such as {key}: name an empty one, or another folder"
    )]
    FilesInTarget {
        /// One of them.
        key: String,
    },
    /// The database or the bucket cannot be used.
    #[error("{why}")]
    Target {
        /// Why.
        why: String,
    },
}

/// Carries over what is in `data_dir`.
///
/// # Errors
/// A server uses the directory, or there is nothing in it; the target cannot be used, or is not empty.
pub async fn migrate(data_dir: &Path, shared: &SharedStores) -> Result<Migrated, MigrateError> {
    let path = data_dir.to_owned();
    let unreadable =
        |why: &dyn std::fmt::Display| MigrateError::Source { path: path.clone(), why: why.to_string() };
    let target = |why: &dyn std::fmt::Display| MigrateError::Target { why: why.to_string() };
    if !data_dir.join(ROWS_FILE).exists() {
        return Err(MigrateError::NoSource { path });
    }
    let _lock = DataDirLock::take(data_dir).await.map_err(|error| match error {
        LockError::InUse => MigrateError::SourceInUse { path: path.clone() },
        LockError::Io(error) => unreadable(&error),
    })?;
    let scratch = tempfile::tempdir().map_err(|e| unreadable(&e))?;
    let (file, folder) = (data_dir.join(ROWS_FILE), scratch.path().to_owned());
    let opening = tokio::task::spawn_blocking(move || {
        let source = Export::of_copy(&file, &folder).map_err(|error| error.to_string())?;
        let blobs = source.blobs().map_err(|error| error.to_string())?;
        Ok::<_, String>((source, blobs))
    });
    let (source, blobs) = opening.await.map_err(|e| unreadable(&e))?.map_err(|e| unreadable(&e))?;
    let (rows, bucket, _) = shared.open(scratch.path()).await.map_err(|error| match error {
        SharedError::DataDir(error) => unreadable(&error),
        SharedError::Database(why) | SharedError::Bucket(why) => MigrateError::Target { why },
    })?;
    let jobs = rows.job_count().await.map_err(|e| target(&e))?;
    if jobs > 0 {
        return Err(MigrateError::RowsInTarget { jobs });
    }
    let sending = FileTransfer { spool: data_dir.join(BLOBS_DIR), bucket, done: Migrated::default() };
    let sent = tokio::task::spawn_blocking(move || sending.all(&blobs)).await.map_err(|e| target(&e))?;
    let done = sent?;
    let jobs = carry_rows(source, &rows).await.map_err(|e| target(&e))?;
    Ok(Migrated { jobs, ..done })
}

/// Files on their way.
struct FileTransfer {
    spool: PathBuf,
    bucket: Arc<S3Blobs>,
    done: Migrated,
}

impl FileTransfer {
    /// Sends every file that is not there yet. Blocks.
    fn all(mut self, blobs: &[BlobRef]) -> Result<Migrated, MigrateError> {
        let told = |error: &io::Error| MigrateError::Target { why: format!("the bucket: {error}") };
        let ours: HashSet<&String> = blobs.iter().map(|blob| &blob.key).collect();
        let listed = self.bucket.list().map_err(|e| told(&e))?;
        let there: HashSet<String> = listed.into_iter().map(|file| file.key).collect();
        if let Some(foreign) = there.iter().find(|key| !ours.contains(key)) {
            return Err(MigrateError::FilesInTarget { key: foreign.clone() });
        }
        for blob in blobs {
            if there.contains(&blob.key) {
                self.done.files_of_earlier_tries += 1;
            } else {
                let file = self.spool.join(&blob.key);
                match open_sound(&file, blob) {
                    Ok(_) => self.bucket.send(&file, &blob.key).map_err(|e| told(&e))?,
                    Err(Unsound::Disk(error)) => {
                        return Err(MigrateError::Source { path: file, why: error.to_string() });
                    }
                    Err(Unsound::Lost | Unsound::Damaged) => {
                        self.done.unsound.push(blob.key.clone());
                        continue;
                    }
                }
            }
            if self.bucket.digest(&blob.key).map_err(|e| told(&e))? != blob.sha256 {
                let why = format!("the bucket: the bytes of {} are not those that were sent", blob.key);
                return Err(MigrateError::Target { why });
            }
            self.done.files += 1;
            self.done.bytes += blob.bytes;
        }
        Ok(self.done)
    }
}

/// Carries all rows over. How many jobs.
async fn carry_rows(source: Export, target: &PostgresStore) -> Result<u64, StoreError> {
    let (send, coming) = mpsc::channel(2);
    let reading = tokio::task::spawn_blocking(move || {
        let mut counts = Vec::with_capacity(TABLES.len());
        for table in TABLES {
            counts.push(send_table(&source, table, &send)?);
        }
        // Nobody listens any more when the other side has failed, which says why.
        let _ = send.blocking_send(None);
        Ok::<_, StoreError>(counts)
    });
    let (read, taken) = tokio::join!(reading, target.import(coming));
    let sent = read.map_err(|error| StoreError::Unavailable(error.to_string()))??;
    let there = taken?;
    if sent != there {
        return Err(StoreError::Unavailable(format!("{sent:?} rows were sent, and {there:?} are there")));
    }
    Ok(u64::try_from(there.first().copied().unwrap_or_default()).unwrap_or_default())
}

/// Sends the rows of a table. How many.
fn send_table(
    source: &Export,
    table: &'static Table,
    send: &mpsc::Sender<Option<Rows>>,
) -> Result<i64, StoreError> {
    let (mut rows, mut count) = (Vec::new(), 0);
    source.rows(table, |cells| {
        rows.push(cells);
        count += 1;
        rows.len() < ROWS_AT_ONCE
            || send.blocking_send(Some(Rows { table, rows: std::mem::take(&mut rows) })).is_ok()
    })?;
    // As above.
    let _ = send.blocking_send(Some(Rows { table, rows }));
    Ok(count)
}
