//! The modeller as a whole call: a file in, an edited file, its certificate and what takes it back out.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Format, ReadOptions, read};
use meshmend::geom::DVec3;
use meshmend::modeller::{self, Embedding, EventPolicy};
use meshmend::pipeline::{
    Answer, BlockerKind, EdgeName, Edit, EditKind, FaceName, ModellerChoices, ModellerRefusal,
    ModellerReport, NameFault, Operation, Options, Outcome, Refusal, Require, Units, run,
};

fn answer(bytes: &[u8], modeller: ModellerChoices, options: Options) -> Answer {
    let options = Options { modeller, ..options };
    run(Operation::Modeller, bytes, &options, &Budget::unlimited()).unwrap()
}

fn edited(bytes: &[u8], operators: Vec<Edit>) -> Answer {
    answer(bytes, ModellerChoices { operators, ..ModellerChoices::default() }, Options::default())
}

fn told(answer: &Answer) -> &ModellerReport {
    answer.report.modeller.as_ref().unwrap()
}

fn refusal(answer: &Answer) -> &ModellerRefusal {
    assert_eq!((answer.report.outcome, &answer.output), (Some(Outcome::Refused), &None));
    match &answer.report.refusal {
        Some(Refusal::Modeller { reason, .. }) => reason,
        other => panic!("{other:?}"),
    }
}

fn shift(face: FaceName, by: f64) -> Edit {
    Edit::Shift { faces: vec![(face, by)], events: EventPolicy::Refuse }
}

fn by_normal(normal: [f64; 3]) -> FaceName {
    FaceName::Normal { normal: DVec3::from_array(normal), at: DVec3::ZERO }
}

/// The corners of the box around what was returned.
fn bounds(answer: &Answer) -> [[f64; 3]; 2] {
    let output = answer.output.as_ref().unwrap();
    let bytes = output.bytes.as_ref().unwrap();
    let soup = read(bytes, output.encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    let at = |f: fn(f64, f64) -> f64, from: f64| {
        std::array::from_fn(|k| soup.positions.iter().map(|p| p[k]).fold(from, f))
    };
    [at(f64::min, f64::INFINITY), at(f64::max, f64::NEG_INFINITY)]
}

#[test]
fn without_an_operator_a_valid_file_comes_back_as_the_very_bytes() {
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::StlAscii);
    let answer = edited(&bytes, vec![]);
    assert_eq!((answer.report.outcome, &told(&answer).rounded_by), (Some(Outcome::Identical), &None));
    assert_eq!(answer.output.as_ref().unwrap().bytes, None);
    let counts = told(&answer).validity.counts;
    assert_eq!((counts.vertices, counts.edges, counts.faces), (8, 12, 6), "coplanar triangles are one face");
}

#[test]
fn a_face_moves_however_it_is_named_and_in_every_format() {
    let solid = cuboid([3.0, 2.0, 1.0]);
    let ray = FaceName::Ray { from: DVec3::new(1.0, 1.0, 9.0), direction: DVec3::new(0.0, 0.0, -2.0) };
    for encoding in [Encoding::Off, Encoding::Obj, Encoding::StlBinary, Encoding::PlyAscii] {
        let bytes = encode(&solid, encoding);
        let listed = answer(
            &bytes,
            ModellerChoices { lists_faces: true, ..ModellerChoices::default() },
            Options::default(),
        );
        let top = told(&listed).faces.iter().find(|face| face.normal == DVec3::Z).unwrap();
        assert_eq!((top.distance, top.sides, top.interior_loops), (1.0, 4, 0));
        for name in [FaceName::Id(top.face), by_normal([0.0, 0.1, 5.0]), ray] {
            let answer = edited(&bytes, vec![shift(name, 0.5)]);
            assert_eq!(answer.report.outcome, Some(Outcome::Modelled), "{encoding:?} {name:?}");
            assert!(answer.report.certificate.as_ref().unwrap().is_printable());
            assert_eq!(bounds(&answer), [[0.0; 3], [3.0, 2.0, 1.5]]);
            let step = &told(&answer).steps[0];
            assert_eq!((step.operator, &step.moved), (EditKind::Shift, &vec![(top.face, 0.5)]));
            assert!(step.validity.is_valid());
            assert_eq!(step.undo, Some((vec![(top.face, -0.5)], false)));
        }
    }
}

