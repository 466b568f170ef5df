//! The plane and the extent of a boundary loop.

use crate::geom::{Aabb, DVec3};

/// How far from its mean plane a loop may be to count as flat, as a share of its size: some float32 steps of a
/// coordinate ten times that size.
pub(super) const FLAT_SHARE_MAX: f64 = 1e-5;

/// A boundary loop as a closed polyline.
pub(super) struct LoopPolyline {
    pub(super) normal: DVec3,
    pub(super) area: f64,
    pub(super) bounds: Aabb,
    pub(super) is_flat: bool,
    pub(super) points: Vec<DVec3>,
}

/// Newell's normal and what else is asked of a loop.
pub(super) fn shape(points: Vec<DVec3>) -> LoopPolyline {
    let bounds = Aabb::of(points.iter().copied());
    let (origin, size) = (points[0], bounds.diagonal());
    let next = points.iter().cycle().skip(1);
    let cross: DVec3 =
        points.iter().zip(next).map(|(a, b)| ((a - origin) / size).cross((b - origin) / size)).sum();
    let normal = cross.try_normalize().unwrap_or(DVec3::ZERO);
    let is_flat = normal != DVec3::ZERO
        && points.iter().all(|p| (p - origin).dot(normal).abs() <= FLAT_SHARE_MAX * size);
    LoopPolyline { normal, area: cross.length() * size * size, bounds, is_flat, points }
}
