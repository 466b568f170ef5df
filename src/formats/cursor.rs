//! Fixed-width values of a binary file.

use super::{Place, ReadError};

/// A cursor over bytes.
#[derive(Debug, Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    /// Begins at byte `at` of the file `bytes`.
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at: at.min(bytes.len()) }
    }

    /// The byte that comes next, as a place in the file.
    pub(super) fn place(&self) -> Place {
        Place::Byte(self.at as u64)
    }

    /// Number of bytes not taken yet.
    pub(super) fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Number of bytes not taken yet, where they are more than blanks and zero bytes.
    pub(super) fn behind(&self) -> u64 {
        let rest = &self.bytes[self.at..];
        let is_padding = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
        if rest.iter().all(is_padding) { 0 } else { rest.len() as u64 }
    }

    /// The next `N` bytes.
    #[inline]
    pub(super) fn take<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], ReadError> {
        match self.bytes[self.at..].first_chunk::<N>() {
            Some(&chunk) => {
                self.at += N;
                Ok(chunk)
            }
            None => Err(self.truncated(expected)),
        }
    }

    /// Leaves out `count` bytes.
    pub(super) fn skip(&mut self, count: u64, expected: &str) -> Result<(), ReadError> {
        if count > self.remaining() as u64 {
            return Err(self.truncated(expected));
        }
        self.at += count as usize;
        Ok(())
    }

    #[cold]
    fn truncated(&self, expected: &str) -> ReadError {
        ReadError::truncated(Place::Byte(self.bytes.len() as u64), expected)
    }
}
