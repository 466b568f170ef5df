//! Who owns the data directory: one server at a time.

use std::fs::{self, File, TryLockError};
use std::io;
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
use std::path::Path;
use std::time::{Duration, Instant};

/// How long a directory that is in use is waited for: what a server that was killed had just begun to start holds it for a
/// moment more.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two looks at a directory that is in use.
const LOOKS_APART: Duration = Duration::from_millis(20);

/// The ownership of a data directory, until it is dropped: two servers must not share one.
#[derive(Debug)]
pub struct DataDirLock {
    /// The file that is locked.
    _file: File,
}

/// A directory that cannot be owned.
#[derive(Debug)]
pub(super) enum LockError {
    /// Another server owns it.
    InUse,
    /// The disk fails.
    Io(io::Error),
}

impl From<io::Error> for LockError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl DataDirLock {
    /// Takes the directory over, which is made if there is none, and waits for a moment where another server holds it.
    pub(super) async fn take(data_dir: &Path) -> Result<Self, LockError> {
        let begun = Instant::now();
        loop {
            match Self::try_take(data_dir) {
                Err(LockError::InUse) if begun.elapsed() < PATIENCE => tokio::time::sleep(LOOKS_APART).await,
                taken => return taken,
            }
        }
    }

    /// Takes the directory over, unless another server holds it.
    fn try_take(data_dir: &Path) -> Result<Self, LockError> {
        // One that is there keeps its rights: what is in it is private by itself.
        fs::DirBuilder::new().recursive(true).mode(0o700).create(data_dir)?;
        let file = File::options().create(true).append(true).mode(0o600).open(data_dir.join("lock"))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _file: file }),
            Err(TryLockError::WouldBlock) => Err(LockError::InUse),
            Err(TryLockError::Error(error)) => Err(error.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_directory_has_one_owner_and_then_the_next_one() {
        let dir = tempfile::tempdir().unwrap();
        let first = DataDirLock::try_take(dir.path()).unwrap();
        assert!(matches!(DataDirLock::try_take(dir.path()), Err(LockError::InUse)));
        drop(first);
        DataDirLock::try_take(dir.path()).unwrap();
    }
}
