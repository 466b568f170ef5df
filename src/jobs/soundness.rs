//! Whether stored files are what they were: the bytes of each are compared with its digest before it is given to anybody.

use std::collections::HashMap;
use std::fs::{File, Metadata};
use std::io::{self, Read as _, Seek as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use sha2::{Digest as _, Sha256};

use super::store::BlobRef;

/// For how long a file that was sound is taken for that while the file system tells of no change, so that one who takes a
/// file in many parts does not have all of it read for each.
const LASTS: Duration = Duration::from_secs(60);
/// Most files that are known to be sound.
const KNOWN_MAX: usize = 4096;
/// Bytes read at a time.
const PIECE_BYTES: usize = 256 << 10;

/// A file that cannot be given to anybody.
#[derive(Debug, thiserror::Error)]
pub(super) enum Unsound {
    /// It is not there.
    #[error("a stored file is lost")]
    Lost,
    /// It has other bytes than it had.
    #[error("a stored file is damaged")]
    Damaged,
    /// The disk does not say.
    #[error(transparent)]
    Disk(io::Error),
}

impl From<io::Error> for Unsound {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::NotFound { Self::Lost } else { Self::Disk(error) }
    }
}

/// Files that were found sound, by their keys.
#[derive(Debug, Default)]
pub(super) struct KnownSound(Mutex<HashMap<String, (Instant, FileVersion)>>);

/// By what the file system tells one version of a file from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct FileVersion {
    inode: u64,
    bytes: u64,
    modified: (i64, i64),
}

impl FileVersion {
    fn of(facts: &Metadata) -> Self {
        Self { inode: facts.ino(), bytes: facts.len(), modified: (facts.mtime(), facts.mtime_nsec()) }
    }
}

/// Opens the file, from its beginning, if it has the bytes that it had. Blocks.
pub(super) fn open_sound(path: &Path, blob: &BlobRef) -> Result<File, Unsound> {
    sound(File::open(path)?, blob)
}

fn sound(mut file: File, blob: &BlobRef) -> Result<File, Unsound> {
    if digest(&mut file)? != blob.sha256 {
        return Err(Unsound::Damaged);
    }
    file.rewind()?;
    Ok(file)
}

impl KnownSound {
    /// Opens the file, from its beginning.
    pub(super) fn open(&self, path: &Path, blob: &BlobRef) -> Result<File, Unsound> {
        let mut file = File::open(path)?;
        let version = FileVersion::of(&file.metadata()?);
        if version.bytes != blob.bytes {
            return Err(Unsound::Damaged);
        }
        let known = self.lock().get(&blob.key).copied();
        if known.is_some_and(|(at, sound)| sound == version && at.elapsed() < LASTS) {
            return Ok(file);
        }
        file = sound(file, blob)?;
        self.keep(&blob.key, version);
        Ok(file)
    }

    /// Takes a file for sound that was written, and its digest made, a moment ago.
    pub(super) fn note(&self, path: &Path, key: &str) {
        // Where the facts cannot be had, the bytes are looked at later.
        if let Ok(facts) = path.metadata() {
            self.keep(key, FileVersion::of(&facts));
        }
    }

    fn keep(&self, key: &str, version: FileVersion) {
        let mut known = self.lock();
        if known.len() >= KNOWN_MAX {
            known.retain(|_, (at, _)| at.elapsed() < LASTS);
        }
        if known.len() < KNOWN_MAX {
            known.insert(key.to_owned(), (Instant::now(), version));
        }
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<String, (Instant, FileVersion)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn digest(file: &mut File) -> io::Result<[u8; 32]> {
    let mut digest = Sha256::new();
    let mut piece = vec![0; PIECE_BYTES];
    loop {
        match file.read(&mut piece) {
            Ok(0) => return Ok(digest.finalize().into()),
            Ok(read) => digest.update(&piece[..read]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_sound_until_a_byte_of_it_changes_or_is_gone() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh");
        let blob = BlobRef {
            key: "out/mesh".to_owned(),
            bytes: 5,
            sha256: Sha256::digest(b"hello").into(),
            files: Vec::new(),
        };
        let known = KnownSound::default();
        std::fs::write(&path, b"hello").unwrap();
        for _ in 0..2 {
            let mut text = String::new();
            known.open(&path, &blob).unwrap().read_to_string(&mut text).unwrap();
            assert_eq!(text, "hello", "from its beginning, also when it was looked at");
        }
        for other in [&b"hellO"[..], b"hell", b"", b"hello!"] {
            std::fs::write(&path, other).unwrap();
            let moved = File::options().append(true).open(&path).unwrap();
            moved.set_modified(std::time::SystemTime::now() + Duration::from_secs(1)).unwrap();
            assert!(matches!(known.open(&path, &blob), Err(Unsound::Damaged)), "{other:?}");
        }
        std::fs::remove_file(&path).unwrap();
        assert!(matches!(known.open(&path, &blob), Err(Unsound::Lost)));
    }

    #[test]
    fn what_is_known_is_bounded() {
        let dir = tempfile::tempdir().unwrap();
        let known = KnownSound::default();
        for number in 0..KNOWN_MAX + 10 {
            known.note(dir.path(), &number.to_string());
        }
        assert_eq!(known.lock().len(), KNOWN_MAX);
    }
}
