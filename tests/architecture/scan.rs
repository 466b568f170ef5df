//! A source file as facts: the paths it names (imports resolved), its macros, attributes, functions and identifiers.
//!
//! Works on tokens, not on a syntax tree, so that code inside macro calls is seen like any other.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};

/// A name used in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Mention {
    /// Segments; `crate`, `self` and `super` and what the file imports are resolved, so the first is `crate` or the
    /// name of another crate where it can be known.
    pub path: Vec<String>,
    /// Line, from 1.
    pub line: usize,
    /// In code that only tests compile.
    pub is_test: bool,
}

impl Mention {
    /// The path as it would be written.
    pub(crate) fn text(&self) -> String {
        self.path.join("::")
    }

    /// True when the path is `prefix` or inside it.
    pub(crate) fn is_in(&self, prefix: &str) -> bool {
        let mut segments = self.path.iter();
        prefix.split("::").all(|want| segments.next().is_some_and(|have| have == want))
    }
}

/// A Rust file and what it says.
#[derive(Debug, Default)]
pub(crate) struct SourceFile {
    /// Path from the package's root, with `/`.
    pub path: String,
    /// The whole text.
    pub text: String,
    /// Paths of two segments or more and imported names.
    pub paths: Vec<Mention>,
    /// Names of called macros.
    pub macros: Vec<Mention>,
    /// Every word of every attribute.
    pub attributes: Vec<Mention>,
    /// Names of functions.
    pub functions: Vec<Mention>,
    /// Every identifier outside attributes.
    pub words: Vec<Mention>,
    /// Crate roots imported under another name or by glob, which would hide what is used.
    pub disguises: Vec<Mention>,
    /// Modules (absolute paths) that only tests compile.
    test_modules: Vec<Vec<String>>,
}

impl SourceFile {
    /// Reads `text` as the file at `path`.
    pub(crate) fn new(path: &str, text: &str) -> Self {
        let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{path}: {e}"));
        let mut file = Self { path: path.to_owned(), text: text.to_owned(), ..Self::default() };
        let mut scan = Scan {
            file: &mut file,
            module: module_of(path),
            is_test: false,
            imports: BTreeMap::new(),
            raw: vec![],
        };
        scan.tokens(&tokens.into_iter().collect::<Vec<_>>());
        scan.resolve_all();
        file
    }

    /// The module at the top of `src` that the file belongs to, e.g. `formats`; empty outside `src`.
    pub(crate) fn top_module(&self) -> &str {
        let Some(inside) = self.path.strip_prefix("src/") else { return "" };
        inside.split('/').next().unwrap_or_default().trim_end_matches(".rs")
    }

    /// The absolute path of the module that the file is.
    pub(crate) fn module(&self) -> Vec<String> {
        module_of(&self.path)
    }

    /// The file's name without folder and ending.
    pub(crate) fn stem(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default().trim_end_matches(".rs")
    }
}

/// Marks everything in files whose `mod` line stands under `#[cfg(test)]` as test code.
pub(crate) fn mark_test_modules(files: &mut [SourceFile]) {
    let of_tests: BTreeSet<Vec<String>> = files.iter().flat_map(|f| f.test_modules.clone()).collect();
    for file in files.iter_mut() {
        let module = module_of(&file.path);
        if (1..=module.len()).any(|n| of_tests.contains(&module[..n])) {
            for list in [
                &mut file.paths,
                &mut file.macros,
                &mut file.attributes,
                &mut file.functions,
                &mut file.words,
            ] {
                list.iter_mut().for_each(|m| m.is_test = true);
            }
        }
    }
}

/// The absolute path of the module that a file under `src` is.
fn module_of(path: &str) -> Vec<String> {
    let inside = path.strip_prefix("src/").unwrap_or(path).trim_end_matches(".rs");
    let mut module = vec!["crate".to_owned()];
    module.extend(inside.split('/').filter(|s| !["mod", "lib", "main"].contains(s)).map(str::to_owned));
    module
}

/// An unresolved path, with the module it stands in.
struct RawPath {
    module: Vec<String>,
    mention: Mention,
}

