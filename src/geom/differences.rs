//! Determinants of points whose differences are small integers of a unit for each axis, as those of nearby points of a float32 mesh
//! are, or all the same on one axis, as in planes across an axis: the first of the exact tiers.
//!
//! A determinant of differences keeps its sign when an axis is scaled by a positive number.

use super::{DVec2, DVec3, Sign};

/// Differences have at most so many bits: minors of two of them fit 62 bits with their sign, and determinants of three 93.
const BITS: u64 = 30;

/// Sign of `det(b - a, c - a)`; `None` where the differences are no small integers.
#[inline]
pub(super) fn orient2d([a, b, c]: [DVec2; 3]) -> Option<Sign> {
    if (a.cmpeq(b) & a.cmpeq(c)).any() {
        return Some(Sign::Zero);
    }
    let [u0, v0] = differences(a.x, [b.x, c.x])?;
    let [u1, v1] = differences(a.y, [b.y, c.y])?;
    Some(Sign::of(&(u0 * v1 - u1 * v0)))
}

/// Sign of `det(b - a, c - a, d - a)`; `None` where the differences are no small integers.
#[inline]
pub(super) fn orient3d([a, b, c, d]: [DVec3; 4]) -> Option<Sign> {
    if (a.cmpeq(b) & a.cmpeq(c) & a.cmpeq(d)).any() {
        return Some(Sign::Zero);
    }
    let [u0, v0, w0] = differences(a.x, [b.x, c.x, d.x])?;
    let [u1, v1, w1] = differences(a.y, [b.y, c.y, d.y])?;
    let [u2, v2, w2] = differences(a.z, [b.z, c.z, d.z])?;
    let term = |w: i64, minor: i64| i128::from(w) * i128::from(minor);
    let det = term(w0, u1 * v2 - u2 * v1) + term(w1, u2 * v0 - u0 * v2) + term(w2, u0 * v1 - u1 * v0);
    Some(Sign::of(&det))
}

/// `values - origin` as integers below `2^30` of one unit.
#[inline]
fn differences<const N: usize>(origin: f64, values: [f64; N]) -> Option<[i64; N]> {
    let rounded = values.map(|value| value - origin);
    // What rounding took away, by Knuth: it is exact itself.
    let is_rounded = |(value, x): (f64, f64)| {
        let subtracted = value - x;
        let kept = x + subtracted;
        (subtracted - origin) + (value - kept) != 0.0
    };
    if rounded == [0.0; N] {
        return Some([0; N]);
    }
    let largest = rounded.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
    let exponent = largest.to_bits() >> 52;
    // Neither infinite nor so small that the unit of the largest is no normal number.
    if !(BITS..2047).contains(&exponent) || values.into_iter().zip(rounded).any(is_rounded) {
        return None;
    }
    let scale = f64::from_bits((2 * 1023 + BITS - 1 - exponent) << 52);
    let scaled = rounded.map(|x| x * scale);
    let integers = scaled.map(|x| x as i64);
    // What is so small beside the largest that it vanishes is no integer either.
    let is_whole = |k: usize| integers[k] as f64 == scaled[k] && (integers[k] == 0) == (rounded[k] == 0.0);
    (0..N).all(is_whole).then_some(integers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::exact;

    /// Numbers between -1 and 1 of 24 bits, some of them near each other.
    fn next(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bits = (*state >> 40) as i64 - (1 << 23);
        let step = [1.0, 2f64.powi(-8), 2f64.powi(-30), 1e10, 2f64.powi(-16)][(*state >> 35) as usize % 5];
        (bits as f64) / f64::from(1 << 23) * step
    }

    #[test]
    fn signs_are_those_of_the_other_tiers_wherever_there_are_some() {
        let (mut state, mut found, mut zeros) = (1, 0, 0);
        for round in 0..20_000 {
            let origin = DVec3::from_array([0; 3].map(|_| next(&mut state) * 100.0)).as_vec3().as_dvec3();
            let mut point =
                || origin + DVec3::from_array([0; 3].map(|_| next(&mut state))).as_vec3().as_dvec3();
            let [a, b, c] = [point(), point(), point()];
            // Every second one is in the plane of the others, or in a plane across an axis with them.
            let d = if round % 2 == 0 { b + (c - a) } else { point() };
            let level = |p: DVec3| if round % 8 == 0 { DVec3::new(p.x, 0.1, p.z) } else { p };
            let [a, b, c, d] = [a, b, c, d].map(level);
            let [of_three, of_two] =
                [orient3d([a, b, c, d]), orient2d([a, b, d].map(|p| DVec2::new(p.x, p.y)))];
            if let Some(sign) = of_three {
                assert_eq!(sign, exact::wide_orient3d([a, b, c, d]), "{a} {b} {c} {d}");
                (found, zeros) = (found + 1, zeros + usize::from(sign.is_zero()));
            }
            if let Some(sign) = of_two {
                assert_eq!(sign, exact::wide_orient2d([a, b, d].map(|p| DVec2::new(p.x, p.y))));
            }
        }
        assert!(found > 2_000 && zeros > 500, "{found} found, {zeros} of them in a plane");
    }

    #[test]
    fn what_vanishes_beside_large_numbers_counts() {
        let tiny = f64::from_bits(1);
        let far = DVec2::splat(2f64.powi(31));
        let near = DVec2::new(tiny, 2.0 * tiny);
        assert_eq!(exact::orient2d([DVec2::ZERO, far, near]), Sign::Positive);
        assert_eq!(exact::orient2d([DVec2::ZERO, near, far]), Sign::Negative);
        let far = DVec2::splat(2f64.powi(1000));
        let near = DVec2::new(2f64.powi(-200), 2f64.powi(-200) * (1.0 + f64::EPSILON));
        assert_eq!(exact::orient2d([DVec2::ZERO, far, near]), Sign::Positive);
        let above = |p: DVec2| p.extend(0.0);
        let points = [DVec3::ZERO, above(far), above(near), DVec3::Z];
        assert_eq!(exact::orient3d(points), Sign::Positive);
    }

    #[test]
    fn differences_are_exact_or_none() {
        assert_eq!(differences(1.0, [1.0, 1.5, 0.75]), Some([0, 1 << 29, -(1 << 28)]));
        assert_eq!(differences(0.1, [0.1, 0.1]), Some([0, 0]));
        // 0.3 - 0.1 is rounded.
        assert_eq!(differences(0.1, [0.3]), None);
        assert_eq!(differences(0.0, [1.0, 2f64.powi(-30)]), None);
        assert_eq!(differences(0.0, [1.0, 2f64.powi(-29)]), Some([1 << 29, 1]));
        for far in [f64::MAX, -f64::MAX] {
            assert_eq!(differences(-far, [far]), None);
            assert_eq!(differences(0.0, [far, 1.0]), None);
        }
        let tiny = f64::from_bits(1);
        assert_eq!(differences(0.0, [tiny]), None);
        assert_eq!(differences(f64::NAN, [1.0]), None);
        assert_eq!(differences(0.0, [2f64.powi(31), tiny]), None);
        assert_eq!(differences(0.0, [2f64.powi(1000), 2f64.powi(-200)]), None);
        let widest = f64::from((1u32 << 30) - 1);
        assert_eq!(differences(0.0, [widest, -widest]), Some([(1 << 30) - 1, 1 - (1 << 30)]));
    }
}
