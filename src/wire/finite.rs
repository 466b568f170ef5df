//! Numbers that JSON can hold.

use glam::DVec3;

/// The number, if JSON can hold it.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The point, if JSON can hold it.
pub(super) fn point(position: &DVec3) -> Option<[f64; 3]> {
    position.is_finite().then(|| position.to_array())
}
