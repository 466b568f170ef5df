//! How often one caller may ask.

use crate::server::{Server, header, problem};

#[test]
fn a_caller_who_asks_too_often_is_told_when_to_come_again_and_others_are_not_touched() {
    let keys = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(keys.path(), "first-key\nsecond-key\n").unwrap();
    let keys = keys.path().to_str().unwrap();
    let server = Server::with(&["--api-keys-file", keys, "--rate-per-minute", "1", "--rate-burst", "3"]);
    let ask = |key: &str| server.get("/v1/version").bearer_auth(key).send().unwrap();
    for left in [2, 1, 0] {
        let answer = ask("first-key");
        assert_eq!(answer.status(), 200);
        assert_eq!(header(&answer, "ratelimit-policy"), "\"burst\";q=3, \"minute\";q=1;w=60");
        assert!(header(&answer, "ratelimit").starts_with(&format!("\"burst\";r={left};t=")));
    }
    let refused = ask("first-key");
    let wait: u64 = header(&refused, "retry-after").parse().unwrap();
    assert!((1..=60).contains(&wait), "{wait}");
    assert!(header(&refused, "ratelimit").starts_with("\"burst\";r=0;t="));
    let (status, code, problem) = problem(refused);
    assert_eq!(
        (status, code.as_str(), &problem["limit_name"]),
        (429, "rate-limited", &"rate_per_minute".into())
    );
    assert_eq!(ask("second-key").status(), 200);
    // Pages and health are not counted.
    for _ in 0..5 {
        assert_eq!(server.get("/docs").send().unwrap().status(), 200);
        assert_eq!(server.admin("/readyz").status(), 200);
    }
}

#[test]
fn without_a_limit_nothing_is_said_about_one() {
    let answer = Server::start().get("/v1/version").send().unwrap();
    assert!(
        answer.headers().get("ratelimit").is_none() && answer.headers().get("ratelimit-policy").is_none()
    );
}
