//! Colours, materials and texture of faces and vertices through repairs, and what is said of those that are lost.

use crate::oracle::RawSoup;
use crate::rebuild::rebuilding;
use crate::repair::{answer, coarse, count, without};
use crate::solids::cube;
use meshmend::budget::Budget;
use meshmend::formats::{self, Encoding, Format, ReadOptions};
use meshmend::geom::DVec3;
use meshmend::mesh::{Color, Descriptions, Materials, NO_POINT, Soup, Texture};
use meshmend::pipeline::{Answer, Operation, Options, Outcome, run};
use std::fmt::Write as _;
use std::sync::Arc;

fn result(answer: &Answer) -> Soup {
    let output = answer.output.as_ref().unwrap_or_else(|| panic!("{:?}", answer.report.refusal));
    let (bytes, encoding) = (output.bytes.as_ref().unwrap(), output.encoding);
    formats::read(bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

fn told(answer: &Answer, step: &str) -> Vec<(&'static str, u64)> {
    let of_step = answer.report.actions.iter().filter(|action| action.step == step);
    of_step.flat_map(|action| action.changes.clone()).collect()
}

/// An OBJ whose texture coordinates are an eighth of x and y, with the material of each face.
fn textured(soup: &RawSoup, material: impl Fn(usize) -> &'static str) -> Vec<u8> {
    let mut text = "mtllib a.mtl\n".to_owned();
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x} {y} {z}\nvt {} {}", x / 8.0, y / 8.0).unwrap();
    }
    for (t, corners) in soup.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| v + 1);
        writeln!(text, "usemtl {}\nf {a}/{a} {b}/{b} {c}/{c}", material(t)).unwrap();
    }
    text.into_bytes()
}

/// That the texture coordinates of a result are within `error` of where [`textured`] puts them.
fn check_texture(soup: &Soup, error: impl Fn(usize) -> f64) {
    for t in 0..soup.triangles.len() {
        let points = soup.texture.of_triangle(t).unwrap();
        for ([u, v], p) in points.into_iter().zip(soup.corners(t as u32)) {
            let apart = (u * 8.0 - p.x).abs().max((v * 8.0 - p.y).abs());
            assert!(apart < error(t), "{u} {v} at {p} of triangle {t}");
        }
    }
}

/// A PLY whose vertices or faces have colours.
fn colored(
    soup: &RawSoup,
    vertex: impl Fn(usize) -> Option<[u8; 3]>,
    face: impl Fn(usize) -> Option<[u8; 3]>,
) -> Vec<u8> {
    let channels = |color: Option<[u8; 3]>| match color {
        Some(_) => "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        None => "",
    };
    let put = |color: Option<[u8; 3]>| color.map_or(String::new(), |[r, g, b]| format!(" {r} {g} {b}"));
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}element face {}\n\
         property list uchar int vertex_indices\n{}end_header\n",
        soup.positions.len(),
        channels(vertex(0)),
        soup.triangles.len(),
        channels(face(0))
    );
    for (v, [x, y, z]) in soup.positions.iter().enumerate() {
        writeln!(text, "{x} {y} {z}{}", put(vertex(v))).unwrap();
    }
    for (t, [a, b, c]) in soup.triangles.iter().enumerate() {
        writeln!(text, "3 {a} {b} {c}{}", put(face(t))).unwrap();
    }
    text.into_bytes()
}

/// Two cubes that pass through each other.
fn crossing() -> RawSoup {
    cube().with(&cube().moved([0.5; 3]))
}

