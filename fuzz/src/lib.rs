//! What must hold of any bytes. Run one target with `cargo fuzz run read_obj`.

use meshmend::budget::{Budget, StopFlag};
use meshmend::certificate::{Depth, certify};
use meshmend::formats::threemf::{Between, Body, FaceSource, NewBody, read_project, rewrite_project};
use meshmend::formats::{Encoding, Format, ReadErrorKind, ReadOptions, read, sniff, write};
use meshmend::pipeline::{Failure, Operation, Options, Outcome, run, work_units_max};

/// Reads `bytes` as a file of `format`: no panic, no more memory than the size allows, a sound soup, and the same
/// triangles again after writing it.
pub fn check_reader(bytes: &[u8], format: Format) {
    let Ok(encoding) = sniff(bytes, Some(format)) else { return };
    let budget = Budget::new(StopFlag::default(), u64::MAX, (1 << 20) + 64 * bytes.len() as u64);
    let soup = match read(bytes, encoding, &ReadOptions::default(), &budget) {
        Ok(soup) => soup,
        Err(error) => {
            // Instances of a mesh make more triangles than a file has bytes; the budget is what holds them.
            let has_instances = matches!(format, Format::Glb | Format::Gltf);
            assert!(has_instances || !matches!(error.kind, ReadErrorKind::Stopped(_)), "{error}");
            return;
        }
    };
    assert_eq!(soup.check(), Vec::<String>::new());
    let unlimited = Budget::unlimited();
    if let Ok(written) = write(&soup, encoding, &unlimited) {
        let back = match read(&written, encoding, &ReadOptions::default(), &unlimited) {
            Ok(back) => back,
            // A soup without triangles is nothing in STL.
            Err(error) if error.kind == ReadErrorKind::Empty => return,
            Err(error) => panic!("what was written cannot be read: {error}"),
        };
        assert_eq!(back.triangles.len(), soup.triangles.len());
        assert!(back.face_faults.is_empty());
    }
}

/// Most bytes that a project of the fuzzer may charge: what is packed may be much more than the file.
const PROJECT_BYTES_MAX: u64 = 256 << 20;

/// Reads `bytes` as a 3MF, or as the model in one: no panic, no more memory than the budget allows, sound soups, and the same
/// meshes again after each was put back into its place.
pub fn check_project(bytes: &[u8]) {
    let packed;
    let bytes = if bytes.starts_with(b"PK") {
        bytes
    } else {
        packed = packed_model(bytes);
        &packed
    };
    let budget = || Budget::new(StopFlag::default(), u64::MAX, PROJECT_BYTES_MAX);
    let options = ReadOptions::default();
    let Ok(project) = read_project(bytes, &options, &budget()) else { return };
    let taken: Vec<(Vec<FaceSource>, Vec<Between>)> = project.bodies.iter().map(middles).collect();
    let is_finite = |body: &usize| project.bodies[*body].soup.non_finite_vertices.is_empty();
    let new: Vec<NewBody<'_>> = (0..project.bodies.len())
        .filter(|body| project.bodies[*body].is_solid() && is_finite(body))
        .map(|body| NewBody { body, soup: &project.bodies[body].soup, sources: &taken[body].0, between: &taken[body].1 })
        .collect();
    for body in &project.bodies {
        assert_eq!(body.soup.check(), Vec::<String>::new());
    }
    if let Ok(scene) = read(bytes, Encoding::ThreeMf, &options, &budget()) {
        assert_eq!(scene.check(), Vec::<String>::new());
    }
    if let Ok(written) = rewrite_project(bytes, &project, &new, &budget()) {
        let back = read_project(&written, &options, &Budget::unlimited()).expect("what was written can be read");
        for (old, new) in project.bodies.iter().zip(&back.bodies) {
            assert_eq!(old.soup.triangles, new.soup.triangles);
        }
    }
}

/// For each triangle what is in the middle of its face, where its corners have several things, and nothing elsewhere.
fn middles(body: &Body) -> (Vec<FaceSource>, Vec<Between>) {
    let mut between = Vec::new();
    let sources = (0..body.soup.triangles.len() as u32).map(|t| {
        let face = body.soup.face_of(t);
        if !body.is_mixed(face) {
            return FaceSource::Nothing;
        }
        between.push(Between::Shares([(face, [0.5, 0.25, 0.25]); 3]));
        FaceSource::Between { face, number: between.len() as u32 - 1 }
    });
    (sources.collect(), between)
}

