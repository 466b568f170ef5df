//! Which readings of a file the certificate judges, and what it says about valid ones.

use crate::certificate_soups::verify;
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::{ENCODINGS, encode};
use crate::solids::{cube, ring, tetrahedron, voxels};
use meshmend::budget::{Budget, StopFlag, Stopped};
use meshmend::certificate::{Certificate, CertifyError, Condition, Depth, Reading, certify, examine};
use meshmend::formats::{Encoding, ReadOptions};
use meshmend::mesh::Soup;
use meshmend::par::with_threads;

const FULL: Depth = Depth::Count { samples: 2 };
const PLAIN: Reading = Reading { is_f32: false, is_fan: false, is_as_indexed: false };

fn certify_obj(text: &str, depth: Depth) -> Certificate {
    certify(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), depth, &Budget::unlimited()).unwrap()
}

/// An L swept upward; its floor and roof are polygons of six corners that begin at corner `first`. Corner 3 is the
/// inner one.
fn l_shape(first: usize) -> String {
    let foot = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)];
    let vertices = [0, 1].iter().flat_map(|z| foot.map(|(x, y)| format!("v {x} {y} {z}\n")));
    let polygon = |corners: Vec<usize>| {
        corners.iter().fold("f".to_owned(), |line, v| format!("{line} {}", v + 1)) + "\n"
    };
    let around: Vec<usize> = (0..6).map(|i| (first + i) % 6).collect();
    let roof = polygon(around.iter().map(|v| v + 6).collect());
    let floor = polygon([&around[..1], &around[1..].iter().rev().copied().collect::<Vec<_>>()].concat());
    let walls = (0..6).map(|i| polygon(vec![i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6]));
    vertices.chain([roof, floor]).chain(walls).collect()
}

#[test]
fn certificate_of_a_concave_polygon_needs_its_fan_to_be_valid_too() {
    let good = certify_obj(&l_shape(3), FULL);
    assert!(good.is_printable(), "{good:?}");
    assert_eq!(good.readings, [PLAIN]);
    let bad = certify_obj(&l_shape(1), FULL);
    assert!(!bad.is_printable());
    assert_eq!(bad.readings, [PLAIN, Reading { is_fan: true, ..PLAIN }]);
    assert!(bad.witnesses.iter().all(|w| w.reading.is_fan && w.faces.iter().any(|&f| f < 2)), "{bad:?}");
}

#[test]
fn certificate_of_a_mesh_split_along_a_seam_is_refused_unless_the_format_has_no_indices() {
    let mut seam = cube();
    seam.positions.push(seam.positions[7]);
    for t in &mut seam.triangles[..6] {
        *t = t.map(|v| if v == 7 { 8 } else { v });
    }
    for encoding in ENCODINGS {
        let certificate = verify(&seam, encoding, FULL);
        let has_indices = !matches!(encoding, Encoding::StlAscii | Encoding::StlBinary);
        assert_eq!(certificate.is_printable(), !has_indices, "{}", encoding.name());
        if has_indices {
            assert_eq!(certificate.readings, [PLAIN, Reading { is_as_indexed: true, ..PLAIN }]);
            assert_eq!((certificate.p0, certificate.p1, certificate.p2), (false, Some(true), Some(true)));
            assert!(certificate.witnesses.iter().all(|w| w.reading.is_as_indexed), "{certificate:?}");
            assert_eq!(
                certificate.violations.total(),
                certificate.violations.edges_without_two_triangles.unwrap()
            );
        }
    }
}

#[test]
fn certificate_of_vertices_that_only_floats_cannot_tell_apart_names_the_float_reading() {
    // Floats beside 1 are 1e-7 apart, doubles 2e-16.
    let thin = tetrahedron().map(|[x, y, z]| [x, y, 1.0 + 1e-12 * z]);
    let certificate = verify(&thin, Encoding::Obj, FULL);
    assert!(!certificate.is_printable());
    assert!(certificate.witnesses.iter().all(|w| w.reading.is_f32), "{certificate:?}");
    assert!(certificate.witnesses.iter().any(|w| w.condition == Condition::NonDegenerate), "{certificate:?}");
}

#[test]
fn certificate_judges_floats_apart_only_where_a_coordinate_is_not_one() {
    assert_eq!(verify(&cube(), Encoding::Obj, FULL).readings, [PLAIN]);
    let readings = verify(&cube().scaled(0.1), Encoding::Obj, FULL).readings;
    assert_eq!(readings, [PLAIN, Reading { is_f32: true, ..PLAIN }]);
    assert_eq!(verify(&cube().scaled(0.1), Encoding::StlBinary, FULL).readings, [PLAIN]);
}

