//! How much memory a job will take, as far as its upload tells.

use crate::pipeline;
use crate::wire::{Format, Operation};

/// What every run takes, in bytes.
const BASE: u64 = 64 << 20;

/// The most that a run probably takes, in bytes; `triangles`: how many there are at most, where the upload tells.
///
/// Measured peaks of a whole process are 166 bytes for a triangle of an analysis and 405 of a repair that rebuilds
/// (docs/campaigns/speed.md). How many bytes of a file make a triangle depends on its format: 50 in a binary STL, about
/// 36 in OBJ and OFF, 19 in a binary PLY, 12 in a GLB of short numbers, 8 to 12 in a 3MF. A format that is not known yet may be the densest one. So much is reserved for the
/// run, and it may charge no more; should it need more, it starts again when there is room for as much as any job may have.
pub(super) fn estimated_bytes(
    operation: Operation,
    format: Option<Format>,
    upload_bytes: u64,
    triangles: Option<u64>,
) -> u64 {
    let facts = pipeline::Operation::from(operation).facts();
    let file_bytes_per_triangle = match format {
        Some(Format::Stl) => 50,
        Some(Format::Obj | Format::Off) => 36,
        Some(Format::Ply) => 19,
        // Strips of small numbers and compressed views have fewer, and instances none.
        Some(Format::Gltf) => 16,
        Some(Format::Glb) | None => 12,
        Some(Format::ThreeMf) => 8,
    };
    let triangles = triangles.unwrap_or(upload_bytes / file_bytes_per_triangle);
    // The upload itself is read into memory.
    let of_mesh =
        triangles.saturating_mul(facts.bytes_per_triangle).saturating_add(upload_bytes).saturating_add(BASE);
    of_mesh.max(facts.bytes_min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_denser_format_and_a_deeper_operation_are_thought_to_take_more() {
        let of = |operation, format| estimated_bytes(operation, format, 50 << 20, None);
        assert_eq!(of(Operation::Analyze, Some(Format::Stl)), BASE + (50 << 20) + (1 << 20) * 170);
        assert!(of(Operation::Repair, Some(Format::Stl)) > of(Operation::Analyze, Some(Format::Stl)));
        assert!(of(Operation::Repair, None) > of(Operation::Repair, Some(Format::Obj)));
        assert_eq!(estimated_bytes(Operation::Repair, None, u64::MAX, None), u64::MAX);
    }

    #[test]
    fn what_the_upload_announces_counts_more_than_its_size() {
        let of = |triangles| estimated_bytes(Operation::Verify, Some(Format::Ply), 4 << 20, Some(triangles));
        assert_eq!(of(4 << 20), BASE + (4 << 20) + (4 << 20) * 170);
        assert_eq!(of(12), 256 << 20, "few triangles may still be much work");
    }
}
