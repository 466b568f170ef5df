//! The files of one server: how much room they fill, and which of them no row names.

use std::collections::HashSet;
use std::fmt;
use std::fs::File;
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use sha2::{Digest, Sha256};
use uuid::Uuid;

use super::blobs::{BlobStore, BlobWriter, PresignedUrls, StoredBlob};
use super::child::MadeFile;
use super::soundness::{KnownSound, Unsound};
use super::store::{BlobRef, ClaimRef};

/// The files of one server.
pub(super) struct Spool {
    blobs: Arc<dyn BlobStore>,
    bytes: AtomicU64,
    /// Those of them that are about to come.
    reserved: AtomicU64,
    bytes_max: u64,
    free_bytes_min: u64,
    /// Other servers write and remove files too.
    is_shared: bool,
    /// Files that this process writes or has written and that no row names yet.
    unnamed: Mutex<HashSet<String>>,
    known: KnownSound,
}

impl fmt::Debug for Spool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Spool").field("bytes", &self.bytes).finish_non_exhaustive()
    }
}

/// How full the directory may be.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpaceLimits {
    /// Most bytes of files.
    pub(super) bytes_max: u64,
    /// Bytes of the disk that stay free.
    pub(super) free_bytes_min: u64,
    /// Other servers use it too.
    pub(super) is_shared: bool,
}

impl Spool {
    /// The files of a store, and those that are in it already. Blocks.
    pub(super) fn of(blobs: Arc<dyn BlobStore>, limits: SpaceLimits) -> io::Result<Arc<Self>> {
        let bytes = blobs.list()?.iter().map(|blob| blob.bytes).sum::<u64>();
        Ok(Arc::new(Self {
            blobs,
            bytes: AtomicU64::new(bytes),
            reserved: AtomicU64::new(0),
            bytes_max: limits.bytes_max,
            free_bytes_min: limits.free_bytes_min,
            is_shared: limits.is_shared,
            unnamed: Mutex::default(),
            known: KnownSound::default(),
        }))
    }

    /// The path of a file. Blocks where it has to be brought here.
    pub(super) fn path(&self, key: &str) -> io::Result<PathBuf> {
        self.blobs.local(key)
    }

    /// Opens a file of which every byte is what it was when it was written. Blocks.
    pub(super) fn open_sound(&self, blob: &BlobRef) -> Result<File, Unsound> {
        self.known.open(&self.path(&blob.key)?, blob)
    }

    /// A file that was written by this process a moment ago: its bytes need not be looked at again.
    fn note_sound(&self, key: &str) {
        if let Ok(path) = self.path(key) {
            self.known.note(&path, key);
        }
    }

