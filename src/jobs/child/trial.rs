//! A trial at the start of the server: a child that is confined as all will be runs a small job.

use std::io;
use std::time::Duration;

use super::launch::Running;
use super::limits::ProcessLimits;
use super::sandbox::{Protections, Sandbox};
use super::task::{ChildSetup, Task};
use super::watch::watch;
use super::workspace::Workspaces;
use crate::budget::StopFlag;
use crate::formats::ReadLimits;
use crate::wire::{Operation, Options};

/// A tetrahedron, valid.
const MESH: &[u8] = b"OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// What the engine and the files of a trial may have, whatever the settings leave to jobs.
const TRIAL_BYTES: u64 = 64 << 20;
/// Longest trial. It takes milliseconds.
const PATIENCE: Duration = Duration::from_secs(10);

/// Jobs cannot run in processes here.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// The folder of jobs cannot be used.
    #[error("no job can be prepared: {0}")]
    Folder(#[from] io::Error),
    /// The process did not do its job.
    #[error("a process that was started for a trial did not answer: {0}")]
    NoAnswer(String),
    /// The sandbox is required, and there is no process to put into it.
    #[error("a sandbox needs `isolation = process`")]
    NoProcess,
    /// The sandbox is required, and the kernel does not give all of it.
    #[error("the kernel does not give the whole sandbox: {0}")]
    Incomplete(String),
}

/// Runs a small job in a child of that setting.
pub(super) fn try_out(workspaces: &Workspaces, setting: &ChildSetup) -> Result<Protections, TrialError> {
    let required = setting.sandbox == Sandbox::Require;
    let setting = ChildSetup {
        // What is missing is to be told, not to end the trial.
        sandbox: if required { Sandbox::Auto } else { setting.sandbox },
        limits: ProcessLimits { file_bytes: TRIAL_BYTES, ..setting.limits },
        ..*setting
    };
    let ReadLimits { triangles_max, vertices_max, polygon_corners_max } = ReadLimits::default();
    let task = Task {
        operation: Operation::Repair,
        options: Options::default(),
        input_bytes: MESH.len() as u64,
        file_sizes: Vec::new(),
        has_material: false,
        triangles_max,
        vertices_max,
        polygon_corners_max,
        engine_work_max: u64::MAX,
        engine_bytes_max: TRIAL_BYTES,
    };
    let running = Running::start(&setting, workspaces)?;
    std::fs::write(running.workspace.rooms.mesh(), MESH)?;
    let answered = watch(running, &task, &StopFlag::default(), PATIENCE, &|_| {})
        .map_err(|death| TrialError::NoAnswer(format!("{death:?}")))?;
    if let Err(problem) = answered.outcome {
        return Err(TrialError::NoAnswer(problem.detail));
    }
    if required && !answered.protections.are_complete() {
        return Err(TrialError::Incomplete(answered.protections.to_string()));
    }
    Ok(answered.protections)
}
