//! The rules of the house, enforced on the sources: who may import whom, and what an engine module never does.
//!
//! `scan` turns a source file into facts, `rules` holds one function per rule, `planted` shows that each rule reports
//! a breach of it.

#[path = "architecture/circles.rs"]
mod circles;
#[path = "architecture/documents.rs"]
mod documents;
#[path = "architecture/instructions.rs"]
mod instructions;
#[path = "architecture/planted.rs"]
mod planted;
#[path = "architecture/rules.rs"]
mod rules;
#[path = "architecture/scan.rs"]
mod scan;

use scan::SourceFile;
use std::path::Path;

/// Every Rust file of the package, by its path from the package's root.
fn sources() -> Vec<SourceFile> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = ["src", "tests", "benches"].map(|name| root.join(name)).to_vec();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry.expect("a readable folder").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let name =
                    path.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
                let text = std::fs::read_to_string(&path).expect("a readable file");
                files.push(SourceFile::new(&name, &text));
            }
        }
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    scan::mark_test_modules(&mut files);
    files
}

#[test]
fn the_sources_keep_every_rule_of_the_house() {
    let files = sources();
    assert!(files.iter().any(|f| f.path == "src/par.rs"), "the sources were not found");
    let breaches = rules::check(&files);
    assert!(breaches.is_empty(), "{} breaches:\n{}", breaches.len(), breaches.join("\n"));
}

#[test]
fn no_files_of_a_module_need_each_other_in_a_circle() {
    let circles = circles::circles(&sources());
    assert!(circles.is_empty(), "{} circles:\n{}", circles.len(), circles.join("\n"));
}

#[test]
fn an_image_is_built_from_all_that_the_sources_include() {
    let given: Vec<_> =
        include_str!("../.dockerignore").lines().filter_map(|line| line.strip_prefix('!')).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut included = 0;
    for file in sources().iter().filter(|file| file.path.starts_with("src/")) {
        let text = std::fs::read_to_string(root.join(&file.path)).expect("a readable file");
        for argument in text.split("include_str!(\"").skip(1).filter_map(|rest| rest.split('"').next()) {
            let folder = root.join(&file.path).with_file_name("");
            let path = folder.join(argument).canonicalize().expect("a file that is included");
            let path = path.strip_prefix(root.canonicalize().expect("the root")).expect("below the root");
            let top = path.iter().next().expect("a name").to_string_lossy();
            assert!(
                given.contains(&&*top),
                "{} includes {argument}, and .dockerignore leaves `{top}` out",
                file.path
            );
            included += 1;
        }
    }
    assert!(included > 5, "the files that are included were not found");
}

#[test]
fn the_package_forbids_unsafe_code() {
    let manifest = include_str!("../Cargo.toml");
    assert!(manifest.lines().any(|line| line == "unsafe_code = \"forbid\""));
}
