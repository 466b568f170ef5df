//! A PostgreSQL server for tests: Debian's own, in a temporary directory, without a port. It ends with the process that
//! started it, however that ends.

use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::{Mutex, OnceLock};

/// Makes the server, tells its directory, and starts it anew for each line that it reads; at the end of its input all goes.
const KEEPER: &str = r#"
cd / && dir=$(mktemp -d /tmp/meshmend-postgres.XXXXXX) || exit 1
control() {
    "$1/pg_ctl" -D "$dir/data" -l "$dir/log" -w -t 60 \
        -o "-k '$dir' -c listen_addresses='' -c max_connections=400" "$2" -m immediate >>"$dir/log" 2>&1 </dev/null
}
if "$1/initdb" -D "$dir/data" -U meshmend --auth=trust --no-sync --encoding=UTF8 --locale=C >"$dir/log" 2>&1 &&
    control "$1" start
then
    echo "$dir"
    while read -r _; do control "$1" restart; echo "$?"; done
    control "$1" stop
else
    cat "$dir/log" >&2
fi
rm -rf "$dir"
"#;

/// A server that runs.
pub(crate) struct Server {
    dir: PathBuf,
    keeper: Mutex<Keeper>,
}

/// The process that started it.
struct Keeper {
    process: Child,
    answers: BufReader<ChildStdout>,
}

impl Drop for Keeper {
    fn drop(&mut self) {
        // At the end of its input it stops the server and removes the directory.
        drop(self.process.stdin.take());
        // One that is gone already is waited for, too.
        let _ = self.process.wait();
    }
}

/// Where the server's programs are, if they are installed: those of the newest version.
pub(crate) fn programs() -> Option<PathBuf> {
    let versions = std::fs::read_dir("/usr/lib/postgresql").ok()?;
    let number = |path: &PathBuf| path.file_name()?.to_str()?.parse::<u32>().ok();
    let newest = versions.flatten().map(|entry| entry.path()).max_by_key(number)?;
    Some(newest.join("bin")).filter(|bin| bin.join("initdb").exists())
}

impl Server {
    /// The one that all tests of this process share.
    pub(crate) fn shared() -> &'static Self {
        static SHARED: OnceLock<Server> = OnceLock::new();
        SHARED.get_or_init(Self::start)
    }

    /// Starts another one.
    pub(crate) fn start() -> Self {
        let programs = programs().expect("PostgreSQL is installed");
        // The server refuses to run as root.
        let mut command = if rustix::process::geteuid().is_root() {
            let mut command = Command::new("runuser");
            command.args(["-u", "nobody", "--", "sh"]);
            command
        } else {
            Command::new("sh")
        };
        command.args(["-c", KEEPER, "keeper"]).arg(programs).process_group(0);
        let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let answers = BufReader::new(process.stdout.take().unwrap());
        let mut keeper = Keeper { process, answers };
        let mut dir = String::new();
        keeper.answers.read_line(&mut dir).unwrap();
        assert!(!dir.is_empty(), "PostgreSQL cannot be started: see above");
        Self { dir: dir.trim().into(), keeper: Mutex::new(keeper) }
    }

    /// How a database of it is addressed.
    pub(crate) fn url(&self, database: &str) -> String {
        format!("host={} user=meshmend dbname={database}", self.dir.display())
    }

    /// Ends the server at once, as a crash does, and starts it anew. Blocks.
    pub(crate) fn crash_and_start(&self) {
        let mut keeper = self.keeper.lock().unwrap();
        writeln!(keeper.process.stdin.as_mut().unwrap(), "anew").unwrap();
        let mut result = String::new();
        keeper.answers.read_line(&mut result).unwrap();
        assert_eq!(result.trim(), "0");
    }
}
