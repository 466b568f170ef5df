//! Time and memory of a rebuilt surface: `cargo bench --bench wrap -- [FILE] [CELLS]`.
//!
//! Wraps the triangles of FILE, or of a wavy sphere of 100,000 triangles, on a lattice of CELLS (256) along its longest
//! side, five times: signs and extraction alone, then with the fit. Prints the least time, the charged memory and the
//! triangles that come out.

#![allow(clippy::print_stdout, reason = "a bench prints its figures")]

use meshmend::budget::{Budget, StopFlag};
use meshmend::formats::{self, ReadOptions};
use meshmend::geom::DVec3;
use meshmend::wrap::{WrapOptions, wrap};
use std::time::{Duration, Instant};

/// Rows of the sphere from pole to pole: twice its square is half the number of triangles.
const ROWS: u32 = 158;

fn wavy_sphere() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let columns = 2 * ROWS;
    let point = |row: u32, column: u32| {
        let latitude = std::f64::consts::PI * (f64::from(row) + 0.5) / f64::from(ROWS);
        let longitude = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
        let radius = 50.0 + (9.0 * latitude).sin() * (7.0 * longitude).cos();
        DVec3::new(latitude.sin() * longitude.cos(), latitude.sin() * longitude.sin(), latitude.cos())
            * radius
    };
    let positions = (0..ROWS).flat_map(|row| (0..columns).map(move |column| point(row, column))).collect();
    let id = |row: u32, column: u32| row * columns + column % columns;
    let patch = |(row, column): (u32, u32)| {
        let [a, b, c, d] =
            [id(row, column), id(row + 1, column), id(row + 1, column + 1), id(row, column + 1)];
        [[a, b, c], [a, c, d]]
    };
    let patches = (0..ROWS - 1).flat_map(|row| (0..columns).map(move |column| (row, column)));
    (positions, patches.flat_map(patch).collect())
}

fn of_file(path: &str) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let budget = Budget::unlimited();
    let encoding = formats::sniff(&bytes, None).unwrap_or_else(|error| panic!("{path}: {error}"));
    let soup = formats::read(&bytes, encoding, &ReadOptions::default(), &budget)
        .unwrap_or_else(|error| panic!("{path}: {error}"));
    (soup.positions, soup.triangles)
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let cells = words.iter().find_map(|word| word.parse().ok()).unwrap_or(256);
    let file = words.iter().find(|word| word.parse::<u32>().is_err());
    let (positions, triangles) = file.map_or_else(wavy_sphere, |path| of_file(path));
    println!("{} triangles, {cells} cells", triangles.len());
    for is_fitted in [false, true] {
        // As many cells as are asked for, however large the surface is.
        let no_other_limit = WrapOptions {
            vertices_max: 1 << 28,
            visits_max: u64::MAX,
            area_max: f64::MAX,
            ..WrapOptions::default()
        };
        let options = WrapOptions { cells, is_fitted, ..no_other_limit };
        let (mut least, mut peak, mut count, mut actual) = (Duration::MAX, 0, 0, 0);
        for _ in 0..5 {
            let budget = Budget::new(StopFlag::default(), u64::MAX, u64::MAX);
            let start = Instant::now();
            let wrapped = wrap(&positions, &triangles, &options, &budget).expect("it can be wrapped");
            least = least.min(start.elapsed());
            (peak, count, actual) = (budget.bytes_peak(), wrapped.triangles.len(), wrapped.account.cells);
        }
        let what = if is_fitted { "with the fit" } else { "signs and extraction" };
        println!(
            "{what}: {:.2} s, {} MiB charged, {count} triangles, {actual} cells",
            least.as_secs_f64(),
            peak >> 20
        );
    }
}
