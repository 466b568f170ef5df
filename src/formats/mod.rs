//! Bytes to [`Soup`] and back, under limits.
//!
//! Reading never panics and never allocates from an unchecked count: a broken file gives a [`ReadError`] with its
//! place, broken content (NaN, an index out of range) gives a soup that names it.

mod announced;
mod colors;
mod cursor;
mod decimals;
mod error;
mod faces;
mod float32;
mod foreign;
mod gltf;
mod numbers;
mod obj;
mod obstacles;
mod off;
mod ply;
mod polygons;
mod ring_set;
mod sniff;
mod stl;
pub mod threemf;
mod words;

pub use announced::triangles_at_most;
pub use error::{Place, ReadError, ReadErrorKind, WriteError};
pub use gltf::two_sided_materials;
pub use obj::materials::color_faces;
pub use polygons::split_polygon;
pub use sniff::sniff;

use crate::budget::{Budget, Stopped};
use crate::mesh::Soup;

/// What is left out of a file that goes on behind the faces that its header announces: so many bytes.
pub(crate) const BYTES_BEHIND: &str = "bytes_behind_triangles";

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stereolithography, binary or ASCII.
    Stl,
    /// Object file format of Geomview, with its colour variants.
    Off,
    /// Polygon file format, ASCII or binary.
    Ply,
    /// glTF 2.0 in one binary file.
    Glb,
    /// glTF 2.0 as JSON that holds its data.
    Gltf,
    /// 3D Manufacturing Format.
    ThreeMf,
}

/// A format together with the way its bytes are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Encoding {
    /// OBJ text.
    Obj,
    /// Binary STL.
    StlBinary,
    /// ASCII STL.
    StlAscii,
    /// OFF text.
    Off,
    /// Binary OFF (big-endian).
    OffBinary,
    /// PLY text.
    PlyAscii,
    /// Binary little-endian PLY.
    PlyBinaryLittleEndian,
    /// Binary big-endian PLY.
    PlyBinaryBigEndian,
    /// GLB.
    Glb,
    /// glTF JSON.
    Gltf,
    /// The package of a 3MF.
    ThreeMf,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 7] =
        [Self::Obj, Self::Stl, Self::Off, Self::Ply, Self::ThreeMf, Self::Glb, Self::Gltf];

    /// The format's name in options and its usual file extension.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Ply => "ply",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::ThreeMf => "3mf",
        }
    }

    /// The format of this name or file extension, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name))
    }

    /// True when the format itself says that its coordinates are metres.
    pub fn is_in_metres(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }

    /// How a new file of this format is laid out when nothing else is asked.
    pub fn default_encoding(self) -> Encoding {
        match self {
            Self::Obj => Encoding::Obj,
            Self::Stl => Encoding::StlBinary,
            Self::Off => Encoding::Off,
            Self::Ply => Encoding::PlyBinaryLittleEndian,
            Self::Glb => Encoding::Glb,
            Self::Gltf => Encoding::Gltf,
            Self::ThreeMf => Encoding::ThreeMf,
        }
    }
}

impl Encoding {
    /// The format of which this is a layout.
    pub fn format(self) -> Format {
        match self {
            Self::Obj => Format::Obj,
            Self::StlBinary | Self::StlAscii => Format::Stl,
            Self::Off | Self::OffBinary => Format::Off,
            Self::PlyAscii | Self::PlyBinaryLittleEndian | Self::PlyBinaryBigEndian => Format::Ply,
            Self::Glb => Format::Glb,
            Self::Gltf => Format::Gltf,
            Self::ThreeMf => Format::ThreeMf,
        }
    }

    /// Whether all of it is text.
    fn is_text(self) -> bool {
        matches!(self, Self::Obj | Self::StlAscii | Self::Off | Self::PlyAscii)
    }

    /// True when coordinates are float32 and nothing else.
    pub fn is_float32(self) -> bool {
        matches!(self, Self::StlBinary | Self::Glb | Self::Gltf)
    }

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::StlBinary => "stl-binary",
            Self::StlAscii => "stl-ascii",
            Self::Off => "off",
            Self::OffBinary => "off-binary",
            Self::PlyAscii => "ply-ascii",
            Self::PlyBinaryLittleEndian => "ply-binary-little-endian",
            Self::PlyBinaryBigEndian => "ply-binary-big-endian",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::ThreeMf => "3mf",
        }
    }
}

/// How decimals become coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Precision {
    /// Rounded to the nearest f64.
    #[default]
    F64,
    /// Rounded to the nearest f32 directly (not by way of f64), then widened. f64 values of binary files are rounded.
    F32,
}

