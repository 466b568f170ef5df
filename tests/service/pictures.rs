//! Pictures: drawn by themselves, kept with a job, shown in the page of its report, and written by the command line.

use crate::meshes::{CROSSING, OPEN, SOLID};
use crate::server::{Server, header, link, problem};
use serde_json::Value;
use std::process::Command;

/// Width and height of a PNG, and its number of frames.
fn size(bytes: &[u8]) -> (u32, u32, u32) {
    let read = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let info = read.info();
    (info.width, info.height, info.animation_control().map_or(1, |control| control.num_frames))
}

fn drawn(server: &Server, query: &str) -> (u32, u32, u32) {
    let response = server.post(&format!("/v1/render{query}")).body(CROSSING).send().unwrap();
    assert_eq!(
        (response.status().as_u16(), header(&response, "content-type")),
        (200, "image/png"),
        "{query}"
    );
    size(&response.bytes().unwrap())
}

#[test]
fn a_mesh_comes_in_and_a_picture_goes_out() {
    let server = Server::start();
    assert_eq!(drawn(&server, ""), (640, 480, 1));
    assert_eq!(drawn(&server, "?views=four&width=200&height=100&edges=all&shade=flat"), (400, 200, 1));
    assert_eq!(
        drawn(&server, "?views=all&width=64&height=64&projection=perspective&defects=false"),
        (192, 192, 1)
    );
    assert_eq!(drawn(&server, "?turntable=6&width=100&height=80"), (100, 80, 6));
    let report =
        server.post("/v1/render").header("accept", "application/json").body(CROSSING).send().unwrap();
    let report: Value = report.json().unwrap();
    assert_eq!(report["operation"], "render");
    assert!(report["timing_ms"]["draw"].as_f64().is_some() && report["before"]["defects"][0].is_object());
}

#[test]
fn what_is_no_wish_for_a_picture_is_refused() {
    let server = Server::start();
    let ask = |path: &str| problem(server.post(path).body(SOLID).send().unwrap());
    for path in [
        "/v1/render?width=8",
        "/v1/render?views=inside",
        "/v1/render?turntable=1",
        "/v1/render?turntable=4&views=front",
        "/v1/render?turntable=4&projection=perspective",
        "/v1/render?turntable=120&width=2048&height=2048",
    ] {
        let (status, code, _) = ask(path);
        assert_eq!((status, code.as_str()), (400, "invalid-parameter"), "{path}");
    }
    for path in ["/v1/render?wall_mm=1", "/v1/render?thumbnail=true", "/v1/analyze?views=iso"] {
        let (status, code, _) = ask(path);
        assert_eq!((status, code.as_str()), (400, "unknown-parameter"), "{path}");
    }
    let response = server.post("/v1/render").header("accept", "image/jpeg").body(SOLID).send().unwrap();
    assert_eq!(problem(response).0, 406);
    let (status, code, _) = problem(server.post("/v1/render").body("OFF\n4 4 6\n0 0 zero\n").send().unwrap());
    assert_eq!((status, code.as_str()), (422, "mesh-unparseable"));
}

#[test]
fn a_thumbnail_is_kept_with_its_job_and_goes_with_it() {
    let server = Server::start();
    let submit = |query: &str| {
        let response = server.post(&format!("/v1/jobs?operation=repair{query}")).body(OPEN).send().unwrap();
        server.ended(&response.json().unwrap())
    };
    let job = submit("&thumbnail=true");
    let path = link(&job, "thumbnail").to_owned();
    assert_eq!(path, format!("{}/thumbnail.png", link(&job, "self")));
    let response = server.get(&path).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "content-type")), (200, "image/png"));
    let tag = header(&response, "etag").to_owned();
    let picture = response.bytes().unwrap();
    assert_eq!(size(&picture), (960, 360, 1), "before and after");
    let again = server.get(&path).header("if-none-match", tag).send().unwrap();
    assert_eq!((again.status().as_u16(), again.bytes().unwrap().len()), (304, 0));

    let page = |job: &Value| {
        let report = format!("{}/report", link(job, "self"));
        server.get(&report).header("accept", "text/html").send().unwrap().text().unwrap()
    };
    assert!(page(&job).contains("src=\"data:image/png;base64,iVBOR"));

    let without = submit("");
    assert!(without["links"]["thumbnail"].is_null());
    let (status, code, body) =
        problem(server.get(&format!("{}/thumbnail.png", link(&without, "self"))).send().unwrap());
    assert_eq!((status, code.as_str()), (404, "not-found"));
    assert!(body["detail"].as_str().unwrap().contains("thumbnail=true"), "{body}");
    assert!(!page(&without).contains("<img"));

    let cached = submit("&thumbnail=true");
    assert_eq!(cached["cached"], true);
    assert_eq!(server.get(link(&cached, "thumbnail")).send().unwrap().bytes().unwrap(), picture);
    for job in [&job, &without, &cached] {
        assert_eq!(server.request("DELETE", link(job, "self")).send().unwrap().status(), 204);
    }
    assert_eq!(server.get(&path).send().unwrap().status(), 404);
    assert!(server.stored_files().is_empty(), "{:?}", server.stored_files());
}

