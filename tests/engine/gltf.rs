//! glTF: what is read of it, what is refused, and what comes back.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::{cube, cuboid};
use meshmend::budget::{Budget, StopFlag, Stopped};
use meshmend::formats::{
    Encoding, Format, ReadError, ReadErrorKind, ReadLimits, ReadOptions, read, sniff, write,
};
use meshmend::geom::DVec3;
use meshmend::mesh::{Color, NO_POINT, ObjectName, Soup};
use meshmend::pipeline::{Answer, Operation, Options, Outcome, Units, run};
use serde_json::{Map, Value, json};

const U8: u32 = 5121;
const I16: u32 = 5122;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// A file under way.
#[derive(Default)]
struct File {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    members: Map<String, Value>,
}

impl File {
    fn view(&mut self, bytes: &[u8]) -> usize {
        let begin = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": begin, "byteLength": bytes.len() }));
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors
            .push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|c| c.to_le_bytes()).collect();
        let size = ["SCALAR", "VEC2", "VEC3", "VEC4"].iter().position(|&name| name == kind).unwrap() + 1;
        self.accessor(&bytes, F32, kind, values.len() / size)
    }

    fn positions(&mut self, points: &[[f32; 3]]) -> usize {
        self.floats("VEC3", points.as_flattened())
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor(&bytes, U32, "SCALAR", indices.len())
    }

    /// One mesh of this primitive, one node, one scene.
    fn with_primitive(mut self, primitive: &Value) -> Self {
        self.set("meshes", json!([{ "primitives": [primitive] }]));
        self.set("nodes", json!([{ "mesh": 0 }]));
        self.set("scenes", json!([{ "nodes": [0] }]));
        self
    }

    fn set(&mut self, key: &str, value: Value) {
        self.members.insert(key.into(), value);
    }

    fn document(&self, uri: Option<String>) -> Vec<u8> {
        let mut document = Map::from_iter([("asset".to_owned(), json!({ "version": "2.0" }))]);
        document.extend(self.members.clone());
        document.insert("accessors".into(), self.accessors.clone().into());
        document.insert("bufferViews".into(), self.views.clone().into());
        if !self.members.contains_key("buffers") {
            let mut buffer = json!({ "byteLength": self.bin.len() });
            if let Some(uri) = uri {
                buffer["uri"] = uri.into();
            }
            document.insert("buffers".into(), json!([buffer]));
        }
        serde_json::to_vec(&document).unwrap()
    }

    fn glb(&self) -> Vec<u8> {
        let mut text = self.document(None);
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + text.len() + 8 + self.bin.len();
        let mut out = b"glTF".to_vec();
        for value in [2, length as u32, text.len() as u32] {
            out.extend(value.to_le_bytes());
        }
        out.extend(b"JSON");
        out.extend(text);
        out.extend((self.bin.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(&self.bin);
        out
    }

    fn gltf(&self) -> Vec<u8> {
        self.document(Some(format!("data:application/octet-stream;base64,{}", base64_of(&self.bin))))
    }
}

fn base64_of(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let letters = |group: &[u8]| {
        let bits =
            group.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - group.len()));
        let letter = |k: usize| {
            if k <= group.len() { LETTERS[(bits >> (18 - 6 * k)) as usize & 63] as char } else { '=' }
        };
        (0..4).map(letter).collect::<String>()
    };
    bytes.chunks(3).map(letters).collect()
}

/// The corners of the triangles of `soup`, each with vertices of its own.
fn corners_of(soup: &RawSoup) -> Vec<[f32; 3]> {
    soup.triangles.as_flattened().iter().map(|&v| soup.positions[v as usize].map(|c| c as f32)).collect()
}

/// A file of these triangles without indices, as exporters write flat shading.
fn split(soup: &RawSoup) -> File {
    let mut file = File::default();
    let positions = file.positions(&corners_of(soup));
    file.with_primitive(&json!({ "attributes": { "POSITION": positions } }))
}

fn open_cube() -> RawSoup {
    let mut soup = cube();
    soup.triangles.truncate(soup.triangles.len() - 1);
    soup
}

fn soup_of(bytes: &[u8]) -> Result<Soup, ReadError> {
    let budget = Budget::new(StopFlag::default(), u64::MAX, (1 << 20) + 200 * bytes.len() as u64);
    let soup = read(bytes, sniff(bytes, None)?, &ReadOptions::default(), &budget)?;
    assert_eq!(soup.check(), Vec::<String>::new());
    Ok(soup)
}

fn error_of(file: &File) -> String {
    soup_of(&file.glb()).unwrap_err().to_string()
}

fn triangles_of(soup: &Soup) -> Vec<[DVec3; 3]> {
    (0..soup.triangles.len() as u32).map(|t| soup.corners(t)).collect()
}

fn answer(operation: Operation, bytes: &[u8], options: &Options) -> Answer {
    run(operation, bytes, options, &Budget::unlimited()).unwrap()
}

