//! Set operations on solids, from bytes to bytes: exact volumes, and what is refused.

use crate::oracle::{RawSoup, judge_welded};
use crate::raw_files::encode;
use crate::solids::{cube, cuboid, tetrahedron};
use SetOperation::{Difference, Intersection, Union};
use meshmend::budget::Budget;
use meshmend::formats::{self, Encoding, Format, ReadOptions};
use meshmend::mesh::{Color, Soup};
use meshmend::par;
use meshmend::pipeline::{
    Answer, BooleanRefusal, ChangeKind, Contact, Failure, Fidelity, NotCombined, NotSolid, Operation,
    Options, Outcome, PictureChoices, Refusal, Require, SetOperation, Units, run,
};

fn try_files(files: &[Vec<u8>], options: &Options) -> Result<Answer, Failure> {
    let file_sizes = files.iter().map(|file| file.len() as u64).collect();
    let options = Options { file_sizes, ..options.clone() };
    run(Operation::Boolean, files.concat(), &options, &Budget::unlimited())
}

fn answer(set_operation: SetOperation, meshes: &[RawSoup], encoding: Encoding) -> Answer {
    let files: Vec<_> = meshes.iter().map(|mesh| encode(mesh, encoding)).collect();
    try_files(&files, &Options { set_operation, ..Options::default() }).unwrap()
}