    /// Bytes on disk, and those that are about to come.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    pub(super) fn bytes_max(&self) -> u64 {
        self.bytes_max
    }

    /// True when `bytes` more would leave too little of the disk.
    pub(super) fn is_disk_short_of(&self, bytes: u64) -> bool {
        self.blobs.free_bytes().is_some_and(|free| free < self.free_bytes_min.saturating_add(bytes))
    }

    /// Room for `bytes`, if there is.
    pub(super) fn reserve(self: &Arc<Self>, bytes: u64) -> Option<ReservedSpace> {
        let grown = |used: u64| used.checked_add(bytes).filter(|&total| total <= self.bytes_max);
        self.bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, grown).ok()?;
        self.reserved.fetch_add(bytes, Ordering::Relaxed);
        Some(ReservedSpace { spool: Arc::clone(self), bytes })
    }

    /// Begins an upload, in this folder. Blocks.
    pub(super) fn begin(
        self: &Arc<Self>,
        folder: &'static str,
    ) -> io::Result<(Unnamed, Box<dyn BlobWriter>)> {
        let unnamed = self.new_name(folder);
        let writer = self.create(&unnamed)?;
        Ok((unnamed, writer))
    }

    /// Begins the file of this name. Blocks.
    pub(super) fn create(&self, unnamed: &Unnamed) -> io::Result<Box<dyn BlobWriter>> {
        self.blobs.create(&unnamed.key)
    }

    /// Writes a file of a run into reserved room. Blocks.
    pub(super) fn write(
        self: &Arc<Self>,
        claim: ClaimRef,
        name: &str,
        content: &[u8],
        space: ReservedSpace,
    ) -> io::Result<Written> {
        let unnamed = self.unnamed(key_of(claim, name));
        let mut writer = self.blobs.create(&unnamed.key)?;
        writer.write_all(content)?;
        writer.commit()?;
        self.note_sound(&unnamed.key);
        let blob = BlobRef {
            key: unnamed.key.clone(),
            bytes: content.len() as u64,
            sha256: Sha256::digest(content).into(),
            files: Vec::new(),
        };
        space.hand_over(&blob);
        Ok(Written { blob: Some(blob), unnamed })
    }

    /// Takes over a file that another process made for a run, into reserved room. Blocks.
    pub(super) fn adopt(
        self: &Arc<Self>,
        claim: ClaimRef,
        file: &MadeFile,
        space: ReservedSpace,
    ) -> io::Result<Written> {
        let name = file.path.file_name().unwrap_or_default().to_string_lossy();
        let unnamed = self.unnamed(key_of(claim, &name));
        self.blobs.adopt(&file.path, &unnamed.key)?;
        self.note_sound(&unnamed.key);
        let blob =
            BlobRef { key: unnamed.key.clone(), bytes: file.bytes, sha256: file.sha256, files: Vec::new() };
        space.hand_over(&blob);
        Ok(Written { blob: Some(blob), unnamed })
    }

    /// Removes a file and gives its room back.
    pub(super) fn remove(&self, blob: &BlobRef) {
        self.remove_file(&blob.key, blob.bytes);
    }

    /// Removes files that no row names.
    pub(super) fn remove_all(&self, orphans: &[BlobRef]) {
        for blob in orphans {
            self.remove(blob);
        }
    }

    fn remove_file(&self, key: &str, bytes: u64) {
        match self.blobs.remove(key) {
            Ok(()) => self.give_back(bytes),
            // Somebody else took it: it fills no room any more.
            Err(error) if error.kind() == io::ErrorKind::NotFound => self.give_back(bytes),
            Err(error) => tracing::warn!(key, %error, "a file could not be removed"),
        }
    }

    fn give_back(&self, bytes: u64) {
        let shrunk = |used: u64| Some(used.saturating_sub(bytes));
        // The update never refuses.
        let _ = self.bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, shrunk);
    }

    /// A name that no file has.
    pub(super) fn new_name(self: &Arc<Self>, folder: &'static str) -> Unnamed {
        self.unnamed(format!("{folder}/{}", Uuid::now_v7().simple()))
    }

    /// The way by which clients reach files without this service in between, where there is one.
    pub(super) fn presigned(&self) -> Option<&dyn PresignedUrls> {
        self.blobs.presigned()
    }

    fn unnamed(self: &Arc<Self>, key: String) -> Unnamed {
        self.held().insert(key.clone());
        Unnamed { spool: Arc::clone(self), key }
    }

    fn held(&self) -> std::sync::MutexGuard<'_, HashSet<String>> {
        self.unnamed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Files that nobody may be about to name. What other servers wrote and removed counts from then on. Blocks.
    pub(super) fn list(&self) -> io::Result<Vec<StoredBlob>> {
        // A file is held before it is made, so what is listed was made by now, and who holds it is asked afterwards.
        let listed = self.blobs.list()?;
        if self.is_shared {
            let stored = listed.iter().map(|blob| blob.bytes).sum::<u64>();
            self.bytes.store(stored.saturating_add(self.reserved.load(Ordering::Relaxed)), Ordering::Relaxed);
        }
        let held = self.held();
        Ok(listed.into_iter().filter(|blob| !blob.is_recent && !held.contains(&blob.key)).collect())
    }

    /// Removes files that nobody names. Blocks.
    pub(super) fn remove_orphans(&self, orphans: &[StoredBlob]) {
        for blob in orphans {
            tracing::info!(key = blob.key, bytes = blob.bytes, "a file that nobody names goes");
            self.remove_file(&blob.key, blob.bytes);
        }
    }
}

/// Name of a file that the run of a claim writes: no other run writes one of that name.
fn key_of(claim: ClaimRef, name: &str) -> String {
    format!("out/{}.{}.{name}", claim.id, claim.epoch)
}

/// The claim whose run wrote the file, if a run did.
pub(super) fn claim_of(key: &str) -> Option<ClaimRef> {
    let mut parts = key.strip_prefix("out/")?.split('.');
    let (id, epoch) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
    Some(ClaimRef { id, epoch })
}

/// Keeps a file from being taken for an orphan, until it is dropped.
#[derive(Debug)]
pub(super) struct Unnamed {
    spool: Arc<Spool>,
    pub(super) key: String,
}

impl Drop for Unnamed {
    fn drop(&mut self) {
        self.spool.held().remove(&self.key);
    }
}

