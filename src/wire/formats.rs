//! The file formats, their media types and extensions.

use serde::Serialize;
use utoipa::ToSchema;

use super::words::{Encoding, Format};

/// What is to be known about a format.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FormatInfo {
    /// Name in options.
    pub name: Format,
    /// Media types that name it; the first one is used in answers.
    pub media_types: &'static [&'static str],
    /// File extensions.
    pub extensions: &'static [&'static str],
    /// Layouts, in the words of reports.
    pub encodings: &'static [Encoding],
    /// It can be read.
    pub read: bool,
    /// It can be written.
    pub write: bool,
}

/// Every format: the answer of `/v1/formats`.
pub fn formats() -> Vec<FormatInfo> {
    Format::ALL.iter().copied().map(FormatInfo::of).collect()
}

impl FormatInfo {
    /// The facts about `format`.
    pub fn of(format: Format) -> Self {
        let (media_types, encodings): (&[&str], &[Encoding]) = match format {
            Format::Obj => (&["model/obj"], &[Encoding::Obj]),
            Format::Stl => (
                &[
                    "model/stl",
                    "model/x.stl-binary",
                    "model/x.stl-ascii",
                    "application/sla",
                    "application/vnd.ms-pki.stl",
                ],
                &[Encoding::StlBinary, Encoding::StlAscii],
            ),
            Format::Off => {
                (&["text/off", "model/off", "application/x-off"], &[Encoding::Off, Encoding::OffBinary])
            }
            Format::Ply => (
                &["application/x-ply", "model/ply"],
                &[Encoding::PlyAscii, Encoding::PlyBinaryLittleEndian, Encoding::PlyBinaryBigEndian],
            ),
            Format::Glb => (&["model/gltf-binary"], &[Encoding::Glb]),
            Format::Gltf => (&["model/gltf+json"], &[Encoding::Gltf]),
            Format::ThreeMf => (&["model/3mf", "application/vnd.ms-3mfdocument"], &[Encoding::ThreeMf]),
        };
        Self {
            name: format,
            media_types,
            extensions: extensions_of(format),
            encodings,
            read: true,
            write: true,
        }
    }
}

fn extensions_of(format: Format) -> &'static [&'static str] {
    match format {
        Format::Obj => &["obj"],
        Format::Stl => &["stl"],
        Format::Off => &["off"],
        Format::Ply => &["ply"],
        Format::Glb => &["glb"],
        Format::Gltf => &["gltf"],
        Format::ThreeMf => &["3mf"],
    }
}

/// The usual extension of `format`, without the dot.
pub fn extension_of(format: Format) -> &'static str {
    extensions_of(format)[0]
}

/// The media type that answers in `format` carry.
pub fn media_type_of(format: Format) -> &'static str {
    FormatInfo::of(format).media_types[0]
}

/// The format that a media type (without parameters, in any case) names.
pub fn format_of_media_type(media_type: &str) -> Option<Format> {
    let names = |&format: &Format| {
        FormatInfo::of(format).media_types.iter().any(|m| m.eq_ignore_ascii_case(media_type))
    };
    Format::ALL.iter().copied().find(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_media_type_names_one_format() {
        for info in formats() {
            for media_type in info.media_types {
                assert_eq!(format_of_media_type(media_type), Some(info.name));
                assert_eq!(format_of_media_type(&media_type.to_uppercase()), Some(info.name));
            }
        }
        assert_eq!(format_of_media_type("application/octet-stream"), None);
    }

    #[test]
    fn every_encoding_of_the_engine_is_listed_under_its_format() {
        for &encoding in Encoding::ALL {
            let format = Format::from(crate::formats::Encoding::from(encoding).format());
            assert!(FormatInfo::of(format).encodings.contains(&encoding), "{encoding}");
        }
    }
}