/// The returned mesh, which must be certified, and be valid in the second opinion.
fn certified(answer: &Answer) -> (Soup, RawSoup) {
    assert_eq!(answer.report.outcome, Some(Outcome::Combined), "{:?}", answer.report.refusal);
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    let output = answer.output.as_ref().unwrap();
    let bytes = output.bytes.as_ref().unwrap();
    let soup = formats::read(bytes, output.encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    let raw = RawSoup {
        positions: soup.positions.iter().map(glam::DVec3::to_array).collect(),
        triangles: soup.triangles.clone(),
    };
    assert!(judge_welded(&raw).is_valid());
    (soup, raw)
}

fn volume_of(mesh: &RawSoup) -> f64 {
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    mesh.triangles.iter().map(six).sum::<f64>() / 6.0
}

/// Volume and number of shells of what meshes become; the volume is exact on a grid.
fn made(set_operation: SetOperation, meshes: &[RawSoup]) -> (f64, usize) {
    let answer = answer(set_operation, meshes, Encoding::Obj);
    let (_, raw) = certified(&answer);
    (volume_of(&raw), answer.report.certificate.unwrap().shells.len())
}

fn refused(set_operation: SetOperation, meshes: &[RawSoup]) -> NotCombined {
    let answer = answer(set_operation, meshes, Encoding::Obj);
    assert_eq!((answer.report.outcome, answer.output), (Some(Outcome::Refused), None));
    match answer.report.refusal {
        Some(Refusal::Boolean { reason: BooleanRefusal { reason, operation } }) => {
            assert_eq!(operation, set_operation);
            reason
        }
        other => panic!("{other:?}"),
    }
}

fn block(size: f64, at: [f64; 3]) -> RawSoup {
    cuboid([size; 3]).moved(at)
}

#[test]
fn cubes_that_overlap() {
    let two = [block(2.0, [0.0; 3]), block(2.0, [1.0, 0.75, 0.5])];
    let both = 1.0 * 1.25 * 1.5;
    assert_eq!(made(Union, &two), (16.0 - both, 1));
    assert_eq!(made(Intersection, &two), (both, 1));
    assert_eq!(made(Difference, &two), (8.0 - both, 1));
    let swapped = [two[1].clone(), two[0].clone()];
    assert_eq!(made(Difference, &swapped), (8.0 - both, 1));
}

#[test]
fn cubes_with_faces_in_common_planes() {
    let two = [block(2.0, [0.0; 3]), block(1.0, [0.0; 3])];
    assert_eq!(made(Union, &two), (8.0, 1));
    assert_eq!(made(Intersection, &two), (1.0, 1));
    assert_eq!(made(Difference, &two), (7.0, 1));
    // A bar through it, flush with both ends.
    let bar = cuboid([1.0, 1.0, 2.0]).moved([0.5, 0.5, 0.0]);
    assert_eq!(made(Difference, &[two[0].clone(), bar.clone()]), (6.0, 1));
    assert_eq!(made(Union, &[two[0].clone(), bar]), (8.0, 1));
}

#[test]
fn cubes_that_touch_in_a_face() {
    let two = [cube(), cube().moved([1.0, 0.0, 0.0])];
    assert_eq!(made(Union, &two), (2.0, 1));
    assert_eq!(made(Difference, &two), (1.0, 1));
    assert_eq!(refused(Intersection, &two), NotCombined::Empty);
}

#[test]
fn cubes_that_touch_in_an_edge_or_a_vertex_are_parted_or_joined() {
    for at in [[1.0, 1.0, 0.0], [1.0; 3]] {
        let two = [cube(), cube().moved(at)];
        assert_eq!(made(Difference, &two), (1.0, 1));
        assert_eq!(refused(Intersection, &two), NotCombined::Empty);
        let (volume, shells) = made(Union, &two);
        assert!((volume - 2.0).abs() < 1e-4 && shells == 2, "{at:?} {volume} {shells}");
        let files: Vec<_> = two.iter().map(|mesh| encode(mesh, Encoding::Obj)).collect();
        let joined = try_files(&files, &Options { contact: Contact::Join, ..Options::default() }).unwrap();
        certified(&joined);
        assert_eq!(joined.report.certificate.unwrap().shells.len(), 1, "{at:?}");
        assert_eq!(joined.report.fidelity.unwrap().word, Fidelity::Faithful, "{at:?}: a neck was made");
    }
}

#[test]
fn a_wide_neck_and_a_volume_that_rounding_multiplies_are_told() {
    let files = [cube(), cube().moved([1.0; 3])].map(|mesh| encode(&mesh, Encoding::Obj));
    let mut options = Options { contact: Contact::Join, ..Options::default() };
    options.wrap.wall = Some(0.6);
    let joined = try_files(&files, &options).unwrap();
    certified(&joined);
    let changes = joined.report.fidelity.unwrap().changes;
    assert!(changes.iter().any(|change| change.kind == ChangeKind::Invented), "{changes:?}");

    // Cubes that share one and a half steps of the lattice.
    let thin = 1.5 * 2f64.powi(-24);
    let sheet = answer(Intersection, &[cube(), cube().moved([1.0 - thin, 0.0, 0.0])], Encoding::Obj);
    certified(&sheet);
    let changes = sheet.report.fidelity.unwrap().changes;
    assert!(changes.iter().all(|change| change.kind == ChangeKind::Volume), "{changes:?}");
    assert_eq!(changes.len(), 1);
}

#[test]
fn a_cube_in_another_leaves_a_cavity() {
    let two = [block(3.0, [0.0; 3]), block(1.0, [1.0; 3])];
    assert_eq!(made(Union, &two), (27.0, 1));
    assert_eq!(made(Intersection, &two), (1.0, 1));
    assert_eq!(made(Difference, &two), (26.0, 2));
    assert_eq!(refused(Difference, &[two[1].clone(), two[0].clone()]), NotCombined::Empty);
}

#[test]
fn a_cavity_that_touches_the_surface_from_inside_stays_a_cavity() {
    // A pyramid whose tip is in the top face: nothing may turn it around, as a repair would.
    let pyramid = tetrahedron().map(|[x, y, z]| [1.0 + x, 1.0 + y, 1.0 + z]);
    let hollow = [cuboid([4.0, 4.0, 2.0]), pyramid];
    let (volume, _) = made(Difference, &hollow);
    assert!((volume - (32.0 - 1.0 / 6.0)).abs() < 1e-4, "{volume}");
}

#[test]
fn cavities_of_the_meshes_are_kept() {
    let hollow = block(3.0, [0.0; 3]).with(&block(1.0, [1.0; 3]).inside_out());
    let apart = block(1.0, [5.0; 3]);
    assert_eq!(made(Union, &[hollow.clone(), apart]), (27.0, 3));
    let island = block(0.5, [1.25; 3]);
    assert_eq!(made(Union, &[hollow.clone(), island.clone()]), (26.125, 3));
    assert_eq!(refused(Intersection, &[hollow.clone(), island]), NotCombined::Empty);
    let plug = block(1.0, [1.0; 3]);
    assert_eq!(made(Union, &[hollow.clone(), plug]), (27.0, 1));
    // A bar that comes through the wall into the cavity.
    let bar = cuboid([0.5, 0.5, 2.0]).moved([1.25, 1.25, 0.0]);
    assert_eq!(made(Difference, &[hollow, bar]), (26.0 - 0.25, 1));
}

#[test]
fn equal_meshes_and_meshes_that_are_apart() {
    let equal = [cube(), cube()];
    assert_eq!(made(Union, &equal), (1.0, 1));
    assert_eq!(made(Intersection, &equal), (1.0, 1));
    assert_eq!(refused(Difference, &equal), NotCombined::Empty);
    let apart = [cube(), cube().moved([5.0; 3])];
    assert_eq!(made(Union, &apart), (2.0, 2));
    assert_eq!(made(Difference, &apart), (1.0, 1));
    assert_eq!(refused(Intersection, &apart), NotCombined::Empty);
}

#[test]
fn three_meshes() {
    let three = [block(2.0, [0.0; 3]), block(2.0, [1.0, 0.0, 0.0]), block(2.0, [1.0; 3])];
    assert_eq!(made(Union, &three), (8.0 + 4.0 + 6.0, 1));
    assert_eq!(made(Intersection, &three), (1.0, 1));
    assert_eq!(made(Difference, &three), (4.0, 1));
}

#[test]
fn a_mesh_that_overlaps_itself_counts_as_what_it_covers() {
    let crossing = block(2.0, [0.0; 3]).with(&block(2.0, [1.0, 0.0, 0.0]));
    assert_eq!(made(Difference, &[crossing, block(1.0, [1.0, 0.0, 0.0])]), (12.0 - 1.0, 1));
}

#[test]
fn rotated_cubes_have_volumes_that_add_up() {
    let turned = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        block(2.0, [-1.0; 3])
            .map(|[x, y, z]| [x * cos - y * sin, x * sin + y * cos, z])
            .map(|[x, y, z]| [x, y * cos - z * sin, y * sin + z * cos])
            .moved([0.3, 0.1, 0.2])
    };
    for angle in [0.1, 0.5, std::f64::consts::FRAC_PI_4, 1.3] {
        for encoding in [Encoding::Obj, Encoding::StlBinary] {
            let two = [block(2.0, [-1.0; 3]), turned(angle)];
            let volume = |operation| volume_of(&certified(&answer(operation, &two, encoding)).1);
            let (either, both, first) = (volume(Union), volume(Intersection), volume(Difference));
            assert!((first + both - 8.0).abs() < 1e-5, "{angle} {first} {both}");
            assert!((either + both - 16.0).abs() < 1e-5, "{angle} {either} {both}");
            assert!(both > 4.0 && both < 8.0, "{angle} {both}");
        }
    }
}

