//! Where a service keeps what outlasts it: the rows of jobs and their files, given to it at its start.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::belonging::open_together;
use super::blobs::{BlobStore, LocalBlobs};
use super::data_dir::{DataDirLock, LockError};
use super::settings::JobsSettings;
use super::shared::{SharedError, SharedStores};
use super::store::JobStore;

/// The file of rows in the data directory.
pub(super) const ROWS_FILE: &str = "jobs.sqlite3";
/// The folder of files in the data directory.
pub(super) const BLOBS_DIR: &str = "spool";

/// The stores of a service.
pub struct Stores {
    /// The rows of jobs.
    pub rows: Arc<dyn JobStore>,
    /// The files of jobs.
    pub blobs: Arc<dyn BlobStore>,
    /// Name of the service among all that use the rows, the same after each of its starts: what a service of that name was
    /// running when it ended is void when it starts again.
    pub worker: String,
    /// What is held while the service uses the stores.
    pub lock: Option<DataDirLock>,
}

impl fmt::Debug for Stores {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stores").field("worker", &self.worker).finish_non_exhaustive()
    }
}

/// Stores that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoresError {
    /// The data directory cannot be used.
    #[error("data directory {path}: {source}")]
    DataDir {
        /// The directory.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Another server uses the data directory.
    #[error("data directory {path} is in use by another server")]
    DataDirInUse {
        /// The directory.
        path: PathBuf,
    },
    /// The database of jobs cannot be used.
    #[error("{why}")]
    Database {
        /// Why.
        why: String,
    },
    /// The bucket of files cannot be used.
    #[error("{why}")]
    Bucket {
        /// Why.
        why: String,
    },
    /// The rows of jobs cannot be read.
    #[error("job store {path}: {why}")]
    Rows {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
}

impl Stores {
    /// Those that the settings name: shared ones, or those in the data directory. This process owns the directory from
    /// then on.
    ///
    /// # Errors
    /// The directory or the stores cannot be used, or another server uses the directory.
    pub async fn open(settings: &JobsSettings) -> Result<Self, StoresError> {
        match &settings.shared {
            Some(shared) => Self::shared(settings, shared).await,
            None => Self::local(settings).await,
        }
    }

    /// A database and a bucket, which other servers use too.
    async fn shared(settings: &JobsSettings, shared: &SharedStores) -> Result<Self, StoresError> {
        let path = &settings.data_dir;
        let lock = Self::own(settings).await?;
        if path.join(ROWS_FILE).exists() {
            tracing::warn!(
                "the data directory holds jobs of its own, which are not seen while database_url is set: {}",
                path.join(ROWS_FILE).display()
            );
        }
        let (rows, blobs, worker) = shared.open(path).await.map_err(|error| match error {
            SharedError::DataDir(source) => StoresError::DataDir { path: path.clone(), source },
            SharedError::Database(why) => StoresError::Database { why },
            SharedError::Bucket(why) => StoresError::Bucket { why },
        })?;
        Ok(Self { rows: Arc::new(rows), blobs, worker, lock: Some(lock) })
    }

    /// Takes the data directory over.
    async fn own(settings: &JobsSettings) -> Result<DataDirLock, StoresError> {
        let path = &settings.data_dir;
        DataDirLock::take(path).await.map_err(|error| match error {
            LockError::InUse => StoresError::DataDirInUse { path: path.clone() },
            LockError::Io(source) => StoresError::DataDir { path: path.clone(), source },
        })
    }

    /// Those in the data directory, which this process owns from then on.
    ///
    /// # Errors
    /// The directory or the rows in it cannot be used, or another server uses them.
    pub async fn local(settings: &JobsSettings) -> Result<Self, StoresError> {
        let path = &settings.data_dir;
        let lock = Self::own(settings).await?;
        let blobs = LocalBlobs::open(&path.join(BLOBS_DIR))
            .map_err(|source| StoresError::DataDir { path: path.clone(), source })?;
        let file = path.join(ROWS_FILE);
        let (rows, mark) = open_together(path, &file, &blobs, settings.lost_store)
            .map_err(|error| StoresError::Rows { path: file, why: error.to_string() })?;
        Ok(Self { rows: Arc::new(rows), blobs: Arc::new(blobs), worker: mark, lock: Some(lock) })
    }
}
