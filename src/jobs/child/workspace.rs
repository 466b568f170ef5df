//! The folder of a child: what it is given to read, and what it leaves. One for each run, gone when nobody needs it.

use std::fs::{self, DirBuilder};
use std::io;
use std::os::unix::fs::DirBuilderExt as _;
use std::path::{Path, PathBuf};

use uuid::Uuid;

/// The place of all folders, on the file system of the spool, so that files come and go without being copied.
#[derive(Debug)]
pub(super) struct Workspaces {
    dir: PathBuf,
}

/// Where things are in a folder.
#[derive(Debug)]
pub(super) struct Rooms(PathBuf);

impl Rooms {
    /// Those of a folder that is there.
    pub(super) fn of(folder: PathBuf) -> Self {
        Self(folder)
    }

    pub(super) fn folder(&self) -> &Path {
        &self.0
    }

    /// Where the child reads.
    pub(super) fn given(&self) -> PathBuf {
        self.0.join("given")
    }

    /// The mesh.
    pub(super) fn mesh(&self) -> PathBuf {
        self.given().join("mesh")
    }

    /// The MTL file of an OBJ.
    pub(super) fn material(&self) -> PathBuf {
        self.given().join("material")
    }

    /// Where the child writes.
    pub(super) fn all_made(&self) -> PathBuf {
        self.0.join("made")
    }

    /// The file with this number.
    pub(super) fn made(&self, number: usize) -> PathBuf {
        self.all_made().join(format!("file-{number}"))
    }
}

impl Workspaces {
    /// Takes the place over from an earlier server, whose children died with it.
    pub(super) fn open(data_dir: &Path) -> io::Result<Self> {
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
    pub(super) fn make(&self) -> io::Result<Workspace> {
        let rooms = Rooms(self.dir.join(Uuid::now_v7().simple().to_string()));
        let make = |dir: &Path| DirBuilder::new().mode(0o700).create(dir);
        make(rooms.folder())?;
        let workspace = Workspace { rooms };
        make(&workspace.rooms.given())?;
        make(&workspace.rooms.all_made())?;
        Ok(workspace)
    }
}

/// A folder; removed with what is in it on drop.
#[derive(Debug)]
pub(in crate::jobs) struct Workspace {
    pub(super) rooms: Rooms,
}

impl Workspace {
    /// Gives the child files to read: under second names, or as copies where the file system has none of those.
    pub(super) fn give(&self, mesh: &Path, material: Option<&Path>) -> io::Result<()> {
        let give = |file: &Path, name: PathBuf| {
            fs::hard_link(file, &name).or_else(|_| fs::copy(file, &name).map(drop))
        };
        give(mesh, self.rooms.mesh())?;
        material.map_or(Ok(()), |material| give(material, self.rooms.material()))
    }

    /// Removes what there is nearly always: few calls where a walk through the folder takes many.
    fn clear_away(&self) -> io::Result<()> {
        fs::remove_file(self.rooms.mesh())?;
        for dir in [&self.rooms.given(), &self.rooms.all_made(), self.rooms.folder()] {
            fs::remove_dir(dir)?;
        }
        Ok(())
    }
}

impl Drop for Workspace {
    fn drop(&mut self) {
        if self.clear_away().is_err()
            && let Err(error) = fs::remove_dir_all(self.rooms.folder())
        {
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
        let upload = dir.path().join("upload");
        fs::write(&upload, b"mesh").unwrap();
        for leaves_files in [false, true] {
            let workspace = workspaces.make().unwrap();
            workspace.give(&upload, leaves_files.then_some(&*upload)).unwrap();
            assert_eq!(fs::read(workspace.rooms.mesh()).unwrap(), b"mesh");
            let folder = workspace.rooms.folder().to_owned();
            if leaves_files {
                fs::write(workspace.rooms.made(0), b"mended").unwrap();
            }
            drop(workspace);
            assert!(!folder.exists() && upload.exists());
        }
        drop(workspaces.make().unwrap());
        assert_eq!(fs::read_dir(dir.path().join("work")).unwrap().count(), 0);
    }
}
