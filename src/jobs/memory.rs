//! How much memory this process may use.

use std::fs;
use std::path::{Path, PathBuf};

/// Three quarters of the memory that this process may use: of the machine, or of its control group.
pub(super) fn default_bytes_max() -> u64 {
    let machine = rustix::system::sysinfo();
    let total = machine.totalram;
    let total = total.saturating_mul(u64::from(machine.mem_unit.max(1)));
    total.min(group_limit().unwrap_or(u64::MAX)) / 4 * 3
}

/// The lowest limit of the control groups that this process is in, of either version of the interface.
fn group_limit() -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    limit_files(&groups).iter().filter_map(|file| limit_in(&fs::read_to_string(file).ok()?)).min()
}

/// Where the limits of the groups stand that `/proc/self/cgroup` names, and of those around them. In a container the mount begins with
/// its own group, whatever that is called outside.
fn limit_files(groups: &str) -> Vec<PathBuf> {
    let files = groups.lines().filter_map(|line| {
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, group) = (fields.next()?, fields.next()?);
        let (mount, file) = match controllers {
            "" => ("/sys/fs/cgroup", "memory.max"),
            _ if controllers.split(',').any(|name| name == "memory") => {
                ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
            }
            _ => return None,
        };
        let own = Path::new(group.trim_start_matches('/'));
        Some(own.ancestors().map(move |group| Path::new(mount).join(group).join(file)))
    });
    files.flatten().collect()
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
    fn the_groups_of_a_process_and_those_around_them_are_asked() {
        let of =
            |groups| limit_files(groups).iter().map(|file| file.display().to_string()).collect::<Vec<_>>();
        let service = "1:name=systemd:/a\n0::/system.slice/meshmend.service\n";
        assert_eq!(
            of(service),
            [
                "/sys/fs/cgroup/system.slice/meshmend.service/memory.max",
                "/sys/fs/cgroup/system.slice/memory.max",
                "/sys/fs/cgroup/memory.max"
            ]
        );
        let older = [
            "/sys/fs/cgroup/memory/jobs/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        ];
        assert_eq!(of("9:cpu,cpuacct:/jobs\n4:memory:/jobs\n"), older);
        assert_eq!(of("0::/\n"), ["/sys/fs/cgroup/memory.max"]);
        assert!(of("").is_empty() && of("nonsense").is_empty());
    }

    #[test]
    fn the_default_is_a_part_of_the_memory_there_is() {
        let bytes = default_bytes_max();
        assert!(bytes > 64 << 20 && bytes < u64::MAX / 2, "{bytes}");
    }
}
