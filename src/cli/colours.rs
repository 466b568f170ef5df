//! Colours and columns of what people read on a terminal.

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
    fn columns_are_aligned_whatever_their_colour() {
        let rows = [(PLAIN, ["a".into(), "1".into()]), (BAD, ["long".to_owned(), "22".to_owned()])];
        let told: Vec<String> =
            aligned(&rows).iter().map(|line| anstream::adapter::strip_str(line).to_string()).collect();
        assert_eq!(told, ["a     1", "long  22"]);
        assert!(aligned(&rows)[1].starts_with('\u{1b}'));
    }
}