struct Scan<'f> {
    file: &'f mut SourceFile,
    module: Vec<String>,
    is_test: bool,
    /// What a name stands for in a module: imports and child modules.
    imports: BTreeMap<(Vec<String>, String), Vec<String>>,
    raw: Vec<RawPath>,
}

impl Scan<'_> {
    fn tokens(&mut self, tokens: &[TokenTree]) {
        // Set by `#[cfg(test)]` or `#[test]` until the body of the item it stands on has passed.
        let mut next_is_test = false;
        let mut i = 0;
        while let Some(token) = tokens.get(i) {
            match token {
                TokenTree::Punct(p) if p.as_char() == '#' => {
                    i = self.attributes(tokens, i, &mut next_is_test);
                }
                TokenTree::Punct(p) => {
                    next_is_test &= p.as_char() != ';';
                    i += 1;
                }
                TokenTree::Group(group) => {
                    let inner: Vec<_> = group.stream().into_iter().collect();
                    self.as_test(next_is_test, |scan| scan.tokens(&inner));
                    next_is_test &= group.delimiter() != Delimiter::Brace;
                    i += 1;
                }
                TokenTree::Ident(word) if word == "use" => {
                    let end =
                        (i..tokens.len()).find(|&j| is_punct(tokens.get(j), ';')).unwrap_or(tokens.len());
                    self.as_test(next_is_test, |scan| scan.use_tree(&tokens[i + 1..end], &[]));
                    i = end;
                }
                TokenTree::Ident(word) if word == "mod" => i = self.module(tokens, i, &mut next_is_test),
                TokenTree::Ident(_) => i = self.as_test(next_is_test, |scan| scan.path(tokens, i)),
                TokenTree::Literal(_) => i += 1,
            }
        }
    }

    /// Runs `body` as test code if `is_test` says so or it already is.
    fn as_test<T>(&mut self, is_test: bool, body: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.is_test;
        self.is_test |= is_test;
        let result = body(self);
        self.is_test = before;
        result
    }

    /// The attribute whose `#` is at `i`; gives the index after it.
    fn attributes(&mut self, tokens: &[TokenTree], i: usize, next_is_test: &mut bool) -> usize {
        let is_inner = is_punct(tokens.get(i + 1), '!');
        let at = i + 1 + usize::from(is_inner);
        let Some(TokenTree::Group(group)) = tokens.get(at) else { return i + 1 };
        let is_for_tests = self.attribute(group.stream());
        if is_inner {
            self.is_test |= is_for_tests;
        } else {
            *next_is_test |= is_for_tests;
        }
        at + 1
    }

    fn mention(&self, path: Vec<String>, line: usize) -> Mention {
        Mention { path, line, is_test: self.is_test }
    }

    /// `mod name;` or `mod name { … }` at `i`; gives the index after it.
    fn module(&mut self, tokens: &[TokenTree], i: usize, next_is_test: &mut bool) -> usize {
        let Some(TokenTree::Ident(name)) = tokens.get(i + 1) else { return i + 1 };
        let mut inner = self.module.clone();
        inner.push(name.to_string());
        self.imports.insert((self.module.clone(), name.to_string()), inner.clone());
        let is_test = self.is_test || std::mem::take(next_is_test);
        if let Some(TokenTree::Group(body)) = tokens.get(i + 2) {
            let outer =
                (std::mem::replace(&mut self.module, inner), std::mem::replace(&mut self.is_test, is_test));
            self.tokens(&body.stream().into_iter().collect::<Vec<_>>());
            (self.module, self.is_test) = outer;
        } else if is_test {
            self.file.test_modules.push(inner);
        }
        i + 3
    }

    /// Notes the words of an attribute; true when it makes its item test code.
    fn attribute(&mut self, stream: TokenStream) -> bool {
        let mut words = Vec::new();
        let mut streams = vec![stream];
        while let Some(stream) = streams.pop() {
            for token in stream {
                match token {
                    TokenTree::Ident(word) => words.push((word.to_string(), word.span().start().line)),
                    TokenTree::Group(group) => streams.push(group.stream()),
                    _ => {}
                }
            }
        }
        for (word, line) in &words {
            let mention = self.mention(vec![word.clone()], *line);
            self.file.attributes.push(mention);
        }
        let has = |want: &str| words.iter().any(|(word, _)| word == want);
        (has("test") && !has("not") && !has("any")) || has("rstest")
    }

    /// The path, macro call or word at `i`; gives the index after it.
    fn path(&mut self, tokens: &[TokenTree], mut i: usize) -> usize {
        let mut path = Vec::new();
        let mut line = 0;
        while let Some(TokenTree::Ident(word)) = tokens.get(i) {
            line = word.span().start().line;
            path.push(word.to_string());
            let mention = self.mention(vec![word.to_string()], line);
            self.file.words.push(mention);
            i += 1;
            if word == "fn"
                && let Some(TokenTree::Ident(name)) = tokens.get(i)
            {
                let mention = self.mention(vec![name.to_string()], line);
                self.file.functions.push(mention);
            }
            // `Vec::<u8>::new`: what is inside the angle brackets is scanned when the loop outside comes to it, the
            // path goes on behind them.
            let is_joined = is_punct(tokens.get(i), ':') && is_punct(tokens.get(i + 1), ':');
            if !is_joined {
                break;
            }
            if is_punct(tokens.get(i + 2), '<') {
                let end = end_of_generics(tokens, i + 2);
                if let Some(TokenTree::Ident(word)) = tokens.get(end + 2)
                    && is_punct(tokens.get(end), ':')
                {
                    path.push(word.to_string());
                }
                break;
            }
            i += 2;
        }
        if is_punct(tokens.get(i), '!') && matches!(tokens.get(i + 1), Some(TokenTree::Group(_))) {
            let mention = self.mention(path.last().cloned().into_iter().collect(), line);
            self.file.macros.push(mention);
        }
        if path.len() > 1 {
            self.note(path, line);
        }
        i
    }

    /// An import tree: `a::b`, `a::{b, c::d}`, `a::*`, `a as b`.
    fn use_tree(&mut self, tokens: &[TokenTree], prefix: &[String]) {
        let mut path = prefix.to_vec();
        let mut name = None;
        let mut line = 0;
        let mut i = 0;
        while i < tokens.len() {
            match &tokens[i] {
                TokenTree::Ident(word) if word == "as" => {
                    name = tokens.get(i + 1).map(ToString::to_string);
                    i += 1;
                }
                TokenTree::Ident(word) => {
                    line = word.span().start().line;
                    if word != "self" || path.is_empty() {
                        path.push(word.to_string());
                    }
                }
                TokenTree::Punct(p) if p.as_char() == '*' => path.push("*".to_owned()),
                TokenTree::Group(group) => {
                    let inner: Vec<_> = group.stream().into_iter().collect();
                    for branch in inner.split(|t| is_punct(Some(t), ',')).filter(|b| !b.is_empty()) {
                        self.use_tree(branch, &path);
                    }
                    return;
                }
                _ => {}
            }
            i += 1;
        }
        let Some(last) = path.last().cloned() else { return };
        let is_root = path.len() == 1 || (path.len() == 2 && last == "*");
        let is_relative = ["self", "super"].contains(&path[0].as_str());
        if is_root && !is_relative && (last == "*" || name.as_ref().is_some_and(|n| *n != last)) {
            let mention = self.mention(path.clone(), line);
            self.file.disguises.push(mention);
        }
        if last != "*" {
            self.imports.insert((self.module.clone(), name.unwrap_or(last)), absolute(&path, &self.module));
        }
        self.note(path, line);
    }

    fn note(&mut self, path: Vec<String>, line: usize) {
        let mention = self.mention(path, line);
        self.raw.push(RawPath { module: self.module.clone(), mention });
    }

    /// Replaces first segments that the file imports or declares by what they stand for.
    fn resolve_all(&mut self) {
        for RawPath { module, mut mention } in std::mem::take(&mut self.raw) {
            mention.path = absolute(&mention.path, &module);
            // A name may come by way of another import (`use std::fs; use fs::File`): a few rounds settle it.
            for _ in 0..4 {
                let Some(target) = self.meaning(&module, &mention.path[0]) else { break };
                if target[0] == mention.path[0] && target.len() == 1 {
                    break;
                }
                mention.path.splice(..1, target);
            }
            self.file.paths.push(mention);
        }
    }

    /// What `name` stands for in `module`; inner modules see what the outer ones import, as by `use super::*`.
    fn meaning(&self, module: &[String], name: &str) -> Option<Vec<String>> {
        if name == "crate" {
            return None;
        }
        (1..=module.len())
            .rev()
            .find_map(|n| self.imports.get(&(module[..n].to_vec(), name.to_owned())).cloned())
    }
}