#[test]
fn a_step_is_taken_back_by_what_it_tells_and_by_an_undo() {
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::Off);
    let first = shift(by_normal([1.0, 0.0, 0.0]), 0.1);
    let once = edited(&bytes, vec![first.clone()]);
    let (moves, passes) = told(&once).steps[0].undo.clone().unwrap();
    assert!(!passes);
    let back = Edit::Shift {
        faces: moves.iter().map(|&(face, by)| (FaceName::Id(face), by)).collect(),
        events: EventPolicy::Refuse,
    };
    let second = shift(by_normal([0.0, 1.0, 0.0]), -0.3);
    for operators in [
        vec![first.clone(), back],
        vec![first.clone(), Edit::Undo],
        vec![first.clone(), second, Edit::Undo, Edit::Undo],
    ] {
        let answer = edited(&bytes, operators);
        assert_eq!(answer.report.outcome, Some(Outcome::Identical));
        assert_eq!(answer.output.as_ref().unwrap().bytes, None, "nothing has changed: the very bytes");
    }
    let none = edited(&bytes, vec![first, Edit::Undo, Edit::Undo]);
    assert_eq!(refusal(&none), &ModellerRefusal::NothingToUndo { operator: 2 });
    assert_eq!(told(&none).steps.len(), 2);
}

#[test]
fn what_is_in_the_way_is_told_and_the_steps_before_it_too() {
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::Off);
    let top = by_normal([0.0, 0.0, 1.0]);
    let answer = edited(&bytes, vec![shift(top, 0.5), shift(top, -1.75)]);
    let ModellerRefusal::Operator { operator: 1, limits, blocking, .. } = refusal(&answer) else {
        panic!("{:?}", answer.report.refusal)
    };
    let distance = limits[0].1;
    assert!(distance <= 0.0 && (distance + 1.5).abs() < 1e-12, "{distance}");
    assert!(blocking.iter().all(|b| b.kind == BlockerKind::EdgeVanishes && b.places.len() == 2));
    assert_eq!(told(&answer).steps.len(), 1);
    let away = FaceName::Ray { from: DVec3::splat(9.0), direction: DVec3::X };
    for (name, fault) in [
        (FaceName::Id(6), NameFault::NoFace(6)),
        (by_normal([0.0; 3]), NameFault::NoNormal),
        (away, NameFault::RayMisses),
    ] {
        let answer = edited(&bytes, vec![shift(name, 0.5)]);
        assert_eq!(refusal(&answer), &ModellerRefusal::Name { operator: Some(0), fault });
    }
}

#[test]
fn a_shift_that_names_one_face_twice_is_refused() {
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::Off);
    let top = by_normal([0.0, 0.0, 1.0]);
    let faces = vec![(top, 0.5), (top, 0.25)];
    let answer = edited(&bytes, vec![Edit::Shift { faces, events: EventPolicy::Refuse }]);
    let ModellerRefusal::Name { operator: Some(0), fault } = refusal(&answer) else {
        panic!("{:?}", answer.report.refusal)
    };
    assert!(matches!(fault, NameFault::FaceTwice(_)), "{fault:?}");
}

