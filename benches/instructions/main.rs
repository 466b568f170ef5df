//! Instructions of the hot passes, counted by Valgrind and compared with `benches/instructions.json`:
//!
//! ```text
//! cargo bench --profile dev --bench instructions              # every pass
//! cargo bench --profile dev --bench instructions -- fill      # those with this in their name
//! MESHMEND_BLESS=1 cargo bench --profile dev --bench instructions
//! ```
//!
//! Fails when a pass takes more than its tolerance above the table. With `MESHMEND_BLESS` the table is written anew instead: see
//! what changed before you keep it. `docs/decisions/0050-instructions-are-counted.md` says what the counts are worth.

#![allow(clippy::print_stdout, reason = "a bench prints its figures")]

#[path = "../support/dented_sphere.rs"]
mod dented_sphere;

mod callgrind;
mod meshes;
mod passes;
mod table;

use self::passes::{PASSES, Pass};
use self::table::{Table, Word};
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::Mutex;

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.json");

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--bench")).collect();
    if let [flag, name] = words.as_slice()
        && flag == callgrind::RUN_ONE
    {
        let pass = PASSES.iter().find(|pass| pass.name == name).expect("the name of a pass");
        callgrind::run_counted(pass);
        return ExitCode::SUCCESS;
    }
    if !cfg!(debug_assertions) {
        println!("the table is of the profile that the tests are built with: add `--profile dev`");
        return ExitCode::FAILURE;
    }
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        println!("not compared: the table is of x86-64 with Linux");
        return ExitCode::SUCCESS;
    }
    let is_chosen =
        |pass: &&Pass| words.is_empty() || words.iter().any(|word| pass.name.contains(word.as_str()));
    let chosen: Vec<&Pass> = PASSES.iter().filter(is_chosen).collect();
    if chosen.is_empty() {
        println!("there is no such pass; there are: {}", names().join(", "));
        return ExitCode::FAILURE;
    }
    let counts = match count_all(&chosen) {
        Ok(counts) => counts,
        Err(fault) => {
            println!("{fault}");
            return ExitCode::FAILURE;
        }
    };
    let table = Table::read(TABLE);
    let is_blessed = std::env::var_os("MESHMEND_BLESS").is_some();
    if is_blessed {
        table.blessed(&names(), &counts).write(TABLE);
    }
    let is_as_before = compare(&table, &chosen, &counts);
    if is_blessed {
        println!("benches/instructions.json is written anew");
    } else if !is_as_before {
        println!("where it went: callgrind_annotate {}/PASS.callgrind", callgrind::FOLDER);
        println!("if that is right: MESHMEND_BLESS=1 cargo bench --profile dev --bench instructions");
    }
    if is_as_before || is_blessed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn names() -> Vec<&'static str> {
    PASSES.iter().map(|pass| pass.name).collect()
}

/// The instructions of these passes, by name, as many at a time as there are cores.
fn count_all(passes: &[&Pass]) -> Result<BTreeMap<String, u64>, String> {
    let (waiting, counts) = (Mutex::new(passes.iter()), Mutex::new(Ok(BTreeMap::new())));
    let next = || waiting.lock().expect("no count panics").next();
    let work = || {
        while let Some(pass) = next() {
            let count = callgrind::count(pass.name);
            let mut counts = counts.lock().expect("no count panics");
            match (count, counts.as_mut()) {
                (Ok(count), Ok(counts)) => drop(counts.insert(pass.name.to_owned(), count)),
                (Err(fault), Ok(_)) => *counts = Err(fault),
                (_, Err(_)) => return,
            }
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..cores).for_each(|_| drop(scope.spawn(work))));
    counts.into_inner().expect("no count panics")
}

/// Prints a line for each pass and what is to be done; true when nothing must be.
fn compare(table: &Table, passes: &[&Pass], counts: &BTreeMap<String, u64>) -> bool {
    println!("{:<24} {:>15} {:>15} {:>8}", "pass", "before", "now", "ratio");
    let (mut dearer, mut cheaper, mut missing) = (0, 0, 0);
    for pass in passes {
        let now = counts[pass.name];
        let Some(row) = table.row(pass.name) else {
            println!("{:<24} {:>15} {now:>15} {:>8}  not in the table", pass.name, "-", "-");
            missing += 1;
            continue;
        };
        let word = match row.judge(now) {
            Word::Same => String::new(),
            Word::Dearer => format!("  DEARER by more than {} %", row.tolerance_percent),
            Word::Cheaper => format!("  cheaper by more than {} %", row.tolerance_percent),
        };
        dearer += usize::from(row.judge(now) == Word::Dearer);
        cheaper += usize::from(row.judge(now) == Word::Cheaper);
        println!("{:<24} {:>15} {now:>15} {:>8.4}{word}", pass.name, row.instructions, row.ratio(now));
    }
    let stale = table.names_beside(&names());
    if cheaper > 0 {
        println!("{cheaper} of {} passes are cheaper: lower the table (MESHMEND_BLESS=1)", passes.len());
    }
    if !stale.is_empty() {
        println!("in the table, but no pass: {}", stale.join(", "));
    }
    if dearer + missing > 0 || !stale.is_empty() {
        println!("{dearer} dearer, {missing} not in the table, {} in the table alone", stale.len());
        return false;
    }
    println!("none of {} passes is dearer than the table says", passes.len());
    true
}
