//! Time from the stop flag to the return of a running engine: `cargo bench --bench cancel -- [CANCELS] [ROWS] [crossing | holes]`.
//!
//! A wavy sphere with holes, flipped and doubled faces, so that every pass has work, is repaired again and again and
//! stopped after a random share of the time of a full run (fixed seed). Prints the number of cancels that came in
//! time, the median, the 99th percentile and the worst time to return in milliseconds, and the pass that was slowest
//! to return. 1,000 cancels of 160,000 triangles (200 rows) take a few minutes, of 500,000 (354 rows) about ten.
//! With `crossing` it is two such spheres that pass through each other, so that the surface is rebuilt, which takes seconds.
//! With `holes` it is the filling of holes by each method instead, of rims with 2,048 and 65,536 corners and of 10,000 small ones;
//! further words choose cases whose names have them, such as `2,048` and `Rbf`.

#![allow(clippy::print_stdout, reason = "a bench prints its figures")]

use meshmend::budget::{Budget, ProgressEvent, Stage, StopFlag, Stopped};
use meshmend::pipeline::{Failure, FillHolesChoices, Operation, Options, run};
use meshmend::repair::fill::{Extract, FillOptions, Method};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

/// SplitMix64: the next number of a fixed sequence.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}

/// A point of the sphere at `row` of `rows` from pole to pole and `column` of `2 * rows` around, in millimetres.
fn point(row: u32, column: u32, rows: u32) -> [f32; 3] {
    let (latitude, longitude) = (
        std::f64::consts::PI * f64::from(row) / f64::from(rows),
        std::f64::consts::PI * f64::from(column % (2 * rows)) / f64::from(rows),
    );
    let is_pole = row == 0 || row == rows;
    let radius = if is_pole { 50.0 } else { 50.0 + (9.0 * latitude).sin() * (7.0 * longitude).cos() };
    let sine = if is_pole { 0.0 } else { latitude.sin() };
    let height = if row == rows { -1.0 } else { latitude.cos() };
    [sine * longitude.cos() * radius, sine * longitude.sin() * radius, height * radius].map(|x| x as f32)
}

/// Two triangles for each of the `2 * rows * rows` patches, one at the poles; every 5,000th is missing, flipped or double.
fn triangles(rows: u32) -> Vec<[[f32; 3]; 3]> {
    let mut sound = Vec::new();
    for row in 0..rows {
        for column in 0..2 * rows {
            let corner = |r, c| point(row + r, column + c, rows);
            if row > 0 {
                sound.push([corner(0, 0), corner(1, 0), corner(0, 1)]);
            }
            if row + 1 < rows {
                sound.push([corner(0, 1), corner(1, 0), corner(1, 1)]);
            }
        }
    }
    let mut damaged = Vec::with_capacity(sound.len() + sound.len() / 5000);
    for (i, triangle) in sound.into_iter().enumerate() {
        let [a, b, c] = triangle;
        match i % 15_000 {
            5_000 => {}
            10_000 => damaged.push([a, c, b]),
            14_999 => damaged.extend([triangle, triangle]),
            _ => damaged.push(triangle),
        }
    }
    damaged
}

fn binary_stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// How long the engine took to return from a pass that was told to stop.
struct Return {
    time: Duration,
    stage: Stage,
}

/// What is run again and again.
struct Case {
    operation: Operation,
    options: Options,
    bytes: Vec<u8>,
}

/// Runs a case and raises the flag after `delay`; `None`: the run was faster.
fn cancel_after(case: &Case, delay: Duration) -> Option<Return> {
    let stop = StopFlag::default();
    let stage = Arc::new(Mutex::new(Stage::Read));
    let entered = Arc::clone(&stage);
    let observer = Box::new(move |event| {
        if let ProgressEvent::Enter(stage) = event {
            *entered.lock().expect("not poisoned") = stage;
        }
    });
    let budget = Budget::new(stop.clone(), u64::MAX, u64::MAX).observed_by(observer);
    let raised = OnceLock::new();
    let (result, returned) = std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(delay);
            raised.set(Instant::now()).expect("raised once");
            stop.cancel();
        });
        let result = run(case.operation, &case.bytes, &case.options, &budget);
        (result, Instant::now())
    });
    let is_cancelled = matches!(result, Err(Failure::Stopped(Stopped::Cancelled)));
    let stage = *stage.lock().expect("not poisoned");
    let raised = raised.into_inner().expect("raised");
    is_cancelled.then(|| Return { time: returned.duration_since(raised), stage })
}

