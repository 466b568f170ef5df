//! Files in a bucket of any S3, with copies of those in use on the disk of this machine.
//!
//! A file is written to this machine first and is in the bucket, under its name and complete, when its commit returns. Who
//! reads one gets the copy, which is brought here when there is none.

mod access;
mod cache;
mod presigned;
mod transfer;

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path as FilePath, PathBuf};
use std::sync::{Arc, mpsc};
use std::time::Duration;

use futures_util::TryStreamExt as _;
use object_store::aws::AmazonS3;
use object_store::path::Path;
use object_store::{ObjectStore, ObjectStoreExt as _, PutMode, PutOptions};
use tokio::runtime::{self, Runtime};

use sha2::{Digest as _, Sha256};

use super::blobs::{BlobStore, BlobWriter, PresignedUrls, StoredBlob};
pub use access::{BucketAccess, BucketError};
use cache::Cache;

/// For how long after it was written a file that no row names may be one that another server is about to name.
const NAMED_WITHIN: Duration = Duration::from_secs(60 * 60);
/// Threads that speak to the bucket.
const THREADS: usize = 2;
/// The file that tells whose store the files are, beside them.
const MARK: &str = "store.mark";

/// Files in a bucket.
pub struct S3Blobs {
    parts: Arc<SharedBucket>,
    /// `None` once it is dropped.
    runtime: Option<Runtime>,
}

/// What writers and removals share with the store.
struct SharedBucket {
    bucket: Box<dyn ObjectStore>,
    /// The same bucket, by the address that clients know.
    signer: AmazonS3,
    prefix: Path,
    cache: Cache,
    handle: runtime::Handle,
}

impl fmt::Debug for S3Blobs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("S3Blobs").field("prefix", &self.parts.prefix).finish_non_exhaustive()
    }
}

impl Drop for S3Blobs {
    fn drop(&mut self) {
        if let Some(runtime) = self.runtime.take() {
            // What is cut off is found by the collection of orphans.
            runtime.shutdown_background();
        }
    }
}

impl S3Blobs {
    /// The files in a bucket. `cache` is a folder of this server's own for copies; what is in it goes. Blocks.
    ///
    /// # Errors
    /// The address cannot be used, or the disk fails. The bucket is not asked yet.
    pub fn open(access: &BucketAccess, cache: &FilePath) -> Result<Self, BucketError> {
        let (bucket, signer, prefix) = access.connect()?;
        let runtime = runtime::Builder::new_multi_thread()
            .worker_threads(THREADS)
            .thread_name("bucket")
            .enable_all()
            .build()
            .map_err(BucketError::Disk)?;
        let parts = SharedBucket {
            bucket: Box::new(bucket),
            signer,
            prefix,
            cache: Cache::open(cache, access.cache_bytes_max).map_err(BucketError::Disk)?,
            handle: runtime.handle().clone(),
        };
        Ok(Self { parts: Arc::new(parts), runtime: Some(runtime) })
    }

    /// The mark of the store that the files in the bucket belong to, if there is one. Blocks.
    ///
    /// # Errors
    /// The bucket does not answer.
    pub fn mark(&self) -> io::Result<Option<String>> {
        self.parts.run(|parts| async move {
            match parts.bucket.get(&parts.place(MARK)).await {
                Ok(found) => {
                    let mark = found.bytes().await?;
                    Ok(Some(String::from_utf8_lossy(&mark).trim().to_owned()))
                }
                Err(object_store::Error::NotFound { .. }) => Ok(None),
                Err(error) => Err(error),
            }
        })
    }

    /// Sends a complete file of this machine, which stays as it is. Blocks.
    ///
    /// # Errors
    /// The bucket does not take it, or has one of that name.
    pub(super) fn send(&self, file: &FilePath, key: &str) -> io::Result<()> {
        self.parts.upload(file, key)
    }

    /// The SHA-256 of a file in the bucket, of which no copy is kept. Blocks.
    ///
    /// # Errors
    /// There is no such file, or the bucket does not answer.
    pub(super) fn digest(&self, key: &str) -> io::Result<[u8; 32]> {
        let place = self.parts.place(key);
        self.parts.run(move |parts| async move {
            let mut content = parts.bucket.get(&place).await?.into_stream();
            let mut digest = Sha256::new();
            while let Some(piece) = content.try_next().await? {
                digest.update(&piece);
            }
            Ok(digest.finalize().into())
        })
    }

    /// Marks the files as those of a store, if they have no mark. The mark that they have then. Blocks.
    ///
    /// # Errors
    /// The bucket does not answer.
    pub fn set_mark(&self, mark: &str) -> io::Result<String> {
        let (given, key) = (mark.to_owned(), self.parts.place(MARK));
        let put = self.parts.run(move |parts| async move {
            parts.bucket.put_opts(&key, given.into(), PutOptions::from(PutMode::Create)).await.map(drop)
        });
        match put {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => Err(error),
            // Another server was first.
            Ok(()) | Err(_) => Ok(self.mark()?.unwrap_or_else(|| mark.to_owned())),
        }
    }
}

