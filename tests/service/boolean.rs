//! Several meshes in, one solid out.

use crate::meshes::{OPEN, SOLID};
use crate::server::{Server, header, link, problem};
use reqwest::blocking::multipart::{Form, Part};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// A cube of side 2 from this corner on, as OFF.
fn cube(low: [f64; 3]) -> String {
    let mut text = "OFF\n8 12 0\n".to_owned();
    for i in 0..8 {
        let at = [0, 1, 2].map(|k| low[k] + if i >> k & 1 == 1 { 2.0 } else { 0.0 });
        writeln!(text, "{} {} {}", at[0], at[1], at[2]).unwrap();
    }
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        writeln!(text, "3 {a} {b} {c}\n3 {a} {c} {d}").unwrap();
    }
    text
}

fn part(name: &str, text: &str) -> Part {
    Part::text(text.to_owned()).file_name(name.to_owned())
}

/// Two cubes that share a volume of one.
fn two() -> Form {
    Form::new().part("mesh", part("a.off", &cube([0.0; 3]))).part("mesh", part("b.off", &cube([1.0; 3])))
}

fn json_of(response: reqwest::blocking::Response) -> Value {
    response.json().unwrap()
}

fn volume(report: &Value) -> f64 {
    report["after"]["measures"]["volume"].as_f64().unwrap()
}

#[test]
fn two_meshes_become_their_union_their_intersection_or_their_difference() {
    let server = Server::start();
    for (query, expected) in [
        ("", 15.0),
        ("?set_operation=union", 15.0),
        ("?set_operation=intersection", 1.0),
        ("?set_operation=difference", 7.0),
    ] {
        let path = format!("/v1/boolean{query}");
        let response = server.post(&path).multipart(two()).send().unwrap();
        assert_eq!((response.status().as_u16(), header(&response, "meshmend-outcome")), (200, "combined"));
        assert_eq!(header(&response, "meshmend-fidelity"), "exact");
        assert_eq!(header(&response, "content-type"), "text/off");
        assert!(header(&response, "content-disposition").contains("a-combined.off"));
        let mesh = response.bytes().unwrap().to_vec();
        let verified = json_of(server.post("/v1/verify").body(mesh).send().unwrap());
        assert_eq!(verified["verdict"]["printable"], true);
        let report = server.post(&path).header("accept", "application/json").multipart(two());
        let report = json_of(report.send().unwrap());
        assert_eq!((report["operation"].as_str(), volume(&report)), (Some("boolean"), expected));
        assert_eq!(report["further_inputs"].as_array().unwrap().len(), 1);
        assert_eq!(report["further_inputs"][0]["before"]["measures"]["volume"], 8.0);
    }
}

