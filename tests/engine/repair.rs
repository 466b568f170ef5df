//! Whole repairs, from bytes to bytes, on the smallest solids.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use std::f64::consts::PI;

use meshmend::budget::Budget;
use meshmend::formats::{self, Encoding, Format, ReadOptions};
use meshmend::mesh::Soup;
use meshmend::par;
use meshmend::pipeline::{
    Answer, FillHoles, Operation, Options, Outcome, Refusal, Require, WrapChoices, run,
};

pub(crate) fn answer(bytes: &[u8], options: &Options) -> Answer {
    run(Operation::Repair, bytes, options, &Budget::unlimited()).unwrap()
}

pub(crate) fn repaired(soup: &RawSoup) -> Answer {
    answer(&encode(soup, Encoding::Obj), &coarse())
}

/// Options with which a rebuilt surface has few cells.
pub(crate) fn coarse() -> Options {
    Options { wrap: WrapChoices { cells: Some(24), ..WrapChoices::default() }, ..Options::default() }
}

/// Sum of a named count over all actions.
pub(crate) fn count(answer: &Answer, name: &str) -> u64 {
    let changes = answer.report.actions.iter().flat_map(|action| &action.changes);
    changes.filter(|(n, _)| *n == name).map(|(_, count)| count).sum()
}