impl SharedBucket {
    /// Where the bucket has the file.
    fn place(&self, key: &str) -> Path {
        self.prefix.parts().chain(Path::from(key).parts()).collect()
    }

    /// Waits for what is done with the bucket, on threads of its own: this one may belong to another runtime.
    fn run<T: Send + 'static, F>(self: &Arc<Self>, body: impl FnOnce(Arc<Self>) -> F) -> io::Result<T>
    where
        F: Future<Output = object_store::Result<T>> + Send + 'static,
    {
        let (tell, told) = mpsc::sync_channel(1);
        let work = body(Arc::clone(self));
        self.handle.spawn(async move {
            // Nobody waits any more when the thread that did is gone.
            drop(tell.send(work.await));
        });
        told.recv().map_err(|_| io::Error::other("the server ends"))?.map_err(failure)
    }
}

impl BlobStore for S3Blobs {
    fn create(&self, key: &str) -> io::Result<Box<dyn BlobWriter>> {
        let (path, file) = self.parts.cache.begin()?;
        Ok(Box::new(S3Writer { parts: Arc::clone(&self.parts), key: key.to_owned(), file: Some(file), path }))
    }

    /// The file must be on the disk of the copies: it becomes one.
    fn adopt(&self, file: &FilePath, key: &str) -> io::Result<()> {
        self.parts.upload(file, key)?;
        self.parts.cache.keep(file, key)
    }

    fn local(&self, key: &str) -> io::Result<PathBuf> {
        if self.parts.cache.is_going(key) {
            return Err(io::ErrorKind::NotFound.into());
        }
        match self.parts.cache.find(key) {
            Some(path) => Ok(path),
            None => self.parts.download(key),
        }
    }

    /// The copy goes at once, the file in the bucket soon: what removes files does not wait for a network. Should that fail,
    /// the collection of orphans finds it.
    fn remove(&self, key: &str) -> io::Result<()> {
        let (parts, key) = (Arc::clone(&self.parts), key.to_owned());
        parts.cache.begin_to_remove(&key);
        self.parts.handle.spawn(async move {
            match parts.bucket.delete(&parts.place(&key)).await {
                Ok(()) | Err(object_store::Error::NotFound { .. }) => {}
                Err(error) => tracing::warn!(key, %error, "a file could not be removed from the bucket"),
            }
            parts.cache.end_to_remove(&key);
        });
        Ok(())
    }

    fn list(&self) -> io::Result<Vec<StoredBlob>> {
        self.parts.run(|parts| async move {
            let mut blobs = Vec::new();
            // Asked before the listing: what is gone by then is not in it.
            let going = parts.cache.going();
            let recent = jiff::Timestamp::now().as_second() - NAMED_WITHIN.as_secs().cast_signed();
            for dir in super::blobs::DIRS {
                let mut files = parts.bucket.list(Some(&parts.place(dir)));
                while let Some(file) = files.try_next().await? {
                    let key = format!("{dir}/{}", file.location.filename().unwrap_or_default());
                    if !going.contains(&key) && !parts.cache.is_going(&key) {
                        let is_recent = file.last_modified.timestamp() > recent;
                        blobs.push(StoredBlob { key, bytes: file.size, is_recent });
                    }
                }
            }
            Ok(blobs)
        })
    }

    /// Those of the disk of this machine, where every file is first.
    fn free_bytes(&self) -> Option<u64> {
        self.parts.cache.free_bytes()
    }

    fn presigned(&self) -> Option<&dyn PresignedUrls> {
        Some(self)
    }
}

/// A file on its way to the bucket, on this machine until then.
struct S3Writer {
    parts: Arc<SharedBucket>,
    key: String,
    /// `None` once it is committed.
    file: Option<File>,
    path: PathBuf,
}

impl Write for S3Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl BlobWriter for S3Writer {
    fn commit(mut self: Box<Self>) -> io::Result<()> {
        self.parts.upload(&self.path, &self.key)?;
        self.file = None;
        self.parts.cache.keep(&self.path, &self.key)
    }
}

impl Drop for S3Writer {
    fn drop(&mut self) {
        if self.file.is_some() {
            // What stays goes with the next start.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// What the bucket says, as a disk says it.
fn failure(error: object_store::Error) -> io::Error {
    let kind = match &error {
        object_store::Error::NotFound { .. } => io::ErrorKind::NotFound,
        object_store::Error::AlreadyExists { .. } | object_store::Error::Precondition { .. } => {
            io::ErrorKind::AlreadyExists
        }
        // The bucket, or the way to it, does not do its work now. Also where it refuses what is asked: a request that a line has cut
        // may look like one that was changed.
        _ => io::ErrorKind::HostUnreachable,
    };
    io::Error::new(kind, error)
}
