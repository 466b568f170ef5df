//! Cutting and stitching from bytes to bytes: the textbook cases, and what is told about them.

use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Format, ReadOptions, read};
use meshmend::mesh::{CutMethod, EdgeGroups, Soup, singular_vertices, twins};
use meshmend::pipeline::{
    Answer, CutStitchChoices, Fidelity, JoinedEdges, Operation, Options, Outcome, Refusal, Require,
    Stitching, run,
};
use std::fmt::Write as _;

type Points = Vec<[f64; 3]>;
type Triangles = Vec<[u32; 3]>;

fn obj((points, triangles): &(Points, Triangles)) -> String {
    let mut text = String::new();
    for [x, y, z] in points {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [a, b, c] in triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    text
}

/// The unit cube at these coordinates: vertex `4 z + 2 y + x`.
fn cube(at: [f64; 3]) -> (Points, Triangles) {
    let corner = |i: u32| [0, 1, 2].map(|k| at[k] + f64::from(i >> k & 1));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

fn both(first: (Points, Triangles), second: (Points, Triangles)) -> (Points, Triangles) {
    let shift = first.0.len() as u32;
    let moved = second.1.into_iter().map(|t| t.map(|v| v + shift));
    ([first.0, second.0].concat(), first.1.into_iter().chain(moved).collect())
}

/// Half-planes that meet in the z axis, each of one quad.
fn book(pages: u32) -> (Points, Triangles) {
    let leaf = |i: u32| {
        let angle = f64::from(i) * std::f64::consts::TAU / f64::from(pages);
        let (y, x) = angle.sin_cos();
        [[x, y, 0.0], [x, y, 1.0]]
    };
    let points = [[[0.0; 3], [0.0, 0.0, 1.0]]].into_iter().chain((0..pages).map(leaf)).flatten().collect();
    let quad = |i: u32| [[0, 2 * i + 2, 2 * i + 3], [0, 2 * i + 3, 1]];
    (points, (0..pages).flat_map(quad).collect())
}

/// Tetrahedra that share their apex and nothing else.
fn cones(count: u32) -> (Points, Triangles) {
    let mut mesh = (vec![[0.0; 3]], Vec::new());
    for i in 0..count {
        let (z, first) = (f64::from(i + 1), mesh.0.len() as u32);
        mesh.0.extend([[1.0, z, 0.0], [1.0, z, 0.4], [1.3, z, 0.2]]);
        let [a, b, c] = [first, first + 1, first + 2];
        mesh.1.extend([[0, b, a], [0, c, b], [0, a, c], [a, b, c]]);
    }
    mesh
}

fn cut_stitch(bytes: &[u8], choices: CutStitchChoices) -> Answer {
    let options = Options { cut_stitch: choices, ..Options::default() };
    run(Operation::CutStitch, bytes, &options, &Budget::unlimited()).unwrap()
}

fn stitching(stitching: Stitching) -> CutStitchChoices {
    CutStitchChoices { stitching, ..CutStitchChoices::default() }
}

fn count(answer: &Answer, step: &str, name: &str) -> u64 {
    let action = answer.report.actions.iter().find(|action| action.step == step).unwrap();
    action.changes.iter().find(|(n, _)| *n == name).unwrap().1
}

/// The result as its indices say, without welding.
fn result(answer: &Answer) -> Soup {
    let bytes = answer.output.as_ref().unwrap().bytes.as_ref().unwrap();
    read(bytes, Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

fn assert_manifold(soup: &Soup) {
    let budget = Budget::unlimited();
    let groups = EdgeGroups::build(&soup.triangles, soup.positions.len(), &budget).unwrap();
    assert!(groups.iter().all(|group| group.len() <= 2));
    let twins = twins(&groups, soup.triangles.len(), &budget).unwrap();
    assert_eq!(singular_vertices(&soup.triangles, soup.positions.len(), &twins, &budget).unwrap(), [0u32; 0]);
}

#[test]
fn two_cubes_that_share_an_edge_are_parted_and_the_certificate_says_what_a_welding_reader_sees() {
    let mesh = both(cube([0.0; 3]), cube([1.0, 1.0, 0.0]));
    let answer = cut_stitch(obj(&mesh).as_bytes(), CutStitchChoices::default());
    assert_eq!(answer.report.outcome, Some(Outcome::CutStitched));
    assert_eq!((count(&answer, "cut", "singular_edges"), count(&answer, "cut", "vertices_copied")), (1, 2));
    let soup = result(&answer);
    assert_eq!((soup.positions.len(), soup.triangles.len()), (16, 24));
    assert_manifold(&soup);
    assert!(
        !answer.report.certificate.unwrap().is_printable(),
        "its two copies of the edge are at one place"
    );
}

#[test]
fn two_cubes_that_share_a_vertex_are_parted_there() {
    let mesh = both(cube([0.0; 3]), cube([1.0; 3]));
    let answer = cut_stitch(obj(&mesh).as_bytes(), CutStitchChoices::default());
    assert_eq!(count(&answer, "cut", "singular_edges"), 0);
    assert_eq!(count(&answer, "cut", "isolated_singular_vertices"), 1);
    assert_eq!(result(&answer).positions.len(), 16);
}

#[test]
fn a_book_falls_into_its_pages_and_snapping_binds_pairs_of_them() {
    for pages in [3, 4, 5] {
        let bytes = obj(&book(pages));
        let cut = cut_stitch(bytes.as_bytes(), stitching(Stitching::None));
        assert_eq!(result(&cut).positions.len() as u32, 4 * pages);
        // All pages run out from the spine the same way; one that is turned changes nothing.
        let mut turned = book(pages);
        for t in &mut turned.1[..2] {
            t.swap(1, 2);
        }
        for book in [bytes, obj(&turned)] {
            let snapped = cut_stitch(book.as_bytes(), stitching(Stitching::Snap));
            let pairs = pages / 2;
            assert_eq!(count(&snapped, "snap", "edges_joined"), u64::from(pairs), "{pages} pages");
            assert_eq!(result(&snapped).positions.len() as u32, 4 * pages - 2 * pairs);
            assert_manifold(&result(&snapped));
        }
    }
}

#[test]
fn a_fan_of_cones_gets_an_apex_each() {
    let answer = cut_stitch(obj(&cones(6)).as_bytes(), CutStitchChoices::default());
    assert_eq!(count(&answer, "cut", "vertices_copied"), 5);
    assert_manifold(&result(&answer));
}

#[test]
fn a_moebius_band_is_cut_across_once_and_what_hangs_on_its_rim_comes_off() {
    // Ten vertices around in two rows; the seam joins the rows crosswise. Two triangles hang on one edge of the rim.
    let mut points: Points = Vec::new();
    for i in 0..10u32 {
        let turn = f64::from(i) * std::f64::consts::TAU / 10.0;
        for side in [-0.3, 0.3] {
            let (up, out) = (turn / 2.0).sin_cos();
            let r = 1.0 + side * out;
            points.push([r * turn.cos(), r * turn.sin(), side * up]);
        }
    }
    points.extend([[3.0, 0.0, 0.5], [3.0, 1.0, 0.0]]);
    let v = |i: u32, side: u32| if i == 10 { 1 - side } else { 2 * i + side };
    let mut triangles: Triangles = (0..10)
        .flat_map(|i| [[v(i, 0), v(i + 1, 0), v(i + 1, 1)], [v(i, 0), v(i + 1, 1), v(i, 1)]])
        .collect();
    triangles.extend([[v(2, 0), v(3, 0), 20], [v(3, 0), v(2, 0), 21]]);
    let answer = cut_stitch(obj(&(points, triangles)).as_bytes(), stitching(Stitching::None));
    assert_eq!(count(&answer, "cut", "edges_in_conflict"), 1);
    assert_eq!(count(&answer, "cut", "singular_edges"), 1);
    let soup = result(&answer);
    assert_manifold(&soup);
    let groups = EdgeGroups::build(&soup.triangles, soup.positions.len(), &Budget::unlimited()).unwrap();
    let is_coherent = |group: &[u32]| {
        let ends = |h: u32| meshmend::mesh::edge_of(&soup.triangles, h);
        group.len() == 1 || ends(group[0])[0] == ends(group[1])[1]
    };
    assert!(groups.iter().all(is_coherent));
}

#[test]
fn a_valid_solid_comes_back_as_its_bytes_and_an_open_one_too() {
    let solid = obj(&cube([0.0; 3]));
    let mut open = cube([0.0; 3]);
    open.1.truncate(10);
    for (text, outcome) in [(solid, Outcome::Identical), (obj(&open), Outcome::CutStitched)] {
        for stitching in [Stitching::None, Stitching::Pinch, Stitching::Snap] {
            let choices = CutStitchChoices { stitching, ..CutStitchChoices::default() };
            let answer = cut_stitch(text.as_bytes(), choices);
            assert_eq!((answer.report.outcome, answer.output.unwrap().bytes), (Some(outcome), None));
        }
    }
}

#[test]
fn a_valid_solid_of_quads_with_a_spare_vertex_comes_back_as_its_bytes() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 9 9 9\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let answer = cut_stitch(text.as_bytes(), CutStitchChoices::default());
    assert_eq!((answer.report.outcome, answer.output.unwrap().bytes), (Some(Outcome::Identical), None));
}

#[test]
fn chosen_edges_are_found_by_any_of_the_vertices_at_their_ends() {
    // A cube whose lid has vertices of its own, 8 to 11, and an unused copy of one of them in front of all.
    let mut mesh = cube([0.0; 3]);
    mesh.0.extend((4..8).map(|i| mesh.0[i]).collect::<Vec<_>>());
    for t in &mut mesh.1[2..4] {
        *t = t.map(|v| v + 4);
    }
    mesh.0.insert(0, [0.0, 0.0, 1.0]);
    for v in mesh.1.as_flattened_mut() {
        *v += 1;
    }
    let chosen = vec![[9, 10], [10, 12], [8, 7], [11, 5]];
    let choices = CutStitchChoices { chosen, ..stitching(Stitching::None) };
    let answer = cut_stitch(obj(&mesh).as_bytes(), choices);
    assert_eq!(count(&answer, "cut", "chosen_edges"), 4);
    assert_eq!(result(&answer).positions.len(), 12);
}

#[test]
fn the_local_and_the_global_cut_give_the_same_bytes_and_say_what_ran() {
    let bytes = obj(&both(book(5), cones(4)));
    let [local, global] = [CutMethod::Local, CutMethod::Global].map(|method| {
        let choices = CutStitchChoices { method: Some(method), ..CutStitchChoices::default() };
        let answer = cut_stitch(bytes.as_bytes(), choices);
        let reason = answer.report.actions.iter().find(|a| a.step == "cut").unwrap().reason.clone();
        (answer.output.unwrap().bytes, reason)
    });
    assert_eq!(local.0, global.0);
    assert!(local.1.starts_with("cut locally, as asked"), "{}", local.1);
    assert!(global.1.starts_with("cut globally, as asked"), "{}", global.1);
}

#[test]
fn chosen_edges_of_the_file_are_cut_and_stay_so() {
    // Around the top of a cube: its lid comes off. What is no edge is not cut.
    let chosen = vec![[4, 5], [5, 7], [7, 6], [6, 4], [0, 7]];
    for stitching in [Stitching::None, Stitching::Pinch, Stitching::Snap] {
        let choices = CutStitchChoices { chosen: chosen.clone(), stitching, ..CutStitchChoices::default() };
        let answer = cut_stitch(obj(&cube([0.0; 3])).as_bytes(), choices);
        assert_eq!(count(&answer, "cut", "chosen_edges"), 4);
        assert_eq!(result(&answer).positions.len(), 12, "{stitching:?}");
    }
}

#[test]
fn snapping_closes_a_gap_of_a_stated_width_and_says_how_far_vertices_moved() {
    // A cube whose lid floats a little above it, with vertices of its own.
    let mut mesh = cube([0.0; 3]);
    for i in 4..8 {
        let [x, y, z] = mesh.0[i];
        mesh.0.push([x, y, z + 0.001]);
    }
    for t in &mut mesh.1[2..4] {
        *t = t.map(|v| v + 4);
    }
    let bytes = obj(&mesh);
    let choices = |epsilon| CutStitchChoices { epsilon, ..stitching(Stitching::Snap) };
    let answer = cut_stitch(bytes.as_bytes(), choices(Some(0.002)));
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    assert_eq!(count(&answer, "snap", "vertices_moved"), 4);
    let snap = answer.report.actions.iter().find(|action| action.step == "snap").unwrap();
    assert!((snap.move_max - 0.001).abs() < 1e-12);
    assert_eq!(result(&answer).positions.len(), 8);
    let left = cut_stitch(bytes.as_bytes(), choices(Some(0.0005)));
    assert_eq!(left.output.unwrap().bytes, None, "nothing is near enough, so nothing changes");
}

#[test]
fn a_vertex_inside_a_boundary_edge_is_inserted_before_snapping() {
    // One side of a crack has a vertex that the other side lacks.
    let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [1.0, -2.0], [1.0, 0.0], [0.0, 0.0], [2.0, 0.0]];
    let points = points.map(|[x, y]| [x, y, 0.0]).to_vec();
    let triangles = vec![[0, 1, 2], [5, 3, 4], [4, 3, 6]];
    let answer = cut_stitch(obj(&(points, triangles)).as_bytes(), stitching(Stitching::Snap));
    assert_eq!(count(&answer, "split-t-vertices", "triangles_split"), 1);
    let soup = result(&answer);
    assert_eq!((soup.positions.len(), soup.triangles.len()), (5, 4));
    assert_manifold(&soup);
}

#[test]
fn a_polygon_that_passes_a_vertex_twice_is_split_or_dropped() {
    use meshmend::repair::polygons::DegenerateFaces;
    let text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 -2 0\nv -2 -2 0\nf 1 2 3 1 4 5\nf 1 3 5\n";
    for (degenerate, left) in [(DegenerateFaces::Split, 3), (DegenerateFaces::Drop, 1)] {
        let answer =
            cut_stitch(text.as_bytes(), CutStitchChoices { degenerate, ..CutStitchChoices::default() });
        assert_eq!(result(&answer).triangles.len(), left);
    }
}

#[test]
fn a_polygon_that_runs_around_a_hole_is_split_and_does_not_cover_the_hole() {
    let washer =
        "v 0 0 0\nv 6 0 0\nv 6 6 0\nv 0 6 0\nv 2 2 0\nv 4 2 0\nv 4 4 0\nv 2 4 0\nf 1 2 3 4 1 5 8 7 6 5\n";
    // Three triangles at one edge, far away: what there is to cut.
    let fan = "v 20 0 0\nv 20 0 9\nv 29 0 0\nv 20 9 0\nv 11 0 0\nf 9 10 11\nf 9 10 12\nf 9 10 13\n";
    let answer = cut_stitch(format!("{washer}{fan}").as_bytes(), CutStitchChoices::default());
    let soup = result(&answer);
    assert_eq!(soup.triangles.len(), 8 + 3);
    let area_of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| soup.positions[v as usize]);
        (b - a).cross(c - a).length() / 2.0
    };
    let is_washer = |t: &&[u32; 3]| t.iter().all(|&v| soup.positions[v as usize].x <= 6.0);
    assert_eq!(soup.triangles.iter().filter(is_washer).map(area_of).sum::<f64>(), 32.0);
}

