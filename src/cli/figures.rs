//! Numbers for people.

/// So many things of that name.
pub(super) fn counted(count: u64, name: &str) -> String {
    let plural = match name.strip_suffix("vertex") {
        Some(which) => format!("{which}vertices"),
        None => format!("{name}s"),
    };
    if count == 1 { format!("1 {name}") } else { format!("{count} {plural}") }
}

/// A number for people: six significant digits.
pub(super) fn figure(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e9).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    let digits_before = magnitude.log10().floor() as i32 + 1;
    let decimals = usize::try_from(6 - digits_before).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
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
            (1234.56789, "1234.57"),
            (123_456_789.0, "123456789"),
            (1e30, "1.00000e30"),
            (1.5e-7, "1.50000e-7"),
        ] {
            assert_eq!(figure(value), text);
        }
    }

    #[test]
    fn one_is_not_a_plural() {
        assert_eq!(counted(1, "vertex"), "1 vertex");
        assert_eq!(counted(0, "triangle"), "0 triangles");
        assert_eq!(counted(8, "vertex"), "8 vertices");
        assert_eq!(counted(4, "new vertex"), "4 new vertices");
    }
}