#[test]
fn what_is_no_solid_is_refused_by_its_number() {
    let mut open = cube().moved([0.5; 3]);
    open.triangles.truncate(10);
    let told = refused(Union, &[cube(), open.clone()]);
    assert!(
        matches!(told, NotCombined::NotSolid { input: 1, why: NotSolid::Open { edges } } if edges >= 4),
        "{told:?}"
    );
    let told = refused(Difference, &[open, cube()]);
    assert!(matches!(told, NotCombined::NotSolid { input: 0, why: NotSolid::Open { .. } }), "{told:?}");
    let partly = cube().with(&cube().moved([3.0; 3]).inside_out());
    let why = NotSolid::InsideOut;
    assert_eq!(refused(Union, &[cube(), cube(), partly]), NotCombined::NotSolid { input: 2, why });
}

#[test]
fn triangles_that_stay_keep_their_bits_and_the_result_is_exact_or_rounded() {
    let two = [block(2.0, [0.0; 3]), block(2.0, [1.0, 0.75, 0.5])];
    let made = answer(Union, &two, Encoding::StlBinary).report;
    assert_eq!(made.fidelity.unwrap().word, Fidelity::Exact);
    assert_eq!(made.identical_triangle_share, Some(0.5));
    assert_eq!((made.actions[0].step, made.actions[0].move_max), ("union", 0.0));
    assert_eq!((made.further_inputs.len(), made.further_inputs[0].facts.bytes), (1, 84 + 12 * 50));
    let third = block(1.0, [0.0; 3]).map(|[x, y, z]| [x / 3.0 + y / 7.0, y + z / 11.0, z + x / 13.0]);
    let rounded = answer(Difference, &[two[1].clone(), third.moved([0.9, 0.7, 0.4])], Encoding::Obj).report;
    assert_eq!(rounded.fidelity.unwrap().word, Fidelity::Faithful);
    let files = two.map(|mesh| encode(&mesh, Encoding::Off));
    let faithful = Options { require: Some(Require::Faithful), ..Options::default() };
    assert_eq!(try_files(&files, &faithful).unwrap().report.outcome, Some(Outcome::Combined));
}

#[test]
fn meshes_may_have_different_formats_and_the_first_gives_that_of_the_result() {
    let two = [block(2.0, [0.0; 3]), block(1.0, [0.5, 0.5, 1.5])];
    for (first, second) in [(Encoding::StlBinary, Encoding::Obj), (Encoding::Off, Encoding::PlyAscii)] {
        let files = [encode(&two[0], first), encode(&two[1], second)];
        let answer = try_files(&files, &Options::default()).unwrap();
        assert_eq!(answer.output.as_ref().unwrap().encoding, first);
        assert_eq!(volume_of(&certified(&answer).1), 8.5);
    }
    // Inches in, millimetres out, as STL says no unit.
    let files = [Encoding::Obj, Encoding::Off].map(|encoding| encode(&cube(), encoding));
    let options =
        Options { units: Some(Units::Inch), output_format: Some(Format::Stl), ..Options::default() };
    let (_, raw) = certified(&try_files(&files, &options).unwrap());
    assert!((volume_of(&raw) - 25.4f64.powi(3)).abs() < 0.01);
}

