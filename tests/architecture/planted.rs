//! Each rule reports a planted breach of it, and says nothing about code that keeps it.

use crate::rules::{RULES, check};
use crate::scan::SourceFile;

/// A breach: the rule, the file it is planted in, and the code.
const PLANTED: &[(&str, &str, &str)] = &[
    ("imports-go-down", "src/mesh/soup.rs", "use crate::formats::Format;"),
    ("imports-go-down", "src/geom/plane.rs", "fn f() { crate::mesh::weld() }"),
    ("imports-go-down", "src/formats/obj.rs", "fn f() { vec![super::super::pipeline::run()]; }"),
    ("imports-go-down", "src/mesh/soup.rs", "use crate::spatial::Bvh;"),
    ("imports-go-down", "src/http/routes.rs", "use crate::cli::run;"),
    ("imports-go-down", "src/simplify/queue.rs", "use crate::arrangement::Cell;"),
    ("imports-go-down", "src/implicit/rbf.rs", "use crate::{geom::Sign, modeller::dual};"),
    ("imports-go-down", "src/stuff.rs", "fn f() {}"),
    ("imports-go-down", "src/mesh/soup.rs", "#[cfg(test)] mod tests { use crate::pipeline::run; }"),
    ("no-effects-in-the-engine", "src/formats/obj.rs", "use std::fs;\nfn f() { fs::read(\"x\"); }"),
    ("no-effects-in-the-engine", "src/formats/obj.rs", "use std::{fmt, fs::File};"),
    ("no-effects-in-the-engine", "src/repair/weld.rs", "fn f() { let t = std::time::Instant::now(); }"),
    ("no-effects-in-the-engine", "src/repair/weld.rs", "fn f() { assert!(std::env::var(\"X\").is_ok()); }"),
    ("no-effects-in-the-engine", "src/pipeline/mod.rs", "async fn f() { tokio::task::yield_now().await }"),
    ("no-effects-in-the-engine", "src/geom/plane.rs", "use std::net::TcpStream;"),
    ("no-effects-in-the-engine", "src/simplify/queue.rs", "fn f() -> u64 { rand::random() }"),
    ("wire-and-config-do-not-wait", "src/wire/report.rs", "use std::time::SystemTime;"),
    ("wire-and-config-do-not-wait", "src/config.rs", "use tokio::sync::mpsc;"),
    ("no-printing-in-the-engine", "src/mesh/soup.rs", "fn f() { println!(\"x\"); }"),
    ("no-printing-in-the-engine", "src/jobs/slots.rs", "fn f() { std::eprintln!(\"x\"); }"),
    ("threads-only-in-par", "src/spatial/bvh.rs", "use rayon::prelude::*;"),
    ("threads-only-in-par", "src/spatial/bvh.rs", "use std::thread;\nfn f() { thread::spawn(|| ()); }"),
    ("threads-only-in-par", "src/jobs/slots.rs", "fn f() { rayon::join(a, b); }"),
    (
        "hash-maps-have-fixed-seeds",
        "src/mesh/soup.rs",
        "use std::collections::HashMap;\nfn f() { HashMap::<u8, u8>::new(); }",
    ),
    (
        "hash-maps-have-fixed-seeds",
        "src/mesh/soup.rs",
        "fn f() { std::collections::HashSet::with_capacity(1); }",
    ),
    ("hash-maps-have-fixed-seeds", "src/mesh/soup.rs", "use foldhash::fast::RandomState;"),
    ("elementary-functions-from-libm", "src/wrap/seams.rs", "fn f(x: f64) -> f64 { x.sin() }"),
    (
        "elementary-functions-from-libm",
        "src/wrap/seams.rs",
        "fn f(x: Vec<f64>) { x.into_iter().map(f64::exp); }",
    ),
    ("no-serialization-in-the-engine", "src/analysis/mod.rs", "#[derive(Clone, Serialize)] struct A;"),
    ("no-serialization-in-the-engine", "src/analysis/mod.rs", "#[derive(serde::Deserialize)] struct A;"),
    ("no-serialization-in-the-engine", "src/formats/obj.rs", "fn f() { serde_json::from_str(\"\"); }"),
    ("http-only-in-http", "src/jobs/mod.rs", "use axum::Router;"),
    ("http-only-in-http", "src/cli.rs", "use hyper::StatusCode;"),
    ("certificate-is-independent", "src/certificate/mod.rs", "use crate::analysis::DefectCode;"),
    (
        "certificate-is-independent",
        "src/certificate/mod.rs",
        "use crate::formats;\nfn f() { formats::write(); }",
    ),
    ("certificate-is-independent", "src/certificate/read_again.rs", "use crate::formats::stl::write_binary;"),
    ("certificate-is-independent", "src/certificate/mod.rs", "use crate::mesh::cut::cut_vertices;"),
    ("certificate-is-independent", "src/certificate/mod.rs", "use crate::mesh::*;"),
    ("certificate-is-independent", "src/certificate/mod.rs", "use crate::formats::{self, announced};"),
    ("certificate-is-independent", "src/certificate/solid.rs", "fn f() { crate::distance::between(); }"),
    ("readers-and-writers-apart", "src/formats/obj/write.rs", "use super::read::line;"),
    (
        "readers-and-writers-apart",
        "src/formats/stl_read.rs",
        "fn f() { crate::formats::stl_write::header(); }",
    ),
    ("readers-and-writers-apart", "src/formats/off.rs", "fn read_off() {}\nfn write_off() {}"),
    ("steps-do-not-call-steps", "src/repair/weld.rs", "use super::fill;"),
    ("steps-do-not-call-steps", "src/repair/fill/ears.rs", "fn f() { crate::repair::orient::orient(); }"),
    ("topology-without-coordinates", "src/mesh/half_edge.rs", "use crate::geom::Sign;"),
    ("topology-without-coordinates", "src/mesh/stitch.rs", "fn f(length: f64) {}"),
    ("topology-without-coordinates", "src/mesh/cut/edges.rs", "fn f(s: &Soup) { s.positions.len(); }"),
    ("no-unsafe", "src/par.rs", "fn f() { unsafe { g() } }"),
    ("no-unsafe", "src/par.rs", "#![allow(unsafe_code)]"),
    ("names-say-what-is-inside", "src/mesh/utils.rs", "fn f() {}"),
    ("names-say-what-is-inside", "src/mesh/common/mod.rs", "fn f() {}"),
    ("names-say-what-is-inside", "tests/service/job_manager.rs", "fn f() {}"),
    ("every-file-has-a-header", "src/par.rs", ""),
    ("no-stubs", "src/par.rs", "fn f() { todo!(\"later\") }"),
    ("no-stubs", "tests/engine/main.rs", "#[test]\n#[ignore = \"slow\"]\nfn f() {}"),
    ("no-disguised-crates", "src/mesh/soup.rs", "use std as s;"),
    ("no-disguised-crates", "src/mesh/soup.rs", "use std::*;"),
    ("no-disguised-crates", "src/mesh/soup.rs", "use crate as c;"),
];

