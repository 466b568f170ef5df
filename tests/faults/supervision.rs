//! No process outlives its job, its deadline or its server.

use crate::ends::{goes_on, problem_of, server};
use crate::engine::LARGE;
use crate::processes::{all_children_of, child_of, children_of, parent_and_state, peak_memory, until_gone};
use crate::server::{Server, link, patiently, signal};
use reqwest::blocking::multipart::{Form, Part};
use serde_json::{Value, json};

/// A job that hangs, and its process.
fn hanging(server: &Server) -> (Value, u32) {
    let job = server.job("repair", "fault hang");
    server.until(&job, |job| job["progress"]["stage"] == "repair");
    let child = child_of(server);
    (job, child)
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
    let waiting = waiting_of(&server, 0);
    server.signal("KILL");
    assert_eq!(server.exit_code(), None, "killed by a signal");
    until_gone(child);
    until_gone(waiting);
}

/// A living process that waits for the next task, and is not `but`. It is known by its name, which it has once it can be
/// stopped: a server waits for a process that is about to become another program.
pub(crate) fn waiting_of(server: &Server, but: u32) -> u32 {
    let waits = |pid| {
        let name = std::fs::read_to_string(format!("/proc/{pid}/comm")).ok();
        name.as_deref() == Some("meshmend-waits\n")
            && parent_and_state(pid).is_some_and(|(_, state)| state != 'Z')
    };
    patiently(|| all_children_of(server).into_iter().find(|&pid| pid != but && waits(pid)))
}

pub(crate) fn a_job_whose_folder_is_removed_runs_again() {
    let server = Server::of(&std::env::current_exe().unwrap(), &["--slots", "1"]);
    let job = server.job("repair", crate::meshes::long_job(60));
    // No folder is made while they are removed: the next process waits already.
    waiting_of(&server, child_of(&server));
    std::fs::remove_dir_all(server.data_dir().join("work")).unwrap();
    let ended = server.ended(&job);
    assert_eq!((&ended["state"], &ended["attempts"]), (&json!("succeeded"), &json!(1)), "{ended}");
}

pub(crate) fn a_process_that_is_killed_while_it_waits_costs_no_job() {
    let server = server(&["--slots", "1"]);
    for number in 0..3 {
        let waiting = waiting_of(&server, 0);
        signal(waiting, "KILL");
        until_gone(waiting);
        let job = server.ended(&server.job("repair", format!("{}# {number}\n", crate::meshes::OPEN)));
        assert_eq!(job["state"], "succeeded", "{job}");
    }
}

pub(crate) fn a_job_whose_process_ends_before_it_takes_the_job_goes_to_another_at_no_cost() {
    let server = server(&["--slots", "1"]);
    let first = waiting_of(&server, 0);
    signal(first, "STOP");
    let job = server.job("repair", crate::meshes::OPEN);
    // Another one waits only once the first is to have the job.
    waiting_of(&server, first);
    signal(first, "KILL");
    let ended = server.ended(&job);
    assert_eq!((&ended["state"], &ended["attempts"]), (&json!("succeeded"), &json!(0)), "{ended}");
    let metrics = server.admin("/metrics").text().unwrap();
    assert!(metrics.contains("meshmend_child_exits_total{kind=\"waiting\"} 1\n"), "{metrics}");
    goes_on(&server);
}

pub(crate) fn a_job_whose_processes_all_end_before_they_take_it_ends_as_lost() {
    let server = server(&["--slots", "1"]);
    let mut given = waiting_of(&server, 0);
    signal(given, "STOP");
    let job = server.job("repair", crate::meshes::OPEN);
    for _ in 0..3 {
        let next = waiting_of(&server, given);
        signal(next, "STOP");
        signal(given, "KILL");
        until_gone(given);
        given = next;
    }
    let ended = server.ended(&job);
    assert_eq!(ended["problem"]["code"], "worker-lost", "{ended}");
    assert!(ended["problem"]["detail"].as_str().unwrap().contains("before they took the job"), "{ended}");
    signal(given, "CONT");
    goes_on(&server);
}

pub(crate) fn a_process_that_is_paused_while_it_waits_ends_at_the_deadline_of_its_job() {
    let server = server(&["--slots", "1", "--deadline-max", "2s"]);
    signal(waiting_of(&server, 0), "STOP");
    let job = server.ended(&job_with_a_long_task(&server));
    assert_eq!(job["problem"]["code"], "engine-timeout", "{job}");
    goes_on(&server);
}

pub(crate) fn a_task_that_is_longer_than_a_pipe_holds_comes_through_whole() {
    let server = server(&["--slots", "1"]);
    let job = server.ended(&job_with_a_long_task(&server));
    // The mesh does not have its last element.
    assert_eq!(job["problem"]["code"], "plan-mismatch", "{job}");
}

/// A job whose plan alone has more bytes than a pipe holds.
fn job_with_a_long_task(server: &Server) -> Value {
    let elements: Vec<_> = (0..5000).map(|number| json!({"number": number, "remedy": "fill"})).collect();
    let plan = json!({"findings": [{"code": "boundary-loop", "elements": elements}]});
    let asked = json!({"operation": "repair", "params": {"plan": plan}}).to_string();
    assert!(asked.len() > 64 << 10);
    let form = Form::new()
        .part("mesh", Part::bytes(crate::meshes::OPEN.as_bytes()))
        .part("job", Part::text(asked).mime_str("application/json").unwrap());
    let response = server.post("/v1/jobs").multipart(form).send().unwrap();
    assert_eq!(response.status(), 202);
    response.json().unwrap()
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
