//! Faces without area beside a valid body: they go, and nothing else happens.

use crate::repair::{answer, count};
use meshmend::pipeline::{FidelityLimits, Options, Outcome};

/// A cube of side 10 of squares.
const CUBE: &str = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 0\nv 0 0 10\nv 10 0 10\nv 0 10 10\nv 10 10 10\n\
                    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// Places of a row of points, faces without area on them (from 9), and what these are called.
const STRAYS: [(&str, &str); 10] = [
    ("a point", "f 9 9 9\n"),
    ("an edge", "f 9 10 10\n"),
    ("an edge, run back", "f 9 10 9\n"),
    ("a line", "f 9 10 11\n"),
    ("a polygon on a line", "f 9 10 11 12\n"),
    ("a polygon back and forth", "f 9 11 10 12\n"),
    ("a quad of two places", "f 9 10 9 10\n"),
    ("a quad that turns back", "f 9 10 10 9\n"),
    ("a point of four corners", "f 9 9 9 9\n"),
    ("several", "f 9 10 11\nf 9 9 9\nf 10 11 12\nf 12 12 9\n"),
];

/// Four points in a row from a place.
fn row([x, y, z]: [f64; 3]) -> String {
    (0..4).map(|i| format!("v {} {y} {z}\n", x + f64::from(i))).collect()
}

#[test]
fn a_face_without_area_goes_and_the_cube_beside_it_keeps_every_bit() {
    for (name, face) in STRAYS {
        // Away from the body, far away from it, beside a corner, and inside of it.
        for place in [[20.0, 5.0, 5.0], [2e4, -3e4, 5.0], [10.5, 10.5, 10.5], [3.0, 4.0, 5.0]] {
            let text = format!("{CUBE}{}{face}", row(place));
            // A limit that only a result at no distance meets.
            let limits = FidelityLimits { deviation_max: Some(1e-3), volume_change_max: Some(0.0) };
            for options in [Options::default(), Options { limits, ..Options::default() }] {
                let answer = answer(text.as_bytes(), &options);
                let report = &answer.report;
                assert_eq!(
                    report.outcome,
                    Some(Outcome::Repaired),
                    "{name} at {place:?}: {:?}",
                    report.refusal
                );
                assert!(report.certificate.as_ref().unwrap().is_printable());
                let after = report.after.as_ref().unwrap();
                assert_eq!((after.counts.triangles, after.measures.volume), (12, Some(1000.0)), "{name}");
                assert_eq!(report.losses.unwrap().bodies_lost, 0, "{name}");
                assert!(report.actions.iter().all(|action| action.move_max == 0.0 && action.step != "wrap"));
            }
        }
    }
}

#[test]
fn a_face_without_area_at_the_cube_itself_goes_too() {
    for face in
        ["f 1 1 1\n", "f 1 2 2\n", "f 1 4 1\n", "f 1 2 9\n", "f 1 9 9\n", "f 1 2 9 10\n", "f 9 1 10 9\n"]
    {
        // The points lie on the line of the first edge, outside of the cube.
        let text = format!("{CUBE}{}{face}", row([20.0, 0.0, 0.0]));
        let answer = answer(text.as_bytes(), &Options::default());
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{face}: {:?}", answer.report.refusal);
        let after = answer.report.after.as_ref().unwrap();
        assert_eq!((after.counts.triangles, after.measures.volume), (12, Some(1000.0)), "{face}");
    }
}

#[test]
fn a_body_with_area_is_still_one_that_may_not_go_unsaid() {
    // A tetrahedron of which one face is missing stays; nothing is removed.
    let text = format!("{CUBE}v 20 0 0\nv 22 0 0\nv 20 2 0\nv 20 0 2\nf 9 11 10\nf 9 10 12\nf 9 12 11\n");
    let answer = answer(text.as_bytes(), &Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    assert_eq!(
        (answer.report.certificate.as_ref().unwrap().shells.len(), count(&answer, "holes_filled")),
        (2, 1)
    );
}

/// Quads of a box from the origin, without its lid.
fn open_box([x, y, z]: [f64; 3]) -> String {
    let corner = |i: u32| {
        let at = |size: f64, bit: u32| size * f64::from(i >> bit & 1);
        format!("v {} {} {}\n", at(x, 0), at(y, 1), at(z, 2))
    };
    let corners: String = (0..8).map(corner).collect();
    corners + "f 1 3 4 2\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

#[test]
fn a_stray_triangle_beside_an_open_box_does_not_make_it_a_skin() {
    for height in [2.0, 5.0, 10.0] {
        let text = format!("{}v 60 0 0\nv 61 0 0\nv 60 1 0\nf 9 10 11\n", open_box([40.0, 30.0, height]));
        let volume =
            answer(text.as_bytes(), &Options::default()).report.after.unwrap().measures.volume.unwrap();
        // The stray becomes a wall.
        assert!((volume - 1200.0 * height).abs() < 1.0, "{height}: {volume}");
    }
}

#[test]
fn a_wall_inside_a_box_of_which_a_triangle_is_missing_does_not_make_it_a_skin() {
    // A corner of the lid is missing; the wall begins and ends in the middle of sides.
    let text = "v 0 0 0\nv 40 0 0\nv 0 30 0\nv 40 30 0\nv 0 0 10\nv 40 0 10\nv 0 30 10\nv 40 30 10\n\
                v 6 0 10\nv 0 6 10\nv 13 0 2\nv 13 30 2\nv 13 30 8\nv 13 0 8\n\
                f 1 3 4 2\nf 1 2 6 9 5\nf 3 7 8 4\nf 1 5 10 7 3\nf 2 4 8 6\nf 9 6 8 7 10\nf 11 12 13 14\n";
    let volume = answer(text.as_bytes(), &Options::default()).report.after.unwrap().measures.volume.unwrap();
    assert!((volume - 12000.0).abs() < 1e-6, "{volume}");
}
