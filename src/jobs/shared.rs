//! Stores that several servers share: rows in a database, files in a bucket, and what sees to it that both belong together.

use std::fs;
use std::io::{self, Write as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;
use std::sync::Arc;

use uuid::Uuid;

use super::blobs::BlobStore as _;
use super::postgres::{DatabaseAccess, PostgresStore};
use super::s3::{BucketAccess, S3Blobs};
use super::store::JobStore as _;

/// The file of the server's name in the data directory.
const NAME_FILE: &str = "server.name";
/// The folder of copies in the data directory.
const COPIES_DIR: &str = "copies";
/// Longest name that is read.
const NAME_BYTES_MAX: usize = 64;
/// Most files of a bucket without a mark that are looked for in the rows.
const LOOKED_FOR_MAX: usize = 1000;

/// Where several servers keep what they share.
#[derive(Debug, Clone)]
pub struct SharedStores {
    /// The rows of jobs.
    pub database: DatabaseAccess,
    /// Their files.
    pub bucket: BucketAccess,
}

/// Why they cannot be used.
#[derive(Debug)]
pub(super) enum SharedError {
    DataDir(io::Error),
    Database(String),
    Bucket(String),
}

impl SharedStores {
    /// Opens both, for the server that owns this data directory. With its name.
    pub(super) async fn open(
        &self,
        data_dir: &Path,
    ) -> Result<(PostgresStore, Arc<S3Blobs>, String), SharedError> {
        let name = server_name(data_dir).map_err(SharedError::DataDir)?;
        let bucket = |error: &dyn std::fmt::Display| SharedError::Bucket(error.to_string());
        let rows =
            PostgresStore::open(&self.database).await.map_err(|e| SharedError::Database(e.to_string()))?;
        let (access, copies) = (self.bucket.clone(), data_dir.join(COPIES_DIR));
        let looking = tokio::task::spawn_blocking(move || {
            let blobs = S3Blobs::open(&access, &copies).map_err(io::Error::other)?;
            let mark = blobs.mark()?;
            // A bucket of many files is listed only where their mark does not say whose they are.
            let listed = if mark.is_none() { blobs.list()? } else { Vec::new() };
            Ok::<_, io::Error>((Arc::new(blobs), mark, listed))
        });
        let (blobs, mark, listed) = looking.await.map_err(|e| bucket(&e))?.map_err(|e| bucket(&e))?;
        if mark.is_none() && !listed.is_empty() {
            let keys = listed.into_iter().take(LOOKED_FOR_MAX).map(|file| file.key).collect();
            let named = rows.named(keys).await.map_err(|e| SharedError::Database(e.to_string()))?;
            if named.is_empty() {
                return Err(bucket(
                    &"it holds files that no row of the database names: name an empty one, or another folder",
                ));
            }
        }
        let (marked, own) = (Arc::clone(&blobs), rows.mark().to_owned());
        let mark = match mark {
            Some(mark) => mark,
            None => tokio::task::spawn_blocking(move || marked.set_mark(&own))
                .await
                .map_err(|e| bucket(&e))?
                .map_err(|e| bucket(&e))?,
        };
        if mark != rows.mark() {
            return Err(bucket(
                &"its files are those of another database: put that one back, or name an empty bucket",
            ));
        }
        Ok((rows, blobs, name))
    }
}

/// The name by which the server of this data directory is known among the others, the same after each of its starts.
fn server_name(data_dir: &Path) -> io::Result<String> {
    let path = data_dir.join(NAME_FILE);
    match fs::read(&path) {
        Ok(name) => {
            let name = String::from_utf8_lossy(&name[..name.len().min(NAME_BYTES_MAX)]).trim().to_owned();
            if !name.is_empty() {
                return Ok(name);
            }
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        Err(_) => {}
    }
    let name = Uuid::now_v7().simple().to_string();
    let mut file = fs::OpenOptions::new().write(true).create(true).truncate(true).mode(0o600).open(&path)?;
    file.write_all(name.as_bytes())?;
    file.sync_all()?;
    Ok(name)
}
