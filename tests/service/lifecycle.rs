//! The life of a job: accepted, waited for, cancelled, deleted, expired, and its files.

use crate::meshes::{OPEN, SOLID, long_job};
use crate::server::{Server, header, link, problem};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// One job at a time, so that the second one waits.
fn narrow() -> Server {
    Server::with(&["--slots", "1", "--interactive-slots", "0"])
}

#[test]
fn a_client_that_does_not_wait_finds_its_job_later() {
    let server = Server::start();
    let response = server.post("/v1/repair").header("prefer", "respond-async").body(OPEN).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "preference-applied")), (202, "respond-async"));
    let location = header(&response, "location").to_owned();
    let job: Value = response.json().unwrap();
    assert_eq!(link(&job, "self"), location);
    let job = server.ended(&job);
    assert_eq!((&job["state"], &job["outcome"]), (&json!("succeeded"), &json!("repaired")));
    let mesh = server.get(link(&job, "result")).send().unwrap();
    assert_eq!((mesh.status().as_u16(), header(&mesh, "content-type")), (200, "text/off"));
}

#[test]
fn a_wait_that_ends_before_the_job_gives_202() {
    let server = narrow();
    let long = server.job("verify", long_job(1100));
    let begun = Instant::now();
    let response = server.post("/v1/repair").header("prefer", "wait=1").body(SOLID).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "preference-applied")), (202, "wait=1"));
    assert!(begun.elapsed() >= Duration::from_secs(1));
    let waiting: Value = response.json().unwrap();
    assert_eq!(waiting["state"], "queued");
    let (status, code, _) =
        problem(server.get(&format!("{}/result", link(&waiting, "self"))).send().unwrap());
    assert_eq!((status, code.as_str()), (409, "job-not-finished"));
    server.post(&format!("{}/cancel", link(&long, "self"))).send().unwrap();
    assert_eq!(server.ended(&waiting)["state"], "succeeded");
}

#[test]
fn a_wait_over_the_limit_is_shortened_and_told() {
    let server = Server::start();
    let response = server.post("/v1/verify").header("prefer", "wait=9999").body(SOLID).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "preference-applied")), (200, "wait=300"));
    let job = server.ended(&server.job("verify", SOLID));
    let response = server.get(&format!("{}?wait=9999", link(&job, "self"))).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "preference-applied")), (200, "wait=300"));
}

#[test]
fn a_job_can_be_cancelled_while_it_waits_and_while_it_runs() {
    let server = narrow();
    let running = server.job("verify", long_job(300));
    let waiting = server.job("verify", SOLID);
    server.until(&running, |job| job["state"] == "running");
    let cancel = |job: &Value| server.post(&format!("{}/cancel", link(job, "self"))).send().unwrap();
    let response = cancel(&waiting);
    assert_eq!(response.status(), 200);
    assert_eq!(response.json::<Value>().unwrap()["state"], "cancelled");
    assert!([200, 202].contains(&cancel(&running).status().as_u16()));
    let ended = server.ended(&running);
    assert_eq!((&ended["state"], &ended["problem"]["code"]), (&json!("cancelled"), &json!("cancelled")));
    let (status, code, _) = problem(server.get(&format!("{}/result", link(&ended, "self"))).send().unwrap());
    assert_eq!((status, code.as_str()), (409, "cancelled"));
    // Once more changes nothing.
    assert_eq!(cancel(&running).status(), 200);
}

#[test]
fn a_client_that_goes_away_leaves_no_job_behind() {
    let server = narrow();
    let mesh = long_job(300);
    let mut line = server.connect();
    line.say(format!(
        "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n",
        mesh.len()
    ));
    line.say(&mesh);
    let metric = |name: &str| {
        let text = server.admin("/metrics").text().unwrap();
        text.lines().find_map(|line| line.strip_prefix(&format!("{name} ")).map(str::to_owned))
    };
    let begun = Instant::now();
    while metric("meshmend_jobs_running").as_deref() != Some("1") {
        assert!(begun.elapsed() < Duration::from_secs(30), "the job does not run");
        std::thread::sleep(Duration::from_millis(10));
    }
    drop(line);
    let other = server.ended(&server.job("verify", SOLID));
    assert_eq!(other["state"], "succeeded");
    let text = server.admin("/metrics").text().unwrap();
    assert!(
        text.lines().any(|line| line.contains("jobs_finished_total") && line.contains("cancelled")),
        "{text}"
    );
}

#[test]
fn a_job_that_takes_longer_than_the_caller_allows_is_ended() {
    let server = Server::start();
    let request = server.post("/v1/verify").header("cancel-after", "0").body(long_job(300));
    let (status, code, _) = problem(request.send().unwrap());
    assert_eq!((status, code.as_str()), (504, "engine-timeout"));
    let request = server.post("/v1/verify").header("cancel-after", "soon").body(SOLID);
    let (status, code, problem) = problem(request.send().unwrap());
    assert_eq!(
        (status, code.as_str(), &problem["parameter"]),
        (400, "invalid-parameter", &json!("Cancel-After"))
    );
}

