//! The rules, one function each: a file in, sentences about breaches out.

use crate::scan::{Mention, SourceFile};

/// Modules of the engine and the service by level. A module may use lower levels and itself, nothing else.
const LEVELS: [&[&str]; 9] = [
    &["budget", "figures", "par", "geom"],
    &["spatial", "mesh"],
    &["formats", "distance", "winding"],
    &["analysis", "printing", "implicit", "simplify", "modeller", "arrangement", "render"],
    &["repair", "certificate", "wrap"],
    &["pipeline"],
    &["wire", "config"],
    &["jobs"],
    &["http", "cli"],
];
/// From this level on a module may read files, print, wait and tell the time.
const FIRST_LEVEL_WITH_EFFECTS: usize = 6;

/// A rule: its name, and the function that finds its breaches in a file.
pub(crate) struct Rule {
    pub name: &'static str,
    pub breaches: fn(&SourceFile) -> Vec<String>,
}

/// All rules.
pub(crate) const RULES: &[Rule] = &[
    Rule { name: "imports-go-down", breaches: imports_go_down },
    Rule { name: "no-effects-in-the-engine", breaches: no_effects_in_the_engine },
    Rule { name: "wire-and-config-do-not-wait", breaches: wire_and_config_do_not_wait },
    Rule { name: "no-printing-in-the-engine", breaches: no_printing_in_the_engine },
    Rule { name: "threads-only-in-par", breaches: threads_only_in_par },
    Rule { name: "hash-maps-have-fixed-seeds", breaches: hash_maps_have_fixed_seeds },
    Rule { name: "elementary-functions-from-libm", breaches: elementary_functions_from_libm },
    Rule { name: "no-serialization-in-the-engine", breaches: no_serialization_in_the_engine },
    Rule { name: "http-only-in-http", breaches: http_only_in_http },
    Rule { name: "certificate-is-independent", breaches: certificate_is_independent },
    Rule { name: "readers-and-writers-apart", breaches: readers_and_writers_apart },
    Rule { name: "steps-do-not-call-steps", breaches: steps_do_not_call_steps },
    Rule { name: "topology-without-coordinates", breaches: topology_without_coordinates },
    Rule { name: "no-unsafe", breaches: no_unsafe },
    Rule { name: "names-say-what-is-inside", breaches: names_say_what_is_inside },
    Rule { name: "every-file-has-a-header", breaches: every_file_has_a_header },
    Rule { name: "no-stubs", breaches: no_stubs },
    Rule { name: "no-disguised-crates", breaches: no_disguised_crates },
];

/// Breaches of all rules in all files, as lines `file: rule: what`.
pub(crate) fn check(files: &[SourceFile]) -> Vec<String> {
    let of = |file: &SourceFile, rule: &Rule| {
        (rule.breaches)(file)
            .into_iter()
            .map(|b| format!("{}: {}: {b}", file.path, rule.name))
            .collect::<Vec<_>>()
    };
    files.iter().flat_map(|file| RULES.iter().flat_map(move |rule| of(file, rule))).collect()
}

fn level(module: &str) -> Option<usize> {
    LEVELS.iter().position(|modules| modules.contains(&module))
}

fn is_engine(file: &SourceFile) -> bool {
    level(file.top_module()).is_some_and(|level| level < FIRST_LEVEL_WITH_EFFECTS)
}

fn report<'m>(mentions: impl IntoIterator<Item = &'m Mention>, why: &str) -> Vec<String> {
    mentions.into_iter().map(|m| format!("line {}: `{}` {why}", m.line, m.text())).collect()
}

/// The paths of code that is not only for tests.
fn paths(file: &SourceFile) -> impl Iterator<Item = &Mention> {
    file.paths.iter().filter(|m| !m.is_test)
}

fn is_in_any(mention: &Mention, prefixes: &[&str]) -> bool {
    prefixes.iter().any(|prefix| mention.is_in(prefix))
}

/// Imports go strictly down or stay inside the module. Tests of a module may also look sideways.
fn imports_go_down(file: &SourceFile) -> Vec<String> {
    let own = file.top_module();
    if !file.path.starts_with("src/") || ["lib", "main"].contains(&own) {
        return vec![];
    }
    let Some(own_level) = level(own) else {
        return vec![format!("module `{own}` has no level in the rules")];
    };
    let is_breach = |m: &&Mention| {
        if m.path[0] != "crate" || m.path.len() < 2 || m.path[1] == own {
            return false;
        }
        level(&m.path[1]).is_none_or(|its| if m.is_test { its > own_level } else { its >= own_level })
    };
    report(file.paths.iter().filter(is_breach), "is not below this module")
}

fn no_effects_in_the_engine(file: &SourceFile) -> Vec<String> {
    let forbidden = [
        "std::fs",
        "std::net",
        "std::env",
        "std::time",
        "std::process",
        "std::os",
        "std::io::stdin",
        "std::io::stdout",
        "std::io::stderr",
        "std::io::Stdin",
        "std::io::Stdout",
        "std::io::Stderr",
        "tokio",
        "tracing",
        "metrics",
        "rand",
        "fastrand",
        "getrandom",
        "uuid",
        "jiff",
        "tempfile",
    ];
    if !is_engine(file) {
        return vec![];
    }
    report(paths(file).filter(|m| is_in_any(m, &forbidden)), "reaches outside the arguments")
}

