//! The lattice wrap on soups of every bad kind, judged by the certificate.

use crate::dented_sphere::dented_sphere;
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::encode;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::certificate::{self, Certificate, Condition, Depth};
use meshmend::formats::{self, Encoding, ReadOptions};
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::pipeline::{Operation, Options, Outcome, Refusal, run};
use meshmend::winding::OpenShells;
use meshmend::wrap::{WrapError, WrapOptions, wrap};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;

/// Positions, and the vertices of each triangle.
type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

fn point(random: &mut Random) -> DVec3 {
    DVec3::new(random.unit(), random.unit(), random.unit())
}

/// Triangles of the box between two corners, outward.
fn cuboid(min: [f64; 3], max: [f64; 3]) -> Mesh {
    let corner =
        |i: usize| DVec3::from_array([0, 1, 2].map(|a| if i >> a & 1 == 1 { max[a] } else { min[a] }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (
        (0..8).map(corner).collect(),
        faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    )
}

fn add(mesh: &mut Mesh, other: &Mesh, is_turned: bool) {
    let base = mesh.0.len() as u32;
    mesh.0.extend(&other.0);
    mesh.1.extend(
        other.1.iter().map(|&[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] }.map(|v| v + base)),
    );
}

/// A soup of one of many bad kinds.
fn soup(random: &mut Random) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut mesh = (Vec::new(), Vec::new());
    let grid = |u: u32, v: u32, columns: u32| v * columns + u;
    match random.below(10) {
        0 => {
            for t in 0..1 + random.below(12) as u32 {
                mesh.0.extend((0..3).map(|_| point(random)));
                mesh.1.push([3 * t, 3 * t + 1, 3 * t + 2]);
            }
        }
        1 => {
            mesh.0.extend((0..3).map(|_| point(random)));
            mesh.1.push([0, 1, 2]);
        }
        2 => {
            // A closed strip with a half turn.
            let n = 5 + random.below(12) as u32;
            for i in 0..n {
                let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
                for side in [-0.3, 0.3] {
                    let reach = 1.0 + side * libm::cos(angle / 2.0);
                    mesh.0.push(DVec3::new(
                        reach * libm::cos(angle),
                        reach * libm::sin(angle),
                        side * libm::sin(angle / 2.0),
                    ));
                }
            }
            for i in 0..n {
                let [a, b] = [2 * i, 2 * i + 1];
                let [c, d] = if i + 1 < n { [a + 2, b + 2] } else { [1, 0] };
                mesh.1.extend([[a, c, b], [b, c, d]]);
            }
        }
        3 => {
            // A figure-eight Klein bottle.
            let n = 8;
            for v in 0..n {
                for u in 0..n {
                    let [u, v] = [u, v].map(|x| f64::from(x) / f64::from(n) * std::f64::consts::TAU);
                    let reach =
                        2.0 + libm::cos(u / 2.0) * libm::sin(v) - libm::sin(u / 2.0) * libm::sin(2.0 * v);
                    mesh.0.push(DVec3::new(
                        reach * libm::cos(u),
                        reach * libm::sin(u),
                        libm::sin(u / 2.0) * libm::sin(v) + libm::cos(u / 2.0) * libm::sin(2.0 * v),
                    ));
                }
            }
            for v in 0..n {
                for u in 0..n {
                    let far =
                        |v: u32| if u + 1 == n { grid(0, (n - v) % n, n) } else { grid(u + 1, v % n, n) };
                    let [a, b, c, d] = [grid(u, v, n), far(v), far(v + 1), grid(u, (v + 1) % n, n)];
                    mesh.1.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        4 => {
            // Stacks in one plane, also on the planes of a lattice.
            for i in 0..2 + random.below(4) {
                let z = [0.0, 0.5, 1e-7][random.below(3)];
                let base = mesh.0.len() as u32;
                mesh.0.extend((0..3).map(|_| point(random).with_z(z)));
                mesh.1.push(if i % 2 == 0 { [base, base + 1, base + 2] } else { [base, base + 2, base + 1] });
            }
        }
        5..=7 => {
            for _ in 0..1 + random.below(4) {
                let (a, b) = (point(random), point(random));
                let (min, max) = (a.min(b), a.max(b) + 1e-3);
                let mut cuboid = cuboid(min.to_array(), max.to_array());
                if random.below(4) == 0 {
                    cuboid.1.truncate(1 + random.below(12));
                }
                add(&mut mesh, &cuboid, random.below(2) == 0);
            }
        }
        8 => {
            // Slivers.
            for t in 0..1 + random.below(6) as u32 {
                let (a, b) = (point(random), point(random));
                mesh.0.extend([a, b, a.lerp(b, random.unit()) + point(random) * 1e-9]);
                mesh.1.push([3 * t, 3 * t + 1, 3 * t + 2]);
            }
        }
        _ => {
            mesh = cuboid([0.0; 3], [1.0; 3]);
            for v in &mut mesh.0 {
                *v += point(random) * 0.9;
            }
        }
    }
    let scale = [1.0, 1e-30, 1e30, 1e-3, 37.0][random.below(5)];
    let offset = point(random) * [0.0, 0.0, 0.0, 10.0, 1e4][random.below(5)];
    for p in &mut mesh.0 {
        *p = (*p + offset) * scale;
    }
    // A vertex that nothing uses.
    if random.below(5) == 0 {
        mesh.0.push(DVec3::splat(1e6 * scale));
    }
    mesh
}

fn certificate_of(positions: &[DVec3], triangles: &[[u32; 3]]) -> Certificate {
    let soup = Soup {
        positions: positions.to_vec(),
        triangles: triangles.to_vec(),
        face_count: triangles.len() as u32,
        ..Soup::default()
    };
    let budget = Budget::unlimited();
    let bytes = formats::write(&soup, Encoding::StlBinary, &budget).unwrap();
    let options = ReadOptions::default();
    certificate::certify(&bytes, Encoding::StlBinary, &options, Depth::FirstViolation, &budget).unwrap()
}

/// All rounds, or those of a campaign that is run in parts: `MESHMEND_ROUNDS=A..B`, without B.
fn rounds(small: usize, full: usize) -> Range<usize> {
    match std::env::var("MESHMEND_ROUNDS") {
        Ok(part) => {
            let (first, end) = part.split_once("..").unwrap();
            first.parse().unwrap()..end.parse().unwrap()
        }
        Err(_) => 0..cases(small, full),
    }
}

/// A long run says that it goes on.
#[allow(clippy::print_stderr, reason = "for who waits for a campaign")]
fn tell_progress(round: usize, rounds: &Range<usize>) {
    if rounds.len() >= 200 && (round - rounds.start).is_multiple_of(rounds.len() / 100) {
        eprintln!("round {round} of {rounds:?}");
    }
}

/// A fifth of the vertices meet something once they are where they belong.
#[test]
fn a_ball_with_dents_of_two_cells_is_fitted_although_many_moves_meet() {
    let (positions, triangles) = dented_sphere(64, 26);
    let options = WrapOptions { cells: 24, ..WrapOptions::default() };
    let wrapped = wrap(&positions, &triangles, &options, &Budget::unlimited()).unwrap();
    let certificate = certificate_of(&wrapped.positions, &wrapped.triangles);
    assert!(certificate.is_printable(), "{:?}", certificate.witnesses);
    assert_eq!((certificate.shells.len(), certificate.shells[0].genus), (1, 0));
    let fit = wrapped.account.fit;
    assert!(fit.moved > 5000 && fit.taken_back * 3 < fit.moved, "{fit:?}");
}

#[test]
fn every_bad_soup_is_wrapped_in_a_certified_solid_or_rightly_refused() {
    let budget = Budget::unlimited();
    let rounds = rounds(120, 100_000);
    let (refused, unfit) = (AtomicUsize::new(0), AtomicUsize::new(0));
    rounds.clone().into_par_iter().for_each(|round| {
        let mut random = Random::of_round(11, round);
        tell_progress(round, &rounds);
        let (positions, triangles) = soup(&mut random);
        let open_shells = random.pick(&[OpenShells::Auto, OpenShells::Close, OpenShells::Thicken]);
        let options = WrapOptions { cells: 16, open_shells, ..WrapOptions::default() };
        match wrap(&positions, &triangles, &options, &budget) {
            Ok(wrapped) => {
                let certificate = certificate_of(&wrapped.unfitted, &wrapped.triangles);
                assert!(certificate.is_printable(), "{round}: {:?}", certificate.witnesses);
                // The fit looks at what meets, not at what went through something on the way; then the certificate refuses
                // it and the bare surface is returned.
                let certificate = certificate_of(&wrapped.positions, &wrapped.triangles);
                let p1_holds = certificate.witnesses.iter().all(|w| w.condition == Condition::Alternating);
                assert!(p1_holds, "{round} fitted: {:?}", certificate.witnesses);
                unfit.fetch_add(usize::from(!certificate.is_printable()), Relaxed);
            }
            Err(WrapError::NotRepresentable(coarse)) => {
                assert!(coarse.pitch * 16384.0 > coarse.diagonal, "{round}: {coarse:?}");
                refused.fetch_add(1, Relaxed);
            }
            Err(error) => panic!("{round}: {error}"),
        }
    });
    let (refused, unfit) = (refused.into_inner(), unfit.into_inner());
    let count = rounds.len();
    assert!(refused < count / 3 && unfit <= count / 200, "{refused} {unfit}");
    println!(
        "| soups wrapped at 16 cells | {rounds:?}: {count}, of which {refused} refused: beyond float32 | {unfit} without the fit |"
    );
}

#[test]
fn every_bad_soup_is_repaired_or_rightly_refused_at_the_default_resolution() {
    let rounds = rounds(3, 1_000);
    let outcomes = Mutex::new(std::collections::BTreeMap::<String, usize>::new());
    rounds.clone().into_par_iter().for_each(|round| {
        let mut random = Random::of_round(12, round);
        tell_progress(round, &rounds);
        let (positions, triangles) = soup(&mut random);
        let raw = RawSoup { positions: positions.iter().map(DVec3::to_array).collect(), triangles };
        let bytes = encode(&raw, Encoding::Obj);
        let answer = run(Operation::Repair, &bytes, &Options::default(), &Budget::unlimited()).unwrap();
        let report = &answer.report;
        let outcome = report.outcome.unwrap();
        if outcome == Outcome::Refused {
            let refusal = report.refusal.as_ref().unwrap();
            assert!(
                matches!(refusal, Refusal::BeyondFloat32 { .. } | Refusal::NothingToRepair),
                "{round}: {refusal:?}"
            );
        } else {
            assert!(report.certificate.as_ref().unwrap().is_printable(), "{round}");
        }
        *outcomes.lock().unwrap().entry(format!("{outcome:?}")).or_default() += 1;
    });
    let outcomes = outcomes.into_inner().unwrap();
    println!("| soups repaired at the default resolution | {rounds:?}: {outcomes:?} |");
}
