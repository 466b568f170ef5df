//! What the log tells, and what it does not.

use crate::meshes::SOLID;
use crate::server::Server;
use reqwest::blocking::multipart::{Form, Part};
use serde_json::Value;

/// A mesh that cannot be read, with a coordinate that stands nowhere else.
const BROKEN: &str = "OFF 3 1 0\n0 0 0\n1 0 0\n0 secretword 71.2345678\n3 0 1 2\n";

#[test]
fn no_key_file_name_coordinate_query_or_secret_is_in_the_log() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(keys.path(), "the-very-key\n").unwrap();
    let keys = keys.path().to_str().unwrap();
    let settings = ["--api-keys-file", keys, "--log", "debug", "--webhooks", "--webhook-attempts-max", "1"];
    let server = Server::with(&settings);
    let secret = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";
    let url = "https://unknown-host.invalid/hook?token=tokenword";
    let job = serde_json::json!({ "operation": "repair", "webhook": { "url": url, "secret": secret } });
    let mut ended = Vec::new();
    for mesh in [BROKEN.to_owned(), SOLID.replace("1 0 0", "71.2345678 0 0")] {
        let form = Form::new()
            .part("job", Part::text(job.to_string()).mime_str("application/json").unwrap())
            .part("mesh", Part::bytes(mesh.into_bytes()).file_name("customerword.off"));
        let made = server.post("/v1/jobs").bearer_auth("the-very-key").multipart(form).send().unwrap();
        let made: Value = made.json().unwrap();
        let id = made["id"].as_str().unwrap_or_else(|| panic!("{made}")).to_owned();
        let path = format!("/v1/jobs/{id}?wait=60&");
        assert_eq!(server.get(&path).bearer_auth("the-very-key").send().unwrap().status(), 200);
        server.logged(&["webhook tried", &id]);
        ended.push(id);
    }
    server.get("/v1/limits?a=queryword").bearer_auth("the-very-key").send().unwrap();
    server.get("/v1/limits").bearer_auth("a-wrong-key").send().unwrap();
    server.logged(&["status=401"]);
    let log = server.log();
    for word in [
        "the-very-key",
        "a-wrong-key",
        "customerword",
        "secretword",
        "71.2345678",
        "queryword",
        "tokenword",
        "MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw",
    ] {
        assert!(!log.contains(word), "{word} is in {log}");
    }
}

#[test]
fn a_request_and_its_job_have_one_line_each_with_what_leads_from_one_to_the_other() {
    let server = Server::with(&["--log-format", "json"]);
    let trace = "4bf92f3577b34da6a3ce929d0e0e4736";
    let request = server
        .post("/v1/verify")
        .header("x-request-id", "seven")
        .header("traceparent", format!("00-{trace}-00f067aa0ba902b7-01"))
        .body(SOLID);
    assert_eq!(request.send().unwrap().status(), 200);
    let line =
        |words: &[&str]| serde_json::from_str::<Value>(&server.logged(words)).unwrap()["fields"].clone();
    let answered = line(&["answered", "seven"]);
    assert_eq!((&answered["method"], &answered["route"]), (&"POST".into(), &"/v1/verify".into()));
    assert_eq!((&answered["status"], &answered["trace"]), (&200.into(), &trace.into()));
    assert_eq!(answered["bytes_in"], SOLID.len());
    assert!(answered["ms"].as_f64().unwrap() > 0.0 && answered["bytes_out"].as_u64().unwrap() > 100);
    let job = answered["job"].as_str().unwrap();
    let ended = line(&["job ended", job]);
    assert_eq!((&ended["operation"], &ended["state"]), (&"verify".into(), &"succeeded".into()));
    assert_eq!((&ended["bytes_in"], &ended["trace"]), (&SOLID.len().into(), &trace.into()));
    assert!(ended["ms"].as_f64().unwrap() > 0.0 && ended["queued_ms"].as_f64().is_some());
    assert_eq!(server.log().matches("job ended").count(), 1);
}