/// A complete file that no row names yet. Dropped before it is [named](Self::named), it is removed.
#[derive(Debug)]
pub(super) struct Written {
    blob: Option<BlobRef>,
    unnamed: Unnamed,
}

impl Written {
    /// The upload that is complete, in room that was reserved for it.
    pub(super) fn upload(unnamed: Unnamed, blob: BlobRef, space: ReservedSpace) -> Self {
        space.hand_over(&blob);
        unnamed.spool.note_sound(&unnamed.key);
        Self { blob: Some(blob), unnamed }
    }

    /// A file that comes to be in the store without this process, whose bytes nobody has looked at.
    pub(super) fn unseen(unnamed: Unnamed, blob: BlobRef, space: ReservedSpace) -> Self {
        space.hand_over(&blob);
        Self { blob: Some(blob), unnamed }
    }

    /// The file.
    pub(super) fn blob(&self) -> Option<&BlobRef> {
        self.blob.as_ref()
    }

    /// A row names the file now, or may do so.
    pub(super) fn named(mut self) {
        self.blob = None;
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        if let Some(blob) = &self.blob {
            self.unnamed.spool.remove(blob);
        }
    }
}

/// Reserved room; given back on drop.
#[derive(Debug)]
pub(super) struct ReservedSpace {
    spool: Arc<Spool>,
    bytes: u64,
}

impl ReservedSpace {
    /// One room of both.
    pub(super) fn absorb(&mut self, mut other: Self) {
        self.bytes += std::mem::take(&mut other.bytes);
    }

    /// The room now belongs to the file, which fills it, until [`Spool::remove`].
    pub(super) fn hand_over(mut self, blob: &BlobRef) {
        self.bytes -= blob.bytes;
        self.spool.reserved.fetch_sub(blob.bytes, Ordering::Relaxed);
    }
}

impl Drop for ReservedSpace {
    fn drop(&mut self) {
        self.spool.reserved.fetch_sub(self.bytes, Ordering::Relaxed);
        self.spool.give_back(self.bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::blobs::LocalBlobs;
    use crate::jobs::store::JobId;

    const LIMITS: SpaceLimits = SpaceLimits { bytes_max: 10, free_bytes_min: 0, is_shared: false };

    fn hello(spool: &Arc<Spool>) -> Written {
        let claim = ClaimRef { id: JobId::unique(), epoch: 1 };
        let space = spool.reserve(5).unwrap();
        spool.write(claim, "mesh", b"hello", space).unwrap()
    }

    fn spool_in(dir: &tempfile::TempDir) -> Arc<Spool> {
        Spool::of(Arc::new(LocalBlobs::open(dir.path()).unwrap()), LIMITS).unwrap()
    }

    #[test]
    fn what_is_in_a_store_counts_for_the_next_server() {
        let dir = tempfile::tempdir().unwrap();
        let first = spool_in(&dir);
        let written = hello(&first);
        let key = written.blob().unwrap().key.clone();
        written.named();
        drop(first);
        let second = spool_in(&dir);
        assert!(second.path(&key).unwrap().exists());
        assert_eq!(second.bytes(), 5);
    }

    #[test]
    fn room_is_counted_from_reservation_to_removal() {
        let dir = tempfile::tempdir().unwrap();
        let spool = spool_in(&dir);
        let mut space = spool.reserve(4).unwrap();
        space.absorb(spool.reserve(5).unwrap());
        assert!(spool.reserve(2).is_none());
        drop(space);
        let written = hello(&spool);
        assert_eq!(spool.bytes(), 5);
        drop(written);
        assert_eq!(spool.bytes(), 0, "a file that nobody came to name is gone");
        assert!(spool.list().unwrap().is_empty());
    }

    #[test]
    fn what_the_process_still_holds_is_no_orphan() {
        let dir = tempfile::tempdir().unwrap();
        let spool = spool_in(&dir);
        let (upload, writer) = spool.begin("in").unwrap();
        let written = hello(&spool);
        assert!(spool.list().unwrap().is_empty());
        let key = written.blob().unwrap().key.clone();
        assert!(claim_of(&key).is_some_and(|claim| claim.epoch == 1) && claim_of(&upload.key).is_none());
        written.named();
        drop((upload, writer));
        assert_eq!(spool.list().unwrap(), [StoredBlob { key, bytes: 5, is_recent: false }]);
    }

    #[test]
    fn a_disk_is_short_of_what_would_leave_too_little_free() {
        let dir = tempfile::tempdir().unwrap();
        let spool = spool_in(&dir);
        assert!(!spool.is_disk_short_of(1) && spool.is_disk_short_of(u64::MAX));
    }
}
