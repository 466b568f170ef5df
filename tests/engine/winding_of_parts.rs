//! What a repair makes of parts must not depend on how they are wound.

use crate::oracle::{RawSoup, weld};
use crate::raw_files::encode;
use crate::repair::{count, repaired};
use crate::solids::cuboid;
use meshmend::budget::Budget;
use meshmend::formats::Encoding;
use meshmend::pipeline::{Answer, CutStitchChoices, Operation, Options, Outcome, Stitching, run};

/// Two cubes of side 10 that share an edge, over common vertices.
fn sharing_an_edge() -> RawSoup {
    weld(&cuboid([10.0; 3]).with(&cuboid([10.0; 3]).moved([10.0, 10.0, 0.0])))
}

/// Two cubes of side 10 that share a corner, over common vertices.
fn sharing_a_corner() -> RawSoup {
    weld(&cuboid([10.0; 3]).with(&cuboid([10.0; 3]).moved([10.0; 3])))
}

/// Shells, and the volume of all.
fn figures(answer: &Answer) -> (usize, f64) {
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
    let shells = answer.report.certificate.as_ref().unwrap().shells.len();
    (shells, answer.report.after.as_ref().unwrap().measures.volume.unwrap())
}

#[test]
fn two_bodies_that_touch_stay_two_whether_they_are_inside_out_or_not() {
    for soup in [sharing_an_edge(), sharing_a_corner()] {
        for soup in [soup.clone(), soup.inside_out()] {
            let (shells, volume) = figures(&repaired(&soup));
            assert!(shells == 2 && (volume - 2000.0).abs() < 1.0, "{shells} shells of {volume}");
        }
    }
}

#[test]
fn two_cavities_that_touch_stay_cavities_of_a_body_inside_out_or_not() {
    let holes = sharing_an_edge().moved([5.0, 5.0, 5.0]).inside_out();
    let block = cuboid([30.0, 30.0, 20.0]).with(&holes);
    for soup in [block.clone(), block.inside_out()] {
        let (_, volume) = figures(&repaired(&soup));
        assert!((volume - 16_000.0).abs() < 1.0, "{volume}");
    }
}

/// Square pages around the z axis, each beside it by a little, so that none shares a vertex with another; those of
/// `turned` (bits) are wound the other way.
fn book(pages: u32, turned: u32) -> RawSoup {
    let mut soup = RawSoup { positions: Vec::new(), triangles: Vec::new() };
    for page in 0..pages {
        let angle = f64::from(page) * std::f64::consts::TAU / f64::from(pages);
        let (y, x) = angle.sin_cos();
        let base = soup.positions.len() as u32;
        for (r, z) in [(2e-4, 0.0), (1.0, 0.0), (1.0, 1.0), (2e-4, 1.0)] {
            soup.positions.push([x * r, y * r, z]);
        }
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let t = if turned >> page & 1 == 1 { [a, c, b] } else { [a, b, c] };
            soup.triangles.push(t.map(|v| v + base));
        }
    }
    soup
}

#[test]
fn pages_of_a_book_are_joined_in_pairs_however_they_are_wound() {
    for pages in 2..=8u32 {
        for turned in 0..1u32 << pages {
            let choices = CutStitchChoices {
                stitching: Stitching::Snap,
                epsilon: Some(1e-3),
                ..CutStitchChoices::default()
            };
            let options = Options { cut_stitch: choices, ..Options::default() };
            let bytes = encode(&book(pages, turned), Encoding::Obj);
            let answer = run(Operation::CutStitch, &bytes, &options, &Budget::unlimited()).unwrap();
            let joined = count(&answer, "edges_joined");
            assert_eq!(joined, u64::from(pages / 2), "{pages} pages, turned {turned:b}");
        }
    }
}