#[test]
fn nothing_is_returned_where_a_solid_is_demanded_and_there_is_none() {
    let options =
        Options { require: Some(Require::Printable), output_format: Some(Format::Stl), ..Options::default() };
    let bytes = obj(&book(3));
    let answer = run(Operation::CutStitch, bytes.as_bytes(), &options, &Budget::unlimited()).unwrap();
    assert!(matches!(answer.report.refusal, Some(Refusal::NotRepairable { witness: Some(_) })));
    assert_eq!(answer.output, None);
}

#[test]
fn a_file_that_is_taken_as_indexed_keeps_rims_apart_and_a_cut_survives_a_second_run() {
    let sheet = |z: f64| {
        (vec![[0.0, 0.0, z], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, z]], vec![[0, 1, 2], [0, 2, 3]])
    };
    let rims = obj(&both(sheet(0.0), sheet(0.5)));
    let indexed =
        |stitching| CutStitchChoices { keeps_copies: true, stitching, ..CutStitchChoices::default() };
    let apart = cut_stitch(rims.as_bytes(), indexed(Stitching::None));
    assert_eq!(apart.output.unwrap().bytes, None, "two sheets stay two, so nothing changes");
    let welded = cut_stitch(rims.as_bytes(), stitching(Stitching::None));
    assert_eq!(result(&welded).positions.len(), 6);

    let chosen = vec![[4, 5], [5, 7], [7, 6], [6, 4]];
    for keeps_copies in [false, true] {
        let choices =
            CutStitchChoices { keeps_copies, chosen: chosen.clone(), ..CutStitchChoices::default() };
        let cut = cut_stitch(obj(&cube([0.0; 3])).as_bytes(), choices).output.unwrap().bytes.unwrap();
        for stitching in [Stitching::None, Stitching::Pinch] {
            let again = cut_stitch(&cut, indexed(stitching));
            assert_eq!(again.output.unwrap().bytes, None, "the lid stays off: {stitching:?}");
        }
        let undone = cut_stitch(&cut, stitching(Stitching::Pinch));
        assert_eq!(result(&undone).positions.len(), 8);
    }
}

