//! What is on the disk: private, whole, and not lost with its store.

use crate::meshes::{OPEN, SOLID};
use crate::server::{Server, header, link, problem};
use serde_json::Value;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Everything in a folder, and the folder.
fn all_in(dir: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    let below = entries.flat_map(|path| if path.is_dir() { all_in(&path) } else { vec![path] });
    below.chain([dir.to_owned()]).collect()
}

#[test]
fn a_bare_start_makes_files_for_its_user_alone() {
    let server = Server::with(&["--webhooks"]);
    server.ended(&server.job("repair", OPEN));
    for path in all_in(&server.data_dir()) {
        let mode = path.metadata().unwrap().permissions().mode() & 0o777;
        assert_eq!(mode & 0o077, 0, "{} has mode {mode:o}", path.display());
    }
    assert!(server.data_dir().join("store.key").exists());
}

#[test]
fn a_file_that_the_disk_has_changed_is_answered_to_nobody_and_made_again() {
    let server = Server::start();
    let job = server.ended(&server.job("repair", OPEN));
    let whole = server.get(link(&job, "result")).send().unwrap();
    let digest = header(&whole, "repr-digest").to_owned();
    let mesh = whole.bytes().unwrap();
    let stored: Vec<_> =
        server.stored_files().into_iter().filter(|path| std::fs::read(path).unwrap() == mesh).collect();
    let mut bytes = mesh.to_vec();
    bytes[9] ^= 1;
    for path in &stored {
        std::fs::write(path, &bytes).unwrap();
        let later = std::time::SystemTime::now() + std::time::Duration::from_secs(1);
        std::fs::File::options().append(true).open(path).unwrap().set_modified(later).unwrap();
    }
    assert_eq!(problem(server.get(link(&job, "result")).send().unwrap()).1, "expired");
    let again = server.post("/v1/repair").body(OPEN).send().unwrap();
    assert_eq!((again.status().as_u16(), header(&again, "repr-digest")), (200, digest.as_str()));
    assert_eq!(again.bytes().unwrap(), mesh);
    assert!(
        server.admin("/metrics").text().unwrap().contains("meshmend_files_unsound_total{kind=\"damaged\"} 1")
    );
}

#[test]
fn a_job_whose_upload_is_lost_is_told_with_410() {
    let server = Server::start();
    let job = server.ended(&server.job("analyze", SOLID));
    for path in server.stored_files().iter().filter(|path| path.to_string_lossy().contains("/in/")) {
        std::fs::remove_file(path).unwrap();
    }
    let input = serde_json::json!({ "input": { "job": job["id"] } });
    let (status, code, problem) = problem(server.post("/v1/verify").json(&input).send().unwrap());
    assert_eq!((status, code.as_str(), &problem["parameter"]), (410, "expired", &"input".into()));
    let again = server.request("DELETE", link(&job, "self")).send().unwrap();
    assert_eq!(again.status(), 204);
}

#[test]
fn a_server_whose_store_is_gone_does_not_start_and_says_what_to_do() {
    let server = Server::start();
    let job = server.ended(&server.job("repair", OPEN));
    let files = server.stored_files();
    let (dir, data) = (server.data_dir(), server.killed());
    for end in ["", "-wal", "-shm"] {
        let _ = std::fs::remove_file(dir.join(format!("jobs.sqlite3{end}")));
    }
    for _ in 0..2 {
        let refused = Command::new(env!("CARGO_BIN_EXE_meshmend"))
            .args(["serve", "--listen", "127.0.0.1:0", "--admin-listen", "off", "--data-dir"])
            .arg(&dir)
            .output()
            .unwrap();
        let words = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{words}");
        assert!(
            words.contains("`data_dir`") && words.contains("--adopt") && words.contains("--discard"),
            "{words}"
        );
        assert!(files.iter().all(|file| file.exists()), "nothing was removed");
    }
    let server = Server::again(data, &["--adopt"]);
    assert_eq!(server.stored_files(), Vec::<PathBuf>::new());
    let adopted = all_in(&dir.join("adopted")).into_iter().filter(|path| path.is_file()).count();
    assert_eq!(adopted, files.len());
    assert_eq!(problem(server.get(link(&job, "self")).send().unwrap()).1, "not-found");
    let job: Value = server.ended(&server.job("repair", OPEN));
    let server = server.killed_and_restarted(&[]);
    assert_eq!(server.get(link(&job, "result")).send().unwrap().status(), 200);
}

#[test]
fn a_store_without_its_mark_is_known_by_the_pieces_of_an_upload() {
    let server = Server::start();
    let upload =
        server.post("/v1/uploads").header("tus-resumable", "1.0.0").header("upload-length", OPEN.len());
    let begun = upload
        .header("content-type", "application/offset+octet-stream")
        .body(OPEN[..OPEN.len() / 2].to_owned())
        .send()
        .unwrap();
    assert_eq!(begun.status(), 201);
    let path = header(&begun, "location").to_owned();
    let (dir, data) = (server.data_dir(), server.killed());
    std::fs::remove_file(dir.join("spool.mark")).unwrap();
    let server = Server::again(data, &[]);
    let asked = server.request("HEAD", &path).header("tus-resumable", "1.0.0").send().unwrap();
    assert_eq!(header(&asked, "upload-offset"), (OPEN.len() / 2).to_string());
}
