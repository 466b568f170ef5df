//! The list of jobs, their labels, and requests that are repeated.

use crate::meshes::{OPEN, SOLID, long_job};
use crate::server::{Server, header, link, problem};
use serde_json::{Value, json};

fn list(server: &Server, query: &str) -> Value {
    let response = server.get(&format!("/v1/jobs{query}")).send().unwrap();
    assert_eq!(response.status(), 200);
    response.json().unwrap()
}

fn ids(page: &Value) -> Vec<&str> {
    page["jobs"].as_array().unwrap().iter().map(|job| job["id"].as_str().unwrap()).collect()
}

#[test]
fn jobs_are_listed_the_latest_first_page_by_page() {
    let server = Server::start();
    assert_eq!(list(&server, ""), json!({"jobs": [], "next": null}));
    let mut made: Vec<_> =
        (0..5).map(|_| server.job("verify", SOLID)["id"].as_str().unwrap().to_owned()).collect();
    made.reverse();
    let first = list(&server, "?limit=3");
    assert_eq!(
        (ids(&first), first["next"].as_str()),
        (made[..3].iter().map(String::as_str).collect(), Some(&*made[2]))
    );
    let second = list(&server, &format!("?limit=3&cursor={}", made[2]));
    assert_eq!(
        (ids(&second), &second["next"]),
        (made[3..].iter().map(String::as_str).collect(), &Value::Null)
    );
    for wrong in ["?limit=0", "?limit=201", "?cursor=x", "?state=done", "?label=x", "?offset=1"] {
        assert_eq!(problem(server.get(&format!("/v1/jobs{wrong}")).send().unwrap()).0, 400, "{wrong}");
    }
}

#[test]
fn jobs_are_found_by_state_and_labels() {
    let server = Server::with(&["--slots", "1"]);
    let input = server.ended(&server.job("verify", SOLID));
    let body = json!({"operation": "repair", "labels": {"order": "17", "part": "lid"}, "input": {"job": input["id"]}});
    let response = server.post("/v1/jobs").json(&body).send().unwrap();
    assert_eq!(response.status(), 202);
    let lid: Value = response.json().unwrap();
    assert_eq!(lid["labels"], json!({"order": "17", "part": "lid"}));
    let path = "/v1/jobs?operation=analyze&labels=%7B%22order%22:%2217%22%7D";
    let other: Value = server.post(path).body(OPEN).send().unwrap().json().unwrap();
    server.ended(&lid);
    server.ended(&other);
    let (lid, other) = (lid["id"].as_str().unwrap(), other["id"].as_str().unwrap());
    assert_eq!(ids(&list(&server, "?label=order:17")), [other, lid]);
    assert_eq!(ids(&list(&server, "?label=order:17&label=part:lid&state=succeeded")), [lid]);
    assert_eq!(ids(&list(&server, "?label=order:17&state=failed")), [""; 0]);
    let wrong = json!({"operation": "repair", "labels": {"a b": "c"}, "input": {"job": input["id"]}});
    let (status, _, told) = problem(server.post("/v1/jobs").json(&wrong).send().unwrap());
    assert_eq!(
        (status, &told["parameter"], &told["limit_name"]),
        (400, &json!("labels"), &json!("labels_max"))
    );
}

#[test]
fn nobody_lists_the_jobs_of_another_key_or_meets_its_idempotency_keys() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(keys.path(), "key-of-alice\nkey-of-bob\n").unwrap();
    let server = Server::with(&["--api-keys-file", keys.path().to_str().unwrap()]);
    let make = |key: &str, mesh: &'static str| -> Value {
        let request = server.post("/v1/jobs?operation=verify").header("idempotency-key", "one");
        request.bearer_auth(key).body(mesh).send().unwrap().json().unwrap()
    };
    let (alice, bob) = (make("key-of-alice", SOLID), make("key-of-bob", OPEN));
    assert_ne!(alice["id"], bob["id"]);
    for (key, job) in [("key-of-alice", &alice), ("key-of-bob", &bob)] {
        let page: Value = server.get("/v1/jobs").bearer_auth(key).send().unwrap().json().unwrap();
        assert_eq!(ids(&page), [job["id"].as_str().unwrap()]);
    }
    let events = format!("{}/events", link(&alice, "self"));
    assert_eq!(problem(server.get(&events).bearer_auth("key-of-bob").send().unwrap()).1, "not-found");
}

#[test]
fn the_same_request_with_its_key_gives_the_same_job() {
    let server = Server::start();
    let ask = |key: &str, path: &str, mesh: &'static str| {
        server.post(path).header("idempotency-key", key).body(mesh).send().unwrap()
    };
    let ids = std::thread::scope(|scope| {
        let asked: Vec<_> = (0..12)
            .map(|_| {
                scope.spawn(|| {
                    ask("k", "/v1/jobs?operation=repair", SOLID).json::<Value>().unwrap()["id"].clone()
                })
            })
            .collect();
        asked.into_iter().map(|asked| asked.join().unwrap()).collect::<Vec<_>>()
    });
    assert!(ids.iter().all(|id| id == &ids[0]), "{ids:?}");
    assert_eq!(list(&server, "")["jobs"].as_array().unwrap().len(), 1);
    for (path, mesh) in [
        ("/v1/jobs?operation=repair", OPEN),
        ("/v1/jobs?operation=verify", SOLID),
        ("/v1/jobs?operation=repair&samples=1", SOLID),
    ] {
        let (status, code, _) = problem(ask("k", path, mesh));
        assert_eq!((status, code.as_str()), (422, "idempotency-key-reused"), "{path}");
    }
    let (status, _, told) = problem(ask("k k", "/v1/repair", SOLID));
    assert_eq!((status, &told["parameter"]), (400, &json!("Idempotency-Key")));
    // What is waited for is repeated in the same way.
    let (first, second) = (ask("w", "/v1/repair", OPEN), ask("w", "/v1/repair", OPEN));
    assert_eq!((first.status(), second.status()), (reqwest::StatusCode::OK, reqwest::StatusCode::OK));
    assert_eq!(header(&first, "link"), header(&second, "link"));
    assert_eq!(first.text().unwrap(), second.text().unwrap());
}

#[test]
fn a_client_that_can_come_back_for_its_job_may_go_away() {
    let server = Server::with(&["--slots", "1"]);
    let mesh = long_job(150);
    let mut line = server.connect();
    line.say(format!(
        "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nIdempotency-Key: later\r\nContent-Length: {}\r\n\r\n",
        mesh.len()
    ));
    line.say(&mesh);
    while list(&server, "?state=running")["jobs"] == json!([]) {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    drop(line);
    let request = server.post("/v1/verify").header("idempotency-key", "later").body(mesh);
    assert_eq!(request.send().unwrap().status(), 200);
    let page = list(&server, "");
    assert_eq!((ids(&page).len(), &page["jobs"][0]["state"]), (1, &json!("succeeded")));
}
