//! Words and figures for people, and their colours.

use anstyle::{AnsiColor, Style};

/// What is to be seen first.
pub(super) const STRONG: Style = Style::new().bold();
/// What is well.
pub(super) const GOOD: Style = AnsiColor::Green.on_default().bold();
/// What wants a look.
pub(super) const DOUBTFUL: Style = AnsiColor::Yellow.on_default();
/// What is wrong.
pub(super) const BAD: Style = AnsiColor::Red.on_default().bold();
/// What is said by the way.
pub(super) const QUIET: Style = Style::new().dimmed();
/// As the rest.
pub(super) const PLAIN: Style = Style::new();

/// The text in this style. Where no colours are wanted, they are taken out when it is printed.
pub(super) fn painted(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}

/// A number with the name of what it counts.
pub(super) fn counted(count: u64, name: &str) -> String {
    let plural = match name {
        "vertex" => "vertices".to_owned(),
        name => format!("{name}s"),
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

/// Rows of cells with their columns aligned, each row in its style; without blanks at the ends.
pub(super) fn aligned<const N: usize>(rows: &[(Style, [String; N])]) -> Vec<String> {
    let width = |column: usize| rows.iter().map(|(_, row)| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; N] = std::array::from_fn(width);
    let line = |(style, row): &(Style, [String; N])| {
        let cells: Vec<String> =
            row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        painted(*style, cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
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
    }

    #[test]
    fn columns_are_aligned_whatever_their_colour() {
        let rows = [(PLAIN, ["a".into(), "1".into()]), (BAD, ["long".to_owned(), "22".to_owned()])];
        let told: Vec<String> =
            aligned(&rows).iter().map(|line| anstream::adapter::strip_str(line).to_string()).collect();
        assert_eq!(told, ["a     1", "long  22"]);
        assert!(aligned(&rows)[1].starts_with('\u{1b}'));
    }
}
