//! Policies, printing reports, and the report as a page.

use crate::meshes::{LINE, OPEN, SOLID};
use crate::server::{Server, header, link, problem};
use serde_json::{Value, json};

#[test]
fn every_policy_is_listed_with_its_limits_and_their_sources() {
    let server = Server::start();
    let policies: Value = server.get("/v1/policies").send().unwrap().json().unwrap();
    let names: Vec<_> = policies.as_array().unwrap().iter().map(|policy| &policy["name"]).collect();
    assert_eq!(names, ["fdm", "sla", "sls", "mjf", "metal"]);
    let wall = &policies[0]["limits"][0];
    assert_eq!(
        (&wall["check"], &wall["error"], &wall["unit"]),
        (&json!("wall-thickness"), &json!(0.8), &json!("mm"))
    );
    assert!(wall["source"].as_str().unwrap().contains("0.8 mm"));
}

#[test]
fn every_operation_measures_for_the_policy_that_is_asked() {
    let server = Server::start();
    for (operation, about) in [
        ("analyze", "input"),
        ("verify", "input"),
        ("repair", "result"),
        ("convert", "result"),
        ("simplify", "result"),
    ] {
        let path = format!("/v1/{operation}?policy=metal&units=cm");
        let report: Value = server
            .post(&path)
            .header("accept", "application/json")
            .body(SOLID)
            .send()
            .unwrap()
            .json()
            .unwrap();
        let printing = &report["printing"];
        assert_eq!(
            (&printing["policy"], &printing["about"]),
            (&json!("metal"), &json!(about)),
            "{operation}"
        );
        assert_eq!(printing["quote"]["bounds"]["max"], json!([10.0, 10.0, 10.0]), "{operation}: millimetres");
    }
    let plain: Value = server.post("/v1/analyze").body(SOLID).send().unwrap().json().unwrap();
    assert_eq!(plain["printing"], Value::Null);
    let (status, code, problem) = problem(server.post("/v1/analyze?policy=slm").body(SOLID).send().unwrap());
    assert_eq!((status, code.as_str(), &problem["parameter"]), (400, "invalid-parameter", &json!("policy")));
}

#[test]
fn a_file_that_is_no_solid_is_not_safe_for_a_price_and_its_repair_is() {
    let server = Server::start();
    let report = |operation: &str| -> Value {
        let request =
            server.post(&format!("/v1/{operation}?policy=sls")).header("accept", "application/json");
        request.body(OPEN).send().unwrap().json().unwrap()
    };
    assert_eq!(report("analyze")["printing"]["quote"]["price_safe"], false);
    assert_eq!(report("repair")["printing"]["quote"]["price_safe"], true);
}

#[test]
fn a_report_is_a_page_for_browsers_and_json_for_everybody_else() {
    let server = Server::start();
    let ended = server.ended(&server.job("repair", OPEN));
    let path = link(&ended, "report");
    let browser = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8";
    let response = server.get(path).header("accept", browser).send().unwrap();
    assert_eq!(header(&response, "content-type"), "text/html; charset=utf-8");
    let policy = header(&response, "content-security-policy").to_owned();
    assert!(
        policy.starts_with("default-src 'none'; img-src data:; style-src 'sha256-")
            && !policy.contains("unsafe"),
        "{policy}"
    );
    let page = response.text().unwrap();
    assert!(page.contains("A valid solid") && page.contains("it is not watertight"), "{page}");
    for outside in ["http://", "https://", "href="] {
        assert!(!page.contains(outside), "{outside}");
    }
    let mut pictures = page.split("src=").skip(1);
    assert!(pictures.all(|picture| picture.trim_start_matches('"').starts_with("data:image/png;base64,")));
    for accept in ["application/json", "*/*"] {
        let response = server.get(path).header("accept", accept).send().unwrap();
        assert_eq!(header(&response, "content-type"), "application/json", "{accept}");
    }
    let (status, code, _) = problem(server.get(path).header("accept", "image/png").send().unwrap());
    assert_eq!((status, code.as_str()), (406, "not-acceptable"));
    let refused = server.ended(&server.job("repair", LINE));
    let page =
        server.get(link(&refused, "report")).header("accept", "text/html").send().unwrap().text().unwrap();
    assert!(page.contains("No result is returned."), "{page}");
}