#[test]
fn certificate_of_a_valid_solid_describes_its_shells() {
    let solid = ring()
        .scaled(2.0)
        .with(&cube().moved([0.5; 3]).inside_out())
        .with(&tetrahedron().scaled(0.25).moved([0.75; 3]))
        .with(&cube().moved([10.0, 0.0, 0.0]));
    let certificate = verify(&solid, Encoding::PlyAscii, FULL);
    assert!(certificate.is_printable(), "{certificate:?}");
    let described: Vec<_> =
        certificate.shells.iter().map(|s| (s.triangles, s.depth, s.genus, s.volume)).collect();
    let tetrahedron = 1.0 / 6.0 / 64.0;
    assert_eq!(described, [(64, 0, 1, 64.0), (12, 1, 0, -1.0), (4, 2, 0, tetrahedron), (12, 0, 0, 1.0)]);
    assert_eq!(certificate.euler_characteristic, 6);
    assert_eq!((certificate.triangles, certificate.vertices), (92, 32 + 8 + 4 + 8));
    assert_eq!(certificate.violations.total(), 0);
}

#[test]
fn certificate_of_no_triangle_says_that_it_is_empty() {
    let (soup, bytes) = (Soup { is_f32_exact: true, ..Soup::default() }, b"");
    let options = ReadOptions::default();
    let examination = examine(&soup, bytes, Encoding::Obj, &options, FULL, &Budget::unlimited()).unwrap();
    let certificate = examination.certificate;
    assert_eq!((certificate.p0, certificate.p1, certificate.p2), (true, Some(true), Some(false)));
    assert_eq!(certificate.witnesses[0].condition, Condition::NotEmpty);
    assert_eq!(certificate.sha256[..4], [0xe3, 0xb0, 0xc4, 0x42]);
}

#[test]
fn certificate_allows_vertices_without_a_face_but_not_without_a_place() {
    let mut soup = cube();
    soup.positions.push([5.0, 5.0, 5.0]);
    assert!(verify(&soup, Encoding::Off, FULL).is_printable());
    soup.positions.push([5.0, f64::NAN, 5.0]);
    let certificate = verify(&soup, Encoding::Off, FULL);
    assert!(!certificate.p0);
    assert_eq!(certificate.violations.unusable, Some(1));
}

#[test]
fn certificate_names_faces_of_the_file_not_triangles() {
    // The third face of the file is a triangle on top of the roof of the L; polygons before it have four triangles.
    let text = l_shape(3).replacen("f 1 2 8 7\n", "f 1 2 8 7\nf 12 7 8\n", 1);
    let certificate = certify_obj(&text, FULL);
    let overlap = certificate.witnesses.iter().find(|w| w.condition == Condition::Embedded).unwrap();
    assert_eq!(overlap.faces, [0, 3], "{certificate:?}");
}

#[test]
fn certificate_is_the_same_with_any_number_of_threads() {
    let mut random = Random::new(9);
    let mut soup = RawSoup::default();
    for _ in 0..1_500 {
        let by = std::array::from_fn(|_| f64::from(random.between(0, 60)) / 4.0);
        soup = soup.with(&cube().scaled(0.5).moved(by));
    }
    let cells: Vec<[i64; 3]> = (0..4_000).map(|i| [i % 20, i / 20 % 20, i / 400 + 40]).collect();
    soup = soup.with(&voxels(&cells)).scaled(0.3);
    let bytes = encode(&soup, Encoding::Off);
    let options = ReadOptions::default();
    for depth in [Depth::FirstViolation, Depth::Count { samples: 5 }] {
        let results: Vec<_> = [1, 2, 8]
            .into_iter()
            .map(|threads| {
                with_threads(threads, || {
                    certify(&bytes, Encoding::Off, &options, depth, &Budget::unlimited())
                })
            })
            .collect();
        assert!(results.windows(2).all(|pair| pair[0] == pair[1]), "{depth:?}");
    }
}

#[test]
fn certificate_of_a_cancelled_run_is_none() {
    let bytes = encode(&cube(), Encoding::Obj);
    let stop = StopFlag::default();
    stop.cancel();
    let budget = Budget::new(stop, u64::MAX, u64::MAX);
    let result = certify(&bytes, Encoding::Obj, &ReadOptions::default(), FULL, &budget);
    assert_eq!(result.unwrap_err(), CertifyError::Stopped(Stopped::Cancelled));
}