#[test]
fn a_part_that_keeps_its_bits_beside_a_rebuilt_one_keeps_its_texture_which_the_new_surface_has_too() {
    let soup = cube().moved([5.0, 0.0, 0.0]).with(&crossing());
    let answer = answer(&textured(&soup, |t| if t < 12 { "oak" } else { "tin" }), &rebuilding());
    assert_eq!(answer.report.outcome, Some(Outcome::Rebuilt));
    let made = result(&answer);
    assert_eq!(made.check(), Vec::<String>::new());
    check_texture(&made, |t| if t < 12 { 1e-9 } else { 0.1 });
    assert_eq!(told(&answer, "texture"), []);
    assert_eq!(count(&answer, "triangles_with_texture"), made.triangles.len() as u64 - 12);
    assert_eq!(made.materials.names, [b"oak".to_vec(), b"tin".to_vec()]);
    assert!((0..made.triangles.len()).all(|t| made.materials.of(t as u32) == Some(u32::from(t >= 12))));
}

#[test]
fn a_rebuilt_surface_has_the_colours_of_the_file() {
    let red = [250, 10, 20];
    let of_vertices = result(&answer(&colored(&crossing(), |_| Some(red), |_| None), &rebuilding()));
    let is_red = |color: &Option<Color>| *color == Some(Color::Bytes(red, None));
    assert!(of_vertices.vertex_colors.len() == of_vertices.positions.len());
    assert!(of_vertices.vertex_colors.iter().all(is_red));
    let answer = answer(&colored(&crossing(), |_| None, |_| Some(red)), &rebuilding());
    let of_faces = result(&answer);
    assert!(
        of_faces.face_colors.len() == of_faces.triangles.len() && of_faces.face_colors.iter().all(is_red)
    );
    assert_eq!(told(&answer, "left_out"), []);
    assert_eq!(count(&answer, "triangles_with_color"), of_faces.triangles.len() as u64);
}

#[test]
fn parts_of_triangles_keep_texture_and_material() {
    let answer = answer(&textured(&crossing(), |_| "oak"), &coarse());
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    check_texture(&result(&answer), |_| 1e-3);
    assert_eq!((told(&answer, "texture"), told(&answer, "materials")), (vec![], vec![]));
}

#[test]
fn a_patch_has_the_colour_or_the_material_of_what_is_beside_it() {
    let open = without(cube(), &[2, 3]);
    let color = |t: usize| [t as u8, 0, 0];
    let filled = answer(&colored(&open, |_| None, |t| Some(color(t))), &coarse());
    let made = result(&filled);
    assert_eq!(made.triangles.len(), 12);
    let colors: Vec<_> = (0..10).map(|t| Some(Color::Bytes(color(t), None))).collect();
    assert_eq!(made.face_colors[..10], colors);
    assert!(made.face_colors[10..].iter().all(|color| colors.contains(color)), "{:?}", made.face_colors);
    let taken = [("triangles_with_color", 2), ("triangles_with_material", 0), ("triangles_with_texture", 0)];
    assert_eq!(told(&filled, "taken_over"), taken);
    let filled = answer(&textured(&open, |_| "oak"), &coarse());
    let made = result(&filled);
    assert!((0..12).all(|t| made.materials.of(t) == Some(0)));
    assert!(!String::from_utf8_lossy(filled.output.unwrap().bytes.as_ref().unwrap()).contains("(null)"));
}