#[test]
fn edges_of_copies_are_chosen_one_by_one_where_a_file_is_taken_as_indexed() {
    // Two cubes at one place, each with vertices of its own.
    let mesh = both(cube([0.0; 3]), cube([0.0; 3]));
    let chosen = vec![[12, 13], [13, 15], [15, 14], [14, 12]];
    let choices = CutStitchChoices {
        keeps_copies: true,
        chosen,
        stitching: Stitching::None,
        ..CutStitchChoices::default()
    };
    let answer = cut_stitch(obj(&mesh).as_bytes(), choices);
    assert_eq!(count(&answer, "cut", "chosen_edges"), 4);
    assert_eq!(result(&answer).positions.len(), 20, "the lid of the second comes off");
}

/// A unit square, and a second one that stands on its diagonal.
const SQUARES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nv 0.5 0.5 -1\nf 1 2 3 4\nf 1 5 3 6\n";

fn faces_of(soup: &Soup) -> Vec<Vec<u32>> {
    soup.faces().map(|(_, corners)| corners.to_vec()).collect()
}

#[test]
fn a_diagonal_is_no_edge_so_that_two_squares_that_share_two_vertices_come_apart_at_these() {
    for method in [None, Some(CutMethod::Local), Some(CutMethod::Global)] {
        let answer =
            cut_stitch(SQUARES.as_bytes(), CutStitchChoices { method, ..CutStitchChoices::default() });
        let cut = ["singular_edges", "isolated_singular_vertices", "vertices_copied"];
        assert_eq!(cut.map(|name| count(&answer, "cut", name)), [0, 2, 2]);
        let restored = ["faces", "components", "polygons", "polygons_split"];
        assert_eq!(restored.map(|name| count(&answer, "restore-polygons", name)), [2, 2, 2, 0]);
        assert_eq!(faces_of(&result(&answer)), [[0, 1, 2, 3], [6, 4, 7, 5]]);
    }
}

