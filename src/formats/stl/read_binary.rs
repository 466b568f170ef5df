//! Binary STL: 80 free bytes, the number of triangles, then 50 bytes for each.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::formats::faces::Faces;
use crate::formats::{BYTES_BEHIND, Place, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::par;
use crate::spatial::coincident_f32;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;
/// The normal stands before the corners.
const NORMAL_BYTES: usize = 12;
const CORNER_BYTES: usize = 12;

/// Length of the file that the header of `bytes` announces, if there is a whole header.
pub(in crate::formats) fn announced_length(bytes: &[u8]) -> Option<u64> {
    announced_triangles(bytes).map(|count| HEADER_BYTES as u64 + TRIANGLE_BYTES as u64 * u64::from(count))
}

/// The number of triangles that the header announces, if there is a whole header.
pub(in crate::formats) fn announced_triangles(bytes: &[u8]) -> Option<u32> {
    bytes[..HEADER_BYTES.min(bytes.len())]
        .last_chunk::<4>()
        .map(|&b| u32::from_le_bytes(b))
        .filter(|_| bytes.len() >= HEADER_BYTES)
}

/// Reads as many triangles as the header announces and welds bit-equal corners. Attribute bytes and whatever follows the last
/// triangle are counted; normals are ignored.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let end = Place::Byte(bytes.len() as u64);
    let (Some(count), Some(length)) = (announced_triangles(bytes), announced_length(bytes)) else {
        return Err(ReadError::truncated(end, "a binary STL header of 84 bytes"));
    };
    if (bytes.len() as u64) < length {
        let expected =
            format!("{length} bytes: 84 and 50 for each of the {count} triangles announced at byte 80");
        return Err(ReadError::truncated(end, expected));
    }
    if count == 0 {
        return Err(ReadError::empty("triangles (the count at byte 80 is 0)"));
    }
    options.limits.check_triangles(u64::from(count))?;

    let records = &bytes[HEADER_BYTES..length as usize];
    let (mut triangles, _charged) = budget.vec::<[u32; 3]>(count as usize)?;
    triangles.resize(count as usize, [0; 3]);
    let first = coincident_f32(|i| corner(records, i), triangles.as_flattened_mut(), budget)?;
    options.limits.check_vertices(first.len() as u64)?;
    let (mut positions, _charged) = budget.vec::<DVec3>(first.len())?;
    positions.resize(first.len(), DVec3::ZERO);
    par::for_each_chunk_mut(&mut positions, CHECK_EVERY, |begin, positions| {
        for (position, &i) in positions.iter_mut().zip(&first[begin..]) {
            *position = DVec3::from(corner(records, i as usize).map(f64::from));
        }
    });

    let soup = Faces::of_triangles(triangles).into_soup(positions, &options.limits, budget)?;
    let marked = count_attributes(records, budget)?;
    let behind = bytes.len() as u64 - length;
    let left_out = [("attribute_bytes", marked), (BYTES_BEHIND, behind)];
    let left_out = left_out.into_iter().filter(|&(_, count)| count > 0).collect();
    Ok(Soup { is_welded_by_format: true, left_out, ..soup })
}

/// Number of triangles whose attribute bytes, the last two, are not zero: some programs keep colours there.
fn count_attributes(records: &[u8], budget: &Budget) -> Result<u64, Stopped> {
    let counts = par::try_map_ranges(records.len() / TRIANGLE_BYTES, CHECK_EVERY, |range| {
        budget.check()?;
        let of_range = &records[range.start * TRIANGLE_BYTES..range.end * TRIANGLE_BYTES];
        let is_marked = |record: &&[u8]| !record.ends_with(&[0, 0]);
        Ok(of_range.chunks_exact(TRIANGLE_BYTES).filter(is_marked).count() as u64)
    })?;
    Ok(counts.into_iter().sum())
}

/// Corner `i % 3` of triangle `i / 3`.
#[inline]
fn corner(records: &[u8], i: usize) -> [f32; 3] {
    let at = i / 3 * TRIANGLE_BYTES + NORMAL_BYTES + i % 3 * CORNER_BYTES;
    match records[at..].first_chunk::<CORNER_BYTES>() {
        Some(&[a, b, c, d, e, f, g, h, i, j, k, l]) => [
            f32::from_le_bytes([a, b, c, d]),
            f32::from_le_bytes([e, f, g, h]),
            f32::from_le_bytes([i, j, k, l]),
        ],
        None => [f32::NAN; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{FaceFault, FaceFaultReason};

    fn file(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = b"solid no text follows".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for corners in triangles {
            bytes.extend([0; 12]);
            bytes.extend(corners.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
            bytes.extend([7, 9]);
        }
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Soup, ReadError> {
        super::read(bytes, &ReadOptions::default(), &Budget::unlimited())
    }

    const A: [f32; 3] = [0.0, 0.0, 0.1];
    const B: [f32; 3] = [1.0, 0.0, 0.0];
    const C: [f32; 3] = [0.0, 1.0, 0.0];
    const D: [f32; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn equal_corners_become_one_vertex_numbered_by_first_use() {
        let soup = read(&file(&[[A, B, C], [D, C, B]])).unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2], [3, 2, 1]]);
        assert_eq!(soup.positions[0], DVec3::new(0.0, 0.0, f64::from(0.1f32)));
        assert_eq!((soup.positions.len(), soup.face_count), (4, 2));
        assert!(soup.is_welded_by_format && soup.is_f32_exact);
    }

    #[test]
    fn a_triangle_with_nan_is_a_fault_and_the_rest_is_read() {
        let soup = read(&file(&[[A, B, [f32::NAN, 0.0, 0.0]], [A, B, C]])).unwrap();
        assert_eq!(soup.face_faults, [FaceFault { face: 0, reason: FaceFaultReason::NonFinite }]);
        assert_eq!((soup.triangle_face, soup.non_finite_vertices), (vec![1], vec![2]));
        assert_eq!(soup.triangles, [[0, 1, 3]]);
    }

    #[test]
    fn triangles_with_attribute_bytes_are_counted() {
        let mut bytes = file(&[[A, B, C], [D, C, B], [A, C, D]]);
        bytes[132..134].fill(0);
        assert_eq!(read(&bytes).unwrap().left_out, [("attribute_bytes", 2)]);
        bytes[182..184].fill(0);
        bytes[232] = 0;
        assert_eq!(read(&bytes).unwrap().left_out, [("attribute_bytes", 1)]);
        bytes[233] = 0;
        assert_eq!(read(&bytes).unwrap().left_out, []);
    }

    #[test]
    fn a_missing_byte_is_an_error_at_the_end_and_a_byte_too_many_is_counted() {
        let mut bytes = file(&[[A, B, C]]);
        bytes.push(0);
        let soup = read(&bytes).unwrap();
        assert_eq!((soup.triangles.len(), soup.left_out.last()), (1, Some(&(BYTES_BEHIND, 1))));
        let error = read(&bytes[..133]).unwrap_err().to_string();
        assert!(error.starts_with("byte 133: the file ends here; expected 134 bytes"), "{error}");
        assert!(read(&bytes[..83]).is_err());
        assert!(read(&file(&[])).unwrap_err().to_string().contains("empty"));
    }

    #[test]
    fn an_absurd_count_is_an_error_without_allocation() {
        let mut bytes = file(&[[A, B, C]]);
        bytes[80..84].fill(0xFF);
        assert!(read(&bytes).unwrap_err().to_string().contains("4294967295 triangles"));
    }
}
