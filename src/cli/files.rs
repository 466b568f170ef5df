//! Input and output: files or the standard streams, and results that appear whole or not at all.

use crate::formats::Format;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A file, or `-` for standard input or output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum FileOrStream {
    Stream,
    File(PathBuf),
}

impl FromStr for FileOrStream {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(if text == "-" { Self::Stream } else { Self::File(text.into()) })
    }
}

impl fmt::Display for FileOrStream {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stream => f.write_str("-"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

impl FileOrStream {
    /// The format that the file's extension names.
    pub(super) fn format(&self) -> Option<Format> {
        match self {
            Self::Stream => None,
            Self::File(_) => Format::from_name(self.extension()?),
        }
    }

    /// The file's extension.
    pub(super) fn extension(&self) -> Option<&str> {
        match self {
            Self::Stream => None,
            Self::File(path) => path.extension()?.to_str(),
        }
    }

    /// The file beside it for the result of this number: `part-2.stl` for `part.stl`.
    pub(super) fn numbered(&self, number: usize) -> Self {
        let Self::File(path) = self else { return self.clone() };
        let mut name = path.file_stem().unwrap_or_default().to_owned();
        name.push(format!("-{number}"));
        if let Some(extension) = path.extension() {
            name.push(".");
            name.push(extension);
        }
        Self::File(path.with_file_name(name))
    }

    /// All bytes of the file or standard input.
    pub(super) fn read(&self) -> io::Result<Vec<u8>> {
        match self {
            Self::Stream => {
                let mut bytes = Vec::new();
                io::stdin().lock().read_to_end(&mut bytes)?;
                Ok(bytes)
            }
            Self::File(path) => fs::read(path),
        }
    }

    /// Whether it can be read again: streams and pipes give their bytes once.
    pub(super) fn is_regular_file(&self) -> bool {
        matches!(self, Self::File(path) if path.is_file())
    }

    /// Fails early where `write` would fail for want of a folder.
    pub(super) fn check_writable(&self) -> io::Result<()> {
        let Self::File(path) = self else { return Ok(()) };
        if path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
        }
        fs::metadata(folder_of(path)).map(|_| ())
    }

    /// Writes all `bytes`. A file appears whole or not at all: the bytes go into a temporary file of the same folder,
    /// which then takes its name. What is no file (a device, a pipe) is written directly.
    pub(super) fn write(&self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Stream => {
                let mut out = io::stdout().lock();
                match out.write_all(bytes).and_then(|()| out.flush()) {
                    // The reader had enough.
                    Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                    result => result,
                }
            }
            Self::File(path) => match fs::metadata(path) {
                Ok(found) if !found.is_file() => File::options().write(true).open(path)?.write_all(bytes),
                // A link stays a link.
                Ok(found) => replace(&fs::canonicalize(path)?, bytes, Some(found.permissions())),
                Err(_) => replace(path, bytes, None),
            },
        }
    }
}

/// What went wrong with a file, without the number that the system has for it.
pub(super) fn told(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error ").next().unwrap_or(&text).to_owned()
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn replace(path: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".meshmend-");
    // As a plain new file: what the process's mask leaves of it.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder_of(path))?;
    file.write_all(bytes)?;
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions)?;
    }
    file.persist(path)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_result_replaces_the_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.stl");
        for bytes in [&b"first"[..], b"second, longer"] {
            FileOrStream::File(path.clone()).write(bytes).unwrap();
            assert_eq!(fs::read(&path).unwrap(), bytes);
            assert_eq!(names(folder.path()), ["out.stl"]);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_replaced_file_keeps_its_permissions_and_a_link_stays_a_link() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("out.stl"), folder.path().join("link.stl"));
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        FileOrStream::File(link.clone()).write(b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[test]
    fn a_folder_or_a_place_without_one_is_told_before_the_work() {
        let folder = tempfile::tempdir().unwrap();
        assert!(FileOrStream::File(folder.path().to_owned()).check_writable().is_err());
        assert!(FileOrStream::File(folder.path().join("no/out.stl")).check_writable().is_err());
        assert!(FileOrStream::File(folder.path().join("out.stl")).check_writable().is_ok());
        assert!(FileOrStream::File("out.stl".into()).check_writable().is_ok());
    }

    #[test]
    fn what_went_wrong_has_no_number() {
        assert_eq!(told(&io::Error::from_raw_os_error(2)), "No such file or directory");
        assert_eq!(told(&io::Error::other("it is a folder")), "it is a folder");
    }

    #[test]
    fn results_of_several_targets_are_numbered_before_the_extension() {
        let numbered = |path: &str| FileOrStream::File(path.into()).numbered(2).to_string();
        assert_eq!(numbered("a.b/part.v1.stl"), "a.b/part.v1-2.stl");
        assert_eq!(numbered("part"), "part-2");
    }

    #[test]
    fn the_extension_names_the_format_in_any_case() {
        assert_eq!("a/b.STL".parse::<FileOrStream>().unwrap().format(), Some(Format::Stl));
        assert_eq!("a/b".parse::<FileOrStream>().unwrap().format(), None);
        assert_eq!("-".parse::<FileOrStream>().unwrap(), FileOrStream::Stream);
    }
}
