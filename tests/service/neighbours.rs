//! Callers beside each other: what one of them does, the others do not pay for.

use crate::meshes::{OPEN, SOLID, long_job};
use crate::server::{Server, header, link, problem};
use reqwest::blocking::Response;
use serde_json::{Value, json};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A file of keys, which are their holders' names.
fn keys(lines: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), lines).unwrap();
    file
}

fn repair(server: &Server, key: &str, mesh: impl Into<Vec<u8>>) -> Response {
    server.post("/v1/repair").bearer_auth(key).body(mesh.into()).send().unwrap()
}

fn job(server: &Server, key: &str, mesh: Vec<u8>) -> Response {
    server.post("/v1/jobs?operation=verify").bearer_auth(key).body(mesh).send().unwrap()
}

#[test]
fn one_who_floods_the_service_costs_another_no_answer_no_result_and_no_place() {
    let keys = keys("loud-key\nquiet-key\n");
    let path = keys.path().to_str().unwrap();
    let server = Server::with(&[
        "--api-keys-file",
        path,
        "--slots",
        "2",
        "--interactive-slots",
        "2",
        "--jobs-max",
        "20",
        "--queue-max",
        "8",
        "--interactive-deadline",
        "1s",
    ]);
    let kept: Value = job(&server, "quiet-key", OPEN.into()).json().unwrap();
    let own = |path: &str| server.get(path).bearer_auth("quiet-key").send().unwrap();
    let ended: Value = own(&format!("{}?wait=60", link(&kept, "self"))).json().unwrap();
    assert_eq!(ended["state"], "succeeded");
    let (is_over, refusals, floods) = (AtomicBool::new(false), AtomicUsize::new(0), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let (server, is_over, refusals, floods) = (&server, &is_over, &refusals, &floods);
            scope.spawn(move || {
                let mut number = thread;
                while !is_over.load(Ordering::SeqCst) {
                    number += 4;
                    // Large ones, small ones that are waited for and take long, and many that are answered at once.
                    let mut mesh = match thread {
                        0 => long_job(250),
                        1 => long_job(90),
                        _ => SOLID.into(),
                    };
                    mesh.extend(format!("# {number}\n").bytes().take(if thread < 2 { 0 } else { 99 }));
                    if thread < 2 {
                        mesh[..4].copy_from_slice(&u32::to_le_bytes(number));
                    }
                    let answer = match thread {
                        1 => {
                            let request = server.post("/v1/verify").header("prefer", "wait=1");
                            request.bearer_auth("loud-key").body(mesh).send().unwrap()
                        }
                        _ => job(server, "loud-key", mesh),
                    };
                    floods.fetch_add(1, Ordering::SeqCst);
                    if !answer.status().is_success() {
                        let (status, code, _) = problem(answer);
                        assert_eq!((status, code.as_str()), (429, "queue-full"));
                        refusals.fetch_add(1, Ordering::SeqCst);
                    }
                }
            });
        }
        // The flood is there: it is refused what is not its own.
        let begun = std::time::Instant::now();
        while refusals.load(Ordering::SeqCst) < 20 && begun.elapsed() < crate::server::PATIENCE {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let answers: Vec<_> =
            (0..6).map(|number| repair(&server, "quiet-key", format!("{OPEN}# {number}\n"))).collect();
        let waiting = job(&server, "quiet-key", long_job(31));
        is_over.store(true, Ordering::SeqCst);
        for answer in answers {
            assert_eq!((answer.status().as_u16(), header(&answer, "meshmend-outcome")), (200, "repaired"));
        }
        assert_eq!(waiting.status(), 202);
    });
    assert!(refusals.load(Ordering::SeqCst) >= 20, "{refusals:?} of {floods:?}");
    // Half of all that are kept may be its own.
    let listed: Value = own("/v1/jobs").json().unwrap();
    assert_eq!(listed["jobs"].as_array().unwrap().len(), 8, "{listed}");
    let kept: Value = own(link(&kept, "self")).json().unwrap();
    assert_eq!(kept["state"], "succeeded");
    assert_eq!(own(link(&kept, "report")).status(), 200);
}

#[test]
fn invalid_keys_are_counted_by_address_and_cost_their_sender_the_connection() {
    let keys = keys("good-key\n");
    let path = keys.path().to_str().unwrap();
    let server = Server::with(&["--api-keys-file", path, "--rate-per-minute", "1", "--rate-burst", "2"]);
    let ask = |key: &str| server.get("/v1/version").bearer_auth(key).send().unwrap();
    for _ in 0..2 {
        let refused = ask("wrong-key");
        assert_eq!(header(&refused, "connection"), "close");
        assert_eq!(problem(refused).1, "unauthenticated");
    }
    let refused = ask("another-wrong-key");
    assert!(!header(&refused, "retry-after").is_empty());
    assert_eq!(problem(refused).1, "rate-limited");
    assert_eq!(ask("good-key").status(), 200, "who has a key is not held to what others do at its address");
}

#[test]
fn there_is_a_limit_on_requests_unless_the_operator_says_otherwise() {
    let server = Server::with(&["--rate-per-minute", "1200", "--rate-burst", "240"]);
    let limits: Value = server.get("/v1/limits").send().unwrap().json().unwrap();
    assert_eq!((&limits["rate_per_minute"], &limits["rate_burst"]), (&json!(1200), &json!(240)));
    let shown = std::process::Command::new(env!("CARGO_BIN_EXE_meshmend"))
        .args(["config", "show"])
        .env_clear()
        .output()
        .unwrap();
    let shown = String::from_utf8(shown.stdout).unwrap();
    let row = shown.lines().find(|line| line.starts_with("rate_per_minute")).unwrap();
    assert!(row.contains("1_200") && row.ends_with("default"), "{row}");
}

#[test]
fn an_address_has_its_share_of_connections_and_no_more() {
    let server = Server::with(&["--connections-max", "4", "--header-timeout", "10min"]);
    let silent = [server.connect(), server.connect()];
    let mut third = server.connect();
    // Said to nobody: the connection is closed at once, long before its head would be late.
    third.try_say("GET /v1/version HTTP/1.1\r\n");
    assert!(third.is_closed());
    assert_eq!(server.admin("/livez").status(), 200);
    assert!(server.admin("/metrics").text().unwrap().contains("meshmend_http_connections_closed_total 1"));
    drop(silent);
    let answer = crate::server::patiently(|| server.get("/v1/version").send().ok());
    assert_eq!(answer.status(), 200);
}
