//! Pages of other origins.

use crate::meshes::SOLID;
use crate::server::{Server, header, problem};

const SHOP: &str = "https://shop.example";

fn preflight(server: &Server, origin: &str) -> reqwest::blocking::Response {
    let request = server.request("OPTIONS", "/v1/repair").header("origin", origin);
    request.header("access-control-request-method", "POST").send().unwrap()
}

#[test]
fn by_default_no_page_of_another_origin_may_ask_or_read() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(keys.path(), "first-key\n").unwrap();
    for settings in [vec![], vec!["--api-keys-file", keys.path().to_str().unwrap()]] {
        let server = Server::with(&settings);
        let answer = preflight(&server, SHOP);
        assert!(answer.headers().get("access-control-allow-origin").is_none());
        assert!(!answer.status().is_success());
    }
}

#[test]
fn a_listed_origin_may_ask_and_read_and_another_one_may_not() {
    let server = Server::with(&["--cors-origins", SHOP]);
    let answer = preflight(&server, SHOP);
    assert_eq!((answer.status().as_u16(), header(&answer, "access-control-allow-origin")), (200, SHOP));
    assert!(header(&answer, "access-control-allow-methods").contains("POST"));
    assert!(header(&answer, "access-control-allow-headers").contains("authorization"));
    assert!(answer.headers().get("access-control-allow-credentials").is_none());

    let answer = server.post("/v1/verify").header("origin", SHOP).body(SOLID).send().unwrap();
    assert_eq!((answer.status().as_u16(), header(&answer, "access-control-allow-origin")), (200, SHOP));
    assert!(header(&answer, "access-control-expose-headers").contains("location"));

    let other = "https://evil.example";
    assert!(preflight(&server, other).headers().get("access-control-allow-origin").is_none());
    let refused = server.post("/v1/verify").header("origin", other).body(SOLID).send().unwrap();
    assert!(refused.headers().get("access-control-allow-origin").is_none());
    assert_eq!(problem(refused).1, "forbidden");
}
