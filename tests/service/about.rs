//! What the service says about itself, and its pages.

use crate::meshes::SOLID;
use crate::server::{Server, header};
use serde_json::Value;
use std::process::Command;

#[test]
fn it_describes_its_errors_limits_formats_and_version() {
    let server = Server::with(&["--upload-bytes-max", "12345B", "--slots", "3"]);
    let get = |path| server.get(path).send().unwrap().json::<Value>().unwrap();
    let errors = get("/v1/errors");
    let refused = errors.as_array().unwrap().iter().find(|row| row["code"] == "not-repairable").unwrap();
    assert_eq!(refused["status"], 422);
    let limits = get("/v1/limits");
    assert_eq!((&limits["upload_bytes_max"], &limits["slots"]), (&12345.into(), &3.into()));
    let formats = get("/v1/formats");
    let names: Vec<_> = formats.as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["obj", "stl", "off", "ply", "glb", "gltf", "3mf"]);
    assert_eq!(get("/v1/version")["version"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn the_contract_is_served_as_committed() {
    let server = Server::start();
    let response = server.get("/openapi.yaml").send().unwrap();
    assert_eq!(header(&response, "content-type"), "application/yaml");
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/openapi.yaml");
    assert_eq!(response.text().unwrap(), std::fs::read_to_string(committed).unwrap());
}

#[test]
fn pages_load_nothing_from_other_hosts() {
    let server = Server::start();
    for (path, media_type) in [
        ("/", "text/html; charset=utf-8"),
        ("/docs", "text/html; charset=utf-8"),
        ("/page.js", "text/javascript; charset=utf-8"),
        ("/worker.js", "text/javascript; charset=utf-8"),
        ("/page.css", "text/css; charset=utf-8"),
        ("/docs.css", "text/css; charset=utf-8"),
        ("/docs.js", "text/javascript; charset=utf-8"),
    ] {
        let response = server.get(path).send().unwrap();
        assert_eq!(
            (response.status().as_u16(), header(&response, "content-type")),
            (200, media_type),
            "{path}"
        );
        let policy = header(&response, "content-security-policy");
        assert!(policy.starts_with("default-src 'none'") && !policy.contains("unsafe"), "{policy}");
        assert_eq!(header(&response, "x-content-type-options"), "nosniff");
        assert_eq!(header(&response, "referrer-policy"), "no-referrer");
        assert!(response.headers().get("access-control-allow-origin").is_none());
        // Names of namespaces, which nobody loads.
        let mut text = response.text().unwrap();
        for owner in ["www.w3.org", "schemas.microsoft.com", "schemas.openxmlformats.org"] {
            text = text.replace(&format!("http://{owner}/"), "");
        }
        assert!(!text.contains("http://") && !text.contains("https://"), "{path}");
    }
}

#[test]
fn what_the_page_loads_is_sent_compressed_and_once() {
    let server = Server::start();
    for path in ["/", "/page.js", "/worker.js", "/page.css"] {
        let packed = server.get(path).header("accept-encoding", "gzip").send().unwrap();
        assert_eq!(packed.headers()["content-encoding"], "gzip", "{path}");
        let tag = header(&packed, "etag").to_owned();
        let again = server.get(path).header("if-none-match", &tag).send().unwrap();
        assert_eq!((again.status().as_u16(), again.bytes().unwrap().len()), (304, 0), "{path}");
    }
}

#[test]
fn health_and_metrics_are_not_on_the_public_listener() {
    let server = Server::start();
    for path in ["/livez", "/readyz", "/metrics"] {
        assert_eq!(server.admin(path).status(), 200, "{path}");
        assert_eq!(server.get(path).send().unwrap().status(), 404, "{path}");
    }
    let metrics = server.admin("/metrics").text().unwrap();
    assert!(metrics.contains("meshmend_http_requests_total"), "{metrics}");
    assert!(metrics.contains("route=\"/livez\"") && metrics.contains("status=\"404\""), "{metrics}");
}

#[test]
fn the_health_check_asks_the_admin_listener() {
    let server = Server::start();
    let check = |address: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshmend"));
        command.args(["healthcheck", "--admin-listen", address]).env_remove("MESHMEND_ADMIN_LISTEN");
        command.output().unwrap().status.success()
    };
    assert!(check(&server.admin));
    // The public listener does not know the question.
    assert!(!check(&server.address));
    assert!(!check("off"));
}

#[test]
fn the_contract_is_there_as_json_and_compressed_for_those_who_take_it() {
    let server = Server::start();
    let plain: Value = server.get("/openapi.json").send().unwrap().json().unwrap();
    assert_eq!(plain["info"]["title"], "Meshmend");
    for path in ["/openapi.json", "/openapi.yaml"] {
        let whole = server.get(path).send().unwrap().bytes().unwrap().len();
        let packed = server.get(path).header("accept-encoding", "gzip").send().unwrap();
        assert_eq!(packed.headers()["content-encoding"], "gzip", "{path}");
        assert!(packed.bytes().unwrap().len() * 5 < whole, "{path}");
    }
}

#[test]
fn a_path_with_a_slash_at_its_end_is_answered_with_the_one_without() {
    let server = Server::start();
    let (status, code, problem) =
        crate::server::problem(server.post("/v1/repair/").body(SOLID).send().unwrap());
    assert_eq!((status, &*code, &problem["suggestion"]), (404, "not-found", &"/v1/repair".into()));
    let icon = server.get("/favicon.ico").send().unwrap();
    assert_eq!(icon.status(), 200);
    assert_eq!(icon.headers()["content-type"], "image/svg+xml");
}