/// Code that keeps every rule although it comes close to a breach.
const HARMLESS: &[(&str, &str)] = &[
    ("src/wrap/seams.rs", "fn f(x: f64) -> f64 { let cos = libm::cos(x); cos.sqrt() }"),
    ("src/mesh/soup.rs", "use super::edges::EdgeGroups;\nuse crate::{budget::Budget, geom::DVec3};"),
    (
        "src/mesh/soup.rs",
        "/// As std::fs::read, println!() and unsafe code.\nfn f() -> &'static str { \"std::fs::read todo!()\" }",
    ),
    (
        "src/mesh/soup.rs",
        "#[cfg(test)]\nmod tests { use std::fs; use super::*; fn f() { println!(); fs::read(\"x\"); } }",
    ),
    (
        "src/mesh/soup.rs",
        "use std::collections::HashMap;\nfn f() { HashMap::<u8, u8, Fixed>::with_hasher(Fixed); }",
    ),
    ("src/par.rs", "use rayon::prelude::*;"),
    ("src/wire/report.rs", "#[derive(serde::Serialize)] struct R;\nuse crate::pipeline::Report;"),
    ("src/certificate/mod.rs", "use crate::formats::{self, ReadError};\nfn f() { formats::read(); }"),
    ("src/certificate/mod.rs", "#[cfg(test)]\nmod tests { use crate::formats::write; }"),
    (
        "src/formats/obj/read.rs",
        "use crate::formats::{ReadError, WriteError};\nfn read() { spread::write_to(); }",
    ),
    (
        "src/formats/mod.rs",
        "mod stl_read; mod stl_write;\nfn read() { stl_read::read() }\nfn write() { stl_write::write() }",
    ),
    ("src/repair/weld.rs", "use super::Step;\nuse crate::repair::weld::nearest;\nuse super::*;"),
    ("src/repair/fill/ears.rs", "use super::planar;"),
    ("src/repair/mod.rs", "mod weld; mod fill;\nfn f() { weld::weld(); fill::fill(); }"),
    ("src/http/mod.rs", "use axum::Router;\nuse crate::jobs::Job;"),
    ("src/main.rs", "fn main() { meshmend::cli::run(std::env::args_os()) }"),
    ("tests/service/main.rs", "use std::fs;\nfn f() { println!(); }"),
];

fn source(path: &str, code: &str) -> SourceFile {
    // Every file but the one planted for it has a header.
    let header = if code.is_empty() { "" } else { "//! A file.\n" };
    SourceFile::new(path, &format!("{header}{code}"))
}

#[test]
fn every_planted_breach_is_reported_by_its_rule_alone() {
    for (rule, path, code) in PLANTED {
        let found = check(&[source(path, code)]);
        assert!(!found.is_empty(), "{rule} did not see {code:?} in {path}");
        let is_of_rule = |line: &String| line.starts_with(&format!("{path}: {rule}: "));
        assert!(found.iter().all(is_of_rule), "{code:?} in {path} gave {found:?}");
    }
}

#[test]
fn every_rule_has_a_planted_breach() {
    for rule in RULES {
        assert!(PLANTED.iter().any(|(name, ..)| *name == rule.name), "nothing planted for {}", rule.name);
    }
}

#[test]
fn code_that_keeps_the_rules_is_not_reported() {
    for (path, code) in HARMLESS {
        assert_eq!(check(&[source(path, code)]), Vec::<String>::new(), "{code:?}");
    }
}
