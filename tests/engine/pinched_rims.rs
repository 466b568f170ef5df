//! Gaps whose two rims meet in one vertex: they are closed between the rims, and one fan of triangles is there afterwards.

use meshmend::budget::Budget;
use meshmend::pipeline::{
    Answer, ChosenHole, FillHolesChoices, HoleFate, HoleOutcome, Operation, Options, Outcome, run,
};
use meshmend::repair::fill::{Extract, FillOptions, Method};
use std::fmt::Write as _;

/// Each method, and the one whose patch closes a band on a torus. A view of its rim passes a place twice, so that none is flat.
const METHODS: [(Method, Method); 6] = [
    (Method::Flat, Method::Minimal),
    (Method::Minimal, Method::Minimal),
    (Method::Smooth, Method::Smooth),
    (Method::Creased, Method::Smooth),
    (Method::Rbf, Method::Rbf),
    (Method::Auto, Method::Rbf),
];

/// A grid of quadrangles of `n` by `m` corners on a torus, in OFF, without those that `is_gone` says. `is_turned`: all the
/// other way around.
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

/// A band through a tube of `m` cells around, which steps aside in its middle, from cell to cell across a vertex.
fn is_band(m: u32) -> impl Fn(u32, u32) -> bool {
    move |i, j| (2 * j < m && i == 5) || (2 * j >= m && i == 6) || (j == 0 && i == 6)
}

/// The same, and it steps back across a vertex where it meets itself.
fn is_band_that_steps_back(i: u32, j: u32) -> bool {
    is_band(12)(i, j) && (i, j) != (6, 0)
}

/// A square ring of cells around one cell that touches what is around the ring in one vertex.
fn is_ring(i: u32, j: u32) -> bool {
    let is_near = (9..=12).contains(&i) && (2..=5).contains(&j);
    is_near && ![(9, 2), (10, 3)].contains(&(i, j))
}

fn filled_by(fill: FillOptions, bytes: &[u8], holes: Option<Vec<ChosenHole>>) -> Answer {
    let filling = FillHolesChoices { fill, holes };
    let options = Options { filling, ..Options::default() };
    run(Operation::FillHoles, bytes, &options, &Budget::unlimited()).unwrap()
}

fn filled(bytes: &[u8], method: Method, holes: Option<Vec<ChosenHole>>) -> Answer {
    filled_by(FillOptions { method, ..FillOptions::default() }, bytes, holes)
}

fn holes(answer: &Answer) -> &[HoleOutcome] {
    &answer.report.filling.as_ref().unwrap().holes
}

/// A torus without holes, and a solid unless it is inside out.
fn is_whole(answer: &Answer, is_turned: bool) {
    let certificate = answer.report.certificate.as_ref().unwrap();
    assert!(certificate.is_printable() || is_turned, "{:?}", certificate.witnesses);
    assert_eq!((certificate.p1, certificate.euler_characteristic), (Some(true), 0));
    assert_eq!(answer.report.identical_triangle_share, Some(1.0));
}

/// That one patch of the method that `of` gives closes both rims of `is_gone`.
fn is_closed_by_each_method(is_gone: impl Fn(u32, u32) -> bool, of: impl Fn((Method, Method)) -> Method) {
    for is_turned in [false, true] {
        let bytes = torus(32, 12, is_turned, &is_gone);
        for way in METHODS {
            let answer = filled(&bytes, way.0, None);
            let [told] = holes(&answer) else { panic!("{way:?}: {:?}", holes(&answer)) };
            assert_eq!((told.loops.len(), told.fate), (2, HoleFate::Filled), "{way:?}: {told:?}");
            assert_eq!(told.told.as_ref().unwrap().used, Some(of(way)), "{told:?}");
            is_whole(&answer, is_turned);
        }
    }
}

#[test]
fn a_band_whose_rims_meet_in_a_vertex_is_closed_between_them_by_each_method() {
    is_closed_by_each_method(is_band(12), |(_, used)| used);
}

#[test]
fn a_ring_around_a_piece_that_touches_its_outer_rim_is_closed_between_them_by_each_method() {
    // Its rims have so few corners that `auto` fits no field.
    is_closed_by_each_method(
        is_ring,
        |(asked, used)| if asked == Method::Auto { Method::Smooth } else { used },
    );
}

#[test]
fn a_surface_of_a_field_that_is_extracted_closes_such_a_band_or_gives_way() {
    let bytes = torus(32, 12, false, is_band(12));
    for extract in [Extract::March, Extract::Mesh] {
        let options = FillOptions { method: Method::Rbf, extract, ..FillOptions::default() };
        is_whole(&filled_by(options, &bytes, None), false);
    }
}

#[test]
fn rims_that_meet_in_two_vertices_are_closed_gap_by_gap() {
    for is_turned in [false, true] {
        let answer = filled(&torus(32, 12, is_turned, is_band_that_steps_back), Method::Auto, None);
        let fates: Vec<_> = holes(&answer).iter().map(|hole| (hole.edges, hole.fate)).collect();
        assert_eq!(fates, [(14, HoleFate::Filled); 2]);
        is_whole(&answer, is_turned);
    }
}

#[test]
fn long_rims_that_meet_in_a_vertex_are_closed_between_them() {
    let bytes = torus(200, 80, false, is_band(80));
    for method in [Method::Minimal, Method::Auto] {
        let answer = filled(&bytes, method, None);
        assert!(holes(&answer)[0].edges > 128, "{:?}", holes(&answer));
        is_whole(&answer, false);
    }
}

#[test]
fn one_of_two_rims_that_meet_is_closed_alone_where_only_it_is_chosen() {
    let bytes = torus(32, 12, false, is_band(12));
    let answer =
        filled(&bytes, Method::Minimal, Some(vec![ChosenHole { number: 0, ..ChosenHole::default() }]));
    let fates: Vec<_> = holes(&answer).iter().map(|hole| (hole.loops.clone(), hole.fate)).collect();
    assert_eq!(fates, [(vec![0], HoleFate::Filled), (vec![1], HoleFate::Kept)]);
}

#[test]
fn a_repair_closes_such_a_band_too() {
    for is_turned in [false, true] {
        let bytes = torus(32, 12, is_turned, is_band(12));
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
    for (method, _) in METHODS {
        let answer = filled(two_cups().as_bytes(), method, None);
        let fates: Vec<_> = holes(&answer).iter().map(|hole| (hole.loops.len(), hole.fate)).collect();
        assert_eq!(fates, [(1, HoleFate::Filled); 2], "{method:?}");
        // Two spheres with one vertex between them.
        assert_eq!(answer.report.certificate.unwrap().euler_characteristic, 3, "{method:?}");
    }
}
