//! Projects of which one mesh is made: negative parts are taken away, and other formats get each part as an object with its name.

use crate::threemf::{box_with_pocket, cuboid, file, mesh, model, run};
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Format, ReadOptions, read};
use meshmend::mesh::{NO_OBJECT, Soup};
use meshmend::pipeline::{Answer, Operation, Options, Outcome, SolidParts};

fn options(parts: SolidParts, output_format: Option<Format>) -> Options {
    Options { parts, output_format, ..Options::default() }
}

fn soup_of(answer: &Answer) -> Soup {
    let output = answer.output.as_ref().unwrap();
    let bytes = output.bytes.as_ref().unwrap();
    read(bytes, output.encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

fn volume(answer: &Answer) -> f64 {
    let certificate = answer.report.certificate.as_ref().unwrap();
    assert!(certificate.is_printable());
    certificate.shells.iter().map(|shell| shell.volume).sum()
}

/// The names of actions that count negative parts as left out.
fn left_out(answer: &Answer) -> u64 {
    let changes = answer.report.actions.iter().flat_map(|action| &action.changes);
    changes.filter(|(name, _)| *name == "negative_parts").map(|(_, count)| count).sum()
}

#[test]
fn negative_parts_are_taken_away_where_parts_are_united() {
    // A cube of 10 with a pocket of 2 inside of it.
    for bytes in box_with_pocket(["NegativeVolume", "negative_part"]) {
        for (format, per_millimetre) in [(None, 1.0), (Some(Format::Stl), 1.0), (Some(Format::Glb), 1e-3)] {
            let answer = run(Operation::Repair, &bytes, &options(SolidParts::Union, format));
            assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{format:?}");
            let unit: f64 = per_millimetre;
            assert!((volume(&answer) / unit.powi(3) - 992.0).abs() < 1e-3, "{format:?}");
            assert_eq!(answer.report.certificate.as_ref().unwrap().shells.len(), 2);
            assert_eq!(left_out(&answer), 0);
            assert!(answer.report.actions.iter().any(|action| action.step == "difference"));
            assert!(answer.report.further_inputs.is_empty() && answer.report.operation == Operation::Repair);
        }
        // As one mesh they stay out of it, and that is told.
        let together = run(Operation::Repair, &bytes, &options(SolidParts::Together, Some(Format::Stl)));
        assert_eq!((volume(&together), left_out(&together)), (1000.0, 1));
    }
}

/// Two cubes as build items, of which the first has a negative part from `low` to `high`.
fn two_items(low: [f64; 3], high: [f64; 3]) -> Vec<u8> {
    with_negative(cuboid(low, high))
}

/// The same with a negative part that lacks a triangle.
fn open_negative() -> Vec<u8> {
    let (points, mut triangles) = cuboid([5.0; 3], [15.0; 3]);
    triangles.pop();
    with_negative((points, triangles))
}

fn with_negative(negative: (Vec<[f64; 3]>, Vec<[u32; 3]>)) -> Vec<u8> {
    let part = |id: u32, (points, triangles): (Vec<[f64; 3]>, Vec<[u32; 3]>)| {
        format!(
            "<object id=\"{id}\" type=\"model\" name=\"part {id}\">{}</object>",
            mesh(&points, &triangles, |_| String::new())
        )
    };
    let cube = || cuboid([0.0; 3], [10.0; 3]);
    let objects = [part(1, cube()), part(2, negative), part(4, cube())].concat()
        + "<object id=\"3\"><components><component objectid=\"1\"/><component objectid=\"2\"/></components></object>";
    let build = "<item objectid=\"3\"/><item objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 1 20 0 0\"/>";
    let model = model("unit=\"millimeter\"", &objects, build);
    crate::threemf::with_settings(
        &model,
        "<config><object id=\"3\"><part id=\"2\" subtype=\"negative_part\"/></object></config>",
    )
}

#[test]
fn a_negative_part_takes_nothing_from_items_that_it_does_not_belong_to() {
    let near =
        run(Operation::Repair, &two_items([5.0, 5.0, 5.0], [15.0; 3]), &options(SolidParts::Union, None));
    assert!((volume(&near) - 1875.0).abs() < 1e-6);
    let far =
        run(Operation::Repair, &two_items([5.0, 5.0, 5.0], [25.0; 3]), &options(SolidParts::Union, None));
    assert!((volume(&far) - 2000.0).abs() < 1e-6, "it reaches the second item");
    assert!(
        far.report.remarks.iter().any(|remark| remark.contains("not taken away")),
        "{:?}",
        far.report.remarks
    );
    // All that there is.
    let all = run(Operation::Repair, &two_items([-1.0; 3], [11.0; 3]), &options(SolidParts::Union, None));
    assert!((volume(&all) - 1000.0).abs() < 1e-6);
    assert!(all.report.remarks.iter().all(|remark| !remark.contains("not taken away")));
    // One that lacks a triangle is mended first, and the account says so.
    let mended = run(Operation::Repair, &open_negative(), &options(SolidParts::Union, None));
    assert!((volume(&mended) - 1875.0).abs() < 1e-6);
    assert_eq!(mended.report.outcome, Some(Outcome::Repaired));
    assert!(mended.report.actions.len() > near.report.actions.len(), "{:?}", mended.report.actions);
}

#[test]
fn other_formats_get_each_part_as_an_object_with_its_name() {
    let bytes = two_items([4.0; 3], [6.0; 3]);
    for format in [Format::Obj, Format::Gltf] {
        let answer = run(Operation::Convert, &bytes, &options(SolidParts::Separate, Some(format)));
        let soup = soup_of(&answer);
        let names: Vec<&[u8]> = soup.objects.names.iter().map(|name| &name.object[..]).collect();
        assert_eq!(names, [b"part 1", b"part 4"], "{format:?}");
        let is_right =
            |t: u32| soup.corners(t).iter().all(|p| p.x >= if format == Format::Obj { 20.0 } else { 0.015 });
        assert!((0..24).all(|t| (soup.objects.of(soup.face_of(t)) == Some(1)) == is_right(t)));
        assert!(!answer.report.remarks.iter().any(|remark| remark.contains("names of parts")));
    }
    let stl = run(Operation::Convert, &bytes, &options(SolidParts::Separate, Some(Format::Stl)));
    assert!(
        stl.report.remarks.iter().any(|remark| remark.contains("names of parts (3)")),
        "{:?}",
        stl.report.remarks
    );
    // One part with volumes: their names are those of groups.
    let [ranges, _] = box_with_pocket(["ModelPart", "normal_part"]);
    let obj = soup_of(&run(Operation::Convert, &ranges, &options(SolidParts::Separate, Some(Format::Obj))));
    let groups: Vec<&[u8]> = obj.objects.names.iter().map(|name| &name.group[..]).collect();
    assert_eq!((groups, &obj.objects.of_face[11..13]), (vec![&b"pocket"[..]], &[NO_OBJECT, 0][..]));
    let one = file(&model(
        "",
        "<object id=\"1\"><mesh><vertices/><triangles/></mesh></object>",
        "<item objectid=\"1\"/>",
    ));
    assert!(
        read(&one, Encoding::ThreeMf, &ReadOptions::default(), &Budget::unlimited())
            .is_ok_and(|s| s.objects.is_empty())
    );
}
