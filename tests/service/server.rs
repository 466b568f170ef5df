//! A server of the built binary for one test, and what a client does with it.

use reqwest::blocking::{Client, RequestBuilder, Response};
use serde_json::Value;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Patience of the tests; only what hangs meets it.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// A server on free ports, with a data folder of its own. Killed when dropped.
pub(crate) struct Server {
    child: Child,
    pub(crate) address: String,
    pub(crate) admin: String,
    client: Client,
    binary: PathBuf,
    /// What it has logged.
    heard: Arc<Mutex<String>>,
    data: Arc<tempfile::TempDir>,
}

impl Server {
    pub(crate) fn start() -> Self {
        Self::with(&[])
    }

    /// A server with further settings, as flags.
    pub(crate) fn with(settings: &[&str]) -> Self {
        Self::of(env!("CARGO_BIN_EXE_meshmend").as_ref(), settings)
    }

    /// A server of another binary that takes the same command line.
    pub(crate) fn of(binary: &Path, settings: &[&str]) -> Self {
        Self::on(binary, Arc::new(tempfile::tempdir().unwrap()), settings)
    }

    /// Kills it and starts another one on the same data folder.
    pub(crate) fn killed_and_restarted(self, settings: &[&str]) -> Self {
        self.killed_for(Duration::ZERO, settings)
    }

    /// Kills it and starts another one on the same data folder after a pause.
    pub(crate) fn killed_for(mut self, pause: Duration, settings: &[&str]) -> Self {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
        std::thread::sleep(pause);
        Self::on(&self.binary, Arc::clone(&self.data), settings)
    }

    /// Kills it; its data folder stays as long as what this gives.
    pub(crate) fn killed(mut self) -> Arc<tempfile::TempDir> {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
        Arc::clone(&self.data)
    }

    /// Starts one on the data folder of one that was killed.
    pub(crate) fn again(data: Arc<tempfile::TempDir>, settings: &[&str]) -> Self {
        Self::on(env!("CARGO_BIN_EXE_meshmend").as_ref(), data, settings)
    }

    /// Starts another one on the same data folder after this one has ended.
    pub(crate) fn restarted(mut self, settings: &[&str]) -> Self {
        assert_eq!(self.exit_code(), Some(0));
        Self::on(&self.binary, Arc::clone(&self.data), settings)
    }

    /// The files of uploads and results.
    pub(crate) fn stored_files(&self) -> Vec<PathBuf> {
        files_under(&self.data_dir().join("spool"))
    }

    fn on(binary: &Path, data: Arc<tempfile::TempDir>, settings: &[&str]) -> Self {
        // The client could speak TLS, and asks by what, although it never does here. Told twice, the first word stays.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let client = Client::builder().timeout(PATIENCE).build().unwrap();
        let mut command = Command::new(binary);
        for (name, _) in std::env::vars_os() {
            if name.to_string_lossy().starts_with("MESHMEND_") {
                command.env_remove(name);
            }
        }
        // Tests ask as often as they like; those of the limit give it as a flag, which goes before this.
        command.env("MESHMEND_RATE_PER_MINUTE", "0");
        command.args(["serve", "--listen", "127.0.0.1:0", "--admin-listen", "127.0.0.1:0", "--data-dir"]);
        command.arg(data.path().join("data")).args(settings).stdin(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut log = BufReader::new(child.stderr.take().unwrap());
        let mut seen = String::new();
        // A server that only runs jobs has no such address.
        let is_worker = settings.windows(2).any(|pair| pair == ["--role", "worker"]);
        let address =
            if is_worker { String::new() } else { bound(&mut log, "listening on http://", &mut seen) };
        let admin = bound(&mut log, "health and metrics on http://", &mut seen);
        // The pipe must not fill up.
        let heard = Arc::new(Mutex::new(seen));
        let hearing = Arc::clone(&heard);
        std::thread::spawn(move || {
            let mut line = String::new();
            while log.read_line(&mut line).is_ok_and(|bytes| bytes > 0) {
                hearing.lock().unwrap().push_str(&line);
                line.clear();
            }
        });
        Self { child, address, admin, client, binary: binary.to_owned(), heard, data }
    }

    pub(crate) fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.address)
    }

    pub(crate) fn get(&self, path: &str) -> RequestBuilder {
        self.client.get(self.url(path))
    }

    pub(crate) fn post(&self, path: &str) -> RequestBuilder {
        self.client.post(self.url(path))
    }

    pub(crate) fn request(&self, method: &str, path: &str) -> RequestBuilder {
        self.client.request(method.parse().unwrap(), self.url(path))
    }

    /// An answer of the admin listener.
    pub(crate) fn admin(&self, path: &str) -> Response {
        self.client.get(format!("http://{}{path}", self.admin)).send().unwrap()
    }

    /// The log since it has been listening.
    pub(crate) fn log(&self) -> String {
        self.heard.lock().unwrap().clone()
    }

    /// Asks until the log has a line with all of `words`, and gives it.
    pub(crate) fn logged(&self, words: &[&str]) -> String {
        let begun = Instant::now();
        loop {
            let log = self.log();
            if let Some(line) = log.lines().find(|line| words.iter().all(|word| line.contains(word))) {
                return line.to_owned();
            }
            assert!(begun.elapsed() < PATIENCE, "no line with {words:?} in {log}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// A connection on which a test speaks for itself.
    pub(crate) fn connect(&self) -> Line {
        let stream = TcpStream::connect(&self.address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Line(stream)
    }

    /// Makes a job and does not wait for it.
    pub(crate) fn job(&self, operation: &str, mesh: impl Into<Vec<u8>>) -> Value {
        let path = format!("/v1/jobs?operation={operation}");
        let response = self.post(&path).body(mesh.into()).send().unwrap();
        assert_eq!(response.status(), 202);
        response.json().unwrap()
    }

    /// The job when it has ended.
    pub(crate) fn ended(&self, job: &Value) -> Value {
        self.get(&format!("{}?wait=60", link(job, "self"))).send().unwrap().json().unwrap()
    }

    /// Asks until `is_so`.
    pub(crate) fn until(&self, job: &Value, is_so: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let job: Value = self.get(link(job, "self")).send().unwrap().json().unwrap();
            if is_so(&job) {
                return job;
            }
            assert!(begun.elapsed() < PATIENCE, "{job}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Sends a signal by its name.
    pub(crate) fn signal(&self, name: &str) {
        signal(self.pid(), name);
    }

    /// Its process.
    pub(crate) fn pid(&self) -> u32 {
        self.child.id()
    }

    /// The folder of its data.
    pub(crate) fn data_dir(&self) -> PathBuf {
        self.data.path().join("data")
    }

    /// The exit code, once it has ended by itself.
    pub(crate) fn exit_code(&mut self) -> Option<i32> {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.code();
            }
            assert!(begun.elapsed() < PATIENCE, "the server does not end");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn files_under(dir: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files_under(&path) } else { vec![path] }).collect()
}

/// The address that the log tells behind `words`.
fn bound(log: &mut BufReader<ChildStderr>, words: &str, seen: &mut String) -> String {
    loop {
        let mut line = String::new();
        assert!(log.read_line(&mut line).unwrap() > 0, "the server did not start: {seen}");
        if let Some((_, address)) = line.trim().split_once(words) {
            let address = address.split('"').next().unwrap_or_default();
            return address.to_owned();
        }
        seen.push_str(&line);
    }
}

/// Sends a signal by its name.
pub(crate) fn signal(pid: u32, name: &str) {
    assert!(try_signal(pid, name));
}

/// Sends a signal by its name. False: there is no such process any more.
pub(crate) fn try_signal(pid: u32, name: &str) -> bool {
    let line = format!("kill -{name} {pid} 2>/dev/null");
    Command::new("sh").args(["-c", &line]).status().unwrap().success()
}

pub(crate) fn link<'j>(job: &'j Value, name: &str) -> &'j str {
    job["links"][name].as_str().unwrap_or_else(|| panic!("no link {name}: {job}"))
}

pub(crate) fn header<'r>(response: &'r Response, name: &str) -> &'r str {
    response.headers().get(name).map_or("", |value| value.to_str().unwrap())
}

