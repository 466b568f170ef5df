//! Whether a store and the files beside it belong together. A store that was made anew beside the files of an earlier one names
//! none of them, and all would go as files that nobody names: then the operator decides.

use std::fs;
use std::io::{self, Write as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};

use uuid::Uuid;

use super::blobs::{BlobStore, StoredBlob, make_private_dir};
use super::sqlite::{SqliteOpenError, SqliteStore, StoreFile};

/// The file of the mark, which goes with the files of uploads and results.
const MARK_FILE: &str = "spool.mark";
/// Where files go that are set aside.
const ASIDE: &str = "adopted";
/// Longest mark that is read.
const MARK_BYTES_MAX: usize = 64;

/// What to do when the store of the stored files is gone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LostStore {
    /// Not to start.
    #[default]
    Refuse,
    /// To set the files aside, in a folder beside the spool.
    Adopt,
    /// To remove them.
    Discard,
}

/// The store is not that of the files.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "it is {store}, and {files} files ({bytes} bytes) of another one are in the spool. Put their store back, or start once with \
     `--adopt`, which keeps the files in the folder `{ASIDE}`, or with `--discard`, which removes them"
)]
pub(super) struct NotTogether {
    store: &'static str,
    files: usize,
    bytes: u64,
}

/// Why the two cannot be looked at or brought together.
#[derive(Debug, thiserror::Error)]
pub(super) enum BelongingError {
    #[error(transparent)]
    NotTogether(#[from] NotTogether),
    #[error(transparent)]
    Store(#[from] SqliteOpenError),
    #[error(transparent)]
    Disk(#[from] io::Error),
}

/// Sees to it that the store at `path` is that of the files, and opens it. With the mark of both. Blocks.
pub(super) fn open_together(
    data_dir: &Path,
    path: &Path,
    blobs: &dyn BlobStore,
    decision: LostStore,
) -> Result<(SqliteStore, String), BelongingError> {
    let store = SqliteStore::look_at(path)?;
    let mark = read_mark(data_dir)?;
    let files = blobs.list()?;
    if let Some(not_together) = not_together(path, &store, mark.as_deref(), &files)? {
        match decision {
            LostStore::Refuse => return Err(not_together.into()),
            LostStore::Adopt => set_aside(data_dir, blobs, &files)?,
            LostStore::Discard => {
                tracing::warn!(files = files.len(), "the files of a lost store are removed");
                for file in &files {
                    if let Err(error) = blobs.remove(&file.key) {
                        tracing::warn!(key = file.key, %error, "a file could not be removed");
                    }
                }
            }
        }
    }
    let opened = SqliteStore::open(path)?;
    let mark = match store {
        StoreFile::Marked(mark) => mark,
        StoreFile::Empty | StoreFile::Unmarked => {
            let mark = Uuid::now_v7().simple().to_string();
            SqliteStore::set_mark(path, &mark)?;
            mark
        }
    };
    write_mark(data_dir, &mark)?;
    Ok((opened, mark))
}

/// Why the store cannot be that of the files, if it cannot.
fn not_together(
    path: &Path,
    store: &StoreFile,
    mark: Option<&str>,
    files: &[StoredBlob],
) -> Result<Option<NotTogether>, BelongingError> {
    if files.is_empty() {
        return Ok(None);
    }
    let store = match (store, mark) {
        (StoreFile::Empty, _) => "missing or empty",
        (StoreFile::Marked(own), Some(mark)) if own == mark => return Ok(None),
        (StoreFile::Marked(_), Some(_)) => "the store of other files",
        // An older program made both.
        (StoreFile::Unmarked, None) => return Ok(None),
        // A server was killed before both had their mark, or an older store was put here.
        (StoreFile::Unmarked, Some(_)) | (StoreFile::Marked(_), None) => {
            let keys: Vec<&str> = files.iter().map(|file| file.key.as_str()).collect();
            if SqliteStore::names_any(path, &keys)? {
                return Ok(None);
            }
            "a store that names none of them"
        }
    };
    let bytes = files.iter().map(|file| file.bytes).sum();
    Ok(Some(NotTogether { store, files: files.len(), bytes }))
}

/// Moves the files to a folder of their own, where nobody removes them.
fn set_aside(data_dir: &Path, blobs: &dyn BlobStore, files: &[StoredBlob]) -> io::Result<()> {
    let dir = data_dir.join(ASIDE).join(Uuid::now_v7().simple().to_string());
    for file in files {
        let to = dir.join(&file.key);
        if let Some(parent) = to.parent() {
            make_private_dir(parent)?;
        }
        fs::rename(blobs.local(&file.key)?, &to)?;
    }
    tracing::warn!(files = files.len(), to = %dir.display(), "the files of a lost store are set aside");
    Ok(())
}

fn mark_file(data_dir: &Path) -> PathBuf {
    data_dir.join(MARK_FILE)
}

fn read_mark(data_dir: &Path) -> io::Result<Option<String>> {
    match fs::read(mark_file(data_dir)) {
        Ok(mark) => {
            let mark = &mark[..mark.len().min(MARK_BYTES_MAX)];
            Ok(Some(String::from_utf8_lossy(mark).trim().to_owned()).filter(|mark| !mark.is_empty()))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Writes the mark, unless it is there: a server starts on a full disk too.
fn write_mark(data_dir: &Path, mark: &str) -> io::Result<()> {
    if read_mark(data_dir)?.as_deref() == Some(mark) {
        return Ok(());
    }
    let path = mark_file(data_dir);
    let unfinished = path.with_extension("unfinished");
    let mut file =
        fs::OpenOptions::new().write(true).create(true).truncate(true).mode(0o600).open(&unfinished)?;
    file.write_all(mark.as_bytes())?;
    file.sync_all()?;
    fs::rename(&unfinished, &path)?;
    path.parent().map_or(Ok(()), |dir| fs::File::open(dir)?.sync_all())
}
