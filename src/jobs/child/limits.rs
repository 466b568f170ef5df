//! What the kernel holds a child to, whatever the engine does.

use std::io;
use std::time::Duration;

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use serde::{Deserialize, Serialize};

/// Memory of a process beside what the engine charges: code, stacks, the allocator's own rest, small buffers.
const MEMORY_ALLOWANCE_BYTES: u64 = 256 << 20;
/// CPU time that a child may use beyond its deadline on every core. The server ends it at the deadline; this ends it
/// when the server cannot.
const CPU_ALLOWANCE: Duration = Duration::from_secs(5);
/// Open files: three streams, the input, the material, one output, and room for the runtime.
const FILES_MAX: u64 = 32;
/// How much sooner than others the kernel ends a child when memory is short, from 0 to 1000: as if it held half of the
/// memory more than it does.
const OOM_SCORE: &str = "500";

/// What the kernel holds a child to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::jobs) struct ProcessLimits {
    /// Private writable memory, in bytes.
    pub(in crate::jobs) memory_bytes: u64,
    /// CPU time of all threads, in seconds.
    pub(in crate::jobs) cpu_s: u64,
    /// Size of a file that it writes, in bytes.
    pub(in crate::jobs) file_bytes: u64,
}

/// Most private writable memory of a child whose engine may charge `engine_bytes_max`. The engine counts large arrays,
/// not every byte: it is given twice what it may charge and a fixed part, so that a run meets its own limit first.
fn memory_max(engine_bytes_max: u64) -> u64 {
    engine_bytes_max.saturating_mul(2).saturating_add(MEMORY_ALLOWANCE_BYTES)
}

impl ProcessLimits {
    /// Limits of a child with these settings and this many engine threads.
    pub(in crate::jobs) fn new(
        engine_bytes_max: u64,
        data_bytes_max: u64,
        deadline: Duration,
        threads: usize,
    ) -> Self {
        let memory_bytes = memory_max(engine_bytes_max);
        let cpu = deadline.saturating_mul(u32::try_from(threads).unwrap_or(u32::MAX));
        Self {
            memory_bytes,
            cpu_s: cpu.saturating_add(CPU_ALLOWANCE).as_secs().saturating_add(1),
            // A file is made in memory first, and kept among the data afterwards.
            file_bytes: memory_bytes.min(data_bytes_max),
        }
    }

    /// Puts this process under the limits.
    pub(super) fn enter(self) -> io::Result<()> {
        let soft_and_hard = |max| Rlimit { current: Some(max), maximum: Some(max) };
        limit(Resource::Data, soft_and_hard(self.memory_bytes))?;
        limit(Resource::Fsize, soft_and_hard(self.file_bytes))?;
        limit(Resource::Nofile, soft_and_hard(FILES_MAX))?;
        limit(Resource::Core, soft_and_hard(0))?;
        // At the soft limit a signal that tells CPU time from other ends, and a second later the end that cannot be caught.
        limit(
            Resource::Cpu,
            Rlimit { current: Some(self.cpu_s), maximum: Some(self.cpu_s.saturating_add(1)) },
        )?;
        // Where this is refused, the child is as likely to go as any other process.
        let _ = std::fs::write("/proc/self/oom_score_adj", OOM_SCORE);
        Ok(())
    }
}

/// Sets a limit, or the one there is when that is lower.
fn limit(resource: Resource, wanted: Rlimit) -> io::Result<()> {
    let ceiling = getrlimit(resource).maximum;
    let under = |wanted: Option<u64>| match (wanted, ceiling) {
        (Some(wanted), Some(ceiling)) => Some(wanted.min(ceiling)),
        (wanted, ceiling) => wanted.or(ceiling),
    };
    let new = Rlimit { current: under(wanted.current), maximum: under(wanted.maximum) };
    setrlimit(resource, new).map_err(io::Error::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_gives_more_than_the_engine_may_use() {
        let limits = ProcessLimits::new(4 << 30, 20 << 30, Duration::from_secs(10), 2);
        assert!(limits.memory_bytes > 4 << 30);
        assert!(limits.cpu_s > 2 * 10, "a deadline on every core comes first");
        assert_eq!(limits.file_bytes, limits.memory_bytes);
        assert_eq!(ProcessLimits::new(4 << 30, 1000, Duration::from_secs(10), 2).file_bytes, 1000);
    }

    #[test]
    fn limits_without_bounds_do_not_overflow() {
        let limits = ProcessLimits::new(u64::MAX, u64::MAX, Duration::MAX, usize::MAX);
        assert_eq!((limits.memory_bytes, limits.cpu_s), (u64::MAX, u64::MAX));
    }
}