/// A tube of `corners` triangles around in three rows, open at both ends, whose rims wave and are jagged.
fn tube(corners: u32) -> Vec<[[f32; 3]; 3]> {
    let at = |row: u32, i: u32| {
        let i = i % corners;
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(corners);
        let tooth = if i.is_multiple_of(2) { 0.3 } else { 0.0 } * std::f64::consts::TAU / f64::from(corners);
        let radius = 50.0 * (1.0 - tooth);
        [radius * turn.cos(), radius * turn.sin(), 12.0 * f64::from(row) + 5.0 * (5.0 * turn).sin()]
            .map(|x| x as f32)
    };
    let cells = (0..3).flat_map(|row| (0..corners).map(move |i| (row, i)));
    cells
        .flat_map(|(row, i)| {
            let [a, b, c, d] = [at(row, i), at(row, i + 1), at(row + 1, i + 1), at(row + 1, i)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// A sphere without the triangles around every fourth vertex of every fourth row.
fn sieve(rows: u32) -> Vec<[[f32; 3]; 3]> {
    let mut left = Vec::new();
    for row in 1..rows - 1 {
        for column in 0..2 * rows {
            let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(r, c)| (row + r, (column + c) % (2 * rows)));
            let is_out = |k: usize| corners[k].0 % 4 == 2 && corners[k].1 % 4 == 0;
            let corner = |k: usize| point(corners[k].0, corners[k].1, rows);
            for t in [[0, 1, 2], [2, 1, 3]] {
                if !t.into_iter().any(is_out) {
                    left.push(t.map(corner));
                }
            }
        }
    }
    left
}

fn hole_cases() -> Vec<(String, Case)> {
    let meshes =
        [("2,048 corners", tube(2_048)), ("65,536 corners", tube(65_536)), ("10,000 holes", sieve(284))];
    let methods = [Method::Flat, Method::Minimal, Method::Smooth, Method::Creased, Method::Rbf, Method::Auto];
    let extracts = [Extract::March, Extract::Mesh].map(|extract| (Method::Rbf, extract));
    let ways = methods.map(|method| (method, Extract::Project)).into_iter().chain(extracts);
    let case = |(method, extract): (Method, Extract), triangles: &[[[f32; 3]; 3]]| {
        let fill = FillOptions { method, extract, ..FillOptions::default() };
        let filling = FillHolesChoices { fill, ..FillHolesChoices::default() };
        let options = Options { filling, ..Options::default() };
        Case { operation: Operation::FillHoles, options, bytes: binary_stl(triangles) }
    };
    let all = meshes.iter().flat_map(|(name, triangles)| ways.clone().map(move |way| (name, way, triangles)));
    all.map(|(name, way, triangles)| (format!("{name}, {:?}, {:?}", way.0, way.1), case(way, triangles)))
        .collect()
}

fn measure(name: &str, case: &Case, cancels: u32) {
    let start = Instant::now();
    let answer = run(case.operation, &case.bytes, &case.options, &Budget::unlimited()).expect("a full run");
    let full = start.elapsed();
    let outcome = answer.report.outcome;
    let holes = answer.report.filling.as_ref().map(|filling| {
        let told = filling.holes.iter().filter_map(|hole| hole.told.as_ref());
        let used: std::collections::BTreeSet<_> = told.map(|told| format!("{:?}", told.used)).collect();
        format!(", \"used\": {used:?}")
    });
    drop(answer);
    let mut seed = 7;
    let delay = |_| full.mul_f64((next(&mut seed) >> 11) as f64 / (1_u64 << 53) as f64);
    let mut returns: Vec<Return> =
        (0..cancels).map(delay).filter_map(|delay| cancel_after(case, delay)).collect();
    assert!(!returns.is_empty(), "no cancel came in time");
    returns.sort_unstable_by_key(|returned| returned.time);
    let at = |share: f64| &returns[((share * returns.len() as f64).ceil() as usize).saturating_sub(1)];
    let ms_at = |share: f64| at(share).time.as_secs_f64() * 1000.0;
    println!(
        "{{\"case\": \"{name}\", \"outcome\": \"{outcome:?}\"{}, \"full_ms\": {:.0}, \"cancels\": {}, \"p50_ms\": {:.2}, \"p99_ms\": {:.2}, \"max_ms\": {:.2}, \"slowest\": \"{}\"}}",
        holes.unwrap_or_default(),
        full.as_secs_f64() * 1000.0,
        returns.len(),
        ms_at(0.5),
        ms_at(0.99),
        ms_at(1.0),
        at(1.0).stage.name(),
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |word: &str| arguments.iter().any(|argument| argument == word);
    let numbers: Vec<u32> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let cancels = numbers.first().copied().unwrap_or(1000);
    if has("holes") {
        let is_chosen = |name: &str| {
            let mut words =
                arguments.iter().filter(|word| word.parse::<u32>().is_err() && !word.starts_with('-'));
            words.all(|word| word == "holes" || name.contains(word.as_str()))
        };
        let chosen = hole_cases().into_iter().filter(|(name, _)| is_chosen(name));
        chosen.for_each(|(name, case)| measure(&name, &case, cancels));
        return;
    }
    let rows = numbers.get(1).copied().unwrap_or(200);
    let mut triangles = triangles(rows);
    if has("crossing") {
        let across = triangles.clone().into_iter().map(|t| t.map(|[x, y, z]| [x + 41.0, y + 7.0, z + 3.0]));
        triangles.extend(across);
    }
    let name = format!("repair of {} triangles", triangles.len());
    let bytes = binary_stl(&triangles);
    measure(&name, &Case { operation: Operation::Repair, options: Options::default(), bytes }, cancels);
}