#[test]
fn ranges_are_open_intervals_of_one_face_or_of_several_together() {
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::Off);
    let (up, down) = (by_normal([0.0, 0.0, 1.0]), by_normal([0.0, 0.0, -1.0]));
    let ranges = vec![vec![(up, 1.0)], vec![(up, 1.0), (down, 1.0)], vec![(up, 1.0), (down, -1.0)]];
    let choices = ModellerChoices { ranges, ..ModellerChoices::default() };
    let answer = answer(&bytes, choices, Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Identical));
    let limits: Vec<_> = told(&answer).ranges.iter().map(|r| r.sides.each_ref().map(|s| s.limit)).collect();
    let near = |told: [Option<f64>; 2], inward: Option<f64>| {
        let is_near = match (told[0], inward) {
            (Some(told), Some(true_one)) => told >= true_one && (told - true_one).abs() < 1e-12,
            (told, true_one) => told == true_one,
        };
        assert!(is_near && told[1].is_none(), "{told:?} instead of {inward:?}");
    };
    near(limits[0], Some(-1.0));
    near(limits[1], Some(-0.5));
    near(limits[2], None);
}

#[test]
fn lengths_are_in_the_unit_of_the_result() {
    // A file in inches becomes an STL in millimetres, and 0.5 is half an inch.
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::Off);
    let options =
        Options { units: Some(Units::Inch), output_format: Some(Format::Stl), ..Options::default() };
    let at = FaceName::Normal { normal: DVec3::Z, at: DVec3::new(1.0, 1.0, 1.0) };
    let choices = ModellerChoices { operators: vec![shift(at, 0.5)], ..ModellerChoices::default() };
    let answer = answer(&bytes, choices, options);
    let [_, max] = bounds(&answer);
    assert!((max[2] - 1.5 * 25.4).abs() < 1e-5, "{max:?}");
}

#[test]
fn what_is_no_closed_solid_is_refused_with_the_place() {
    let mut open = cube();
    open.triangles.pop();
    let answer = edited(&encode(&open, Encoding::Off), vec![]);
    assert!(matches!(refusal(&answer), ModellerRefusal::Import(modeller::ImportRefusal::NotClosed(_))));
    // Two bodies are two volumes.
    let two = cube().with(&cube().moved([5.0, 0.0, 0.0]));
    let answer = edited(&encode(&two, Encoding::Off), vec![]);
    assert!(matches!(refusal(&answer), ModellerRefusal::Import(modeller::ImportRefusal::Invalid(_))));
}

#[test]
fn faces_are_written_as_polygons_where_that_is_asked() {
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::Off);
    for (format, quads) in [(Format::Off, "\n4 "), (Format::Obj, "\nf ")] {
        let choices = ModellerChoices { writes_polygons: true, ..ModellerChoices::default() };
        let options = Options { output_format: Some(format), ..Options::default() };
        let answer = answer(&bytes, choices, options);
        assert!(answer.report.certificate.as_ref().unwrap().is_printable());
        let text = String::from_utf8(answer.output.unwrap().bytes.unwrap()).unwrap();
        assert_eq!(text.matches(quads).count(), 6, "{text}");
    }
    // An STL has no polygons: nothing is to be written anew.
    let bytes = encode(&cuboid([3.0, 2.0, 1.0]), Encoding::StlBinary);
    let choices = ModellerChoices { writes_polygons: true, ..ModellerChoices::default() };
    let answer = answer(&bytes, choices, Options::default());
    assert_eq!((answer.report.outcome, answer.output.unwrap().bytes), (Some(Outcome::Identical), None));
}

/// A plate of an L with a hole: a face of a reflex corner, and faces with an interior loop.
fn angle_plate() -> RawSoup {
    let outline = [[0.0, 0.0], [40.0, 0.0], [40.0, 10.0], [10.0, 10.0], [10.0, 40.0], [0.0, 40.0]];
    let hole = [[3.0, 3.0], [3.0, 7.0], [7.0, 7.0], [7.0, 3.0]];
    let mut positions = Vec::new();
    for z in [0.0, 5.0] {
        positions.extend(outline.iter().chain(&hole).map(|p| [p[0], p[1], z]));
    }
    let top = [
        [0, 1, 9],
        [1, 3, 9],
        [1, 2, 3],
        [3, 8, 9],
        [3, 4, 8],
        [4, 7, 8],
        [4, 5, 7],
        [5, 6, 7],
        [5, 0, 6],
        [0, 9, 6],
    ];
    let mut triangles: Vec<[u32; 3]> = top.iter().map(|t| t.map(|v| v + 10)).collect();
    triangles.extend(top.iter().map(|&[a, b, c]| [a, c, b]));
    for (first, count) in [(0, 6), (6, 4)] {
        for i in 0..count {
            let (a, b) = (first + i, first + (i + 1) % count);
            triangles.extend([[a, b, b + 10], [a, b + 10, a + 10]]);
        }
    }
    RawSoup { positions, triangles }
}

