//! Why a child gave no answer, told by how it ended and by what its runtime wrote.

use std::io;
use std::os::unix::process::ExitStatusExt as _;
use std::process::ExitStatus;

use libc::c_int;

use super::limits::ProcessLimits;
use crate::budget::Stopped;
use crate::wire::{Problem, ProblemCode, Stage};

/// Why a child gave no answer.
#[derive(Debug)]
pub(in crate::jobs) enum Death {
    /// The server ended it.
    Stopped(Stopped),
    /// It could not be started or watched.
    NotStarted(io::Error),
    /// It ended so before it had its task.
    Waiting(Box<Death>),
    /// The system gave it no more memory.
    OutOfMemory,
    /// A thread of it used up its stack.
    StackOverflow,
    /// It gave itself up.
    Aborted,
    /// The processor or the kernel stopped it at a fault of its own.
    Fault(c_int),
    /// Somebody else ended it: an operator, or the kernel when the machine had no more memory.
    Killed(c_int),
    /// It used more CPU time than it may.
    CpuTime,
    /// It wrote a larger file than it may.
    FileSize,
    /// It ended by itself, with this code.
    NoAnswer(i32),
    /// It said what no child says.
    Garbled,
}

impl Death {
    /// What `status` means; `words` is what the runtime wrote; `is_for_memory`: the kernel has ended a process for lack of
    /// memory meanwhile.
    pub(super) fn of(status: ExitStatus, words: &str, is_for_memory: bool) -> Self {
        let Some(signal) = status.signal() else { return Self::NoAnswer(status.code().unwrap_or(-1)) };
        match signal {
            libc::SIGABRT | libc::SIGSEGV if words.contains("has overflowed its stack") => {
                Self::StackOverflow
            }
            libc::SIGABRT if words.contains("memory allocation of") => Self::OutOfMemory,
            libc::SIGABRT => Self::Aborted,
            // Tried again, it would take as much.
            libc::SIGKILL if is_for_memory => Self::OutOfMemory,
            libc::SIGXCPU => Self::CpuTime,
            libc::SIGXFSZ => Self::FileSize,
            libc::SIGSEGV | libc::SIGBUS | libc::SIGILL | libc::SIGFPE | libc::SIGTRAP | libc::SIGSYS => {
                Self::Fault(signal)
            }
            _ => Self::Killed(signal),
        }
    }

    /// A word for metrics and the log.
    pub(in crate::jobs) fn kind(&self) -> &'static str {
        match self {
            Self::Stopped(Stopped::Cancelled) => "cancelled",
            Self::Stopped(_) => "deadline",
            Self::NotStarted(_) => "not-started",
            Self::Waiting(_) => "waiting",
            Self::OutOfMemory => "out-of-memory",
            Self::StackOverflow => "stack-overflow",
            Self::Aborted => "aborted",
            Self::Fault(_) => "fault",
            Self::Killed(_) => "killed",
            Self::CpuTime => "cpu-time",
            Self::FileSize => "file-size",
            Self::NoAnswer(_) => "no-answer",
            Self::Garbled => "garbled",
        }
    }

    /// What the caller hears; `stage` is the last pass that was heard of.
    pub(in crate::jobs) fn problem(
        &self,
        stage: Option<Stage>,
        limits: &ProcessLimits,
        engine_bytes_max: u64,
    ) -> Problem {
        let place = match stage {
            Some(stage) => format!("in the pass `{stage}`"),
            None => "before or between two passes".to_owned(),
        };
        let of = |code, what: &str| Problem::new(code, format!("the job's process {what} {place}"));
        let crashed = |what: &str| of(ProblemCode::EngineCrashed, what);
        match self {
            Self::Stopped(stopped) => Problem::from(stopped),
            Self::NotStarted(_) => {
                Problem::new(ProblemCode::WorkerLost, "no process could be started for the job")
            }
            Self::Waiting(last) => {
                let how = last.kind();
                let detail = format!("several processes ended before they took the job, the last by `{how}`");
                Problem::new(ProblemCode::WorkerLost, detail)
            }
            Self::OutOfMemory => of(ProblemCode::EngineOutOfMemory, "got no more memory").with_limit(
                "engine_bytes_max",
                engine_bytes_max,
                None,
            ),
            Self::StackOverflow => crashed("overflowed its stack"),
            Self::Aborted => crashed("aborted"),
            Self::Fault(signal) => crashed(&format!("failed with {}", name(*signal))),
            Self::Killed(signal) => {
                of(ProblemCode::WorkerLost, &format!("was killed from outside with {}", name(*signal)))
            }
            Self::CpuTime => of(ProblemCode::EngineTimeout, &format!("used {} s of CPU time", limits.cpu_s)),
            Self::FileSize => crashed(&format!("wrote a file of more than {} bytes", limits.file_bytes)),
            Self::NoAnswer(code) => crashed(&format!("ended without an answer (exit code {code})")),
            Self::Garbled => crashed("gave an answer that cannot be read"),
        }
    }
}

