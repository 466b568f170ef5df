//! Words of a text file and the lines they stand on.

use super::{Place, ReadError};
use memchr::{memchr, memchr2, memrchr2};

/// What a text format makes of two special characters.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Dialect {
    /// `#` begins a comment that lasts to the end of the line.
    pub(super) comments: bool,
    /// A backslash before a line break joins the next line to this one.
    pub(super) continued_lines: bool,
}

/// A cursor over the blank-separated words of a text.
///
/// Lines end with LF, CR LF or a lone CR. Every other byte up to the space is blank; all bytes above it, whatever
/// their encoding, belong to words.
#[derive(Debug, Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    dialect: Dialect,
}

impl<'a> Words<'a> {
    /// The words of `bytes`, whose first line has the number `line`. A UTF-8 byte order mark at its start is skipped.
    pub(super) fn new(bytes: &'a [u8], line: u64, dialect: Dialect) -> Self {
        Self { bytes: bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), at: 0, line, dialect }
    }

    /// Number of the current line.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// The current line as a place in the file.
    pub(super) fn place(&self) -> Place {
        Place::Line(self.line)
    }

    /// Bytes not looked at yet.
    pub(super) fn remaining(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Bytes from the next word on.
    pub(super) fn behind(&mut self) -> u64 {
        self.next_word().map_or(0, |word| (word.len() + self.remaining().len()) as u64)
    }

    /// The next word of this line, or nothing at its end.
    #[inline]
    pub(super) fn next_in_line(&mut self) -> Option<&'a [u8]> {
        loop {
            match *self.bytes.get(self.at)? {
                b'\n' | b'\r' => return None,
                0..=b' ' => self.at += 1,
                b'#' if self.dialect.comments => {
                    self.at = line_end(self.bytes, self.at);
                    return None;
                }
                b'\\' if self.continues_here() => {
                    self.at += 1;
                    self.step_over_line_break();
                }
                _ => return Some(self.take_word()),
            }
        }
    }

    fn take_word(&mut self) -> &'a [u8] {
        let start = self.at;
        self.at += 1;
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                0..=b' ' => break,
                b'#' if self.dialect.comments => break,
                b'\\' if self.continues_here() => break,
                _ => self.at += 1,
            }
        }
        &self.bytes[start..self.at]
    }

    fn continues_here(&self) -> bool {
        self.dialect.continued_lines && matches!(self.bytes.get(self.at + 1), Some(b'\n' | b'\r'))
    }

    /// The next word of this line or a later one.
    #[inline]
    pub(super) fn next_word(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.next_in_line() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    /// Goes to the next line; false at the end of the file. Lines joined to this one are skipped too, unless the
    /// backslash belongs to a comment or to what [`rest_of_line`](Self::rest_of_line) took.
    pub(super) fn next_line(&mut self) -> bool {
        loop {
            let end = line_end(self.bytes, self.at);
            let skipped = &self.bytes[self.at..end];
            self.at = end;
            if !self.step_over_line_break() {
                return false;
            }
            if !(self.dialect.continued_lines && skipped.ends_with(b"\\"))
                || (self.dialect.comments && memchr(b'#', skipped).is_some())
            {
                return true;
            }
        }
    }

    /// The rest of this line without blanks around it, comment signs and backslashes included; goes to its end.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let end = line_end(self.bytes, self.at);
        let rest = self.bytes[self.at..end].trim_ascii();
        self.at = end;
        rest
    }

    /// The rest of this line without blanks around it and without the backslash that joins the next line to it; stays where it is,
    /// so that [`next_line`](Self::next_line) skips lines that are joined.
    pub(super) fn name_in_line(&self) -> &'a [u8] {
        let end = line_end(self.bytes, self.at);
        let rest = &self.bytes[self.at..end];
        let is_continued = self.dialect.continued_lines && end < self.bytes.len();
        let rest = if is_continued { rest.strip_suffix(b"\\").unwrap_or(rest) } else { rest };
        rest.trim_ascii()
    }

    fn step_over_line_break(&mut self) -> bool {
        let width = match self.remaining() {
            [b'\r', b'\n', ..] => 2,
            [b'\r' | b'\n', ..] => 1,
            _ => return false,
        };
        self.at += width;
        self.line += 1;
        true
    }

    /// The error for `found` (or the end of the line or file) where `expected` should stand.
    #[cold]
    pub(super) fn wrong(&self, found: Option<&[u8]>, expected: &str) -> ReadError {
        match found {
            Some(word) => ReadError::unparseable(self.place(), quoted(word), expected),
            None if self.remaining().is_empty() => ReadError::truncated(self.place(), expected),
            None => ReadError::unparseable(self.place(), "the end of the line", expected),
        }
    }
}

/// Where the line of `from` ends: at its line break or at the end of `bytes`.
fn line_end(bytes: &[u8], from: usize) -> usize {
    memchr2(b'\n', b'\r', &bytes[from..]).map_or(bytes.len(), |length| from + length)
}

