//! Heads of requests that could be read in more than one way, and requests about another version.

use crate::meshes::{OPEN, SOLID};
use crate::server::{Server, header, link, problem};

/// What is answered to these bytes, with the connection's end.
fn answer(server: &Server, bytes: &str) -> String {
    let mut line = server.connect();
    line.say(bytes);
    line.hear_all()
}

#[test]
fn a_host_that_only_begins_like_this_one_is_foreign() {
    let server = Server::start();
    for (host, status) in [
        ("127.0.0.1.evil.example", 403),
        ("localhost.evil.example:80", 403),
        ("[::1]evil.example", 400),
        ("[::1]:80evil.example", 400),
        ("127.0.0.1:evil.example", 400),
    ] {
        let text = answer(
            &server,
            &format!("GET /v1/version HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"),
        );
        assert!(text.starts_with(&format!("HTTP/1.1 {status} ")), "{host}: {text}");
    }
}

#[test]
fn a_head_without_a_host_or_with_two_is_refused_also_where_there_are_keys() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(keys.path(), "a-key\n").unwrap();
    let server = Server::with(&["--api-keys-file", keys.path().to_str().unwrap()]);
    let head = "GET /v1/version HTTP/1.1\r\nAuthorization: Bearer a-key\r\nConnection: close\r\n";
    for hosts in ["", "Host: a\r\nHost: b\r\n"] {
        let text = answer(&server, &format!("{head}{hosts}\r\n"));
        assert!(text.starts_with("HTTP/1.1 400 "), "{text}");
    }
    assert!(answer(&server, &format!("{head}Host: a\r\n\r\n")).starts_with("HTTP/1.1 200 "));
}

#[test]
fn a_body_in_another_transfer_coding_is_refused_and_encodings_are_read_in_any_case() {
    let server = Server::start();
    let text = answer(
        &server,
        "POST /v1/verify HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: gzip, chunked\r\nConnection: close\r\n\r\n0\r\n\r\n",
    );
    assert!(text.starts_with("HTTP/1.1 415 ") && text.contains("unsupported-media-type"), "{text}");
    let send = |encoding: &str| {
        server.post("/v1/verify").header("content-encoding", encoding).body(SOLID).send().unwrap()
    };
    assert_eq!(send("IDENTITY").status(), 200);
    assert_eq!(problem(send("br, gzip")).1, "unsupported-media-type");
    // What is not compressed although it says so is not taken for a mesh.
    assert_ne!(send("GZip").status(), 200);
}

#[test]
fn a_request_about_another_version_changes_nothing() {
    let server = Server::start();
    let job = server.ended(&server.job("repair", OPEN));
    let (own, result) = (link(&job, "self"), link(&job, "result"));
    let tag = |path: &str| header(&server.get(path).send().unwrap(), "etag").to_owned();
    let refused = |method: &str, path: &str| {
        let (status, code, _) =
            problem(server.request(method, path).header("if-match", "\"other\"").send().unwrap());
        assert_eq!((status, code.as_str()), (412, "precondition-failed"), "{method} {path}");
    };
    refused("GET", own);
    refused("GET", result);
    refused("POST", &format!("{own}/cancel"));
    refused("DELETE", own);
    assert_eq!(server.get(result).header("if-match", tag(result)).send().unwrap().status(), 200);
    assert_eq!(server.request("DELETE", own).header("if-match", tag(own)).send().unwrap().status(), 204);
}

#[test]
fn text_in_utf_16_and_text_with_zero_bytes_are_told_as_such() {
    let server = Server::start();
    let obj = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let utf_16: Vec<u8> = obj.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (path, body, words) in [
        ("/v1/verify", utf_16.clone(), "UTF-16"),
        ("/v1/verify?format=obj", utf_16, "UTF-16"),
        ("/v1/verify", obj.replacen("v 0 10 0", "v 0 1\0 0", 1).into_bytes(), "zero byte"),
        ("/v1/verify?reader=tobj", obj.replacen("v 0 10 0", "v 0 1\0 0", 1).into_bytes(), "zero byte"),
        ("/v1/verify", SOLID.replacen("3 0 1 3", "3 0 1\0 3", 1).into_bytes(), "zero byte"),
    ] {
        let (status, _, problem) = problem(server.post(path).body(body).send().unwrap());
        assert_eq!(status, 422, "{problem}");
        assert!(problem.to_string().contains(words), "{path}: {problem}");
    }
}
