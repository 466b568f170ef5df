//! Each mesh under `fixtures/` against the expected reports beside it.
//!
//! `MESHMEND_BLESS=1` writes the expected files anew; read what changed before you keep it.

use meshmend::budget::Budget;
use meshmend::formats::ReadLimits;
use meshmend::pipeline::{Operation, Options, WrapChoices, run};
use meshmend::wire::{self, DefectCode, Report, TimingMs};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// What is rebuilt is rebuilt coarsely here, because that is quick.
const WRAP_CELLS: u32 = 32;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures")
}

/// Every fixture mesh, in a fixed order.
fn meshes() -> Vec<PathBuf> {
    let folders =
        fs::read_dir(root()).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir());
    let files = folders.flat_map(|folder| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let mut meshes: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|e| e != "json")).collect();
    meshes.sort();
    meshes
}

fn expected_path(mesh: &Path) -> PathBuf {
    PathBuf::from(format!("{}.expected.json", mesh.display()))
}

/// The options of the modeller, for the meshes that have some.
fn modeller_options(mesh: &Path) -> Option<Options> {
    let text = fs::read_to_string(format!("{}.options.json", mesh.display())).ok()?;
    let Value::Object(members) = serde_json::from_str(&text).unwrap() else { panic!("{mesh:?}: no object") };
    Some(wire::Options::try_from(members).unwrap().to_engine(ReadLimits::default()))
}

/// What `meshmend modeller` makes of it: what it tells of the polyhedron and each operator, and the returned file in
/// short.
fn modelled(bytes: &[u8], options: &Options) -> Value {
    let report = report(bytes, Operation::Modeller, options);
    let certificate = &report["certificate"];
    json!({
        "verdict": report["verdict"],
        "modeller": report["modeller"],
        "result": { "sha256": certificate["sha256"], "bytes": certificate["bytes"], "shells": certificate["shells"] },
    })
}

/// The report of `operation`, or why there is none.
fn report(bytes: &[u8], operation: Operation, options: &Options) -> Value {
    match run(operation, bytes, options, &Budget::unlimited()) {
        Ok(answer) => serde_json::to_value(Report::new(&answer.report, TimingMs::default())).unwrap(),
        Err(failure) => json!({ "error": failure.to_string() }),
    }
}

fn coarse() -> Options {
    let wrap = WrapChoices { cells: Some(WRAP_CELLS), ..WrapChoices::default() };
    Options { wrap, ..Options::default() }
}

/// What `meshmend analyze` says of a file, without what differs from run to run or from version to version.
fn analyzed(bytes: &[u8]) -> Value {
    let mut report = report(bytes, Operation::Analyze, &coarse());
    let differs = ["engine", "timing_ms", "resources"];
    let does_not_apply = ["plan", "actions", "modeller", "after", "deviation", "certificate", "printing"];
    report
        .as_object_mut()
        .unwrap()
        .retain(|name, _| ![&differs[..], &does_not_apply].concat().contains(&name.as_str()));
    report["input_certificate"].as_object_mut().map(|certificate| certificate.remove("engine_version"));
    report
}

/// What `meshmend repair` makes of it: the verdict, what each step changed, and the returned file in short.
fn repaired(bytes: &[u8]) -> Value {
    let report = report(bytes, Operation::Repair, &coarse());
    if report.get("error").is_some() {
        return report;
    }
    let changed = |action: &Value| {
        let counts = action["changes"].as_array().unwrap().iter().filter(|change| change["count"] != 0);
        let counts: Vec<String> =
            counts.map(|c| format!("{} {}", c["name"].as_str().unwrap(), c["count"])).collect();
        (!counts.is_empty()).then(|| format!("{}: {}", action["step"].as_str().unwrap(), counts.join(", ")))
    };
    let changes: Vec<String> = report["actions"].as_array().unwrap().iter().filter_map(changed).collect();
    let [certificate, after] = [&report["certificate"], &report["after"]];
    let result = json!({
        "sha256": certificate["sha256"],
        "bytes": certificate["bytes"],
        "shells": certificate["shells"],
        "defects": after["defects"],
    });
    json!({
        "verdict": report["verdict"],
        "changes": changes,
        "deviation": report["deviation"],
        "result": if certificate.is_null() { Value::Null } else { result },
    })
}

