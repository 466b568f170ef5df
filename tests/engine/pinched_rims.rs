//! Gaps whose two rims meet in one vertex: they are closed between the rims, and one fan of triangles is there afterwards.

use meshmend::budget::Budget;
use meshmend::pipeline::{
    Answer, ChosenHole, FillHolesChoices, HoleFate, HoleOutcome, Operation, Options, Outcome, run,
};
use meshmend::repair::fill::{FillOptions, Method};
use std::fmt::Write as _;

const METHODS: [Method; 5] = [Method::Flat, Method::Minimal, Method::Smooth, Method::Rbf, Method::Auto];

/// A grid of quadrangles of `n` by `m` corners that is closed around both ways, in OFF, without those that `is_gone` says.
fn torus(n: u32, m: u32, is_turned: bool, is_gone: impl Fn(u32, u32) -> bool) -> Vec<u8> {
    let id = |i: u32, j: u32| (i % n) * m + j % m;
    let cells = (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).filter(|&(i, j)| !is_gone(i, j));
    let quads: Vec<[u32; 4]> = cells
        .map(|(i, j)| {
            let mut quad = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            if is_turned {
                quad.reverse();
            }
            quad
        })
        .collect();
    let mut text = format!("OFF\n{} {} 0\n", n * m, quads.len());
    for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
        let [u, v] = [(i, n), (j, m)].map(|(k, of)| f64::from(k) / f64::from(of) * std::f64::consts::TAU);
        let (radius, z) = (30.0 + 10.0 * v.cos(), 10.0 * v.sin());
        writeln!(text, "{} {} {z}", radius * u.cos(), radius * u.sin()).unwrap();
    }
    for [a, b, c, d] in quads {
        writeln!(text, "4 {a} {b} {c} {d}").unwrap();
    }
    text.into_bytes()
}

/// Where the band through a tube begins whose rims meet in one vertex: it steps aside there, from cell to cell across it.
fn is_band(i: u32, j: u32) -> bool {
    (j < 6 && i == 5) || (j >= 6 && i == 6) || (j == 0 && i == 6)
}

/// A square ring of cells around one cell that touches what is around the ring in one vertex.
fn is_ring(i: u32, j: u32) -> bool {
    let is_near = (9..=12).contains(&i) && (2..=5).contains(&j);
    is_near && ![(9, 2), (10, 3)].contains(&(i, j))
}

fn filled(bytes: &[u8], method: Method, holes: Option<Vec<ChosenHole>>) -> Answer {
    let fill = FillOptions { method, ..FillOptions::default() };
    let filling = FillHolesChoices { fill, holes };
    let options = Options { filling, ..Options::default() };
    run(Operation::FillHoles, bytes, &options, &Budget::unlimited()).unwrap()
}

fn holes(answer: &Answer) -> &[HoleOutcome] {
    &answer.report.filling.as_ref().unwrap().holes
}

#[test]
fn a_band_whose_rims_meet_in_a_vertex_is_closed_between_them_by_each_method() {
    for (is_turned, method) in [false, true].into_iter().flat_map(|turned| METHODS.map(|m| (turned, m))) {
        let answer = filled(&torus(32, 12, is_turned, is_band), method, None);
        let told = holes(&answer);
        assert_eq!(told.len(), 1, "{method:?}");
        assert_eq!(
            (&told[0].loops[..], told[0].fate),
            (&[0, 1][..], HoleFate::Filled),
            "{method:?}: {told:?}"
        );
        let certificate = answer.report.certificate.as_ref().unwrap();
        assert!(certificate.is_printable() || is_turned, "{method:?}: {:?}", certificate.witnesses);
        assert_eq!((certificate.p1, certificate.euler_characteristic), (Some(true), 0), "{method:?}");
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
    }
}

