//! Servers that end or are killed and begin again on the same data folder: what was accepted goes on.

use crate::meshes::{OPEN, SOLID, long_job};
use crate::server::{Server, header, link, problem};
use serde_json::{Value, json};

/// One job at a time, leases as short as they may be.
const NARROW: &[&str] = &["--slots", "1", "--lease", "1s"];

#[test]
fn jobs_of_a_killed_server_end_on_the_next_one() {
    let server = Server::with(NARROW);
    let ended = server.ended(&server.job("repair", SOLID));
    let running = server.job("verify", long_job(200));
    server.until(&running, |job| job["state"] == "running");
    let queued: Vec<_> = (0..3).map(|i| server.job("repair", format!("{OPEN}# {i}\n"))).collect();
    let server = server.killed_and_restarted(NARROW);
    let again = server.ended(&running);
    assert_eq!((&again["state"], &again["attempts"]), (&json!("succeeded"), &json!(1)), "{again}");
    for job in &queued {
        let job = server.ended(job);
        assert_eq!((&job["outcome"], &job["attempts"]), (&json!("repaired"), &json!(0)), "{job}");
        assert_eq!(server.get(link(&job, "result")).send().unwrap().status(), 200);
    }
    let kept = server.ended(&ended);
    assert_eq!(kept["finished_at"], ended["finished_at"], "what has ended is not run again");
    assert_eq!(server.get(link(&kept, "result")).send().unwrap().text().unwrap(), SOLID);
}

#[test]
fn a_server_that_ends_gives_its_jobs_to_the_next_one_and_says_where_they_are() {
    let settings = &["--slots", "1", "--drain-grace", "200ms"];
    let server = Server::with(settings);
    let mesh = long_job(1000);
    let mut line = server.connect();
    line.say(format!(
        "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n",
        mesh.len()
    ));
    line.say(&mesh);
    while server.get("/v1/jobs?state=running").send().unwrap().json::<Value>().unwrap()["jobs"] == json!([]) {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let queued = server.job("repair", SOLID);
    server.signal("TERM");
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 202 "), "{answer:.500}");
    let location = answer.lines().find_map(|line| line.strip_prefix("location: ")).unwrap().to_owned();
    let server = server.restarted(settings);
    let waited_for = json!({"links": {"self": location}});
    let job: Value = server.get(&location).send().unwrap().json().unwrap();
    assert_eq!(job["attempts"], 0, "{job}");
    server.post(&format!("{location}/cancel")).send().unwrap();
    assert_eq!(server.ended(&queued)["state"], "succeeded");
    assert_eq!(server.ended(&waited_for)["state"], "cancelled");
}

#[test]
fn an_upload_that_a_kill_cuts_off_leaves_no_file() {
    let server = Server::start();
    let mut line = server.connect();
    line.say("POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9000000\r\n\r\n");
    line.say(vec![b'x'; 4_000_000]);
    while server.stored_files().iter().all(|file| file.metadata().map_or(0, |data| data.len()) == 0) {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let server = server.killed_and_restarted(&[]);
    assert_eq!(server.stored_files(), Vec::<std::path::PathBuf>::new());
}

#[test]
fn the_deadline_of_a_job_outlasts_the_server() {
    let server = Server::with(NARROW);
    server.job("verify", long_job(500));
    let response =
        server.post("/v1/jobs?operation=repair").header("cancel-after", "1").body(SOLID).send().unwrap();
    let job: Value = response.json().unwrap();
    let server = server.killed_for(std::time::Duration::from_millis(1100), NARROW);
    let ended = server.ended(&job);
    assert_eq!((&ended["state"], &ended["problem"]["code"]), (&json!("failed"), &json!("engine-timeout")));
}

#[test]
fn who_follows_a_job_over_a_kill_hears_its_end_once() {
    let server = Server::with(NARROW);
    let job = server.job("verify", long_job(500));
    server.until(&job, |job| job["state"] == "running");
    let path = format!("{}/events", link(&job, "self"));
    let server = server.killed_and_restarted(NARROW);
    let response = server.get(&path).header("last-event-id", "2.0").send().unwrap();
    assert_eq!(header(&response, "content-type"), "text/event-stream");
    assert_eq!(header(&response, "x-accel-buffering"), "no");
    let text = response.text().unwrap();
    let states: Vec<_> = text.split("\n\n").filter(|event| event.contains("event: state")).collect();
    assert_eq!(states.len(), 3, "{text}");
    for (event, state) in states.iter().zip(["queued", "running", "succeeded"]) {
        assert!(event.contains(&format!("\"state\":\"{state}\"")), "{text}");
    }
    assert!(
        text.contains("event: stage") && text.contains("\"stage\":\"certify\",\"phase\":\"end\""),
        "{text}"
    );
    let last = text.lines().filter_map(|line| line.strip_prefix("id: ")).next_back().unwrap();
    let heard = server.get(&path).header("last-event-id", last).send().unwrap();
    assert_eq!(heard.status(), 204);
    let all = server.get(&path).send().unwrap().text().unwrap();
    assert_eq!(all.matches("\"state\":\"succeeded\"").count(), 1);
    assert_eq!(
        problem(server.get(&path).header("last-event-id", "x").send().unwrap()).1,
        "invalid-parameter"
    );
    assert_eq!(problem(server.get(&path).header("accept", "text/html").send().unwrap()).1, "not-acceptable");
}

#[test]
fn a_server_that_was_paused_past_its_leases_shows_one_result() {
    let server = Server::with(NARROW);
    let job = server.job("verify", long_job(200));
    server.until(&job, |job| job["state"] == "running");
    server.signal("STOP");
    std::thread::sleep(std::time::Duration::from_millis(2500));
    server.signal("CONT");
    let job = server.ended(&job);
    assert_eq!(job["state"], "succeeded", "{job}");
    assert!(job["attempts"].as_u64().unwrap() <= 1, "{job}");
    let events = server.get(&format!("{}/events", link(&job, "self"))).send().unwrap().text().unwrap();
    assert_eq!(events.matches("\"state\":\"succeeded\"").count(), 1, "{events}");
    server.request("DELETE", link(&job, "self")).send().unwrap();
    assert_eq!(server.stored_files(), Vec::<std::path::PathBuf>::new());
}
