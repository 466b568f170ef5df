//! Webhooks: signed calls when jobs end.

use crate::meshes::{BROKEN, SOLID};
use crate::receiver::{Received, Receiver};
use crate::server::{Server, link, problem};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hmac::{Hmac, KeyInit as _, Mac as _};
use reqwest::blocking::multipart::{Form, Part};
use serde_json::{Value, json};

const SECRET: &str = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

/// A server that may call `receiver`.
fn server(receiver: &Receiver, settings: &[&str]) -> Server {
    let hosts = ["--webhooks", "--webhook-pause", "50ms", "--webhook-private-hosts", &receiver.host];
    Server::with(&[&hosts, settings].concat())
}

/// Makes a job with a webhook.
fn post(server: &Server, webhook: &Value, mesh: &str) -> reqwest::blocking::Response {
    let job = json!({ "operation": "verify", "webhook": webhook });
    let form = Form::new()
        .part("job", Part::text(job.to_string()).mime_str("application/json").unwrap())
        .part("mesh", Part::bytes(mesh.as_bytes().to_vec()));
    server.post("/v1/jobs").multipart(form).send().unwrap()
}

fn job(server: &Server, receiver: &Receiver, mesh: &str) -> Value {
    let webhook = json!({ "url": format!("http://{}/hook?token=7", receiver.host), "secret": SECRET });
    let response = post(server, &webhook, mesh);
    assert_eq!(response.status(), 202);
    response.json().unwrap()
}

/// The deliveries of a job, once `is_so`.
fn deliveries(server: &Server, job: &Value, is_so: impl Fn(&Value) -> bool) -> Value {
    let path = format!("{}/deliveries", link(job, "self"));
    crate::server::patiently(|| {
        let list: Value = server.get(&path).send().unwrap().json().unwrap();
        is_so(&list["deliveries"][0]).then(|| list["deliveries"].clone())
    })
}

/// The message of a call, whose signature must be right.
fn verified(call: &Received, secret: &str) -> Value {
    let key = STANDARD.decode(&secret["whsec_".len()..]).unwrap();
    let mut mac = Hmac::<sha2::Sha256>::new_from_slice(&key).unwrap();
    let (id, timestamp) = (call.header("webhook-id"), call.header("webhook-timestamp"));
    mac.update(format!("{id}.{timestamp}.{}", call.body).as_bytes());
    let expected = format!("v1,{}", STANDARD.encode(mac.finalize().into_bytes()));
    assert!(call.header("webhook-signature").split(' ').any(|one| one == expected), "{call:?}");
    assert_eq!(call.header("content-type"), "application/json");
    serde_json::from_str(&call.body).unwrap()
}

#[test]
fn the_end_of_a_job_is_told_once_in_a_signed_call_without_secrets() {
    let receiver = Receiver::answering(&[204]);
    let server = server(&receiver, &[]);
    for (mesh, event, state) in [(SOLID, "job.succeeded", "succeeded"), (BROKEN, "job.failed", "failed")] {
        let job = job(&server, &receiver, mesh);
        let call = receiver.next();
        assert_eq!(call.head.lines().next(), Some("POST /hook?token=7 HTTP/1.1"));
        let message = verified(&call, SECRET);
        assert_eq!((&message["type"], &message["data"]["state"]), (&json!(event), &json!(state)));
        assert_eq!(message["data"]["id"], job["id"]);
        assert!(!call.body.contains("token") && !call.body.contains("MfKQ"), "{}", call.body);
        let list = deliveries(&server, &job, |delivery| delivery["state"] == "delivered");
        assert_eq!(list.as_array().unwrap().len(), 1);
        assert_eq!(list[0]["id"], call.header("webhook-id"));
        assert_eq!(list[0]["url"], format!("http://{}/hook", receiver.host));
        assert_eq!((&list[0]["tries"][0]["status"], &list[0]["next_at"]), (&json!(204), &Value::Null));
        let shown = server.get(link(&job, "self")).send().unwrap().text().unwrap();
        assert!(!shown.contains("token") && !shown.contains("MfKQ"), "{shown}");
    }
    let metrics = server.admin("/metrics").text().unwrap();
    assert!(
        metrics.contains("meshmend_webhook_tries_total{answer=\"2xx\",then=\"delivered\"} 2"),
        "{metrics}"
    );
}

#[test]
fn a_call_that_is_not_taken_is_made_again_with_the_same_id_and_so_it_is_when_asked_for() {
    let receiver = Receiver::answering(&[500, 302, 200]);
    let server = server(&receiver, &[]);
    let job = job(&server, &receiver, SOLID);
    let calls = [receiver.next(), receiver.next(), receiver.next()];
    for call in &calls {
        verified(call, SECRET);
        assert_eq!(call.header("webhook-id"), calls[0].header("webhook-id"));
    }
    let list = deliveries(&server, &job, |delivery| delivery["state"] == "delivered");
    let statuses: Vec<_> =
        list[0]["tries"].as_array().unwrap().iter().map(|one| one["status"].clone()).collect();
    assert_eq!(statuses, [500, 302, 200]);

    let again = format!("{}/deliveries/{}/redeliver", link(&job, "self"), list[0]["id"].as_str().unwrap());
    let response = server.post(&again).send().unwrap();
    assert_eq!(response.status(), 202);
    assert_eq!(response.json::<Value>().unwrap()["state"], "pending");
    assert_eq!(receiver.next().header("webhook-id"), calls[0].header("webhook-id"));
    deliveries(&server, &job, |delivery| delivery["tries"].as_array().unwrap().len() == 4);
    let unknown = format!("{}/deliveries/msg_7/redeliver", link(&job, "self"));
    assert_eq!(problem(server.post(&unknown).send().unwrap()).1, "not-found");
}

