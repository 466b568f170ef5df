//! Bodies that pass through each other, with a hole of one triangle: through it all that is inside can be seen, and it is a defect all the
//! same, not an opening.

use crate::oracle::RawSoup;
use crate::repair::repaired;
use crate::solids::cuboid;
use meshmend::pipeline::Outcome;

/// Two boxes that share a corner of 8 x 6 x 4.
fn boxes() -> RawSoup {
    cuboid([12.0, 10.0, 8.0]).with(&cuboid([12.0, 10.0, 8.0]).moved([4.0; 3]))
}

const VOLUME: f64 = 2.0 * 960.0 - 8.0 * 6.0 * 4.0;

fn assert_united(mesh: &RawSoup, name: &str) {
    let report = repaired(mesh).report;
    assert_eq!(report.outcome, Some(Outcome::Repaired), "{name}");
    let volume = report.after.as_ref().unwrap().measures.volume.unwrap();
    assert!((volume - VOLUME).abs() < 1e-6 * VOLUME, "{name}: {volume}");
    assert_eq!(report.certificate.as_ref().unwrap().shells.len(), 1, "{name}");
    // What was seen through the hole is told.
    let [lost, told] = [report.losses.unwrap().visible_loss, report.fidelity.unwrap().changes.len() as f64];
    assert!((0.01..0.3).contains(&lost) && told > 0.0, "{name}: {lost}");
}

#[test]
fn the_bodies_become_one_whichever_triangle_is_missing() {
    for t in 0..24 {
        let mut open = boxes();
        open.triangles.remove(t);
        assert_united(&open, &format!("without triangle {t}"));
    }
}

#[test]
fn so_they_do_where_both_miss_one_and_where_all_faces_turn_inward() {
    for (a, b) in [(0, 12), (3, 20), (11, 23)] {
        let mut open = boxes();
        open.triangles.remove(b);
        open.triangles.remove(a);
        assert_united(&open, &format!("without triangles {a} and {b}"));
        assert_united(&open.inside_out(), &format!("inside out, without triangles {a} and {b}"));
    }
}

#[test]
fn a_body_that_is_seen_through_a_hole_is_not_filled_over() {
    // A tent of triangles whose one end is open, and a box in it that touches nothing.
    let positions = [
        [0.0, 0.0, 0.0],
        [20.0, 0.0, 0.0],
        [10.0, 0.0, 18.0],
        [0.0, 8.0, 0.0],
        [20.0, 8.0, 0.0],
        [10.0, 8.0, 18.0],
    ];
    let triangles = vec![[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [2, 3, 0], [3, 5, 4]];
    let open = RawSoup { positions: positions.to_vec(), triangles };
    let report = repaired(&open.with(&cuboid([10.0, 4.0, 6.0]).moved([5.0, 2.0, 1.0]))).report;
    assert_eq!(report.outcome, Some(Outcome::Repaired));
    let losses = report.losses.unwrap();
    assert_eq!((losses.bodies_lost, losses.visible_loss < 0.01), (0, true), "{losses:?}");
}
