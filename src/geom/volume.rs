//! Area and volume: rounded figures for reports, and the exact sign of a volume for decisions.

use super::exact::{BitSpan, det3};
use super::{DVec3, Sign};
use num_bigint::BigInt;

/// Triangles between two calls of the caller's check.
const CHECK_EVERY: usize = 4096;

/// Area of a triangle, in square units of the coordinates; infinite when it exceeds the range of f64.
pub fn triangle_area([a, b, c]: [DVec3; 3]) -> f64 {
    finite_or_infinite((b - a).cross(c - a).length() / 2.0)
}

/// Volume enclosed by closed oriented triangles, in cubic units of the coordinates, positive when they turn
/// counter-clockwise seen from outside; infinite when it exceeds the range of f64. For a list that is not closed it is
/// the volume of the cone over it from the first corner.
///
/// Rounded, summed with compensation (Neumaier 1974); use [`volume_sign`] for decisions.
pub fn signed_volume(triangles: impl IntoIterator<Item = [DVec3; 3]>) -> f64 {
    let mut origin = None;
    let (mut sum, mut lost) = (0.0f64, 0.0f64);
    for corners in triangles {
        let origin = *origin.get_or_insert(corners[0]);
        let term = rounded_det(corners, origin).value;
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    finite_or_infinite((if sum.is_finite() { sum + lost } else { sum }) / 6.0)
}

/// Infinity in place of the NaN that the difference of two overflown products is.
fn finite_or_infinite(value: f64) -> f64 {
    if value.is_nan() { f64::INFINITY } else { value }
}

/// Sign of the volume enclosed by closed oriented triangles, exact for all finite coordinates: positive when they turn
/// counter-clockwise seen from outside. The list must be closed (each edge as often in one direction as in the
/// other), so that the sum of `det(a, b, c)`, six times the volume, does not depend on the origin.
///
/// `check` is called at least every 4,096 triangles.
///
/// # Errors
/// Those of `check`.
pub fn volume_sign<E>(
    triangles: impl Iterator<Item = [DVec3; 3]> + Clone,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Sign, E> {
    match filtered_sign(triangles.clone(), &mut check)? {
        Some(sign) => Ok(sign),
        None => exact_sign(triangles, &mut check),
    }
}

/// The sign, if the rounded sum is further from zero than its error can be.
///
/// With `e = 2^-53`: a term has an error of at most `9 e` times its magnitude sum plus what underflow adds (analysis in
/// [`super::predicates`], the origin being one of the corners of all input); adding `n` terms has one of at most
/// `n e / (1 - n e)` times the sum of their magnitudes (Higham 2002, section 4.2), and the sum of magnitude sums, itself
/// rounded `n + 8` times, is at least half the true one. `2 (n + 9) e` times twice that sum covers everything for
/// `n < 2^40`, and a slack of `2^-1000` times the reach of each triangle covers underflow.
fn filtered_sign<E>(
    triangles: impl Iterator<Item = [DVec3; 3]>,
    check: &mut impl FnMut() -> Result<(), E>,
) -> Result<Option<Sign>, E> {
    let mut origin = None;
    let (mut sum, mut spread, mut reach, mut count) = (0.0f64, 0.0f64, 0.0f64, 0usize);
    for corners in triangles {
        if count.is_multiple_of(CHECK_EVERY) {
            check()?;
        }
        let origin = *origin.get_or_insert(corners[0]);
        let term = rounded_det(corners, origin);
        sum += term.value;
        spread += term.spread;
        reach += term.reach;
        count += 1;
    }
    let error = (count + 9) as f64 * (2.0 * f64::EPSILON) * spread + reach * 2f64.powi(-1000);
    // An overflow makes the error infinite or NaN, and then neither comparison holds.
    Ok(if sum > error {
        Some(Sign::Positive)
    } else if -sum > error {
        Some(Sign::Negative)
    } else {
        None
    })
}

/// `det(a - o, b - o, c - o)`, rounded, and what bounds its error.
struct RoundedDet {
    value: f64,
    /// Sum of the magnitudes of its six products.
    spread: f64,
    /// Sum of the magnitudes of the factors that an underflow in a product is multiplied by.
    reach: f64,
}

fn rounded_det([a, b, c]: [DVec3; 3], origin: DVec3) -> RoundedDet {
    let [u0, u1, u2] = [a.x - origin.x, a.y - origin.y, a.z - origin.z];
    let [v0, v1, v2] = [b.x - origin.x, b.y - origin.y, b.z - origin.z];
    let [w0, w1, w2] = [c.x - origin.x, c.y - origin.y, c.z - origin.z];
    let (p0, p1, p2) = (u1 * v2, u2 * v0, u0 * v1);
    let (m0, m1, m2) = (u2 * v1, u0 * v2, u1 * v0);
    let value = w0 * (p0 - m0) + w1 * (p1 - m1) + w2 * (p2 - m2);
    let [w0, w1, w2] = [w0.abs(), w1.abs(), w2.abs()];
    let spread = w0 * (p0.abs() + m0.abs()) + w1 * (p1.abs() + m1.abs()) + w2 * (p2.abs() + m2.abs());
    RoundedDet { value, spread, reach: 1.0 + w0 + w1 + w2 }
}

/// Coordinates of at most 40 bits: a determinant of them has at most 123.
const I128_BITS_MAX: i32 = 40;

fn exact_sign<E>(
    triangles: impl Iterator<Item = [DVec3; 3]> + Clone,
    check: &mut impl FnMut() -> Result<(), E>,
) -> Result<Sign, E> {
    let mut span = BitSpan::ZERO;
    for (i, corners) in triangles.clone().enumerate() {
        if i.is_multiple_of(CHECK_EVERY) {
            check()?;
        }
        span = corners.iter().flat_map(DVec3::to_array).fold(span, BitSpan::with);
    }
    let mut total = BigInt::ZERO;
    let mut part = 0i128;
    for (i, corners) in triangles.enumerate() {
        if i.is_multiple_of(CHECK_EVERY) {
            check()?;
        }
        if span.bits() <= I128_BITS_MAX {
            let [a, b, c] = corners.map(|p| p.to_array().map(|x| span.to_i128(x)));
            let term = det3(&a, &b, &c);
            part = part.checked_add(term).unwrap_or_else(|| {
                total += part;
                term
            });
        } else {
            let [a, b, c] = corners.map(|p| p.to_array().map(|x| span.to_big(x)));
            total += det3(&a, &b, &c);
        }
    }
    Ok(Sign::of(&(total + part)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// A tetrahedron with its corner at `o` and legs of length `s`, outward.
    fn tetrahedron(o: DVec3, s: f64) -> Vec<[DVec3; 3]> {
        let [a, b, c, d] = [o, o + DVec3::X * s, o + DVec3::Y * s, o + DVec3::Z * s];
        vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
    }

    fn inside_out(surface: &[[DVec3; 3]]) -> Vec<[DVec3; 3]> {
        surface.iter().map(|&[a, b, c]| [a, c, b]).collect()
    }

    fn sign(surface: &[[DVec3; 3]]) -> Sign {
        volume_sign(surface.iter().copied(), || Ok::<_, Infallible>(())).unwrap()
    }

    #[test]
    fn outward_is_positive_at_every_scale_and_far_from_the_origin() {
        for (o, s) in [
            (DVec3::ZERO, 1.0),
            (DVec3::splat(1e15), 1.0),
            (DVec3::ZERO, 1e-200),
            (DVec3::ZERO, f64::from_bits(1)),
            (DVec3::splat(-1e300), 1e305),
            (DVec3::ZERO, f64::MAX),
        ] {
            let surface = tetrahedron(o, s);
            assert_eq!(sign(&surface), Sign::Positive, "{o} {s}");
            assert_eq!(sign(&inside_out(&surface)), Sign::Negative, "{o} {s}");
        }
    }

    #[test]
    fn a_folded_surface_has_exactly_no_volume() {
        let mut surface = tetrahedron(DVec3::splat(0.1), 0.7);
        surface.extend(inside_out(&surface));
        assert_eq!(sign(&surface), Sign::Zero);
        assert_eq!(sign(&[]), Sign::Zero);
    }

    #[test]
    fn the_smallest_difference_of_two_huge_volumes_is_seen() {
        let mut surface = tetrahedron(DVec3::ZERO, 1e9);
        surface.extend(inside_out(&surface));
        surface.extend(tetrahedron(DVec3::ZERO, 1e-9));
        assert_eq!(sign(&surface), Sign::Positive);
    }

    #[test]
    fn sums_of_the_integer_tier_do_not_overflow() {
        let side = 2f64.powi(40) - 1.0;
        let mut surface: Vec<_> = (0..100).flat_map(|_| tetrahedron(DVec3::ZERO, side)).collect();
        surface.extend((0..100).flat_map(|_| inside_out(&tetrahedron(DVec3::ZERO, side))));
        let check = &mut || Ok::<_, Infallible>(());
        assert_eq!(exact_sign(surface.iter().copied(), check).unwrap(), Sign::Zero);
        surface.extend(tetrahedron(DVec3::ZERO, 1.0));
        assert_eq!(exact_sign(surface.iter().copied(), check).unwrap(), Sign::Positive);
    }

    #[test]
    fn rounded_figures_are_close_and_overflow_to_infinity() {
        let volume = signed_volume(tetrahedron(DVec3::splat(1e3), 2.0));
        assert!((volume - 8.0 / 6.0).abs() < 1e-12, "{volume}");
        assert_eq!(signed_volume(tetrahedron(DVec3::ZERO, 1e200)), f64::INFINITY);
        assert_eq!(signed_volume([]), 0.0);
        assert_eq!(triangle_area([DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 3.0]), 3.0);
        assert_eq!(triangle_area([DVec3::ZERO, DVec3::X * 1e200, DVec3::Y * 1e200]), f64::INFINITY);
    }
}
