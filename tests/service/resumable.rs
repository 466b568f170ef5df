//! Uploads that come before their job, in pieces (tus), on one server and on several.

use std::sync::Arc;

use reqwest::blocking::{Client, Response};
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::meshes::{OPEN, SOLID};
use crate::server::{Line, Server, header, is, link, patiently, problem, refused};
use crate::town::Town;

/// What counts at one time of what comes quickly.
const PIECE_BYTES: usize = 8 << 20;
const BYTES: &str = "application/offset+octet-stream";

/// A mesh of `bytes` bytes, no two lines of which are the same.
fn padded(mesh: &str, bytes: usize) -> Vec<u8> {
    let mut text = mesh.as_bytes().to_vec();
    let mut number = 0_u64;
    while text.len() + 64 < bytes {
        text.extend(format!("# line {number:055}\n").bytes());
        number += 1;
    }
    text.push(b'#');
    text.resize(bytes - 1, b'.');
    text.push(b'\n');
    text
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Begins an upload. Its path.
fn create(server: &Server, length: usize) -> String {
    let answer = server
        .post("/v1/uploads")
        .header("tus-resumable", "1.0.0")
        .header("upload-length", length.to_string())
        .header("upload-metadata", "filename cGFydCBvbmUub2Zm")
        .send()
        .unwrap();
    assert_eq!((answer.status().as_u16(), header(&answer, "tus-resumable")), (201, "1.0.0"));
    header(&answer, "location").to_owned()
}

fn tus(server: &Server, method: &str, path: &str) -> reqwest::blocking::RequestBuilder {
    server.request(method, path).header("tus-resumable", "1.0.0")
}

fn patch(server: &Server, path: &str, at: usize, bytes: &[u8]) -> Response {
    let request = tus(server, "PATCH", path).header("upload-offset", at.to_string());
    request.header("content-type", BYTES).body(bytes.to_vec()).send().unwrap()
}

/// Where the upload stands.
fn offset(server: &Server, path: &str) -> usize {
    let answer = tus(server, "HEAD", path).send().unwrap();
    assert_eq!((answer.status().as_u16(), header(&answer, "cache-control")), (200, "no-store"));
    header(&answer, "upload-offset").parse().unwrap()
}

/// A connection on which these bytes of the upload are sent, of a request that announces so many.
fn sending(server: &Server, path: &str, at: usize, bytes: &[u8], announced: usize) -> Line {
    let mut line = server.connect();
    line.say(format!(
        "PATCH {path} HTTP/1.1\r\nHost: localhost\r\nTus-Resumable: 1.0.0\r\nUpload-Offset: {at}\r\n\
         Content-Type: {BYTES}\r\nContent-Length: {announced}\r\n\r\n"
    ));
    line.say(bytes);
    line
}

/// The request that names an upload.
fn input(path: &str) -> Value {
    json!({ "input": { "upload": path.rsplit('/').next().unwrap() } })
}

#[test]
fn an_upload_goes_on_where_a_broken_connection_left_it_and_is_repaired() {
    let server = Server::start();
    let mesh = padded(OPEN, 3 << 20);
    let path = create(&server, mesh.len());
    assert_eq!(offset(&server, &path), 0);
    let mut at = 0;
    for sent in [1, 700_001, 1 << 20] {
        // It breaks before all has come.
        drop(sending(&server, &path, at, &mesh[at..at + sent], mesh.len() - at));
        at += sent;
        patiently(|| (offset(&server, &path) == at).then_some(()));
    }
    let unfinished = server.post("/v1/repair").json(&input(&path)).send().unwrap();
    let (status, code, told) = problem(unfinished);
    assert_eq!((status, code.as_str(), &told["parameter"]), (409, "upload-unfinished", &json!("input")));
    let done = patch(&server, &path, at, &mesh[at..]);
    assert_eq!((done.status().as_u16(), header(&done, "upload-offset")), (204, &*mesh.len().to_string()));
    assert!(header(&done, "upload-expires").ends_with(" GMT"));
    // What it was made of is for this user alone.
    for file in server.stored_files() {
        use std::os::unix::fs::PermissionsExt as _;
        assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o600);
    }
    let report: Value = server.post("/v1/analyze").json(&input(&path)).send().unwrap().json().unwrap();
    assert_eq!(report["input"]["sha256"], *digest(&mesh), "{report}");
    let repaired = server.post("/v1/repair").json(&input(&path)).send().unwrap();
    assert_eq!(repaired.status(), 200);
    assert!(header(&repaired, "content-disposition").contains("part one"), "the name that came with it");
    let direct = server.post("/v1/repair").body(mesh.clone()).send().unwrap();
    assert_eq!(repaired.bytes().unwrap(), direct.bytes().unwrap());
    // The first job has taken the bytes over: they are there once for each mesh that was sent.
    let of_uploads = |server: &Server| {
        let files = server.stored_files().into_iter();
        files.filter(|file| file.metadata().unwrap().len() >= 1 << 20).count()
    };
    // The direct one was answered from the first.
    patiently(|| (of_uploads(&server) == 1).then_some(()));
    assert_eq!(offset(&server, &path), mesh.len());
    assert_eq!(tus(&server, "DELETE", &path).send().unwrap().status(), 204);
    assert_eq!(tus(&server, "HEAD", &path).send().unwrap().status(), 404);
    assert_eq!(refused(server.post("/v1/repair").json(&input(&path)).send().unwrap()), is(404, "not-found"));
}

