//! Small meshes that somebody waits for have slots of their own.

use crate::meshes::{SOLID, long_job};
use crate::server::{Server, link};

#[test]
fn a_small_mesh_that_is_waited_for_does_not_wait_behind_a_large_one() {
    let server = Server::with(&["--slots", "1"]);
    let large = server.job("verify", long_job(700));
    server.until(&large, |job| job["state"] == "running");
    let answer = server.post("/v1/verify").body(SOLID).send().unwrap();
    assert_eq!(answer.status(), 200);
    let large = server.until(&large, |_| true);
    assert_eq!(large["state"], "running", "the large one is still at it");
    server.post(&format!("{}/cancel", link(&large, "self"))).send().unwrap();
}

#[test]
fn a_large_mesh_does_not_take_the_place_of_small_ones() {
    let server = Server::with(&["--slots", "1", "--interactive-bytes-max", "1KiB"]);
    let first = server.job("verify", long_job(1000));
    server.until(&first, |job| job["state"] == "running");
    let answer = server.post("/v1/verify").header("prefer", "wait=1").body(long_job(60)).send().unwrap();
    let second: serde_json::Value = answer.json().unwrap();
    assert_eq!(second["state"], "queued");
    assert_eq!(server.post("/v1/verify").body(SOLID).send().unwrap().status(), 200);
    let metrics = server.admin("/metrics").text().unwrap();
    let age = metrics.lines().find_map(|line| line.strip_prefix("meshmend_queue_oldest_seconds "));
    assert!(age.is_some_and(|age| age.parse::<f64>().unwrap() > 0.5), "{age:?}");
    for job in [first, second] {
        server.post(&format!("{}/cancel", link(&job, "self"))).send().unwrap();
    }
}

#[test]
fn jobs_that_are_thought_to_need_all_memory_run_one_after_the_other() {
    let server = Server::with(&["--slots", "2", "--memory-bytes-max", "1MiB"]);
    let jobs = [long_job(200), long_job(201)].map(|mesh| server.job("verify", mesh));
    for job in &jobs {
        assert_eq!(server.ended(job)["state"], "succeeded");
    }
    let cancelled = [long_job(700), long_job(701)].map(|mesh| server.job("verify", mesh));
    for job in &cancelled {
        server.post(&format!("{}/cancel", link(job, "self"))).send().unwrap();
        assert_eq!(server.ended(job)["state"], "cancelled", "also while it waits for memory");
    }
}