/// Nothing below `jobs` waits; only `config` looks at files and the environment.
fn wire_and_config_do_not_wait(file: &SourceFile) -> Vec<String> {
    let forbidden: &[&str] = match file.top_module() {
        "wire" => &[
            "tokio",
            "std::fs",
            "std::net::TcpStream",
            "std::env",
            "std::time::Instant",
            "std::time::SystemTime",
            "std::process",
        ],
        "config" => {
            &["tokio", "std::net::TcpStream", "std::time::Instant", "std::time::SystemTime", "std::process"]
        }
        _ => &[],
    };
    report(paths(file).filter(|m| is_in_any(m, forbidden)), "belongs higher up")
}

fn no_printing_in_the_engine(file: &SourceFile) -> Vec<String> {
    if !is_engine(file) && !["wire", "config", "jobs", "http"].contains(&file.top_module()) {
        return vec![];
    }
    let prints = ["print", "println", "eprint", "eprintln", "dbg"];
    report(file.macros.iter().filter(|m| !m.is_test && prints.contains(&m.path[0].as_str())), "prints")
}

fn threads_only_in_par(file: &SourceFile) -> Vec<String> {
    let (forbidden, why): (&[&str], _) = match file.top_module() {
        "par" | "" => return vec![],
        _ if is_engine(file) => (&["rayon", "std::thread", "crossbeam"], "starts threads outside `par`"),
        _ => (&["rayon", "crossbeam"], "starts engine threads outside `par`"),
    };
    report(paths(file).filter(|m| is_in_any(m, forbidden)), why)
}

/// The default hasher of `std` is seeded anew in every process, so its order would differ from run to run.
fn hash_maps_have_fixed_seeds(file: &SourceFile) -> Vec<String> {
    if !is_engine(file) {
        return vec![];
    }
    let unseeded = |m: &&Mention| {
        let text = m.text();
        m.path.last().is_some_and(|s| s == "RandomState")
            || ["HashMap", "HashSet"].iter().any(|kind| {
                ["new", "with_capacity", "from"]
                    .iter()
                    .any(|make| text == format!("std::collections::{kind}::{make}"))
            })
    };
    report(paths(file).filter(unseeded), "is hashed with a random seed")
}

fn no_serialization_in_the_engine(file: &SourceFile) -> Vec<String> {
    if !is_engine(file) {
        return vec![];
    }
    let words = ["serde", "Serialize", "Deserialize", "ToSchema"];
    let mut breaches = report(
        file.attributes.iter().filter(|m| !m.is_test && words.contains(&m.path[0].as_str())),
        "gives an engine type a public form; mirror it in `wire`",
    );
    // A glTF document is JSON.
    let is_gltf = file.path.starts_with("src/formats/gltf");
    let serial = |m: &&Mention| m.is_in("serde") || m.is_in("utoipa") || (m.is_in("serde_json") && !is_gltf);
    breaches.extend(report(paths(file).filter(serial), "belongs to `wire`"));
    breaches
}

fn http_only_in_http(file: &SourceFile) -> Vec<String> {
    if !file.path.starts_with("src/") || file.top_module() == "http" {
        return vec![];
    }
    let forbidden =
        ["axum", "hyper", "hyper_util", "tower", "tower_http", "utoipa_axum", "multer", "http_body_util"];
    report(paths(file).filter(|m| is_in_any(m, &forbidden)), "is HTTP outside `http`")
}

/// What the judge may see. Of modules that hold more than that each name is listed.
const FOR_THE_JUDGE: [&str; 21] = [
    "crate::budget",
    "crate::certificate",
    "crate::formats::Encoding",
    "crate::formats::Precision",
    "crate::formats::ReadError",
    "crate::formats::ReadErrorKind",
    "crate::formats::ReadOptions",
    "crate::formats::read",
    "crate::formats::read_parts",
    "crate::geom",
    "crate::mesh::EdgeGroups",
    "crate::mesh::Soup",
    "crate::mesh::UnionFind",
    "crate::mesh::corners_from",
    "crate::mesh::edge_of",
    "crate::mesh::fan_heads",
    "crate::mesh::singular_vertices",
    "crate::mesh::triangle_of",
    "crate::mesh::twins",
    "crate::par",
    "crate::spatial",
];

fn certificate_is_independent(file: &SourceFile) -> Vec<String> {
    if file.top_module() != "certificate" {
        return vec![];
    }
    // `formats` by itself is the name through which a listed one is called.
    let is_allowed = |m: &Mention| m.text() == "crate::formats" || is_in_any(m, &FOR_THE_JUDGE);
    let is_breach = |m: &&Mention| m.path[0] == "crate" && m.path.len() > 1 && !is_allowed(m);
    report(
        paths(file).filter(is_breach),
        "is not for the judge: it may see only predicates, search structures, the soup and readers",
    )
}

