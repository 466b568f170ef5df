//! Files that are small for the work they ask for, each family of `experiments/hostile_files.py` at a small size: every
//! operation ends with an answer within the bound that is known before, the same with any number of threads.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use crate::support::cases;
use meshmend::budget::{Budget, StopFlag};
use meshmend::certificate::Certificate;
use meshmend::formats::Encoding;
use meshmend::par;
use meshmend::pipeline::{Failure, FidelityLimits, Operation, Options, Outcome, run, work_units_max};
use std::fmt::Write as _;

/// Bytes that a small file may have charged at one time.
const BYTES_MAX: u64 = 1 << 30;

/// How a run ended, and the work that it took. What repairs and combines gets a part of its bound here, and all of it in the
/// campaign: the bound itself takes minutes.
fn ended(operation: Operation, name: &str, bytes: &[u8], options: &Options) -> (String, u64) {
    let changes = matches!(operation, Operation::Repair | Operation::Boolean);
    let part = if changes { cases(20, 1) as u64 } else { 1 };
    let units = work_units_max(operation, bytes.len(), options).unwrap() / part;
    let budget = Budget::new(StopFlag::default(), u64::MAX, BYTES_MAX);
    let answer = budget.within(units, || run(operation, bytes, options, &budget));
    let answer = answer.transpose().unwrap_or(Err(Failure::OverBudget { units }));
    assert!(budget.work_used() <= units, "{name}: {} of {units}", budget.work_used());
    let word = match answer {
        Ok(answer) => {
            let report = &answer.report;
            if changes {
                let is_refused = report.outcome == Some(Outcome::Refused);
                assert_eq!(is_refused, report.refusal.is_some(), "{name}");
                let certificate = report.certificate.as_ref();
                assert!(is_refused || certificate.is_some_and(Certificate::is_printable), "{name}");
            }
            format!("{:?} {:?}", report.outcome, report.refusal.as_ref().map(std::mem::discriminant))
        }
        Err(failure @ Failure::OverBudget { .. }) => failure.to_string(),
        Err(failure) => panic!("{name}: {failure}"),
    };
    (word, budget.work_used())
}

/// All operations on a file.
fn check(name: &str, bytes: &[u8]) {
    for operation in [Operation::Analyze, Operation::Verify, Operation::Repair] {
        ended(operation, name, bytes, &Options::default());
    }
}

fn check_soup(name: &str, soup: &RawSoup, encoding: Encoding) {
    check(name, &encode(soup, encoding));
}

/// Triangles of corners of their own.
fn soup_of(triangles: impl IntoIterator<Item = [[f64; 3]; 3]>) -> RawSoup {
    let positions: Vec<[f64; 3]> = triangles.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    RawSoup { positions, triangles }
}

fn point(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| random.unit())
}

fn random_triangles(count: usize) -> RawSoup {
    let mut random = Random::new(count as u64);
    soup_of((0..count).map(|_| std::array::from_fn(|_| point(&mut random))))
}

/// `n` beams along x through `n` beams along y, turned about z where that is asked.
fn beams(n: usize, is_turned: bool) -> RawSoup {
    let length = 2.0 * n as f64 + 1.0;
    let mut all = RawSoup::default();
    for i in 0..n {
        let at = 2.0 * i as f64;
        all = all.with(&cuboid([length, 1.0, 1.0]).moved([-1.0, at, 0.0]));
        all = all.with(&cuboid([1.0, length, 1.0]).moved([at, -1.0, 0.25]));
    }
    if is_turned {
        for [x, y, _] in &mut all.positions {
            (*x, *y) = (0.8 * *x - 0.6 * *y, 0.6 * *x + 0.8 * *y);
        }
    }
    all
}

/// Boxes that all hold the origin, turned anyhow.
fn boxes_at_one_place(count: usize) -> RawSoup {
    let mut random = Random::new(7);
    (0..count).fold(RawSoup::default(), |all, _| {
        let size: [f64; 3] = std::array::from_fn(|_| 0.5 + random.unit());
        let mut one = cuboid(size).moved(size.map(|x| -x / 2.0));
        for (u, v) in [(0, 1), (1, 2), (0, 1)] {
            let (sin, cos) = (std::f64::consts::TAU * random.unit()).sin_cos();
            for p in &mut one.positions {
                (p[u], p[v]) = (cos * p[u] - sin * p[v], sin * p[u] + cos * p[v]);
            }
        }
        all.with(&one)
    })
}

