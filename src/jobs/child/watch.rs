//! A child from its task to its end, watched from one thread of the server.

use std::io::{self, Read as _};
use std::sync::Arc;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::death::Death;
use super::hearing::{Hearing, Last};
use super::launch::Running;
use super::memory_kills;
use super::sandbox::Protections;
use super::task::{FileMade, Task};
use super::workspace::{MadeFile, Workspace};
use crate::budget::{ProgressEvent, StopFlag};
use crate::jobs::product::RunProduct;
use crate::wire::Problem;

/// Time between two looks at the stop flag. What the child says and its end are heard at once.
const TICK: Duration = Duration::from_millis(20);

/// What came of a child that answered.
#[derive(Debug)]
pub(in crate::jobs) struct Answered {
    /// What held it.
    pub(super) protections: Protections,
    /// Where in the sources the engine panicked, if it did.
    pub(in crate::jobs) panicked_at: Option<String>,
    /// What it made, or why it made nothing.
    pub(in crate::jobs) outcome: Result<RunProduct<MadeFile>, Problem>,
}

/// Gives a child its task and hears it to its end. Passes go to `hear`. When `stop` is raised the child ends within moments;
/// when `patience` is over, this raises it.
pub(super) fn watch(
    mut running: Running,
    task: &Task,
    stop: &StopFlag,
    patience: Duration,
    hear: &dyn Fn(ProgressEvent),
) -> Result<Answered, Death> {
    let begun = Instant::now();
    running.give(task).map_err(Death::NotStarted)?;
    let mut hearing = Hearing::default();
    let mut piece = vec![0; 8 << 10];
    let mut is_open = true;
    let status = loop {
        if begun.elapsed() >= patience {
            stop.pass_deadline();
        }
        if let Some(reason) = stop.raised() {
            running.kill();
            return Err(Death::Stopped(reason));
        }
        running.tell().map_err(Death::NotStarted)?;
        // Asked before the last words are read, so that none can come after.
        let status = running.status().map_err(Death::NotStarted)?;
        let has_words = wait(&running, is_open, if status.is_some() { Duration::ZERO } else { TICK })
            .map_err(Death::NotStarted)?;
        if has_words {
            let read = match running.output.read(&mut piece) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                read => read.map_err(Death::NotStarted)?,
            };
            is_open = read > 0;
            hearing.take(&piece[..read], hear).map_err(|_| Death::Garbled)?;
        } else if let Some(status) = status {
            break status;
        }
    };
    let words = running.words();
    if !words.is_empty() {
        // What a panic says may hold a figure of the mesh.
        tracing::debug!(words, "last words of a job's process");
    }
    if !status.success() {
        let is_for_memory = memory_kills::are_more();
        let death = Death::of(status, &words, is_for_memory);
        return Err(if hearing.has_task { death } else { Death::Waiting(Box::new(death)) });
    }
    let protections = hearing.protections.unwrap_or_default();
    let outcome = match hearing.last() {
        Some(Last::Made(product)) => {
            Ok(product.try_map(|made| taken(&made, &running.workspace)).map_err(|_| Death::Garbled)?)
        }
        Some(Last::Failed(problem)) => Err(*problem),
        None => return Err(Death::NoAnswer(0)),
    };
    running.workspace.mark_sound();
    let place = |line: &str| Some(line.split_once(" panicked at ")?.1.trim_end_matches(':').to_owned());
    let panicked_at = words.lines().find_map(place);
    Ok(Answered { protections, panicked_at, outcome })
}

/// Waits until the child says something, ends, or `patience` is over. Whether there is something to read.
fn wait(running: &Running, is_open: bool, patience: Duration) -> io::Result<bool> {
    let mut sources = Vec::with_capacity(3);
    if is_open {
        sources.push(PollFd::new(&running.output, PollFlags::IN));
    }
    if let Some(ended) = &running.ended {
        sources.push(PollFd::new(ended, PollFlags::IN));
    }
    if let Some(untold) = &running.untold {
        sources.push(PollFd::new(&untold.pipe, PollFlags::OUT));
    }
    let patience = Timespec::try_from(patience).map_err(io::Error::other)?;
    match poll(&mut sources, Some(&patience)) {
        // A signal of the server's own.
        Err(rustix::io::Errno::INTR) => Ok(false),
        polled => {
            polled?;
            Ok(is_open && !sources[0].revents().is_empty())
        }
    }
}

/// The file that a child says it made, if it is one.
fn taken(made: &FileMade, workspace: &Arc<Workspace>) -> io::Result<MadeFile> {
    let path = workspace.rooms.made(made.number);
    // Links are not followed: what a child makes may be a lie.
    let facts = std::fs::symlink_metadata(&path)?;
    if !facts.is_file() || facts.len() != made.bytes {
        return Err(io::ErrorKind::InvalidData.into());
    }
    Ok(MadeFile { path, bytes: made.bytes, sha256: made.sha256, _folder: Arc::clone(workspace) })
}
