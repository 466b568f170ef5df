//! Copies of files on the disk of this machine. Names are given once, so a copy is never an old one.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use uuid::Uuid;

use crate::jobs::blobs::{DIRS, make_private_dir};

/// For how long a copy that somebody asked for stays, whatever the limit: it is about to be opened.
const STAYS: Duration = Duration::from_secs(5 * 60);

/// A folder of copies.
pub(super) struct Cache {
    dir: PathBuf,
    bytes_max: u64,
    known: Mutex<CacheIndex>,
}

#[derive(Debug, Default)]
struct CacheIndex {
    copies: HashMap<String, Copy>,
    bytes: u64,
    /// Files that are being removed from the bucket.
    going: HashSet<String>,
}

#[derive(Debug)]
struct Copy {
    bytes: u64,
    asked_at: Instant,
}

impl Cache {
    /// Opens the folder, without what is in it. Blocks.
    pub(super) fn open(dir: &Path, bytes_max: u64) -> io::Result<Self> {
        match fs::remove_dir_all(dir) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        make_private_dir(dir)?;
        for kind in DIRS {
            make_private_dir(&dir.join(kind))?;
        }
        Ok(Self { dir: dir.to_owned(), bytes_max, known: Mutex::default() })
    }

    /// Begins a file that is no copy yet.
    pub(super) fn begin(&self) -> io::Result<(PathBuf, File)> {
        let path = self.dir.join(format!("{}.unfinished", Uuid::now_v7().simple()));
        let file = File::options().write(true).create_new(true).mode(0o600).open(&path)?;
        Ok((path, file))
    }

    /// A complete file becomes the copy of that name; others go when there are too many.
    pub(super) fn keep(&self, file: &Path, key: &str) -> io::Result<()> {
        let bytes = file.metadata()?.len();
        let mut known = self.known();
        fs::rename(file, self.dir.join(key))?;
        known.bytes += bytes;
        let before = known.copies.insert(key.to_owned(), Copy { bytes, asked_at: Instant::now() });
        known.bytes -= before.map_or(0, |copy| copy.bytes);
        while known.bytes > self.bytes_max {
            let oldest = known.copies.iter().min_by_key(|(_, copy)| copy.asked_at);
            let Some((key, _)) = oldest.filter(|(_, copy)| copy.asked_at.elapsed() > STAYS) else { break };
            let key = key.clone();
            self.forget(&mut known, &key);
        }
        Ok(())
    }

    /// The copy of that name, if there is one.
    pub(super) fn find(&self, key: &str) -> Option<PathBuf> {
        let mut known = self.known();
        known.copies.get_mut(key)?.asked_at = Instant::now();
        let path = self.dir.join(key);
        if path.exists() {
            return Some(path);
        }
        // Somebody cleared the folder.
        self.forget(&mut known, key);
        None
    }

    /// The copy goes, and the file is as good as gone.
    pub(super) fn begin_to_remove(&self, key: &str) {
        let mut known = self.known();
        known.going.insert(key.to_owned());
        self.forget(&mut known, key);
    }

    /// The file is gone, or stays.
    pub(super) fn end_to_remove(&self, key: &str) {
        self.known().going.remove(key);
    }

    /// Whether the file is being removed.
    pub(super) fn is_going(&self, key: &str) -> bool {
        self.known().going.contains(key)
    }

    /// Files that are being removed.
    pub(super) fn going(&self) -> HashSet<String> {
        self.known().going.clone()
    }

    /// Bytes that can still be written here, if that is known.
    pub(super) fn free_bytes(&self) -> Option<u64> {
        let disk = rustix::fs::statvfs(&self.dir).ok()?;
        Some(disk.f_bavail.saturating_mul(disk.f_frsize))
    }

    fn forget(&self, known: &mut CacheIndex, key: &str) {
        if let Some(copy) = known.copies.remove(key) {
            known.bytes -= copy.bytes;
            // One that is gone already fills no room.
            let _ = fs::remove_file(self.dir.join(key));
        }
    }

    fn known(&self) -> MutexGuard<'_, CacheIndex> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