#[test]
fn what_was_stored_is_there_after_the_server_was_killed_in_the_middle() {
    let server = Server::start();
    let mesh = padded(OPEN, 2 * PIECE_BYTES + (3 << 20));
    let path = create(&server, mesh.len());
    let _line = sending(&server, &path, 0, &mesh[..2 * PIECE_BYTES + (1 << 20)], mesh.len());
    let told = patiently(|| Some(offset(&server, &path)).filter(|&at| at >= PIECE_BYTES));
    let server = server.killed_and_restarted(&[]);
    let at = offset(&server, &path);
    assert!((told..=2 * PIECE_BYTES + (1 << 20)).contains(&at), "{told}, then {at}");
    assert_eq!(patch(&server, &path, at, &mesh[at..]).status(), 204);
    let verified = server.post("/v1/verify").json(&input(&path)).send().unwrap();
    let report: Value = verified.json().unwrap();
    assert_eq!(report["input"]["sha256"], *digest(&mesh));
    let server = server.killed_and_restarted(&[]);
    assert_eq!(server.post("/v1/verify").json(&input(&path)).send().unwrap().status(), 200);
}

#[test]
fn what_has_come_is_stored_while_nothing_more_comes() {
    let server = Server::start();
    let mesh = padded(OPEN, 64 << 10);
    let path = create(&server, mesh.len());
    let half = mesh.len() / 2;
    let line = sending(&server, &path, 0, &mesh[..half], mesh.len());
    patiently(|| (offset(&server, &path) == half).then_some(()));
    let server = server.killed_and_restarted(&[]);
    drop(line);
    assert_eq!(offset(&server, &path), half);
    assert_eq!(patch(&server, &path, half, &mesh[half..]).status(), 204);
}

#[test]
fn a_server_that_ends_keeps_what_has_come_and_does_not_wait_for_the_rest() {
    let server = Server::start();
    let mesh = padded(OPEN, 3 << 20);
    let path = create(&server, mesh.len());
    let mut line = sending(&server, &path, 0, &mesh[..1 << 20], mesh.len());
    let written = 3 << 18;
    let is_there = |file: &std::path::PathBuf| file.metadata().is_ok_and(|data| data.len() >= written);
    patiently(|| server.stored_files().iter().any(is_there).then_some(()));
    server.signal("TERM");
    let answer = line.hear_all();
    assert!(answer.starts_with("HTTP/1.1 503 ") && answer.contains("draining"), "{answer}");
    let server = server.restarted(&[]);
    let at = offset(&server, &path);
    assert!((3 << 18..=1 << 20).contains(&at), "{at}");
    assert_eq!(patch(&server, &path, at, &mesh[at..]).status(), 204);
    let report: Value = server.post("/v1/verify").json(&input(&path)).send().unwrap().json().unwrap();
    assert_eq!(report["input"]["sha256"], *digest(&mesh));
}

