//! The analysis against brute force, against the certificate, and on meshes with a planted defect.

use crate::certificate_soups::{random_soup, without_what_the_format_cannot_hold};
use crate::naive::Naive;
use crate::oracle::{RawSoup, judge_welded, weld};
use crate::random::Random;
use crate::raw_files::{ENCODINGS, encode};
use crate::solids::{any_solid, cube, tetrahedron};
use crate::support::{cases, corpus_files, on_all_cores};
use meshmend::analysis::{Analysis, AnalyzeOptions, DefectCode, Finding, Severity, Witness, analyze};
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, ReadOptions, read};
use meshmend::geom::{Aabb, DVec3};
use meshmend::mesh::Soup;
use meshmend::par;
use meshmend::pipeline::{Operation, Options, run};
use std::collections::BTreeSet;

fn soup_of(bytes: &[u8], encoding: Encoding) -> Soup {
    read(bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

fn described(soup: &Soup) -> Analysis {
    analyze(soup, None, &AnalyzeOptions::default(), &Budget::unlimited()).unwrap()
}

fn finding(told: &Analysis, code: DefectCode) -> Option<&Finding> {
    told.findings.iter().find(|f| f.code == code)
}

fn count(told: &Analysis, code: DefectCode) -> u64 {
    finding(told, code).map_or(0, |f| f.count)
}

/// A random soup and a format that can hold it.
fn random_file(seed: usize) -> (RawSoup, Encoding) {
    let mut random = Random::new(seed as u64 ^ 0xa11a_1e5e);
    let encoding = random.pick(&ENCODINGS);
    (without_what_the_format_cannot_hold(random_soup(&mut random), encoding), encoding)
}

#[test]
fn every_count_is_what_brute_force_finds() {
    let rounds = cases(800, 40_000);
    on_all_cores(rounds, |round| {
        let (raw, encoding) = random_file(round);
        let soup = soup_of(&encode(&raw, encoding), encoding);
        let told = described(&soup);
        let context = || format!("round {round} as {}: {raw:?}\n{told:#?}", encoding.name());
        let naive = Naive::of(&soup);
        assert_eq!(told.counts, naive.counts(), "{}", context());
        assert_eq!(told.properties, naive.properties(told.properties.is_embedded), "{}", context());
        assert_eq!(told.measures.euler_characteristic, naive.euler_characteristic(), "{}", context());
        for (code, expected) in naive.defects() {
            assert_eq!(count(&told, code), expected, "{code:?} {}", context());
        }
        // What needs exact geometry is judged by rational arithmetic.
        let positions = soup.positions.iter().map(DVec3::to_array).collect();
        let opinion = judge_welded(&RawSoup { positions, triangles: soup.triangles.clone() });
        let total = |codes: &[DefectCode]| codes.iter().map(|&code| count(&told, code)).sum::<u64>();
        use DefectCode as D;
        assert_eq!(total(&[D::CoincidentCorners, D::CollinearFace]), opinion.degenerate, "{}", context());
        assert_eq!(total(&[D::SelfIntersection, D::Overlap, D::Touch]), opinion.contacts, "{}", context());
        if let Some(is_solid) = opinion.is_solid {
            let misnested = total(&[D::InvertedShell, D::MisnestedShell, D::NoTriangle]);
            assert_eq!(misnested == 0, is_solid, "{}", context());
        }
    });
}

#[test]
fn a_file_has_an_error_exactly_when_its_certificate_is_not_printable() {
    let rounds = cases(3_000, 60_000);
    on_all_cores(rounds, |round| {
        let (raw, encoding) = random_file(round + 1_000_000);
        assert_errors_say_what_the_certificate_says(
            &encode(&raw, encoding),
            &format!("round {round}: {raw:?}"),
        );
    });
}

#[test]
fn real_files_have_an_error_exactly_when_their_certificate_is_not_printable() {
    let bytes_max = cases(200_000, usize::MAX);
    let Some(files) = corpus_files(&["obj", "stl", "off", "ply"]) else { return };
    let judged = on_all_cores(files.len(), |i| {
        let bytes = std::fs::read(&files[i]).unwrap();
        bytes.len() <= bytes_max
            && assert_errors_say_what_the_certificate_says(&bytes, &files[i].to_string_lossy())
    });
    let judged = judged.iter().filter(|&&is_judged| is_judged).count();
    println!("| real files, errors against certificate | {judged} | all agree |");
    assert!(judged > 50, "only {judged} files");
}

/// False for a file that cannot be read.
fn assert_errors_say_what_the_certificate_says(bytes: &[u8], name: &str) -> bool {
    let Ok(answer) = run(Operation::Analyze, bytes, &Options::default(), &Budget::unlimited()) else {
        return false;
    };
    let told = answer.report.before.unwrap();
    let certificate = answer.report.input_certificate;
    assert_eq!(told.has_errors(), !certificate.is_printable(), "{name}\n{told:#?}\n{certificate:?}");
    // The certificate may be taken at its word for readings that the analysis does not make, and for no other.
    if finding(&told, DefectCode::UnsoundReading).is_some() {
        let is_other = certificate.witnesses.iter().all(|w| w.reading.is_f32 || w.reading.is_fan);
        assert!(is_other, "{name}\n{told:#?}\n{certificate:?}");
    }
    true
}

#[test]
fn the_order_of_faces_and_of_their_corners_changes_no_count() {
    on_all_cores(cases(1_000, 30_000), |round| {
        let (raw, _) = random_file(round + 2_000_000);
        let mut random = Random::new(round as u64);
        let mut shuffled = raw.clone();
        for i in (1..shuffled.triangles.len()).rev() {
            shuffled.triangles.swap(i, random.below(i + 1));
        }
        for triangle in &mut shuffled.triangles {
            triangle.rotate_left(random.below(3));
        }
        let [told, again] =
            [&raw, &shuffled].map(|raw| described(&soup_of(&encode(raw, Encoding::Obj), Encoding::Obj)));
        let context = || format!("round {round}: {raw:?}\n{shuffled:?}");
        // How rims are joined at an edge of many faces depends on their order.
        let has_rims_in_question = !told.properties.is_edge_manifold;
        let is_compared = |f: &&Finding| f.code != DefectCode::BoundaryLoop || !has_rims_in_question;
        let counts = |told: &Analysis| -> Vec<(DefectCode, Severity, u64)> {
            told.findings.iter().filter(is_compared).map(|f| (f.code, f.severity, f.count)).collect()
        };
        assert_eq!(counts(&told), counts(&again), "{}", context());
        assert_eq!(told.properties, again.properties, "{}", context());
        assert_eq!(told.measures.bounds, again.measures.bounds, "{}", context());
        assert_eq!(told.measures.volume.is_some(), again.measures.volume.is_some(), "{}", context());
        let size = told.measures.bounds.map_or(0.0, Aabb::diagonal);
        let is_close = |a: f64, b: f64, unit: f64| a == b || (a - b).abs() <= 1e-12 * unit;
        assert!(is_close(told.measures.area, again.measures.area, size * size), "{}", context());
        let volumes = told.measures.volume.zip(again.measures.volume);
        assert!(volumes.is_none_or(|(a, b)| is_close(a, b, size * size * size)), "{}", context());
    });
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let mut random = Random::new(7);
    let mut raw = RawSoup::default();
    for i in 0..400 {
        raw =
            raw.with(&any_solid(&mut random).moved([f64::from(i % 20) * 1.5, f64::from(i / 20) * 1.5, 0.0]));
    }
    for _ in 0..300 {
        let t = random.below(raw.triangles.len());
        if random.one_in(2) {
            raw.triangles[t].swap(0, 1);
        } else {
            raw.triangles.remove(t);
        }
    }
    let soup = soup_of(&encode(&raw, Encoding::Obj), Encoding::Obj);
    assert!(soup.triangles.len() > 5_000, "{}", soup.triangles.len());
    let [one, two, eight] = [1, 2, 8].map(|threads| par::with_threads(threads, || described(&soup)));
    assert_eq!(one, two);
    assert_eq!(one, eight);
}

/// The first witness of `code` in what is told about `raw`, and how many there are.
fn witness(raw: &RawSoup, code: DefectCode) -> (Witness, u64) {
    let told = described(&soup_of(&encode(raw, Encoding::Obj), Encoding::Obj));
    let finding = finding(&told, code).unwrap_or_else(|| panic!("no {code:?} in {raw:?}\n{told:#?}"));
    (finding.witnesses[0].clone(), finding.count)
}

fn faces(witness: &Witness) -> Vec<u32> {
    witness.faces.iter().map(|e| e.index).collect()
}

fn vertices(witness: &Witness) -> BTreeSet<u32> {
    witness.vertices.iter().map(|e| e.index).collect()
}

#[test]
fn a_planted_defect_is_found_where_it_was_planted() {
    use DefectCode as D;
    on_all_cores(cases(300, 20_000), |round| {
        let mut random = Random::new(round as u64 + 77);
        let clean = weld(&any_solid(&mut random));
        assert_eq!(
            described(&soup_of(&encode(&clean, Encoding::Obj), Encoding::Obj)).findings,
            [],
            "{clean:?}"
        );
        let t = random.below(clean.triangles.len());
        let corners = clean.triangles[t];
        let [a, b, c] = corners;
        let new_face = clean.triangles.len() as u32;
        let new_vertex = clean.positions.len() as u32;
        let planted = |plant: &dyn Fn(&mut RawSoup), code| {
            let mut raw = clean.clone();
            plant(&mut raw);
            witness(&raw, code)
        };

        let (at, n) = planted(&|raw| raw.triangles.retain(|other| *other != corners), D::BoundaryLoop);
        assert_eq!((n, vertices(&at)), (1, BTreeSet::from(corners)));
        assert_eq!(at.figures[0], ("edges", 3.0));

        let (at, n) = planted(&|raw| raw.triangles[t].swap(0, 1), D::OrientationConflict);
        assert!(n == 3 && faces(&at).contains(&(t as u32)), "{at:?}");

        let (at, n) = planted(&|raw| raw.triangles.push([b, c, a]), D::DuplicateFace);
        assert_eq!((n, faces(&at)), (1, vec![new_face, t as u32]));

        let (at, n) = planted(&|raw| raw.triangles.push([c, b, a]), D::OppositeDuplicateFace);
        assert_eq!((n, faces(&at)), (1, vec![new_face, t as u32]));

        let (at, n) = planted(&|raw| raw.triangles.push([a, a, b]), D::CoincidentCorners);
        assert_eq!((n, faces(&at)), (1, vec![new_face]));

        let on_a_line = [[90.0, 9.0, 1.0], [91.0, 9.0, 1.0], [99.0, 9.0, 1.0]];
        let loose = [new_vertex, new_vertex + 1, new_vertex + 2];
        let append = |points: [[f64; 3]; 3]| {
            move |raw: &mut RawSoup| {
                raw.positions.extend(points);
                raw.triangles.push(loose);
            }
        };
        let (at, n) = planted(&append(on_a_line), D::CollinearFace);
        assert_eq!((n, faces(&at)), (1, vec![new_face]));

        let (at, n) =
            planted(&append([[90.0, 0.0, 0.0], [91.0, 0.0, 0.0], [90.0, 1.0, 0.0]]), D::IsolatedFace);
        assert_eq!((n, faces(&at)), (1, vec![new_face]));

        let (at, n) =
            planted(&append([[f64::NAN, 0.0, 0.0], [91.0, 0.0, 0.0], [90.0, 1.0, 0.0]]), D::NonFiniteVertex);
        assert_eq!((n, vertices(&at)), (1, BTreeSet::from([new_vertex])));
        let (at, n) =
            planted(&append([[0.0, f64::INFINITY, 0.0], [9.0, 0.0, 0.0], [9.0, 1.0, 0.0]]), D::NonFiniteFace);
        assert_eq!((n, faces(&at)), (1, vec![new_face]));

        let (at, n) = planted(&|raw| raw.triangles.push([a, b, new_vertex + 5]), D::IndexOutOfRange);
        assert_eq!((n, faces(&at)), (1, vec![new_face]));
        assert_eq!(at.faces[0].line, Some(new_vertex + new_face + 1), "vertices come first, a line each");

        let (at, n) = planted(&|raw| raw.positions.push([90.0; 3]), D::IsolatedVertex);
        assert_eq!((n, vertices(&at)), (1, BTreeSet::from([new_vertex])));

        let tear = |raw: &mut RawSoup| {
            raw.positions.push(raw.positions[a as usize]);
            raw.triangles[t][0] = new_vertex;
        };
        let (at, n) = planted(&tear, D::DuplicateVertex);
        assert_eq!((n, vertices(&at)), (1, BTreeSet::from([a, new_vertex])));

        let fin = |raw: &mut RawSoup| {
            raw.positions.push([90.0; 3]);
            raw.triangles.push([a, b, new_vertex]);
        };
        let (at, n) = planted(&fin, D::NonManifoldEdge);
        assert_eq!((n, vertices(&at)), (1, BTreeSet::from([a, b])));
        assert!(faces(&at).contains(&new_face));

        let cone = |raw: &mut RawSoup| {
            *raw = raw.clone().with(&tetrahedron().moved([90.0; 3]));
            for corner in raw.triangles.iter_mut().flatten().filter(|v| **v == new_vertex) {
                *corner = a;
            }
        };
        let (at, n) = planted(&cone, D::NonManifoldVertex);
        assert_eq!((n, vertices(&at)), (1, BTreeSet::from([a])));

        let (_, n) = planted(&|raw| *raw = raw.clone().inside_out(), D::InvertedShell);
        assert_eq!(n, 1);

        let needle = |raw: &mut RawSoup| *raw = raw.clone().with(&needle_through(&clean, t));
        let (at, _) = planted(&needle, D::SelfIntersection);
        assert_eq!(faces(&at)[0], t as u32, "{at:?}");
    });
}

/// A tetrahedron so thin and short that of all faces of `raw` it meets only triangle `t`, in its middle.
fn needle_through(raw: &RawSoup, t: usize) -> RawSoup {
    let [a, b, c] = raw.triangles[t].map(|v| raw.positions[v as usize]);
    let at: [f64; 3] = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
    // A needle in the direction of the normal, whose three edges are far from the plane of the triangle.
    let [u, v]: [[f64; 3]; 2] = [std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k])];
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let point = |along: f64, x: f64, y: f64| {
        std::array::from_fn(|k| at[k] + 1e-3 * (along * normal[k] + x * u[k] + y * v[k]))
    };
    let positions =
        vec![point(-1.0, 0.0, 0.0), point(-1.0, 1.0, 0.0), point(-1.0, 0.0, 1.0), point(1.0, 0.1, 0.1)];
    RawSoup { positions, ..tetrahedron() }
}

#[test]
fn nested_cubes_are_told_by_what_each_and_the_one_around_it_point_to() {
    on_all_cores(cases(200, 5_000), |round| {
        let mut random = Random::new(round as u64 + 5);
        let mut raw = RawSoup::default();
        let mut outward = Vec::new();
        for depth in 0..1 + random.below(5) {
            let part = cube().scaled(12.0 - 2.0 * depth as f64).moved([depth as f64; 3]);
            outward.push(random.one_in(2));
            raw = raw.with(&if outward[depth] { part } else { part.inside_out() });
        }
        // A neighbour changes nothing.
        raw = raw.with(&cube().moved([50.0, 0.0, 0.0]));
        let told = described(&soup_of(&encode(&raw, Encoding::Obj), Encoding::Obj));
        let misnested = outward.windows(2).filter(|pair| pair[0] == pair[1]).count() as u64;
        let said = [DefectCode::InvertedShell, DefectCode::MisnestedShell].map(|code| count(&told, code));
        assert_eq!(said, [u64::from(!outward[0]), misnested], "{outward:?}\n{told:#?}");
    });
}
