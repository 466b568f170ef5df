//! The folder in which a child leaves what it makes: one for each run, gone when nobody needs it.

use std::fs::{self, DirBuilder};
use std::io;
use std::os::unix::fs::DirBuilderExt as _;
use std::path::{Path, PathBuf};

use uuid::Uuid;

/// The place of all folders, on the file system of the spool, so that files move without being copied.
#[derive(Debug)]
pub(in crate::jobs) struct Workspaces {
    dir: PathBuf,
}

impl Workspaces {
    /// Takes the place over from an earlier server, whose children died with it.
    pub(in crate::jobs) fn open(data_dir: &Path) -> io::Result<Self> {
        let dir = std::path::absolute(data_dir.join("work"))?;
        if let Err(error) = fs::remove_dir_all(&dir)
            && error.kind() != io::ErrorKind::NotFound
        {
            // A child of a server that was killed a moment ago may write its last; what stays goes at the next start.
            tracing::warn!(%error, "folders of an earlier server could not be removed");
        }
        fs::create_dir_all(&dir)?;
        Ok(Self { dir })
    }

    /// A new folder, for this server's user alone.
    pub(in crate::jobs) fn make(&self) -> io::Result<Workspace> {
        let path = self.dir.join(Uuid::now_v7().simple().to_string());
        DirBuilder::new().mode(0o700).create(&path)?;
        Ok(Workspace { path })
    }
}

/// A folder; removed with what is in it on drop.
#[derive(Debug)]
pub(in crate::jobs) struct Workspace {
    path: PathBuf,
}

impl Workspace {
    pub(in crate::jobs) fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Workspace {
    fn drop(&mut self) {
        if let Err(error) = fs::remove_dir_all(&self.path) {
            tracing::warn!(%error, "the folder of a job's process could not be removed");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_goes_with_its_files_and_what_an_earlier_server_left_goes_at_the_start() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir_all(dir.path().join("work/old")).unwrap();
        let workspaces = Workspaces::open(dir.path()).unwrap();
        assert!(!dir.path().join("work/old").exists());
        let workspace = workspaces.make().unwrap();
        let path = workspace.path().to_owned();
        fs::write(path.join("made-0"), b"mesh").unwrap();
        drop(workspace);
        assert!(!path.exists());
    }
}
