//! How often the kernel has ended a process because there was no more memory.

use std::fs;
use std::sync::atomic::{AtomicU64, Ordering};

/// Where the kernel counts: the control group of either version of its interface, and the whole machine.
const FILES: [&str; 3] =
    ["/sys/fs/cgroup/memory.events", "/sys/fs/cgroup/memory/memory.oom_control", "/proc/vmstat"];

/// How many there were when this process last looked.
static SEEN: AtomicU64 = AtomicU64::new(0);

/// Whether there were more since the last look; the first one tells nothing.
pub(super) fn are_more() -> bool {
    let count = count();
    SEEN.swap(count, Ordering::Relaxed) < count
}

/// The sum of all counts that can be read.
fn count() -> u64 {
    FILES.iter().filter_map(|file| count_in(&fs::read_to_string(file).ok()?)).fold(0, u64::saturating_add)
}

fn count_in(text: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix("oom_kill ")?.trim().parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kills_are_counted_among_other_words() {
        assert_eq!(count_in("low 0\nhigh 0\nmax 4\noom 4\noom_kill 3\noom_group_kill 1\n"), Some(3));
        assert_eq!(count_in("oom_kill_disable 0\nunder_oom 0\noom_kill 7\n"), Some(7));
        assert_eq!(count_in("pgfault 1\n"), None);
    }
}