#[test]
fn a_picture_may_be_a_mesh_that_viewers_turn() {
    let server = Server::start();
    let glb = "model/gltf-binary";
    let drawn = server.post("/v1/render?picture_format=glb").body(CROSSING).send().unwrap();
    assert_eq!((drawn.status().as_u16(), header(&drawn, "content-type")), (200, glb));
    let drawn = drawn.bytes().unwrap();
    assert!(drawn.starts_with(b"glTF"));
    let accepted = server.post("/v1/render").header("accept", glb).body(CROSSING).send().unwrap();
    assert_eq!(accepted.bytes().unwrap(), drawn);
    let without = server.post("/v1/render?picture_format=glb&defects=false").body(CROSSING).send().unwrap();
    assert_ne!(without.bytes().unwrap(), drawn, "defects have colours");
    for choice in ["views=front", "turntable=4", "width=100"] {
        let path = format!("/v1/render?picture_format=glb&{choice}");
        let (status, code, _) = problem(server.post(&path).body(CROSSING).send().unwrap());
        assert_eq!((status, code.as_str()), (400, "invalid-parameter"), "{path}");
    }
    let views = server.post("/v1/render?views=front").header("accept", glb).body(CROSSING).send().unwrap();
    assert_eq!(problem(views).0, 400);
    for (format, accept) in [("png", glb), ("glb", "image/png")] {
        let path = format!("/v1/render?picture_format={format}");
        let refused = server.post(&path).header("accept", accept).body(CROSSING).send().unwrap();
        assert_eq!(problem(refused).0, 406, "{path}");
    }
    let response = server.post("/v1/jobs?operation=render&picture_format=glb").body(CROSSING).send().unwrap();
    let job = server.ended(&response.json().unwrap());
    let path = link(&job, "thumbnail").to_owned();
    assert_eq!(path, format!("{}/thumbnail.glb", link(&job, "self")));
    let kept = server.get(&path).send().unwrap();
    assert_eq!(header(&kept, "content-type"), glb);
    assert_eq!(kept.bytes().unwrap(), drawn);
    let (status, _, body) = problem(server.get(&path.replace(".glb", ".png")).send().unwrap());
    assert_eq!(status, 404);
    assert!(body["detail"].as_str().unwrap().contains(glb), "{body}");
    let report = format!("{}/report", link(&job, "self"));
    let page = server.get(&report).header("accept", "text/html").send().unwrap().text().unwrap();
    assert!(!page.contains("<img"), "a page shows no mesh");
}

#[test]
fn a_picture_outlasts_a_killed_server_and_is_the_same_in_either_isolation() {
    let of = |isolation: &str| {
        let server = Server::with(&["--isolation", isolation]);
        let response =
            server.post("/v1/jobs?operation=analyze&thumbnail=true").body(CROSSING).send().unwrap();
        let job = server.ended(&response.json().unwrap());
        let server = server.killed_and_restarted(&["--isolation", isolation]);
        server.get(link(&job, "thumbnail")).send().unwrap().bytes().unwrap()
    };
    let picture = of("process");
    assert_eq!(size(&picture), (480, 360, 1));
    assert_eq!(picture, of("thread"));
}

