//! How many triangles the header of a PLY file leaves room for.

use super::header::{DataEncoding, Header, PlyElement, PropertyType};

/// The most triangles of a file of `file_bytes` bytes with the header at the beginning of `start`. `None`: it has none, or
/// its values are text whose length says little.
pub(in crate::formats) fn header_triangles_at_most(start: &[u8], file_bytes: u64) -> Option<u64> {
    let header = Header::read(start).ok()?;
    let least =
        |element: &PlyElement<'_>| element.count.saturating_mul(element.bytes_min(header.layout) as u64);
    let taken: u64 = header.elements.iter().map(least).fold(0, u64::saturating_add);
    let rest = file_bytes.saturating_sub(header.end as u64).saturating_sub(taken);
    let of = |name: &[u8]| header.elements.iter().find(|element| element.name == name && element.count > 0);
    if let Some(strips) = of(b"tristrips") {
        // In text, a digit and a blank.
        return Some(rest / index_width(strips, header.layout).unwrap_or(2));
    }
    let faces = of(b"face")?;
    let corners = rest / index_width(faces, header.layout)?;
    Some(corners.saturating_sub(faces.count.saturating_mul(2)))
}

/// Bytes of an index in the element's list, unless values are text.
fn index_width(element: &PlyElement<'_>, layout: DataEncoding) -> Option<u64> {
    if layout == DataEncoding::Ascii {
        return None;
    }
    element.properties.iter().find_map(|property| match property.kind {
        PropertyType::List { item, .. } => Some(item.width() as u64),
        PropertyType::One(_) => None,
    })
}
