//! The zip package of a 3MF (Open Packaging Conventions, ECMA-376 part 2): its entries, under limits, by part name.
//!
//! An entry's name is a key and nothing else: it never becomes a path of a file system.

use crate::budget::{Budget, Charge};
use crate::formats::{Place, ReadError, ReadErrorKind};
use rustc_hash::FxHashMap;
use std::io::{Cursor, Read};
use zip::result::ZipError;
use zip::{CompressionMethod, ZipArchive};

/// Most entries of a package.
const ENTRIES_MAX: u64 = 65_536;
/// Most bytes of all parts that are read, inflated.
const INFLATED_BYTES_MAX: u64 = 4 << 30;
/// From this size on an entry's ratio counts: a small one cannot do harm.
const RATIO_FROM_BYTES: u64 = 16 << 20;
/// Most inflated bytes for each packed one. Meshes as text have 4 to 20, long lists of equal components up to 200.
const RATIO_MAX: u64 = 500;
/// Bytes inflated between two looks at the budget.
const PIECE_BYTES: usize = 1 << 20;

/// The archive behind the bytes of a 3MF.
pub(super) type Archive<'b> = ZipArchive<Cursor<&'b [u8]>>;

/// A package that is open.
pub(super) struct Package<'b> {
    archive: Archive<'b>,
    /// Entry numbers by part name in lower case: OPC compares names without case.
    numbers: FxHashMap<String, usize>,
    names: Vec<String>,
    inflated: u64,
}

impl<'b> Package<'b> {
    /// Opens `bytes`.
    ///
    /// # Errors
    /// No zip archive, a damaged one, one with encrypted entries, too many entries, or names that are no part names.
    pub(super) fn open(bytes: &'b [u8], budget: &Budget) -> Result<Self, ReadError> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
        let count = archive.len() as u64;
        if count > ENTRIES_MAX {
            return Err(too_large("entries in the package", "entries_max", ENTRIES_MAX, count));
        }
        if archive.has_duplicate_names() {
            let found = "two entries of one name in the package".to_owned();
            return Err(ReadError::unparseable(Place::Whole, found, "entries with different names"));
        }
        let mut package = Self { archive, numbers: FxHashMap::default(), names: Vec::new(), inflated: 0 };
        for number in 0..package.archive.len() {
            budget.spend(1)?;
            let entry = package.archive.by_index_raw(number).map_err(|error| damaged(&error))?;
            let raw = entry.name().map_err(|error| damaged(&error))?.into_owned();
            if entry.encrypted() {
                return Err(ReadError::foreign("an encrypted zip archive"));
            }
            let name = part_name(&raw)?;
            let is_folder = entry.is_dir();
            package.names.push(name.clone());
            if !is_folder && package.numbers.insert(name.to_ascii_lowercase(), number).is_some() {
                let found = format!("two entries of the name {name} in the package");
                return Err(ReadError::unparseable(Place::Whole, found, "entries with different names"));
            }
        }
        Ok(package)
    }

    /// The part names of all entries, in the order of the archive; those of folders end with `/`.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The number of the entry with the part name `name`, such as `/3D/3dmodel.model`.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.numbers.get(&name.to_ascii_lowercase()).copied()
    }

    /// The bytes of entry `number`, inflated. The charge stands for them.
    ///
    /// # Errors
    /// A method that is not read, damaged data, or more bytes than the limits allow.
    pub(super) fn inflate<'g>(
        &mut self,
        number: usize,
        budget: &'g Budget,
    ) -> Result<(Vec<u8>, Charge<'g>), ReadError> {
        let name = self.names[number].clone();
        let in_part = |error: &ZipError| {
            let found = format!("damaged data in {name}: {error}");
            ReadError::unparseable(Place::Whole, found, "an intact zip archive")
        };
        let mut entry = self.archive.by_index(number).map_err(|error| in_part(&error))?;
        let (packed, size) = (entry.compressed_size(), entry.size());
        if !matches!(entry.compression(), CompressionMethod::Stored | CompressionMethod::Deflated) {
            let found = format!("{name} packed as {}", entry.compression());
            return Err(ReadError::unparseable(Place::Whole, found, "entries that are deflated or stored"));
        }
        if size >= RATIO_FROM_BYTES && size / packed.max(1) > RATIO_MAX {
            return Err(too_large(
                "inflated bytes for each packed one in the package",
                "ratio_max",
                RATIO_MAX,
                size / packed.max(1),
            ));
        }
        self.inflated = self.inflated.saturating_add(size);
        if self.inflated > INFLATED_BYTES_MAX {
            let what = "inflated bytes in the package";
            return Err(too_large(what, "inflated_bytes_max", INFLATED_BYTES_MAX, self.inflated));
        }
        let size = usize::try_from(size).unwrap_or(usize::MAX);
        let (mut bytes, charge) = budget.vec::<u8>(size)?;
        // What the directory says is not to be trusted: one byte more than that is an error and not memory.
        let mut source = (&mut entry).take(size as u64 + 1);
        loop {
            budget.check()?;
            let piece = (size + 1 - bytes.len()).min(PIECE_BYTES) as u64;
            let read = (&mut source).take(piece).read_to_end(&mut bytes);
            let count = read.map_err(|error| in_part(&ZipError::Io(error)))?;
            if bytes.len() > size {
                let found = format!("more data in {name} than its entry says");
                return Err(ReadError::unparseable(Place::Whole, found, format!("{size} bytes")));
            }
            if count == 0 {
                break;
            }
        }
        if bytes.len() < size {
            return Err(ReadError::truncated(Place::Whole, format!("{size} bytes in {name}")));
        }
        Ok((bytes, charge))
    }

    /// Looks at how entry `number` is packed, without inflating it.
    pub(super) fn into_archive(self) -> Archive<'b> {
        self.archive
    }
}

