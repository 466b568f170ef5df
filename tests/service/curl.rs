//! Every block of `docs/http.md` runs as it stands there.

use crate::server::Server;
use crate::town::Town;
use std::path::Path;
use std::process::Command;

const STL: &str = "solid part\n\
    facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 10 0\nvertex 10 0 0\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 10 0 0\nvertex 0 0 10\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 10\nvertex 0 10 0\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 10 0 0\nvertex 0 10 0\nvertex 0 0 10\nendloop\nendfacet\n\
    endsolid part\n";
const OBJ: &str = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nusemtl red\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const MTL: &str = "newmtl red\nKd 1 0 0\n";

/// The blocks of a page that are for a shell.
fn blocks(page: &str) -> Vec<&str> {
    page.split("```sh\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn every_curl_line_of_the_documentation_works() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/http.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks = blocks(&page);
    assert!(blocks.len() > 10);
    run(&blocks, &["--webhooks", "--upload-bytes-max", "64MiB", "--webhook-attempts-max", "1"]);
}

#[test]
fn every_curl_line_of_the_documentation_works_on_a_server_with_its_defaults() {
    let page = include_str!("../../docs/http.md");
    run(&blocks(page), &[]);
}

#[test]
fn every_curl_line_of_the_documentation_works_on_a_server_that_gives_presigned_urls() {
    let Some(town) = Town::open() else { return };
    let page = include_str!("../../docs/http.md");
    run(&blocks(page), &town.settings("all", &["--presigned-ttl", "15min"]));
}

fn run(blocks: &[&str], settings: &[&str]) {
    let server = Server::with(settings);
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("part.stl", STL), ("part.obj", OBJ), ("part.mtl", MTL)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    // A line that fails ends the script, and tells which one it was.
    let script = format!("set -euxo pipefail\n{}", blocks.join("\n"));
    let script = script.replace("curl ", "curl -sS ");
    let ran = Command::new("bash")
        .args(["-c", &script])
        .current_dir(folder.path())
        .env("url", format!("http://{}", server.address))
        .env("admin", format!("http://{}", server.admin))
        .env("no_proxy", "*")
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{told}");
    let written = std::fs::read_to_string(folder.path().join("repaired.stl")).unwrap_or_default();
    assert!(!written.is_empty() || folder.path().join("repaired.stl").metadata().unwrap().len() > 84);
}

#[test]
fn every_operation_of_the_contract_is_in_the_documentation() {
    let page = include_str!("../../docs/http.md");
    let contract = meshmend::http::openapi_yaml();
    for line in contract.lines() {
        let Some(path) = line.strip_prefix("  /").and_then(|rest| rest.strip_suffix(':')) else { continue };
        let shown = format!("/{path}")
            .replace("/v1/jobs/{id}/deliveries/{delivery}", "$job/deliveries/$delivery")
            .replace("/v1/jobs/{id}", "$job")
            .replace("/v1/uploads/{id}", "$upload");
        assert!(page.contains(&format!("$url{shown}")), "{path} is not in docs/http.md");
    }
}