/// The status of the problem that an answer must be, and its code.
pub(crate) fn refused(response: Response) -> (u16, String) {
    let (status, code, _) = problem(response);
    (status, code)
}

/// The same, expected.
pub(crate) fn is(status: u16, code: &str) -> (u16, String) {
    (status, code.to_owned())
}

/// The problem that an answer must be, with its code. Every problem is checked for what all have in common.
pub(crate) fn problem(response: Response) -> (u16, String, Value) {
    let status = response.status().as_u16();
    assert_eq!(header(&response, "content-type"), "application/problem+json", "status {status}");
    assert!(!header(&response, "x-request-id").is_empty());
    let problem: Value = response.json().unwrap();
    let code = problem["code"].as_str().unwrap().to_owned();
    assert_eq!(problem["status"], status, "{problem}");
    assert_eq!(problem["type"], format!("/v1/errors#{code}"), "{problem}");
    assert!(
        !problem["title"].as_str().unwrap().is_empty() && !problem["detail"].as_str().unwrap().is_empty()
    );
    (status, code, problem)
}

/// A connection on which every byte is said by the test.
pub(crate) struct Line(TcpStream);

impl Line {
    pub(crate) fn say(&mut self, bytes: impl AsRef<[u8]>) {
        self.0.write_all(bytes.as_ref()).unwrap();
    }

    /// As [`say`](Self::say); false when the other end does not listen any more.
    pub(crate) fn try_say(&mut self, bytes: impl AsRef<[u8]>) -> bool {
        self.0.write_all(bytes.as_ref()).is_ok()
    }

    /// Whether the other end closes without a word.
    pub(crate) fn is_closed(&mut self) -> bool {
        match self.0.read(&mut [0]) {
            Ok(bytes) => bytes == 0,
            // It was closed with bytes of ours unread.
            Err(error) => error.kind() == std::io::ErrorKind::ConnectionReset,
        }
    }

    /// Everything until the other end closes.
    pub(crate) fn hear_all(&mut self) -> String {
        let mut bytes = Vec::new();
        self.0.read_to_end(&mut bytes).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// The next `len` bytes.
    pub(crate) fn hear(&mut self, len: usize) -> String {
        let mut bytes = vec![0; len];
        self.0.read_exact(&mut bytes).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// Asks until there is an answer.
pub(crate) fn patiently<T>(ask: impl Fn() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(begun.elapsed() < PATIENCE, "nothing has come of it");
        std::thread::sleep(Duration::from_millis(20));
    }
}
