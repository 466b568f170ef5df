//! Exit codes, and messages that end a run.

use crate::wire::{Problem, ProblemCode};
use std::io::Write as _;
use std::process::ExitCode;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Exit {
    /// It did what was asked.
    Done = 0,
    /// The answer is no: no certified result, a file that is not valid, a service that is not ready.
    Negative = 1,
    /// The input cannot be read, or the command is wrong.
    Usage = 2,
    /// A limit or the deadline was met, or the run was cancelled.
    Stopped = 3,
    /// Something that should not happen.
    Internal = 4,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

impl Exit {
    /// How a run ends that meets this problem.
    pub(super) fn of(problem: &Problem) -> Self {
        match problem.code {
            ProblemCode::MeshTooLarge
            | ProblemCode::OverBudget
            | ProblemCode::EngineTimeout
            | ProblemCode::EngineOutOfMemory
            | ProblemCode::Cancelled => Self::Stopped,
            ProblemCode::NotRepairable => Self::Negative,
            ProblemCode::Internal | ProblemCode::EngineCrashed | ProblemCode::StorageFull => Self::Internal,
            _ => Self::Usage,
        }
    }
}

/// Writes a line to standard error. Where that is closed, nobody wants to know.
pub(super) fn say(message: &str) {
    let _ = writeln!(std::io::stderr(), "meshmend: {message}");
}

/// Writes text to standard output, with its colours where that is a terminal that has them and `NO_COLOR` is not set; a reader
/// that has gone (`| head`) is no error.
pub(super) fn print(text: &str) {
    let mut out = anstream::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}
