//! The natural logarithm without branches, so that a loop over many numbers is vectorized, and with the same bits on
//! every machine.

/// The high and low parts of ln 2; the high part times an exponent is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// The bits of the square root of 1/2, rounded down to 20 bits of fraction: mantissas are taken from there to its double.
const ROOT_HALF_BITS: u64 = 0x3fe6_a09e_0000_0000;
const ONE_BITS: u64 = 0x3ff0_0000_0000_0000;
const FRACTION_BITS: u64 = 0x000f_ffff_ffff_ffff;
/// 2^52: numbers above it with an integer in their fraction bits.
const TWO_52: f64 = 4_503_599_627_370_496.0;

/// ln x for a normal positive `x`, to within two units in the last place. For 0 some finite number, so that a product
/// with 0 is 0.
///
/// x = 2^k m with m in [sqrt(1/2), sqrt(2)); with f = m - 1 and s = f / (2 + f), ln m = 2 atanh s, whose odd series is
/// cut after s^21 (|s| <= 0.172, so what is left is below 2^-60 of ln m).
#[inline(always)]
pub(super) fn ln(x: f64) -> f64 {
    let bits = x.to_bits().wrapping_add(ONE_BITS - ROOT_HALF_BITS);
    // The exponent as a float without a conversion of 64-bit integers, which the baseline of x86-64 lacks.
    let k = f64::from_bits(TWO_52.to_bits() | (bits >> 52)) - (TWO_52 + 1023.0);
    let m = f64::from_bits((bits & FRACTION_BITS) + ROOT_HALF_BITS);
    let f = m - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let odd = w * (1.0 / 5.0 + w * (1.0 / 9.0 + w * (1.0 / 13.0 + w * (1.0 / 17.0 + w * (1.0 / 21.0)))));
    let even = z * (1.0 / 3.0 + w * (1.0 / 7.0 + w * (1.0 / 11.0 + w * (1.0 / 15.0 + w * (1.0 / 19.0)))));
    // ln m = 2 s (1 + series) = f - s (f - 2 series), since 2 s = f - s f.
    let series = odd + even;
    k * LN_2[0] + (f - (s * (f - 2.0 * series) - k * LN_2[1]))
}

#[cfg(test)]
mod tests {
    use super::ln;

    #[test]
    fn it_is_the_logarithm_to_within_two_units_in_the_last_place() {
        let mut state = 7u64;
        for i in 0..200_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let exponent = if i % 2 == 0 { 0x3fc + (state >> 60) % 8 } else { 1 + (state >> 53) % 2045 };
            let x = f64::from_bits((exponent << 52) | (state >> 12));
            let truth = libm::log(x);
            let ulp = f64::from_bits(truth.abs().to_bits() + 1) - truth.abs();
            assert!((ln(x) - truth).abs() <= 2.0 * ulp, "{x:e}: {} {truth}", ln(x));
        }
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln(2.0), std::f64::consts::LN_2);
    }

    #[test]
    fn zero_times_the_logarithm_of_zero_is_zero() {
        assert_eq!(0.0 * ln(0.0), 0.0);
    }
}
