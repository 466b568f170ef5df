//! Connections that say nothing or half of something, too many of them, and the end of the service.

use crate::meshes::{SOLID, long_job};
use crate::server::{Server, link, problem};
use serde_json::Value;
use std::time::{Duration, Instant};

const HEAD: &str = "GET /v1/version HTTP/1.1\r\nHost: localhost\r\n";

#[test]
fn a_connection_that_does_not_finish_a_head_in_time_is_closed() {
    let server = Server::with(&["--header-timeout", "300ms"]);
    let mut silent = server.connect();
    let mut half = server.connect();
    half.say(HEAD);
    let mut dripping = server.connect();
    let drip = std::thread::spawn(move || {
        // One byte at a time keeps no head alive.
        for byte in HEAD.bytes().cycle().take(100) {
            if !dripping.try_say([byte]) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        false
    });
    let begun = Instant::now();
    assert_eq!(silent.hear_all(), "");
    half.hear_all();
    assert!(begun.elapsed() < Duration::from_secs(20));
    assert!(drip.join().unwrap(), "a dripping head is cut");
}

#[test]
fn a_connection_that_is_idle_between_two_requests_is_closed() {
    let server = Server::with(&["--header-timeout", "300ms"]);
    let mut line = server.connect();
    line.say(format!("{HEAD}\r\n"));
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
}

#[test]
fn one_connection_answers_one_request_after_another() {
    let server = Server::start();
    let mut line = server.connect();
    line.say(format!("{HEAD}\r\n{HEAD}\r\n{HEAD}Connection: close\r\n\r\n"));
    assert_eq!(line.hear_all().matches("HTTP/1.1 200 OK").count(), 3);
}

#[test]
fn connections_over_the_limit_wait_for_a_place() {
    let server = Server::with(&["--connections-max", "1", "--header-timeout", "1s"]);
    let mut first = server.connect();
    let mut second = server.connect();
    second.say(format!("{HEAD}Connection: close\r\n\r\n"));
    let begun = Instant::now();
    // The first one says nothing and is closed in the end; only then is the second one answered.
    assert_eq!(first.hear_all(), "");
    assert!(second.hear_all().starts_with("HTTP/1.1 200 "));
    assert!(begun.elapsed() >= Duration::from_millis(500));
    // The admin listener has places of its own.
    assert_eq!(server.admin("/livez").status(), 200);
}

#[test]
fn many_bad_connections_do_not_stop_normal_requests_and_all_of_them_end() {
    let server =
        Server::with(&["--header-timeout", "2s", "--upload-timeout", "2s", "--upload-rate-min", "1KiB"]);
    let mut bad: Vec<_> = (0..150).map(|_| server.connect()).collect();
    for (number, line) in bad.iter_mut().enumerate() {
        match number % 3 {
            0 => {}
            1 => line.say(HEAD),
            _ => line.say("POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999\r\n\r\nsome"),
        }
    }
    for _ in 0..20 {
        assert_eq!(server.post("/v1/verify").body(SOLID).send().unwrap().status(), 200);
    }
    for (number, mut line) in bad.into_iter().enumerate() {
        let answer = line.hear_all();
        if number % 3 == 2 {
            assert!(answer.starts_with("HTTP/1.1 408 ") && answer.contains("upload-timeout"), "{answer}");
        }
    }
}

#[test]
fn an_upload_that_drips_is_ended_although_it_never_pauses() {
    let server = Server::with(&["--upload-timeout", "1s", "--upload-rate-min", "1MiB"]);
    let mut line = server.connect();
    line.say("POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999\r\n\r\n");
    let begun = Instant::now();
    while line.try_say("x") && begun.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(100));
    }
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 408 ") && answer.contains("upload_rate_min"), "{answer}");
}

#[test]
fn garbage_ends_its_connection_and_nothing_else() {
    let server = Server::start();
    for garbage in
        [&b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"[..], b"GET / HTTP/9.9\r\n\r\n", b"\0\0\0\0\r\n\r\n"]
    {
        let mut line = server.connect();
        line.say(garbage);
        let answer = line.hear_all();
        assert!(answer.is_empty() || answer.starts_with("HTTP/1.1 400 "), "{answer}");
    }
    assert_eq!(server.get("/v1/version").send().unwrap().status(), 200);
}

#[test]
fn a_signal_ends_the_service_after_what_is_under_way() {
    let mut server = Server::start();
    assert_eq!(server.admin("/readyz").status(), 200);
    let mut line = server.connect();
    let mesh = long_job(100);
    line.say(format!(
        "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n",
        mesh.len()
    ));
    line.say(&mesh);
    until_jobs_run(&server);
    server.signal("TERM");
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 200 "), "{answer:.500}");
    assert_eq!(server.exit_code(), Some(0));
}

#[test]
fn while_the_service_ends_it_is_not_ready_and_takes_no_jobs() {
    let mut server = Server::with(&["--slots", "1"]);
    let running = server.job("verify", long_job(500));
    server.until(&running, |job| job["state"] == "running");
    // Kept open over the signal, with half a request on it.
    let mut line = server.connect();
    line.say("POST /v1/verify HTTP/1.1\r\nHost: localhost\r\n");
    std::thread::sleep(Duration::from_millis(100));
    server.signal("TERM");
    let begun = Instant::now();
    while server.admin("/readyz").status() != 503 {
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
    assert_eq!(server.admin("/livez").status(), 200);
    assert_eq!(problem(server.admin("/readyz")).1, "draining");
    line.say(format!("Content-Length: {}\r\n\r\n{SOLID}", SOLID.len()));
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 503 ") && answer.contains("draining"), "{answer}");
    server.signal("TERM");
    server.exit_code();
}

#[test]
fn a_second_signal_ends_the_service_at_once() {
    let mut server = Server::start();
    let running = server.job("verify", long_job(700));
    server.until(&running, |job| job["state"] == "running");
    server.signal("TERM");
    server.signal("INT");
    let begun = Instant::now();
    server.exit_code();
    assert!(begun.elapsed() < Duration::from_secs(10), "not after the grace of 25 s");
}

fn until_jobs_run(server: &Server) {
    let begun = Instant::now();
    let is_running = || server.admin("/metrics").text().unwrap().contains("meshmend_jobs_running 1");
    while !is_running() {
        assert!(begun.elapsed() < Duration::from_secs(30), "the job does not run");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn many_requests_at_one_time_are_all_answered() {
    let server = Server::start();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..16)
            .map(|_| {
                scope.spawn(|| {
                    let job: Value = server.job("verify", SOLID);
                    server
                        .get(&format!("{}?wait=30", link(&job, "self")))
                        .send()
                        .unwrap()
                        .json::<Value>()
                        .unwrap()
                })
            })
            .collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap()["state"], "succeeded");
        }
    });
}
