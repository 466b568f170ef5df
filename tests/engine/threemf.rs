//! 3MF: packages that break other readers, projects that keep what is theirs, and parts that are mended one by one.

use meshmend::analysis::DefectCode;
use meshmend::budget::{Budget, StopFlag};
use meshmend::certificate::{Depth, certify_parts};
use meshmend::formats::threemf::{ObjectKind, Project, read_project};
use meshmend::formats::{self, Encoding, Format, Place, ReadErrorKind, ReadOptions, read, sniff};
use meshmend::mesh::{Color, Units};
use meshmend::pipeline::{
    self, Answer, Failure, HoleOutcome, Operation, Options, Outcome, PictureChoices, Require, SolidParts,
};
use meshmend::render::View;
use std::fmt::Write as _;
use std::io::{Cursor, Read as _, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const MATERIAL: &str = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
const PRODUCTION: &str = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
const RELATIONSHIPS: &str = "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
    <Relationship Target=\"/3D/3dmodel.model\" Id=\"r0\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\
    </Relationships>";

/// A zip archive of these entries.
fn package_with(entries: &[(&str, &[u8])], options: SimpleFileOptions) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        archive.start_file(*name, options).unwrap();
        archive.write_all(content).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

fn package(entries: &[(&str, &[u8])]) -> Vec<u8> {
    package_with(entries, SimpleFileOptions::default().compression_method(CompressionMethod::Deflated))
}

/// A 3MF with this model.
pub(crate) fn file(model: &str) -> Vec<u8> {
    package(&[("_rels/.rels", RELATIONSHIPS.as_bytes()), ("3D/3dmodel.model", model.as_bytes())])
}

/// A 3MF with this model and what slicers of the kin of Bambu Studio note of its parts.
pub(crate) fn with_settings(model: &str, settings: &str) -> Vec<u8> {
    package(&[
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model.as_bytes()),
        ("Metadata/model_settings.config", settings.as_bytes()),
    ])
}

pub(crate) fn model(attributes: &str, resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model {attributes} xmlns=\"{CORE}\" xmlns:m=\"{MATERIAL}\" \
         xmlns:p=\"{PRODUCTION}\" xmlns:slic3rpe=\"http://schemas.slic3r.org/3mf/2017/06\">\n\
         <resources>{resources}</resources>\n<build>{build}</build>\n</model>\n"
    )
}

/// The corners and triangles of the box from `low` to `high`, outward.
pub(crate) fn cuboid(low: [f64; 3], high: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
    let triangles = vec![
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    ((0..8).map(corner).collect(), triangles)
}

/// The element of a mesh; `marks` gives further attributes of each triangle.
pub(crate) fn mesh(points: &[[f64; 3]], triangles: &[[u32; 3]], marks: impl Fn(usize) -> String) -> String {
    let mut text = "<mesh><vertices>".to_owned();
    for [x, y, z] in points {
        write!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>").unwrap();
    }
    text += "</vertices><triangles>";
    for (t, [a, b, c]) in triangles.iter().enumerate() {
        write!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"{}/>", marks(t)).unwrap();
    }
    text + "</triangles></mesh>"
}

fn plain_cuboid(side: f64) -> String {
    let (points, triangles) = cuboid([0.0; 3], [side; 3]);
    mesh(&points, &triangles, |_| String::new())
}

fn simple() -> String {
    let object = format!("<object id=\"1\" type=\"model\" name=\"a\">{}</object>", plain_cuboid(10.0));
    model("unit=\"millimeter\"", &object, "<item objectid=\"1\"/>")
}

pub(crate) fn project(bytes: &[u8]) -> Project {
    read_project(bytes, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

fn error_of(bytes: &[u8]) -> formats::ReadError {
    let budget = Budget::new(StopFlag::default(), u64::MAX, 256 << 20);
    let error = read_project(bytes, &ReadOptions::default(), &budget).unwrap_err();
    assert!(!matches!(error.kind, ReadErrorKind::Stopped(_)), "{error}");
    error
}

pub(crate) fn run(operation: Operation, bytes: &[u8], options: &Options) -> Answer {
    pipeline::run(operation, bytes, options, &Budget::unlimited()).unwrap()
}

pub(crate) fn part(bytes: &[u8], name: &str) -> Vec<u8> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut content = Vec::new();
    archive.by_name(name).unwrap().read_to_end(&mut content).unwrap();
    content
}

pub(crate) fn result(answer: &Answer) -> &[u8] {
    answer.output.as_ref().and_then(|output| output.bytes.as_deref()).expect("a new file")
}

#[test]
fn a_valid_file_comes_back_byte_for_byte() {
    let bytes = file(&simple());
    assert_eq!(sniff(&bytes, None), Ok(Encoding::ThreeMf));
    let answer = run(Operation::Repair, &bytes, &Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Identical));
    assert_eq!(answer.output.unwrap().bytes, None);
    let certificate = answer.report.certificate.unwrap();
    assert!(certificate.is_printable());
    assert_eq!((certificate.parts, certificate.triangles), (Some(1), 12));
}

