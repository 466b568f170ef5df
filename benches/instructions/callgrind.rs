//! Runs a pass in a process of its own below Valgrind, which counts the instructions between two points.

use crate::passes::{Body, Pass};
use meshmend::par;
use std::any::Any;
use std::hint::black_box;
use std::process::Command;

/// Tells the program to run the pass whose name follows.
pub(crate) const RUN_ONE: &str = "--run-one";

/// Where the counts by function are left.
pub(crate) const FOLDER: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/instructions");

/// Counting is on inside the function whose name contains this.
const COUNTED: &str = "run_body_counted";

/// The instructions of the pass of this name, or what is wrong.
pub(crate) fn count(name: &str) -> Result<u64, String> {
    std::fs::create_dir_all(FOLDER).map_err(|error| format!("{FOLDER}: {error}"))?;
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let file = format!("{FOLDER}/{name}.callgrind");
    // Without the variables of the caller, whose length moves the stack. One thread; and the copy and search routines of the C
    // library that every processor has.
    let run = Command::new("valgrind")
        .env_clear()
        .envs(std::env::var_os("PATH").map(|path| ("PATH", path)))
        .env("RAYON_NUM_THREADS", "1")
        .env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-ERMS,-FSRM")
        .args(["--tool=callgrind", "--quiet", &format!("--toggle-collect=*{COUNTED}*")])
        .arg(format!("--callgrind-out-file={file}"))
        .arg(program)
        .args([RUN_ONE, name])
        .output()
        .map_err(|error| format!("valgrind cannot be started ({error}): install it"))?;
    if !run.status.success() {
        return Err(format!("{name}: {}\n{}", run.status, String::from_utf8_lossy(&run.stderr)));
    }
    let profile = std::fs::read_to_string(&file).map_err(|error| format!("{file}: {error}"))?;
    let total = profile.lines().find_map(|line| line.strip_prefix("totals: "));
    match total.and_then(|total| total.trim().parse().ok()) {
        Some(count) if count > 0 => Ok(count),
        _ => Err(format!("{name}: nothing was counted in `{COUNTED}`")),
    }
}

/// Prepares the input of a pass and runs it, with one engine thread.
pub(crate) fn run_counted(pass: &Pass) {
    par::with_threads(1, || drop(run_body_counted((pass.prepare)())));
}

#[inline(never)]
fn run_body_counted(body: Body) -> Box<dyn Any> {
    black_box(body())
}
