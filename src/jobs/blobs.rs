//! Where the files of jobs live: meshes under `in/`, what runs write under `out/<job>.<epoch>.<name>`, and under `pieces/` what
//! comes of a mesh before its job.

use std::fs::{self, DirBuilder, File, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::store::BlobRef;

/// A file as a listing shows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredBlob {
    /// Its name.
    pub key: String,
    /// Number of bytes.
    pub bytes: u64,
    /// It was written a short time ago, in a store where another process may be about to name it in a row.
    pub is_recent: bool,
}

/// A file that is being written. Dropped before it is committed, it leaves nothing behind.
pub trait BlobWriter: Write + Send {
    /// Ends the file: it is complete and outlasts a loss of power.
    ///
    /// # Errors
    /// The disk fails.
    fn commit(self: Box<Self>) -> io::Result<()>;
}

/// Files by name, each written once. Methods block; a name is one of the folders and then letters, digits, dots and hyphens.
pub trait BlobStore: Send + Sync {
    /// Begins a file.
    ///
    /// # Errors
    /// The disk fails, or there is such a file.
    fn create(&self, key: &str) -> io::Result<Box<dyn BlobWriter>>;

    /// Takes over a complete file of this machine that nobody writes any more; it is there no longer afterwards. It
    /// outlasts a loss of power.
    ///
    /// # Errors
    /// The disk fails, or there is such a file.
    fn adopt(&self, file: &Path, key: &str) -> io::Result<()>;

    /// A path under which the whole file can be read.
    ///
    /// # Errors
    /// There is no such file, or it cannot be had.
    fn local(&self, key: &str) -> io::Result<PathBuf>;

    /// Removes a file; one that is as good as gone may fill its room a moment longer.
    ///
    /// # Errors
    /// There is no such file, where that is known, or the disk fails.
    fn remove(&self, key: &str) -> io::Result<()>;

    /// Every file, also those that were begun and never committed, where that leaves any.
    ///
    /// # Errors
    /// The disk fails.
    fn list(&self) -> io::Result<Vec<StoredBlob>>;

    /// Bytes that can still be written, if that is known.
    fn free_bytes(&self) -> Option<u64>;

    /// The way by which clients reach files without this service in between, where there is one.
    fn presigned(&self) -> Option<&dyn PresignedUrls> {
        None
    }
}

/// A request by which a client may write one file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PresignedPut {
    /// Where.
    pub url: String,
    /// Headers that it must have, as they stand here.
    pub headers: Vec<(String, String)>,
}

/// URLs that let whoever has them read or write one file for a while. Methods block.
pub trait PresignedUrls: Send + Sync {
    /// By which a file of this name can be written, with these bytes and no others.
    ///
    /// # Errors
    /// The key to the bucket cannot be had.
    fn put(&self, blob: &BlobRef, lasts: Duration) -> io::Result<PresignedPut>;

    /// By which a file can be read, with this `Content-Disposition`.
    ///
    /// # Errors
    /// The key to the bucket cannot be had.
    fn get(&self, key: &str, disposition: &str, lasts: Duration) -> io::Result<String>;

    /// Copies a file within the store, under a name that no file has.
    ///
    /// # Errors
    /// There is no such file, or the bucket does not answer.
    fn copy(&self, from: &str, to: &str) -> io::Result<()>;

    /// The number of bytes of a file; `None`: there is none.
    ///
    /// # Errors
    /// The bucket does not answer.
    fn size(&self, key: &str) -> io::Result<Option<u64>>;
}

/// The directories that hold all files.
pub(super) const DIRS: [&str; 3] = [MESHES, "out", PIECES];
/// The one of the meshes of jobs.
pub(super) const MESHES: &str = "in";
/// The one of pieces of meshes, and of meshes that clients write to the bucket by themselves.
pub(super) const PIECES: &str = "pieces";

/// Files in a directory.
#[derive(Debug)]
pub struct LocalBlobs {
    root: PathBuf,
}

impl LocalBlobs {
    /// Opens the directory, or makes it.
    ///
    /// # Errors
    /// The disk fails.
    pub fn open(root: &Path) -> io::Result<Self> {
        make_private_dir(root)?;
        for dir in DIRS {
            make_private_dir(&root.join(dir))?;
        }
        sync_dir(root)?;
        Ok(Self { root: root.to_owned() })
    }
}

impl BlobStore for LocalBlobs {
    fn create(&self, key: &str) -> io::Result<Box<dyn BlobWriter>> {
        let path = self.root.join(key);
        let file = File::options().write(true).create_new(true).mode(0o600).open(&path)?;
        Ok(Box::new(LocalWriter { file: Some(file), path }))
    }

    /// The file must be on the same disk: it is moved, not copied.
    fn adopt(&self, file: &Path, key: &str) -> io::Result<()> {
        let path = self.root.join(key);
        File::open(file)?.sync_all()?;
        // A name is given once, so nothing comes in between; a rename by itself would take another file's place.
        if path.try_exists()? {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        fs::rename(file, &path)?;
        sync_dir_of(&path)
    }

    fn local(&self, key: &str) -> io::Result<PathBuf> {
        Ok(self.root.join(key))
    }

    fn remove(&self, key: &str) -> io::Result<()> {
        fs::remove_file(self.root.join(key))
    }

    fn list(&self) -> io::Result<Vec<StoredBlob>> {
        let mut blobs = Vec::new();
        for dir in DIRS {
            for entry in fs::read_dir(self.root.join(dir))? {
                let entry = entry?;
                let key = format!("{dir}/{}", entry.file_name().to_string_lossy());
                match entry.metadata() {
                    Ok(metadata) => blobs.push(StoredBlob { key, bytes: metadata.len(), is_recent: false }),
                    // Removed since the directory was read.
                    Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(blobs)
    }

    fn free_bytes(&self) -> Option<u64> {
        let disk = rustix::fs::statvfs(&self.root).ok()?;
        Some(disk.f_bavail.saturating_mul(disk.f_frsize))
    }
}

/// A file on its way to the disk.
struct LocalWriter {
    /// `None` once it is committed.
    file: Option<File>,
    path: PathBuf,
}

impl Write for LocalWriter {
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

impl BlobWriter for LocalWriter {
    fn commit(mut self: Box<Self>) -> io::Result<()> {
        let Some(file) = &self.file else { return Err(io::ErrorKind::BrokenPipe.into()) };
        file.sync_all()?;
        sync_dir_of(&self.path)?;
        self.file = None;
        Ok(())
    }
}

impl Drop for LocalWriter {
    fn drop(&mut self) {
        if self.file.is_some() {
            // What stays is found by the collection of orphans.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Makes a directory for this user alone, or makes the one that is there so.
pub(super) fn make_private_dir(path: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(path)?;
    // That of another user, who lets this one write, stays as it is.
    let _ = fs::set_permissions(path, Permissions::from_mode(0o700));
    Ok(())
}

/// Makes the entry of a file outlast a loss of power.
fn sync_dir_of(path: &Path) -> io::Result<()> {
    path.parent().map_or(Ok(()), sync_dir)
}

/// Makes the entries of a directory outlast a loss of power.
fn sync_dir(dir: &Path) -> io::Result<()> {
    File::open(dir)?.sync_all()
}