#[test]
fn a_ring_around_a_piece_that_touches_its_outer_rim_is_closed_between_them_by_each_method() {
    for (is_turned, method) in [false, true].into_iter().flat_map(|turned| METHODS.map(|m| (turned, m))) {
        let answer = filled(&torus(32, 12, is_turned, is_ring), method, None);
        let told = holes(&answer);
        assert_eq!(told.len(), 1, "{method:?}: {told:?}");
        assert_eq!((told[0].loops.len(), told[0].fate), (2, HoleFate::Filled), "{method:?}: {told:?}");
        let certificate = answer.report.certificate.as_ref().unwrap();
        assert!(certificate.is_printable() || is_turned, "{method:?}: {:?}", certificate.witnesses);
        assert_eq!((certificate.p1, certificate.euler_characteristic), (Some(true), 0), "{method:?}");
    }
}

#[test]
fn one_of_two_rims_that_meet_is_closed_alone_where_only_it_is_chosen() {
    let bytes = torus(32, 12, false, is_band);
    let answer =
        filled(&bytes, Method::Minimal, Some(vec![ChosenHole { number: 0, ..ChosenHole::default() }]));
    let fates: Vec<_> = holes(&answer).iter().map(|hole| (hole.loops.clone(), hole.fate)).collect();
    assert_eq!(fates, [(vec![0], HoleFate::Filled), (vec![1], HoleFate::Kept)]);
}

#[test]
fn a_repair_closes_such_a_band_too() {
    for is_turned in [false, true] {
        let bytes = torus(32, 12, is_turned, is_band);
        let answer = run(Operation::Repair, &bytes, &Options::default(), &Budget::unlimited()).unwrap();
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
        assert_eq!(answer.report.certificate.as_ref().unwrap().euler_characteristic, 0);
        assert_eq!((&holes(&answer)[0].loops[..], holes(&answer)[0].fate), (&[0, 1][..], HoleFate::Filled));
    }
}

/// Two cups without lids, side by side, that touch in one vertex of their upper rims.
fn two_cups() -> String {
    let mut text = String::from("OFF\n33 32 0\n");
    let n = 8;
    let ring = |x: f64, z: f64, from: i32| {
        (0..n).map(move |k| {
            let angle = f64::from(from + k) / f64::from(n) * std::f64::consts::TAU;
            [x + 10.0 * angle.cos(), 10.0 * angle.sin(), z]
        })
    };
    // The first of each upper ring is where they touch; the lower ones are narrower, so that nothing else does.
    let mut points: Vec<[f64; 3]> = ring(-10.0, 20.0, 0).collect();
    points.extend(ring(10.0, 20.0, n / 2).skip(1));
    for x in [-10.0, 10.0] {
        points.extend(
            ring(x, 0.0, if x < 0.0 { 0 } else { n / 2 }).map(|[px, y, z]| [x + (px - x) / 2.0, y / 2.0, z]),
        );
        points.push([x, 0.0, 0.0]);
    }
    points[0] = [0.0, 0.0, 20.0];
    let upper = |cup: i32, k: i32| match (cup, k % n) {
        (_, 0) => 0,
        (cup, k) => cup * (n - 1) + k,
    };
    let lower = |cup: i32, k: i32| 2 * n - 1 + cup * (n + 1) + k % n;
    for [x, y, z] in points {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    for cup in 0..2 {
        for k in 0..n {
            let middle = 2 * n - 1 + cup * (n + 1) + n;
            writeln!(
                text,
                "4 {} {} {} {}",
                lower(cup, k),
                lower(cup, k + 1),
                upper(cup, k + 1),
                upper(cup, k)
            )
            .unwrap();
            writeln!(text, "3 {middle} {} {}", lower(cup, k + 1), lower(cup, k)).unwrap();
        }
    }
    text
}

#[test]
fn two_cups_that_lean_against_each_other_in_a_vertex_get_a_lid_each() {
    for method in METHODS {
        let answer = filled(two_cups().as_bytes(), method, None);
        let fates: Vec<_> = holes(&answer).iter().map(|hole| (hole.loops.len(), hole.fate)).collect();
        assert_eq!(fates, [(1, HoleFate::Filled); 2], "{method:?}");
        // Two spheres with one vertex between them.
        assert_eq!(answer.report.certificate.unwrap().euler_characteristic, 3, "{method:?}");
    }
}
