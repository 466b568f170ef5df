//! Polygons that a file has more than once, from other corners and the other way around.

use crate::repair::{answer, count};
use meshmend::analysis::DefectCode;
use meshmend::budget::Budget;
use meshmend::pipeline::{Answer, Operation, Options, Outcome, run};

/// A cube of side 10 of squares.
const CUBE: &str = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 0\nv 0 0 10\nv 10 0 10\nv 0 10 10\nv 10 10 10\n\
                    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// The first square of the cube from each corner, as it runs and turned around.
const COPIES: [&str; 8] =
    ["1 3 4 2", "3 4 2 1", "4 2 1 3", "2 1 3 4", "1 2 4 3", "2 4 3 1", "4 3 1 2", "3 1 2 4"];

fn finding(answer: &Answer, code: DefectCode) -> u64 {
    let findings = &answer.report.before.as_ref().unwrap().findings;
    findings.iter().find(|finding| finding.code == code).map_or(0, |finding| finding.count)
}

fn assert_whole_cube(answer: &Answer, case: &str) {
    let report = &answer.report;
    assert_eq!(report.outcome, Some(Outcome::Repaired), "{case}: {:?}", report.refusal);
    assert!(report.certificate.as_ref().unwrap().is_printable());
    let after = report.after.as_ref().unwrap();
    assert_eq!((after.counts.triangles, after.measures.volume), (12, Some(1000.0)), "{case}");
    assert!(report.identical_triangle_share.unwrap() > 0.8, "{case}");
    assert!(report.actions.iter().all(|action| action.move_max == 0.0 && action.step != "wrap"), "{case}");
}

#[test]
fn a_copy_of_a_square_is_a_duplicate_from_whichever_corner_it_begins() {
    for (i, copy) in COPIES.iter().enumerate() {
        let text = format!("{CUBE}f {copy}\n");
        let analyzed =
            run(Operation::Analyze, text.as_bytes(), &Options::default(), &Budget::unlimited()).unwrap();
        let is_reversed = i >= 4;
        assert_eq!(finding(&analyzed, DefectCode::DuplicateFace), if is_reversed { 0 } else { 2 }, "{copy}");
        assert_eq!(
            finding(&analyzed, DefectCode::OppositeDuplicateFace),
            if is_reversed { 2 } else { 0 },
            "{copy}"
        );
        assert_eq!(finding(&analyzed, DefectCode::Overlap), 0, "{copy}");
        if !is_reversed {
            assert_whole_cube(&answer(text.as_bytes(), &Options::default()), copy);
        }
    }
}

#[test]
fn copies_over_vertices_of_their_own_are_copies_too() {
    for order in ["9 10 11 12", "10 11 12 9", "11 12 9 10", "12 9 10 11"] {
        let text = format!("{CUBE}v 0 0 0\nv 0 10 0\nv 10 10 0\nv 10 0 0\nf {order}\n");
        assert_whole_cube(&answer(text.as_bytes(), &Options::default()), order);
    }
}

#[test]
fn two_cubes_glued_by_a_whole_square_are_one_block_from_whichever_corner_it_begins() {
    // The second cube stands below the first; its top is the first's bottom, turned around.
    let points = "v 0 0 -10\nv 10 0 -10\nv 0 10 -10\nv 10 10 -10\n";
    let sides = "f 9 11 12 10\nf 9 10 2 1\nf 11 3 4 12\nf 9 1 3 11\nf 10 12 4 2\n";
    for top in &COPIES[4..] {
        let text = format!("{CUBE}{points}{sides}f {top}\n");
        let answer = answer(text.as_bytes(), &Options::default());
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{top}: {:?}", answer.report.refusal);
        let after = answer.report.after.as_ref().unwrap();
        assert_eq!((after.counts.triangles, after.measures.volume), (20, Some(2000.0)), "{top}");
        assert_eq!(count(&answer, "opposite_pairs_cancelled"), 2, "{top}");
    }
}

#[test]
fn a_pentagon_given_twice_is_dropped_once_from_every_corner() {
    // A prism over a pentagon.
    let ring = [[0, 0], [4, -2], [8, 0], [6, 5], [2, 5]];
    let points: String = [0, 6].iter().flat_map(|z| ring.map(|[x, y]| format!("v {x} {y} {z}\n"))).collect();
    let sides: String =
        (0..5).map(|i| format!("f {} {} {} {}\n", i + 1, (i + 1) % 5 + 1, (i + 1) % 5 + 6, i + 6)).collect();
    let prism = format!("{points}f 5 4 3 2 1\nf 6 7 8 9 10\n{sides}");
    let mut top = [6, 7, 8, 9, 10];
    for _ in 0..5 {
        top.rotate_left(1);
        let [a, b, c, d, e] = top;
        let text = format!("{prism}f {a} {b} {c} {d} {e}\n");
        let answer = answer(text.as_bytes(), &Options::default());
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{top:?}: {:?}", answer.report.refusal);
        assert_eq!(
            (count(&answer, "copies_dropped"), answer.report.after.unwrap().counts.triangles),
            (3, 16)
        );
    }
}
