//! How much memory this process may use.

use std::fs;

/// Three quarters of the memory that this process may use: of the machine, or of its control group.
pub(super) fn default_bytes_max() -> u64 {
    let machine = rustix::system::sysinfo();
    let total = machine.totalram;
    let total = total.saturating_mul(u64::from(machine.mem_unit.max(1)));
    total.min(group_limit().unwrap_or(u64::MAX)) / 4 * 3
}

/// The limit of the control group, of either version of the interface.
fn group_limit() -> Option<u64> {
    const FILES: [&str; 2] = ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"];
    FILES.iter().find_map(|file| limit_in(&fs::read_to_string(file).ok()?))
}

/// A number of bytes; other words, and numbers beyond any memory, mean that there is no limit.
fn limit_in(text: &str) -> Option<u64> {
    text.trim().parse().ok().filter(|&bytes: &u64| bytes < 1 << 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_a_control_group_is_read_in_both_versions_of_its_words() {
        assert_eq!(limit_in("1073741824\n"), Some(1 << 30));
        assert_eq!(limit_in("max\n"), None);
        assert_eq!(limit_in("9223372036854771712\n"), None);
    }

    #[test]
    fn the_default_is_a_part_of_the_memory_there_is() {
        let bytes = default_bytes_max();
        assert!(bytes > 64 << 20 && bytes < u64::MAX / 2, "{bytes}");
    }
}
