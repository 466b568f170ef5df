//! Files under the data directory: who owns it, how full it is.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use sha2::{Digest, Sha256};
use uuid::Uuid;

use super::product::MadeFile;
use super::store::BlobRef;

/// The files of one server.
#[derive(Debug)]
pub(super) struct Spool {
    dir: PathBuf,
    /// Held as long as the server runs: two servers must not share a directory.
    _lock: File,
    bytes: AtomicU64,
    bytes_max: u64,
}

/// A directory that cannot be used.
#[derive(Debug)]
pub(super) enum OpenError {
    InUse,
    Io(io::Error),
}

impl From<io::Error> for OpenError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Spool {
    /// Takes the directory over; files of an earlier run go, because their rows are gone.
    pub(super) fn open(data_dir: &Path, bytes_max: u64) -> Result<Arc<Self>, OpenError> {
        let dir = data_dir.join("spool");
        fs::create_dir_all(&dir)?;
        let lock = File::options().create(true).append(true).open(data_dir.join("lock"))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(OpenError::InUse),
            Err(TryLockError::Error(error)) => return Err(error.into()),
        }
        for entry in fs::read_dir(&dir)? {
            fs::remove_file(entry?.path())?;
        }
        Ok(Arc::new(Self { dir, _lock: lock, bytes: AtomicU64::new(0), bytes_max }))
    }

    /// A key that no file has.
    pub(super) fn new_key() -> String {
        Uuid::now_v7().simple().to_string()
    }

    pub(super) fn path(&self, key: &str) -> PathBuf {
        self.dir.join(key)
    }

    /// Bytes on disk, and those that are about to come.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    pub(super) fn bytes_max(&self) -> u64 {
        self.bytes_max
    }

    /// Room for `bytes`, if there is.
    pub(super) fn reserve(self: &Arc<Self>, bytes: u64) -> Option<Space> {
        let grown = |used: u64| used.checked_add(bytes).filter(|&total| total <= self.bytes_max);
        self.bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, grown).ok()?;
        Some(Space { spool: Arc::clone(self), bytes })
    }

    /// Writes a file into reserved room. Blocks.
    pub(super) fn write(&self, content: &[u8], space: Space) -> io::Result<BlobRef> {
        let key = Self::new_key();
        fs::write(self.path(&key), content).inspect_err(|_| drop(fs::remove_file(self.path(&key))))?;
        let blob = BlobRef { key, bytes: content.len() as u64, sha256: Sha256::digest(content).into() };
        space.hand_over(&blob);
        Ok(blob)
    }

    /// Takes a file of the same file system over, into reserved room. Blocks.
    pub(super) fn adopt(&self, file: &MadeFile, space: Space) -> io::Result<BlobRef> {
        let key = Self::new_key();
        fs::rename(&file.path, self.path(&key))?;
        let blob = BlobRef { key, bytes: file.bytes, sha256: file.sha256 };
        space.hand_over(&blob);
        Ok(blob)
    }

    /// Removes a file and gives its room back.
    pub(super) fn remove(&self, blob: &BlobRef) {
        if let Err(error) = fs::remove_file(self.path(&blob.key)) {
            tracing::warn!(key = blob.key, %error, "a spool file could not be removed");
        }
        self.bytes.fetch_sub(blob.bytes, Ordering::Relaxed);
    }
}

/// Reserved room; given back on drop.
#[derive(Debug)]
pub(super) struct Space {
    spool: Arc<Spool>,
    bytes: u64,
}

impl Space {
    /// One room of both.
    pub(super) fn absorb(&mut self, mut other: Self) {
        self.bytes += std::mem::take(&mut other.bytes);
    }

    /// The room now belongs to the file, which fills it, until [`Spool::remove`].
    pub(super) fn hand_over(mut self, blob: &BlobRef) {
        self.bytes -= blob.bytes;
    }
}

impl Drop for Space {
    fn drop(&mut self) {
        self.spool.bytes.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_directory_has_one_owner_who_starts_with_an_empty_spool() {
        let dir = tempfile::tempdir().unwrap();
        let first = Spool::open(dir.path(), 100).unwrap();
        let space = first.reserve(5).unwrap();
        let blob = first.write(b"hello", space).unwrap();
        assert!(matches!(Spool::open(dir.path(), 100), Err(OpenError::InUse)));
        assert!(first.path(&blob.key).exists());
        drop(first);
        let second = Spool::open(dir.path(), 100).unwrap();
        assert!(!second.path(&blob.key).exists());
        assert_eq!(second.bytes(), 0);
    }

    #[test]
    fn room_is_counted_from_reservation_to_removal() {
        let dir = tempfile::tempdir().unwrap();
        let spool = Spool::open(dir.path(), 10).unwrap();
        let mut space = spool.reserve(4).unwrap();
        space.absorb(spool.reserve(5).unwrap());
        assert!(spool.reserve(2).is_none());
        let blob = spool.write(b"hello", space).unwrap();
        assert_eq!(spool.bytes(), 5, "what the file does not fill is given back");
        spool.remove(&blob);
        assert_eq!(spool.bytes(), 0);
    }
}