/// Refuses text with a zero byte in it: as a blank it would divide the numbers of a file in UTF-16 into digits, which are
/// another mesh.
pub(super) fn check_text(bytes: &[u8]) -> Result<(), ReadError> {
    let mut from = 0;
    while let Some(zero) = memchr(0, &bytes[from..]).map(|zero| from + zero) {
        let start = memrchr2(b'\n', b'\r', &bytes[..zero]).map_or(0, |end| end + 1);
        let end = line_end(bytes, zero);
        // Nothing in a comment is read, nor a line of which the first byte begins no word or number: what some programs leave
        // behind the text.
        let begins = bytes[start..end].iter().find(|byte| !matches!(byte, 0 | b' ' | b'\t'));
        let is_read = begins.is_none_or(|byte| byte.is_ascii_alphanumeric() || b"+-.".contains(byte));
        if !is_read || bytes[start..zero].contains(&b'#') {
            from = end;
            continue;
        }
        let mut words = Words::new(&bytes[..zero], 1, Dialect::default());
        while words.next_line() {}
        return Err(ReadError::unparseable(
            words.place(),
            "a zero byte",
            "text without zero bytes, in UTF-8",
        ));
    }
    Ok(())
}

/// A piece of a file for an error message: printable and short.
pub(super) fn quoted(word: &[u8]) -> String {
    const SHOWN_BYTES_MAX: usize = 40;
    let shown = &word[..word.len().min(SHOWN_BYTES_MAX)];
    let dots = if shown.len() < word.len() { "…" } else { "" };
    format!("\"{}{dots}\"", shown.escape_ascii())
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJ: Dialect = Dialect { comments: true, continued_lines: true };

    fn lines_of(text: &[u8], dialect: Dialect) -> Vec<(u64, Vec<&[u8]>)> {
        let mut words = Words::new(text, 1, dialect);
        let mut lines = Vec::new();
        loop {
            let line = words.line();
            let mut in_line = Vec::new();
            while let Some(word) = words.next_in_line() {
                in_line.push(word);
            }
            if !in_line.is_empty() {
                lines.push((line, in_line));
            }
            if !words.next_line() {
                return lines;
            }
        }
    }

    #[test]
    fn all_three_line_ends_count_as_one_line_each() {
        let lines = lines_of(b"a\nb\r\nc\rd\n\n e", Dialect::default());
        let numbers: Vec<u64> = lines.iter().map(|l| l.0).collect();
        assert_eq!(numbers, [1, 2, 3, 4, 6]);
    }

    #[test]
    fn a_comment_ends_a_word_and_the_line() {
        assert_eq!(
            lines_of(b"f 1 2 3#note 4\n5", OBJ),
            [(1, vec![&b"f"[..], b"1", b"2", b"3"]), (2, vec![&b"5"[..]])]
        );
        assert_eq!(lines_of(b"a#b", Dialect::default())[0].1, [b"a#b"]);
    }

    #[test]
    fn a_backslash_joins_lines_that_are_still_counted() {
        assert_eq!(
            lines_of(b"f 1 \\\r\n2\\\n 3\nv", OBJ),
            [(1, vec![&b"f"[..], b"1", b"2", b"3"]), (4, vec![&b"v"[..]])]
        );
        let mut words = Words::new(b"g a\\\nb c\nv", 1, OBJ);
        assert!(words.next_line());
        assert_eq!((words.line(), words.next_word()), (3, Some(&b"v"[..])));
    }

    #[test]
    fn a_backslash_at_the_end_of_a_comment_joins_nothing() {
        let mut words = Words::new(b"# C:\\dir\\\nv 1", 1, OBJ);
        assert_eq!(words.next_in_line(), None);
        assert_eq!((words.next_word(), words.line()), (Some(&b"v"[..]), 2));
    }

    #[test]
    fn latin_1_bytes_and_a_byte_order_mark_do_no_harm() {
        assert_eq!(lines_of(b"\xEF\xBB\xBFg B\xFCgel\tx", OBJ), [(1, vec![&b"g"[..], b"B\xFCgel", b"x"])]);
    }

    #[test]
    fn a_zero_byte_is_told_with_its_line() {
        for text in [
            &b"v 0 0 0\r\nv 1 0 0\r"[..],
            b"v 0 0 0\n# a\0b\0\nv 1 0 0",
            b"v 0 0 0 # \0",
            b"v 0 0 0\n:\xF3\0\0\x01\r\0\xF3",
        ] {
            assert_eq!(check_text(text), Ok(()));
        }
        for (text, line) in
            [(&b"\0"[..], 1), (b"v 0 0 0\rv 1 \0 0", 2), (b"# \0\r\n\r\nv \0# a\0", 3), (b"a\n\0", 2)]
        {
            let error = check_text(text).unwrap_err().to_string();
            let told = format!("line {line}: found a zero byte; expected text without zero bytes, in UTF-8");
            assert_eq!(error, told);
        }
    }

    #[test]
    fn a_long_word_is_shortened_and_escaped_in_messages() {
        assert_eq!(quoted(b"a\xFC\""), "\"a\\xfc\\\"\"");
        assert!(quoted(&[b'x'; 1000]).len() < 60);
    }
}
