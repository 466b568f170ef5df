//! How a mesh comes in, and what stops it.

use crate::meshes::{OPEN, SOLID, long_job};
use crate::server::{Server, header, link, problem};
use reqwest::blocking::multipart::{Form, Part};
use serde_json::{Value, json};
use std::time::Duration;

fn mesh() -> Part {
    Part::text(SOLID).file_name("part one.off")
}

fn params(text: &str) -> Part {
    Part::text(text.to_owned())
}

/// Status and code of the problem that `form` makes at `path`.
fn refused(server: &Server, path: &str, form: Form) -> (u16, String, Value) {
    problem(server.post(path).multipart(form).send().unwrap())
}

/// As [`refused`] where the answer comes before the form has been sent, at which the client here may give up by itself.
fn refused_early(server: &Server, form: impl Fn() -> Form) -> (u16, String, Value) {
    let tries = (0..10).map(|_| server.post("/v1/repair").multipart(form()).send());
    problem(tries.filter_map(Result::ok).next().unwrap())
}

#[test]
fn a_form_brings_the_mesh_and_its_options_in_any_order() {
    let server = Server::start();
    let options = || params(r#"{"output_format":"stl","units":"cm"}"#);
    for form in [
        Form::new().part("mesh", mesh()).part("params", options()),
        Form::new().part("params", options()).part("mesh", mesh()),
        Form::new().part("material", Part::text("newmtl a\n")).part("params", options()).part("mesh", mesh()),
    ] {
        let response = server.post("/v1/repair").multipart(form).send().unwrap();
        assert_eq!(response.status(), 200);
        assert_eq!(response.headers()["content-type"], "model/stl");
        let name = response.headers()["content-disposition"].to_str().unwrap();
        assert!(name.contains("part one") && name.contains(".stl"), "{name}");
    }
}

#[test]
fn a_result_keeps_the_letters_of_the_name_of_its_file() {
    let server = Server::start();
    // As curl and browsers send it.
    let form = format!(
        "--b\r\nContent-Disposition: form-data; name=\"mesh\"; filename=\"Stück 1.off\"\r\n\r\n{SOLID}\r\n--b--\r\n"
    );
    let request = server.post("/v1/repair").header("content-type", "multipart/form-data; boundary=b");
    let response = request.body(form).send().unwrap();
    assert_eq!(
        header(&response, "content-disposition"),
        "attachment; filename=\"St_ck 1.off\"; filename*=UTF-8''St%C3%BCck%201.off"
    );
}

#[test]
fn a_form_that_is_not_as_it_should_be_is_a_problem() {
    let server = Server::start();
    let code = |form| {
        let (status, code, problem) = refused(&server, "/v1/repair", form);
        (status, code, problem["parameter"].as_str().unwrap_or_default().to_owned())
    };
    let is = |code: &str, parameter: &str| (400, code.to_owned(), parameter.to_owned());
    let whole = || Form::new().part("mesh", mesh());
    assert_eq!(code(Form::new()), is("body-incomplete", ""));
    assert_eq!(code(Form::new().part("params", params("{}"))), is("invalid-parameter", "mesh"));
    assert_eq!(code(Form::new().part("mesh", Part::text(""))), is("invalid-parameter", "mesh"));
    assert_eq!(code(whole().part("mesh", mesh())), is("invalid-parameter", "mesh"));
    assert_eq!(code(whole().part("units", params("cm"))), is("unknown-parameter", "units"));
    assert_eq!(code(whole().part("params", params("{"))), is("invalid-parameter", ""));
    assert_eq!(code(whole().part("params", params(r#"{"unit":"cm"}"#))), is("unknown-parameter", "unit"));
    assert_eq!(code(whole().part("params", params(r#"{"units":7}"#))), is("invalid-parameter", "units"));
    assert_eq!(
        code(whole().part("params", params(r#"{"operation":"verify"}"#))),
        is("invalid-parameter", "operation")
    );
}

#[test]
fn the_material_of_an_obj_colours_its_faces() {
    let server = Server::start();
    let obj =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nusemtl none\nf 1 4 3\nf 2 3 4\n";
    let job = |material: &'static str| {
        let form = Form::new()
            .part("mesh", Part::text(obj))
            .part("params", params(r#"{"operation":"convert","output_format":"off"}"#))
            .part("material", Part::text(material));
        let response = server.post("/v1/jobs").multipart(form).send().unwrap();
        server.ended(&response.json().unwrap())
    };
    let result = |job: &Value| server.get(link(job, "result")).send().unwrap().text().unwrap();
    let red = job("newmtl red\nKd 1 0 0\n");
    assert!(result(&red).contains("3 0 2 1 1.0 0.0 0.0\n"), "{}", result(&red));
    // Another material is another job, and an upload is used again with its material.
    assert!(result(&job("newmtl red\nKd 0 0 1\n")).contains("3 0 2 1 0.0 0.0 1.0\n"));
    let input = json!({ "job": red["id"] });
    let again =
        server.post("/v1/convert").json(&json!({ "input": input, "output_format": "off", "samples": 1 }));
    assert_eq!(again.send().unwrap().text().unwrap(), result(&red));

    let broken = job("newmtl red\nKd 1.0\n");
    assert_eq!(
        (&broken["state"], &broken["problem"]["code"]),
        (&json!("failed"), &json!("mesh-unparseable"))
    );
    assert!(broken["problem"]["detail"].as_str().unwrap().contains("material"), "{broken}");
}

#[test]
fn query_and_body_may_agree_but_not_contradict_each_other() {
    let server = Server::start();
    let send = |query: &str, text: &str| {
        let form = Form::new().part("mesh", mesh()).part("params", params(text));
        server.post(&format!("/v1/verify?{query}")).multipart(form).send().unwrap()
    };
    assert_eq!(send("units=cm&samples=3", r#"{"units":"cm"}"#).status(), 200);
    let (status, code, problem) = problem(send("units=cm", r#"{"units":"mm"}"#));
    assert_eq!((status, code.as_str(), &problem["parameter"]), (400, "invalid-parameter", &json!("units")));
}

#[test]
fn an_earlier_upload_is_used_again() {
    let server = Server::start();
    let first = server.ended(&server.job("analyze", SOLID));
    let input = json!({ "job": first["id"] });
    let again = server.post("/v1/repair").json(&json!({ "input": input, "output_format": "stl" }));
    let response = again.send().unwrap();
    assert_eq!(
        (response.status().as_u16(), &response.headers()["content-type"]),
        (200, &"model/stl".parse().unwrap())
    );
    let query = format!("/v1/verify?input=%7B%22job%22:{}%7D", first["id"]).replace('"', "%22");
    assert_eq!(server.post(&query).send().unwrap().status(), 200);
    let job = server.post("/v1/jobs").json(&json!({ "operation": "verify", "params": { "input": input } }));
    assert_eq!(job.send().unwrap().status(), 202);

    let unknown = json!({ "input": { "job": "00000000-0000-7000-8000-000000000000" } });
    let (status, code, _) = problem(server.post("/v1/repair").json(&unknown).send().unwrap());
    assert_eq!((status, code.as_str()), (404, "not-found"));
    let (status, code, _) = problem(server.post("/v1/repair").json(&json!({})).send().unwrap());
    assert_eq!((status, code.as_str()), (400, "invalid-parameter"));
    let both = server.post(&query).body(SOLID);
    assert_eq!(problem(both.send().unwrap()).1, "invalid-parameter");
}

#[test]
fn a_job_says_its_operation_in_the_query_the_form_or_json() {
    let server = Server::start();
    let job = |part: &'static str, text: &str| {
        let form = Form::new().part("mesh", mesh()).part(part, params(text));
        server.post("/v1/jobs").multipart(form).send().unwrap()
    };
    for response in [
        job("job", r#"{"operation":"verify"}"#),
        job("params", r#"{"operation":"verify","units":"in"}"#),
        server.post("/v1/jobs?operation=verify").body(SOLID).send().unwrap(),
    ] {
        assert_eq!(response.status(), 202);
        let location = response.headers()["location"].to_str().unwrap().to_owned();
        let job: Value = response.json().unwrap();
        assert_eq!(location, link(&job, "self"));
        assert_eq!(
            (&job["operation"], &server.ended(&job)["state"]),
            (&json!("verify"), &json!("succeeded"))
        );
    }
    for response in [
        server.post("/v1/jobs").body(SOLID).send().unwrap(),
        server.post("/v1/jobs?operation=repiar").body(SOLID).send().unwrap(),
        job("job", r#"{"units":"mm"}"#),
    ] {
        let (status, code, problem) = problem(response);
        assert_eq!(
            (status, code.as_str(), &problem["parameter"]),
            (400, "invalid-parameter", &json!("operation"))
        );
    }
}

#[test]
fn a_request_without_a_mesh_is_told_how_to_send_one() {
    let server = Server::start();
    let (status, code, problem) = problem(server.post("/v1/repair").send().unwrap());
    assert_eq!((status, code.as_str()), (422, "mesh-empty"));
    assert!(problem["detail"].as_str().unwrap().contains("--data-binary"));
}

#[test]
fn a_media_type_that_is_not_read_is_refused() {
    let server = Server::start();
    for content_type in ["text/html", "image/png", "multipart/form-data", "application/xml"] {
        let request = server.post("/v1/repair").header("content-type", content_type).body(SOLID);
        let (status, code, _) = problem(request.send().unwrap());
        assert_eq!((status, code.as_str()), (415, "unsupported-media-type"), "{content_type}");
    }
}

#[test]
fn a_body_that_is_announced_too_large_is_refused_before_it_is_sent() {
    let server = Server::with(&["--upload-bytes-max", "1000B"]);
    let mut line = server.connect();
    line.say(
        "POST /v1/repair HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1001\r\nExpect: 100-continue\r\n\r\n",
    );
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 413 "), "no 100 Continue: {answer}");
    assert!(
        answer.contains("body-too-large") && answer.contains("\"limit\":1000,\"actual\":1001"),
        "{answer}"
    );
}

#[test]
fn a_client_that_is_told_to_go_on_goes_on() {
    let server = Server::start();
    let mut line = server.connect();
    line.say(format!(
        "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\nExpect: 100-continue\r\n\
         Connection: close\r\n\r\n",
        SOLID.len()
    ));
    let go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    assert_eq!(line.hear(go_on.len()), go_on);
    line.say(SOLID);
    assert!(line.hear_all().starts_with("HTTP/1.1 200 "));
}

#[test]
fn a_client_that_sends_too_much_reads_its_413_all_the_same() {
    let server = Server::with(&["--upload-bytes-max", "100KiB"]);
    let heads = [
        "Transfer-Encoding: chunked\r\n\r\n".to_owned(),
        // Announced, but without waiting for leave.
        format!("Content-Length: {}\r\n\r\n", 400 << 10),
    ];
    for head in heads {
        let mut line = server.connect();
        line.say(format!("POST /v1/repair HTTP/1.1\r\nHost: localhost\r\n{head}"));
        let piece = if head.starts_with('T') {
            format!("10000\r\n{}\r\n", "0".repeat(0x10000))
        } else {
            "0".repeat(0x10000)
        };
        // All of it is said before anything is heard, as many clients do.
        for _ in 0..6 {
            assert!(line.try_say(&piece), "the server hung up");
        }
        let answer = line.hear_all();
        assert!(answer.starts_with("HTTP/1.1 413 ") && answer.contains("body-too-large"), "{answer}");
        assert!(answer.contains("application/problem+json"));
    }
}

#[test]
fn a_small_upload_that_is_refused_keeps_its_connection_and_a_large_one_is_told_that_it_ends() {
    let server = Server::with(&["--slots", "1", "--interactive-slots", "0", "--queue-max", "1"]);
    let running = server.job("verify", long_job(400));
    server.until(&running, |job| job["state"] == "running");
    server.job("repair", SOLID);
    let head = |bytes: usize, more: &str| {
        format!("POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: {bytes}\r\n{more}\r\n")
    };
    let mut line = server.connect();
    line.say(head(SOLID.len(), "") + SOLID);
    line.say(head(SOLID.len(), "Connection: close\r\n") + SOLID);
    let answers = line.hear_all();
    assert_eq!(answers.matches("HTTP/1.1 429 ").count(), 2, "{answers}");
    assert_eq!(answers.matches("retry-after: ").count(), 2, "{answers}");
    let mut line = server.connect();
    line.say(head(9_000_000, "") + "OFF");
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 429 ") && answer.contains("connection: close"), "{answer}");
}

#[test]
fn with_a_full_queue_who_asks_first_sends_nothing_and_who_repeats_a_request_gets_its_job() {
    let server = Server::with(&["--slots", "1", "--interactive-slots", "0", "--queue-max", "1"]);
    let running = server.job("verify", long_job(400));
    server.until(&running, |job| job["state"] == "running");
    let ask = |key: &str, mesh: &'static str| {
        let request = server.post("/v1/jobs?operation=verify").header("idempotency-key", key);
        request.body(mesh).send().unwrap()
    };
    let queued: Value = ask("one", SOLID).json().unwrap();
    let form = "Content-Type: multipart/form-data; boundary=cut\r\n";
    for (bytes, more) in [(SOLID.len(), ""), (9_000_000, ""), (9_000_000, form)] {
        let mut line = server.connect();
        line.say(format!(
            "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: {bytes}\r\nExpect: 100-continue\r\n{more}\r\n"
        ));
        let answer = line.hear_all();
        assert!(answer.starts_with("HTTP/1.1 429 "), "no 100 Continue: {answer}");
    }
    let again: Value = ask("one", SOLID).json().unwrap();
    assert_eq!(again["id"], queued["id"]);
    assert_eq!(problem(ask("one", OPEN)).1, "idempotency-key-reused");
    assert_eq!(problem(ask("two", SOLID)).1, "queue-full");
}

#[test]
fn a_form_over_the_limit_is_refused_while_it_comes_in() {
    let server = Server::with(&["--upload-bytes-max", "100KiB"]);
    let large = || Part::bytes(vec![b'0'; 200 << 10]).file_name("large.stl");
    let (status, code, problem) = refused_early(&server, || Form::new().part("mesh", large()));
    assert_eq!((status, code.as_str(), &problem["limit"]), (413, "body-too-large", &json!(100 << 10)));
    let long = || params(&" ".repeat((1 << 20) + 4096));
    let (status, code, problem) = refused_early(&server, || Form::new().part("params", long()));
    assert_eq!(
        (status, code.as_str(), &problem["limit_name"]),
        (413, "body-too-large", &json!("json_bytes_max"))
    );
}

#[test]
fn a_body_that_pauses_for_too_long_is_given_up() {
    let server = Server::with(&["--upload-timeout", "300ms"]);
    let mut line = server.connect();
    line.say("POST /v1/repair HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\nOFF\n");
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 408 ") && answer.contains("upload-timeout"), "{answer}");
}

#[test]
fn a_body_that_drips_for_too_long_is_given_up() {
    let server = Server::with(&["--upload-total-timeout", "500ms"]);
    let mut line = server.connect();
    line.say("POST /v1/repair HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n");
    for _ in 0..20 {
        if !line.try_say("0") {
            break;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 408 ") && answer.contains("upload_total_timeout_s"), "{answer}");
}

#[test]
fn a_body_with_broken_chunks_is_a_problem() {
    let server = Server::start();
    let mut line = server.connect();
    line.say(
        "POST /v1/repair HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nxyz\r\nOFF\r\n",
    );
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 400 ") && answer.contains("body-incomplete"), "{answer}");
}

#[test]
fn a_part_named_file_is_the_mesh() {
    let server = Server::start();
    let form = Form::new().part("file", mesh());
    let report: Value = server.post("/v1/verify").multipart(form).send().unwrap().json().unwrap();
    assert_eq!(report["verdict"]["printable"], true);
    let (_, code, problem) =
        refused(&server, "/v1/verify", Form::new().part("file", mesh()).part("mesh", mesh()));
    assert_eq!((&*code, &problem["parameter"]), ("invalid-parameter", &json!("mesh")));
}

/// `text` as gzip without compression: one stored block.
fn gzip(text: &[u8]) -> Vec<u8> {
    let crc = !text.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
    });
    let len = u16::try_from(text.len()).unwrap();
    let mut bytes = vec![0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255, 1];
    bytes.extend([len, !len].iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend_from_slice(text);
    bytes.extend([crc, u32::from(len)].iter().flat_map(|n| n.to_le_bytes()));
    bytes
}

#[test]
fn a_compressed_body_is_taken_and_counts_by_what_it_holds() {
    let server = Server::with(&["--upload-bytes-max", "1KiB"]);
    let send = |body: Vec<u8>, encoding: &str| {
        server.post("/v1/verify").header("content-encoding", encoding).body(body).send().unwrap()
    };
    let report: Value = send(gzip(SOLID.as_bytes()), "gzip").json().unwrap();
    assert_eq!(
        (&report["verdict"]["printable"], &report["input"]["bytes"]),
        (&json!(true), &json!(SOLID.len()))
    );
    let (first, second) = SOLID.split_at(SOLID.len() / 2);
    let members = [gzip(first.as_bytes()), gzip(second.as_bytes())].concat();
    let report: Value = send(members, "gzip").json().unwrap();
    assert_eq!(report["input"]["bytes"], json!(SOLID.len()), "two members");
    let large = [SOLID.as_bytes(), &[b'#'; 2000]].concat();
    assert_eq!(problem(send(gzip(&large), "gzip")).1, "body-too-large");
    let packed = gzip(SOLID.as_bytes());
    let mut damaged = packed.clone();
    damaged[packed.len() - 8] ^= 1;
    for (body, what) in [(packed[..40].to_vec(), "its data ends early; "), (damaged, "its data is damaged; ")]
    {
        let (_, code, told) = problem(send(body, "gzip"));
        let detail = told["detail"].as_str().unwrap();
        assert_eq!(code, "body-incomplete");
        assert!(detail.starts_with(&format!("the body is compressed with gzip, but {what}")), "{detail}");
    }
    let (status, code, told) = problem(send(SOLID.into(), "br"));
    assert_eq!(
        (status, &*code, &told["allowed"]),
        (415, "unsupported-media-type", &json!(["gzip", "identity"]))
    );
    // Compressed by its maker and not said to be so.
    let (status, code, told) =
        problem(server.post("/v1/verify").body(gzip(SOLID.as_bytes())).send().unwrap());
    assert_eq!((status, &*code), (422, "mesh-unparseable"));
    assert!(told["detail"].as_str().unwrap().contains("this is gzip, which is not read here"), "{told}");
}