/// The returned mesh, which must be certified, with the number of its shells.
fn certified(answer: &Answer) -> (Soup, usize) {
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
    let certificate = answer.report.certificate.as_ref().unwrap();
    assert!(certificate.is_printable());
    let output = answer.output.as_ref().unwrap();
    let bytes = output.bytes.as_ref().unwrap();
    let soup = formats::read(bytes, output.encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    (soup, certificate.shells.len())
}

pub(crate) fn refused(answer: &Answer) -> &Refusal {
    assert_eq!(answer.report.outcome, Some(Outcome::Refused));
    assert!(answer.output.is_none() && answer.report.certificate.is_none());
    answer.report.refusal.as_ref().unwrap()
}

/// The soup without the triangles of these numbers.
pub(crate) fn without(mut soup: RawSoup, gone: &[usize]) -> RawSoup {
    let mut t = 0;
    soup.triangles.retain(|_| {
        t += 1;
        !gone.contains(&(t - 1))
    });
    soup
}

pub(crate) fn flat(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> RawSoup {
    RawSoup { positions: points.iter().map(|&[x, y]| [x, y, 0.0]).collect(), triangles: triangles.to_vec() }
}

/// A cube of side 3 with a cube of side 1 in its middle, which points inward: a cavity.
fn hollow_cube() -> RawSoup {
    cuboid([3.0; 3]).with(&cube().moved([1.0; 3]).inside_out())
}

#[test]
fn a_valid_file_comes_back_as_the_same_bytes() {
    for soup in [cube(), hollow_cube()] {
        let answer = repaired(&soup);
        assert_eq!(answer.report.outcome, Some(Outcome::Identical));
        assert_eq!(answer.output.unwrap().bytes, None);
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
        assert!(answer.report.actions.is_empty() && answer.report.after.is_none());
    }
}

#[test]
fn a_valid_file_in_another_format_is_converted() {
    let options = Options { output_format: Some(Format::Stl), ..Options::default() };
    let answer = answer(&encode(&hollow_cube(), Encoding::Obj), &options);
    assert_eq!(answer.report.outcome, Some(Outcome::Converted));
    assert_eq!(answer.report.identical_triangle_share, Some(1.0));
    assert!(answer.report.certificate.unwrap().is_printable());
    assert_eq!(answer.output.unwrap().encoding, Encoding::StlBinary);
}

#[test]
fn a_cube_without_a_face_gets_it_back_and_nothing_else_changes() {
    for encoding in
        [Encoding::Obj, Encoding::StlBinary, Encoding::StlAscii, Encoding::Off, Encoding::PlyAscii]
    {
        let answer = answer(&encode(&without(cube(), &[2, 3]), encoding), &Options::default());
        let (soup, shells) = certified(&answer);
        assert_eq!((soup.triangles.len(), shells), (12, 1));
        assert_eq!(answer.output.as_ref().unwrap().encoding, encoding);
        assert_eq!((count(&answer, "holes_filled"), count(&answer, "triangles_added")), (1, 2));
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
        assert!(answer.report.actions.iter().all(|action| action.move_max == 0.0));
    }
}

#[test]
fn holes_stay_open_when_that_is_asked() {
    let bytes = encode(&without(cube(), &[2, 3]), Encoding::Obj);
    let options = Options { fill_holes: FillHoles::None, require: Some(Require::None), ..coarse() };
    let open = answer(&bytes, &options);
    assert_eq!(open.report.outcome, Some(Outcome::Partial));
    assert_eq!(open.report.after.unwrap().counts.triangles, 10);
    let options = Options { fill_holes: FillHoles::None, ..coarse() };
    let (volume, shells) = crate::rebuild::rebuilt(&answer(&bytes, &options));
    assert!(shells == 1 && (0.8..1.1).contains(&volume), "{volume}");
}

#[test]
fn a_cube_without_a_corner_is_closed_across_a_loop_that_is_not_flat() {
    let mut soup = cube();
    soup.triangles.retain(|t| !t.contains(&0));
    let answer = repaired(&soup);
    let (_, shells) = certified(&answer);
    assert_eq!(
        (shells, count(&answer, "holes_filled"), count(&answer, "unused_vertices_dropped")),
        (1, 1, 1)
    );
}

#[test]
fn flipped_faces_turn_back() {
    let mut soup = cube();
    for t in [0, 5, 6] {
        soup.triangles[t].swap(0, 1);
    }
    let answer = repaired(&soup);
    assert_eq!(certified(&answer).0.triangles.len(), 12);
    assert_eq!(count(&answer, "triangles_flipped"), 3);
    assert_eq!(answer.report.identical_triangle_share, Some(0.75));
}

#[test]
fn an_inverted_cube_turns_and_so_does_an_inverted_one_with_a_cavity() {
    assert_eq!(certified(&repaired(&cube().inside_out())).1, 1);
    let answer = repaired(&hollow_cube().inside_out());
    assert_eq!(certified(&answer).1, 2);
    assert_eq!(count(&answer, "shells_turned"), 2);
    assert_eq!(answer.report.certificate.unwrap().shells.iter().map(|s| s.depth).collect::<Vec<_>>(), [0, 1]);
}

#[test]
fn a_cavity_stays_when_the_body_around_it_is_repaired() {
    let answer = repaired(&without(hollow_cube(), &[0, 1]));
    assert_eq!(certified(&answer).1, 2);
    assert_eq!(count(&answer, "shells_turned"), 0);
}

#[test]
fn an_outward_shell_inside_a_body_is_dropped_and_listed_by_a_face_of_the_file() {
    let answer = repaired(&cuboid([3.0; 3]).with(&cube().moved([1.0; 3])));
    assert_eq!(certified(&answer).0.triangles.len(), 12);
    assert_eq!(count(&answer, "hidden_shells_dropped"), 1);
    let nest = answer.report.actions.iter().find(|action| action.step == "nest").unwrap();
    assert!(nest.reason.contains("those with faces 12"), "{}", nest.reason);
}

#[test]
fn the_double_wall_between_two_cubes_goes_and_one_box_is_left() {
    let upper = RawSoup { positions: cube().moved([0.0, 0.0, 1.0]).positions, triangles: cube().triangles };
    let mut both = cube().with(&upper);
    // The lower cube's top and the upper cube's bottom have other diagonals; give them the same one.
    both.triangles[12] = [8, 11, 9];
    both.triangles[13] = [8, 10, 11];
    let answer = repaired(&both);
    let (soup, shells) = certified(&answer);
    assert_eq!((soup.triangles.len(), shells), (20, 1));
    assert_eq!(count(&answer, "opposite_pairs_cancelled"), 2);
}

#[test]
fn a_cube_given_in_both_directions_is_a_cube() {
    let answer = repaired(&cube().with(&cube().inside_out()));
    assert_eq!(certified(&answer).0.triangles.len(), 12);
    assert_eq!(count(&answer, "copies_dropped"), 12);
}

#[test]
fn a_cube_given_in_both_directions_but_for_one_face_is_a_cube_by_the_second_plan() {
    let both = cube().with(&without(cube().inside_out(), &[4]));
    assert_eq!(certified(&repaired(&both)).0.triangles.len(), 12);
}

#[test]
fn a_body_that_fills_a_cavity_exactly_leaves_a_full_body() {
    for filling_first in [false, true] {
        let filling = cube().moved([1.0; 3]);
        let soup = if filling_first { filling.with(&hollow_cube()) } else { hollow_cube().with(&filling) };
        let answer = repaired(&soup);
        assert_eq!(certified(&answer).0.triangles.len(), 12, "filling first: {filling_first}");
        assert_eq!(answer.report.certificate.unwrap().shells[0].volume, 27.0);
    }
}

#[test]
fn duplicate_faces_are_dropped() {
    let mut soup = cube();
    soup.triangles.extend([soup.triangles[3], soup.triangles[7]]);
    let answer = repaired(&soup);
    assert_eq!(certified(&answer).0.triangles.len(), 12);
    assert_eq!(answer.report.identical_triangle_share, Some(12.0 / 14.0));
}

#[test]
fn a_collinear_face_goes_and_its_neighbour_is_split() {
    let mut soup = cube();
    // A vertex in the middle of edge 0-1; the triangle on one side is split there, the other has a sliver instead.
    soup.positions.push([0.5, 0.0, 0.0]);
    let split = soup.triangles.iter().position(|t| (0..3).any(|c| [t[c], t[(c + 1) % 3]] == [0, 1])).unwrap();
    let apex = *soup.triangles[split].iter().find(|&&v| v > 1).unwrap();
    soup.triangles[split] = [0, 8, apex];
    soup.triangles.extend([[8, 1, apex], [0, 1, 8]]);
    let answer = repaired(&soup);
    assert_eq!(certified(&answer).0.triangles.len(), 14);
    assert_eq!((count(&answer, "triangles_split"), count(&answer, "holes_filled")), (1, 0));
}

#[test]
fn a_mesh_split_along_seams_is_welded() {
    let cube = cube();
    let split = RawSoup {
        positions: cube.triangles.iter().flatten().map(|&v| cube.positions[v as usize]).collect(),
        triangles: (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
    };
    let answer = repaired(&split);
    assert_eq!(certified(&answer).0.positions.len(), 8);
    assert_eq!(count(&answer, "vertices_joined"), 28);
    assert_eq!(answer.report.identical_triangle_share, Some(1.0));
}

#[test]
fn both_open_ends_of_a_pipe_are_closed_around_its_bore() {
    let side = |size: f64| {
        let mut tube = cuboid([size, size, 4.0]).moved([-size / 2.0, -size / 2.0, 0.0]);
        tube.triangles.retain(|t| {
            let z = t.map(|v| tube.positions[v as usize][2]);
            z.contains(&0.0) && z.contains(&4.0)
        });
        tube
    };
    let answer = repaired(&side(4.0).with(&side(2.0).inside_out()));
    let (soup, shells) = certified(&answer);
    assert_eq!((soup.triangles.len(), shells), (32, 1));
    assert_eq!(answer.report.certificate.unwrap().shells[0].genus, 1);
}

#[test]
fn the_patch_of_an_inverted_body_runs_with_its_rim_and_turns_with_it() {
    let answer = repaired(&without(cube(), &[6]).inside_out());
    assert_eq!(certified(&answer).0.triangles.len(), 12);
    assert_eq!((count(&answer, "holes_filled"), count(&answer, "shells_turned")), (1, 1));
    assert_eq!(answer.report.certificate.unwrap().shells[0].volume, 1.0);
}

#[test]
fn a_stray_triangle_beside_a_body_is_neither_deleted_nor_doubled() {
    let options = Options { require: Some(Require::None), ..Options::default() };
    let stray = flat(&[[5.0, 0.0], [6.0, 0.0], [5.0, 1.0]], &[[0, 1, 2]]);
    let answer = answer(&encode(&cube().with(&stray), Encoding::Obj), &options);
    assert_eq!(answer.report.outcome, Some(Outcome::Partial));
    assert_eq!(answer.report.after.unwrap().counts.triangles, 13);
}

#[test]
fn walls_with_crossing_diagonals_are_not_taken_for_copies() {
    // The two triangulations of the common square are four different triangles that overlap.
    let quarter_turn = |[x, y, z]: [f64; 3]| [1.0 - y, x, z + 1.0];
    let above = RawSoup { positions: cube().positions.into_iter().map(quarter_turn).collect(), ..cube() };
    let answer = repaired(&cube().with(&above));
    let (_, shells) = certified(&answer);
    assert_eq!((shells, answer.report.certificate.as_ref().unwrap().shells[0].volume), (1, 2.0));
    assert_eq!(count(&answer, "copies_dropped") + count(&answer, "opposite_pairs_cancelled"), 0);
}

#[test]
fn a_face_with_nan_is_replaced() {
    let mut text = String::from_utf8(encode(&cube(), Encoding::Obj)).unwrap();
    text.push_str("v nan 0 0\nf 1 2 9\n");
    let answer = answer(text.as_bytes(), &Options::default());
    assert_eq!(certified(&answer).0.triangles.len(), 12);
    assert_eq!(count(&answer, "unusable_faces_dropped"), 1);
}

#[test]
fn nothing_but_degenerate_triangles_is_nothing_to_repair() {
    let line = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], &[[0, 1, 2], [0, 0, 1]]);
    assert_eq!(refused(&repaired(&line)), &Refusal::NothingToRepair);
}

#[test]
fn what_is_mended_is_written_when_nothing_is_required_and_says_what_does_not_hold() {
    let options = Options { require: Some(Require::None), ..Options::default() };
    let sheet = flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [5.0, 5.0]], &[[0, 1, 2], [0, 1, 2]]);
    let answer = answer(&encode(&sheet, Encoding::Obj), &options);
    assert_eq!(answer.report.outcome, Some(Outcome::Partial));
    assert!(!answer.report.certificate.as_ref().unwrap().is_printable());
    assert_eq!(answer.report.after.unwrap().counts.triangles, 1);
    assert!(answer.output.unwrap().bytes.is_some());
}

