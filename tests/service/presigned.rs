//! Meshes that go to the bucket and come from it without a server in between.

use reqwest::blocking::{Client, Response};
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::meshes::{OPEN, SOLID};
use crate::server::{Server, header, is, link, refused};
use crate::town::Town;

fn asked(mesh: &str) -> Value {
    let digest: String = Sha256::digest(mesh).iter().map(|byte| format!("{byte:02x}")).collect();
    json!({ "length": mesh.len(), "sha256": digest, "file_name": "part one.off" })
}

fn begin(server: &Server, asked: &Value) -> Response {
    server.post("/v1/uploads/presigned").json(asked).send().unwrap()
}

/// Writes to the bucket as an upload says.
fn put(upload: &Value, bytes: &str) -> u16 {
    let client = Client::builder().no_proxy().build().unwrap();
    let request = client.put(upload["put"]["url"].as_str().unwrap());
    let headers = upload["put"]["headers"].as_object().unwrap();
    let request =
        headers.iter().fold(request, |request, (name, value)| request.header(name, value.as_str().unwrap()));
    request.body(bytes.to_owned()).send().unwrap().status().as_u16()
}

fn input(upload: &Value) -> Value {
    json!({ "input": { "upload": upload["id"] } })
}

#[test]
fn a_mesh_goes_to_the_bucket_and_its_result_comes_from_there() {
    let Some(town) = Town::open() else { return };
    let settings = ["--presigned-ttl", "15min", "--interactive-slots", "0"];
    let server = town.server("api", &settings);
    let worker = town.server("worker", &[]);
    let begun = begin(&server, &asked(OPEN));
    assert_eq!((begun.status().as_u16(), header(&begun, "cache-control")), (201, "no-store"));
    let place = header(&begun, "location").to_owned();
    let upload: Value = begun.json().unwrap();
    assert_eq!((&upload["received"], &upload["put"]["valid_s"]), (&json!(0), &json!(900)), "{upload}");
    let unsent = server.post("/v1/repair").json(&input(&upload)).send().unwrap();
    assert_eq!(refused(unsent), is(409, "upload-unfinished"));
    // Nothing but these bytes is taken.
    let longer = format!("{OPEN}# more\n");
    let other = OPEN.replace("0 0 1", "0 0 2");
    assert!(put(&upload, &longer) >= 400 && put(&upload, &other) >= 400);
    let stand = |path: &str| server.request("HEAD", path).header("tus-resumable", "1.0.0").send().unwrap();
    assert_eq!(put(&upload, OPEN), 200);
    assert_eq!(header(&stand(&place), "upload-offset"), OPEN.len().to_string());
    let repaired = server.post("/v1/repair").json(&input(&upload)).send().unwrap();
    assert_eq!(repaired.status(), 200);
    assert!(header(&repaired, "content-disposition").contains("part one"));
    let mesh = repaired.bytes().unwrap();
    let copies = std::fs::read_dir(server.data_dir().join("copies/in")).unwrap().count();
    assert_eq!(copies, 0, "the mesh came past the server that took the request");
    // A job of its own, whose result nobody has asked this server for.
    let mut again = input(&upload);
    again["operation"] = json!("convert");
    again["output_format"] = json!("stl");
    let job: Value = server.post("/v1/jobs").json(&again).send().unwrap().json().unwrap();
    let job = server.ended(&job);
    assert_eq!(job["state"], "succeeded", "{job}");
    let path = format!("{}?redirect=true", link(&job, "result"));
    let client = Client::builder().redirect(reqwest::redirect::Policy::none()).no_proxy().build().unwrap();
    let redirect = client.get(server.url(&path)).send().unwrap();
    assert_eq!((redirect.status().as_u16(), header(&redirect, "cache-control")), (307, "no-store"));
    let from_bucket = client.get(header(&redirect, "location")).send().unwrap();
    assert_eq!(from_bucket.status(), 200);
    let from_bucket = from_bucket.bytes().unwrap();
    let whole = server.get(link(&job, "result")).send().unwrap().bytes().unwrap();
    assert!(!whole.is_empty() && whole == from_bucket && !mesh.is_empty());
    // A URL that was changed opens nothing.
    let forged = header(&redirect, "location").replace("X-Amz-Expires=900", "X-Amz-Expires=901");
    assert_eq!(client.get(forged).send().unwrap().status(), 403);
    for wrong in ["redirect=yes", "redirect=true&redirect=false", "redirekt=true"] {
        assert_eq!(server.get(&format!("{}?{wrong}", link(&job, "result"))).send().unwrap().status(), 400);
    }
    // A bucket that compares no digest may have other bytes. Nobody is given anything made of them.
    let false_one: Value = begin(&server, &asked(SOLID)).json().unwrap();
    let name = false_one["id"].as_str().unwrap().replace('-', "");
    let place = town.dir.path().join("bucket/meshes/shop/pieces").join(name);
    std::fs::write(place, SOLID.replace("0 0 1", "0 0 2")).unwrap();
    let repaired = server.post("/v1/repair").json(&input(&false_one)).send().unwrap();
    assert_eq!(refused(repaired), is(410, "expired"));
    drop(worker);
    // What is deleted before it was taken is gone from the bucket too.
    let second: Value = begin(&server, &asked(SOLID)).json().unwrap();
    assert_eq!(put(&second, SOLID), 200);
    let before = town.stored_files().len();
    let path = format!("/v1/uploads/{}", second["id"].as_str().unwrap());
    let patched =
        server.request("PATCH", &path).header("tus-resumable", "1.0.0").header("upload-offset", "0");
    let patched = patched.header("content-type", "application/offset+octet-stream").body("a").send().unwrap();
    assert_eq!(refused(patched), is(409, "upload-conflict"));
    let deleted = server.request("DELETE", &path).header("tus-resumable", "1.0.0").send().unwrap();
    assert_eq!(deleted.status(), 204);
    crate::server::patiently(|| (town.stored_files().len() == before - 1).then_some(()));
}

#[test]
fn what_is_not_as_it_should_be_is_refused_before_a_url_is_given() {
    let Some(town) = Town::open() else { return };
    let server = town.server("all", &["--presigned-ttl", "1min", "--upload-bytes-max", "1000B"]);
    let with = |name: &str, value: Value| {
        let mut asked = asked(OPEN);
        asked[name] = value;
        refused(begin(&server, &asked))
    };
    assert_eq!(with("length", json!(1001)), is(413, "body-too-large"));
    assert_eq!(with("length", json!("7")), is(400, "invalid-parameter"));
    assert_eq!(with("sha256", json!("7")), is(400, "invalid-parameter"));
    assert_eq!(with("url", json!("https://elsewhere.example/mesh.stl")), is(400, "invalid-parameter"));
    let text = server.post("/v1/uploads/presigned").body("{}").send().unwrap();
    assert_eq!(refused(text), is(415, "unsupported-media-type"));
    // Without the setting none is given, nor where files are on the disk of the server.
    for server in [town.server("all", &[]), Server::start()] {
        assert_eq!(refused(begin(&server, &asked(OPEN))), is(422, "presigned-refused"));
        let job = server.ended(&server.job("repair", OPEN));
        let redirected = server.get(&format!("{}?redirect=true", link(&job, "result"))).send().unwrap();
        assert_eq!(refused(redirected), is(422, "presigned-refused"));
        let limits: Value = server.get("/v1/limits").send().unwrap().json().unwrap();
        assert_eq!(limits["presigned_ttl_s"], 0);
    }
}
