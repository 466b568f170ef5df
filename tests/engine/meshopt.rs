//! glTF with meshopt compression: the files of `tests/meshopt_files`, whose streams an encoder of others made, beside the same
//! models without it; and streams that are cut, changed or claim too much.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::{Budget, StopFlag, Stopped};
use meshmend::formats::{Encoding, Format, ReadError, ReadErrorKind, ReadLimits, ReadOptions, read, sniff};
use meshmend::geom::DVec3;
use meshmend::mesh::{Color, Soup};
use meshmend::pipeline::{Answer, Operation, Options, Outcome, run};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXT: &str = "EXT_meshopt_compression";
const KHR: &str = "KHR_meshopt_compression";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshopt_files")
}

fn bytes_of(name: &str) -> Vec<u8> {
    std::fs::read(folder().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A budget that holds what a file of its size may take.
fn budget_for(bytes: &[u8]) -> Budget {
    Budget::new(StopFlag::default(), u64::MAX, (1 << 20) + 200 * bytes.len() as u64)
}

fn soup_of(bytes: &[u8]) -> Result<Soup, ReadError> {
    let soup = read(bytes, sniff(bytes, None)?, &ReadOptions::default(), &budget_for(bytes))?;
    assert_eq!(soup.check(), Vec::<String>::new());
    Ok(soup)
}

fn file(name: &str) -> Soup {
    soup_of(&bytes_of(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A GLB as its document and its binary chunk.
#[derive(Clone)]
struct Glb {
    document: Value,
    bin: Vec<u8>,
}

impl Glb {
    fn of(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let begin = 20 + word(12);
        Self {
            document: serde_json::from_slice(&bytes[20..begin]).unwrap(),
            bin: bytes[begin + 8..begin + 8 + word(begin)].to_vec(),
        }
    }

    fn named(name: &str) -> Self {
        Self::of(&bytes_of(name))
    }

    fn bytes(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec(&self.document).unwrap();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut out = b"glTF".to_vec();
        let length = 28 + text.len() + self.bin.len();
        [2, length as u32, text.len() as u32].iter().for_each(|word| out.extend(word.to_le_bytes()));
        out.extend(b"JSON");
        out.extend(text);
        out.extend((self.bin.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(&self.bin);
        out
    }

    fn error(&self) -> String {
        soup_of(&self.bytes()).unwrap_err().to_string()
    }

    /// The extensions by which views are compressed, each with the number of its view.
    fn streams(&self) -> Vec<(usize, Value)> {
        let views = self.document["bufferViews"].as_array().unwrap().iter().enumerate();
        let stream = |(i, view): (usize, &Value)| {
            [EXT, KHR].iter().find_map(|name| Some((i, view["extensions"].get(name)?.clone())))
        };
        views.filter_map(stream).collect()
    }

    /// The extension of the view number `view`.
    fn stream_mut(&mut self, view: usize) -> &mut Value {
        let extensions = self.document["bufferViews"][view]["extensions"].as_object_mut().unwrap();
        extensions.values_mut().next().unwrap()
    }

    /// Where the stream of a view is in the binary chunk.
    fn range(stream: &Value) -> std::ops::Range<usize> {
        let number = |key: &str| stream[key].as_u64().unwrap_or(0) as usize;
        number("byteOffset")..number("byteOffset") + number("byteLength")
    }
}

/// Every GLB of the folder with a compressed view.
fn compressed_files() -> Vec<(String, Glb)> {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".glb"))
        .collect();
    names.sort();
    let files: Vec<_> = names.into_iter().map(|name| (name.clone(), Glb::named(&name))).collect();
    let compressed: Vec<_> = files.into_iter().filter(|(_, glb)| !glb.streams().is_empty()).collect();
    assert!(compressed.len() > 20);
    compressed
}

/// The corners of a triangle with their texture coordinates, begun with the vertex of the smallest number: the encoder of
/// triangles turns them.
fn triangle(soup: &Soup, t: usize) -> Vec<(u32, Option<[u64; 2]>)> {
    let corners = soup.triangles[t];
    let points = soup.texture.of_triangle(t).map(|points| points.map(|uv| uv.map(f64::to_bits)));
    let least = (0..3).min_by_key(|&k| corners[k]).unwrap();
    (0..3).map(|k| (least + k) % 3).map(|k| (corners[k], points.map(|points| points[k]))).collect()
}

fn assert_same_triangles(found: &Soup, want: &Soup, name: &str) {
    assert_eq!(found.triangles.len(), want.triangles.len(), "{name}");
    for t in 0..want.triangles.len() {
        assert_eq!(triangle(found, t), triangle(want, t), "{name}: triangle {t}");
    }
}

fn bits(soup: &Soup) -> Vec<[u64; 3]> {
    soup.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

#[test]
fn a_compressed_torus_is_the_torus_bit_for_bit() {
    let want = file("torus.glb");
    assert_eq!((want.positions.len(), want.triangles.len(), want.vertex_colors.len()), (300, 600, 300));
    for name in [
        "torus-ext.glb",
        "torus-ext.gltf",
        "torus-khr.glb",
        "torus-16-bit.glb",
        "torus-sequence.glb",
        "torus-sequence-16-bit.glb",
        "torus-interleaved.glb",
        "torus-fallback.glb",
    ] {
        let found = file(name);
        assert_eq!(bits(&found), bits(&want), "{name}");
        assert_eq!(found.vertex_colors, want.vertex_colors, "{name}");
        assert_same_triangles(&found, &want, name);
    }
    for name in ["torus-sequence.glb", "torus-sequence-16-bit.glb"] {
        assert_eq!(file(name).triangles, want.triangles, "{name}: sequences are not turned");
    }
}

#[test]
fn quantized_coordinates_ramps_and_noise_come_back_bit_for_bit() {
    for (name, plain) in [
        ("quantized-ext.glb", "quantized.glb"),
        ("quantized-khr.glb", "quantized.glb"),
        ("ramp-khr.glb", "ramp.glb"),
        ("spread-ext.glb", "spread.glb"),
        ("spread-khr.glb", "spread.glb"),
    ] {
        let (found, want) = (file(name), file(plain));
        assert_eq!(bits(&found), bits(&want), "{name}");
        assert_same_triangles(&found, &want, name);
    }
}

/// How far the corners of the triangles of two files are apart at most. Vertices that a filter has moved onto each other are one.
fn apart(found: &Soup, want: &Soup) -> f64 {
    assert_eq!(found.triangles.len(), want.triangles.len());
    let corners =
        (0..want.triangles.len() as u32).flat_map(|t| found.corners(t).into_iter().zip(want.corners(t)));
    corners.map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f64::max)
}

#[test]
fn filters_are_undone_within_their_precision() {
    let vectors = file("vectors.glb");
    for (name, bits) in [
        ("vectors-6-bit.glb", 6),
        ("vectors-8-bit.glb", 8),
        ("vectors-12-bit.glb", 12),
        ("vectors-16-bit.glb", 16),
    ] {
        // Half a step in two coordinates of the octahedron and one in the third, at most 3^0.5 times that on the sphere, and one of
        // the output.
        let step = 1.0 / f64::from((1 << (bits - 1)) - 1);
        let output = if bits <= 8 { 1.0 / 127.0 } else { 1.0 / 32767.0 };
        let gap = apart(&file(name), &vectors);
        assert!(gap <= 4.5f64.sqrt() * step + output, "{name}: {gap}");
        assert!(gap > 0.0, "{name}");
    }
    let quaternions = file("quaternions.glb");
    for (name, bits) in [("quaternions-12-bit.glb", 12), ("quaternions-16-bit.glb", 16)] {
        // Half a step in each of three components moves the fourth by no more than three halves: it is the greatest.
        let gap = apart(&file(name), &quaternions);
        assert!(gap <= 1.5 / f64::from((1 << (bits - 1)) - 1) + 1.0 / 32767.0, "{name}: {gap}");
        assert!(gap > 0.0, "{name}");
    }
    let torus = file("torus.glb");
    let exponential = file("torus-exponential.glb");
    let largest = 7.0;
    for (found, want) in exponential.positions.iter().zip(&torus.positions) {
        // Of 15 bits one is the sign; the exponent is that of the greatest component.
        assert!((*found - *want).abs().max_element() <= largest / f64::from(1 << 13), "{found} {want}");
    }
    assert_eq!(exponential.texture.points.len(), torus.texture.points.len());
    for (found, want) in exponential.texture.points.iter().zip(&torus.texture.points) {
        assert!((0..2).all(|k| (found[k] - want[k]).abs() <= 1.0 / f64::from(1 << 10)), "{found:?} {want:?}");
    }
    for (name, steps) in [("torus-color-8.glb", 255.0), ("torus-color-16.glb", 65535.0)] {
        for (found, want) in file(name).vertex_colors.iter().zip(&torus.vertex_colors) {
            let (Some(Color::Linear(a, a4)), Some(Color::Linear(b, b4))) = (found, want) else {
                panic!("{name}: {found:?} {want:?}")
            };
            let gap = (0..3).map(|k| (a[k] - b[k]).abs()).chain([(a4.unwrap() - b4.unwrap()).abs()]);
            // Chrominance is rounded in two components, of which both are added.
            assert!(gap.fold(0.0, f32::max) <= 3.0 / steps, "{name}: {found:?} {want:?}");
        }
    }
}

#[test]
fn a_field_of_89_blocks_is_the_field() {
    let (width, height) = (150, 151);
    let soup = file("field-khr.glb");
    let point = |i: usize| {
        let (x, y) = ((i % width) as i32, (i / width) as i32);
        let z = x * (width as i32 - x) - y * (height as i32 - y) + x * y % 7;
        DVec3::new(f64::from(100 * x), f64::from(100 * y), f64::from(z))
    };
    let want: Vec<DVec3> = (0..width * height).map(point).collect();
    assert!(soup.positions == want);
    let cells = (0..(height - 1) * (width - 1)).map(|i| i / (width - 1) * width + i % (width - 1));
    let split = |v: usize| [[v, v + 1, v + width + 1], [v, v + width + 1, v + width]];
    let triangles: Vec<[u32; 3]> = cells.flat_map(split).map(|t| t.map(|v| v as u32)).collect();
    assert_same_triangles(&soup, &Soup { triangles, ..Soup::default() }, "field");
}

#[test]
fn documents_of_gltfpack_are_the_torus_within_a_step_of_their_coordinates() {
    let answer =
        |name: &str| run(Operation::Analyze, bytes_of(name), &Options::default(), &Budget::unlimited());
    let want = answer("torus.glb").unwrap().report;
    for name in ["gltfpack-ext.glb", "gltfpack-khr.glb", "gltfpack-floats.glb"] {
        let found = answer(name).unwrap().report;
        let (found_certificate, want_certificate) = (&found.input_certificate, &want.input_certificate);
        assert!(found_certificate.is_printable(), "{name}");
        assert_eq!(
            (found_certificate.vertices, found_certificate.triangles, found_certificate.euler_characteristic),
            (want_certificate.vertices, want_certificate.triangles, want_certificate.euler_characteristic)
        );
        let bounds =
            |report: &meshmend::pipeline::Report| report.before.as_ref().unwrap().measures.bounds.unwrap();
        let (found, want) = (bounds(&found), bounds(&want));
        // 14 bits of a length of 14.
        let step = 14.0 / f64::from(1 << 14);
        assert!((found.min - want.min).abs().max_element() <= step, "{name}");
        assert!((found.max - want.max).abs().max_element() <= step, "{name}");
    }
}

fn answer(operation: Operation, bytes: &[u8], options: &Options) -> Answer {
    run(operation, bytes, options, &Budget::unlimited()).unwrap()
}

#[test]
fn operations_take_a_compressed_file_as_the_same_one_without_compression() {
    let (plain, compressed) = (bytes_of("torus.glb"), bytes_of("torus-sequence.glb"));
    let analyzed = |bytes: &[u8]| {
        let report = answer(Operation::Analyze, bytes, &Options::default()).report;
        let c = report.input_certificate;
        (c.p0, c.p1, c.p2, c.vertices, c.triangles, c.readings)
    };
    assert_eq!(analyzed(&compressed), analyzed(&plain));
    // A valid file comes back as it is, with its compression.
    let mended = answer(Operation::Repair, &compressed, &Options::default());
    assert_eq!((mended.report.outcome, mended.output.unwrap().bytes), (Some(Outcome::Identical), None));
    for format in [Format::Stl, Format::Ply, Format::Gltf] {
        let options = Options { output_format: Some(format), ..Options::default() };
        let converted =
            |bytes: &[u8]| answer(Operation::Convert, bytes, &options).output.unwrap().bytes.unwrap();
        assert!(converted(&compressed) == converted(&plain), "{format:?}");
    }
}

#[test]
fn a_repaired_file_is_written_without_compression_and_the_report_says_so() {
    let open = |name: &str| {
        let mut glb = Glb::named(name);
        let accessors = glb.document["accessors"].as_array_mut().unwrap();
        let count = accessors.last().unwrap()["count"].as_u64().unwrap();
        accessors.last_mut().unwrap()["count"] = (count - 3).into();
        glb.bytes()
    };
    let of = |bytes: &[u8]| {
        let answer = answer(Operation::Repair, bytes, &Options::default());
        assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
        let told = answer.report.actions.iter().find(|action| action.step == "left_out");
        (told.map(|action| action.changes.clone()), answer.output.unwrap().bytes.unwrap())
    };
    let (told, mended) = of(&open("torus-sequence.glb"));
    assert_eq!(told, Some(vec![("compressed_views", 4)]));
    let (nothing, of_plain) = of(&open("torus.glb"));
    assert_eq!(nothing, None);
    assert!(mended == of_plain);
    assert_eq!(Glb::of(&mended).document.get("extensionsUsed"), None);
}

#[test]
fn a_stream_that_is_cut_or_goes_on_is_an_error_with_its_place() {
    let mut random = Random::new(31);
    for (name, glb) in compressed_files() {
        for (view, stream) in glb.streams() {
            let range = Glb::range(&stream);
            let length = range.len();
            let some = (0..cases(12, 400)).map(|_| random.below(length));
            let cuts = some.chain([0, 1, length - 1]).collect::<Vec<_>>();
            for cut in cuts {
                let mut broken = glb.clone();
                broken.stream_mut(view)["byteLength"] = cut.into();
                let error = broken.error();
                assert!(error.contains(&format!("/bufferViews/{view}/extensions")), "{name} {cut}: {error}");
            }
            let mut longer = glb.clone();
            let more = 1 + random.below(40);
            longer.stream_mut(view)["byteOffset"] = glb.bin.len().into();
            longer.stream_mut(view)["byteLength"] = (length + more).into();
            longer.bin.extend_from_slice(&glb.bin[range]);
            longer.bin.resize(longer.bin.len() + more, 0);
            let error = longer.error();
            assert!(error.contains("of the stream of /bufferViews/"), "{name} {more}: {error}");
        }
    }
}

#[test]
fn a_stream_with_changed_bytes_is_an_error_or_a_sound_soup() {
    let mut random = Random::new(32);
    let (mut errors, mut soups) = (0, 0);
    for (_, glb) in compressed_files() {
        for (_, stream) in glb.streams() {
            let range = Glb::range(&stream);
            let count = if range.len() > 10_000 { cases(4, 40) } else { cases(60, 4000) };
            for _ in 0..count {
                let mut broken = glb.clone();
                for _ in 0..1 + random.below(3) {
                    let at = range.start + random.below(range.len());
                    broken.bin[at] ^= match random.below(2) {
                        0 => 1u8 << random.below(8),
                        _ => random.below(256) as u8,
                    };
                }
                match soup_of(&broken.bytes()) {
                    Ok(_) => soups += 1,
                    Err(error) => {
                        assert!(!matches!(error.kind, ReadErrorKind::Stopped(_)), "{error}");
                        errors += 1;
                    }
                }
            }
        }
    }
    assert!(errors > 100 && soups > 100, "{errors} {soups}");
}

/// A file of triangles whose positions are a stream of `bytes` for `count` elements of 12 bytes.
fn positions_of(bytes: &[u8], count: u64) -> Glb {
    let mut glb = Glb::named("spread-khr.glb");
    glb.bin = bytes.to_vec();
    glb.bin.resize(bytes.len().next_multiple_of(4), 0);
    glb.document["accessors"][0]["count"] = count.into();
    glb.document["bufferViews"][0]["byteLength"] = (12 * count).into();
    let stream = glb.stream_mut(0);
    stream["byteOffset"] = 0.into();
    stream["byteLength"] = bytes.len().into();
    stream["count"] = count.into();
    glb
}

/// The shortest stream of so many elements of 12 bytes: all are as the one before.
fn shortest(count: u64) -> Vec<u8> {
    let mut bytes = vec![0xa1];
    bytes.resize(1 + 3 * count.div_ceil(256) as usize, 0b1010_1010);
    bytes.resize(bytes.len() + 24, 0);
    bytes
}

#[test]
fn what_a_small_stream_claims_is_held_against_its_length_and_the_limits() {
    for count in [257, 3_000, 1 << 20, 1 << 31, 1 << 40, u64::MAX / 12] {
        let error = positions_of(&shortest(256), count).error();
        let at = "elements at /bufferViews/0/extensions/KHR_meshopt_compression";
        assert!(error.contains("found a stream of 28 bytes") && error.contains(at), "{count}: {error}");
    }
    for mode in ["TRIANGLES", "INDICES"] {
        let mut glb = Glb::named("torus-ext.glb");
        glb.document["accessors"][3]["count"] = 300_000_000.into();
        glb.document["bufferViews"][3]["byteLength"] = 1_200_000_000.into();
        let stream = glb.stream_mut(3);
        stream["count"] = 300_000_000.into();
        stream["mode"] = mode.into();
        assert!(glb.error().contains("elements at /bufferViews/3/extensions/"), "{mode}: {}", glb.error());
    }
    // What the stream can hold is read where the limits and the memory allow it.
    let count = 300_000;
    let bytes = positions_of(&shortest(count), count).bytes();
    assert!(bytes.len() < 6_000);
    let with = |limits: ReadLimits, bytes_max: u64| {
        let budget = Budget::new(StopFlag::default(), u64::MAX, bytes_max);
        let soup = read(&bytes, Encoding::Glb, &ReadOptions { limits, ..ReadOptions::default() }, &budget);
        assert!(budget.bytes_peak() <= bytes_max);
        soup.map(|soup| soup.face_count).map_err(|error| error.kind)
    };
    assert_eq!(with(ReadLimits::default(), u64::MAX), Ok(100_000));
    for bytes_max in [100_000, 4_000_000, 9_000_000] {
        let stopped = with(ReadLimits::default(), bytes_max);
        assert!(matches!(stopped, Err(ReadErrorKind::Stopped(Stopped::Memory { .. }))), "{stopped:?}");
    }
    let few = ReadLimits { triangles_max: 99_999, ..ReadLimits::default() };
    let limit = |kind| matches!(kind, Err(ReadErrorKind::TooLarge { limit_name: "triangles_max", .. }));
    assert!(limit(with(few, 1 << 20)), "before there is room for them");
}

#[test]
fn a_view_is_decoded_once_however_often_it_is_placed() {
    let mut glb = Glb::named("torus-ext.glb");
    let work = |glb: &Glb| {
        let budget = Budget::unlimited();
        let soup = read(&glb.bytes(), Encoding::Glb, &ReadOptions::default(), &budget).unwrap();
        (soup.triangles.len(), budget.work_used())
    };
    let once = work(&glb);
    assert!(once.1 > 0);
    glb.document["nodes"] = (0..50).map(|i| json!({ "mesh": 0, "translation": [20 * i, 0, 0] })).collect();
    glb.document["scenes"][0]["nodes"] = (0..50).collect();
    assert_eq!(work(&glb), (50 * once.0, once.1));
}

#[test]
fn a_view_against_the_rules_of_the_extension_is_refused_with_its_place() {
    let with = |view: usize, key: &str, value: Value| {
        let mut glb = Glb::named("torus-ext.glb");
        glb.stream_mut(view)[key] = value;
        glb.error()
    };
    for (view, key, value) in [
        (0, "mode", json!("POINTS")),
        (0, "mode", Value::Null),
        (0, "filter", json!("SQUARE")),
        (0, "filter", json!("OCTAHEDRAL")),
        (0, "filter", json!("QUATERNION")),
        (3, "filter", json!("EXPONENTIAL")),
        (0, "byteStride", json!(10)),
        (0, "byteStride", json!(260)),
        (0, "byteStride", json!(0)),
        (3, "byteStride", json!(8)),
        (3, "count", json!(1799)),
        (0, "count", json!(-1)),
        (0, "buffer", json!(7)),
    ] {
        let error = with(view, key, value.clone());
        let is_missing = value.is_null() && error.contains("the member `mode`");
        assert!(is_missing || error.contains(&format!("/{EXT}/{key}")), "{key} {value}: {error}");
    }
    for (key, value) in [("count", json!(299)), ("count", json!(u64::MAX)), ("byteStride", json!(16))] {
        let error = with(0, key, value.clone());
        assert!(error.contains("found 3600 at /bufferViews/0/byteLength"), "{key} {value}: {error}");
    }
    assert!(with(0, "buffer", json!(1)).contains("a buffer without bytes at /buffers/1"));
    assert!(with(0, "byteOffset", json!(1u64 << 40)).contains("in buffer 0 for /bufferViews/0/extensions/"));
    let mut headers = Glb::named("torus-ext.glb");
    for (view, stream) in headers.streams() {
        let at = Glb::range(&stream).start;
        let header = std::mem::replace(&mut headers.bin[at], 0x00);
        let error = headers.error();
        let place = format!("found 0x00 at byte 0 of the stream of /bufferViews/{view}/extensions/{EXT}");
        assert!(error.contains(&place), "{error}");
        headers.bin[at] = header;
    }
    // Of views that no triangle needs nothing is wrong.
    let mut unused = Glb::named("torus-ext.glb");
    unused.document["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("COLOR_0");
    unused.stream_mut(1)["mode"] = json!("POINTS");
    assert_eq!(soup_of(&unused.bytes()).unwrap().triangles.len(), 600);
}
