//! Where the files of jobs live: uploads under `in/`, what runs write under `out/<job>/<epoch>/`.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file as a listing shows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredBlob {
    /// Its name.
    pub key: String,
    /// Number of bytes.
    pub bytes: u64,
}

/// A file that is being written. Dropped before it is committed, it leaves nothing behind.
pub trait BlobWriter: Write + Send {
    /// Ends the file: it is complete and outlasts a loss of power.
    ///
    /// # Errors
    /// The disk fails.
    fn commit(self: Box<Self>) -> io::Result<()>;
}

/// Files by name, each written once. Methods block; a name is a relative path of letters, digits, dots and hyphens.
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

    /// Removes a file.
    ///
    /// # Errors
    /// There is no such file, or the disk fails.
    fn remove(&self, key: &str) -> io::Result<()>;

    /// Every file, also those that were begun and never committed.
    ///
    /// # Errors
    /// The disk fails.
    fn list(&self) -> io::Result<Vec<StoredBlob>>;

    /// Bytes that can still be written, if that is known.
    fn free_bytes(&self) -> Option<u64>;
}

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
        for dir in [root.to_owned(), root.join("in"), root.join("out")] {
            fs::create_dir_all(&dir)?;
        }
        sync_dir(root)?;
        Ok(Self { root: root.to_owned() })
    }

    /// The directories between the file and the root, the innermost first.
    fn dirs_of<'p>(&self, path: &'p Path) -> impl Iterator<Item = &'p Path> {
        path.ancestors().skip(1).take_while(|dir| *dir != self.root)
    }

    /// Makes the directories of a file. Those that were not there, the innermost first.
    fn make_dirs_for(&self, path: &Path) -> io::Result<Vec<PathBuf>> {
        let Some(dir) = path.parent().filter(|dir| !dir.is_dir()) else { return Ok(Vec::new()) };
        let new_dirs = self.dirs_of(path).filter(|dir| !dir.is_dir()).map(Path::to_owned).collect();
        fs::create_dir_all(dir)?;
        Ok(new_dirs)
    }

    fn list_into(
        dir: &Path,
        key: &str,
        blobs: &mut Vec<StoredBlob>,
        dirs: &mut Vec<(PathBuf, String)>,
    ) -> io::Result<()> {
        for entry in fs::read_dir(dir)? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let key = if key.is_empty() { name } else { format!("{key}/{name}") };
            match entry.metadata() {
                Ok(metadata) if metadata.is_dir() => dirs.push((entry.path(), key)),
                Ok(metadata) => blobs.push(StoredBlob { key, bytes: metadata.len() }),
                // Removed since the directory was read.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl BlobStore for LocalBlobs {
    fn create(&self, key: &str) -> io::Result<Box<dyn BlobWriter>> {
        let path = self.root.join(key);
        let new_dirs = self.make_dirs_for(&path)?;
        let file = File::create_new(&path)?;
        Ok(Box::new(LocalWriter { file: Some(file), path, new_dirs }))
    }

    /// The file must be on the same disk: it is moved, not copied.
    fn adopt(&self, file: &Path, key: &str) -> io::Result<()> {
        let path = self.root.join(key);
        let new_dirs = self.make_dirs_for(&path)?;
        File::open(file)?.sync_all()?;
        // A name is given once, so nothing comes in between; a rename by itself would take another file's place.
        if path.try_exists()? {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        fs::rename(file, &path)?;
        sync_dirs_of(&path, &new_dirs)
    }

    fn local(&self, key: &str) -> io::Result<PathBuf> {
        Ok(self.root.join(key))
    }

    fn remove(&self, key: &str) -> io::Result<()> {
        let path = self.root.join(key);
        fs::remove_file(&path)?;
        // Directories of a run go with its last file; `in` and `out` stay.
        let depth = key.split('/').count();
        for dir in path.ancestors().skip(1).take(depth.saturating_sub(2)) {
            if fs::remove_dir(dir).is_err() {
                break;
            }
        }
        Ok(())
    }

    fn list(&self) -> io::Result<Vec<StoredBlob>> {
        let mut blobs = Vec::new();
        let mut dirs = vec![(self.root.clone(), String::new())];
        while let Some((dir, key)) = dirs.pop() {
            match Self::list_into(&dir, &key, &mut blobs, &mut dirs) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                listed => listed?,
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
    /// Directories that were made for it, the innermost first.
    new_dirs: Vec<PathBuf>,
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
        sync_dirs_of(&self.path, &self.new_dirs)?;
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

/// Makes the entry of a file outlast a loss of power. It is in its directory, that of a new directory in the one above.
fn sync_dirs_of(path: &Path, new_dirs: &[PathBuf]) -> io::Result<()> {
    let dirs = path.parent().into_iter().chain(new_dirs.iter().filter_map(|dir| dir.parent()));
    dirs.into_iter().try_for_each(sync_dir)
}

/// Makes the entries of a directory outlast a loss of power.
fn sync_dir(dir: &Path) -> io::Result<()> {
    File::open(dir)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(blobs: &LocalBlobs) -> Vec<String> {
        let mut keys: Vec<_> = blobs.list().unwrap().into_iter().map(|blob| blob.key).collect();
        keys.sort();
        keys
    }

    #[test]
    fn a_file_is_there_once_it_is_committed_and_leaves_no_directory_when_it_goes() {
        let dir = tempfile::tempdir().unwrap();
        let blobs = LocalBlobs::open(dir.path()).unwrap();
        let key = "out/job/1/mesh";
        let mut writer = blobs.create(key).unwrap();
        writer.write_all(b"hello").unwrap();
        writer.commit().unwrap();
        assert_eq!(fs::read(blobs.local(key).unwrap()).unwrap(), b"hello");
        assert_eq!(blobs.list().unwrap(), [StoredBlob { key: key.to_owned(), bytes: 5 }]);
        assert!(blobs.create(key).is_err(), "a file is written once");
        blobs.remove(key).unwrap();
        assert_eq!(fs::read_dir(dir.path().join("out")).unwrap().count(), 0);
        assert_eq!(blobs.remove(key).unwrap_err().kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn a_file_that_is_taken_over_moves_and_takes_no_other_s_place() {
        let dir = tempfile::tempdir().unwrap();
        let blobs = LocalBlobs::open(&dir.path().join("spool")).unwrap();
        let (file, key) = (dir.path().join("made"), "out/job/1/mesh");
        fs::write(&file, b"hello").unwrap();
        blobs.adopt(&file, key).unwrap();
        assert!(!file.exists());
        assert_eq!(fs::read(blobs.local(key).unwrap()).unwrap(), b"hello");
        fs::write(&file, b"other").unwrap();
        assert!(blobs.adopt(&file, key).is_err(), "a file is written once");
        assert_eq!(fs::read(blobs.local(key).unwrap()).unwrap(), b"hello");
    }

    #[test]
    fn a_file_that_is_given_up_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let blobs = LocalBlobs::open(dir.path()).unwrap();
        let mut writer = blobs.create("in/upload").unwrap();
        writer.write_all(b"hello").unwrap();
        assert_eq!(keys(&blobs), ["in/upload"], "a listing shows what is not committed");
        drop(writer);
        assert!(keys(&blobs).is_empty());
    }

    #[test]
    fn the_disk_says_how_much_room_it_has() {
        let dir = tempfile::tempdir().unwrap();
        assert!(LocalBlobs::open(dir.path()).unwrap().free_bytes() > Some(0));
    }
}