#[test]
fn hostile_triangles_end_within_their_bound() {
    for count in [20, 60, cases(60, 1000)] {
        check_soup("random triangles", &random_triangles(count), Encoding::StlBinary);
    }
    let mut random = Random::new(5);
    let sliver = |random: &mut Random| {
        let [a, b] = [point(random), point(random)];
        [a, b, b.map(|x| x + 1e-6 * random.unit())]
    };
    check_soup("slivers", &soup_of((0..300).map(|_| sliver(&mut random))), Encoding::Off);
    let plane = |random: &mut Random| {
        let corners: [[f64; 3]; 3] = std::array::from_fn(|_| point(random).map(|x| 20.0 * (x - 0.5)));
        corners
    };
    check_soup("planes", &soup_of((0..30).map(|_| plane(&mut random))), Encoding::StlBinary);
    let flat = |random: &mut Random| {
        let [a, d]: [[f64; 3]; 2] = std::array::from_fn(|_| point(random).map(|x| (64.0 * x).floor()));
        [a, std::array::from_fn(|k| a[k] + d[k]), std::array::from_fn(|k| a[k] + 2.0 * d[k])]
    };
    check_soup("no area", &soup_of((0..2000).map(|_| flat(&mut random))), Encoding::StlBinary);
    let one = [[0.0; 3], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0]];
    check_soup("copies", &soup_of(std::iter::repeat_n(one, 2000)), Encoding::StlBinary);
    let far = cube().with(&soup_of([[[20.0, 0.0, 0.0]; 3]]));
    check_soup("a degenerate triangle far away", &far, Encoding::StlBinary);
    let limits = FidelityLimits { deviation_max: Some(1e-9), ..FidelityLimits::default() };
    let options = Options { limits, ..Options::default() };
    ended(Operation::Repair, "no deviation", &encode(&soup_of([one]), Encoding::StlBinary), &options);
}

#[test]
fn hostile_bodies_end_within_their_bound() {
    for is_turned in [false, true] {
        check_soup("beams", &beams(8, is_turned), Encoding::StlBinary);
    }
    check_soup("boxes at one place", &boxes_at_one_place(12), Encoding::StlBinary);
    let there = beams(4, false);
    check_soup("both directions", &there.clone().with(&there.inside_out()), Encoding::StlBinary);
    let at = |i: usize| [i % 5, i / 5 % 5, i / 25].map(|x| x as f64);
    let boxes = (0..125).fold(RawSoup::default(), |all, i| all.with(&cube().moved(at(i))));
    check_soup("touching boxes", &boxes, Encoding::PlyBinaryLittleEndian);
    let is_open = |i: usize| [i % 3, i / 3 % 3, i / 9].iter().filter(|&&x| x == 1).count() > 1;
    let at = |i: usize| [i % 3, i / 3 % 3, i / 9].map(|x| x as f64);
    let sponge = (0..27).filter(|&i| !is_open(i));
    let sponge = sponge.fold(RawSoup::default(), |all, i| all.with(&cube().moved(at(i))));
    check_soup("Menger sponge", &sponge, Encoding::Off);
    let nested = (1..60).fold(RawSoup::default(), |all, i| {
        let size = f64::from(i);
        all.with(&cuboid([size; 3]).moved([-size / 2.0; 3]))
    });
    check_soup("nested shells", &nested, Encoding::StlBinary);
}

/// An OBJ of the quads of cuboids.
fn quads(cuboids: &RawSoup, is_inside_out: bool) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in &cuboids.positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for halves in cuboids.triangles.chunks_exact(2) {
        let ([a, b, c], [_, _, d]) = (halves[0], halves[1]);
        let [a, b, c, d] = if is_inside_out { [d, c, b, a] } else { [a, b, c, d] }.map(|v| v + 1);
        writeln!(text, "f {a} {b} {c} {d}").unwrap();
    }
    text.into_bytes()
}

#[test]
fn grids_of_beams_are_united_with_a_small_part_of_their_bound() {
    let n = 20;
    let size = n as f64;
    let volume = 2.0 * size * (2.0 * size + 1.0) - 0.75 * size * size;
    let crumb = cube().scaled(0.5).moved([500.0, 300.0, 100.0]);
    for is_turned in [false, true] {
        let grid = beams(n, is_turned);
        let files = [
            ("triangles", encode(&grid, Encoding::StlBinary), volume),
            ("quads", quads(&grid, false), volume),
            ("quads inside out", quads(&grid, true), volume),
            ("a crumb away from it", quads(&grid.with(&crumb), false), volume + 0.125),
        ];
        for (name, bytes, volume) in files {
            let options = Options::default();
            // They take about a half of it, and twice of it where each decision counts as one by integers.
            let units = work_units_max(Operation::Repair, bytes.len(), &options).unwrap() / 50;
            let budget = Budget::new(StopFlag::default(), units, BYTES_MAX);
            let report = run(Operation::Repair, &bytes, &options, &budget).unwrap().report;
            assert_eq!(report.outcome, Some(Outcome::Repaired), "{name}, {is_turned}: {:?}", report.tried);
            let enclosed: f64 = report.certificate.unwrap().shells.iter().map(|shell| shell.volume).sum();
            assert!(
                (enclosed - volume).abs() < 1e-5 * volume,
                "{name}, {is_turned}: {enclosed}, not {volume}"
            );
        }
    }
}

