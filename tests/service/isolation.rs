//! A process of its own changes where a job runs, not what comes of it.

use crate::meshes::{SOLID, long_job};
use crate::server::Server;
use serde_json::Value;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Every mesh under `fixtures/`.
fn meshes() -> Vec<PathBuf> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures")];
    let mut meshes = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().and_then(|extension| extension.to_str());
            if path.is_dir() {
                folders.push(path);
            } else if extension.is_some_and(|extension| ["obj", "stl", "off", "ply"].contains(&extension)) {
                meshes.push(path);
            }
        }
    }
    meshes.sort();
    meshes
}

/// What came of a job, but for its id and its times.
fn outcome(server: &Server, job: &Value) -> (Value, Option<Value>, Option<Vec<u8>>) {
    let job = server.until(job, |job| job["finished_at"].is_string());
    let content = |name: &str| {
        let path = job["links"][name].as_str()?;
        Some(server.get(path).send().unwrap().bytes().unwrap().to_vec())
    };
    let report = content("report").map(|report| {
        let mut report: Value = serde_json::from_slice(&report).unwrap();
        assert_eq!(report["timing_ms"], job["timing_ms"], "the job and its report tell the same times");
        report.as_object_mut().unwrap().remove("timing_ms");
        report
    });
    let mut problem = job["problem"].clone();
    if let Some(problem) = problem.as_object_mut() {
        problem.remove("instance");
    }
    (problem, report, content("result"))
}

#[test]
fn results_and_reports_are_the_same_in_a_process_and_in_a_thread() {
    let (process, thread) = (Server::start(), Server::with(&["--isolation", "thread"]));
    let meshes = meshes();
    assert!(meshes.len() > 30, "the fixtures were not found");
    let mut results = 0;
    for path in meshes {
        let mesh = std::fs::read(&path).unwrap();
        // Coarse where a surface must be rebuilt: what is compared is the way, not the work.
        for operation in ["repair&effort=low&wrap_cells=16", "simplify"] {
            let (here, there) = (process.job(operation, &*mesh), thread.job(operation, &*mesh));
            let (here, there) = (outcome(&process, &here), outcome(&thread, &there));
            let (problem, report) = (&here.0, &there.0);
            assert!(here == there, "{operation} {}: {problem} {report}", path.display());
            results += usize::from(here.2.is_some());
        }
    }
    assert!(results > 30, "only {results} results were compared");
    let metrics = process.admin("/metrics").text().unwrap();
    assert!(metrics.contains("meshmend_child_exits_total{kind=\"answered\"}"), "{metrics}");
}

#[test]
fn limits_of_the_engine_are_refused_by_the_engine_itself() {
    let server = Server::with(&["--engine-bytes-max", "16B"]);
    let job = server.ended(&server.job("repair", SOLID));
    assert_eq!(job["problem"]["code"], "engine-out-of-memory");
    assert_eq!(job["problem"]["limit"], 16);
    assert!(job["problem"]["actual"].as_u64() > Some(16), "{job}");
}

#[test]
fn several_results_come_from_a_process_as_several_files() {
    let path = "/v1/simplify?targets=[{\"faces\":100},{\"faces\":50}]";
    let archive = |server: Server| {
        let response =
            server.post(path).header("accept", "application/zip").body(long_job(10)).send().unwrap();
        assert_eq!(response.status(), 200);
        let bytes = response.bytes().unwrap();
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
        let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
        let meshes = names.iter().filter(|name| name.ends_with(".stl")).map(|name| {
            let mut mesh = Vec::new();
            archive.by_name(name).unwrap().read_to_end(&mut mesh).unwrap();
            mesh
        });
        meshes.collect::<Vec<_>>()
    };
    let (here, there) = (archive(Server::start()), archive(Server::with(&["--isolation", "thread"])));
    assert_eq!(here.len(), 2);
    assert!(here[0] != here[1] && here == there);
}

#[test]
fn the_server_says_what_holds_the_processes_of_jobs() {
    assert!(Server::start().log().contains("jobs run in processes of their own: "));
    assert!(!Server::with(&["--isolation", "thread"]).log().contains("processes of their own"));
}

#[test]
fn run_job_without_a_server_ends_with_a_word() {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_meshmend"));
    let output = command.arg("run-job").stdin(std::process::Stdio::null()).output().unwrap();
    assert!(!output.status.success() && output.stdout.is_empty());
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("meshmend: run-job: "));
}
