//! Descriptions of the contract as HTML: paragraphs, lists, and words of code between back quotes.

use std::fmt::{Display, Formatter, Result};

use crate::wire::Escaped;

/// A description; lines that begin with `- ` are a list.
pub(super) struct Prose<'t>(pub(super) &'t str);

impl Display for Prose<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut is_list = false;
        for line in self.0.lines().map(str::trim).filter(|line| !line.is_empty()) {
            let item = line.strip_prefix("- ");
            match (is_list, item.is_some()) {
                (false, true) => f.write_str("<ul>")?,
                (true, false) => f.write_str("</ul>")?,
                _ => {}
            }
            is_list = item.is_some();
            match item {
                Some(item) => write!(f, "<li>{}</li>", Line(item))?,
                None => write!(f, "<p>{}</p>", Line(line))?,
            }
        }
        if is_list { f.write_str("</ul>") } else { Ok(()) }
    }
}

struct Line<'t>(&'t str);

impl Display for Line<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut parts = self.0.split('`');
        if let Some(first) = parts.next() {
            Escaped(first).fmt(f)?;
        }
        while let Some(code) = parts.next() {
            match parts.next() {
                Some(after) => write!(f, "<code>{}</code>{}", Escaped(code), Escaped(after))?,
                // A quote that is not closed is one.
                None => write!(f, "`{}", Escaped(code))?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_and_lists_are_told_apart_and_nothing_becomes_markup() {
        let told = Prose("Take `a<b>`.\n- `x`: one\n- two\nEnd & `open").to_string();
        assert_eq!(
            told,
            "<p>Take <code>a&lt;b&gt;</code>.</p><ul><li><code>x</code>: one</li><li>two</li></ul><p>End &amp; `open</p>"
        );
    }
}
