//! No circles: files of one module that need each other can only be read, and changed, together.
//!
//! `mod.rs` is left out: it says what is common to its folder and calls what is in it.

use crate::scan::SourceFile;
use std::collections::{BTreeMap, BTreeSet};

/// Circles of files inside modules, each as a line `a -> b -> a` with the names that tie one to the next.
pub(crate) fn circles(files: &[SourceFile]) -> Vec<String> {
    let tree = Tree::of(files);
    let mut arrows: BTreeMap<&str, BTreeMap<&str, String>> = BTreeMap::new();
    for file in tree.files() {
        for mention in file.paths.iter().filter(|m| !m.is_test && m.path[0] == "crate") {
            let Some(target) = tree.home_of(&mention.path, &mut BTreeSet::new()) else { continue };
            let is_inside = target.top_module() == file.top_module() && target.path != file.path;
            if is_inside && target.stem() != "mod" {
                let name = mention.path.last().cloned().unwrap_or_default();
                arrows.entry(&file.path).or_default().entry(&target.path).or_insert(name);
            }
        }
    }
    knots(&arrows).iter().map(|knot| shortest_circle(knot, &arrows)).collect()
}

/// The files of `src` by the path of the module that each is.
struct Tree<'f> {
    by_module: BTreeMap<Vec<String>, &'f SourceFile>,
}

impl<'f> Tree<'f> {
    fn of(files: &'f [SourceFile]) -> Self {
        let of_source = files.iter().filter(|file| file.path.starts_with("src/"));
        Self { by_module: of_source.map(|file| (file.module(), file)).collect() }
    }

    fn files(&self) -> impl Iterator<Item = &'f SourceFile> {
        self.by_module.values().copied().filter(|file| !["mod", "lib", "main"].contains(&file.stem()))
    }

    /// The file that `path` leads to, through what a `mod.rs` gives out again.
    fn home_of(&self, path: &[String], seen: &mut BTreeSet<Vec<String>>) -> Option<&'f SourceFile> {
        let depth = (2..=path.len()).rev().find(|&n| self.by_module.contains_key(&path[..n]))?;
        let file = self.by_module[&path[..depth]];
        let given_out = path.get(depth).filter(|_| file.stem() == "mod" && seen.insert(path.to_vec()));
        let source = given_out.and_then(|name| {
            let is_source = |m: &&crate::scan::Mention| {
                m.path.len() > depth + 1 && m.path[..depth] == path[..depth] && m.path.last() == Some(name)
            };
            file.paths.iter().find(is_source)
        });
        match source {
            Some(mention) => self.home_of(&mention.path, seen),
            None => Some(file),
        }
    }
}

type Arrows<'f> = BTreeMap<&'f str, BTreeMap<&'f str, String>>;

/// Sets of two or more files each of which reaches all the others.
fn knots<'f>(arrows: &Arrows<'f>) -> Vec<BTreeSet<&'f str>> {
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|&from| (from, reached_from(from, arrows))).collect();
    let mut knots: Vec<BTreeSet<&str>> = Vec::new();
    for (&from, targets) in reached.iter().filter(|(from, targets)| targets.contains(*from)) {
        if !knots.iter().any(|knot| knot.contains(from)) {
            knots.push(
                targets
                    .iter()
                    .copied()
                    .filter(|to| reached.get(to).is_some_and(|r| r.contains(from)))
                    .collect(),
            );
        }
    }
    knots
}

fn reached_from<'f>(from: &str, arrows: &Arrows<'f>) -> BTreeSet<&'f str> {
    let mut reached = BTreeSet::new();
    let mut waiting: Vec<&str> = vec![from];
    while let Some(file) = waiting.pop() {
        for &next in arrows.get(file).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(next) {
                waiting.push(next);
            }
        }
    }
    reached
}

/// A shortest circle through the first file of a knot, as a line.
fn shortest_circle(knot: &BTreeSet<&str>, arrows: &Arrows<'_>) -> String {
    let Some(&first) = knot.first() else { return String::new() };
    let mut lines = vec![(first, first.to_owned())];
    let mut seen = BTreeSet::new();
    loop {
        let mut longer = Vec::new();
        for (at, line) in &lines {
            for (&next, name) in arrows[at].iter().filter(|(next, _)| knot.contains(*next)) {
                let line = format!("{line} -({name})-> {next}");
                if next == first {
                    return format!("{} files: {line}", knot.len());
                }
                if seen.insert(next) {
                    longer.push((next, line));
                }
            }
        }
        lines = longer;
    }
}

#[test]
fn a_planted_circle_is_seen_also_through_a_mod_file() {
    let file = |path: &str, code: &str| SourceFile::new(path, &format!("//! A file.\n{code}"));
    let planted = [
        file("src/mesh/mod.rs", "mod a; mod b; mod c;\npub use self::a::A;\npub use self::b::B;"),
        file("src/mesh/a.rs", "use super::B;\nuse super::c::C;"),
        file("src/mesh/b.rs", "use crate::mesh::A;"),
        file("src/mesh/c.rs", "#[cfg(test)]\nmod tests { use super::super::A; }"),
    ];
    assert_eq!(circles(&planted), ["2 files: src/mesh/a.rs -(B)-> src/mesh/b.rs -(A)-> src/mesh/a.rs"]);
    assert_eq!(circles(&planted[..2]), Vec::<String>::new());
}