#[test]
fn faces_with_holes_are_split_and_others_stay_polygons() {
    let bytes = encode(&angle_plate(), Encoding::Off);
    let wall = FaceName::Normal { normal: DVec3::X, at: DVec3::new(10.0, 30.0, 2.0) };
    let choices = ModellerChoices {
        operators: vec![shift(wall, 0.4)],
        writes_polygons: true,
        ..ModellerChoices::default()
    };
    let answer = answer(&bytes, choices, Options::default());
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    let counts = told(&answer).steps[0].validity.counts;
    assert_eq!((counts.interior_loops, counts.faces, counts.genus()), (2, 12, Some(1)));
    let text = String::from_utf8(answer.output.unwrap().bytes.unwrap()).unwrap();
    let of = |corners: &str| text.lines().skip(22).filter(|line| line.starts_with(corners)).count();
    assert_eq!((of("4 "), of("3 ")), (10, 20), "{text}");
}

#[test]
fn the_dual_is_written_and_a_plane_through_the_origin_is_refused_or_recentred() {
    let centred = cuboid([2.0; 3]).moved([-1.0; 3]);
    let choices = |is_dual_recentered: bool| ModellerChoices {
        dual: Some(Embedding::Polar),
        is_dual_recentered,
        ..ModellerChoices::default()
    };
    let octahedron = answer(&encode(&centred, Encoding::Off), choices(false), Options::default());
    let after = octahedron.report.after.as_ref().unwrap();
    assert_eq!((after.counts.triangles, octahedron.report.outcome), (8, Some(Outcome::Modelled)));
    assert!(octahedron.report.certificate.as_ref().unwrap().is_printable());
    assert_eq!(bounds(&octahedron), [[-1.0; 3], [1.0; 3]]);
    let corner = encode(&cuboid([2.0; 3]), Encoding::Off);
    let refused = answer(&corner, choices(false), Options::default());
    assert!(matches!(refusal(&refused), ModellerRefusal::Dual(_)));
    assert_eq!(bounds(&answer(&corner, choices(true), Options::default())), [[-1.0; 3], [1.0; 3]]);
}

#[test]
fn what_cannot_be_rounded_to_a_solid_is_refused_where_a_solid_is_demanded_and_never_called_one() {
    // So far from the origin float32 steps are 1/16: a wall of 0.01 between a cavity and the outside rounds to nothing.
    let cavity = cuboid([2.0; 3]).moved([1.0; 3]).inside_out();
    let far = cuboid([4.0; 3]).with(&cavity).moved([1_000_000.0; 3]);
    let bytes = encode(&far, Encoding::Off);
    let inside = FaceName::Normal { normal: -DVec3::X, at: DVec3::splat(1_000_002.0) + DVec3::X };
    let choices = ModellerChoices { operators: vec![shift(inside, -0.99)], ..ModellerChoices::default() };
    let free = answer(&bytes, choices.clone(), Options::default());
    assert_eq!(free.report.outcome, Some(Outcome::Modelled));
    assert!(!free.report.certificate.unwrap().is_printable());
    let strict = Options { require: Some(Require::Printable), ..Options::default() };
    let refused = answer(&bytes, choices, strict);
    assert_eq!((refused.report.outcome, refused.output), (Some(Outcome::Refused), None));
}

