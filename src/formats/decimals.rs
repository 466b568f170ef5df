//! Text output: numbers in their shortest form that reads back as the same value.

use super::WriteError;
use super::colors::{ColorLayout, as_bytes, as_floats};
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::DVec3;
use crate::mesh::Color;

/// Text that grows under a budget.
pub(super) struct Text<'b> {
    bytes: Vec<u8>,
    float: zmij::Buffer,
    integer: itoa::Buffer,
    budget: &'b Budget,
    charges: Vec<Charge<'b>>,
}

impl<'b> Text<'b> {
    /// Empty text.
    pub(super) fn new(budget: &'b Budget) -> Self {
        let (float, integer) = (zmij::Buffer::new(), itoa::Buffer::new());
        Self { bytes: Vec::new(), float, integer, budget, charges: Vec::new() }
    }

    /// To be called before item `i` of a list whose items take at most `item_bytes_max` each; makes room for the next
    /// items and looks whether the run must end.
    pub(super) fn before_item(&mut self, i: usize, item_bytes_max: usize) -> Result<(), Stopped> {
        if i.is_multiple_of(CHECK_EVERY) {
            self.charges.push(self.budget.reserve(&mut self.bytes, CHECK_EVERY * item_bytes_max)?);
        }
        Ok(())
    }

    /// `word` as it is.
    pub(super) fn word(&mut self, word: &str) {
        self.bytes.extend_from_slice(word.as_bytes());
    }

    /// `bytes` as they are.
    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// A whole number.
    pub(super) fn integer(&mut self, number: i64) {
        self.bytes.extend_from_slice(self.integer.format(number).as_bytes());
    }

    /// The coordinates of `vertex`, with spaces between them.
    pub(super) fn point(&mut self, vertex: u32, p: DVec3, encoding: &'static str) -> Result<(), WriteError> {
        for (k, value) in p.to_array().into_iter().enumerate() {
            if !value.is_finite() {
                return Err(WriteError::NotRepresentable { vertex, value, encoding });
            }
            if k > 0 {
                self.word(" ");
            }
            self.coordinate(value);
        }
        Ok(())
    }

    /// The channels of `color`, each after a space.
    pub(super) fn color(&mut self, color: Option<Color>, layout: ColorLayout) {
        if layout.is_bytes {
            for channel in &as_bytes(color)[..layout.channels()] {
                self.word(" ");
                self.integer(i64::from(*channel));
            }
        } else {
            for channel in &as_floats(color)[..layout.channels()] {
                self.word(" ");
                self.channel(*channel);
            }
        }
    }

    /// A finite coordinate; whole numbers without ".0".
    pub(super) fn coordinate(&mut self, value: f64) {
        let text = self.float.format_finite(value);
        self.bytes.extend_from_slice(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// A colour channel; whole numbers with ".0", which tells them from bytes.
    fn channel(&mut self, value: f32) {
        self.bytes.extend_from_slice(self.float.format(value).as_bytes());
    }

    /// All that was written.
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}