#[test]
fn a_client_is_told_what_is_wrong_with_an_upload() {
    let server = Server::with(&["--upload-bytes-max", "1000B"]);
    let options = server.request("OPTIONS", "/v1/uploads").send().unwrap();
    assert_eq!(options.status(), 204);
    for (name, value) in [("tus-version", "1.0.0"), ("tus-resumable", "1.0.0"), ("tus-max-size", "1000")] {
        assert_eq!(header(&options, name), value);
    }
    assert!(header(&options, "tus-extension").contains("creation"));
    let begin = |headers: &[(&str, &str)]| {
        let request = tus(&server, "POST", "/v1/uploads");
        let request = headers.iter().fold(request, |request, (name, value)| request.header(*name, *value));
        request.send().unwrap()
    };
    assert_eq!(refused(begin(&[("upload-length", "1001")])), is(413, "body-too-large"));
    assert_eq!(refused(begin(&[])), is(400, "invalid-parameter"));
    assert_eq!(refused(begin(&[("upload-defer-length", "1")])), is(400, "invalid-parameter"));
    assert_eq!(
        refused(begin(&[("upload-length", "1"), ("upload-metadata", "a b c")])),
        is(400, "invalid-parameter")
    );
    let typed = begin(&[("upload-length", "1"), ("content-type", "model/stl")]);
    assert_eq!(refused(typed), is(415, "unsupported-media-type"));
    let unversioned = server.post("/v1/uploads").header("upload-length", "1").send().unwrap();
    assert_eq!(header(&unversioned, "tus-version"), "1.0.0");
    assert_eq!(refused(unversioned), is(412, "unsupported-version"));

    let path = create(&server, 100);
    assert_eq!(patch(&server, &path, 0, &[b'#'; 10]).status(), 204);
    for at in [0, 9, 11, 100] {
        let (status, code, told) = problem(patch(&server, &path, at, b"a"));
        assert_eq!((status, code.as_str()), (409, "upload-conflict"), "{at}");
        assert!(told["detail"].as_str().unwrap().contains("byte 10"), "{told}");
    }
    assert_eq!(refused(patch(&server, &path, 10, &[b'#'; 91])), is(413, "body-too-large"));
    // One that does not say how long it is brings what there is room for.
    let chunked = |at: usize, bytes: Vec<u8>| {
        let body = reqwest::blocking::Body::new(std::io::Cursor::new(bytes));
        let request = tus(&server, "PATCH", &path).header("upload-offset", at.to_string());
        request.header("content-type", BYTES).body(body).send().unwrap()
    };
    assert_eq!(refused(chunked(10, vec![b'#'; 91])), is(413, "body-too-large"));
    assert!((10..=100).contains(&offset(&server, &path)));
    let path = create(&server, 100);
    let untyped = tus(&server, "PATCH", &path).header("upload-offset", "0").body("a").send().unwrap();
    assert_eq!(refused(untyped), is(415, "unsupported-media-type"));
    let packed = tus(&server, "PATCH", &path).header("upload-offset", "0").header("content-type", BYTES);
    let packed = packed.header("content-encoding", "br").body("a").send().unwrap();
    assert_eq!(refused(packed), is(415, "unsupported-media-type"));
    let without = tus(&server, "PATCH", &path).header("content-type", BYTES).body("a").send().unwrap();
    assert_eq!(refused(without), is(400, "invalid-parameter"));
    assert_eq!(offset(&server, &path), 0, "nothing of it was stored");
    for unknown in ["/v1/uploads/7", "/v1/uploads/0192f0c1-2345-7abc-8def-0123456789ab"] {
        assert_eq!(refused(patch(&server, unknown, 0, b"a")), is(404, "not-found"));
        assert_eq!(refused(tus(&server, "DELETE", unknown).send().unwrap()), is(404, "not-found"));
        let named = server.post("/v1/verify").json(&input(unknown)).send().unwrap();
        let (status, code, told) = problem(named);
        assert_eq!((status, code.as_str(), &told["parameter"]), (404, "not-found", &json!("input")));
    }
    let id = path.rsplit('/').next().unwrap();
    let both = format!("/v1/verify?input=%7B%22upload%22:%22{id}%22%7D");
    assert_eq!(refused(server.post(&both).body(SOLID).send().unwrap()), is(400, "invalid-parameter"));
    for wrong in [json!({}), json!({ "job": "a", "upload": "b" }), json!({ "file": "a" })] {
        let named = server.post("/v1/verify").json(&json!({ "input": wrong })).send().unwrap();
        assert_eq!(refused(named), is(400, "invalid-parameter"));
    }
    let empty = create(&server, 0);
    assert_eq!(
        refused(server.post("/v1/verify").json(&input(&empty)).send().unwrap()),
        is(422, "mesh-empty")
    );
}

