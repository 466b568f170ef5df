//! Numbers in text.

use super::Precision;

/// The coordinate that `word` spells, rounded as `precision` says and widened. The spellings of NaN and infinity that
/// C, C++ and Python programs print are numbers too.
#[inline]
pub(super) fn coordinate(word: &[u8], precision: Precision) -> Option<f64> {
    let number = match precision {
        Precision::F64 => fast_float2::parse::<f64, _>(word).ok(),
        Precision::F32 => fast_float2::parse::<f32, _>(word).ok().map(f64::from),
    };
    number.or_else(|| non_finite(word))
}

/// `nan(ind)`, `1.#QNAN`, `-1.#INF00` and their like, which the number parser does not know.
#[cold]
fn non_finite(word: &[u8]) -> Option<f64> {
    let (sign, rest) = match word {
        [b'-', rest @ ..] => (-1.0, rest),
        [b'+', rest @ ..] => (1.0, rest),
        _ => (1.0, word),
    };
    let is = |prefix: &[u8]| rest.get(..prefix.len()).is_some_and(|head| head.eq_ignore_ascii_case(prefix));
    if is(b"1.#INF") {
        Some(sign * f64::INFINITY)
    } else if is(b"nan(") || is(b"1.#QNAN") || is(b"1.#SNAN") || is(b"1.#IND") {
        Some(f64::NAN)
    } else {
        None
    }
}

/// A `coordinate` of a binary file as `precision` wants it.
#[inline]
pub(super) fn rounded(coordinate: f64, precision: Precision) -> f64 {
    match precision {
        Precision::F64 => coordinate,
        Precision::F32 => f64::from(coordinate as f32),
    }
}

/// The integer that `word` spells; values beyond i64 become its nearest end.
#[inline]
pub(super) fn integer(word: &[u8]) -> Option<i64> {
    let (is_negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        _ => (false, word),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0i64;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value.saturating_mul(10).saturating_add(i64::from(digit - b'0'));
    }
    Some(if is_negative { -value } else { value })
}

/// A vertex index as the soup stores it; whatever no file can have becomes `u32::MAX`, which is out of range.
#[inline]
pub(super) fn index(value: i64) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_rounded_to_the_precision_asked() {
        assert_eq!(coordinate(b"0.1", Precision::F64), Some(0.1));
        assert_eq!(coordinate(b"0.1", Precision::F32), Some(f64::from(0.1f32)));
        assert_eq!(coordinate(b"+1.5E+02", Precision::F64), Some(150.0));
        assert_eq!(coordinate(b".5", Precision::F64), Some(0.5));
        assert_eq!(coordinate(b"5.", Precision::F64), Some(5.0));
        assert_eq!(coordinate(b"-0", Precision::F64).map(f64::to_bits), Some((-0.0f64).to_bits()));
    }

    #[test]
    fn a_decimal_goes_to_float32_directly_not_by_way_of_float64() {
        // Just above the middle of two float32 values; its nearest f64 is that middle, which rounds to even.
        let word = b"1.000000059604644775390625000000000000001";
        assert_eq!(coordinate(word, Precision::F64), Some(1.000_000_059_604_644_8));
        assert_eq!(coordinate(word, Precision::F32), Some(f64::from(1.000_000_1_f32)));
    }

    #[test]
    fn words_for_nan_and_infinity_are_numbers() {
        for word in ["nan", "NaN", "-nan", "nan(ind)", "-nan(ind)", "1.#QNAN", "-1.#IND00", "1.#SNAN"] {
            assert!(coordinate(word.as_bytes(), Precision::F64).is_some_and(f64::is_nan), "{word}");
        }
        for word in ["inf", "Infinity", "+inf", "1.#INF", "1e999"] {
            assert_eq!(coordinate(word.as_bytes(), Precision::F32), Some(f64::INFINITY), "{word}");
        }
        assert_eq!(coordinate(b"-1.#INF00", Precision::F64), Some(f64::NEG_INFINITY));
    }

    #[test]
    fn other_words_are_not_numbers() {
        for word in ["", "-", "1.0abc", "1,5", "nano", "0x10", "--1", "1.#"] {
            assert_eq!(coordinate(word.as_bytes(), Precision::F64), None, "{word}");
            assert_eq!(integer(word.as_bytes()), None, "{word}");
        }
    }

    #[test]
    fn integers_beyond_every_index_stay_beyond() {
        assert_eq!(integer(b"-12"), Some(-12));
        assert_eq!(integer(b"99999999999999999999"), Some(i64::MAX));
        assert_eq!([index(-1), index(i64::MAX), index(7)], [u32::MAX, u32::MAX, 7]);
    }
}
