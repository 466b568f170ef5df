//! How much memory a job will take, as far as its upload tells.

use crate::wire::{Format, Operation};

/// What every run takes, in bytes.
const BASE: u64 = 64 << 20;

/// The most that a run probably takes, in bytes.
///
/// Measured peaks of a whole process are 166 bytes for a triangle of an analysis and 405 of a repair that rebuilds
/// (docs/campaigns/speed.md). How many bytes of a file make a triangle depends on its format: 50 in a binary STL, about
/// 36 in OBJ and OFF, 19 in a binary PLY. A format that is not known yet may be the densest one. This decides only who
/// runs beside whom: what a job may take is limited by `engine_bytes_max`.
pub(super) fn estimated_bytes(operation: Operation, format: Option<Format>, upload_bytes: u64) -> u64 {
    let per_triangle = match operation {
        Operation::Analyze | Operation::Verify | Operation::Convert | Operation::CutStitch => 170,
        Operation::Plan | Operation::Repair | Operation::Simplify | Operation::FillHoles => 410,
        // Exact planes and points, and the boxes around them: 1 to 2 kB for each triangle of parts that were measured.
        Operation::Modeller => 2000,
    };
    let file_bytes_per_triangle = match format {
        Some(Format::Stl) => 50,
        Some(Format::Obj | Format::Off) => 36,
        Some(Format::Ply) | None => 19,
    };
    (upload_bytes / file_bytes_per_triangle).saturating_mul(per_triangle).saturating_add(BASE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_denser_format_and_a_deeper_operation_are_thought_to_take_more() {
        let of = |operation, format| estimated_bytes(operation, format, 50 << 20);
        assert_eq!(of(Operation::Analyze, Some(Format::Stl)), BASE + (1 << 20) * 170);
        assert!(of(Operation::Repair, Some(Format::Stl)) > of(Operation::Analyze, Some(Format::Stl)));
        assert!(of(Operation::Repair, None) > of(Operation::Repair, Some(Format::Obj)));
        assert_eq!(estimated_bytes(Operation::Repair, None, u64::MAX), u64::MAX);
    }
}
