//! The plane of a face whose corners were rounded, with short integers.

use crate::geom::DVec3;
use crate::modeller::exact::rational;
use crate::modeller::plane::Plane;
use num_bigint::BigInt;

/// Bits of the components of a fitted normal: an error of 2^-40 is far below that of float32 coordinates.
const NORMAL_BITS: i32 = 40;

/// The plane nearest to `corners` whose doubled area vector is `normal`: perpendicular to an axis when that is within
/// `tolerance` of all corners. `None` when the normal is zero.
pub(super) fn fit(corners: &[DVec3], normal: DVec3, tolerance: f64) -> Option<Plane> {
    let unit = normal.try_normalize()?;
    if let Some(plane) = along_an_axis(corners, unit, tolerance) {
        return Some(plane);
    }
    let scale = crate::geom::power_of_two(NORMAL_BITS);
    let rounded = (unit * scale).round();
    let heights = corners.iter().map(|p| p.dot(rounded));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    // The middle between the farthest corners on either side.
    let offset = rational(low + (high - low) / 2.0);
    Some(Plane::new(rounded.to_array().map(|x| BigInt::from(x as i64)), offset))
}

fn along_an_axis(corners: &[DVec3], unit: DVec3, tolerance: f64) -> Option<Plane> {
    let axis = (0..3).find(|&k| unit[k].abs() > 0.999)?;
    let mut heights: Vec<f64> = corners.iter().map(|p| p[axis]).collect();
    heights.sort_unstable_by(f64::total_cmp);
    // A height that the file has: the median.
    let middle = heights[heights.len() / 2];
    let spread = (heights[heights.len() - 1] - middle).max(middle - heights[0]);
    let sign = if unit[axis] < 0.0 { -1 } else { 1 };
    let normal = std::array::from_fn(|k| BigInt::from(if k == axis { sign } else { 0 }));
    (spread <= tolerance).then(|| Plane::new(normal, rational(f64::from(sign) * middle)))
}
