//! The start of a child, the task it is given, and its certain end.

use std::fs::File;
use std::io::{self, ErrorKind, PipeReader, PipeWriter, Write as _};
use std::os::fd::OwnedFd;
use std::os::unix::fs::FileExt as _;
use std::os::unix::process::CommandExt as _;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;

use rustix::fs::{MemfdFlags, SealFlags, fcntl_add_seals, ftruncate, memfd_create};
use rustix::io::ioctl_fionbio;
use rustix::process::{Pid, PidfdFlags, Signal, kill_process_group, pidfd_open};

use super::run::RUN_JOB;
use super::task::{ChildSetup, Task};
use super::workspace::{Workspace, Workspaces};

/// The binary that this process runs, also when the file has been replaced since: versions do not mix.
const OWN_BINARY: &str = "/proc/self/exe";
/// Most that is kept of what the runtime writes before it aborts.
const WORDS_BYTES_MAX: u64 = 8 << 10;
/// The one variable that a child has, by which the GNU C library is tuned; another one does not look at it.
const TUNABLES: &str = "GLIBC_TUNABLES";
/// Its value where the server has none. Memory comes in large pages and is kept up to a size, which spares a new process most
/// of the faults by which it comes to it; larger pieces go back at once, so that its peak is no higher.
const TUNED: &str = "glibc.malloc.hugetlb=1:glibc.malloc.top_pad=16777216:glibc.malloc.mmap_threshold=4194304:\
                     glibc.malloc.trim_threshold=67108864";

/// A child that has not been reaped. Dropped, it is killed with its group and reaped.
#[derive(Debug)]
pub(super) struct Running {
    child: Child,
    /// Where it finds its files and leaves others.
    pub(super) workspace: Arc<Workspace>,
    /// The part of its task that it has not been told yet.
    pub(super) untold: Option<Untold>,
    /// What it says.
    pub(super) output: PipeReader,
    /// Readable once it has ended; `None` where the kernel has no such thing.
    pub(super) ended: Option<OwnedFd>,
    words: File,
    status: Option<ExitStatus>,
}

/// What a child has still to be told, and the way to it: it listens until that is closed.
#[derive(Debug)]
pub(super) struct Untold {
    pub(super) pipe: PipeWriter,
    words: Vec<u8>,
}

impl Running {
    /// Starts a child, which waits for its task. It dies with the calling thread.
    pub(super) fn start(setting: &ChildSetup, workspaces: &Workspaces) -> io::Result<Self> {
        let workspace = Arc::new(workspaces.make()?);
        let (source, pipe) = io::pipe()?;
        // A child that does not listen must not hold up whoever speaks to it.
        ioctl_fionbio(&pipe, true)?;
        let words = page_of_words()?;
        let (output, sink) = io::pipe()?;
        let mut command = Command::new(OWN_BINARY);
        command.arg0(env!("CARGO_PKG_NAME")).arg(RUN_JOB).arg(workspace.rooms.folder());
        command.arg(serde_json::to_string(setting)?).env_clear().process_group(0);
        command.env(TUNABLES, std::env::var_os(TUNABLES).unwrap_or_else(|| TUNED.into()));
        command.stdin(Stdio::from(source)).stdout(Stdio::from(sink)).stderr(Stdio::from(words.try_clone()?));
        let child = command.spawn()?;
        // With the command go this process's copies of the child's ends, so that the child's end is heard.
        drop(command);
        let ended = pidfd_open(Pid::from_child(&child), PidfdFlags::empty()).ok();
        let untold = Some(Untold { pipe, words: Vec::new() });
        Ok(Self { child, workspace, untold, output, ended, words, status: None })
    }

    /// Gives it its task; [`tell`](Self::tell) goes on with what does not fit into the pipe.
    pub(super) fn give(&mut self, task: &Task) -> io::Result<()> {
        if let Some(untold) = &mut self.untold {
            untold.words = serde_json::to_vec(task)?;
        }
        self.tell()
    }

    /// Tells it as much of its task as it will hear now.
    pub(super) fn tell(&mut self) -> io::Result<()> {
        let Some(Untold { pipe, words }) = &mut self.untold else { return Ok(()) };
        while !words.is_empty() {
            match pipe.write(words) {
                Ok(told) => drop(words.drain(..told)),
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                // It is gone: how it ended says more.
                Err(error) if error.kind() == ErrorKind::BrokenPipe => break,
                Err(error) => return Err(error),
            }
        }
        self.untold = None;
        Ok(())
    }

    /// How it ended, if it has.
    pub(super) fn status(&mut self) -> io::Result<Option<ExitStatus>> {
        if self.status.is_none() {
            self.status = self.child.try_wait()?;
        }
        Ok(self.status)
    }

    /// What the runtime wrote about its end.
    pub(super) fn words(&self) -> String {
        let mut bytes = vec![0; WORDS_BYTES_MAX as usize];
        let read = self.words.read_at(&mut bytes, 0).unwrap_or(0);
        String::from_utf8_lossy(&bytes[..read]).trim_matches(['\0', '\n']).to_owned()
    }

    /// Ends it and all that it may have started, and reaps it.
    pub(super) fn kill(&mut self) {
        if self.status.is_some() {
            // Reaped: its number may be another's by now.
            return;
        }
        if let Err(error) = kill_process_group(Pid::from_child(&self.child), Signal::KILL) {
            tracing::error!(%error, "the process of a job could not be killed");
        }
        match self.child.wait() {
            Ok(status) => self.status = Some(status),
            Err(error) => tracing::error!(%error, "the process of a job could not be reaped"),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.kill();
    }
}

/// A file in memory that cannot grow.
fn page_of_words() -> io::Result<File> {
    let file = memfd_create("meshmend-words", MemfdFlags::CLOEXEC | MemfdFlags::ALLOW_SEALING)?;
    ftruncate(&file, WORDS_BYTES_MAX)?;
    fcntl_add_seals(&file, SealFlags::GROW | SealFlags::SHRINK | SealFlags::SEAL)?;
    Ok(file.into())
}