#[test]
fn packages_that_break_other_readers_are_read() {
    let model = simple();
    let marked = format!("\u{feff}{model}");
    let absolute =
        package(&[("/_rels/.rels", RELATIONSHIPS.as_bytes()), ("/3D/3dmodel.model", model.as_bytes())]);
    let slashes =
        package(&[("_rels\\.rels", RELATIONSHIPS.as_bytes()), ("3D\\3dmodel.model", model.as_bytes())]);
    let loose = package(&[("3D/3dmodel.model", model.as_bytes())]);
    let entries: [(&str, &[u8]); 2] =
        [("_rels/.rels", RELATIONSHIPS.as_bytes()), ("3D/3dmodel.model", model.as_bytes())];
    let stored =
        package_with(&entries, SimpleFileOptions::default().compression_method(CompressionMethod::Stored));
    let large = package_with(&entries, SimpleFileOptions::default().large_file(true));
    let mut streamed = ZipWriter::new_stream(Vec::new());
    for (name, content) in entries {
        streamed.start_file(name, SimpleFileOptions::default()).unwrap();
        streamed.write_all(content).unwrap();
    }
    let streamed = streamed.finish().unwrap().into_inner();
    let repeated = model.replace(
        "<resources>",
        "<metadata name=\"Title\">a</metadata><metadata name=\"Title\">b</metadata><resources>",
    );
    let of_model =
        RELATIONSHIPS.replace("/3D/3dmodel.model", "C:/picture.png").replace("3dmodel\"", "texture\"");
    let [relationships, root] = entries;
    let dangling = package(&[relationships, root, ("3D/_rels/3dmodel.model.rels", of_model.as_bytes())]);
    let mixed = model.replace(
        "<resources>",
        "<resources><m:colorgroup id=\"90\"><m:color color=\"#FF0000\"/></m:colorgroup>\
         <m:compositematerials id=\"91\" matid=\"90\" matindices=\"0\"><m:composite values=\"1\"/></m:compositematerials>",
    );
    let cases = [
        ("byte order mark", file(&marked), 0),
        ("absolute names", absolute, 0),
        ("backslashes", slashes, 0),
        ("stored entries", stored, 0),
        ("zip64", large, 0),
        ("data descriptors", streamed, 0),
        ("no relationships", loose, 1),
        ("metadata twice", file(&repeated), 1),
        ("a part of the model that is not there", dangling, 1),
        ("xml:space", file(&model.replace("<model ", "<model xml:space=\"default\" ")), 1),
        ("a composite of colours", file(&mixed), 1),
    ];
    for (what, bytes, remarks) in cases {
        let project = project(&bytes);
        assert_eq!(project.bodies.len(), 1, "{what}");
        assert_eq!(project.remarks.len(), remarks, "{what}: {:?}", project.remarks);
        let answer = run(Operation::Verify, &bytes, &Options::default());
        assert!(answer.report.input_certificate.is_printable(), "{what}");
    }
}

#[test]
fn an_element_of_thousands_of_attributes_is_refused() {
    let many: String = (0..20_000).map(|i| format!("a{i}=\"\" ")).collect();
    let error = error_of(&file(&simple().replace("<item ", &format!("<item {many}"))));
    assert!(error.to_string().contains("more than 200 attributes in <item>"), "{error}");
}

#[test]
fn names_that_lead_out_of_the_package_and_missing_parts_are_refused() {
    let model = simple();
    let traversal = package(&[
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model.as_bytes()),
        ("../../etc/passwd", b"x"),
    ]);
    assert!(error_of(&traversal).to_string().contains("../../etc/passwd"));
    let missing = package(&[("_rels/.rels", RELATIONSHIPS.as_bytes()), ("3D/other.model", model.as_bytes())]);
    assert!(error_of(&missing).to_string().contains("/3D/3dmodel.model"));
    let signed = RELATIONSHIPS.replace(
        "</Relationships>",
        "<Relationship Target=\"/_xmlsignatures/origin.sigs\" Id=\"s\" \
         Type=\"http://schemas.openxmlformats.org/package/2006/relationships/digital-signature/origin\"/></Relationships>",
    );
    let signed = package(&[("_rels/.rels", signed.as_bytes()), ("3D/3dmodel.model", model.as_bytes())]);
    assert!(error_of(&signed).to_string().contains("a signed 3MF"));
    let document = package(&[("[Content_Types].xml", b"<Types/>"), ("word/document.xml", b"<w/>")]);
    assert!(matches!(sniff(&document, None).unwrap_err().kind, ReadErrorKind::Foreign { .. }));
}

#[test]
fn a_bomb_is_refused_before_it_is_memory() {
    // 1 GiB of blanks behind a model; the entry says so, and its ratio is more than any mesh has.
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    archive.start_file("_rels/.rels", SimpleFileOptions::default()).unwrap();
    archive.write_all(RELATIONSHIPS.as_bytes()).unwrap();
    archive.start_file("3D/3dmodel.model", SimpleFileOptions::default()).unwrap();
    archive.write_all(simple().as_bytes()).unwrap();
    let blanks = vec![b' '; 1 << 20];
    for _ in 0..1 << 10 {
        archive.write_all(&blanks).unwrap();
    }
    let bytes = archive.finish().unwrap().into_inner();
    assert!(bytes.len() < 2 << 20);
    let error = error_of(&bytes);
    assert!(matches!(error.kind, ReadErrorKind::TooLarge { limit_name: "ratio_max", .. }), "{error}");

    // The same with an entry that lies about its size.
    let size = ((1_u64 << 30) + simple().len() as u64) as u32;
    let lie = 100_000_u32;
    let mut bytes = bytes;
    let places: Vec<usize> =
        (0..bytes.len() - 4).filter(|&i| bytes[i..i + 4] == size.to_le_bytes()).collect();
    assert_eq!(places.len(), 2, "in the entry and in the directory");
    for i in places {
        bytes[i..i + 4].copy_from_slice(&lie.to_le_bytes());
    }
    let error = error_of(&bytes);
    assert!(error.to_string().contains("3dmodel.model"), "{error}");
}

#[test]
fn what_is_no_model_is_refused_with_its_place() {
    let cases = [
        (simple().replace("<model", "<!DOCTYPE model><model"), "document type"),
        (simple().replace("UTF-8", "ISO-8859-1"), "ISO-8859-1"),
        (simple().replace("unit=\"millimeter\"", "unit=\"parsec\""), "parsec"),
        (simple().replace("</build>", "</built>"), "no XML"),
        (simple().replace("objectid=\"1\"", "objectid=\"7\""), "the object 7"),
        (
            simple().replace("<model", "<model requiredextensions=\"v\" xmlns:v=\"urn:volumes\""),
            "urn:volumes",
        ),
        (simple().replace("v1=\"0\"", "v1=\"x\""), "triangle"),
        (simple().replace("x=\"10\"", "x=\"ten\""), "vertex"),
        (
            simple().replace("objectid=\"1\"/>", "objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 0 0 0 0\"/>"),
            "transform",
        ),
    ];
    for (model, what) in cases {
        let error = error_of(&file(&model));
        assert!(error.to_string().contains(what), "{what}: {error}");
        assert!(error.to_string().contains("3dmodel.model"), "{error}");
        assert_ne!(error.place, Place::Whole, "{error}");
    }
}

