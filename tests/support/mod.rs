//! What several test folders share.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How many cases a randomised test runs: `small` in every test run, `full` when `MESHMEND_CAMPAIGN` is set
/// (`scripts/campaign.sh` sets it).
pub(crate) fn cases(small: usize, full: usize) -> usize {
    if std::env::var_os("MESHMEND_CAMPAIGN").is_some() { full } else { small }
}

/// Number of the part of a campaign that can be run in parts, from 1: the value of `MESHMEND_CAMPAIGN`.
pub(crate) fn campaign_part() -> u64 {
    std::env::var("MESHMEND_CAMPAIGN").ok().and_then(|part| part.parse().ok()).unwrap_or(1)
}

/// The corpus of real meshes, if it is there; otherwise says so and gives `None`, and the test has nothing to measure.
#[allow(clippy::print_stderr, reason = "a test that measures nothing says so")]
pub(crate) fn corpus() -> Option<PathBuf> {
    let root = std::env::var_os("MESHMEND_CORPUS")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus"), PathBuf::from);
    if root.join("MANIFEST.tsv").exists() {
        return Some(root);
    }
    eprintln!(
        "the corpus of real meshes is not here: {} (set MESHMEND_CORPUS); nothing measured",
        root.display()
    );
    None
}

/// The corpus's files with one of `extensions` (in any case), in a fixed order; see [`corpus`].
pub(crate) fn corpus_files(extensions: &[&str]) -> Option<Vec<PathBuf>> {
    let mut folders = vec![corpus()?];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
            if path.is_dir() {
                folders.push(path);
            } else if extensions.contains(&extension.as_str()) {
                files.push(path);
            }
        }
    }
    files.sort();
    Some(files)
}

/// Runs `body` for every number below `count` on all cores, each of which takes the next one when it is free; results in
/// order. A panic inside is a panic here.
pub(crate) fn on_all_cores<R: Send>(count: usize, body: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (body, next) = (&body, &AtomicUsize::new(0));
    let numbers =
        move || std::iter::from_fn(move || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&i| i < count));
    std::thread::scope(|scope| {
        let parts: Vec<_> = (0..cores)
            .map(|_| scope.spawn(move || numbers().map(|i| (i, body(i))).collect::<Vec<(usize, R)>>()))
            .collect();
        let mut results: Vec<(usize, R)> = parts
            .into_iter()
            .flat_map(|part| part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect();
        results.sort_unstable_by_key(|(i, _)| *i);
        results.into_iter().map(|(_, result)| result).collect()
    })
}
