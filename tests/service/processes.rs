//! The processes of a server, as the system shows them.

use crate::server::{PATIENCE, Server};
use std::time::{Duration, Instant};

/// The processes that run jobs of the server, and dead ones that have not been reaped.
pub(crate) fn children_of(server: &Server) -> Vec<u32> {
    let mut children = all_children_of(server);
    children.retain(|&pid| {
        let works = || {
            std::fs::read_to_string(format!("/proc/{pid}/comm")).is_ok_and(|name| name == "meshmend-job\n")
        };
        parent_and_state(pid).is_some_and(|(_, state)| state == 'Z') || works()
    });
    children
}

/// All processes that the server started and that have not been reaped.
pub(crate) fn all_children_of(server: &Server) -> Vec<u32> {
    let number = |name: std::ffi::OsString| name.to_str()?.parse::<u32>().ok();
    let processes = std::fs::read_dir("/proc").unwrap().filter_map(|entry| number(entry.ok()?.file_name()));
    processes.filter(|&pid| parent_and_state(pid).is_some_and(|(its, _)| its == server.pid())).collect()
}

/// The one process that runs a job, once there is one.
pub(crate) fn child_of(server: &Server) -> u32 {
    let begun = Instant::now();
    loop {
        if let [pid] = children_of(server)[..] {
            return pid;
        }
        assert!(begun.elapsed() < PATIENCE, "no process runs a job");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Waits until the process is gone. One that nobody reaps is gone as well: the first process of a container may not.
pub(crate) fn until_gone(pid: u32) {
    let begun = Instant::now();
    while parent_and_state(pid).is_some_and(|(_, state)| state != 'Z') {
        assert!(begun.elapsed() < PATIENCE, "process {pid} is still there");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The parent of a process and the letter of its state; `None`: there is no such process.
pub(crate) fn parent_and_state(pid: u32) -> Option<(u32, char)> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // Its name stands in brackets and may hold anything.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let state = fields.next()?.chars().next()?;
    Some((fields.next()?.parse().ok()?, state))
}

/// The most memory that the server has held at one time, in bytes.
pub(crate) fn peak_memory(server: &Server) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", server.pid())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() << 10
}
