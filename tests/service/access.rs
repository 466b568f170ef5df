//! Who may use the service.

use crate::meshes::SOLID;
use crate::server::{Server, header, link, problem};
use reqwest::blocking::RequestBuilder;
use serde_json::Value;

fn code(request: RequestBuilder) -> (u16, String) {
    let (status, code, _) = problem(request.send().unwrap());
    (status, code)
}

#[test]
fn without_keys_a_foreign_host_origin_or_proxy_is_refused() {
    let server = Server::with(&["--allowed-hosts", "mesh.example"]);
    let refused = (403, "forbidden".to_owned());
    for path in ["/", "/v1/version", "/v1/jobs/7", "/nowhere"] {
        let get = || server.get(path);
        assert_eq!(code(get().header("host", "evil.example")), refused, "{path}");
        assert_eq!(code(get().header("origin", "http://evil.example")), refused, "{path}");
        assert_eq!(code(get().header("origin", "null")), refused, "{path}");
        assert_eq!(code(get().header("x-forwarded-for", "8.8.8.8")), refused, "{path}");
        assert_eq!(code(get().header("forwarded", "for=8.8.8.8")), refused, "{path}");
    }
    let post = server.post("/v1/repair").header("origin", "http://evil.example").body(SOLID);
    assert_eq!(code(post), refused);
    let own = format!("http://{}", server.address);
    assert_eq!(server.get("/v1/version").header("origin", own).send().unwrap().status(), 200);
    assert_eq!(server.get("/v1/version").header("host", "mesh.example").send().unwrap().status(), 200);
}

#[test]
fn a_trusted_proxy_may_forward() {
    let server = Server::with(&["--trusted-proxies", "127.0.0.1"]);
    let request = server.get("/v1/version").header("x-forwarded-for", "8.8.8.8");
    assert_eq!(request.send().unwrap().status(), 200);
}

#[test]
fn with_keys_only_their_holders_come_in_and_see_their_own_jobs() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    // The second line is the digest of `open sesame`.
    let digest = "41ef4bb0b23661e66301aac36066912dac037827b4ae63a7b1165a5aa93ed4eb";
    std::fs::write(keys.path(), format!("first-key\nshop:{digest}\n")).unwrap();
    let server = Server::with(&["--api-keys-file", keys.path().to_str().unwrap()]);

    let refused = server.get("/v1/version").send().unwrap();
    assert!(header(&refused, "www-authenticate").starts_with("Bearer"));
    assert_eq!(problem(refused).1, "unauthenticated");
    let unauthenticated = (401, "unauthenticated".to_owned());
    assert_eq!(code(server.get("/v1/version").bearer_auth("wrong")), unauthenticated);
    assert_eq!(code(server.get("/v1/version").bearer_auth(digest)), unauthenticated);
    assert_eq!(code(server.post("/v1/repair").body(SOLID)), unauthenticated);
    for page in ["/", "/docs", "/openapi.yaml"] {
        assert_eq!(server.get(page).send().unwrap().status(), 200, "{page} is for everybody");
    }
    // A key is no ambient right, so host and origin do not matter.
    let foreign = server.get("/v1/version").bearer_auth("first-key").header("origin", "http://other.example");
    assert_eq!(foreign.send().unwrap().status(), 200);
    assert_eq!(server.get("/v1/version").header("x-api-key", "open sesame").send().unwrap().status(), 200);

    let mine = |request: RequestBuilder| request.bearer_auth("first-key").send().unwrap();
    let job: Value = mine(server.post("/v1/jobs?operation=repair").body(SOLID)).json().unwrap();
    let path = link(&job, "self");
    let job: Value = mine(server.get(&format!("{path}?wait=60"))).json().unwrap();
    assert_eq!(job["state"], "succeeded");
    let not_found = (404, "not-found".to_owned());
    let input = serde_json::json!({ "input": { "job": job["id"] } });
    for request in [
        server.get(path),
        server.get(link(&job, "report")),
        server.get(link(&job, "result")),
        server.post(&format!("{path}/cancel")),
        server.request("DELETE", path),
        server.get(&format!("{path}/events")),
        server.get(&format!("{path}/deliveries")),
        server.post(&format!("{path}/deliveries/msg_1/redeliver")),
        server.post("/v1/verify").json(&input),
    ] {
        assert_eq!(code(request.bearer_auth("open sesame")), not_found);
    }
    let listed =
        |key: &str| -> Value { server.get("/v1/jobs").bearer_auth(key).send().unwrap().json().unwrap() };
    assert_eq!(listed("first-key")["jobs"][0]["id"], job["id"]);
    assert_eq!(listed("open sesame")["jobs"], serde_json::json!([]));
    let keyed = |key: &str| -> Value {
        let request = server.post("/v1/jobs?operation=verify").header("idempotency-key", "one").body(SOLID);
        request.bearer_auth(key).send().unwrap().json().unwrap()
    };
    assert_eq!(keyed("first-key")["id"], keyed("first-key")["id"]);
    assert_ne!(keyed("first-key")["id"], keyed("open sesame")["id"], "each caller has keys of its own");
    assert_eq!(mine(server.post("/v1/verify").json(&input)).status(), 200);
    assert_eq!(mine(server.request("DELETE", path)).status(), 204);
}

#[test]
fn a_key_does_what_its_scopes_allow_and_a_second_key_of_a_name_sees_the_same_jobs() {
    // Digests of `open sesame` and `second`.
    let first = "41ef4bb0b23661e66301aac36066912dac037827b4ae63a7b1165a5aa93ed4eb";
    let second = "16367aacb67a4a017c8da8ab95682ccb390863780f7114dda0a0e0c55644c7c4";
    let keys = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(keys.path(), format!("shop:{first}:submit\nshop:{second}:read\n")).unwrap();
    let server = Server::with(&["--api-keys-file", keys.path().to_str().unwrap()]);
    let (submits, reads) = ("open sesame", "second");
    let forbidden = (403, "forbidden".to_owned());
    assert_eq!(code(server.get("/v1/limits").bearer_auth(submits)), forbidden);
    assert_eq!(code(server.post("/v1/verify").body(SOLID).bearer_auth(reads)), forbidden);
    let made = server.post("/v1/jobs?operation=verify").body(SOLID).bearer_auth(submits).send().unwrap();
    assert_eq!(made.status(), 202);
    let job: Value = made.json().unwrap();
    let path = link(&job, "self");
    let seen = server.get(&format!("{path}?wait=60")).bearer_auth(reads).send().unwrap();
    assert_eq!(seen.json::<Value>().unwrap()["state"], "succeeded");
    assert_eq!(code(server.request("DELETE", path).bearer_auth(reads)), forbidden);
    assert_eq!(server.request("DELETE", path).bearer_auth(submits).send().unwrap().status(), 204);
}