/// A package with `model`, whose entries are stored.
fn packed_model(model: &[u8]) -> Vec<u8> {
    use std::io::Write as _;
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    archive.start_file("3D/3dmodel.model", options).expect("an entry");
    archive.write_all(model).expect("bytes in memory");
    archive.finish().expect("an archive").into_inner()
}

/// Takes `bytes` as a list of triangles and repairs, verifies and describes it: every operation ends within its bound of work, and
/// what a repair returns is certified, by a second look at its bytes too, or refused.
pub fn check_mesh(bytes: &[u8]) {
    let Some(mesh) = obj_of(bytes) else { return };
    for operation in [Operation::Analyze, Operation::Verify, Operation::Repair] {
        let (options, budget) = (Options::default(), Budget::new(StopFlag::default(), u64::MAX, 1 << 30));
        let answer = match run(operation, &mesh, &options, &budget) {
            Ok(answer) => answer,
            // The first bytes may leave no vertex and no face.
            Err(Failure::OverBudget { .. } | Failure::Unreadable(_)) => return,
            Err(failure) => panic!("{failure}"),
        };
        let units = work_units_max(operation, mesh.len(), &options).unwrap_or(u64::MAX);
        assert!(budget.work_used() <= units, "{} of {units} units", budget.work_used());
        if operation != Operation::Repair {
            continue;
        }
        let is_refused = answer.report.outcome == Some(Outcome::Refused);
        assert_eq!(is_refused, answer.output.is_none());
        if let Some(output) = answer.output {
            let returned = output.bytes.as_deref().unwrap_or(&mesh);
            let depth = Depth::Count { samples: 1 };
            let judged = certify(returned, output.encoding, &ReadOptions::default(), depth, &Budget::unlimited());
            assert!(judged.is_ok_and(|certificate| certificate.is_printable()), "what is returned is certified");
        }
    }
}

/// Reads `bytes` as the JSON of a request, and as names and values of a query: no panic, and what is accepted becomes options of the
/// engine. Run it with `cargo fuzz run --features requests read_request`.
#[cfg(feature = "requests")]
pub fn check_request(bytes: &[u8]) {
    use meshmend::formats::ReadLimits;
    use meshmend::wire::{JobRequest, Operation, Options};
    let accept = |options: &Options| {
        for &operation in Operation::ALL {
            if options.check(operation).is_ok() {
                let _ = options.to_engine(ReadLimits::default());
            }
        }
    };
    if let Ok(request) = JobRequest::from_json(bytes) {
        accept(&request.options);
    }
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = JobRequest::labels_of_query(text);
    let pairs = text.split('&').map(|pair| pair.split_once('=').unwrap_or((pair, "")));
    if let Ok(options) = Options::from_pairs(pairs) {
        accept(&options);
    }
}

/// An OBJ of up to 512 triangles: the first byte says how far apart its coordinates are, the others are coordinates and corners.
fn obj_of(bytes: &[u8]) -> Option<Vec<u8>> {
    let (&kind, rest) = bytes.split_first()?;
    let (&count, rest) = rest.split_first()?;
    let points = rest.get(..3 * usize::from(count))?;
    let corners = &rest[points.len()..];
    let coordinate = |byte: u8| match kind % 4 {
        0 => f64::from(byte as i8),
        1 => f64::from(byte as i8) / 7.0,
        2 => f64::from(byte & 7),
        _ => (f64::from(byte & 3) - 1.5) * 10f64.powi(i32::from(byte as i8) * 2),
    };
    let mut text = String::new();
    for point in points.chunks_exact(3) {
        let [x, y, z] = [point[0], point[1], point[2]].map(coordinate);
        text.push_str(&format!("v {x:?} {y:?} {z:?}\n"));
    }
    for face in corners.chunks_exact(3).take(512) {
        let [a, b, c] = [face[0], face[1], face[2]].map(|v| u32::from(v) % u32::from(count).max(1) + 1);
        text.push_str(&format!("f {a} {b} {c}\n"));
    }
    Some(text.into_bytes())
}
