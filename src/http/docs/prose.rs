//! Descriptions of the contract as HTML: paragraphs, lists, and words of code between back quotes.

use std::fmt::{Display, Formatter, Result};

use crate::wire::Escaped;

/// A description. Lines without an empty one between them are one paragraph; one that begins with `- ` is an item of a list.
pub(super) struct Prose<'t>(pub(super) &'t str);

impl Display for Prose<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut is_list = false;
        for (is_item, text) in blocks(self.0) {
            match (is_list, is_item) {
                (false, true) => f.write_str("<ul>")?,
                (true, false) => f.write_str("</ul>")?,
                _ => {}
            }
            is_list = is_item;
            let tag = if is_item { "li" } else { "p" };
            write!(f, "<{tag}>{}</{tag}>", ProseLine(&text))?;
        }
        if is_list { f.write_str("</ul>") } else { Ok(()) }
    }
}

/// The paragraphs and items of a text, each on one line, and whether it is an item.
fn blocks(text: &str) -> Vec<(bool, String)> {
    let mut blocks: Vec<(bool, String)> = Vec::new();
    let mut is_open = false;
    for line in text.lines().map(str::trim) {
        let item = line.strip_prefix("- ");
        if let (None, true, Some((_, block))) = (item, is_open && !line.is_empty(), blocks.last_mut()) {
            block.push(' ');
            block.push_str(line);
        } else if !line.is_empty() {
            blocks.push((item.is_some(), item.unwrap_or(line).to_owned()));
        }
        is_open = !line.is_empty();
    }
    blocks
}

struct ProseLine<'t>(&'t str);

impl Display for ProseLine<'_> {
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
        let told = Prose("Take `a<b>`\nand go.\n- `x`: one\n- two\n  lines\n\nEnd & `open").to_string();
        assert_eq!(
            told,
            "<p>Take <code>a&lt;b&gt;</code> and go.</p><ul><li><code>x</code>: one</li><li>two lines</li></ul><p>End &amp; `open</p>"
        );
    }
}
