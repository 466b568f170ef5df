//! How a job ends when its process does.

use crate::engine::LARGE;
use crate::meshes::OPEN;
use crate::processes::{child_of, children_of};
use crate::server::{Server, signal};
use serde_json::{Value, json};
use std::path::Path;

/// A server of this very binary.
pub(crate) fn server(settings: &[&str]) -> Server {
    // A run that is lost is tried again; here once is enough.
    let settings = [settings, &["--attempts-max", "1"]].concat();
    Server::of(&std::env::current_exe().unwrap(), &settings)
}

/// The problem of a job with this fault.
pub(crate) fn problem_of(server: &Server, fault: &str) -> Value {
    let job = server.ended(&server.job("repair", format!("fault {fault}")));
    assert!(["failed", "cancelled"].contains(&job["state"].as_str().unwrap()), "{fault}: {job}");
    job["problem"].clone()
}

/// The server takes the next job, and no process is left.
pub(crate) fn goes_on(server: &Server) {
    let job = server.ended(&server.job("repair", OPEN));
    assert_eq!((&job["state"], &job["outcome"]), (&json!("succeeded"), &json!("repaired")), "{job}");
    assert!(children_of(server).is_empty());
    let folders: Vec<_> = std::fs::read_dir(server.data_dir().join("work")).unwrap().collect();
    // That of the process that waits, and that of the last job, which serves again.
    assert!(folders.len() <= 2, "{folders:?}");
    let files =
        |folder: &Path| ["given", "made"].map(|room| std::fs::read_dir(folder.join(room)).unwrap().count());
    assert!(
        folders.into_iter().all(|folder| files(&folder.unwrap().path()) == [0, 0]),
        "files of jobs that have ended"
    );
}

pub(crate) fn every_end_of_a_process_is_a_problem_of_its_own_and_the_next_job_runs() {
    let server = server(&["--slots", "1", "--engine-bytes-max", "16MiB"]);
    for (fault, code, words) in [
        ("memory", "engine-out-of-memory", "got no more memory"),
        ("overflow", "engine-crashed", "overflowed its stack"),
        ("abort", "engine-crashed", "aborted"),
        ("panic", "engine-crashed", "the engine failed on this mesh"),
        ("silence", "engine-crashed", "without an answer (exit code 0)"),
        ("exit", "engine-crashed", "without an answer (exit code 3)"),
        ("noise", "engine-crashed", "cannot be read"),
        ("flood", "engine-crashed", "cannot be read"),
    ] {
        let problem = problem_of(&server, fault);
        assert_eq!(problem["code"], code, "{fault}: {problem}");
        let detail = problem["detail"].as_str().unwrap();
        assert!(detail.contains(words), "{fault}: {detail}");
        // The panic was caught by the process itself.
        assert!(fault == "panic" || detail.ends_with("in the pass `repair`"), "{fault}: {detail}");
        goes_on(&server);
    }
    let problem = problem_of(&server, "memory");
    assert_eq!((&problem["limit_name"], &problem["limit"]), (&json!("engine_bytes_max"), &json!(16 << 20)));
}

pub(crate) fn a_signal_from_outside_is_told_from_a_fault_of_the_engine() {
    let server = server(&["--slots", "1"]);
    for (name, code, words) in [
        ("KILL", "worker-lost", "killed from outside with SIGKILL"),
        ("TERM", "worker-lost", "killed from outside with SIGTERM"),
        ("ILL", "engine-crashed", "failed with SIGILL"),
        ("XCPU", "engine-timeout", "of CPU time"),
        ("XFSZ", "engine-crashed", "wrote a file of more than"),
    ] {
        let job = server.job("repair", "fault hang");
        server.until(&job, |job| job["progress"]["stage"] == "repair");
        signal(child_of(&server), name);
        let problem = &server.ended(&job)["problem"];
        assert_eq!(problem["code"], code, "{name}: {problem}");
        assert!(problem["detail"].as_str().unwrap().contains(words), "{name}: {problem}");
        goes_on(&server);
    }
}

pub(crate) fn a_file_that_grows_too_large_ends_its_job() {
    // In a sandbox there is no file that could grow but the results, whose size is known before they are written.
    let server = server(&["--sandbox", "off", "--data-bytes-max", "4MiB"]);
    let problem = problem_of(&server, "file");
    assert_eq!(problem["code"], "engine-crashed", "{problem}");
    assert!(problem["detail"].as_str().unwrap().contains("more than 4194304 bytes"), "{problem}");
    goes_on(&server);
}

pub(crate) fn a_result_that_is_larger_than_what_may_be_kept_is_refused_by_its_limit() {
    let server = server(&["--data-bytes-max", "32MiB"]);
    let problem = problem_of(&server, "large");
    assert_eq!(
        (&problem["code"], &problem["limit_name"]),
        (&json!("storage-full"), &json!("data_bytes_max"))
    );
    assert_eq!((&problem["limit"], &problem["actual"]), (&json!(32 << 20), &json!(LARGE)));
    goes_on(&server);
}

pub(crate) fn ends_are_counted_by_kind() {
    let server = server(&["--slots", "1"]);
    for fault in ["overflow", "overflow", "panic", "exit"] {
        problem_of(&server, fault);
    }
    goes_on(&server);
    let metrics = server.admin("/metrics").text().unwrap();
    for (kind, count) in [("stack-overflow", 2), ("panicked", 1), ("no-answer", 1), ("answered", 1)] {
        let line = format!("meshmend_child_exits_total{{kind=\"{kind}\"}} {count}");
        assert!(metrics.lines().any(|told| told == line), "{line}:\n{metrics}");
    }
}
