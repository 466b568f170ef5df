//! What the documents name exists: relative links, files, and names of the code.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folders with documents.
const FOLDERS: [&str; 8] = [
    "",
    "docs",
    "docs/decisions",
    "experiments",
    "fixtures",
    "examples/ordering-backend",
    "clients/python",
    "clients/typescript",
];
/// Pages of runs at earlier commits, and the list of changes, speak of what was there then.
const HISTORY: [&str; 1] = ["CHANGELOG.md"];
/// Where a file that is named by the end of its path may be.
const TREES: [&str; 11] = [
    "src",
    "clients",
    "tests",
    "benches",
    "docs",
    "experiments",
    "scripts",
    "fixtures",
    "policies",
    "deploy",
    "examples",
];
/// Names in documents that look like files of this package and are none.
const ELSEWHERE: [&str; 1] = ["src/local.rs"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Documents, by their path from the root, with their text.
fn documents() -> Vec<(PathBuf, String)> {
    let mut documents = Vec::new();
    for folder in FOLDERS {
        for entry in std::fs::read_dir(root().join(folder)).expect("a folder of documents") {
            let path = entry.expect("a readable folder").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            if name.ends_with(".md") && !HISTORY.contains(&name.as_str()) {
                documents.push((Path::new(folder).join(name), std::fs::read_to_string(&path).expect("text")));
            }
        }
    }
    documents.sort();
    documents
}

/// Every file of the package that a document may name, from the root.
fn files() -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    let mut waiting = TREES.map(PathBuf::from).to_vec();
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).expect("a folder of the package") {
            let entry = entry.expect("a readable folder");
            let path = folder.join(entry.file_name());
            if entry.path().is_dir() {
                files.insert(format!("{}/", path.display()));
                waiting.push(path);
            } else {
                files.insert(path.display().to_string());
            }
        }
    }
    files
}

/// What stands between backticks, and the text with code blocks left out.
fn quoted(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    prose.flat_map(|part| part.split('`').skip(1).step_by(2)).collect()
}

/// The targets of links.
fn links(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    prose.flat_map(|part| part.split("](").skip(1).filter_map(|rest| rest.split(')').next())).collect()
}

#[test]
fn every_relative_link_leads_to_a_file() {
    let mut missing = Vec::new();
    let mut followed = 0;
    for (document, text) in documents() {
        for link in links(&text).into_iter().filter(|link| !link.contains("://") && !link.starts_with('#')) {
            let target = link.split('#').next().unwrap_or_default();
            followed += 1;
            if !root().join(&document).with_file_name("").join(target).exists() {
                missing.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(followed > 50, "the links were not found");
    assert!(missing.is_empty(), "links that lead nowhere:\n{}", missing.join("\n"));
}

/// True for what is written as a file of this package: a path with an ending that its files have, or a folder.
fn is_file_name(quoted: &str) -> bool {
    let is_plain = quoted.chars().all(|c| c.is_ascii_alphanumeric() || "/_-.".contains(c));
    let ends = [".rs", ".py", ".md", ".sh", ".toml", ".svg", ".png"].iter().any(|end| quoted.ends_with(end));
    let is_folder = quoted.ends_with('/') && !quoted.starts_with('/');
    is_plain && (ends || is_folder) && !quoted.starts_with('.')
}

#[test]
fn every_file_that_a_document_names_exists() {
    let files = files();
    let exists = |name: &str| {
        let end = format!("/{name}");
        root().join(name).exists() || files.iter().any(|file| file.ends_with(&end))
    };
    let mut missing = Vec::new();
    let mut looked_up = 0;
    for (document, text) in documents() {
        for name in quoted(&text).into_iter().filter(|name| is_file_name(name) && !ELSEWHERE.contains(name)) {
            looked_up += 1;
            if !exists(name) {
                missing.push(format!("{}: {name}", document.display()));
            }
        }
    }
    assert!(looked_up > 100, "the names were not found");
    assert!(missing.is_empty(), "files that do not exist:\n{}", missing.join("\n"));
}

/// A path through the code, such as `guard::check_ring`, of which the last name must be in the sources.
fn is_code_path(quoted: &str) -> bool {
    let name = quoted.split('(').next().unwrap_or_default();
    name.contains("::") && name.chars().all(|c| c.is_ascii_alphanumeric() || "_:".contains(c))
}

#[test]
fn every_path_through_the_code_that_a_document_names_exists() {
    let sources = crate::sources();
    let words: BTreeSet<&str> =
        sources.iter().flat_map(|file| file.words.iter().map(|m| m.path[0].as_str())).collect();
    let of_package = |name: &str| name.split("::").all(|part| words.contains(part) || part == "meshmend");
    let mut missing = Vec::new();
    let mut looked_up = 0;
    for (document, text) in documents() {
        for path in quoted(&text).into_iter().filter(|path| is_code_path(path) && !path.starts_with("std::"))
        {
            looked_up += 1;
            if !of_package(path.split('(').next().unwrap_or_default()) {
                missing.push(format!("{}: {path}", document.display()));
            }
        }
    }
    assert!(looked_up > 3, "the paths were not found");
    assert!(missing.is_empty(), "names that the code does not have:\n{}", missing.join("\n"));
}

/// What stands between `start` and `end` in `text`, from the first place where `start` does.
fn between<'t>(text: &'t str, start: &str, end: &str) -> &'t str {
    let (_, rest) = text.split_once(start).unwrap_or_else(|| panic!("`{start}` is gone"));
    rest.split_once(end).unwrap_or_else(|| panic!("`{end}` is gone")).0
}

#[test]
fn the_page_on_the_ladder_lists_the_rungs_in_their_order() {
    let read = |path: &str| std::fs::read_to_string(root().join(path)).expect(path);
    let list = read("src/pipeline/ladder/mod.rs");
    let name_of = |rung: &str| {
        let (file, constant) = rung.split_once("::").expect("a file and a constant");
        let source = read(&format!("src/pipeline/ladder/{file}.rs"));
        let body = between(&source, &format!("const {constant}: Rung = Rung {{"), "};");
        between(body, "name: \"", "\"").to_owned()
    };
    let rungs = between(&list, "] = [", "];").split(',').map(str::trim).filter(|rung| !rung.is_empty());
    let in_code: Vec<String> = rungs.map(|rung| name_of(rung.trim_start_matches('&'))).collect();
    let page = read("docs/ladder.md");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let on_page: Vec<&str> = rows.filter_map(|row| row.split_once('`').map(|(name, _)| name)).collect();
    assert!(in_code.len() > 5, "the rungs were not found");
    assert_eq!(on_page, in_code);
}