#[test]
fn options_may_stand_in_params_and_the_order_of_the_meshes_counts() {
    let server = Server::start();
    let report = |first: &str, second: &str| {
        let params = Part::text(r#"{"set_operation":"difference","output_format":"stl"}"#);
        let form = Form::new().part("mesh", part("1", first)).part("params", params);
        let form = form.part("mesh", part("2", second));
        json_of(
            server.post("/v1/boolean").header("accept", "application/json").multipart(form).send().unwrap(),
        )
    };
    let (large, small) = (cube([0.0; 3]), SOLID.to_owned());
    let made = report(&large, &small);
    assert!((volume(&made) - (8.0 - 1.0 / 6.0)).abs() < 1e-12, "{made}");
    let none = report(&small, &large);
    assert_eq!((&none["code"], &none["status"]), (&json!("not-repairable"), &json!(422)));
    let reason = &none["report"]["verdict"]["reasons"][0];
    assert_eq!(reason["code"], "empty-result");
    assert!(none["detail"].as_str().unwrap().contains("the other meshes cover the first one"), "{none}");
}

#[test]
fn what_is_no_closed_solid_is_refused_with_its_number() {
    let server = Server::start();
    let form = Form::new().part("mesh", part("a", SOLID)).part("mesh", part("b", OPEN));
    let (status, code, problem) = problem(server.post("/v1/boolean").multipart(form).send().unwrap());
    assert_eq!((status, code.as_str()), (422, "not-repairable"));
    let reason = &problem["report"]["verdict"]["reasons"][0];
    assert_eq!(reason["code"], "input-not-solid");
    let detail = problem["detail"].as_str().unwrap();
    assert!(
        detail.starts_with("mesh 2 is no closed solid") && detail.ends_with("repair it first"),
        "{detail}"
    );
}

#[test]
fn too_few_too_many_and_unreadable_meshes_are_told() {
    let server = Server::start();
    let refused = |path: &str, form: Form| {
        let (status, code, problem) = problem(server.post(path).multipart(form).send().unwrap());
        let told = problem["detail"].as_str().unwrap_or_default().to_owned();
        (status, code, problem["parameter"].as_str().unwrap_or_default().to_owned(), told)
    };
    let is = |told: (u16, String, String, String), status: u16, code: &str, words: &str| {
        assert_eq!((told.0, told.1.as_str(), told.2.as_str()), (status, code, "mesh"), "{}", told.3);
        assert!(told.3.contains(words), "{}", told.3);
    };
    let one = || Form::new().part("mesh", part("a.off", SOLID));
    is(refused("/v1/boolean", one()), 400, "invalid-parameter", "2 to 32 meshes");
    is(refused("/v1/boolean", Form::new().text("params", "{}")), 400, "invalid-parameter", "");
    let many = (0..33).fold(Form::new(), |form, _| form.part("mesh", part("a.off", SOLID)));
    is(refused("/v1/boolean", many), 400, "invalid-parameter", "more than 32");
    is(refused("/v1/repair", two()), 400, "invalid-parameter", "twice");
    is(refused("/v1/jobs?operation=repair", two()), 400, "invalid-parameter", "one mesh");
    let broken = || one().part("mesh", part("b.off", "OFF\n4 4 6\n0 0 zero\n"));
    is(refused("/v1/boolean", broken()), 422, "mesh-unparseable", "mesh 2: ");
    // A named file without a byte is no mesh; a file input that was left empty is none at all.
    is(refused("/v1/boolean", one().part("mesh", part("b.off", ""))), 422, "mesh-empty", "mesh 2: ");
    let empty = two().part("mesh", Part::text(""));
    assert_eq!(server.post("/v1/boolean").multipart(empty).send().unwrap().status(), 200);
    let (status, code, _) = problem(server.post("/v1/boolean").body(SOLID).send().unwrap());
    assert_eq!((status, code.as_str()), (400, "invalid-parameter"));
}

#[test]
fn a_job_is_polled_and_its_meshes_are_used_again() {
    let server = Server::start();
    let form = two().text("job", r#"{"operation":"boolean","set_operation":"difference"}"#);
    let response = server.post("/v1/jobs").multipart(form).send().unwrap();
    assert_eq!(response.status(), 202);
    let job = server.ended(&json_of(response));
    assert_eq!((&job["state"], &job["outcome"]), (&json!("succeeded"), &json!("combined")));
    let report = json_of(server.get(link(&job, "report")).send().unwrap());
    assert_eq!(volume(&report), 7.0);
    let result = server.get(link(&job, "result")).send().unwrap();
    assert_eq!(result.status(), 200);
    let again = json!({ "input": { "job": job["id"] }, "set_operation": "intersection" });
    let report = server.post("/v1/boolean").header("accept", "application/json").json(&again);
    assert_eq!(volume(&json_of(report.send().unwrap())), 1.0);
    // Several meshes are nothing for an operation on one.
    let repair = server.post("/v1/repair").json(&json!({ "input": { "job": job["id"] } }));
    assert_eq!(problem(repair.send().unwrap()).1, "invalid-parameter");
}

#[test]
fn the_same_meshes_in_the_same_order_are_answered_from_the_cache_and_no_others() {
    let server = Server::start();
    let job = |meshes: &[&str]| {
        let form = meshes.iter().fold(Form::new(), |form, mesh| form.part("mesh", part("m", mesh)));
        let form = form.text("job", r#"{"operation":"boolean"}"#);
        server.ended(&json_of(server.post("/v1/jobs").multipart(form).send().unwrap()))
    };
    let (a, b) = (cube([0.0; 3]), cube([1.0; 3]));
    assert_eq!(job(&[&a, &b])["cached"], false);
    assert_eq!(job(&[&a, &b])["cached"], true);
    assert_eq!(job(&[&b, &a])["cached"], false);
    // The same bytes divided elsewhere: the empty line at the end of the first is at the start of the second.
    let (long, short) = (format!("{a}\n"), format!("\n{b}"));
    assert_eq!(job(&[&long, &b])["cached"], false);
    assert_eq!(job(&[&a, &short])["cached"], false);
    assert_eq!(job(&[&a, &short])["cached"], true);
}

#[test]
fn a_key_makes_one_job_of_the_same_meshes_and_refuses_others() {
    let server = Server::start();
    let send = |form: Form| server.post("/v1/boolean").header("idempotency-key", "k").multipart(form).send();
    assert_eq!(send(two()).unwrap().status(), 200);
    assert_eq!(send(two()).unwrap().status(), 200);
    let swapped =
        Form::new().part("mesh", part("b.off", &cube([1.0; 3]))).part("mesh", part("a.off", &cube([0.0; 3])));
    assert_eq!(problem(send(swapped).unwrap()).1, "idempotency-key-reused");
}