fn name(signal: c_int) -> String {
    let name = match signal {
        libc::SIGSEGV => "SIGSEGV",
        libc::SIGBUS => "SIGBUS",
        libc::SIGILL => "SIGILL",
        libc::SIGFPE => "SIGFPE",
        libc::SIGTRAP => "SIGTRAP",
        libc::SIGSYS => "SIGSYS",
        libc::SIGKILL => "SIGKILL",
        libc::SIGTERM => "SIGTERM",
        libc::SIGINT => "SIGINT",
        libc::SIGHUP => "SIGHUP",
        _ => return format!("signal {signal}"),
    };
    name.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn ends_are_told_apart_by_status_and_words() {
        let overflow =
            "thread 'main' (7) has overflowed its stack\nfatal runtime error: stack overflow, aborting";
        let rows = [
            (libc::SIGABRT, overflow, "stack-overflow", ProblemCode::EngineCrashed),
            (libc::SIGSEGV, overflow, "stack-overflow", ProblemCode::EngineCrashed),
            (
                libc::SIGABRT,
                "memory allocation of 9 bytes failed",
                "out-of-memory",
                ProblemCode::EngineOutOfMemory,
            ),
            (libc::SIGABRT, "", "aborted", ProblemCode::EngineCrashed),
            (libc::SIGSEGV, "", "fault", ProblemCode::EngineCrashed),
            (libc::SIGSYS, "", "fault", ProblemCode::EngineCrashed),
            (libc::SIGXCPU, "", "cpu-time", ProblemCode::EngineTimeout),
            (libc::SIGXFSZ, "", "file-size", ProblemCode::EngineCrashed),
            (libc::SIGKILL, "", "killed", ProblemCode::WorkerLost),
            (libc::SIGTERM, "", "killed", ProblemCode::WorkerLost),
            (3 << 8, "", "no-answer", ProblemCode::EngineCrashed),
            (0, "", "no-answer", ProblemCode::EngineCrashed),
        ];
        let limits = ProcessLimits::new(1 << 30, 1 << 30, Duration::from_secs(1), 1);
        for (status, words, kind, code) in rows {
            let death = Death::of(ExitStatus::from_raw(status), words, false);
            let problem = death.problem(Some(Stage::Repair), &limits, 1 << 30);
            assert_eq!((death.kind(), problem.code), (kind, code), "{status}");
            assert!(problem.detail.ends_with("in the pass `repair`"), "{}", problem.detail);
        }
    }

    #[test]
    fn one_that_the_kernel_ends_for_memory_is_not_lost_but_too_large() {
        let of = |signal, is_for_memory| Death::of(ExitStatus::from_raw(signal), "", is_for_memory).kind();
        assert_eq!((of(libc::SIGKILL, true), of(libc::SIGKILL, false)), ("out-of-memory", "killed"));
        assert_eq!(of(libc::SIGTERM, true), "killed");
    }

    #[test]
    fn a_signal_is_told_by_its_name() {
        let limits = ProcessLimits::new(1 << 30, 1 << 30, Duration::from_secs(1), 1);
        let detail = |signal| Death::Killed(signal).problem(None, &limits, 1 << 30).detail;
        assert!(detail(libc::SIGKILL).contains("killed from outside with SIGKILL"));
        assert!(detail(libc::SIGUSR1).contains(&format!("signal {}", libc::SIGUSR1)));
    }
}