#[test]
fn a_receiver_that_never_takes_it_is_given_up_and_one_that_is_gone_at_once() {
    let receiver = Receiver::answering(&[500, 500, 410]);
    let server = server(&receiver, &["--webhook-attempts-max", "2"]);
    for tries in [2, 1] {
        let job = job(&server, &receiver, SOLID);
        let list = deliveries(&server, &job, |delivery| delivery["state"] == "failed");
        assert_eq!(list[0]["tries"].as_array().unwrap().len(), tries, "{list}");
    }
}

#[test]
fn a_receiver_that_never_answers_holds_up_nobody_else() {
    let silent = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let receiver = Receiver::answering(&[204]);
    let hosts = format!("{},{}", receiver.host, silent.local_addr().unwrap());
    let server =
        Server::with(&["--webhooks", "--webhook-timeout", "5min", "--webhook-private-hosts", &hosts]);
    // More than are sent at one time.
    for number in 0..40 {
        let webhook =
            json!({ "url": format!("http://{}/{number}", silent.local_addr().unwrap()), "secret": SECRET });
        assert_eq!(post(&server, &webhook, SOLID).status(), 202);
    }
    let prompt = job(&server, &receiver, BROKEN);
    assert_eq!(verified(&receiver.next(), SECRET)["data"]["id"], prompt["id"]);
}

#[test]
fn the_secrets_of_the_server_sign_where_the_job_brings_none() {
    let receiver = Receiver::answering(&[200]);
    let old = format!("whsec_{}", STANDARD.encode([7; 32]));
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), format!("{SECRET}\n{old}\n")).unwrap();
    let server = server(&receiver, &["--webhook-secret-file", file.path().to_str().unwrap()]);
    let url = format!("http://{}/", receiver.host);
    assert_eq!(post(&server, &json!({ "url": url }), SOLID).status(), 202);
    let call = receiver.next();
    verified(&call, SECRET);
    verified(&call, &old);
}

#[test]
fn a_webhook_to_a_place_that_is_not_public_is_refused_before_the_job_is_made() {
    let receiver = Receiver::answering(&[]);
    let server = server(&receiver, &[]);
    for url in [
        "https://127.0.0.1/",
        "https://2130706433/",
        "https://[::ffff:169.254.169.254]/",
        "https://localhost./",
        "https://user:pass@shop.example/",
        "http://shop.example/",
        "file:///etc/passwd",
        "no url",
    ] {
        let (status, code, problem) = problem(post(&server, &json!({ "url": url, "secret": SECRET }), SOLID));
        assert_eq!(
            (status, code.as_str(), &problem["parameter"]),
            (422, "webhook-refused", &json!("webhook"))
        );
    }
    let no_secret = post(&server, &json!({ "url": "https://shop.example/" }), SOLID);
    assert_eq!(problem(no_secret).1, "webhook-refused");
    for webhook in [json!("https://shop.example/"), json!({ "uri": "https://shop.example/" })] {
        assert_eq!(problem(post(&server, &webhook, SOLID)).1, "invalid-parameter");
    }
    let metrics = server.admin("/metrics").text().unwrap();
    assert!(!metrics.contains("meshmend_jobs_finished_total"), "{metrics}");
}

#[test]
fn by_default_no_webhook_is_taken_and_only_jobs_take_one() {
    let server = Server::start();
    let webhook = json!({ "url": "https://shop.example/", "secret": SECRET });
    let (_, code, problem_) = problem(post(&server, &webhook, SOLID));
    assert!(code == "webhook-refused" && problem_["detail"].as_str().unwrap().contains("off"), "{problem_}");
    let params = Part::text(json!({ "webhook": webhook }).to_string()).mime_str("application/json").unwrap();
    let form = Form::new().part("params", params).part("mesh", Part::bytes(SOLID.as_bytes().to_vec()));
    assert_eq!(problem(server.post("/v1/verify").multipart(form).send().unwrap()).1, "unknown-parameter");
}

#[test]
fn a_name_that_leads_to_this_machine_is_not_called() {
    let server = Server::with(&["--webhooks", "--webhook-attempts-max", "1"]);
    // A name that does not exist, and so has no address at all: the call fails without one.
    let webhook = json!({ "url": "https://nowhere.invalid/", "secret": SECRET });
    let made: Value = post(&server, &webhook, SOLID).json().unwrap();
    let list = deliveries(&server, &made, |delivery| delivery["state"] == "failed");
    assert_eq!(
        (&list[0]["tries"][0]["status"], &list[0]["tries"][0]["error"]),
        (&Value::Null, &json!("no connection"))
    );
}