#[test]
fn hostile_hubs_end_within_their_bound() {
    let mut random = Random::new(9);
    let tips = (0..600).map(|_| point(&mut random).map(|x| x - 0.5));
    let positions: Vec<[f64; 3]> = [[0.0; 3], [0.0, 0.0, 1.0]].into_iter().chain(tips).collect();
    let at_edge = (0..600).map(|i| [0, 1, 2 + i]).collect();
    check_soup("faces at an edge", &RawSoup { positions, triangles: at_edge }, Encoding::PlyAscii);
    let rim = |i: u32| f64::from(i) / 1000.0 * std::f64::consts::TAU;
    let rim = (0..1000).map(|i| [rim(i).cos(), rim(i).sin(), 0.0]);
    let positions = std::iter::once([0.0, 0.0, 1.0]).chain(rim).collect();
    let fan = (0..1000).map(|i| [0, 1 + i, 1 + (i + 1) % 1000]).collect();
    check_soup("faces at a vertex", &RawSoup { positions, triangles: fan }, Encoding::Off);
    let at_vertex = soup_of((0..200).map(|_| [[0.0; 3], point(&mut random), point(&mut random)]));
    check_soup("random faces at a vertex", &at_vertex, Encoding::StlBinary);
}

/// One polygon over all points, as OFF.
fn polygon(points: &[[f64; 3]]) -> Vec<u8> {
    let mut text = format!("OFF\n{} 1 0\n", points.len());
    for [x, y, z] in points {
        writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
    }
    write!(text, "{}", points.len()).unwrap();
    (0..points.len()).for_each(|i| write!(text, " {i}").unwrap());
    text.push('\n');
    text.into_bytes()
}

#[test]
fn hostile_polygons_end_within_their_bound() {
    const CORNERS: usize = 600;
    let mut random = Random::new(3);
    let around = |i: usize, radius: f64| {
        let angle = i as f64 / CORNERS as f64 * std::f64::consts::TAU;
        [radius * angle.cos(), radius * angle.sin(), 0.0]
    };
    let star: Vec<_> = (0..CORNERS).map(|i| around(i, 1.0 + 9.0 * (i % 2) as f64)).collect();
    check("star", &polygon(&star));
    let turns = |i: usize, inset: f64| {
        let angle = i as f64 / 20.0;
        [(i as f64 + inset) * angle.cos(), (i as f64 + inset) * angle.sin(), 0.0]
    };
    let out = (0..CORNERS / 2).map(|i| turns(i, 1.0));
    let spiral: Vec<_> = out.chain((0..CORNERS / 2).rev().map(|i| turns(i, 40.0))).collect();
    check("spiral", &polygon(&spiral));
    let teeth = (0..CORNERS / 2).flat_map(|i| {
        let at = i as f64;
        [[at, 5.0 + 4.0 * random.unit(), 0.0], [at + 0.5, 4.0 * random.unit(), 0.0]]
    });
    let comb: Vec<_> = teeth.chain([[CORNERS as f64, -1.0, 0.0], [-1.0, -1.0, 0.0]]).collect();
    check("comb", &polygon(&comb));
    let mut random = Random::new(4);
    let wild: Vec<_> = (0..200).map(|_| point(&mut random)).collect();
    check("polygon through itself", &polygon(&wild));
    let flat: Vec<_> = wild.iter().map(|&[x, y, _]| [x, y, 0.0]).collect();
    check("flat polygon through itself", &polygon(&flat));
    check("polygon at one point", &polygon(&[[1.0, 2.0, 3.0]; CORNERS]));
    let turns = format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{CORNERS}{}\n", " 0 1 2".repeat(CORNERS / 3));
    check("polygon in turns", turns.as_bytes());
}

#[test]
fn hostile_numbers_end_within_their_bound() {
    let mut random = Random::new(11);
    let number = |random: &mut Random| (random.unit() - 0.5) * 10f64.powf(600.0 * random.unit() - 300.0);
    let corners = |random: &mut Random| -> [[f64; 3]; 3] {
        std::array::from_fn(|_| std::array::from_fn(|_| number(random)))
    };
    check_soup(
        "mixed exponents",
        &soup_of((0..40).map(|_| corners(&mut random))),
        Encoding::PlyBinaryBigEndian,
    );
    let sized = (0..20).fold(RawSoup::default(), |all, _| {
        let size = 10f64.powf(600.0 * random.unit() - 300.0);
        all.with(&cuboid([size; 3]).moved([size * random.unit(); 3]))
    });
    check_soup("cubes of all sizes", &sized, Encoding::PlyBinaryLittleEndian);
}