#[test]
fn an_upload_may_begin_with_its_bytes_and_a_repeated_request_gives_the_same_job() {
    let server = Server::start();
    let begun = tus(&server, "POST", "/v1/uploads")
        .header("upload-length", OPEN.len().to_string())
        .header("content-type", BYTES)
        .body(OPEN)
        .send()
        .unwrap();
    assert_eq!((begun.status().as_u16(), header(&begun, "upload-offset")), (201, &*OPEN.len().to_string()));
    let path = header(&begun, "location").to_owned();
    let told: Value = begun.json().unwrap();
    assert!(path.ends_with(told["id"].as_str().unwrap()), "{told}");
    let job = || {
        let mut asked = input(&path);
        asked["operation"] = json!("repair");
        let request = server.post("/v1/jobs").header("idempotency-key", "order-17").json(&asked);
        let job: Value = request.send().unwrap().json().unwrap();
        server.ended(&job)
    };
    let (first, again) = (job(), job());
    assert_eq!((&first["id"], &first["outcome"]), (&again["id"], &json!("repaired")), "{first} {again}");
    // When that job is gone, so are its bytes.
    assert_eq!(server.request("DELETE", link(&first, "self")).send().unwrap().status(), 204);
    assert_eq!(refused(server.post("/v1/repair").json(&input(&path)).send().unwrap()), is(404, "not-found"));
    patiently(|| server.stored_files().is_empty().then_some(()));
}

/// Sends several meshes at one offset at the same time to servers that share an upload. The one that was stored.
fn race(servers: &[&Server], path: &str, meshes: &[Vec<u8>]) -> usize {
    let client = Arc::new(Client::new());
    let sending: Vec<_> = meshes
        .iter()
        .enumerate()
        .map(|(number, mesh)| {
            let (url, client, mesh) =
                (servers[number % servers.len()].url(path), Arc::clone(&client), mesh.clone());
            std::thread::spawn(move || {
                let request = client.patch(url).header("tus-resumable", "1.0.0").header("upload-offset", "0");
                request.header("content-type", BYTES).body(mesh).send().unwrap()
            })
        })
        .collect();
    let answers: Vec<_> = sending.into_iter().map(|thread| thread.join().unwrap()).collect();
    let mut stored = Vec::new();
    for (number, answer) in answers.into_iter().enumerate() {
        match answer.status().as_u16() {
            204 => stored.push(number),
            _ => assert_eq!(refused(answer), is(409, "upload-conflict")),
        }
    }
    assert_eq!(stored.len(), 1, "{stored:?}");
    stored[0]
}

fn rivals(number: usize) -> Vec<Vec<u8>> {
    (0..number).map(|number| format!("{SOLID}# {number:060}\n").into_bytes()).collect()
}

