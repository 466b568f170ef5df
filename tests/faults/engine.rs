//! The engine that fails: a mesh that begins with `fault` says how, any other one is repaired.

use meshmend::budget::{Budget, Stage};
use meshmend::formats::{Place, ReadError, ReadErrorKind};
use meshmend::pipeline::{self, Answer, Failure, Operation, Options};
use std::hint::black_box;
use std::io::Write as _;
use std::time::Duration;

/// Bytes of the result that the fault `large` makes.
pub(crate) const LARGE: usize = 64 << 20;

/// A tetrahedron without its last face.
const OPEN: &[u8] = b"OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n";

/// The engine of the tests.
pub(crate) fn run(
    operation: Operation,
    bytes: Vec<u8>,
    options: &Options,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let fault = bytes.strip_prefix(b"fault ").and_then(|fault| std::str::from_utf8(fault).ok());
    match fault {
        Some(fault) => budget.stage(Stage::Repair, || fail(fault.trim(), options, budget)),
        None => pipeline::run(operation, bytes, options, budget),
    }
}

fn fail(fault: &str, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    match fault {
        "memory" => use_all_memory(),
        "overflow" => drop(black_box(descend(0))),
        "abort" => std::process::abort(),
        "panic" => panic!("a planted panic"),
        "silence" => std::process::exit(0),
        "exit" => std::process::exit(3),
        "noise" => speak(b"this is not a word of the language\n"),
        "flood" => loop {
            speak(&[b'x'; 4096]);
        },
        "hang" => loop {
            std::thread::sleep(Duration::from_secs(1));
        },
        "spin" => loop {
            black_box(0);
        },
        "file" => write_without_end(),
        "large" => return large(options, budget),
        "reach" => return Err(told(&crate::confinement::reached())),
        _ => {}
    }
    Err(told(&["the fault did not happen"]))
}

/// A failure whose problem says this in `expected`.
fn told(what: &[&str]) -> Failure {
    let kind = ReadErrorKind::Unparseable { found: "a fault".to_owned() };
    Failure::Unreadable(ReadError {
        kind,
        place: Place::Whole,
        expected: format!("reached: {}", what.join(", ")),
    })
}

fn use_all_memory() {
    let mut blocks = Vec::new();
    loop {
        blocks.push(black_box(vec![1_u8; 16 << 20]));
    }
}

/// Calls itself until the stack is used up.
fn descend(depth: u64) -> u64 {
    let room = black_box([depth; 64]);
    if black_box(true) { descend(depth + 1) + room[black_box(7)] } else { 0 }
}

fn speak(bytes: &[u8]) {
    let mut output = std::io::stdout().lock();
    output.write_all(bytes).unwrap();
    output.flush().unwrap();
}

/// A file without a name, so that nothing is left of it.
fn write_without_end() {
    let mut file = tempfile::tempfile().unwrap();
    loop {
        file.write_all(&[0; 64 << 10]).unwrap();
    }
}

fn large(options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let mut answer = pipeline::run(Operation::Repair, OPEN, options, budget)?;
    if let Some(output) = &mut answer.output {
        output.bytes = Some(vec![b'7'; LARGE]);
    }
    Ok(answer)
}