/// The faces of a list in another unit than that of the file.
fn faces_in(bytes: &[u8], options: Options) -> Vec<(u32, [i64; 3], usize)> {
    let choices = ModellerChoices { lists_faces: true, tolerance: Some(0.0), ..ModellerChoices::default() };
    let answer = answer(bytes, choices, options);
    let turned = |normal: DVec3| normal.to_array().map(|x| (x * 1e9).round() as i64);
    told(&answer).faces.iter().map(|f| (f.face, turned(f.normal), f.sides)).collect()
}

#[test]
fn faces_have_the_same_numbers_in_every_unit_and_format_of_the_result() {
    // Parallelograms of short binary fractions lie in one plane exactly; 25.4 times as large they do not, because of rounding.
    let sheared = cuboid([3.0, 2.0, 1.0]).map(|[x, y, z]| {
        [
            x + y * 0.328_125 + z * 0.703_125,
            y + x * 0.171_875 + z * 0.109_375,
            z + x * 0.453_125 + y * 0.890_625,
        ]
    });
    let bytes = encode(&sheared, Encoding::Off);
    let first = faces_in(&bytes, Options::default());
    assert_eq!(first.len(), 6);
    for (units, output_format, output_units) in [
        (Units::Inch, Some(Format::Stl), None),
        (Units::Inch, None, Some(Units::Millimetre)),
        (Units::Metre, Some(Format::Stl), None),
        (Units::Millimetre, Some(Format::Glb), None),
    ] {
        let options = Options { units: Some(units), output_format, output_units, ..Options::default() };
        assert_eq!(faces_in(&bytes, options), first, "{units:?} {output_format:?}");
    }
}

/// A roof of four slopes that ends at corners of four faces: its hips begin at the corners of the walls.
fn hip_house() -> RawSoup {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [12.0, 0.0, 0.0],
        [12.0, 8.0, 0.0],
        [0.0, 8.0, 0.0],
        [0.0, 0.0, 5.0],
        [12.0, 0.0, 5.0],
        [12.0, 8.0, 5.0],
        [0.0, 8.0, 5.0],
        [4.0, 4.0, 9.0],
        [8.0, 4.0, 9.0],
    ];
    let triangles = vec![
        [9, 5, 6],
        [7, 4, 8],
        [0, 3, 2],
        [2, 1, 0],
        [0, 1, 4],
        [1, 5, 4],
        [4, 3, 0],
        [4, 7, 3],
        [6, 2, 3],
        [3, 7, 6],
        [1, 2, 6],
        [6, 5, 1],
        [8, 6, 7],
        [9, 6, 8],
        [8, 4, 5],
        [8, 5, 9],
    ];
    RawSoup { positions, triangles }
}

#[test]
fn an_edge_merges_and_flips_where_corners_of_four_faces_split_first() {
    let bytes = encode(&hip_house(), Encoding::Off);
    let ridge = EdgeName { faces: [FaceName::Id(7), FaceName::Id(8)], at: None };
    let face = FaceName::Id(1);
    let merged = edited(&bytes, vec![Edit::Merge { edge: ridge, face }]);
    let step = &told(&merged).steps[0];
    assert!((step.moved[0].1 + 8.0f64.sqrt()).abs() < 1e-9 && step.validity.is_valid(), "{step:?}");
    for (by, volume) in [(-2.9, 496.4339), (-3.0, 489.4523)] {
        let flipped = edited(&bytes, vec![Edit::Flip { edge: ridge, face, by: Some(by) }]);
        let told = flipped.report.after.as_ref().and_then(|mesh| mesh.measures.volume).unwrap();
        assert!((told - volume).abs() < 1e-3, "{told} instead of {volume}");
    }
    // The ends of the ridge do not reach each other as early as that.
    let early = edited(&bytes, vec![Edit::Flip { edge: ridge, face, by: Some(-2.0) }]);
    let ModellerRefusal::Operator { limits, .. } = refusal(&early) else {
        panic!("{:?}", early.report.refusal)
    };
    assert!((limits[0].1 + 8.0f64.sqrt()).abs() < 1e-9, "{limits:?}");
}