#[test]
fn of_those_who_send_at_one_offset_one_is_taken() {
    let server = Server::start();
    for _ in 0..5 {
        let meshes = rivals(8);
        let path = create(&server, meshes[0].len());
        let stored = race(&[&server], &path, &meshes);
        let report: Value = server.post("/v1/verify").json(&input(&path)).send().unwrap().json().unwrap();
        assert_eq!(report["input"]["sha256"], *digest(&meshes[stored]));
    }
    let unnamed =
        server.stored_files().into_iter().filter(|file| file.to_string_lossy().contains("/pieces/"));
    assert_eq!(unnamed.count(), 0, "what was not taken is gone");
}

#[test]
fn of_several_requests_that_name_an_upload_at_one_time_each_gets_its_mesh() {
    let server = Server::start();
    for _ in 0..5 {
        let path = create(&server, OPEN.len());
        assert_eq!(patch(&server, &path, 0, OPEN.as_bytes()).status(), 204);
        let asked = ["/v1/repair", "/v1/analyze", "/v1/verify", "/v1/repair"];
        let answers: Vec<_> = std::thread::scope(|scope| {
            let ask = |operation: &'static str| {
                let (server, input) = (&server, input(&path));
                scope.spawn(move || server.post(operation).json(&input).send().unwrap().status().as_u16())
            };
            let asking = asked.map(ask);
            asking.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(answers, [200; 4]);
    }
}

#[test]
fn an_upload_that_does_not_go_on_goes() {
    let server = Server::with(&["--upload-ttl", "3s", "--lease", "1s"]);
    let path = create(&server, 1000);
    assert_eq!(patch(&server, &path, 0, &[b'#'; 10]).status(), 204);
    assert_eq!(server.stored_files().len(), 1);
    patiently(|| (tus(&server, "HEAD", &path).send().unwrap().status() == 404).then_some(()));
    patiently(|| server.stored_files().is_empty().then_some(()));
    assert_eq!(refused(patch(&server, &path, 10, b"a")), is(404, "not-found"));
}

#[test]
fn an_upload_is_its_owner_s_and_counts_for_it() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    // Digests of `one` and `two`; the first key may only send.
    let line = |name: &str, key: &str, more: &str| format!("{name}:{}{more}\n", digest(key.as_bytes()));
    std::fs::write(keys.path(), line("a", "one", ":submit") + &line("b", "two", "")).unwrap();
    let server = Server::with(&[
        "--api-keys-file",
        keys.path().to_str().unwrap(),
        "--owner-data-bytes-max",
        "100000B",
        "--uploads-max",
        "4",
    ]);
    let begin = |key: &str, length: usize| {
        let request = tus(&server, "POST", "/v1/uploads").bearer_auth(key);
        request.header("upload-length", length.to_string()).send().unwrap()
    };
    let path = header(&begin("one", OPEN.len()), "location").to_owned();
    let send = |key: &str, path: &str, at: usize, bytes: &[u8]| {
        let request = tus(&server, "PATCH", path).bearer_auth(key).header("upload-offset", at.to_string());
        request.header("content-type", BYTES).body(bytes.to_vec()).send().unwrap()
    };
    assert_eq!(send("one", &path, 0, OPEN.as_bytes()).status(), 204);
    assert_eq!(tus(&server, "HEAD", &path).bearer_auth("one").send().unwrap().status(), 200);
    // For anybody else it is not there.
    assert_eq!(tus(&server, "HEAD", &path).bearer_auth("two").send().unwrap().status(), 404);
    assert_eq!(refused(send("two", &path, 0, b"a")), is(404, "not-found"));
    let delete = tus(&server, "DELETE", &path).bearer_auth("two").send().unwrap();
    assert_eq!(refused(delete), is(404, "not-found"));
    let named = |key: &str| server.post("/v1/verify").bearer_auth(key).json(&input(&path)).send().unwrap();
    assert_eq!(refused(named("two")), is(404, "not-found"));
    assert_eq!(named("one").status(), 200);
    // What has come of it counts, also where the connection broke.
    let large = header(&begin("two", 300_000), "location").to_owned();
    assert_eq!(send("two", &large, 0, &[b'#'; 60_000]).status(), 204);
    let (status, code, told) = problem(send("two", &large, 60_000, &[b'#'; 60_000]));
    assert_eq!((status, code.as_str()), (507, "storage-full"), "{told}");
    let refused_too = server.post("/v1/repair").bearer_auth("two").body(padded(OPEN, 60_000)).send().unwrap();
    assert_eq!(refused(refused_too), is(507, "storage-full"));
    assert_eq!(tus(&server, "DELETE", &large).bearer_auth("two").send().unwrap().status(), 204);
    let fits = server.post("/v1/repair").bearer_auth("two").body(padded(OPEN, 40_000)).send().unwrap();
    assert_eq!(fits.status(), 200);
    // One alone may have half of all uploads.
    assert_eq!((begin("two", 1).status().as_u16(), begin("two", 1).status().as_u16()), (201, 201));
    let (status, code, told) = problem(begin("two", 1));
    assert_eq!((status, code.as_str(), &told["limit_name"]), (507, "storage-full", &json!("uploads_max")));
    assert_eq!(begin("one", 1).status(), 201);
}