#[test]
fn a_deleted_job_is_not_found_any_more() {
    let server = narrow();
    let ended = server.ended(&server.job("repair", SOLID));
    let running = server.job("verify", long_job(300));
    for job in [&ended, &running] {
        let path = link(job, "self");
        let response = server.request("DELETE", path).send().unwrap();
        assert_eq!((response.status().as_u16(), response.text().unwrap().as_str()), (204, ""));
        for (method, path) in [
            ("GET", path.to_owned()),
            ("GET", format!("{path}/report")),
            ("GET", format!("{path}/result")),
            ("POST", format!("{path}/cancel")),
            ("DELETE", path.to_owned()),
        ] {
            let (status, code, _) = problem(server.request(method, &path).send().unwrap());
            assert_eq!((status, code.as_str()), (404, "not-found"), "{method} {path}");
        }
    }
}

#[test]
fn a_result_is_kept_for_its_time_and_then_gone() {
    let server = Server::start();
    let response = server.post("/v1/jobs?operation=repair&result_ttl=1").body(SOLID).send().unwrap();
    let job = server.ended(&response.json().unwrap());
    assert_eq!(job["state"], "succeeded");
    server.until(&job, |job| job["state"] == "expired");
    for name in ["report", "result"] {
        let (status, code, _) =
            problem(server.get(&format!("{}/{name}", link(&job, "self"))).send().unwrap());
        assert_eq!((status, code.as_str()), (410, "expired"));
    }
}

#[test]
fn a_job_that_has_not_changed_is_not_sent_again() {
    let server = Server::start();
    let job = server.ended(&server.job("verify", SOLID));
    let response = server.get(link(&job, "self")).send().unwrap();
    let etag = header(&response, "etag").to_owned();
    let again = server.get(link(&job, "self")).header("if-none-match", &etag).send().unwrap();
    assert_eq!((again.status().as_u16(), header(&again, "etag")), (304, etag.as_str()));
}

#[test]
fn a_result_can_be_read_in_parts_and_checked() {
    let server = Server::start();
    let job = server.ended(&server.job("repair", SOLID));
    let get = |name: &'static str, value: &str| {
        server.get(link(&job, "result")).header(name, value).send().unwrap()
    };
    let whole = server.get(link(&job, "result")).send().unwrap();
    let etag = header(&whole, "etag").to_owned();
    let digest = header(&whole, "repr-digest");
    assert!(digest.starts_with("sha-256=:") && digest.ends_with("=:"), "{digest}");
    assert_eq!(header(&whole, "accept-ranges"), "bytes");
    assert_eq!(header(&whole, "content-length"), SOLID.len().to_string());
    assert_eq!(whole.text().unwrap(), SOLID);

    let part = get("range", "bytes=4-7");
    assert_eq!(part.status(), 206);
    assert_eq!(header(&part, "content-range"), format!("bytes 4-7/{}", SOLID.len()));
    assert_eq!(part.text().unwrap(), &SOLID[4..=7]);
    assert_eq!(get("range", "bytes=-5").text().unwrap(), &SOLID[SOLID.len() - 5..]);

    let beyond = get("range", "bytes=9999-");
    assert_eq!(header(&beyond, "content-range"), format!("bytes */{}", SOLID.len()));
    assert_eq!(problem(beyond).1, "range-not-satisfiable");
    assert_eq!(get("if-none-match", &etag).status(), 304);
    let of_other =
        server.get(link(&job, "result")).header("range", "bytes=4-7").header("if-range", "\"other\"");
    assert_eq!(of_other.send().unwrap().status(), 200);

    let head = server.request("HEAD", link(&job, "result")).send().unwrap();
    assert_eq!(
        (head.status().as_u16(), header(&head, "content-length")),
        (200, SOLID.len().to_string().as_str())
    );
    assert_eq!(get("accept", "text/off").status(), 200);
    assert_eq!(problem(get("accept", "model/stl")).1, "not-acceptable");
}

#[test]
fn a_full_queue_says_when_to_come_again() {
    let server = Server::with(&["--slots", "1", "--queue-max", "1"]);
    let running = server.job("verify", long_job(300));
    server.until(&running, |job| job["state"] == "running");
    server.job("verify", SOLID);
    let response = server.post("/v1/verify").body(OPEN).send().unwrap();
    assert!(header(&response, "retry-after").parse::<u64>().unwrap() > 0);
    let (status, code, _) = problem(response);
    assert_eq!((status, code.as_str()), (429, "queue-full"));
}
