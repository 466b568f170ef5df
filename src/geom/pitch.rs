//! The pitch of the lattice on which new coordinates are born, so that every one of them is a float32.

/// The power of two `g` for which every whole multiple of `g` up to `reach` in size is exactly a float32; `None` where
/// `reach` is not finite or float32 does not go so far.
pub fn print_pitch(reach: f64) -> Option<f64> {
    let exponent = (exponent_above(reach) - 23).max(-149);
    (reach.is_finite() && exponent <= 104).then(|| power_of_two(exponent))
}

/// The least `e` with `x <= 2^e`, for a positive number; at least that of the least normal number.
pub fn exponent_above(x: f64) -> i32 {
    let bits = x.to_bits();
    let biased = (bits >> 52) as i32;
    if biased == 0 {
        return -1022;
    }
    biased - 1023 + i32::from(bits << 12 != 0)
}

/// `2^exponent` for a normal number.
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_up_to_the_reach_are_float32_and_half_the_pitch_would_not_do() {
        for reach in [1.0, 1.5, 256.0, 300.0, 1e-3, 1e30] {
            let pitch = print_pitch(reach).unwrap();
            let largest = (reach / pitch).floor() * pitch;
            assert_eq!(f64::from(largest as f32), largest);
            assert!(reach / pitch > f64::from(1 << 22), "{reach}: {pitch}");
        }
        assert_eq!(print_pitch(256.0), Some(2f64.powi(-15)));
        assert_eq!(print_pitch(1e-300), Some(2f64.powi(-149)));
        assert_eq!((print_pitch(1e39), print_pitch(f64::INFINITY)), (None, None));
    }
}
