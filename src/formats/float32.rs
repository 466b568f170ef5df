//! Coordinates as float32, for encodings that hold nothing else.

use super::WriteError;
use crate::geom::DVec3;

/// The coordinates of `vertex` rounded to float32.
///
/// # Errors
/// A coordinate that is not finite as a float32.
pub(super) fn rounded(vertex: u32, p: DVec3, encoding: &'static str) -> Result<[f32; 3], WriteError> {
    let rounded = p.to_array().map(|c| c as f32);
    match (0..3).find(|&k| !rounded[k].is_finite()) {
        Some(k) => Err(WriteError::NotRepresentable { vertex, value: p[k], encoding }),
        None => Ok(rounded),
    }
}
