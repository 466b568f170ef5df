//! What a process that runs a job can reach.

use crate::ends::{goes_on, problem_of, server};
use crate::meshes::OPEN;
use crate::server::Server;
use crate::supervision::waiting_of;
use rustix::process::{Resource, Rlimit, Signal, getppid, getrlimit, setrlimit, test_kill_process};
use serde_json::json;
use std::net::{TcpListener, TcpStream, UdpSocket};
use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::net::UnixDatagram;
use std::process::Command;

/// A limit raised, a signal sent, a file read: whatever of this a process can do. Run by the engine of the tests.
pub(crate) fn reached() -> Vec<&'static str> {
    let higher = || {
        let hard = getrlimit(Resource::Data).maximum?.checked_add(1)?;
        setrlimit(Resource::Data, Rlimit { current: Some(hard), maximum: Some(hard) }).ok()
    };
    let folder = std::path::PathBuf::from(std::env::args_os().nth(2).unwrap());
    let upload = folder.join("given/mesh");
    assert!(std::fs::File::open(&upload).is_ok(), "it reads what it is given");
    let tries: [(&str, bool); 15] = [
        ("the upload, to write it", std::fs::File::options().write(true).open(&upload).is_ok()),
        ("the upload, to remove it", std::fs::remove_file(&upload).is_ok()),
        ("the folders of others", std::fs::read_dir(folder.join("..")).is_ok()),
        ("a file of the system", std::fs::read("/etc/passwd").is_ok()),
        ("its own binary", std::fs::File::open("/proc/self/exe").is_ok()),
        ("a list of files", std::fs::read_dir("/").is_ok()),
        ("a new file", tempfile::tempfile().is_ok()),
        ("a connection", TcpStream::connect("127.0.0.1:9").is_err_and(|error| is_answered(&error))),
        ("a listener", TcpListener::bind("127.0.0.1:0").is_ok()),
        ("a datagram", UdpSocket::bind("127.0.0.1:0").is_ok()),
        ("a local socket", UnixDatagram::unbound().is_ok()),
        ("another program", Command::new("/bin/true").status().is_ok()),
        ("the server", getppid().is_some_and(|server| test_kill_process(server).is_ok())),
        ("a higher limit", higher().is_some()),
        ("a later death", rustix::process::set_parent_process_death_signal(None::<Signal>).is_ok()),
    ];
    // Threads are no way out, and must go on to work.
    assert_eq!(std::thread::spawn(|| 7).join().unwrap(), 7);
    tries.into_iter().filter_map(|(what, is_reached)| is_reached.then_some(what)).collect()
}

/// Nobody listens there: the answer shows that the question was asked.
fn is_answered(error: &std::io::Error) -> bool {
    error.kind() == std::io::ErrorKind::ConnectionRefused
}

pub(crate) fn a_confined_process_reaches_nothing() {
    let automatic = server(&[]);
    let is_complete =
        automatic.log().contains("landlock (ABI") && automatic.log().contains(", seccomp filter");
    if !is_complete {
        // A kernel without: then the server says so, and does not start where the sandbox is required.
        let (code, words) = refused(&["--sandbox", "require"]);
        assert_eq!(code, Some(2), "{words}");
        assert!(words.contains("`sandbox`"), "{words}");
        return;
    }
    for server in [automatic, server(&["--sandbox", "require"])] {
        let problem = problem_of(&server, "reach");
        assert_eq!(problem["expected"], "reached: ", "{problem}");
        goes_on(&server);
    }
}

pub(crate) fn a_process_inherits_no_descriptor_and_has_no_capability() {
    let folder = tempfile::tempdir().unwrap();
    let (script, secret) = (folder.path().join("server"), folder.path().join("secret"));
    std::fs::write(&secret, "secret").unwrap();
    let own = std::env::current_exe().unwrap();
    let words = format!("#!/bin/sh\nexec 7<'{}'\nexec '{}' \"$@\"\n", secret.display(), own.display());
    std::fs::write(&script, words).unwrap();
    std::fs::set_permissions(&script, std::fs::Permissions::from_mode(0o700)).unwrap();
    let server = Server::of(&script, &[]);
    let waiting = waiting_of(&server, 0);
    let open = |pid: u32| {
        let descriptors = std::fs::read_dir(format!("/proc/{pid}/fd")).unwrap();
        descriptors.filter_map(|entry| std::fs::read_link(entry.ok()?.path()).ok()).collect::<Vec<_>>()
    };
    assert!(open(server.pid()).contains(&secret), "the server was not started with the descriptor");
    assert!(!open(waiting).contains(&secret), "{:?}", open(waiting));
    if server.log().contains("no landlock, no seccomp filter") {
        return;
    }
    let status = std::fs::read_to_string(format!("/proc/{waiting}/status")).unwrap();
    let sets: Vec<&str> = status.lines().filter(|line| line.starts_with("Cap")).collect();
    let held = |line: &&str| u64::from_str_radix(line.split_whitespace().last().unwrap(), 16).unwrap();
    let is_bounding = |line: &&&str| line.starts_with("CapBnd");
    assert_eq!(sets.iter().filter(|line| !is_bounding(line)).map(held).max(), Some(0), "{sets:?}");
    // Only who may, which root may, takes capabilities out of the bounding set.
    if rustix::process::geteuid().is_root() {
        assert_eq!(sets.iter().find(is_bounding).map(held), Some(0), "{sets:?}");
    }
}

pub(crate) fn without_a_sandbox_the_limits_still_hold() {
    let server = server(&["--sandbox", "off", "--engine-bytes-max", "16MiB"]);
    assert!(server.log().contains("no landlock, no seccomp filter"), "{}", server.log());
    let problem = problem_of(&server, "reach");
    let reached = problem["expected"].as_str().unwrap_or_else(|| panic!("{problem}"));
    for what in ["a file of the system", "a connection", "the upload, to write it"] {
        assert!(reached.contains(what), "{reached}");
    }
    assert_eq!(problem_of(&server, "memory")["code"], "engine-out-of-memory");
    goes_on(&server);
}

pub(crate) fn a_sandbox_that_is_required_needs_a_process() {
    let (code, words) = refused(&["--sandbox", "require", "--isolation", "thread"]);
    assert_eq!(code, Some(2), "{words}");
    assert!(words.contains("`sandbox`") && words.contains("isolation = process"), "{words}");
}

pub(crate) fn threads_know_no_process() {
    let server = server(&["--isolation", "thread"]);
    let job = server.ended(&server.job("repair", OPEN));
    assert_eq!(job["state"], json!("succeeded"));
    let metrics = server.admin("/metrics").text().unwrap();
    assert!(!metrics.contains("meshmend_child_exits_total"), "{metrics}");
}

/// The exit code and the last words of a server that does not start.
fn refused(settings: &[&str]) -> (Option<i32>, String) {
    let data = tempfile::tempdir().unwrap();
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["serve", "--listen", "127.0.0.1:0", "--admin-listen", "off", "--data-dir"]);
    let output = command.arg(data.path()).args(settings).output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}