#[test]
fn components_may_not_go_in_a_circle_and_may_be_many() {
    let cube = format!("<object id=\"1\" type=\"model\">{}</object>", plain_cuboid(1.0));
    let circle = format!(
        "{cube}<object id=\"2\"><components><component objectid=\"3\"/></components></object>\
         <object id=\"3\"><components><component objectid=\"1\"/><component objectid=\"2\"/></components></object>"
    );
    let error = error_of(&file(&model("", &circle, "<item objectid=\"2\"/>")));
    assert!(error.to_string().contains("of itself"), "{error}");

    let mut many = format!("{cube}<object id=\"2\"><components>");
    for i in 0..10_000 {
        write!(
            many,
            "<component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 {} {} 0\"/>",
            2 * (i % 100),
            2 * (i / 100)
        )
        .unwrap();
    }
    many += "</components></object>";
    let bytes = file(&model("", &many, "<item objectid=\"2\"/>"));
    let all = project(&bytes);
    assert_eq!((all.bodies.len(), all.bodies[0].instances), (1, 10_000));
    let scene = read(&bytes, Encoding::ThreeMf, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    assert_eq!(scene.triangles.len(), 120_000);

    // Each object twice in the next: 2^40 places.
    let mut doubled = cube;
    for i in 2..42 {
        let below = format!("<component objectid=\"{}\"/>", i - 1);
        write!(doubled, "<object id=\"{i}\"><components>{below}{below}</components></object>").unwrap();
    }
    let error = error_of(&file(&model("", &doubled, "<item objectid=\"41\"/>")));
    assert!(matches!(error.kind, ReadErrorKind::TooLarge { limit_name: "components_max", .. }), "{error}");
}

#[test]
fn coordinates_and_indices_that_cannot_be_used_are_findings() {
    let huge = simple().replace("x=\"10\"", "x=\"1e999\"");
    let answer = run(Operation::Analyze, &file(&huge), &Options::default());
    assert!(answer.report.before.unwrap().has_errors());
    let beyond = simple().replace("v1=\"0\" v2=\"2\" v3=\"1\"", "v1=\"0\" v2=\"99\" v3=\"1\"");
    let bytes = file(&beyond);
    assert_eq!(project(&bytes).bodies[0].soup.face_faults.len(), 1);
    let mended = run(Operation::Repair, &bytes, &Options::default());
    assert!(mended.report.certificate.unwrap().is_printable());
}

#[test]
fn a_transform_is_applied_once_and_a_mirror_keeps_the_outside_out() {
    let cube = format!("<object id=\"1\" type=\"model\">{}</object>", plain_cuboid(2.0));
    let nested = format!(
        "{cube}<object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object>"
    );
    let build = "<item objectid=\"2\" transform=\"-1 0 0 0 1 0 0 0 1 0 7 0\"/><item objectid=\"1\"/>";
    let bytes = file(&model("unit=\"inch\"", &nested, build));
    let scene = read(&bytes, Encoding::ThreeMf, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    assert_eq!(scene.units, Some(Units::Inch));
    let xs: Vec<f64> = scene.positions[..8].iter().map(|p| p.x).collect();
    assert!(xs.iter().all(|x| (-7.0..=-5.0).contains(x)), "{xs:?}");
    assert!(scene.positions[..8].iter().all(|p| (7.0..=9.0).contains(&p.y)));
    let together = Options { parts: SolidParts::Together, ..Options::default() };
    let verified = run(Operation::Verify, &bytes, &together);
    assert!(verified.report.input_certificate.is_printable());
    // STL names no unit: what it holds is millimetres.
    let stl = Options { output_format: Some(Format::Stl), ..Options::default() };
    let converted = run(Operation::Convert, &bytes, &stl);
    assert_eq!(converted.report.input.units, Units::Inch);
    let bounds = converted.report.after.unwrap().measures.bounds.unwrap();
    assert!((bounds.max.y - 9.0 * 25.4).abs() < 1e-4, "{bounds:?}");
}

#[test]
fn colours_go_from_a_project_to_other_formats_and_back() {
    let (points, triangles) = cuboid([0.0; 3], [1.0; 3]);
    let resources = format!(
        "<basematerials id=\"1\"><base name=\"r\" displaycolor=\"#FF0000\"/><base name=\"b\" displaycolor=\"#0000FF\"/></basematerials>\
         <m:colorgroup id=\"2\"><m:color color=\"#00FF00\"/></m:colorgroup>\
         <m:compositematerials id=\"3\" matid=\"1\" matindices=\"0 1\"><m:composite values=\"1 1\"/></m:compositematerials>\
         <m:multiproperties id=\"4\" pids=\"1 2\"><m:multi pindices=\"1 0\"/></m:multiproperties>\
         <object id=\"9\" pid=\"1\" pindex=\"0\">{}</object>",
        mesh(&points, &triangles, |t| match t {
            0 => " pid=\"2\" p1=\"0\"".to_owned(),
            1 => " p1=\"1\"".to_owned(),
            2 => " pid=\"3\" p1=\"0\"".to_owned(),
            3 => " pid=\"4\" p1=\"0\"".to_owned(),
            4 => " pid=\"1\" p1=\"0\" p2=\"1\" p3=\"1\"".to_owned(),
            _ => String::new(),
        })
    );
    let bytes = file(&model("", &resources, "<item objectid=\"9\"/>"));
    let expected = [[0, 255, 0], [0, 0, 255], [128, 0, 128], [0, 255, 0], [85, 0, 170], [255, 0, 0]];
    let colors_of = |bytes: &[u8], encoding| {
        let soup = read(bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        soup.face_colors
            .iter()
            .map(|color| match color {
                Some(Color::Bytes(rgb, _)) => *rgb,
                other => panic!("{other:?}"),
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(colors_of(&bytes, Encoding::ThreeMf)[..6], expected);
    let to = |format| Options { output_format: Some(format), ..Options::default() };
    let off = run(Operation::Convert, &bytes, &to(Format::Off));
    assert_eq!(colors_of(result(&off), Encoding::Off)[..6], expected);
    assert!(
        off.report.remarks.last().unwrap().contains("textures and materials that 5 triangles state"),
        "{:?}",
        off.report.remarks
    );
    // The fifth has other colours at its corners.
    let told = off.report.actions.iter().find(|action| action.step == "left_out").unwrap();
    assert_eq!(told.changes, [("colors_at_corners", 1)]);
    for (format, what) in [(Format::Glb, "textures and"), (Format::Obj, "colours, textures and")] {
        let remarks = run(Operation::Convert, &bytes, &to(format)).report.remarks;
        assert!(remarks.last().unwrap().contains(&format!(": {what} materials that")), "{remarks:?}");
    }
    let back = run(Operation::Convert, result(&off), &to(Format::ThreeMf));
    assert_eq!(colors_of(result(&back), Encoding::ThreeMf)[..6], expected);
    assert!(back.report.certificate.unwrap().is_printable());
}

/// A project of four colours as slicers of the Prusa and Bambu families write it: a part in a file of its own, one with a
/// hole, one that a second body crosses, one that is inside out, one that is valid.
fn painted(is_broken: bool) -> Vec<u8> {
    const PAINT: [&str; 4] = ["4", "8", "0C", "1C"];
    let paint = |t: usize| format!(" paint_color=\"{0}\" slic3rpe:mmu_segmentation=\"{0}\"", PAINT[t % 4]);
    let (points, mut open) = cuboid([0.0; 3], [10.0; 3]);
    let (_, mut turned) = cuboid([0.0; 3], [10.0; 3]);
    let (mut crossed_points, mut crossed) = cuboid([0.0; 3], [10.0; 3]);
    if is_broken {
        open.pop();
        turned.iter_mut().for_each(|t| t.swap(1, 2));
        let (more, triangles) = cuboid([5.0, 2.0, 2.0], [15.0, 4.0, 4.0]);
        crossed_points.extend(more);
        crossed.extend(triangles.iter().map(|t| t.map(|v| v + 8)));
    }
    let divided = |t: usize| if t == 3 { " paint_color=\"4843\"".to_owned() } else { paint(t) };
    let object = |id: u32, name: &str, mesh: &str| {
        format!("<object id=\"{id}\" type=\"model\" name=\"{name}\" pid=\"1\" pindex=\"0\">{mesh}</object>\n")
    };
    let materials = "<basematerials id=\"1\"><base name=\"PLA\" displaycolor=\"#808080\"/></basematerials>";
    let own = model(
        "",
        &[materials, &object(2, "valid", &mesh(&points, &cuboid([0.0; 3], [10.0; 3]).1, paint))].concat(),
        "",
    );
    let root = [
        materials.to_owned(),
        object(2, "open", &mesh(&points, &open, paint)),
        object(3, "crossed", &mesh(&crossed_points, &crossed, paint)),
        object(4, "turned", &mesh(&points, &turned, divided)),
        "<object id=\"5\" name=\"assembly\"><components><component objectid=\"2\"/>\
         <component objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 40 0 0\"/></components></object>\n"
            .to_owned(),
    ]
    .concat();
    let build = "<item objectid=\"5\"/><item objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 1 0 40 0\"/>\
                 <item objectid=\"2\" p:path=\"/3D/Objects/valid.model\" transform=\"1 0 0 0 1 0 0 0 1 40 40 0\"/>";
    package(&[
        ("[Content_Types].xml", b"<Types/>"),
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model("unit=\"millimeter\" requiredextensions=\"p\"", &root, build).as_bytes()),
        ("3D/Objects/valid.model", own.as_bytes()),
        ("Metadata/plate_1.png", &[7; 5000]),
        ("Metadata/model_settings.config", b"<config><object id=\"2\"/></config>"),
    ])
}

/// The corners of each triangle of an object with its other attributes.
fn marks(bytes: &[u8], name: &str) -> Vec<([[f64; 3]; 3], String)> {
    let project = project(bytes);
    let body = project.bodies.iter().find(|body| body.name == name).unwrap();
    let text = |t: usize| {
        let number = body.attributes.others.get(t).copied().unwrap_or(u32::MAX);
        body.attributes.texts.get(number as usize).cloned().unwrap_or_default()
    };
    (0..body.soup.triangles.len())
        .map(|t| (body.soup.corners(t as u32).map(|p| p.to_array()), text(t)))
        .collect()
}

/// The same triangle from its smallest corner on, whichever way around it goes.
fn without_order(mut corners: [[f64; 3]; 3]) -> [[u64; 3]; 3] {
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    corners.map(|p| p.map(f64::to_bits))
}

#[test]
fn a_painted_project_is_mended_part_by_part_and_keeps_its_paint() {
    let bytes = painted(true);
    let before = run(Operation::Verify, &bytes, &Options::default()).report.input_certificate;
    assert!(!before.is_printable());
    assert_eq!(before.parts, Some(4));
    let answer = run(Operation::Repair, &bytes, &Options::default());
    let new = result(&answer);
    let certificate = answer.report.certificate.clone().unwrap();
    assert!(certificate.is_printable(), "{:?}", certificate.witnesses);
    let budget = Budget::unlimited();
    let depth = Depth::Count { samples: 4 };
    let again = certify_parts(new, Encoding::ThreeMf, &ReadOptions::default(), depth, &budget).unwrap();
    assert_eq!(again, certificate, "the certificate is about the bytes that are returned");
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    let outcomes: Vec<_> = answer.report.parts.iter().map(|part| part.report.outcome.unwrap()).collect();
    assert_eq!(outcomes, [Outcome::Repaired, Outcome::Repaired, Outcome::Repaired, Outcome::Identical]);

    for name in [
        "[Content_Types].xml",
        "_rels/.rels",
        "3D/Objects/valid.model",
        "Metadata/plate_1.png",
        "Metadata/model_settings.config",
    ] {
        assert_eq!(part(new, name), part(&bytes, name), "{name}");
    }
    let (old_project, new_project) = (project(&bytes), project(new));
    let facts = |project: &Project| -> Vec<(String, String, u32, u32)> {
        let of = |body: &meshmend::formats::threemf::Body| {
            (body.part.clone(), body.name.clone(), body.object, body.instances)
        };
        project.bodies.iter().map(of).collect()
    };
    assert_eq!(facts(&old_project), facts(&new_project));

    for name in ["open", "crossed", "valid"] {
        let (old, new) = (marks(&bytes, name), marks(new, name));
        let mut untouched = 0;
        for (corners, text) in &old {
            let same = new.iter().find(|(other, _)| without_order(*other) == without_order(*corners));
            let Some((_, found)) = same else { continue };
            assert_eq!(found, text, "{name} {corners:?}");
            untouched += 1;
        }
        assert!(untouched >= 10, "{name}: {untouched} of {}", old.len());
        assert!(new.iter().all(|(_, text)| text.contains("paint_color")), "{name}: no triangle is bare");
    }
    // A shell that is turned around keeps the paint of whole triangles; that of a divided one cannot be turned.
    let (old, new_marks) = (marks(&bytes, "turned"), marks(new, "turned"));
    for (t, (corners, text)) in old.iter().enumerate() {
        let (_, found) =
            new_marks.iter().find(|(other, _)| without_order(*other) == without_order(*corners)).unwrap();
        assert_eq!(found, if t == 3 { "" } else { text.as_str() });
    }
    let counts = answer.report.parts[2].attributes.unwrap();
    assert_eq!((counts.kept, counts.from_face, counts.from_nearest, counts.lost), (11, 0, 0, 1));
    assert!(counts.lost_area_share > 0.0 && counts.kept_area_share + counts.lost_area_share > 0.999_999);
    // What was mended is valid now and comes back as it is.
    let second = run(Operation::Repair, new, &Options::default());
    assert_eq!(second.report.outcome, Some(Outcome::Identical));
}

#[test]
fn volumes_that_a_slicer_notes_are_parts_and_their_ranges_are_kept_up() {
    let (mut points, mut triangles) = cuboid([0.0; 3], [10.0; 3]);
    triangles.pop();
    // The second volume overlaps the first, as the parts of an assembly may.
    let (more, second) = cuboid([5.0; 3], [15.0; 3]);
    points.extend(more);
    triangles.extend(second.iter().map(|t| t.map(|v| v + 8)));
    let paint = |t: usize| format!(" slic3rpe:mmu_segmentation=\"{}\"", if t < 11 { "4" } else { "8" });
    let object = format!("<object id=\"1\" type=\"model\">{}</object>", mesh(&points, &triangles, paint));
    let config = "<?xml version=\"1.0\"?>\n<config>\n <object id=\"1\">\n  <volume firstid=\"0\" lastid=\"10\">\n\
        <metadata type=\"volume\" key=\"name\" value=\"first\"/>\n  </volume>\n  <volume firstid=\"11\" lastid=\"22\">\n\
        <metadata type=\"volume\" key=\"name\" value=\"second\"/>\n  </volume>\n </object>\n</config>\n";
    let bytes = package(&[
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model("", &object, "<item objectid=\"1\"/>").as_bytes()),
        ("Metadata/Slic3r_PE_model.config", config.as_bytes()),
    ]);
    let names: Vec<String> = project(&bytes).bodies.into_iter().map(|body| body.name).collect();
    assert_eq!(names, ["first", "second"]);
    let answer = run(Operation::Repair, &bytes, &Options::default());
    let new = result(&answer);
    assert!(answer.report.certificate.clone().unwrap().is_printable());
    let outcomes: Vec<_> = answer.report.parts.iter().map(|part| part.report.outcome.unwrap()).collect();
    assert_eq!(outcomes, [Outcome::Repaired, Outcome::Identical]);
    let written = String::from_utf8(part(new, "Metadata/Slic3r_PE_model.config")).unwrap();
    assert_eq!(
        written,
        config.replace("\"10\"", "\"11\"").replace("\"11\" lastid=\"22\"", "\"12\" lastid=\"23\"")
    );
    let again = project(new);
    assert_eq!(again.bodies[1].soup.triangles.len(), 12);
    assert!(marks(new, "second").iter().all(|(_, text)| text == "slic3rpe:mmu_segmentation=\"8\""));
    assert!(marks(new, "first").iter().all(|(_, text)| text == "slic3rpe:mmu_segmentation=\"4\""));
}

/// A box with one volume that is printed and one that is not, as two kinds of projects note it.
pub(crate) fn box_with_pocket(purposes: [&str; 2]) -> [Vec<u8>; 2] {
    let [(body, sides), (pocket, _)] = [cuboid([0.0; 3], [10.0; 3]), cuboid([4.0; 3], [6.0; 3])];
    let second = || sides.iter().map(|t| t.map(|v| v + 8));
    let of_both = mesh(
        &[&body[..], &pocket].concat(),
        &sides.iter().copied().chain(second()).collect::<Vec<_>>(),
        |_| String::new(),
    );
    let objects = format!("<object id=\"1\" type=\"model\">{of_both}</object>");
    let [prusa, bambu] = purposes;
    let ranges = format!(
        "<config><object id=\"1\"><volume firstid=\"0\" lastid=\"11\"/><volume firstid=\"12\" lastid=\"23\">\
         <metadata type=\"volume\" key=\"volume_type\" value=\"{prusa}\"/><metadata type=\"volume\" key=\"name\" \
         value=\"pocket\"/></volume></object></config>"
    );
    let of_ranges = package(&[
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model("", &objects, "<item objectid=\"1\"/>").as_bytes()),
        ("Metadata/Slic3r_PE_model.config", ranges.as_bytes()),
    ]);
    let [body, pocket] = [body, pocket].map(|points| mesh(&points, &sides, |_| String::new()));
    let objects = format!(
        "<object id=\"1\">{body}</object><object id=\"2\">{pocket}</object><object id=\"3\"><components>\
         <component objectid=\"1\"/><component objectid=\"2\"/></components></object>"
    );
    let parts = format!(
        "<config><object id=\"3\"><part id=\"1\" subtype=\"normal_part\"/><part id=\"2\" subtype=\"{bambu}\"/></object></config>"
    );
    let of_components = package(&[
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model("", &objects, "<item objectid=\"3\"/>").as_bytes()),
        ("Metadata/model_settings.config", parts.as_bytes()),
    ]);
    [of_ranges, of_components]
}

#[test]
fn what_is_no_material_is_no_part_of_one_mesh_and_that_is_told() {
    for (purposes, name) in [
        (["NegativeVolume", "negative_part"], "negative_parts"),
        (["ParameterModifier", "modifier_part"], "modifier_parts"),
        (["SupportBlocker", "support_enforcer"], "support_parts"),
    ] {
        for bytes in box_with_pocket(purposes) {
            let options = Options { output_format: Some(Format::Stl), ..Options::default() };
            let answer = run(Operation::Repair, &bytes, &options);
            let certificate = answer.report.certificate.clone().unwrap();
            assert_eq!((certificate.triangles, certificate.shells.len()), (12, 1), "{name}");
            let left_out = answer.report.actions.iter().find(|action| action.step == "left_out").unwrap();
            assert_eq!(left_out.changes, [(name, 1)]);
            let separate = run(Operation::Repair, &bytes, &Options::default());
            assert_eq!((separate.report.outcome, separate.report.parts.len()), (Some(Outcome::Identical), 2));
        }
    }
    for bytes in box_with_pocket(["ModelPart", "normal_part"]) {
        let options = Options { output_format: Some(Format::Stl), ..Options::default() };
        let certificate = run(Operation::Convert, &bytes, &options).report.certificate.unwrap();
        assert_eq!(certificate.triangles, 24);
    }
}

#[test]
fn settings_of_a_slicer_that_cannot_be_read_are_told_and_refuse_no_file() {
    for settings in ["<config><object id=\"1\"", "<!DOCTYPE a><config/>"] {
        let bytes = package(&[
            ("_rels/.rels", RELATIONSHIPS.as_bytes()),
            ("3D/3dmodel.model", simple().as_bytes()),
            ("Metadata/model_settings.config", settings.as_bytes()),
        ]);
        let remarks = project(&bytes).remarks;
        assert!(
            remarks.iter().any(|remark| remark.contains("model_settings.config")),
            "{settings}: {remarks:?}"
        );
        let answer = run(Operation::Repair, &bytes, &Options::default());
        assert_eq!(answer.report.outcome, Some(Outcome::Identical));
    }
}

#[test]
fn metadata_of_names_in_no_namespace_are_told_and_kept() {
    let names = ["Title", "slic3rpe:Version3mf", "Colour of the week"];
    let metadata = names.map(|name| format!("<metadata name=\"{name}\">x</metadata>")).concat();
    let bytes = file(&simple().replace("<resources>", &format!("{metadata}<resources>")));
    let answer = run(Operation::Repair, &bytes, &Options::default());
    let [remark] = &answer.report.remarks[..] else { panic!("one remark: {:?}", answer.report.remarks) };
    assert_eq!(names.map(|name| remark.contains(name)), [false, false, true], "{remark}");
    assert_eq!(answer.report.outcome, Some(Outcome::Identical));
}

#[test]
fn holes_of_several_parts_are_told_together_and_patches_are_a_share_of_all() {
    let open = |without: usize| {
        let (points, mut triangles) = cuboid([0.0; 3], [10.0; 3]);
        triangles.truncate(triangles.len() - without);
        mesh(&points, &triangles, |_| String::new())
    };
    let objects = [1, 2].map(|id| format!("<object id=\"{id}\" type=\"model\">{}</object>", open(id)));
    let items = "<item objectid=\"1\"/><item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 40 0 0\"/>";
    let bytes = file(&model("unit=\"millimeter\"", &objects.concat(), items));
    for operation in [Operation::Repair, Operation::FillHoles] {
        let answer = run(operation, &bytes, &Options::default());
        assert!(answer.report.certificate.as_ref().unwrap().is_printable());
        let filling = answer.report.filling.as_ref().unwrap();
        let told = |hole: &HoleOutcome| (hole.part, hole.loops.clone(), hole.edges);
        let loops: Vec<_> = filling.holes.iter().map(told).collect();
        assert_eq!(loops, [(Some(0), vec![0], 3), (Some(1), vec![0], 4)]);
        // One and two of the 24 triangles, all of one size.
        assert!((filling.interpolated_area_share - 3.0 / 24.0).abs() < 1e-12, "{filling:?}");
        let of_parts: Vec<usize> = answer
            .report
            .parts
            .iter()
            .map(|part| part.report.filling.as_ref().unwrap().holes.len())
            .collect();
        assert_eq!(of_parts, [1, 1]);
    }
}

#[test]
fn the_same_file_gives_the_same_bytes_with_one_thread_and_with_many() {
    let bytes = painted(true);
    let of = |threads| {
        let repair = || pipeline::run(Operation::Repair, &bytes, &Options::default(), &Budget::unlimited());
        let answer = meshmend::par::with_threads(threads, repair).unwrap();
        (answer.output, answer.report.certificate, answer.report.work_used)
    };
    let (one, two, eight) = (of(1), of(2), of(8));
    assert_eq!(one, two);
    assert_eq!(one, eight);
}

#[test]
fn parts_become_one_solid_only_when_that_is_asked() {
    let cube = format!("<object id=\"1\" type=\"model\">{}</object>", plain_cuboid(2.0));
    let build = "<item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 1 1 1\"/>";
    let bytes = file(&model("", &cube, build));
    let of = |operation, parts| run(operation, &bytes, &Options { parts, ..Options::default() });
    assert!(of(Operation::Verify, SolidParts::Separate).report.input_certificate.is_printable());
    assert!(!of(Operation::Verify, SolidParts::Together).report.input_certificate.is_printable());
    assert_eq!(of(Operation::Repair, SolidParts::Separate).report.outcome, Some(Outcome::Identical));
    for parts in [SolidParts::Together, SolidParts::Union] {
        let united = of(Operation::Repair, parts);
        let certificate = united.report.certificate.clone().unwrap();
        assert!(certificate.is_printable());
        assert_eq!(certificate.shells.len(), 1, "{parts:?}");
        assert!((certificate.shells[0].volume - 15.0).abs() < 1e-9);
        assert_eq!(project(result(&united)).bodies.len(), 1);
    }
}

#[test]
fn parts_that_were_mended_and_needed_no_union_are_told_as_mended() {
    let (points, mut open) = cuboid([0.0; 3], [1.0; 3]);
    open.pop();
    let objects = format!("<object id=\"1\">{}</object>", mesh(&points, &open, |_| String::new()));
    let build = "<item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>";
    let bytes = file(&model("", &objects, build));
    let answer = run(Operation::Repair, &bytes, &Options { parts: SolidParts::Union, ..Options::default() });
    let report = &answer.report;
    assert_eq!(report.outcome, Some(Outcome::Repaired));
    assert_eq!(report.parts[0].report.outcome, Some(Outcome::Repaired));
    assert!(report.actions.iter().any(|action| action.step == "fill-holes"));
    assert!(report.before.as_ref().is_some_and(|before| before.counts.boundary_edges > 0));
    let certificate = report.certificate.as_ref().unwrap();
    assert!(certificate.is_printable());
    assert_ne!(certificate.sha256, report.input.sha256);
    assert_eq!(project(result(&answer)).bodies[0].soup.triangles.len(), 12, "the mended part, still once");
    assert!(report.remarks.iter().all(|remark| !remark.contains("takes the place")), "{:?}", report.remarks);
    // A file whose parts are sound and apart is the very file that came.
    let sound = file(&model("", &format!("<object id=\"1\">{}</object>", plain_cuboid(1.0)), build));
    let answer = run(Operation::Repair, &sound, &Options { parts: SolidParts::Union, ..Options::default() });
    assert_eq!(answer.report.outcome, Some(Outcome::Identical));
    assert_eq!(answer.output.unwrap().bytes, None);
}

#[test]
fn a_lattice_beside_a_mesh_is_kept_only_with_it() {
    let (points, mut open) = cuboid([0.0; 3], [1.0; 3]);
    open.pop();
    let beams = "<b:beamlattice radius=\"1\" minlength=\"1\"><b:beams/></b:beamlattice></mesh>";
    let of = |triangles: &[[u32; 3]]| {
        let mesh = mesh(&points, triangles, |_| String::new()).replace("</mesh>", beams);
        let object = format!("<object id=\"1\">{mesh}</object>");
        let extension = "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\"";
        let bytes = file(&model(extension, &object, "<item objectid=\"1\"/>"));
        run(Operation::Repair, &bytes, &Options::default()).report.remarks
    };
    let kept = "/3D/3dmodel.model holds a beam lattice: kept where the mesh stays as it is, and not judged.";
    assert_eq!(of(&cuboid([0.0; 3], [1.0; 3]).1), [kept]);
    let remarks = of(&open);
    assert_eq!((remarks.len(), &remarks[0][..]), (2, kept));
    assert!(remarks[1].ends_with("is left out: beamlattice."), "{remarks:?}");
}

#[test]
fn a_part_that_cannot_be_mended_is_named_and_nothing_is_dropped() {
    let flat = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"2\" y=\"0\" z=\"0\"/>\
                </vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>";
    let objects = format!(
        "<object id=\"1\">{}</object><object id=\"2\" name=\"flat\">{flat}</object>",
        plain_cuboid(1.0)
    );
    let bytes = file(&model("", &objects, "<item objectid=\"1\"/><item objectid=\"2\"/>"));
    let answer = run(Operation::Repair, &bytes, &Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Refused));
    assert!(answer.output.is_none());
    assert_eq!(answer.report.parts[1].facts.name, "flat");
    assert!(answer.report.parts[1].report.refusal.is_some());
}

#[test]
fn supports_and_surfaces_need_no_solid_and_are_kept() {
    let (points, mut open) = cuboid([0.0; 3], [1.0; 3]);
    open.pop();
    let sheet = mesh(&points, &open, |_| String::new());
    let objects = format!(
        "<object id=\"1\">{}</object><object id=\"2\" type=\"surface\">{sheet}</object><object id=\"3\" type=\"support\">{sheet}</object>",
        plain_cuboid(1.0)
    );
    let bytes =
        file(&model("", &objects, "<item objectid=\"1\"/><item objectid=\"2\"/><item objectid=\"3\"/>"));
    let all = project(&bytes);
    assert_eq!(
        all.bodies.iter().map(|b| b.kind).collect::<Vec<_>>(),
        [ObjectKind::Model, ObjectKind::Surface, ObjectKind::Support]
    );
    let answer = run(Operation::Repair, &bytes, &Options::default());
    assert_eq!(answer.report.outcome, Some(Outcome::Identical));
    assert_eq!(answer.report.certificate.unwrap().parts, Some(1));
    assert_eq!(answer.report.remarks.len(), 2, "{:?}", answer.report.remarks);
}

#[test]
fn what_has_no_solid_is_never_called_one() {
    let bytes = file(&model("", "", ""));
    let verified = run(Operation::Verify, &bytes, &Options::default());
    assert!(!verified.report.input_certificate.is_printable());
    let repaired = run(Operation::Repair, &bytes, &Options::default());
    assert_eq!(repaired.report.outcome, Some(Outcome::Refused));
    assert!(repaired.output.is_none());
}

#[test]
fn a_unit_that_contradicts_the_file_and_options_for_one_mesh_are_refused() {
    let bytes = file(&simple());
    let inches = Options { units: Some(Units::Inch), ..Options::default() };
    let failed = |operation, bytes: &[u8], options: &Options| {
        pipeline::run(operation, bytes, options, &Budget::unlimited()).unwrap_err()
    };
    assert!(matches!(failed(Operation::Analyze, &bytes, &inches), Failure::Unreadable(_)));
    let to_inches = Options { output_units: Some(Units::Inch), ..Options::default() };
    let failure = failed(Operation::Repair, &bytes, &to_inches);
    assert!(matches!(failure, Failure::NotApplicable { option: "output_units", .. }), "{failure}");
    let failure = failed(Operation::Modeller, &painted(false), &Options::default());
    assert!(matches!(failure, Failure::NotApplicable { option: "operators", .. }), "{failure}");
}

#[test]
fn every_operation_gives_a_project_back() {
    let bytes = painted(false);
    for operation in [Operation::Simplify, Operation::CutStitch, Operation::FillHoles, Operation::Convert] {
        let answer = run(operation, &bytes, &Options { require: Some(Require::None), ..Options::default() });
        let output = answer.output.as_ref().unwrap_or_else(|| panic!("{operation:?}"));
        let new = output.bytes.as_deref().unwrap_or(&bytes);
        let names: Vec<String> = project(new).bodies.into_iter().map(|body| body.name).collect();
        assert_eq!(names, ["open", "crossed", "turned", "valid"], "{operation:?}");
    }
}

/// Many damaged variants of a project: an answer or an error, never a panic, and whatever is returned is what its
/// certificate says.
#[test]
fn damaged_projects_are_answered_or_refused() {
    let whole = painted(true);
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let text = String::from_utf8(part(&whole, "3D/3dmodel.model")).unwrap();
    for i in 0..crate::support::cases(150, 3000) {
        let bytes = if i % 3 == 0 {
            let mut bytes = whole.clone();
            for _ in 0..=random(3) {
                let at = random(bytes.len());
                bytes[at] = random(256) as u8;
            }
            bytes
        } else {
            let mut text = text.clone().into_bytes();
            for _ in 0..=random(3) {
                let (at, length) = (random(text.len()), random(12));
                let end = (at + length).min(text.len());
                text.drain(at..end);
            }
            package(&[("_rels/.rels", RELATIONSHIPS.as_bytes()), ("3D/3dmodel.model", &text)])
        };
        let budget = Budget::new(StopFlag::default(), 50_000_000, 256 << 20);
        let _ = pipeline::run(Operation::Analyze, &bytes, &Options::default(), &budget);
        if let Ok(project) = read_project(&bytes, &ReadOptions::default(), &Budget::unlimited()) {
            for body in &project.bodies {
                assert_eq!(body.soup.check(), Vec::<String>::new());
            }
            let scene =
                read(&bytes, Encoding::ThreeMf, &ReadOptions::default(), &Budget::unlimited()).unwrap();
            assert_eq!(scene.check(), Vec::<String>::new());
        }
    }
}

/// Width and pixels of a picture.
fn pixels(png: &[u8]) -> (usize, Vec<[u8; 3]>) {
    let mut read = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
    let mut bytes = vec![0; read.output_buffer_size().unwrap()];
    read.next_frame(&mut bytes).unwrap();
    (read.info().width as usize, bytes.chunks(3).map(|p| [p[0], p[1], p[2]]).collect())
}

#[test]
fn a_picture_shows_every_part_at_its_places_with_the_defects_of_its_own() {
    const RIM: [u8; 3] = [242, 115, 28];
    const CROSSING: [u8; 3] = [224, 53, 127];
    let (points, triangles) = cuboid([0.0; 3], [10.0; 3]);
    // Without its lid, whole, and inside out.
    let open: Vec<_> = triangles.iter().filter(|t| t.iter().any(|&v| v < 4)).copied().collect();
    assert_eq!(open.len(), 10);
    let inverted: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let object = |(id, triangles): (usize, &Vec<[u32; 3]>)| {
        format!("<object id=\"{id}\" type=\"model\">{}</object>", mesh(&points, triangles, |_| String::new()))
    };
    let objects: String = (1..).zip([&open, &triangles, &inverted]).map(object).collect();
    let item =
        |(id, x): (u32, f64)| format!("<item objectid=\"{id}\" transform=\"1 0 0 0 1 0 0 0 1 {x} 0 0\"/>");
    let build: String = [(1, 0.0), (2, 5.0), (3, 30.0), (3, 50.0)].map(item).concat();
    let bytes = file(&model("unit=\"millimeter\"", &objects, &build));
    let picture = |operation: Operation, parts: SolidParts| {
        let choices = PictureChoices { views: vec![View::Front], ..PictureChoices::default() };
        let options = Options { parts, picture: Some(choices), ..Options::default() };
        let answer = run(operation, &bytes, &options);
        pixels(&answer.picture.expect("a picture"))
    };
    let (width, drawn) = picture(Operation::Render, SolidParts::Separate);
    assert_eq!((width, drawn.len()), (480, 480 * 360));
    let is_blue = |x: usize| matches!(drawn[180 * width + x], [r, _, b] if b > r.saturating_add(40));
    // 60 mm are nine tenths of the width: a box is 72 pixels wide, and the first begins 24 pixels from the left.
    assert_eq!(
        [60, 276, 420].map(is_blue),
        [false, true, true],
        "both places of the part that is inside out"
    );
    assert!(drawn[..180 * width].contains(&RIM));
    assert!(!drawn.contains(&CROSSING), "parts that meet are no defect of either");
    assert_eq!(
        picture(Operation::Analyze, SolidParts::Separate),
        (width, drawn),
        "the same beside another operation"
    );
    let (_, together) = picture(Operation::Render, SolidParts::Together);
    assert!(together.contains(&CROSSING) && together.contains(&RIM));
    let (width, mended) = picture(Operation::Repair, SolidParts::Separate);
    assert_eq!(width, 960, "before and after");
    assert!(mended.iter().any(|&[r, g, b]| g > r.saturating_add(50) && g > b), "the new lid");
}

#[test]
fn a_project_that_is_too_large_to_be_drawn_is_mended_without_a_picture_and_says_so() {
    let object = format!("<object id=\"1\" type=\"model\">{}</object>", plain_cuboid(10.0));
    let bytes = file(&model("unit=\"millimeter\"", &object, &"<item objectid=\"1\"/>".repeat(3)));
    let mut options = Options { picture: Some(PictureChoices::default()), ..Options::default() };
    assert!(run(Operation::Repair, &bytes, &options).picture.is_some());
    options.read.limits.triangles_max = 35;
    let answer = run(Operation::Repair, &bytes, &options);
    assert_eq!((answer.report.outcome, answer.picture), (Some(Outcome::Identical), None));
    assert!(
        answer.report.remarks.iter().any(|remark| remark.contains("no picture")),
        "{:?}",
        answer.report.remarks
    );
    let failure = pipeline::run(Operation::Render, &bytes, &options, &Budget::unlimited()).unwrap_err();
    assert!(
        matches!(failure, Failure::Unreadable(error) if matches!(error.kind, ReadErrorKind::TooLarge { .. }))
    );
}

#[test]
fn more_meshes_than_the_limit_are_refused_by_name() {
    let (points, triangles) = cuboid([0.0; 3], [1.0; 3]);
    let tetrahedron = mesh(&points[..4], &triangles[..1], |_| String::new());
    let objects = |count: u32| -> String {
        (1..=count).map(|id| format!("<object id=\"{id}\">{tetrahedron}</object>")).collect()
    };
    assert_eq!(project(&file(&model("", &objects(10_000), ""))).bodies.len(), 10_000);
    let error = error_of(&file(&model("", &objects(10_001), "")));
    let limit_name = match error.kind {
        ReadErrorKind::TooLarge { limit_name, .. } => limit_name,
        other => panic!("{other:?}"),
    };
    assert_eq!(limit_name, "meshes_max");
}

#[test]
fn a_defect_of_several_parts_has_no_more_witnesses_than_asked() {
    let (points, triangles) = cuboid([0.0; 3], [1.0; 3]);
    let open = mesh(&points, &triangles[1..], |_| String::new());
    let objects: String = (1..=3).map(|id| format!("<object id=\"{id}\">{open}</object>")).collect();
    let items: String = (1..=3).map(|id| format!("<item objectid=\"{id}\"/>")).collect();
    let bytes = file(&model("", &objects, &items));
    for samples in [1, 2, 10] {
        let options = Options { samples: Some(samples), ..Options::default() };
        let before = run(Operation::Analyze, &bytes, &options).report.before.unwrap();
        let rims = before.findings.iter().find(|finding| finding.code == DefectCode::BoundaryLoop).unwrap();
        assert_eq!((rims.count, rims.witnesses.len()), (3, samples.min(3)));
    }
}
