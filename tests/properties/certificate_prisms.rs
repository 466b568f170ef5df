//! Thousands of flat prisms: a count of edges and a positive volume are fooled by them, the certificate is not.

use crate::certificate_soups::verify;
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::solids::prism;
use meshmend::certificate::{Certificate, Condition, Depth};
use meshmend::formats::Encoding;

const PRISMS: usize = 3_600;
const ROW: usize = 60;

/// Many of `part` on a grid, far from each other.
fn field(part: &RawSoup) -> RawSoup {
    let mut soup = RawSoup::default();
    for i in 0..PRISMS {
        soup = soup.with(&part.clone().moved([4.0 * (i % ROW) as f64, 4.0 * (i / ROW) as f64, 0.0]));
    }
    soup
}

/// A triangle and its reverse: every edge has two triangles, in opposite directions.
fn pillow() -> RawSoup {
    let mut pillow = prism(0.0);
    pillow.positions.truncate(3);
    pillow.triangles = vec![[0, 2, 1], [0, 1, 2]];
    pillow
}

fn judge(soup: &RawSoup) -> Certificate {
    verify(soup, Encoding::StlBinary, Depth::Count { samples: 2 })
}

#[test]
fn certificate_rejects_thousands_of_triangles_with_their_reverse() {
    let certificate = judge(&field(&pillow()));
    let said = certificate.violations;
    assert!(!certificate.p0);
    assert_eq!(said.duplicate, Some(PRISMS as u64));
    assert_eq!(
        [said.edges_without_two_triangles, said.edges_in_one_direction, said.singular_vertices],
        [Some(0); 3]
    );
    assert_eq!(certificate.witnesses[0].condition, Condition::Distinct);
    assert_eq!(certificate.witnesses[0].faces, [0, 1]);
}

#[test]
fn certificate_rejects_one_triangle_with_its_reverse_among_thousands_of_prisms() {
    let mut soup = field(&prism(0.5));
    soup = soup.with(&pillow().moved([-7.0, 0.0, 0.0]));
    let certificate = judge(&soup);
    assert_eq!(certificate.violations.duplicate, Some(1));
    let last = soup.triangles.len() as u32 - 1;
    assert_eq!(certificate.witnesses[0].faces, [last - 1, last]);
}

#[test]
fn certificate_accepts_thousands_of_thin_prisms_and_counts_them() {
    for height in [1.0, 1e-3, 1e-30] {
        let certificate = judge(&field(&prism(height)));
        assert!(certificate.is_printable(), "{height}: {certificate:?}");
        assert_eq!(certificate.shells.len(), PRISMS);
        for shell in &certificate.shells {
            assert_eq!((shell.triangles, shell.depth, shell.genus), (8, 0, 0));
            // A float has 24 bits.
            assert!((shell.volume / (height / 2.0) - 1.0).abs() < 1e-6, "{height}: {}", shell.volume);
        }
        assert_eq!(certificate.euler_characteristic, 2 * PRISMS as i64);
    }
}

#[test]
fn certificate_rejects_thousands_of_prisms_of_no_height() {
    let certificate = judge(&field(&prism(0.0)));
    // The two triangles of each of the three walls.
    assert_eq!(certificate.violations.degenerate, Some(6 * PRISMS as u64));
    assert_eq!(certificate.violations.duplicate, Some(PRISMS as u64));
    assert!(!certificate.is_printable());
}

#[test]
fn certificate_rejects_thousands_of_prisms_when_one_more_touches_overlaps_or_doubles_one() {
    let mut random = Random::new(3);
    let field = field(&prism(0.5));
    let turned = || prism(0.5).map(|[x, y, z]| [-x, -y, z]);
    for (name, part) in [
        ("an edge on a wall", prism(0.5).moved([-1.0, 0.25, 0.25])),
        ("a wall on a wall", turned().moved([0.0, 0.75, 0.25])),
        ("a foot on a roof", prism(0.5).moved([0.0, 0.0, 0.5])),
        ("a corner on a corner", prism(0.5).moved([1.0, 0.0, 0.5])),
        (
            "a corner on a roof",
            turned().moved([0.25, 0.25, 0.5]).map(|[x, y, z]| [x, y, z + (0.25 - x) / 4.0]),
        ),
        ("an edge on an edge", prism(0.5).moved([-1.0, 0.0, 0.0])),
        ("one through the other", prism(0.5).moved([0.25, 0.125, 0.125])),
        ("a copy", prism(0.5)),
    ] {
        let place = random.below(PRISMS);
        let origin = field.positions[6 * place];
        let soup = field.clone().with(&part.moved(origin));
        let certificate = judge(&soup);
        assert!(!certificate.is_printable(), "{name}");
        let is_ours = |t: &u32| *t as usize / 8 == place || *t as usize / 8 == PRISMS;
        for witness in &certificate.witnesses {
            assert!(witness.faces.iter().all(is_ours), "{name}: {witness:?} is not about prism {place}");
        }
    }
}

#[test]
fn certificate_rejects_thousands_of_prisms_when_one_is_inside_out() {
    let mut soup = field(&prism(0.5));
    let place = 1234;
    for t in &mut soup.triangles[8 * place..8 * (place + 1)] {
        t.swap(0, 1);
    }
    let certificate = judge(&soup);
    assert!(certificate.p0 && certificate.p1 == Some(true));
    assert_eq!(certificate.p2, Some(false));
    assert_eq!(certificate.violations.misnested_shells, Some(1));
    assert_eq!(certificate.witnesses[0].faces, [8 * place as u32]);
}
