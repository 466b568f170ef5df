//! A page that is being written.

use serde_json::Value;
use std::fmt::{Display, Formatter, Result, Write as _};

/// Text as HTML.
pub struct Escaped<'t>(pub &'t str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        for c in self.0.chars() {
            match c {
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '&' => f.write_str("&amp;")?,
                '"' => f.write_str("&quot;")?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}

/// How good something is, as the style sheet names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    Good,
    Fair,
    Bad,
    Open,
}

impl Tone {
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Fair => "fair",
            Self::Bad => "bad",
            Self::Open => "open",
        }
    }
}

/// One cell of a table.
pub(super) enum TableCell {
    Text(String),
    Number(String),
    Mark(Tone, &'static str),
}

impl Display for TableCell {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Text(text) => write!(f, "<td>{}</td>", Escaped(text)),
            Self::Number(text) => write!(f, "<td class=number>{}</td>", Escaped(text)),
            Self::Mark(tone, word) => {
                write!(f, "<td><span class=\"mark {}\">{}</span></td>", tone.class(), Escaped(word))
            }
        }
    }
}

/// The page so far.
pub(super) struct HtmlPage(pub(super) String);

impl HtmlPage {
    pub(super) fn add(&mut self, arguments: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.0.write_fmt(arguments);
    }

    pub(super) fn heading(&mut self, text: &str) {
        self.add(format_args!("<h2>{}</h2>", Escaped(text)));
    }

    pub(super) fn paragraph(&mut self, text: &str) {
        self.add(format_args!("<p>{}</p>", Escaped(text)));
    }

    /// A table with a line of headings, in a box of its own that scrolls where it is too wide for the page; nothing without rows.
    pub(super) fn table(&mut self, headings: &[&str], rows: Vec<Vec<TableCell>>) {
        if rows.is_empty() {
            return;
        }
        self.add(format_args!("<div class=table tabindex=0><table>"));
        if !headings.is_empty() {
            self.add(format_args!("<thead><tr>"));
            headings.iter().for_each(|heading| self.add(format_args!("<th>{}</th>", Escaped(heading))));
            self.add(format_args!("</tr></thead>"));
        }
        for row in rows {
            self.add(format_args!("<tr>"));
            row.iter().for_each(|cell| self.add(format_args!("{cell}")));
            self.add(format_args!("</tr>"));
        }
        self.add(format_args!("</table></div>"));
    }
}

/// The items of a list; none when it is something else.
pub(super) fn items(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// The text; empty when it is something else.
pub(super) fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// The least number that is told for people; what is nearer to 0 is nothing that a machine could print.
const LEAST: f64 = 1e-9;

/// A number for people: up to five significant digits, without a power of ten where it is not very large.
pub(super) fn figure(value: f64) -> String {
    if value.abs() >= 1e9 {
        return format!("{value:.2e}");
    }
    if value.abs() < LEAST {
        return "0".to_owned();
    }
    let decimals = match value.abs() {
        v if v >= 1000.0 => 0,
        v if v >= 10.0 => 2,
        v if v >= 1e-4 => 4,
        v if v >= 1e-6 => 7,
        _ => 10,
    };
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The number with its unit; a dash when there is none.
pub(super) fn measured(value: &Value, unit: &str) -> String {
    match value.as_f64() {
        Some(number) if number != 0.0 && number.abs() < LEAST => {
            format!("less than {}{unit}", figure(LEAST))
        }
        Some(number) => format!("{}{unit}", figure(number)),
        None => "\u{2013}".to_owned(),
    }
}