#[test]
fn cubes_that_touch_are_drawn_apart_and_all_but_the_touching_corners_keep_their_bits() {
    for (at, moved) in [([1.0, 1.0, 1.0], 1), ([1.0, 1.0, 0.0], 2)] {
        let answer =
            answer(&encode(&cube().with(&cube().moved(at)), Encoding::StlBinary), &Options::default());
        let (soup, shells) = certified(&answer);
        assert_eq!((shells, soup.positions.len()), (2, 16));
        let open = answer.report.actions.iter().find(|action| action.step == "open-contacts").unwrap();
        assert_eq!(open.changes, [("vertices_moved", moved)]);
        assert!(open.move_max > 0.0 && open.move_max < 1e-5, "{}", open.move_max);
        assert!(answer.report.distance.unwrap().upper() < 1e-5);
    }
}

/// A unit ball of `2 n (n - 1)` triangles: poles, and `n` columns of `n - 1` vertices row by row.
fn globe(n: u32) -> RawSoup {
    let angle = |k: u32, whole: f64| f64::from(k) / f64::from(n) * whole;
    let ring = |row: u32| {
        let (r, z) = angle(row, PI).sin_cos();
        (0..n).map(move |column| {
            let (y, x) = angle(column, 2.0 * PI).sin_cos();
            [r * x, r * y, z].map(|x| f64::from(x as f32))
        })
    };
    let vertex = |row: u32, column: u32| match row {
        0 => 0,
        row if row == n => 1 + (n - 1) * n,
        row => 1 + (row - 1) * n + column % n,
    };
    let positions = [[0.0, 0.0, 1.0]].into_iter().chain((1..n).flat_map(ring)).chain([[0.0, 0.0, -1.0]]);
    let triangles =
        (0..n).flat_map(|row| (0..n).map(move |column| (row, column))).flat_map(|(row, column)| {
            let [a, b] = [vertex(row, column), vertex(row, column + 1)];
            let [c, d] = [vertex(row + 1, column), vertex(row + 1, column + 1)];
            [[a, c, d], [a, d, b]]
        });
    let is_proper = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    RawSoup { positions: positions.collect(), triangles: triangles.filter(is_proper).collect() }
}

