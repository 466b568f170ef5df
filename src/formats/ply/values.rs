//! The values after a PLY header, as text or binary.

use super::header::Scalar;
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::cursor::Cursor;
use crate::formats::numbers::{coordinate, integer, rounded};
use crate::formats::words::{Dialect, Words};
use crate::formats::{Place, Precision, ReadError};

/// Values in file order, whatever their layout.
pub(super) trait ValueReader {
    /// The next value, of type `kind`.
    fn number(&mut self, kind: Scalar, precision: Precision) -> Result<f64, ReadError>;
    /// The next value, of the integer type `kind`.
    fn integer(&mut self, kind: Scalar) -> Result<i64, ReadError>;
    /// Leaves out `count` values of type `kind`.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), ReadError>;
    /// Where the next value stands.
    fn place(&self) -> Place;
    /// Number of bytes not read yet.
    fn remaining(&self) -> usize;
    /// Number of bytes behind what was read, where they are more than blanks.
    fn behind(&mut self) -> u64;
    /// The next value is the first of an item.
    fn begin_item(&mut self);
    /// Line of the first value of the item, in text.
    fn item_line(&self) -> Option<u32>;
}

/// Values as words.
pub(super) struct Ascii<'a> {
    words: Words<'a>,
    is_first: bool,
    item_line: u64,
    budget: &'a Budget,
}

impl<'a> Ascii<'a> {
    /// The values `bytes`, which begin on `line`.
    pub(super) fn new(bytes: &'a [u8], line: u64, budget: &'a Budget) -> Self {
        Self { words: Words::new(bytes, line, Dialect::default()), is_first: true, item_line: line, budget }
    }

    #[inline]
    fn word(&mut self) -> Option<&'a [u8]> {
        let word = self.words.next_word();
        if self.is_first {
            self.is_first = false;
            self.item_line = self.words.line();
        }
        word
    }
}

impl ValueReader for Ascii<'_> {
    #[inline]
    fn number(&mut self, _kind: Scalar, precision: Precision) -> Result<f64, ReadError> {
        let word = self.word();
        word.and_then(|word| coordinate(word, precision)).ok_or_else(|| self.words.wrong(word, "a number"))
    }

    #[inline]
    fn integer(&mut self, _kind: Scalar) -> Result<i64, ReadError> {
        let word = self.word();
        word.and_then(integer).ok_or_else(|| self.words.wrong(word, "an integer"))
    }

    fn skip(&mut self, _kind: Scalar, count: u64) -> Result<(), ReadError> {
        for i in 0..count {
            if i.is_multiple_of(CHECK_EVERY as u64) {
                self.budget.check()?;
            }
            if self.word().is_none() {
                return Err(self.words.wrong(None, "a value"));
            }
        }
        Ok(())
    }

    fn place(&self) -> Place {
        self.words.place()
    }

    fn remaining(&self) -> usize {
        self.words.remaining().len()
    }

    fn behind(&mut self) -> u64 {
        self.words.behind()
    }

    fn begin_item(&mut self) {
        self.is_first = true;
    }

    fn item_line(&self) -> Option<u32> {
        Some(self.item_line as u32)
    }
}

/// Values as bytes, the most significant first if `BIG`, otherwise the least.
pub(super) struct Binary<'a, const BIG: bool>(Cursor<'a>);

impl<'a, const BIG: bool> Binary<'a, BIG> {
    /// The values that begin at byte `at` of the file `bytes`.
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self(Cursor::new(bytes, at))
    }

    /// The next bytes, the least significant first.
    #[inline]
    fn little<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let mut bytes = self.0.take("a value")?;
        if BIG {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<const BIG: bool> ValueReader for Binary<'_, BIG> {
    #[inline]
    fn number(&mut self, kind: Scalar, precision: Precision) -> Result<f64, ReadError> {
        match kind {
            Scalar::F32 => Ok(f32::from_le_bytes(self.little()?).into()),
            Scalar::F64 => Ok(rounded(f64::from_le_bytes(self.little()?), precision)),
            _ => self.integer(kind).map(|value| rounded(value as f64, precision)),
        }
    }

    #[inline]
    fn integer(&mut self, kind: Scalar) -> Result<i64, ReadError> {
        Ok(match kind {
            Scalar::I8 => i8::from_le_bytes(self.little()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.little()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.little()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.little()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.little()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.little()?).into(),
            Scalar::F32 | Scalar::F64 => self.number(kind, Precision::F64)? as i64,
        })
    }

    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), ReadError> {
        self.0.skip(count.saturating_mul(kind.width() as u64), "values")
    }

    fn place(&self) -> Place {
        self.0.place()
    }

    fn remaining(&self) -> usize {
        self.0.remaining()
    }

    fn behind(&mut self) -> u64 {
        self.0.behind()
    }

    fn begin_item(&mut self) {}

    fn item_line(&self) -> Option<u32> {
        None
    }
}
