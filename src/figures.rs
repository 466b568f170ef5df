//! Numbers in sentences for people. JSON has them in full.

/// The number to six significant digits: `0.333333`, `12.5`, `1e30`.
pub fn figure(value: f64) -> String {
    significant(value, 6)
}

/// The number to so many significant digits, at least one, without zeros at the end. What is smaller than a ten-thousandth
/// or has more than nine digits before the point has an exponent.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.max(1);
    if !value.is_finite() || !(1e-4..1e9).contains(&value.abs()) {
        let text = format!("{value:.*e}", digits - 1);
        return match text.split_once('e') {
            Some((number, exponent)) => format!("{}e{exponent}", trimmed(number)),
            None => text,
        };
    }
    let before = libm::log10(value.abs()).floor() as i32 + 1;
    let decimals = usize::try_from(digits as i32 - before).unwrap_or(0);
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

/// Without zeros at the end, where they say nothing.
fn trimmed(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_six_significant_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-12.5, "-12.5"),
            (1.0 / 3.0, "0.333333"),
            (0.1 + 0.2, "0.3"),
            (0.095_680_999_999_999_99, "0.095681"),
            (1234.56789, "1234.57"),
            (123_456_789.0, "123456789"),
            (1e30, "1e30"),
            (1.5e-7, "1.5e-7"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(figure(value), text);
        }
    }

    #[test]
    fn fewer_digits_are_rounded() {
        assert_eq!(significant(0.039_85, 3), "0.0398");
        assert_eq!(significant(99.96, 3), "100");
        assert_eq!(significant(1234.5, 3), "1234");
        assert_eq!(significant(1e-9, 3), "1e-9");
    }
}