fn damaged(error: &ZipError) -> ReadError {
    match error {
        ZipError::UnsupportedArchive(what) if what.contains("assword") => {
            ReadError::foreign("an encrypted zip archive")
        }
        _ => ReadError::unparseable(
            Place::Whole,
            format!("a damaged zip archive: {error}"),
            "the package of a 3MF",
        ),
    }
}

/// A limit of this reader that is passed.
pub(super) fn too_large(what: &'static str, limit_name: &'static str, limit: u64, actual: u64) -> ReadError {
    let kind = ReadErrorKind::TooLarge { what, limit_name, limit, actual };
    ReadError { kind, place: Place::Whole, expected: String::new() }
}

/// The part name of an entry: from `/` on, with `/` between its segments.
fn part_name(entry: &str) -> Result<String, ReadError> {
    let slashed = entry.replace('\\', "/");
    let inside = slashed.trim_start_matches('/');
    let is_strange = |segment: &str| segment == ".." || segment == "." || segment.contains(':');
    if inside.is_empty() || inside.split('/').any(is_strange) || inside.contains('\0') {
        let found = format!("an entry of the name {:?} in the package", shortened(entry));
        return Err(ReadError::unparseable(Place::Whole, found, "names of parts inside the package"));
    }
    Ok(format!("/{inside}"))
}

/// The part that `target` names, seen from the part `source`: absolute or relative, `%` escapes resolved. `None`: it is
/// outside of the package.
pub(super) fn resolve(source: &str, target: &str) -> Option<String> {
    let target = unescaped(target).replace('\\', "/");
    let folder = source.rsplit_once('/').map_or("", |(folder, _)| folder);
    let whole = if target.starts_with('/') { target } else { format!("{folder}/{target}") };
    let mut segments = Vec::new();
    for segment in whole.split('/') {
        match segment {
            "" | "." => {}
            ".." => {
                segments.pop()?;
            }
            _ => segments.push(segment),
        }
    }
    Some(format!("/{}", segments.join("/")))
}

/// `text` with `%20` and its like as what they stand for.
fn unescaped(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let digits = tail.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        match digits.filter(|_| *first == b'%').and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            None => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned())
}

/// The beginning of a text that may be long, for a message.
pub(super) fn shortened(text: &str) -> String {
    const LETTERS_MAX: usize = 60;
    let mut letters = text.chars();
    let start: String = letters.by_ref().take(LETTERS_MAX).collect();
    if letters.next().is_some() { format!("{start}…") } else { start }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_resolved_as_seen_from_their_source() {
        let of = |source: &str, target: &str| resolve(source, target);
        assert_eq!(of("/", "3D/3dmodel.model").as_deref(), Some("/3D/3dmodel.model"));
        assert_eq!(of("/3D/3dmodel.model", "/3D/a%20b.png").as_deref(), Some("/3D/a b.png"));
        assert_eq!(of("/3D/3dmodel.model", "Objects/./a.model").as_deref(), Some("/3D/Objects/a.model"));
        assert_eq!(of("/3D/3dmodel.model", "../Metadata/x").as_deref(), Some("/Metadata/x"));
        assert_eq!(of("/3D/3dmodel.model", "../../x"), None);
    }

    #[test]
    fn names_that_lead_out_of_the_package_are_refused() {
        for name in ["../a", "a/../b", "C:/a", "", "/", "a\0b", "..\\a"] {
            assert!(part_name(name).is_err(), "{name}");
        }
        assert_eq!(part_name("/3D\\3dmodel.model").unwrap(), "/3D/3dmodel.model");
    }
}