/// Resolves `self` and `super` at the start of a path.
fn absolute(path: &[String], module: &[String]) -> Vec<String> {
    let ups = path.iter().take_while(|s| *s == "super").count();
    let skip = if path[0] == "self" { 1 } else { ups };
    if skip == 0 {
        return path.to_vec();
    }
    let base = &module[..module.len().saturating_sub(ups).max(1)];
    base.iter().chain(&path[skip..]).cloned().collect()
}

fn is_punct(token: Option<&TokenTree>, want: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == want)
}

/// The index behind the `>` that closes the `<` at `start`.
fn end_of_generics(tokens: &[TokenTree], start: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(start) {
        let is_arrow = is_punct(i.checked_sub(1).and_then(|before| tokens.get(before)), '-');
        if is_punct(Some(token), '<') {
            depth += 1;
        } else if is_punct(Some(token), '>') && !is_arrow {
            depth -= 1;
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(file: &SourceFile) -> Vec<String> {
        file.paths.iter().map(Mention::text).collect()
    }

    #[test]
    fn imports_are_flattened_and_relative_ones_made_absolute() {
        let file = SourceFile::new(
            "src/repair/weld.rs",
            "use crate::{mesh::Soup, geom::{self, DVec3 as P}};\nuse super::Step;",
        );
        assert_eq!(
            paths(&file),
            ["crate::mesh::Soup", "crate::geom", "crate::geom::DVec3", "crate::repair::Step"]
        );
    }

    #[test]
    fn a_path_through_an_imported_name_is_resolved_also_inside_a_macro() {
        let file = SourceFile::new(
            "src/mesh/mod.rs",
            "use std::fs; mod soup;\nfn f() { vec![fs::read(\"x\"), soup::g()]; }",
        );
        assert_eq!(paths(&file), ["std::fs", "std::fs::read", "crate::mesh::soup::g"]);
    }

    #[test]
    fn a_path_goes_on_behind_its_type_arguments() {
        let file = SourceFile::new("src/par.rs", "use a::Map;\nfn f() { Map::<u8, Vec<u8>>::new(); }");
        assert_eq!(paths(&file), ["a::Map", "a::Map::new"]);
    }

    #[test]
    fn code_of_tests_is_told_from_other_code() {
        let text = "fn a() { x::y(); }\n#[cfg(test)]\nmod tests { fn b() { x::z(); } }\nfn c() { x::w(); }";
        let file = SourceFile::new("src/par.rs", text);
        assert_eq!(file.paths.iter().map(|m| m.is_test).collect::<Vec<_>>(), [false, true, false]);
        assert_eq!(file.paths.iter().map(|m| m.line).collect::<Vec<_>>(), [1, 3, 4]);
    }

    #[test]
    fn a_file_declared_under_cfg_test_is_test_code() {
        let mut files = [
            SourceFile::new("src/mesh/mod.rs", "#[cfg(test)]\nmod random;\nmod soup;"),
            SourceFile::new("src/mesh/random.rs", "fn f() { x::y(); }"),
            SourceFile::new("src/mesh/soup.rs", "fn f() { x::y(); }"),
        ];
        mark_test_modules(&mut files);
        assert!(files[1].paths[0].is_test && !files[2].paths[0].is_test);
    }
}