#[test]
fn the_command_line_writes_pictures_and_pages_with_them() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("open.off", OPEN), ("solid.off", SOLID)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let run = |args: &[&str]| {
        let command =
            Command::new(env!("CARGO_BIN_EXE_meshmend")).current_dir(folder.path()).args(args).output();
        let output = command.unwrap();
        (output.status.code(), output.stdout)
    };
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(
        run(&["render", "open.off", "-o", "open.png", "--width", "300", "--height", "200"]).0,
        Some(0)
    );
    assert_eq!(size(&read("open.png")), (300, 200, 1));
    assert_eq!(run(&["render", "open.off", "--after", "solid.off", "-o", "both.png"]).0, Some(0));
    assert_eq!(size(&read("both.png")), (1280, 480, 1));
    assert_eq!(run(&["render", "open.off", "solid.off", "-d", "all"]).0, Some(0));
    assert_eq!(size(&read("all/solid.png")), (640, 480, 1));
    let (code, bytes) = run(&["render", "open.off", "-o", "-"]);
    assert_eq!((code, size(&bytes)), (Some(0), (640, 480, 1)));
    assert_eq!(run(&["render", "open.off"]).0, Some(2), "a picture has to go somewhere");
    assert_eq!(run(&["render", "open.off", "--after", "solid.off", "-o", "both.glb"]).0, Some(0));
    assert!(read("both.glb").starts_with(b"glTF"));
    assert_eq!(run(&["render", "open.off", "solid.off", "-d", "all", "--picture-format", "glb"]).0, Some(0));
    assert!(read("all/solid.glb").starts_with(b"glTF"));
    for (format, name) in [("glb", "a.png"), ("png", "a.glb"), ("glb", "a.jpg")] {
        assert_eq!(run(&["render", "open.off", "-o", name, "--picture-format", format]).0, Some(2), "{name}");
    }
    assert_eq!(run(&["repair", "open.off", "-o", "r.off", "--report-html", "report.html"]).0, Some(0));
    assert!(String::from_utf8(read("report.html")).unwrap().contains("src=\"data:image/png;base64,"));
}

/// The examples of the page, by the ids of their calls.
fn examples(page: &str, language: &str) -> Vec<(String, String)> {
    let articles = page.split("<article id=").skip(1);
    let of = |article: &str| {
        let id = article.split(' ').next()?.to_owned();
        let code = article.split(&format!("<pre class={language} ")).nth(1)?.split("<code>").nth(1)?;
        let code = code.split("</code>").next()?;
        let code = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&amp;", "&")]
            .iter()
            .fold(code.to_owned(), |code, (from, to)| code.replace(from, to));
        Some((id, code))
    };
    articles.filter_map(of).collect()
}

/// Runs every example of `language` by `command`, which is given a file with `begin` before the example.
fn run_examples(language: &str, command: &str, extension: &str, begin: impl Fn(&str, &str) -> String) {
    let server = Server::start();
    let page = server.get("/docs").send().unwrap().text().unwrap();
    let mut examples = examples(&page, language);
    assert!(examples.len() > 20, "{}", examples.len());
    // A job that has not ended yet cannot be cancelled in vain, and one that is deleted is there no more.
    let order =
        |id: &str| ["cancel_job", "delete_job"].iter().position(|last| *last == id).map_or(0, |at| at + 1);
    examples.sort_by_key(|(id, _)| order(id));
    let response =
        server.post("/v1/jobs?operation=repair&thumbnail=true").body(OPEN).send().unwrap().json().unwrap();
    let job = link(&server.ended(&response), "self").to_owned();
    let folder = tempfile::tempdir().unwrap();
    for name in ["part.stl", "other.stl"] {
        std::fs::write(folder.path().join(name), SOLID).unwrap();
    }
    let url = format!("http://{}", server.address);
    // There are no webhooks here, and so no delivery to repeat; the picture of the job is no mesh.
    let has_none = |id: &str| ["redeliver", "get_job_thumbnail_mesh"].contains(&id);
    for (id, code) in examples.iter().filter(|(id, _)| !has_none(id)) {
        let script = folder.path().join(format!("example.{extension}"));
        std::fs::write(&script, format!("{}\n{code}\n", begin(&url, &job))).unwrap();
        let ran = Command::new(command)
            .arg(&script)
            .current_dir(folder.path())
            .env("no_proxy", "*")
            .env("NO_PROXY", "*")
            .output()
            .unwrap();
        assert!(ran.status.success(), "{id}: {code}\n{}", String::from_utf8_lossy(&ran.stderr));
    }
    for file in ["repaired.stl", "both.stl", "part.png", "part.obj", "openapi.yaml"] {
        assert!(std::fs::metadata(folder.path().join(file)).unwrap().len() > 50, "{file}");
    }
}

#[test]
fn every_curl_example_of_the_reference_works() {
    run_examples("curl", "bash", "sh", |url, job| format!("set -eu\nurl={url}\njob={job}"));
}

#[test]
fn every_python_example_of_the_reference_works() {
    run_examples("python", "python3", "py", |url, job| format!("url = \"{url}\"\njob = \"{job}\""));
}

#[test]
fn every_typescript_example_of_the_reference_works() {
    let has_node = Command::new("node").arg("--version").output().is_ok_and(|told| told.status.success());
    if !has_node {
        #[allow(clippy::print_stderr, reason = "a test that runs nothing says so")]
        {
            eprintln!("node is not here: no example was run");
        }
        return;
    }
    // They use no types, so that they are JavaScript too.
    run_examples("typescript", "node", "mjs", |url, job| {
        format!("const url = \"{url}\";\nconst job = \"{job}\";")
    });
}