#[test]
fn a_spike_through_a_large_surface_goes_and_both_places_are_closed() {
    // One vertex of a ball is pulled through the ball and out on the other side.
    let mut soup = globe(48);
    let vertex = &mut soup.positions[1 + 23 * 48];
    *vertex = vertex.map(|x| f64::from((-1.1 * x + 0.01) as f32));
    let answer = answer(&encode(&soup, Encoding::Off), &Options::default());
    let (_, shells) = certified(&answer);
    assert_eq!(shells, 1);
    assert!(answer.report.actions.iter().any(|action| action.step == "unite"));
    assert!(answer.report.identical_triangle_share.unwrap() > 0.9);
    assert!(answer.report.losses.unwrap().visible_loss < 0.01);
}

#[test]
fn the_number_of_threads_does_not_change_a_byte() {
    let mut soup = without(hollow_cube(), &[0, 1, 14]).with(&without(cube().moved([7.0, 0.0, 0.0]), &[5]));
    soup.triangles.push(soup.triangles[8]);
    let bytes = encode(&soup, Encoding::PlyBinaryLittleEndian);
    let answers: Vec<Answer> =
        [1, 2, 8].map(|threads| par::with_threads(threads, || answer(&bytes, &Options::default()))).to_vec();
    certified(&answers[0]);
    assert_eq!(answers[0], answers[1]);
    assert_eq!(answers[0], answers[2]);
}

#[test]
fn the_rungs_that_were_tried_are_told_in_their_order() {
    let valid = cube();
    assert!(repaired(&valid).report.tried.is_empty());
    assert_eq!(repaired(&without(cube(), &[0])).report.tried, ["as-drawn"]);
    let overlapping = cube().with(&cuboid([0.5; 3]).moved([0.75, 0.25, 0.25]));
    assert_eq!(repaired(&overlapping).report.tried, ["as-drawn", "unite"]);
    let mut lone = cube();
    lone.triangles.truncate(1);
    let tried = repaired(&lone).report.tried;
    assert_eq!(tried.first(), Some(&"as-drawn"));
    assert!(tried.iter().all(|name| tried.iter().filter(|other| *other == name).count() == 1), "{tried:?}");
}