#[test]
fn polygons_come_back_in_every_format_that_has_them_and_stl_says_that_it_has_none() {
    for (format, encoding) in [
        (Format::Obj, Encoding::Obj),
        (Format::Off, Encoding::Off),
        (Format::Ply, Encoding::PlyBinaryLittleEndian),
    ] {
        let options = Options { output_format: Some(format), ..Options::default() };
        let answer = run(Operation::CutStitch, SQUARES.as_bytes(), &options, &Budget::unlimited()).unwrap();
        let output = answer.output.unwrap();
        assert_eq!(output.encoding, encoding);
        let soup =
            read(&output.bytes.unwrap(), encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!(faces_of(&soup), [[0, 1, 2, 3], [6, 4, 7, 5]]);
        assert_eq!(answer.report.after.unwrap().counts.faces, 2);
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
    }
    let options = Options { output_format: Some(Format::Stl), ..Options::default() };
    let answer = run(Operation::CutStitch, SQUARES.as_bytes(), &options, &Budget::unlimited()).unwrap();
    assert_eq!(count(&answer, "restore-polygons", "polygons_split"), 2);
    let action = answer.report.actions.iter().find(|action| action.step == "restore-polygons").unwrap();
    assert_eq!(action.reason, "STL holds triangles alone");
    assert_eq!(answer.report.after.unwrap().counts.faces, 4);
}

/// The unit cube of squares, from any corner.
const CUBE_OF_SQUARES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 6 7 8 5\nf 1 2 6 5\nf 7 6 2 3\nf 3 4 8 7\nf 5 8 4 1\n";

#[test]
fn a_lid_of_one_square_comes_off_and_its_edges_come_back_where_nothing_keeps_them_apart() {
    // Around the top; a diagonal of the top is no edge, and the sides wound the other way are turned.
    let turned = CUBE_OF_SQUARES.replace("f 7 6 2 3", "f 3 2 6 7");
    let chosen = vec![[4, 5], [5, 6], [6, 7], [7, 4], [5, 7], [4, 6]];
    let choices = CutStitchChoices { chosen, ..CutStitchChoices::default() };
    let answer = cut_stitch(turned.as_bytes(), choices);
    assert_eq!(count(&answer, "cut", "chosen_edges"), 4);
    assert_eq!(count(&answer, "restore-polygons", "components"), 2);
    let lidless = result(&answer);
    assert_eq!((lidless.positions.len(), lidless.polygons.faces.len()), (12, 6));
    let bytes = answer.output.unwrap().bytes.unwrap();
    let whole = cut_stitch(&bytes, CutStitchChoices { keeps_copies: true, ..stitching(Stitching::Snap) });
    let closed = result(&whole);
    assert_eq!(closed.positions.len(), 8);
    assert!(whole.report.certificate.as_ref().unwrap().is_printable());
    // Corner by corner where each face of the cube was, in its direction.
    let cube = read(CUBE_OF_SQUARES.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited())
        .unwrap();
    let places = |soup: &Soup| -> Vec<Vec<[u64; 3]>> {
        let at = |v: &u32| soup.positions[*v as usize].to_array().map(f64::to_bits);
        let from_least = |face: Vec<u32>| {
            let all: Vec<[u64; 3]> = face.iter().map(at).collect();
            (0..all.len()).map(|i| [&all[i..], &all[..i]].concat()).min().unwrap()
        };
        let mut all: Vec<_> = faces_of(soup).into_iter().map(from_least).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(places(&closed), places(&cube));
}

#[test]
fn the_edges_that_were_joined_are_listed_by_the_numbers_of_the_file() {
    // Two squares side by side with vertices of their own along x = 1.
    let text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\nf 5 6 7 8\n";
    let choices = CutStitchChoices { keeps_copies: true, ..stitching(Stitching::Snap) };
    let answer = cut_stitch(text.as_bytes(), choices);
    let snap = answer.report.actions.iter().find(|action| action.step == "snap").unwrap();
    let stitches = snap.stitches.as_ref().unwrap();
    assert_eq!(stitches.explicit, [JoinedEdges { edges: [[1, 2], [7, 4]], faces: [0, 1] }]);
    assert_eq!((stitches.explicit_total, stitches.implicit_total), (1, 0));
    assert_eq!(faces_of(&result(&answer)), [[0, 1, 2, 3], [1, 4, 5, 2]]);
    assert!(answer.report.actions.iter().all(|action| action.stitches.is_some() == (action.step == "snap")));
    // A repair takes the same steps and lists nothing.
    let repaired =
        run(Operation::Repair, text.as_bytes(), &Options::default(), &Budget::unlimited()).unwrap();
    assert!(repaired.report.actions.iter().all(|action| action.stitches.is_none()));
}

#[test]
fn a_slit_is_zipped_and_its_last_edge_is_listed_as_implicit() {
    // A sheet of four squares with one that stands on its middle line from (1, 0) to (1, 2), given as two edges.
    let mut text = String::new();
    for i in 0..9 {
        writeln!(text, "v {} {} 0", i % 3, i / 3).unwrap();
    }
    text.push_str("v 1 0.5 1\nv 1 1.5 1\n");
    text.push_str("f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\nf 2 5 10\nf 5 8 11\n");
    let answer = cut_stitch(text.as_bytes(), CutStitchChoices::default());
    assert_eq!(count(&answer, "cut", "singular_edges"), 2);
    let pinch = answer.report.actions.iter().find(|action| action.step == "pinch").unwrap();
    let stitches = pinch.stitches.as_ref().unwrap();
    let totals = [stitches.explicit_total, stitches.implicit_total];
    assert_eq!(
        totals,
        [count(&answer, "pinch", "edges_joined"), count(&answer, "pinch", "edges_joined_with_others")]
    );
    for pair in stitches.explicit.iter().chain(&stitches.implicit) {
        let [[a, b], other] = pair.edges;
        assert_eq!(other, [b, a], "copies of one edge");
    }
}

#[test]
fn a_polygon_with_a_vertex_inside_its_edge_becomes_triangles_and_no_other_does() {
    // The left square has a vertex in the middle of its right side that the right one lacks.
    let text = "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\n\
        f 1 2 7 3 4\nf 2 5 6 3\n";
    let answer = cut_stitch(text.as_bytes(), stitching(Stitching::Snap));
    assert_eq!(count(&answer, "split-t-vertices", "polygons_split"), 1);
    let action = answer.report.actions.iter().find(|action| action.step == "split-t-vertices").unwrap();
    assert!(action.reason.contains("1 polygons with vertices inside their edges"), "{}", action.reason);
    let soup = result(&answer);
    let sizes: Vec<usize> = faces_of(&soup).iter().map(Vec::len).collect();
    assert_eq!(sizes, [5, 3, 3, 3]);
}

#[test]
fn colours_and_texture_stay_with_polygons() {
    let textured = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nv 0.5 0.5 -1\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 1 5 3 6\n";
    let answer = cut_stitch(textured.as_bytes(), CutStitchChoices::default());
    let text = String::from_utf8(answer.output.unwrap().bytes.unwrap()).unwrap();
    assert!(text.ends_with("f 1/1 2/2 3/3 4/4\nf 7 5 8 6\n"), "{text}");
    let colored = "OFF\n6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 1\n0.5 0.5 -1\n4 0 1 2 3 255 0 0\n4 0 4 2 5 0 0 255\n";
    let answer = cut_stitch(colored.as_bytes(), CutStitchChoices::default());
    let text = String::from_utf8(answer.output.unwrap().bytes.unwrap()).unwrap();
    assert!(text.ends_with("4 0 1 2 3 255 0 0\n4 6 4 7 5 0 0 255\n"), "{text}");
}

#[test]
fn faces_with_the_same_vertices_in_another_order_are_no_copies_and_a_triangle_is_no_copy_of_half_a_square() {
    let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    for (faces, left) in [
        ("f 1 2 3 4\nf 3 2 1 4\n", 1),
        ("f 1 2 3 4\nf 2 3 4 1\nf 4 1 2 3\n", 1),
        ("f 1 2 3 4\nf 1 3 2 4\n", 2),
        ("f 1 2 3 4\nf 1 2 3\n", 2),
        ("f 1 2 3 4\nf 1 2 3\nf 2 3 1\n", 2),
    ] {
        let answer = cut_stitch(format!("{points}{faces}").as_bytes(), stitching(Stitching::None));
        let copies = count(&answer, "drop-duplicates", "copies_dropped");
        assert_eq!(copies, faces.lines().count() as u64 - left, "{faces}");
    }
}

#[test]
fn quads_of_which_one_is_turned_stay_where_they_are() {
    let (points, quads) = (cube([0.0; 3]).0, "5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6");
    let vertices: String = points.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    for first in ["1 3 4 2", "1 2 4 3"] {
        let answer =
            cut_stitch(format!("{vertices}f {first}\nf {quads}\n").as_bytes(), CutStitchChoices::default());
        let fidelity = answer.report.fidelity.as_ref().unwrap();
        assert_eq!(fidelity.word, Fidelity::Exact, "{first}: {fidelity:?}");
    }
}
