//! The folder of a child: what it is given to read, and what it leaves. One for each run; when nobody needs it any longer,
//! it is emptied and serves the next run: on some file systems, names that come and go are dear.

use std::fs::{self, DirBuilder};
use std::io;
use std::os::unix::fs::DirBuilderExt as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use uuid::Uuid;

use crate::jobs::blobs::make_private_dir;

/// The place of all folders, on the file system of the spool, so that files come and go without being copied. Clones share it.
#[derive(Debug, Clone)]
pub(super) struct Workspaces {
    dir: PathBuf,
    idle: Arc<Mutex<Idle>>,
}

/// Folders that serve nobody: as many as there were runs at one time.
#[derive(Debug, Default)]
struct Idle {
    /// They are empty.
    rooms: Vec<Rooms>,
    /// No more are wanted.
    is_over: bool,
}

/// Where things are in a folder.
#[derive(Debug, Clone)]
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

    /// Whether nobody has removed them.
    pub(super) fn are_there(&self) -> bool {
        self.given().is_dir() && self.all_made().is_dir()
    }

    /// Removes all files.
    fn empty(&self) -> io::Result<()> {
        for dir in [self.given(), self.all_made()] {
            for file in fs::read_dir(dir)? {
                fs::remove_file(file?.path())?;
            }
        }
        Ok(())
    }

    /// Removes the folder with all that is in it.
    fn remove(&self) {
        if let Err(error) = fs::remove_dir_all(self.folder())
            && error.kind() != io::ErrorKind::NotFound
        {
            tracing::warn!(%error, "the folder of a job's process could not be removed");
        }
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
        make_private_dir(&dir)?;
        Ok(Self { dir, idle: Arc::default() })
    }

    /// An empty folder, for this server's user alone.
    pub(super) fn make(&self) -> io::Result<Workspace> {
        let workspace =
            |rooms| Workspace { rooms, idle: Arc::clone(&self.idle), is_sound: AtomicBool::new(false) };
        // One that somebody has removed serves nobody.
        while let Some(rooms) = lock(&self.idle).rooms.pop() {
            if rooms.are_there() {
                return Ok(workspace(rooms));
            }
        }
        make_private_dir(&self.dir)?;
        let made = workspace(Rooms(self.dir.join(Uuid::now_v7().simple().to_string())));
        for dir in [made.rooms.folder(), &made.rooms.given(), &made.rooms.all_made()] {
            DirBuilder::new().mode(0o700).create(dir)?;
        }
        Ok(made)
    }

    /// Removes the folders that serve nobody, and from now on each one after its run.
    pub(super) fn close(&self) {
        let mut idle = lock(&self.idle);
        idle.is_over = true;
        idle.rooms.drain(..).for_each(|rooms| rooms.remove());
    }
}

fn lock(idle: &Mutex<Idle>) -> MutexGuard<'_, Idle> {
    idle.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A folder for one run.
#[derive(Debug)]
pub(in crate::jobs) struct Workspace {
    pub(super) rooms: Rooms,
    idle: Arc<Mutex<Idle>>,
    /// Its child has ended as it should.
    is_sound: AtomicBool,
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

    /// The child has ended as it should: its folder may serve again.
    pub(super) fn mark_sound(&self) {
        self.is_sound.store(true, Ordering::Relaxed);
    }
}

impl Drop for Workspace {
    fn drop(&mut self) {
        if !self.is_sound.load(Ordering::Relaxed) || self.rooms.empty().is_err() {
            return self.rooms.remove();
        }
        let mut idle = lock(&self.idle);
        if idle.is_over {
            self.rooms.remove();
        } else {
            idle.rooms.push(self.rooms.clone());
        }
    }
}

/// A file that another process made in a folder of its own.
#[derive(Debug, Clone)]
pub(in crate::jobs) struct MadeFile {
    pub(in crate::jobs) path: PathBuf,
    pub(in crate::jobs) bytes: u64,
    pub(in crate::jobs) sha256: [u8; 32],
    /// The folder, which goes with the last file.
    pub(in crate::jobs) _folder: Arc<Workspace>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(dir: &Path) -> usize {
        fs::read_dir(dir).unwrap().count()
    }

    #[test]
    fn what_an_earlier_server_left_goes_at_the_start() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir_all(dir.path().join("work/old")).unwrap();
        drop(Workspaces::open(dir.path()).unwrap());
        assert_eq!(count(&dir.path().join("work")), 0);
    }

    #[test]
    fn folders_that_somebody_has_removed_are_made_again() {
        let dir = tempfile::tempdir().unwrap();
        let workspaces = Workspaces::open(dir.path()).unwrap();
        let first = workspaces.make().unwrap();
        let rooms = first.rooms.clone();
        first.mark_sound();
        drop(first);
        fs::remove_dir_all(dir.path().join("work")).unwrap();
        let second = workspaces.make().unwrap();
        assert!(second.rooms.are_there() && second.rooms.folder() != rooms.folder());
    }

    #[test]
    fn a_folder_is_emptied_for_the_next_run_and_goes_when_something_was_wrong_or_all_is_over() {
        let dir = tempfile::tempdir().unwrap();
        let workspaces = Workspaces::open(dir.path()).unwrap();
        let all = dir.path().join("work");
        let upload = dir.path().join("upload");
        fs::write(&upload, b"mesh").unwrap();
        let run = |is_sound: bool| {
            let workspace = workspaces.make().unwrap();
            let rooms = workspace.rooms.clone();
            assert_eq!((count(&rooms.given()), count(&rooms.all_made())), (0, 0));
            workspace.give(&upload, Some(&*upload)).unwrap();
            assert_eq!(fs::read(rooms.mesh()).unwrap(), b"mesh");
            fs::write(rooms.made(3), b"mended").unwrap();
            if is_sound {
                workspace.mark_sound();
            }
            drop(workspace);
            assert!(upload.exists());
            rooms.folder().to_owned()
        };
        let first = run(true);
        assert_eq!(run(true), first);
        assert_eq!(run(false), first);
        assert_eq!(count(&all), 0);
        let next = run(true);
        assert!(next != first && next.exists());
        // What nobody but a person could put there.
        let workspace = workspaces.make().unwrap();
        fs::create_dir(workspace.rooms.all_made().join("folder")).unwrap();
        workspace.mark_sound();
        drop(workspace);
        assert_eq!(count(&all), 0);
        let (held, idle) = (workspaces.make().unwrap(), run(true));
        assert!(idle.exists());
        workspaces.close();
        assert_eq!(count(&all), 1);
        held.mark_sound();
        drop(held);
        assert_eq!(count(&all), 0);
    }
}
