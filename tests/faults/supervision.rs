//! No process outlives its job, its deadline or its server.

use crate::ends::{goes_on, problem_of, server};
use crate::engine::LARGE;
use crate::processes::{child_of, children_of, parent_and_state, peak_memory};
use crate::server::{PATIENCE, Server, link, signal};
use serde_json::Value;
use std::time::{Duration, Instant};

/// A job that hangs, and its process.
fn hanging(server: &Server) -> (Value, u32) {
    let job = server.job("repair", "fault hang");
    server.until(&job, |job| job["progress"]["stage"] == "repair");
    let child = child_of(server);
    (job, child)
}

/// Waits until the process is gone. One that nobody reaps is gone as well: the first process of a container may not.
fn until_gone(pid: u32) {
    let begun = Instant::now();
    while parent_and_state(pid).is_some_and(|(_, state)| state != 'Z') {
        assert!(begun.elapsed() < PATIENCE, "process {pid} is still there");
        std::thread::sleep(Duration::from_millis(5));
    }
}

pub(crate) fn a_cancelled_job_leaves_no_process() {
    let server = server(&["--slots", "1"]);
    let (job, child) = hanging(&server);
    server.post(&format!("{}/cancel", link(&job, "self"))).send().unwrap();
    let ended = server.ended(&job);
    assert_eq!((&ended["state"], &ended["problem"]["code"]), (&"cancelled".into(), &"cancelled".into()));
    assert_eq!(parent_and_state(child), None, "the process is gone before the job has ended");
    goes_on(&server);
}

pub(crate) fn a_deleted_job_leaves_no_process() {
    let server = server(&["--slots", "1"]);
    let (job, child) = hanging(&server);
    assert_eq!(server.request("DELETE", link(&job, "self")).send().unwrap().status(), 204);
    until_gone(child);
    goes_on(&server);
}

pub(crate) fn a_process_that_hangs_ends_at_its_deadline() {
    let server = server(&["--slots", "1", "--deadline-max", "300ms"]);
    assert_eq!(problem_of(&server, "hang")["code"], "engine-timeout");
    assert!(children_of(&server).is_empty());
}

pub(crate) fn a_paused_process_ends_at_its_deadline() {
    let server = server(&["--slots", "1", "--deadline-max", "2s"]);
    let (job, child) = hanging(&server);
    signal(child, "STOP");
    assert_eq!(server.ended(&job)["problem"]["code"], "engine-timeout");
    assert_eq!(parent_and_state(child), None);
    goes_on(&server);
}

pub(crate) fn a_process_that_computes_without_end_ends_at_its_deadline() {
    let server = server(&["--slots", "1"]);
    let request = server.post("/v1/repair").header("cancel-after", "1").body("fault spin");
    let (status, code, _) = crate::server::problem(request.send().unwrap());
    assert_eq!((status, code.as_str()), (504, "engine-timeout"));
    goes_on(&server);
}

pub(crate) fn a_server_that_is_killed_leaves_no_process() {
    let mut server = server(&["--slots", "2"]);
    let (_, child) = hanging(&server);
    server.signal("KILL");
    assert_eq!(server.exit_code(), None, "killed by a signal");
    until_gone(child);
}

pub(crate) fn a_server_that_ends_in_order_leaves_no_process_and_no_folder() {
    let mut server = server(&["--slots", "1", "--drain-grace", "10ms"]);
    let (_, child) = hanging(&server);
    server.signal("TERM");
    assert_eq!(server.exit_code(), Some(0));
    assert_eq!(parent_and_state(child), None);
    assert_eq!(std::fs::read_dir(server.data_dir().join("work")).unwrap().count(), 0);
}

pub(crate) fn a_large_result_does_not_pass_through_the_memory_of_the_server() {
    let server = server(&["--slots", "1"]);
    goes_on(&server);
    let before = peak_memory(&server);
    let job = server.ended(&server.job("repair", "fault large"));
    let mut result = server.get(link(&job, "result")).send().unwrap();
    let bytes = std::io::copy(&mut result, &mut std::io::sink()).unwrap();
    assert_eq!(bytes, LARGE as u64);
    let more = peak_memory(&server) - before;
    assert!(more < LARGE as u64 / 4, "{more} bytes more for a result of {LARGE}");
    goes_on(&server);
}