/// Which reader takes OBJ files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ObjReader {
    /// Our own: line-positioned, keeps vertex numbering.
    #[default]
    Own,
    /// The `tobj` crate: as other Rust programs read the file; no line numbers.
    Tobj,
}

/// What a reader may take in. A file over a limit is refused with the limit's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadLimits {
    /// Most triangles after polygons are split.
    pub triangles_max: u32,
    /// Most vertices.
    pub vertices_max: u32,
    /// Most corners of one polygon.
    pub polygon_corners_max: u32,
}

impl Default for ReadLimits {
    fn default() -> Self {
        Self { triangles_max: 100_000_000, vertices_max: 300_000_000, polygon_corners_max: 65_536 }
    }
}

/// How to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadOptions {
    /// Limits on counts.
    pub limits: ReadLimits,
    /// Rounding of coordinates.
    pub precision: Precision,
    /// Reader of OBJ files.
    pub obj_reader: ObjReader,
}

/// Reads `bytes`, whose encoding is `encoding` (see [`sniff`]).
///
/// Faces of more than three corners are split: as a fan where that is right, otherwise by ear clipping on the
/// coordinate plane nearest to theirs ([`Polygons::not_fans`](crate::mesh::Polygons::not_fans) lists them).
///
/// # Errors
/// A [`ReadError`] with the line or byte where reading had to end and what was expected there.
pub fn read(
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    if encoding.is_text() {
        words::check_text(bytes)?;
    }
    match encoding {
        Encoding::Obj => match options.obj_reader {
            ObjReader::Own => obj::read::read(bytes, options, budget),
            ObjReader::Tobj => obj::read_with_tobj::read(bytes, options, budget),
        },
        Encoding::StlBinary => stl::read_binary::read(bytes, options, budget),
        Encoding::StlAscii => stl::read_ascii::read(bytes, options, budget),
        Encoding::Off => off::read::read(bytes, options, budget),
        Encoding::OffBinary => off::read_binary::read(bytes, options, budget),
        Encoding::PlyAscii | Encoding::PlyBinaryLittleEndian | Encoding::PlyBinaryBigEndian => {
            ply::read::read(bytes, options, budget)
        }
        Encoding::Glb | Encoding::Gltf => gltf::read::read(bytes, encoding, options, budget),
        Encoding::ThreeMf => threemf::read::read(bytes, options, budget),
    }
}

/// Reads the parts of a file, each in its own coordinates: the meshes of a 3MF that have to be solids. A file of another
/// format is one part.
///
/// # Errors
/// As [`read`].
pub fn read_parts(
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Vec<Soup>, ReadError> {
    match encoding {
        Encoding::ThreeMf => threemf::read::read_solids(bytes, options, budget),
        _ => Ok(vec![read(bytes, encoding, options, budget)?]),
    }
}

/// Writes the triangles of `soup` (not its polygons) with its vertex colours and, where the format holds them, its
/// face colours. Deterministic: the same soup gives the same bytes. Binary STL and glTF hold coordinates exactly when
/// they are float32 values; text prints the shortest decimal that reads back as the same f64.
///
/// # Errors
/// A coordinate that the encoding cannot hold (not finite, or beyond the range of f32 in STL); a stopped budget.
pub fn write(soup: &Soup, encoding: Encoding, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    match encoding {
        Encoding::Obj => obj::write::write(soup, budget),
        Encoding::StlBinary => stl::write::binary(soup, budget),
        Encoding::StlAscii => stl::write::ascii(soup, budget),
        Encoding::Off => off::write::text(soup, budget),
        Encoding::OffBinary => off::write::binary(soup, budget),
        Encoding::PlyAscii | Encoding::PlyBinaryLittleEndian | Encoding::PlyBinaryBigEndian => {
            ply::write::write(soup, encoding, budget)
        }
        Encoding::Glb | Encoding::Gltf => gltf::write::write(soup, encoding, budget),
        Encoding::ThreeMf => threemf::write::write(soup, budget),
    }
}

/// The order in which [`write`](fn@write) writes the triangles of `soup`; `None`: their own. OBJ keeps triangles of one object
/// together, and glTF those of one object and one material.
pub fn stored_order(soup: &Soup, encoding: Encoding) -> Option<Vec<u32>> {
    match encoding {
        Encoding::Glb | Encoding::Gltf => gltf::stored_order(soup),
        Encoding::Obj => obj::stored_order(soup),
        _ => None,
    }
}

impl From<Stopped> for ReadError {
    fn from(stopped: Stopped) -> Self {
        Self { kind: ReadErrorKind::Stopped(stopped), place: Place::Whole, expected: String::new() }
    }
}