fn converted(bytes: &[u8], format: Format) -> Vec<u8> {
    let options = Options { output_format: Some(format), ..Options::default() };
    let answer = answer(Operation::Convert, bytes, &options);
    answer.output.unwrap().bytes.unwrap_or_else(|| bytes.to_vec())
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// A file of the square with more in its primitive.
fn square_with(fill: impl FnOnce(&mut File) -> Value) -> File {
    let mut file = File::default();
    let positions = file.positions(&SQUARE);
    let mut primitive = json!({ "attributes": { "POSITION": positions } });
    let more = fill(&mut file);
    for (key, value) in more.as_object().unwrap() {
        match value.as_object() {
            Some(members) if key == "attributes" => {
                members.iter().for_each(|(k, v)| primitive["attributes"][k] = v.clone());
            }
            _ => primitive[key] = value.clone(),
        }
    }
    file.with_primitive(&primitive)
}

#[test]
fn a_solid_whose_vertices_are_split_is_valid_and_comes_back_byte_for_byte() {
    let file = split(&cube());
    for (bytes, encoding) in [(file.glb(), Encoding::Glb), (file.gltf(), Encoding::Gltf)] {
        assert_eq!(sniff(&bytes, None), Ok(encoding));
        let answer = answer(Operation::Repair, &bytes, &Options::default());
        assert_eq!(answer.report.outcome, Some(Outcome::Identical));
        let output = answer.output.unwrap();
        assert_eq!((output.bytes, output.encoding), (None, encoding));
        let certificate = answer.report.certificate.unwrap();
        assert!(certificate.is_printable());
        assert_eq!((certificate.vertices, certificate.triangles), (8, 12));
    }
}

#[test]
fn a_split_solid_is_judged_as_the_same_triangles_in_stl() {
    for soup in [cube(), open_cube(), cube().with(&cube().moved([0.5; 3])), cuboid([1.0, 2.0, 3.0])] {
        let of = |bytes: &[u8]| {
            let report = answer(Operation::Analyze, bytes, &Options::default()).report;
            let c = report.input_certificate;
            let codes: Vec<_> = report.before.unwrap().findings.iter().map(|f| (f.code, f.count)).collect();
            (c.p0, c.p1, c.p2, c.violations, c.vertices, c.euler_characteristic, c.readings, codes)
        };
        assert_eq!(of(&split(&soup).glb()), of(&encode(&soup, Encoding::StlBinary)));
    }
}

#[test]
fn a_broken_solid_is_repaired_and_the_result_verifies_in_both_encodings() {
    let file = split(&open_cube());
    for bytes in [file.glb(), file.gltf()] {
        let encoding = sniff(&bytes, None).unwrap();
        let mended = answer(Operation::Repair, &bytes, &Options::default());
        assert_eq!(mended.report.outcome, Some(Outcome::Repaired));
        let output = mended.output.unwrap();
        assert_eq!(output.encoding, encoding);
        let bytes = output.bytes.unwrap();
        let verified = answer(Operation::Verify, &bytes, &Options::default()).report;
        assert!(verified.input_certificate.is_printable());
        assert_eq!(mended.report.certificate.unwrap().sha256, verified.input.sha256);
        let again = answer(Operation::Repair, &bytes, &Options::default());
        assert_eq!(again.report.outcome, Some(Outcome::Identical));
    }
}

#[test]
fn indices_may_have_one_two_or_four_bytes_or_be_left_out() {
    let want = [[0, 1, 2], [2, 3, 0]];
    for (component, bytes) in [(U8, 1), (U16, 2), (U32, 4)] {
        let file = square_with(|file| {
            let bytes: Vec<u8> =
                want.as_flattened().iter().flat_map(|&v: &u32| v.to_le_bytes()[..bytes].to_vec()).collect();
            json!({ "indices": file.accessor(&bytes, component, "SCALAR", 6) })
        });
        assert_eq!(soup_of(&file.glb()).unwrap().triangles, want);
        assert_eq!(soup_of(&file.gltf()).unwrap().triangles, want);
    }
    let plain = square_with(|_| json!({}));
    assert_eq!(soup_of(&plain.glb()).unwrap().triangles, [[0, 1, 2]], "a fourth vertex begins no triangle");
    let signed = square_with(|file| json!({ "indices": file.accessor(&[0; 6], I16, "SCALAR", 3) }));
    assert!(error_of(&signed).contains("found 5122 at /accessors/1/componentType"), "{}", error_of(&signed));
}

#[test]
fn strips_and_fans_are_triangles_with_one_side_outside() {
    let of = |mode: u32, indices: &[u32]| {
        let file = square_with(|file| json!({ "mode": mode, "indices": file.indices(indices) }));
        soup_of(&file.glb()).unwrap().triangles
    };
    assert_eq!(of(5, &[0, 1, 3, 2]), [[0, 1, 3], [1, 2, 3]]);
    assert_eq!(of(6, &[0, 1, 2, 3]), [[1, 2, 0], [2, 3, 0]]);
    // A vertex twice turns a corner.
    assert_eq!(of(5, &[0, 1, 3, 3, 3, 1, 2]), [[0, 1, 3], [3, 1, 2]]);
    let points = square_with(|_| json!({ "mode": 1 }));
    assert_eq!(soup_of(&points.glb()).unwrap_err().kind, ReadErrorKind::Empty);
    let wrong = square_with(|_| json!({ "mode": 7 }));
    assert!(error_of(&wrong).contains("found 7 at /meshes/0/primitives/0/mode"), "{}", error_of(&wrong));
}

#[test]
fn an_index_without_a_vertex_is_a_face_at_fault_and_not_a_vertex_of_another_mesh() {
    let mut file = File::default();
    let positions = file.positions(&SQUARE);
    let indices = file.indices(&[0, 1, 2, 0, 2, 4, 0, 2, u32::MAX]);
    let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
    file.set("meshes", json!([{ "primitives": [primitive, primitive] }]));
    let soup = soup_of(&file.glb()).unwrap();
    assert_eq!((soup.triangles.len(), soup.face_count, soup.face_faults.len()), (2, 6, 4));
}

#[test]
fn a_sparse_accessor_puts_elements_in_the_place_of_others() {
    let sparse = |file: &mut File, base: Option<usize>, index: u16, count: u64| {
        let indices = file.view(&index.to_le_bytes());
        let values = file.view(&[5f32, 6.0, 7.0].iter().flat_map(|c| c.to_le_bytes()).collect::<Vec<_>>());
        let mut accessor = json!({ "componentType": F32, "count": 3, "type": "VEC3", "sparse": {
            "count": count,
            "indices": { "bufferView": indices, "componentType": U16 },
            "values": { "bufferView": values },
        }});
        if let Some(base) = base {
            accessor["bufferView"] = base.into();
        }
        file.accessors.push(accessor);
        file.accessors.len() - 1
    };
    let of = |is_based: bool, index: u16, count: u64| {
        let mut file = File::default();
        let points: Vec<u8> = SQUARE[..3].as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
        let base = is_based.then(|| file.view(&points));
        let positions = sparse(&mut file, base, index, count);
        file.with_primitive(&json!({ "attributes": { "POSITION": positions } }))
    };
    let moved = DVec3::new(5.0, 6.0, 7.0);
    let based = soup_of(&of(true, 1, 1).glb()).unwrap();
    assert_eq!(based.corners(0), [DVec3::ZERO, moved, DVec3::new(1.0, 1.0, 0.0)]);
    let bare = soup_of(&of(false, 2, 1).glb()).unwrap();
    assert_eq!(bare.corners(0), [DVec3::ZERO, DVec3::ZERO, moved]);
    let error = error_of(&of(true, 3, 1));
    assert!(error.contains("found the index 3 at /accessors/0/sparse/indices"), "{error}");
    assert!(error_of(&of(true, 0, 4)).contains("found 4 at /accessors/0/sparse/count"));
    assert!(error_of(&of(true, 0, 3)).contains("ends here"), "three values are not there");
}

#[test]
fn quantized_positions_are_scaled_back_by_their_node() {
    let mut file = File::default();
    let bytes: Vec<u8> =
        [0i16, 0, 0, 0, 32767, 0, 0, 0, -32768, 16384, 0, 0].iter().flat_map(|c| c.to_le_bytes()).collect();
    let view = file.view(&bytes);
    file.views[view]["byteStride"] = 8.into();
    for is_normalized in [false, true] {
        file.accessors.push(json!({
            "bufferView": view, "componentType": I16, "normalized": is_normalized, "count": 3, "type": "VEC3"
        }));
    }
    let of = |file: &mut File, accessor: usize, scale: f64| {
        let primitive = json!({ "attributes": { "POSITION": accessor } });
        file.set("meshes", json!([{ "primitives": [primitive] }]));
        file.set("nodes", json!([{ "mesh": 0, "scale": [scale, scale, scale] }]));
        file.set("extensionsRequired", json!(["KHR_mesh_quantization"]));
        soup_of(&file.glb()).unwrap().corners(0)
    };
    let whole = of(&mut file, 0, 0.5);
    assert_eq!(whole, [DVec3::ZERO, DVec3::X * 16383.5, DVec3::new(-16384.0, 8192.0, 0.0)]);
    let shares = of(&mut file, 1, 2.0);
    assert_eq!(shares, [DVec3::ZERO, DVec3::X * 2.0, DVec3::new(-2.0, 2.0 * 16384.0 / 32767.0, 0.0)]);
}

#[test]
fn nodes_put_meshes_where_they_are_once_for_each() {
    let mut file = File::default();
    let positions = file.positions(&SQUARE[..3]);
    file.set(
        "meshes",
        json!([{ "name": "sail", "primitives": [{ "attributes": { "POSITION": positions } }] }]),
    );
    file.set(
        "nodes",
        json!([
            { "children": [1, 2], "translation": [10.0, 0.0, 0.0] },
            { "mesh": 0, "scale": [2.0, 1.0, 1.0], "name": "wide" },
            { "mesh": 0, "rotation": [0.0, 0.0, 0.70710677, 0.70710677] },
            { "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1] },
            { "mesh": 0, "translation": [100.0, 0.0, 0.0] },
        ]),
    );
    file.set("scenes", json!([{ "nodes": [4] }, { "nodes": [0, 3] }]));
    file.set("scene", json!(1));
    let bytes = file.glb();
    let soup = soup_of(&bytes).unwrap();
    let point = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let near =
        |found: [DVec3; 3], want: [DVec3; 3]| found.iter().zip(want).all(|(a, b)| a.distance(b) < 1e-12);
    let triangles = triangles_of(&soup);
    assert_eq!(triangles.len(), 3);
    assert_eq!(triangles[0], [point(10.0, 0.0, 0.0), point(12.0, 0.0, 0.0), point(12.0, 1.0, 0.0)]);
    assert!(near(triangles[1], [point(10.0, 0.0, 0.0), point(10.0, 1.0, 0.0), point(9.0, 1.0, 0.0)]));
    // A mirror turns a triangle around, so that its outside stays.
    assert_eq!(triangles[2], [point(0.0, 0.0, 3.0), point(-1.0, 1.0, 3.0), point(-1.0, 0.0, 3.0)]);
    assert_eq!(soup.left_out, [("meshes_outside_of_the_scene", 1)]);
    let name = |object: &str| ObjectName { object: object.into(), group: b"sail".to_vec() };
    assert_eq!(soup.objects.names, ["wide", "", ""].map(name));
    assert_eq!(soup.objects.of_face, [0, 1, 2]);
    // Without scenes all nodes are shown, and without nodes all meshes.
    file.members.remove("scenes");
    file.members.remove("scene");
    assert_eq!(soup_of(&file.glb()).unwrap().triangles.len(), 4);
    file.members.remove("nodes");
    assert_eq!(soup_of(&file.glb()).unwrap().triangles.len(), 1);
}

#[test]
fn a_placed_solid_stays_one() {
    let mut file = split(&cube());
    file.set(
        "nodes",
        json!([{ "mesh": 0, "rotation": [0.1, 0.2, 0.3, 0.9273618], "scale": [0.3, 0.7, 1.1] }]),
    );
    let report = answer(Operation::Verify, &file.glb(), &Options::default()).report;
    assert!(report.input_certificate.is_printable(), "{:?}", report.input_certificate.witnesses);
    assert_eq!(report.input_certificate.readings.len(), 2, "as f64 and as f32");
}

#[test]
fn nodes_that_go_around_or_come_twice_are_refused_and_deep_ones_are_read() {
    let of = |nodes: Value| {
        let mut file = File::default();
        let positions = file.positions(&SQUARE[..3]);
        file.set("meshes", json!([{ "primitives": [{ "attributes": { "POSITION": positions } }] }]));
        file.set("nodes", nodes);
        file.set("scenes", json!([{ "nodes": [0] }]));
        soup_of(&file.glb())
    };
    for nodes in [
        json!([{ "children": [0] }]),
        json!([{ "children": [1] }, { "children": [0], "mesh": 0 }]),
        json!([{ "children": [1, 1] }, { "mesh": 0 }]),
    ] {
        let error = of(nodes).unwrap_err().to_string();
        assert!(error.contains("a node that comes again at /nodes/"), "{error}");
    }
    let error = of(json!([{ "children": [7] }])).unwrap_err().to_string();
    assert!(error.contains("found 7 at /nodes/0/children/0; expected an index into /nodes of 1"), "{error}");
    let deep = 20_000;
    let chain: Vec<Value> = (0..deep)
        .map(|i| if i + 1 < deep { json!({ "children": [i + 1] }) } else { json!({ "mesh": 0 }) })
        .collect();
    assert_eq!(of(chain.into()).unwrap().triangles.len(), 1);
}

#[test]
fn what_a_small_file_claims_is_not_believed() {
    let file = |accessor: Value| {
        let mut file = File::default();
        file.view(&[0; 36]);
        file.accessors.push(accessor);
        file.with_primitive(&json!({ "attributes": { "POSITION": 0 } }))
    };
    let vec3 = |count: Value| json!({ "componentType": F32, "count": count, "type": "VEC3" });
    for count in [
        json!(4_000_000_000u64),
        json!(200_000),
        json!(u64::MAX),
        json!(1e300),
        json!(-1),
        json!(2.5),
        json!("3"),
    ] {
        let error = error_of(&file(vec3(count.clone())));
        assert!(error.contains("/accessors/0/count"), "{count}: {error}");
    }
    for member in ["byteOffset", "count"] {
        for value in [4u64, 1 << 31, 1 << 32, u64::MAX / 3, u64::MAX] {
            let mut accessor = vec3(json!(3));
            accessor["bufferView"] = 0.into();
            accessor[member] = value.into();
            let error = error_of(&file(accessor));
            assert!(
                error.contains("ends here") || error.contains("/accessors/0/count"),
                "{member} {value}: {error}"
            );
        }
    }
    for member in ["byteOffset", "byteLength", "byteStride", "buffer"] {
        for value in [37u64, 1 << 32, u64::MAX] {
            let mut accessor = vec3(json!(3));
            accessor["bufferView"] = 0.into();
            let mut file = file(accessor);
            file.views[0][member] = value.into();
            assert!(soup_of(&file.glb()).is_err(), "{member} {value}");
        }
    }
}

#[test]
fn many_instances_of_a_mesh_are_counted_before_they_are_made() {
    let mut file = split(&cube());
    let nodes: Vec<Value> = (0..100).map(|i| json!({ "mesh": 0, "translation": [2 * i, 0, 0] })).collect();
    file.set("nodes", nodes.into());
    file.members.remove("scenes");
    let bytes = file.glb();
    assert_eq!(soup_of(&bytes).unwrap().triangles.len(), 1200);
    let with = |limits: ReadLimits, bytes_max: u64| {
        let budget = Budget::new(StopFlag::default(), u64::MAX, bytes_max);
        let options = ReadOptions { limits, ..ReadOptions::default() };
        read(&bytes, Encoding::Glb, &options, &budget).unwrap_err().kind
    };
    let limits = ReadLimits { triangles_max: 1199, ..ReadLimits::default() };
    let too_large = with(limits, u64::MAX);
    assert!(matches!(too_large, ReadErrorKind::TooLarge { limit_name: "triangles_max", actual: 1200, .. }));
    let stopped = with(ReadLimits::default(), 100_000);
    assert!(matches!(stopped, ReadErrorKind::Stopped(Stopped::Memory { .. })), "{stopped:?}");
}

#[test]
fn what_cannot_be_read_is_refused_by_name() {
    let draco = square_with(|file| {
        file.accessors[0].as_object_mut().unwrap().remove("bufferView");
        json!({ "extensions": { "KHR_draco_mesh_compression": { "bufferView": 0 } } })
    });
    assert!(error_of(&draco).contains("glTF with Draco compression"), "{}", error_of(&draco));
    let fallback =
        square_with(|_| json!({ "extensions": { "KHR_draco_mesh_compression": { "bufferView": 0 } } }));
    assert_eq!(soup_of(&fallback.glb()).unwrap().triangles.len(), 1);
    let mut external = square_with(|_| json!({}));
    external.set("buffers", json!([{ "byteLength": 48, "uri": "part.bin" }]));
    assert!(
        error_of(&external).contains("the external file `part.bin` at /buffers/0/uri"),
        "{}",
        error_of(&external)
    );
    let mut broken = square_with(|_| json!({}));
    broken.set("buffers", json!([{ "byteLength": 48, "uri": "data:;base64,AAA*" }]));
    assert!(error_of(&broken).contains("broken base64"), "{}", error_of(&broken));
    let mut required = square_with(|_| json!({}));
    required.set("extensionsRequired", json!(["KHR_materials_unlit", "ACME_holes"]));
    assert!(error_of(&required).contains("the required extension `ACME_holes` at /extensionsRequired/1"));
    let mut instances = square_with(|_| json!({}));
    instances.set("nodes", json!([{ "mesh": 0, "extensions": { "EXT_mesh_gpu_instancing": {} } }]));
    assert!(error_of(&instances).contains("EXT_mesh_gpu_instancing"));
    let mut old = square_with(|_| json!({}));
    old.set("asset", json!({ "version": "1.0" }));
    assert!(error_of(&old).contains("version `1.0` at /asset"), "{}", error_of(&old));
    let mut bytes = square_with(|_| json!({})).glb();
    bytes[4] = 1;
    assert!(soup_of(&bytes).unwrap_err().to_string().contains("byte 4: found GLB of version 1"));
}

#[test]
fn a_file_cut_anywhere_or_with_a_byte_changed_is_an_error_or_a_sound_soup() {
    let mut file = split(&cube());
    file.set("materials", json!([{ "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1] } }]));
    file.members["meshes"][0]["primitives"][0]["material"] = 0.into();
    let bytes = file.glb();
    for end in 0..bytes.len() {
        let cut = &bytes[..end];
        let read = read(cut, Encoding::Glb, &ReadOptions::default(), &Budget::unlimited());
        assert!(read.is_err(), "cut at {end}");
        let mut changed = bytes.clone();
        changed[end] ^= 1 << (end % 8);
        let Ok(encoding) = sniff(&changed, None) else { continue };
        let read = meshmend::formats::read(&changed, encoding, &ReadOptions::default(), &Budget::unlimited());
        if let Ok(soup) = read {
            assert_eq!(soup.check(), Vec::<String>::new(), "byte {end}");
        }
    }
    let text = String::from_utf8(file.gltf()).unwrap();
    let error = soup_of(text.replace("\"nodes\":[", "\"nodes\":[}").as_bytes()).unwrap_err();
    assert!(
        matches!(error.place, meshmend::formats::Place::Byte(at) if text[at as usize - 1..].starts_with('[')),
        "{error}"
    );
    let deep = format!("{{\"asset\":{}1{}}}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(soup_of(deep.as_bytes()).unwrap_err().to_string().contains("recursion limit"));
}

#[test]
fn colours_of_vertices_are_read_from_bytes_shorts_and_floats_and_stay() {
    let channels = [[0, 51, 102, 255], [255, 0, 0, 0], [1, 2, 3, 4], [9, 8, 7, 6]];
    let colors = |kind: u32| {
        square_with(|file| {
            let bytes: Vec<u8> = channels
                .as_flattened()
                .iter()
                .flat_map(|&c: &u8| match kind {
                    U8 => vec![c],
                    U16 => (u16::from(c) * 257).to_le_bytes().to_vec(),
                    _ => ((f64::from(c) / 255.0) as f32).to_le_bytes().to_vec(),
                })
                .collect();
            let colors = file.accessor(&bytes, kind, "VEC4", 4);
            if kind != F32 {
                file.accessors[colors]["normalized"] = true.into();
            }
            json!({ "attributes": { "COLOR_0": colors }, "indices": file.indices(&[0, 1, 2, 0, 2, 3]) })
        })
    };
    let share = |c: u8| (f64::from(c) / 255.0) as f32;
    let want = channels.map(|[r, g, b, a]| Some(Color::Linear([r, g, b].map(share), Some(share(a)))));
    for kind in [U8, U16, F32] {
        let soup = soup_of(&colors(kind).glb()).unwrap();
        assert_eq!((&soup.vertex_colors[..], soup.face_colors.len()), (&want[..], 0), "{kind}");
        for encoding in [Encoding::Glb, Encoding::Gltf] {
            let back = soup_of(&write(&soup, encoding, &Budget::unlimited()).unwrap()).unwrap();
            assert_eq!(
                (back.vertex_colors, back.triangles),
                (soup.vertex_colors.clone(), soup.triangles.clone())
            );
        }
    }
    let short = square_with(|file| {
        let colors = file.floats("VEC3", &[1.0; 9]);
        json!({ "attributes": { "COLOR_0": colors } })
    });
    let error = error_of(&short);
    assert!(error.contains("found 3 elements at /accessors/1; expected 4"), "{error}");
}

#[test]
fn colours_of_faces_by_split_vertices_are_colours_of_faces() {
    let mut file = File::default();
    let corners = corners_of(&cube());
    let positions = file.positions(&corners);
    let of_corner = |i: usize| [(i / 6) as f32 / 8.0, 0.5, 0.25];
    let colors: Vec<[f32; 3]> = (0..corners.len()).map(of_corner).collect();
    let colors = file.floats("VEC3", colors.as_flattened());
    let file = file.with_primitive(&json!({ "attributes": { "POSITION": positions, "COLOR_0": colors } }));
    let soup = soup_of(&file.glb()).unwrap();
    let want: Vec<_> = (0..12).map(|t| Some(Color::Linear(of_corner(3 * t), None))).collect();
    assert_eq!((&soup.face_colors, soup.vertex_colors.len(), soup.positions.len()), (&want, 0, 8));
    // As sRGB in a PLY, and in materials of a new GLB.
    let ply = converted(&file.glb(), Format::Ply);
    let of_ply = soup_of(&ply).unwrap().face_colors;
    assert_eq!(of_ply[0], Some(Color::Bytes([0, 188, 137], None)));
    let back = converted(&ply, Format::Glb);
    let of_glb = soup_of(&back).unwrap();
    assert_eq!(of_glb.materials.names.len(), 6);
    let again = soup_of(&converted(&back, Format::Ply)).unwrap().face_colors;
    let without_alpha = |color: &Option<Color>| match color {
        Some(Color::Bytes(rgb, _)) => *rgb,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        again.iter().map(without_alpha).collect::<Vec<_>>(),
        of_ply.iter().map(without_alpha).collect::<Vec<_>>()
    );
}

#[test]
fn colours_that_differ_at_seams_within_faces_are_named() {
    let mut file = File::default();
    let positions = file.positions(&[SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[0], SQUARE[2], SQUARE[3]]);
    let colors: Vec<f32> = (0..18).map(|i| i as f32 / 32.0).collect();
    let colors = file.floats("VEC3", &colors);
    let file = file.with_primitive(&json!({ "attributes": { "POSITION": positions, "COLOR_0": colors } }));
    let soup = soup_of(&file.glb()).unwrap();
    assert_eq!((soup.vertex_colors.len(), soup.left_out), (4, vec![("colors_at_seams", 2)]));
}

/// A cube whose faces are of two materials in turn, one with a picture, with texture coordinates; without a triangle.
fn painted_cube() -> File {
    let mut file = File::default();
    let corners = corners_of(&open_cube());
    let picture = file.view(b"\x89PNG\r\n\x1a\nnot looked into");
    let part = |file: &mut File, parity: usize| {
        let of_part: Vec<usize> = (0..corners.len()).filter(|i| i / 3 % 2 == parity).collect();
        let points: Vec<[f32; 3]> = of_part.iter().map(|&i| corners[i]).collect();
        let uv: Vec<[f32; 2]> = of_part.iter().map(|&i| [i as f32 / 64.0, (i % 3) as f32 / 4.0]).collect();
        let (positions, uv) = (file.positions(&points), file.floats("VEC2", uv.as_flattened()));
        json!({ "attributes": { "POSITION": positions, "TEXCOORD_0": uv }, "material": parity })
    };
    let primitives = [part(&mut file, 0), part(&mut file, 1)];
    file.set("meshes", json!([{ "primitives": primitives }]));
    file.set("nodes", json!([{ "mesh": 0 }]));
    file.set("images", json!([{ "bufferView": picture, "mimeType": "image/png" }]));
    file.set("samplers", json!([{ "wrapS": 33071 }]));
    file.set("textures", json!([{ "source": 0, "sampler": 0 }]));
    file.set(
        "materials",
        json!([
            { "name": "skin", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "roughnessFactor": 0.25 },
              "extensions": { "KHR_materials_unlit": {} } },
            { "name": "lips", "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.0, 0.125, 1.0] } },
        ]),
    );
    file.set("animations", json!([{}, {}]));
    file.set("cameras", json!([{ "type": "perspective" }]));
    file
}

#[test]
fn materials_textures_and_pictures_survive_a_repair() {
    let file = painted_cube();
    let before = soup_of(&file.glb()).unwrap();
    assert_eq!(before.materials.of_face, [[0; 6].as_slice(), &[1; 5]].concat());
    assert_eq!(before.face_colors[6], Some(Color::Linear([0.5, 0.0, 0.125], Some(1.0))));
    assert_eq!(before.face_colors[0], None, "the picture has its colours");
    for bytes in [file.glb(), file.gltf()] {
        let mended = answer(Operation::Repair, &bytes, &Options::default());
        assert_eq!(mended.report.outcome, Some(Outcome::Repaired));
        assert_eq!(mended.report.identical_triangle_share, Some(1.0));
        let told = mended.report.actions.iter().find(|action| action.step == "left_out").unwrap();
        assert_eq!(told.changes, [("animations", 2), ("cameras", 1)]);
        let after = soup_of(&mended.output.unwrap().bytes.unwrap()).unwrap();
        let descriptions = after.materials.descriptions.as_ref().unwrap();
        assert_eq!(descriptions.pictures, [b"\x89PNG\r\n\x1a\nnot looked into".to_vec()]);
        // The patch goes over a seam of the texture, so it has the material and the texture of the face nearest to it.
        assert_eq!(after.materials.names, [b"skin".to_vec(), b"lips".to_vec()]);
        assert!((0..after.triangles.len()).all(|t| after.texture.of_triangle(t).is_some()));
        let of = |soup: &Soup| -> Value {
            serde_json::from_slice(&soup.materials.descriptions.as_ref().unwrap().json).unwrap()
        };
        assert_eq!(of(&after), of(&before));
        // Each triangle of the file is there with its material and its texture.
        let key = |soup: &Soup, t: usize| {
            let material = soup.materials.of(soup.face_of(t as u32));
            let mut corners: Vec<_> = soup
                .corners(t as u32)
                .iter()
                .zip(soup.texture.of_triangle(t).unwrap_or_default())
                .map(|(p, uv)| (p.to_array().map(f64::to_bits), uv.map(f64::to_bits)))
                .collect();
            corners.sort_unstable();
            (corners, material)
        };
        let found: Vec<_> = (0..after.triangles.len()).map(|t| key(&after, t)).collect();
        for t in 0..before.triangles.len() {
            assert!(found.contains(&key(&before, t)), "triangle {t}");
        }
    }
}

#[test]
fn textures_on_other_sets_of_coordinates_or_in_other_files_are_named() {
    let mut file = painted_cube();
    file.members["materials"][0]["occlusionTexture"] = json!({ "index": 0, "texCoord": 1 });
    file.members["materials"][1]["emissiveTexture"] = json!({ "index": 1 });
    file.set("textures", json!([{ "source": 0 }, { "source": 1 }]));
    let images = file.members["images"].as_array_mut().unwrap();
    images.insert(0, json!({ "uri": "glow.png" }));
    file.set("textures", json!([{ "source": 1 }, { "source": 0 }]));
    let soup = soup_of(&file.glb()).unwrap();
    assert!(soup.left_out.contains(&("textures", 2)), "{:?}", soup.left_out);
    let json: Value = serde_json::from_slice(&soup.materials.descriptions.unwrap().json).unwrap();
    assert_eq!(json["materials"][0]["occlusionTexture"], Value::Null);
    assert_eq!(json["textures"][0]["source"], 0);
}

#[test]
fn a_face_without_texture_has_none_again() {
    let soup = Soup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3]],
        face_count: 3,
        texture: meshmend::mesh::Texture {
            points: vec![[0.0, 0.25], [0.5, 1.0], [0.75, 0.0]],
            corners: vec![[0, 1, 2], [NO_POINT; 3], [2, 1, 0]],
        },
        ..Soup::default()
    };
    let order = meshmend::formats::stored_order(&soup, Encoding::Glb);
    assert_eq!(order, Some(vec![0, 2, 1]));
    let back = soup_of(&write(&soup, Encoding::Glb, &Budget::unlimited()).unwrap()).unwrap();
    let of = |soup: &Soup, t: usize| (soup.corners(t as u32), soup.texture.of_triangle(t));
    for (t, &was) in order.unwrap().iter().enumerate() {
        assert_eq!(of(&back, t), of(&soup, was as usize));
    }
}

#[test]
fn more_colours_than_materials_go_to_vertices() {
    let grid: Vec<DVec3> =
        (0..21 * 21).map(|i| DVec3::new(f64::from(i % 21), f64::from(i / 21), 0.0)).collect();
    let triangles: Vec<[u32; 3]> = (0..400)
        .flat_map(|i| {
            let v = i / 20 * 21 + i % 20;
            [[v, v + 1, v + 22], [v, v + 22, v + 21]]
        })
        .collect();
    let color =
        |i: usize| Some(Color::Linear([(i % 256) as f32 / 255.0, (i / 256) as f32 / 255.0, 0.3], None));
    let soup = Soup {
        face_count: 800,
        face_colors: (0..800).map(color).collect(),
        positions: grid,
        triangles,
        ..Soup::default()
    };
    let bytes = write(&soup, Encoding::Glb, &Budget::unlimited()).unwrap();
    let back = soup_of(&bytes).unwrap();
    assert_eq!((back.face_colors, back.materials.names.len()), (soup.face_colors, 0));
    assert_eq!(back.triangles.len(), 800);
}

#[test]
fn a_glb_is_in_metres_and_takes_the_unit_of_other_formats_along() {
    let bytes = split(&cuboid([0.02, 0.03, 0.04])).glb();
    let report = answer(Operation::Analyze, &bytes, &Options::default()).report;
    assert_eq!((report.input.units, report.input.units_are_stated), (Units::Metre, true));
    let sides = |bytes: &[u8]| {
        let bounds =
            answer(Operation::Analyze, bytes, &Options::default()).report.before.unwrap().measures.bounds;
        bounds.map(|bounds| (bounds.max - bounds.min).to_array()).unwrap()
    };
    let is_near =
        |found: [f64; 3], want: [f64; 3]| found.iter().zip(want).all(|(a, b)| (a / b - 1.0).abs() < 1e-6);
    let stl = converted(&bytes, Format::Stl);
    assert!(is_near(sides(&stl), [20.0, 30.0, 40.0]), "{:?}", sides(&stl));
    assert!(is_near(sides(&converted(&stl, Format::Glb)), [0.02, 0.03, 0.04]));
    assert!(
        is_near(sides(&converted(&bytes, Format::Ply)), [0.02, 0.03, 0.04]),
        "a PLY has the unit of its file"
    );
    // The caller's word counts more.
    let options =
        Options { units: Some(Units::Millimetre), output_format: Some(Format::Stl), ..Options::default() };
    let as_said = answer(Operation::Convert, &bytes, &options).output.unwrap().bytes.unwrap();
    assert!(is_near(sides(&as_said), [0.02, 0.03, 0.04]));
    let same = Options { units: Some(Units::Millimetre), ..Options::default() };
    assert_eq!(answer(Operation::Repair, &bytes, &same).report.outcome, Some(Outcome::Identical));
}

#[test]
fn what_is_written_obeys_the_rules_of_the_container() {
    let soups =
        [soup_of(&painted_cube().glb()).unwrap(), soup_of(&split(&cuboid([1.0, 2.0, 3.0])).glb()).unwrap()];
    for soup in soups {
        let bytes = write(&soup, Encoding::Glb, &Budget::unlimited()).unwrap();
        assert_eq!(bytes, write(&soup, Encoding::Glb, &Budget::unlimited()).unwrap());
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((word(4), word(8), word(12) % 4), (2, bytes.len(), 0));
        let begin = 20 + word(12);
        assert_eq!((word(begin) % 4, begin + 8 + word(begin)), (0, bytes.len()));
        let document: Value = serde_json::from_slice(&bytes[20..begin]).unwrap();
        assert_eq!(document["buffers"][0]["byteLength"], word(begin));
        for view in document["bufferViews"].as_array().unwrap() {
            assert!(view["byteLength"].as_u64().unwrap() > 0);
            assert_eq!(view["byteOffset"].as_u64().unwrap() % 4, 0);
        }
        let positions = &document["accessors"][0];
        let numbers = |key: &str| -> Vec<f64> {
            positions[key].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect()
        };
        let low = soup.positions.iter().fold(DVec3::INFINITY, |low, &p| low.min(p));
        let high = soup.positions.iter().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p));
        assert_eq!((numbers("min"), numbers("max")), (low.to_array().to_vec(), high.to_array().to_vec()));
    }
}

#[test]
fn every_format_becomes_a_glb_and_comes_back_with_the_same_triangles() {
    let soup = cube().with(&cube().moved([3.0; 3]));
    for encoding in [Encoding::Obj, Encoding::StlBinary, Encoding::Off, Encoding::PlyAscii] {
        let bytes = encode(&soup, encoding);
        let metres =
            Options { units: Some(Units::Metre), output_format: Some(Format::Glb), ..Options::default() };
        let output = answer(Operation::Convert, &bytes, &metres);
        assert_eq!(output.report.outcome, Some(Outcome::Converted));
        assert_eq!(output.report.identical_triangle_share, Some(1.0));
        let glb = output.output.unwrap().bytes.unwrap();
        let original = soup_of(&bytes).unwrap();
        assert_eq!(triangles_of(&soup_of(&glb).unwrap()), triangles_of(&original));
        let text = converted(&glb, Format::Gltf);
        assert_eq!(triangles_of(&soup_of(&text).unwrap()), triangles_of(&original));
    }
}

#[test]
fn a_coordinate_beyond_float32_cannot_be_written() {
    let soup = Soup {
        positions: vec![DVec3::ZERO, DVec3::X * 1e300, DVec3::Y],
        triangles: vec![[0, 1, 2]],
        face_count: 1,
        ..Soup::default()
    };
    let error = write(&soup, Encoding::Glb, &Budget::unlimited()).unwrap_err().to_string();
    assert!(error.contains("vertex 1: coordinate") && error.ends_with("written as glb"), "{error}");
}