/// What a file of `formats` does, by a word in its name or its folder's.
fn has_part(path: &str, word: &str) -> bool {
    path.split(['/', '_', '.', ':']).any(|part| part.starts_with(word))
}

fn readers_and_writers_apart(file: &SourceFile) -> Vec<String> {
    if file.top_module() != "formats" || file.stem() == "mod" {
        return vec![];
    }
    let (reads, writes) = (has_part(&file.path, "read"), has_part(&file.path, "writ"));
    let makes = |word: &str| file.functions.iter().any(|m| !m.is_test && m.path[0].starts_with(word));
    if makes("read") && makes("write") {
        return vec!["reads and writes; one file each".to_owned()];
    }
    let other = match (reads, writes) {
        (true, false) => "writ",
        (false, true) => "read",
        _ => return vec![],
    };
    // Types such as `ReadError` and `WriteError` are shared words; only modules and functions count.
    let is_breach = |m: &&Mention| {
        m.is_in("crate::formats")
            && m.path[2..].iter().any(|s| s.starts_with(char::is_lowercase) && has_part(s, other))
    };
    report(paths(file).filter(is_breach), "is the other direction")
}

/// A step is a file or folder of `repair`; `repair/mod.rs` and what it declares itself belong to all.
fn steps_do_not_call_steps(file: &SourceFile) -> Vec<String> {
    let Some(inside) = file.path.strip_prefix("src/repair/") else { return vec![] };
    let own = inside.split('/').next().unwrap_or_default().trim_end_matches(".rs");
    if own == "mod" {
        return vec![];
    }
    let is_breach = |m: &&Mention| {
        m.is_in("crate::repair")
            && m.path.get(2).is_some_and(|s| s != own && s != "*" && s.starts_with(char::is_lowercase))
    };
    report(paths(file).filter(is_breach), "belongs to a sibling step; order belongs to the plan")
}

fn topology_without_coordinates(file: &SourceFile) -> Vec<String> {
    let topology = [
        "src/mesh/half_edge",
        "src/mesh/polyhedron",
        "src/mesh/corner_table",
        "src/mesh/cut",
        "src/mesh/stitch",
        "src/mesh/edges",
        "src/mesh/components",
    ];
    if !topology.iter().any(|name| file.path.starts_with(name)) {
        return vec![];
    }
    let coordinates = ["DVec3", "Aabb", "f64", "f32", "positions", "glam"];
    let mut breaches = report(
        file.words.iter().filter(|m| !m.is_test && coordinates.contains(&m.path[0].as_str())),
        "is about coordinates",
    );
    breaches.extend(report(paths(file).filter(|m| m.is_in("crate::geom")), "is about coordinates"));
    breaches
}

fn no_unsafe(file: &SourceFile) -> Vec<String> {
    let mut breaches = report(file.words.iter().filter(|m| m.path[0] == "unsafe"), "is forbidden");
    breaches.extend(report(file.attributes.iter().filter(|m| m.path[0] == "unsafe_code"), "is forbidden"));
    breaches
}

fn names_say_what_is_inside(file: &SourceFile) -> Vec<String> {
    let empty = ["util", "utils", "helper", "helpers", "common", "manager", "managers", "misc"];
    let says_nothing = |part: &&str| part.split('_').any(|word| empty.contains(&word));
    file.path
        .trim_end_matches(".rs")
        .split('/')
        .filter(says_nothing)
        .map(|part| format!("`{part}` says nothing about its content"))
        .collect()
}

fn every_file_has_a_header(file: &SourceFile) -> Vec<String> {
    if file.text.starts_with("//!") { vec![] } else { vec!["does not begin with `//!`".to_owned()] }
}

fn no_stubs(file: &SourceFile) -> Vec<String> {
    let mut breaches = report(
        file.macros.iter().filter(|m| ["todo", "unimplemented"].contains(&m.path[0].as_str())),
        "stands for code that is not there",
    );
    breaches.extend(report(file.attributes.iter().filter(|m| m.path[0] == "ignore"), "skips a test"));
    breaches
}

/// Those of the standard library are the platform's, whose last digit differs from one processor to another.
fn elementary_functions_from_libm(file: &SourceFile) -> Vec<String> {
    let functions = [
        "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh",
        "acosh", "atanh", "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt",
        "hypot",
    ];
    if !is_engine(file) {
        return vec![];
    }
    let lines: Vec<&str> = file.text.lines().collect();
    let is_called = |m: &&Mention| {
        let name = m.path[0].as_str();
        let calls = [format!(".{name}("), format!("f64::{name}"), format!("f32::{name}")];
        functions.contains(&name)
            && lines.get(m.line - 1).is_some_and(|line| calls.iter().any(|call| line.contains(call)))
    };
    report(
        file.words.iter().filter(|m| !m.is_test).filter(is_called),
        "is the platform's: `libm` has one for all",
    )
}

/// `use std as s` or `use std::*` would hide from the other rules what a file uses.
fn no_disguised_crates(file: &SourceFile) -> Vec<String> {
    if !file.path.starts_with("src/") {
        return vec![];
    }
    report(file.disguises.iter().filter(|m| !m.is_test), "hides what is used; import by name")
}
