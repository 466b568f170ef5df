//! Everything that is not a success is a problem with a stable code, the framework's own answers included.

use crate::meshes::SOLID;
use crate::server::{Server, header, problem};
use serde_json::{Value, json};
use std::collections::HashSet;

#[test]
fn every_wrong_turn_is_a_problem_with_a_stable_code() {
    let server = Server::start();
    let rows: Value = server.get("/v1/errors").send().unwrap().json().unwrap();
    let known: HashSet<_> =
        rows.as_array().unwrap().iter().map(|row| row["code"].as_str().unwrap()).collect();
    let no_job = "/v1/jobs/00000000-0000-7000-8000-000000000000";
    let table = [
        ("GET", "/", "", 200, ""),
        ("GET", "/nowhere", "", 404, "not-found"),
        ("GET", "/v1", "", 404, "not-found"),
        ("GET", "/v1/jobs/", "", 404, "not-found"),
        ("GET", "/v1/repair/", "", 404, "not-found"),
        ("GET", no_job, "", 404, "not-found"),
        ("GET", "/v1/jobs/7", "", 404, "not-found"),
        ("GET", "/v1/jobs/%ff", "", 404, "not-found"),
        ("GET", "/v1/jobs/7/report", "", 404, "not-found"),
        ("GET", "/v1/jobs/7/result", "", 404, "not-found"),
        ("POST", "/v1/jobs/7/cancel", "", 404, "not-found"),
        ("DELETE", "/v1/jobs/7", "", 404, "not-found"),
        ("GET", "/v1/repair", "", 405, "method-not-allowed"),
        ("PUT", "/v1/repair", SOLID, 405, "method-not-allowed"),
        ("OPTIONS", "/v1/repair", "", 405, "method-not-allowed"),
        ("PUT", "/v1/jobs", "", 405, "method-not-allowed"),
        ("DELETE", "/v1/limits", "", 405, "method-not-allowed"),
        ("POST", "/", "", 405, "method-not-allowed"),
        ("FOO", "/v1/limits", "", 405, "method-not-allowed"),
        ("GET", "/v1/limits?x=1", "", 400, "unknown-parameter"),
        ("GET", "/v1/jobs/7?x=1", "", 400, "unknown-parameter"),
        ("GET", "/v1/jobs/7?wait=soon", "", 400, "invalid-parameter"),
        ("POST", "/v1/repair?unit=mm", SOLID, 400, "unknown-parameter"),
        ("POST", "/v1/repair?units=parsec", SOLID, 400, "invalid-parameter"),
        ("POST", "/v1/repair?samples=-1", SOLID, 400, "invalid-parameter"),
        ("POST", "/v1/repair?input=7", "", 400, "invalid-parameter"),
        ("POST", "/v1/repair?units=mm&units=cm", SOLID, 400, "invalid-parameter"),
        ("POST", "/v1/repair", "", 422, "mesh-empty"),
        ("POST", "/v1/repair", "neither this nor that", 422, "mesh-unparseable"),
    ];
    for (method, path, body, status, code) in table {
        let response = server.request(method, path).body(body).send().unwrap();
        if code.is_empty() {
            assert_eq!(response.status(), status, "{method} {path}");
            continue;
        }
        let allow = header(&response, "allow").to_owned();
        let (told, its_code, _) = problem(response);
        assert_eq!((told, its_code.as_str()), (status, code), "{method} {path}");
        assert!(known.contains(code));
        assert_eq!(!allow.is_empty(), status == 405, "{method} {path}: Allow: {allow}");
    }
}

#[test]
fn a_misspelt_parameter_is_answered_with_the_nearest_one() {
    let server = Server::start();
    let (_, _, problem) = problem(server.post("/v1/repair?outptu_format=stl").body(SOLID).send().unwrap());
    assert_eq!(
        (&problem["parameter"], &problem["suggestion"]),
        (&json!("outptu_format"), &json!("output_format"))
    );
    assert!(problem["detail"].as_str().unwrap().contains("did you mean `output_format`?"));
}

#[test]
fn allow_lists_the_methods_of_a_path() {
    let server = Server::start();
    let allow = |path| header(&server.request("PATCH", path).send().unwrap(), "allow").to_owned();
    assert_eq!(allow("/v1/repair"), "POST");
    let mut methods: Vec<_> = allow("/v1/jobs/7").split(',').map(|m| m.trim().to_owned()).collect();
    methods.sort();
    assert_eq!(methods, ["DELETE", "GET", "HEAD"]);
}

#[test]
fn a_head_that_is_too_large_is_a_problem() {
    let server = Server::start();
    let long = "x".repeat(40 << 10);
    for request in
        [server.get("/v1/limits").header("x-long", &long), server.get(&format!("/v1/limits?{long}"))]
    {
        let (status, code, problem) = problem(request.send().unwrap());
        assert_eq!(
            (status, code.as_str(), &problem["limit_name"]),
            (431, "head-too-large", &json!("head_bytes_max"))
        );
    }
}

#[test]
fn a_request_id_is_taken_over_when_it_is_plain_and_made_up_otherwise() {
    let server = Server::start();
    let id = |given: &str| {
        let response = server.get("/v1/version").header("x-request-id", given).send().unwrap();
        header(&response, "x-request-id").to_owned()
    };
    assert_eq!(id("order-7_a.b"), "order-7_a.b");
    for strange in ["", "a b", "<script>", &"x".repeat(129)] {
        let own = id(strange);
        assert!(own != strange && own.len() == 36, "{own}");
    }
}

#[test]
fn what_accepts_no_json_gets_none() {
    let server = Server::start();
    for path in ["/v1/limits", "/v1/errors", "/v1/formats", "/v1/version", "/v1/jobs/7"] {
        let (status, code, problem) = problem(server.get(path).header("accept", "text/html").send().unwrap());
        assert_eq!((status, code.as_str()), (406, "not-acceptable"), "{path}");
        assert_eq!(problem["allowed"], json!(["application/json"]));
    }
}

#[test]
fn a_limit_is_named_as_the_limits_name_it() {
    let server = Server::with(&["--triangles-max", "3"]);
    let limits: Value = server.get("/v1/limits").send().unwrap().json().unwrap();
    let (status, code, problem) = problem(server.post("/v1/verify").body(SOLID).send().unwrap());
    assert_eq!((status, code.as_str(), &problem["actual"]), (413, "mesh-too-large", &json!(4)));
    assert_eq!(limits[problem["limit_name"].as_str().unwrap()], problem["limit"]);
}
