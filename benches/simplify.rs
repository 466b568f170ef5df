//! Speed of simplification on a given mesh file, as a line of JSON:
//! `cargo bench --bench simplify -- FILE [SHARE] [quadric|memoryless|length] [optimal|onto-end]
//! [strict|fast|guarded] [OUT.off]`.
//!
//! `seconds`: from the triangles in memory to the simplified triangles in memory, the best of three runs. `peak_bytes`:
//! what the engine charged to its budget, beside the input and the result. Cut first where the file is no manifold
//! (not timed).

#![allow(clippy::print_stdout, reason = "a bench prints its figures")]

use meshmend::budget::Budget;
use meshmend::formats::{ReadOptions, read, sniff};
use meshmend::mesh::{Soup, cut_singular};
use meshmend::simplify::{
    CriterionKind, Mode, Placement, Simplified, SimplifyInput, SimplifyOptions, Target, simplify,
};
use std::fmt::Write;
use std::time::Instant;

fn manifold(file: &str) -> Soup {
    let bytes = std::fs::read(file).expect("FILE can be read");
    let (options, budget) = (ReadOptions::default(), Budget::unlimited());
    let encoding = sniff(&bytes, None).expect("a known format");
    let mut soup = read(&bytes, encoding, &options, &budget).expect("a readable mesh");
    soup.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let cut = cut_singular(&mut soup.triangles, soup.positions.len(), &budget).expect("cut");
    let copies: Vec<_> = cut.copies.iter().map(|&v| soup.positions[v as usize]).collect();
    soup.positions.extend(copies);
    soup
}

fn off(mesh: &Simplified) -> String {
    let mut text = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.triangles.len());
    for p in &mesh.positions {
        writeln!(text, "{} {} {}", p.x, p.y, p.z).expect("text grows");
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(text, "3 {a} {b} {c}").expect("text grows");
    }
    text
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let Some(file) = args.first() else {
        println!(
            "usage: cargo bench --bench simplify -- FILE [SHARE] [CRITERION] [PLACEMENT] [MODE] [OUT.off]"
        );
        return;
    };
    let word = |i: usize, default: &str| args.get(i).map_or(default.to_owned(), Clone::clone);
    let soup = manifold(file);
    let options = SimplifyOptions {
        targets: vec![Target::Ratio(word(1, "0.1").parse().expect("SHARE is a number"))],
        criterion: match word(2, "quadric").as_str() {
            "memoryless" => CriterionKind::Memoryless,
            "length" => CriterionKind::Length,
            _ => CriterionKind::Quadric,
        },
        placement: match word(3, "optimal").as_str() {
            "onto-end" => Placement::OntoEnd,
            _ => Placement::Optimal,
        },
        ..SimplifyOptions::default()
    };
    let mode = match word(4, "strict").as_str() {
        "fast" => Mode::Fast,
        "guarded" => Mode::Guarded,
        _ => Mode::Strict,
    };
    let input = SimplifyInput::new(&soup.positions, &soup.triangles);
    let mut best = f64::INFINITY;
    let mut last = None;
    for _ in 0..3 {
        let budget = Budget::unlimited();
        let start = Instant::now();
        let levels = simplify(&input, mode, &options, &budget).expect("a manifold");
        best = best.min(start.elapsed().as_secs_f64());
        last = levels.into_iter().next().map(|level| (level, budget.bytes_peak()));
    }
    let (level, peak) = last.expect("one target");
    println!(
        "{{\"faces\": {}, \"faces_after\": {}, \"seconds\": {best:.4}, \"faces_per_s\": {:.0}, \"peak_bytes\": {peak}, \
         \"peak_bytes_per_face\": {:.0}, \"collapses\": {}, \"refusals\": {}, \"error_max\": {:e}}}",
        soup.triangles.len(),
        level.report.faces_after,
        soup.triangles.len() as f64 / best,
        peak as f64 / soup.triangles.len() as f64,
        level.report.collapses,
        level.report.refusals.total(),
        level.report.error_max,
    );
    if let Some(path) = args.get(5) {
        std::fs::write(path, off(&level)).expect("OUT can be written");
    }
}