#[test]
fn hostile_lists_end_within_their_bound() {
    let side = 32;
    let mut header = format!("ply\nformat ascii 1.0\nelement vertex {}\n", side * side);
    header.push_str("property float x\nproperty float y\nproperty float z\nelement tristrips 1\n");
    header.push_str("property list int int vertex_indices\nend_header\n");
    for i in 0..side * side {
        writeln!(header, "{} {} {}", i % side, i / side, i % 7).unwrap();
    }
    let count = 6000;
    write!(header, "{count}").unwrap();
    (0..count).for_each(|k| write!(header, " {}", (k / 2 + k % 2 * side) % (side * side)).unwrap());
    header.push('\n');
    check("strip", header.as_bytes());
    let mut groups = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n".to_owned();
    let faces = ["1 3 2", "1 2 4", "2 3 4", "3 1 4"];
    (0..2000).for_each(|i| writeln!(groups, "g {i}\nf {}", faces[i % 4]).unwrap());
    check("groups", groups.as_bytes());
}

#[test]
fn hostile_files_end_the_same_with_any_number_of_threads() {
    let files = [
        encode(&random_triangles(40), Encoding::StlBinary),
        encode(&beams(5, true), Encoding::Off),
        polygon(&(0..64).map(|i| [f64::from(i * 37 % 64), f64::from(i * 23 % 64), 0.0]).collect::<Vec<_>>()),
    ];
    for bytes in files {
        let one_two_eight = [1, 2, 8].map(|threads| {
            par::with_threads(threads, || ended(Operation::Repair, "", &bytes, &Options::default()))
        });
        assert_eq!(one_two_eight[0], one_two_eight[1]);
        assert_eq!(one_two_eight[0], one_two_eight[2]);
    }
}

#[test]
fn less_work_gives_less_and_never_something_else() {
    for (name, mesh) in [("triangles", random_triangles(12)), ("beams", beams(3, true))] {
        let bytes = encode(&mesh, Encoding::StlBinary);
        let options = Options::default();
        let (_, needed) = ended(Operation::Repair, name, &bytes, &options);
        for part in [2, 5, 20, 100] {
            let within_a_share = || {
                let budget = Budget::new(StopFlag::default(), u64::MAX, BYTES_MAX);
                let answer =
                    budget.within(needed / part, || run(Operation::Repair, &bytes, &options, &budget));
                assert!(
                    budget.work_used() <= needed / part,
                    "{name}: {} of {}",
                    budget.work_used(),
                    needed / part
                );
                // Nothing: what was left is not enough to describe the file.
                let report = answer.unwrap_or_else(|failure| panic!("{name}: {failure}"))?.report;
                let is_certified = report.certificate.as_ref().is_some_and(Certificate::is_printable);
                assert_eq!(is_certified, report.refusal.is_none(), "{name}: {:?}", report.refusal);
                Some((report.outcome, report.tried, budget.work_used()))
            };
            let [one, two, eight] = [1, 2, 8].map(|threads| par::with_threads(threads, within_a_share));
            assert_eq!(one, two, "{name}, one part of {part}");
            assert_eq!(one, eight, "{name}, one part of {part}");
        }
    }
}

#[test]
fn hostile_meshes_are_combined_within_their_bound() {
    let grid = beams(6, false).moved([0.3, 0.2, 0.1]);
    let pairs = [
        (beams(6, true), grid.clone()),
        (grid.clone(), grid.inside_out()),
        (random_triangles(60), cube()),
        (cube(), random_triangles(60)),
    ];
    for (first, second) in pairs {
        let files = [first, second].map(|mesh| encode(&mesh, Encoding::StlBinary));
        let file_sizes = files.iter().map(|file| file.len() as u64).collect();
        let options = Options { file_sizes, ..Options::default() };
        ended(Operation::Boolean, "combined", &files.concat(), &options);
    }
}

#[test]
fn the_limit_of_the_caller_is_told_as_such() {
    let bytes = encode(&random_triangles(60), Encoding::StlBinary);
    let looked = ended(Operation::Verify, "", &bytes, &Options::default()).1;
    assert!(looked < ended(Operation::Repair, "", &bytes, &Options::default()).1);
    let budget = Budget::new(StopFlag::default(), looked / 2, BYTES_MAX);
    let failure = run(Operation::Repair, &bytes, &Options::default(), &budget).unwrap_err();
    assert!(matches!(failure, Failure::Stopped(_)), "{failure:?}");
}
