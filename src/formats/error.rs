//! Where and why reading or writing ended.

use crate::budget::Stopped;
use crate::figures::figure;
use std::fmt;

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    Whole,
    /// A line, counted from 1.
    Line(u64),
    /// A byte offset, counted from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => f.write_str("file"),
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(offset) => write!(f, "byte {offset}"),
        }
    }
}

/// Why a file could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReadErrorKind {
    /// No bytes, or no element of a mesh.
    #[error("empty")]
    Empty,
    /// The content is not of any known format, or not of the named one.
    #[error("unknown format")]
    UnknownFormat,
    /// The content is of a format that is not read.
    #[error("this is {name}, which is not read here")]
    Foreign {
        /// Its name.
        name: &'static str,
    },
    /// The content breaks the format's rules.
    #[error("found {found}")]
    Unparseable {
        /// What stands there, shortened.
        found: String,
    },
    /// The file ends too early.
    #[error("the file ends here")]
    Truncated,
    /// A count is over a limit.
    #[error("{actual} {what} is over the limit {limit_name} = {limit}")]
    TooLarge {
        /// What is counted.
        what: &'static str,
        /// Name of the limit in the configuration.
        limit_name: &'static str,
        /// The limit.
        limit: u64,
        /// The file's count, as far as it is known.
        actual: u64,
    },
    /// The run was stopped.
    #[error("{0}")]
    Stopped(Stopped),
}

/// A file that could not be read: why, where, and what was expected there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    /// Why.
    pub kind: ReadErrorKind,
    /// Where.
    pub place: Place,
    /// What should have stood there; empty when that does not apply.
    pub expected: String,
}

impl ReadError {
    pub(super) fn empty(expected: &str) -> Self {
        Self { kind: ReadErrorKind::Empty, place: Place::Whole, expected: expected.to_owned() }
    }

    pub(super) fn foreign(name: &'static str) -> Self {
        let expected = match name {
            "gzip" => {
                "the mesh itself in STL, OBJ, OFF, PLY, 3MF or glTF: unpack the file first; a request may be compressed, which its header `Content-Encoding: gzip` says"
            }
            "STEP" | "OpenCASCADE BREP" => {
                "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF: export one from the CAD program, which divides curved surfaces as finely as it is told"
            }
            "AMF" | "compressed AMF" => {
                "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF: slicers save an AMF as 3MF, with its parts and colours"
            }
            "VRML" | "X3D" => "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF: PLY keeps the colours of vertices",
            "COLLADA" => {
                "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF: modelling programs export the scene as OBJ with its materials"
            }
            "text in UTF-16" | "text in UTF-32" => {
                "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF, as text in UTF-8"
            }
            _ => "a mesh in STL, OBJ, OFF, PLY, 3MF or glTF",
        };
        Self { kind: ReadErrorKind::Foreign { name }, place: Place::Whole, expected: expected.to_owned() }
    }

    pub(super) fn unparseable(place: Place, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { kind: ReadErrorKind::Unparseable { found: found.into() }, place, expected: expected.into() }
    }

    pub(super) fn truncated(place: Place, expected: impl Into<String>) -> Self {
        Self { kind: ReadErrorKind::Truncated, place, expected: expected.into() }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // What is said of the whole file needs no place.
        if self.place != Place::Whole {
            write!(f, "{}: ", self.place)?;
        }
        self.kind.fmt(f)?;
        if !self.expected.is_empty() {
            write!(f, "; expected {}", self.expected)?;
        }
        Ok(())
    }
}

impl std::error::Error for ReadError {}

/// A mesh that could not be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// A coordinate is not finite or beyond what the encoding can hold.
    #[error("vertex {vertex}: coordinate {} cannot be written as {encoding}", figure(*.value))]
    NotRepresentable {
        /// The vertex.
        vertex: u32,
        /// The coordinate.
        value: f64,
        /// Name of the encoding.
        encoding: &'static str,
    },
    /// The file would be longer than its format allows.
    #[error("{bytes} bytes are more than the {bytes_max} that {encoding} can hold")]
    TooLarge {
        /// Its length, or that of its largest part.
        bytes: u64,
        /// The most there may be.
        bytes_max: u64,
        /// Name of the encoding.
        encoding: &'static str,
    },
    /// The package around the mesh cannot be made.
    #[error("the package cannot be written: {reason}")]
    Package {
        /// Why.
        reason: String,
    },
    /// The run was stopped.
    #[error("{0}")]
    Stopped(#[from] Stopped),
}