#[test]
fn what_there_is_no_room_for_is_refused_before_it_is_sent() {
    let server = Server::with(&["--data-bytes-max", "1000000B", "--upload-bytes-max", "2000000B"]);
    let begin = |length: &str| tus(&server, "POST", "/v1/uploads").header("upload-length", length).send();
    // Its pieces and the mesh that a job gets are there at one time.
    for bytes in ["1000001", "500001"] {
        assert_eq!(refused(begin(bytes).unwrap()), is(507, "storage-full"));
    }
    // Results make way for it.
    assert_eq!(server.post("/v1/repair").body(padded(OPEN, 400_000)).send().unwrap().status(), 200);
    let mesh = padded(OPEN, 450_000);
    let path = create(&server, mesh.len());
    assert_eq!(patch(&server, &path, 0, &mesh).status(), 204);
    assert_eq!(server.post("/v1/verify").json(&input(&path)).send().unwrap().status(), 200);
}

#[test]
fn an_upload_goes_on_at_another_server() {
    let Some(town) = Town::open() else { return };
    let (one, other) = (town.server("api", &[]), town.server("all", &[]));
    let mesh = padded(OPEN, PIECE_BYTES + (2 << 20));
    let path = create(&one, mesh.len());
    let sent = PIECE_BYTES + (1 << 20);
    drop(sending(&one, &path, 0, &mesh[..sent], mesh.len()));
    patiently(|| (offset(&other, &path) == sent).then_some(()));
    assert_eq!(refused(patch(&other, &path, 0, &mesh[..100])), is(409, "upload-conflict"));
    // The server that took the first part is gone.
    drop(one);
    assert_eq!(patch(&other, &path, sent, &mesh[sent..]).status(), 204);
    let third = town.server("api", &[]);
    let report: Value = third.post("/v1/analyze").json(&input(&path)).send().unwrap().json().unwrap();
    assert_eq!(report["input"]["sha256"], *digest(&mesh), "{report}");
    let repaired = other.post("/v1/repair").json(&input(&path)).send().unwrap();
    assert_eq!(repaired.status(), 200);
    let pieces = || town.stored_files().len();
    patiently(|| (pieces() == 4).then_some(()));
    for _ in 0..3 {
        let meshes = rivals(6);
        let path = create(&third, meshes[0].len());
        let stored = race(&[&other, &third], &path, &meshes);
        assert_eq!(offset(&other, &path), meshes[0].len());
        let report: Value = third.post("/v1/verify").json(&input(&path)).send().unwrap().json().unwrap();
        assert_eq!(report["input"]["sha256"], *digest(&meshes[stored]));
    }
    let path = create(&third, 10);
    assert_eq!(patch(&other, &path, 0, b"12345").status(), 204);
    assert_eq!(tus(&third, "DELETE", &path).send().unwrap().status(), 204);
    assert_eq!(tus(&other, "HEAD", &path).send().unwrap().status(), 404);
}
