//! Seconds per stage on a given mesh file, as JSON: `cargo bench --bench stages -- FILE [RUNS]`.
//!
//! `read`: bytes to welded soup. `analyze_and_certify`: the whole report with exact self-intersections *and* the
//! certificate, from the soup in memory. `analyze`, `analyze_near`, `analyze_volume`: the report alone with contacts known,
//! the same with the search for what is near, and with the volume as an interval. `experiments/speed.py` sets these beside other programs in one run.

#![allow(clippy::print_stdout, reason = "a bench prints its figures")]

use meshmend::analysis::{AnalyzeOptions, NearSearch, analyze};
use meshmend::budget::Budget;
use meshmend::certificate::{Depth, examine};
use meshmend::formats::{ReadOptions, read, sniff};
use std::hint::black_box;
use std::time::Instant;

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// Median seconds of `runs` calls after one that is not counted.
fn timed<T>(runs: usize, body: impl Fn() -> T) -> f64 {
    black_box(body());
    let seconds = |_| {
        let start = Instant::now();
        black_box(body());
        start.elapsed().as_secs_f64()
    };
    median((0..runs).map(seconds).collect())
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let Some(file) = args.first() else {
        println!("usage: cargo bench --bench stages -- FILE [RUNS]");
        return;
    };
    let runs = args.get(1).map_or(5, |n| n.parse().expect("RUNS is a number"));
    let bytes = std::fs::read(file).expect("FILE can be read");
    let (options, budget) = (ReadOptions::default(), Budget::unlimited());
    let encoding = sniff(&bytes, None).expect("a known format");
    let soup = read(&bytes, encoding, &options, &budget).expect("a readable mesh");
    let depth = Depth::Count { samples: 16 };
    let analyze_and_certify = || {
        let found = examine(&soup, &bytes, encoding, &options, depth, &budget).expect("examined");
        analyze(&soup, found.contacts.as_ref(), &AnalyzeOptions::default(), &budget).expect("analyzed")
    };
    let known = examine(&soup, &bytes, encoding, &options, depth, &budget).expect("examined").contacts;
    let analyzed =
        |options: &AnalyzeOptions| timed(runs, || analyze(&soup, known.as_ref(), options, &budget));
    let plain = AnalyzeOptions::default();
    println!(
        "{{\"triangles\": {}, \"read\": {:.4}, \"certify\": {:.4}, \"analyze_and_certify\": {:.4}, \
         \"analyze\": {:.4}, \"analyze_near\": {:.4}, \"analyze_volume\": {:.4}}}",
        soup.triangles.len(),
        timed(runs, || read(&bytes, encoding, &options, &budget)),
        timed(runs, || examine(&soup, &bytes, encoding, &options, depth, &budget)),
        timed(runs, analyze_and_certify),
        analyzed(&plain),
        analyzed(&AnalyzeOptions { near: NearSearch::ByDiagonal, ..plain }),
        analyzed(&AnalyzeOptions { volume_interval: true, ..plain }),
    );
}
