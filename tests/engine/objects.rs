//! The objects of a file, which are the `o` and `g` of OBJ and the nodes of glTF, through operations and from format to format.

use crate::oracle::RawSoup;
use crate::rebuild::rebuilding;
use crate::repair::{answer, coarse, without};
use crate::solids::cube;
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Format, ReadOptions, color_faces, read, write};
use meshmend::geom::DVec3;
use meshmend::mesh::{Color, Materials, NO_OBJECT, OBJECTS_MAX, ObjectName, Objects, Soup};
use meshmend::pipeline::{Answer, Operation, Options, Outcome, SimplifyChoices, run};
use meshmend::simplify::Target;
use serde_json::Value;
use std::fmt::Write as _;

/// An OBJ with a line before some of its triangles.
fn obj(soup: &RawSoup, line: impl Fn(usize) -> &'static str) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for (t, corners) in soup.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| v + 1);
        writeln!(text, "{}f {a} {b} {c}", line(t)).unwrap();
    }
    text.into_bytes()
}

fn soup_of(bytes: &[u8], encoding: Encoding) -> Soup {
    let soup = read(bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    assert_eq!(soup.check(), Vec::<String>::new());
    soup
}

fn output(answer: &Answer) -> &[u8] {
    answer.output.as_ref().unwrap().bytes.as_ref().unwrap()
}

/// The names of the object of each triangle, `object/group`, with its middle.
fn objects(soup: &Soup) -> Vec<(String, DVec3)> {
    let text = |name: &[u8]| String::from_utf8(name.to_vec()).unwrap();
    let object = |t: u32| match soup.objects.of(soup.face_of(t)).map(|o| &soup.objects.names[o as usize]) {
        Some(ObjectName { object, group }) => format!("{}/{}", text(object), text(group)),
        None => String::new(),
    };
    (0..soup.triangles.len() as u32)
        .map(|t| (object(t), soup.corners(t).iter().sum::<DVec3>() / 3.0))
        .collect()
}

fn as_format(format: Format) -> Options {
    Options { output_format: Some(format), ..Options::default() }
}

/// Two cubes whose triangles belong to three objects in turn; the first three belong to none.
fn mixed() -> (RawSoup, impl Fn(usize) -> &'static str + Copy) {
    let soup = cube().with(&cube().moved([3.0, 0.0, 0.0]));
    let line = |t: usize| match t {
        3 => "o left\ng top side\n",
        6 => "g\n",
        8 => "g top side\n",
        12 => "o right\ng\n",
        _ => "",
    };
    (soup, line)
}

#[test]
fn the_objects_of_an_obj_stay_with_their_triangles_and_each_is_written_in_one_piece() {
    let (soup, line) = mixed();
    let before = soup_of(&obj(&soup, line), Encoding::Obj);
    assert_eq!(before.objects.of_face[..9], [NO_OBJECT, NO_OBJECT, NO_OBJECT, 0, 0, 0, 1, 1, 0]);
    assert_eq!((before.objects.names.len(), before.left_out.len()), (3, 0));
    // Without a triangle of the second object, whose patch comes last.
    let mended = answer(&obj(&without(soup, &[7]), |t| line(t + usize::from(t >= 7))), &coarse());
    assert_eq!(mended.report.outcome, Some(Outcome::Repaired));
    assert_eq!(mended.report.identical_triangle_share, Some(1.0));
    assert!(mended.report.actions.iter().all(|action| action.step != "left_out"));
    let text = String::from_utf8(output(&mended).to_vec()).unwrap();
    let statements: Vec<&str> = text.lines().filter(|line| line.starts_with(['o', 'g'])).collect();
    assert_eq!(statements, ["o left", "g top side", "g", "o right"]);
    let (was, is) = (objects(&before), objects(&soup_of(text.as_bytes(), Encoding::Obj)));
    assert_eq!(is.len(), 24);
    // The patch belongs where one beside it does.
    let mut kept = was.iter().enumerate().filter(|&(t, _)| t != 7);
    assert!(kept.all(|(_, triangle)| is.contains(triangle)), "{is:?}");
}

#[test]
fn objects_become_nodes_with_their_own_vertices_and_nodes_objects() {
    let (soup, line) = mixed();
    let bytes = obj(&soup, line);
    let metres = Options { units: Some(meshmend::pipeline::Units::Metre), ..as_format(Format::Gltf) };
    let converted = run(Operation::Convert, &bytes, &metres, &Budget::unlimited()).unwrap();
    assert_eq!(converted.report.identical_triangle_share, Some(1.0));
    assert_eq!(converted.report.certificate.as_ref().unwrap().shells.len(), 2);
    let document: Value = serde_json::from_slice(output(&converted)).unwrap();
    let names = |list: &str| -> Vec<Option<&str>> {
        document[list].as_array().unwrap().iter().map(|item| item["name"].as_str()).collect()
    };
    assert_eq!(names("nodes"), [None, Some("left"), Some("left"), Some("right")]);
    assert_eq!(names("meshes"), [None, Some("top side"), None, None]);
    assert_eq!(document["scenes"][0]["nodes"], serde_json::json!([0, 1, 2, 3]));
    // The box of each is its own.
    let right = &document["meshes"][3]["primitives"][0]["attributes"]["POSITION"];
    let positions = &document["accessors"][right.as_u64().unwrap() as usize];
    assert_eq!((&positions["min"][0], &positions["count"]), (&serde_json::json!(3.0), &serde_json::json!(8)));
    let (before, after) = (soup_of(&bytes, Encoding::Obj), soup_of(output(&converted), Encoding::Gltf));
    let (mut was, mut is) = (objects(&before), objects(&after));
    // Those that belonged to none are of a node without a name.
    was.iter_mut().chain(&mut is).filter(|(name, _)| name == "/").for_each(|(name, _)| name.clear());
    let key = |(name, p): &(String, DVec3)| (name.clone(), p.to_array().map(f64::to_bits));
    was.sort_by_key(key);
    is.sort_by_key(key);
    assert_eq!(was, is);
    let back =
        run(Operation::Convert, output(&converted), &as_format(Format::Obj), &Budget::unlimited()).unwrap();
    let mut again = objects(&soup_of(output(&back), Encoding::Obj));
    again.iter_mut().filter(|(name, _)| name == "/").for_each(|(name, _)| name.clear());
    again.sort_by_key(key);
    assert_eq!(again, is);
}

#[test]
fn united_rebuilt_and_simplified_bodies_belong_where_they_did() {
    let crossing = cube().with(&cube().moved([0.5; 3]));
    let bytes = obj(&crossing, |t| match t {
        0 => "o low\n",
        12 => "o high\n",
        _ => "",
    });
    for options in [coarse(), rebuilding()] {
        let made = answer(&bytes, &options);
        let soup = soup_of(output(&made), Encoding::Obj);
        let (mut low, mut high) = (0, 0);
        for (name, middle) in objects(&soup) {
            let is_of_low = middle.min_element() < 0.2;
            let is_of_high = middle.max_element() > 1.3;
            low += u32::from(is_of_low);
            high += u32::from(is_of_high);
            assert!(!is_of_low || name == "low/", "{name} at {middle}");
            assert!(!is_of_high || name == "high/", "{name} at {middle}");
        }
        assert!(low > 0 && high > 0);
    }
    let (soup, line) = mixed();
    let simplify = SimplifyChoices { targets: vec![Target::Faces(20)], ..SimplifyChoices::default() };
    let options = Options { simplify, ..Options::default() };
    let simplified = run(Operation::Simplify, obj(&soup, line), &options, &Budget::unlimited()).unwrap();
    let bytes = simplified.output.as_ref().and_then(|output| output.bytes.as_deref()).unwrap();
    let of_x = |(name, middle): &(String, DVec3)| (middle.x > 2.0) == (name == "right/");
    assert!(objects(&soup_of(bytes, Encoding::Obj)).iter().all(of_x));
}

#[test]
fn objects_that_the_output_does_not_hold_and_too_many_are_counted() {
    let (soup, line) = mixed();
    let told = |bytes: &[u8], format| {
        let converted = run(Operation::Convert, bytes, &as_format(format), &Budget::unlimited()).unwrap();
        let left_out = converted.report.actions.iter().find(|action| action.step == "left_out");
        left_out.map_or(Vec::new(), |action| action.changes.clone())
    };
    for format in [Format::Stl, Format::Off, Format::Ply, Format::ThreeMf] {
        assert_eq!(told(&obj(&soup, line), format), [("objects", 3)], "{format:?}");
    }
    // One more than are kept.
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 0..=OBJECTS_MAX {
        writeln!(text, "g {i}\nf 1 2 3").unwrap();
    }
    let many = soup_of(text.as_bytes(), Encoding::Obj);
    assert!(many.objects.is_empty());
    assert_eq!(many.left_out, [("objects", OBJECTS_MAX as u64 + 1)]);
    // What a name of another format holds stays in its line.
    let name = ObjectName { object: b"a\nf 1 2 3\r#\\".to_vec(), group: Vec::new() };
    let mut one = soup_of(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Encoding::Obj);
    one.objects = Objects { names: vec![name], of_face: vec![0] };
    one.materials =
        Materials { names: vec![b"b\nf 3 2 1\\".to_vec()], of_face: vec![0], ..Materials::default() };
    let text = String::from_utf8(write(&one, Encoding::Obj, &Budget::unlimited()).unwrap()).unwrap();
    assert!(text.ends_with("o a_f 1 2 3_#_\nusemtl b_f 3 2 1_\nf 1 2 3\n"), "{text}");
    // A backslash joins the next line, whoever counts.
    let joined = "v 0 0 0\nv 1 0 0\ng C:\\dir\\\nv 9 9 9\nv 0 1 0\nusemtl a\\\nf 1 1 1\nf -3 -2 -1\n";
    let soup = soup_of(joined.as_bytes(), Encoding::Obj);
    assert_eq!((soup.positions.len(), &soup.triangles[..]), (3, &[[0, 1, 2]][..]));
    assert_eq!(soup.objects.names[0].group, b"C:\\dir");
    let mut colored = soup;
    let mtl = b"newmtl a\nKd 1 0 0\n";
    color_faces(&mut colored, joined.as_bytes(), mtl, &Budget::unlimited()).unwrap();
    assert_eq!(colored.face_colors, [Some(Color::Floats([1.0, 0.0, 0.0], None))]);
    // A long name is as none.
    let long = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\no {}\nf 1 2 3\n", "x".repeat(256));
    assert!(soup_of(long.as_bytes(), Encoding::Obj).objects.is_empty());
}

#[test]
fn a_soup_with_objects_is_written_and_read_back_the_same() {
    let (soup, line) = mixed();
    for encoding in [Encoding::Obj, Encoding::Glb] {
        let before = soup_of(&obj(&soup, line), Encoding::Obj);
        let bytes = write(&before, encoding, &Budget::unlimited()).unwrap();
        let after = soup_of(&bytes, encoding);
        let again = write(&after, encoding, &Budget::unlimited()).unwrap();
        assert!(again == bytes, "{encoding:?}");
    }
}