fn actual(mesh: &Path) -> Value {
    let bytes = fs::read(mesh).unwrap();
    let mut actual = json!({ "analyze": analyzed(&bytes), "repair": repaired(&bytes) });
    if let Some(options) = modeller_options(mesh) {
        actual["modeller"] = modelled(&bytes, &options);
    }
    actual
}

/// Widest line that an expected file has where it can.
const COLUMNS: usize = 120;

/// JSON in which whatever fits on a line is on one.
fn compact(value: &Value, indent: usize) -> String {
    let inline = value.to_string();
    let (open, close, rows): (_, _, Vec<String>) = match value {
        _ if inline.len() + indent <= COLUMNS => return inline,
        Value::Object(members) => {
            let row = |(name, value): (&String, &Value)| format!("{name:?}: {}", compact(value, indent + 2));
            ('{', '}', members.iter().map(row).collect())
        }
        Value::Array(items) => ('[', ']', items.iter().map(|item| compact(item, indent + 2)).collect()),
        _ => return inline,
    };
    let [outer, inner] = [indent, indent + 2].map(|width| " ".repeat(width));
    format!("{open}\n{inner}{}\n{outer}{close}", rows.join(&format!(",\n{inner}")))
}

#[test]
fn each_fixture_has_the_expected_report_and_repair() {
    let is_blessed = std::env::var_os("MESHMEND_BLESS").is_some();
    let mut different = Vec::new();
    for mesh in meshes() {
        let said = format!("{}\n", compact(&actual(&mesh), 0));
        let path = expected_path(&mesh);
        if is_blessed {
            fs::write(&path, &said).unwrap();
        } else if fs::read_to_string(&path).unwrap_or_default() != said {
            different.push(format!("{}:\n{said}", path.display()));
        }
    }
    assert!(different.is_empty(), "not as expected:\n{}", different.join("\n"));
}

#[test]
fn there_is_a_fixture_for_every_expected_file() {
    let expected: BTreeSet<PathBuf> = meshes().iter().map(|mesh| expected_path(mesh)).collect();
    let folders: BTreeSet<PathBuf> = meshes().iter().map(|mesh| mesh.parent().unwrap().to_owned()).collect();
    let files =
        folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let there: BTreeSet<PathBuf> =
        files.filter(|path| path.to_string_lossy().ends_with(".expected.json")).collect();
    assert_eq!(there, expected);
}

#[test]
fn the_defect_catalogue_names_every_code_with_an_example_that_shows_it() {
    let catalogue = include_str!("../../docs/defects.md");
    let rows: Vec<Vec<&str>> = catalogue
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let codes: Vec<&str> = rows.iter().map(|row| row[0].trim_matches('`')).collect();
    assert_eq!(codes, DefectCode::WORDS, "one row for each code, in their order");
    for (code, row) in codes.iter().zip(&rows) {
        let [severities, examples] = [row[1], row[3]];
        for example in examples.split(", ").map(|path| path.trim_matches('`')) {
            let expected = fs::read_to_string(expected_path(&root().join(example))).expect(example);
            let expected: Value = serde_json::from_str(&expected).unwrap();
            let defects = expected["analyze"]["before"]["defects"].as_array().expect(example);
            let shown = defects.iter().find(|defect| defect["code"] == *code);
            let severity =
                shown.unwrap_or_else(|| panic!("{example} shows no {code}"))["severity"].as_str().unwrap();
            assert!(severities.contains(severity), "{code} is {severity}");
        }
    }
}