#[test]
fn vertex_colours_that_differ_at_a_seam_are_counted_when_it_is_welded() {
    // Each triangle has its own vertices, and those of the first have another colour.
    let cube = cube();
    let apart = RawSoup {
        positions: cube.triangles.as_flattened().iter().map(|&v| cube.positions[v as usize]).collect(),
        triangles: (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
    };
    let bytes = colored(&apart, |v| Some(if v < 3 { [255, 0, 0] } else { [0, 0, 255] }), |_| None);
    let welded = answer(&bytes, &coarse());
    let [(name, lost)] = told(&welded, "left_out")[..] else { panic!("{:?}", welded.report.actions) };
    assert!(name == "colors_at_seams" && lost > 0);
    assert_eq!(result(&welded).positions.len(), 8);
    // Written vertex by vertex, nothing is lost.
    let options = Options { output_format: Some(Format::Off), ..Options::default() };
    let converted = run(Operation::Convert, &bytes, &options, &Budget::unlimited()).unwrap();
    assert_eq!(told(&converted, "left_out"), []);
}

/// A triangle with a picture on it and one of the same material without texture coordinates.
fn half_textured() -> Soup {
    let json = br#"{ "materials": [{ "name": "skin", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 },
        "roughnessFactor": 0.5 } }], "textures": [{ "source": 0 }], "samplers": [], "images": [{ "mimeType": "image/png",
        "bufferView": 0 }] }"#;
    let descriptions =
        Descriptions { json: json.to_vec(), pictures: vec![vec![1, 2, 3]], colors: vec![None] };
    Soup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        triangles: vec![[0, 1, 2], [0, 3, 1]],
        face_count: 2,
        texture: Texture {
            points: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            corners: vec![[0, 1, 2], [NO_POINT; 3]],
        },
        materials: Materials {
            names: vec![b"skin".to_vec()],
            of_face: vec![0, 0],
            descriptions: Some(Arc::new(descriptions)),
            ..Materials::default()
        },
        ..Soup::default()
    }
}

#[test]
fn triangles_without_texture_have_a_material_without_pictures() {
    let budget = Budget::unlimited();
    let bytes = formats::write(&half_textured(), Encoding::Gltf, &budget).unwrap();
    let document: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
    let primitives = document["meshes"][0]["primitives"].as_array().unwrap();
    let of = |i: usize| {
        let material = &document["materials"][primitives[i]["material"].as_u64().unwrap() as usize];
        let has_points = primitives[i]["attributes"].get("TEXCOORD_0").is_some();
        let pbr = &material["pbrMetallicRoughness"];
        assert_eq!((&material["name"], &pbr["roughnessFactor"]), (&"skin".into(), &0.5.into()));
        (has_points, pbr.get("baseColorTexture").is_some())
    };
    assert_eq!((of(0), of(1)), ((true, true), (false, false)));
    // What is written of that has no more materials.
    let again = formats::read(&bytes, Encoding::Gltf, &ReadOptions::default(), &budget).unwrap();
    assert_eq!(again.materials.names.len(), 2);
    assert_eq!(formats::write(&again, Encoding::Gltf, &budget).unwrap(), bytes);
}

#[test]
fn linear_colours_become_those_of_a_3mf() {
    let linear = Some(Color::Linear([1.0, 0.0, 0.214_041_14], Some(1.0)));
    let soup = Soup { face_colors: vec![linear, None], ..half_textured() };
    let at_vertices = Soup { face_colors: Vec::new(), vertex_colors: vec![linear; 4], ..soup.clone() };
    for soup in [soup, at_vertices] {
        let bytes = formats::write(&soup, Encoding::ThreeMf, &Budget::unlimited()).unwrap();
        let back = formats::read(&bytes, Encoding::ThreeMf, &ReadOptions::default(), &Budget::unlimited());
        assert_eq!(back.unwrap().face_colors[0], Some(Color::Bytes([255, 0, 128], None)));
    }
}

#[test]
fn names_and_colours_that_the_output_does_not_hold_are_counted() {
    let mut text = String::from_utf8(textured(&cube(), |_| "oak")).unwrap();
    text.insert_str(0, "o body\ng side\n");
    let options = Options { output_format: Some(Format::Stl), ..Options::default() };
    let converted = run(Operation::Convert, text.as_bytes(), &options, &Budget::unlimited()).unwrap();
    assert_eq!(told(&converted, "left_out"), [("objects", 1)]);
    let bytes = colored(&cube(), |_| Some([1, 2, 3]), |_| Some([4, 5, 6]));
    let converted = run(Operation::Convert, &bytes, &options, &Budget::unlimited()).unwrap();
    assert_eq!(told(&converted, "left_out"), [("vertex_colors", 8), ("face_colors", 12)]);
}