#[test]
fn faces_have_the_colour_of_the_mesh_that_they_come_from() {
    let off = |mesh: &RawSoup, color: &str| {
        let mut text = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.triangles.len());
        for [x, y, z] in &mesh.positions {
            text.push_str(&format!("{x} {y} {z}\n"));
        }
        for [a, b, c] in &mesh.triangles {
            text.push_str(&format!("3 {a} {b} {c} {color}\n"));
        }
        text.into_bytes()
    };
    let files = [off(&block(4.0, [0.0; 3]), "255 0 0"), off(&block(2.0, [1.0, 1.0, 3.0]), "0 0 255")];
    let options = Options { set_operation: Difference, ..Options::default() };
    let (soup, _) = certified(&try_files(&files, &options).unwrap());
    let colors: Vec<[u8; 3]> = soup
        .face_colors
        .iter()
        .map(|color| match color {
            Some(Color::Bytes(rgb, None)) => *rgb,
            other => panic!("{other:?}"),
        })
        .collect();
    for (t, color) in colors.iter().enumerate() {
        // The walls and the floor of the pocket come from the second.
        let is_in_pocket = soup
            .corners(t as u32)
            .iter()
            .all(|p| (1.0..=3.0).contains(&p.x) && (1.0..=3.0).contains(&p.y) && (3.0..=4.0).contains(&p.z));
        assert_eq!(*color, if is_in_pocket { [0, 0, 255] } else { [255, 0, 0] }, "{t}");
    }
    assert!(colors.contains(&[0, 0, 255]));
}

#[test]
fn as_many_meshes_as_the_operation_takes_and_errors_name_the_mesh() {
    let file = encode(&cube(), Encoding::Off);
    let count = |count: usize| try_files(&vec![file.clone(); count], &Options::default());
    assert_eq!(count(1), Err(Failure::MeshCount { operation: Operation::Boolean, count: 1 }));
    assert_eq!(count(33), Err(Failure::MeshCount { operation: Operation::Boolean, count: 33 }));
    assert_eq!(count(32).unwrap().report.outcome, Some(Outcome::Combined));
    let file_sizes = vec![file.len() as u64; 2];
    let two = [file.clone(), file.clone()].concat();
    let options = Options { file_sizes, ..Options::default() };
    let failure = run(Operation::Repair, &two, &options, &Budget::unlimited()).unwrap_err();
    assert_eq!(failure.to_string(), "repair takes one mesh, not 2");
    let failure = try_files(&[file, b"OFF\n4 4 6\n0 0 zero\n".to_vec()], &Options::default()).unwrap_err();
    assert!(
        failure.to_string().starts_with("mesh 2: ") && failure.to_string().contains("line 3"),
        "{failure}"
    );
}

#[test]
fn the_same_bytes_with_1_2_and_8_threads() {
    let two = [block(2.0, [0.0; 3]), tetrahedron().scaled(3.0).moved([0.1, 0.3, 0.7])];
    let bytes = [1, 2, 8].map(|threads| {
        par::with_threads(threads, || answer(Difference, &two, Encoding::StlBinary).output.unwrap().bytes)
    });
    assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2]);
}

/// Width and pixels of the picture of a run on these meshes.
fn picture_of(meshes: &[RawSoup]) -> (u32, Vec<[u8; 3]>) {
    let files: Vec<_> = meshes.iter().map(|mesh| encode(mesh, Encoding::Obj)).collect();
    let options = Options { picture: Some(PictureChoices::default()), ..Options::default() };
    let bytes = try_files(&files, &options).unwrap().picture.expect("a picture");
    let mut read = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut pixels = vec![0; read.output_buffer_size().unwrap()];
    read.next_frame(&mut pixels).unwrap();
    (read.info().width, pixels.chunks(3).map(|p| [p[0], p[1], p[2]]).collect())
}

#[test]
fn a_picture_shows_all_solids_with_their_defects_and_what_became_of_them() {
    const RIM: [u8; 3] = [242, 115, 28];
    let moved = |mesh: RawSoup, by: f64| RawSoup {
        positions: mesh.positions.iter().map(|p| p.map(|x| x + by)).collect(),
        ..mesh
    };
    let (width, pixels) = picture_of(&[cube(), moved(cube(), 0.5)]);
    assert_eq!(width, 960, "the files, and the result");
    assert!(pixels.iter().any(|&[r, g, b]| g > r.saturating_add(50) && g > b), "what is new");
    assert!(!pixels.contains(&RIM));
    let mut open = moved(cube(), 2.0);
    open.triangles.pop();
    let (width, pixels) = picture_of(&[cube(), open]);
    assert_eq!(width, 480, "there is no result");
    assert!(pixels.contains(&RIM), "the hole in the second file");
}
