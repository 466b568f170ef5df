//! Pixels, and what is put on them.

use super::letters::{LETTER_HEIGHT, LETTER_WIDTH, rows_of};

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// A picture: rows of pixels from the top left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Canvas {
    width: usize,
    height: usize,
    /// Three bytes for each pixel.
    pub(super) bytes: Vec<u8>,
}

impl Canvas {
    /// A picture of one colour.
    pub fn filled(width: usize, height: usize, color: Rgb) -> Self {
        Self { width, height, bytes: color.repeat(width * height) }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The colour of a pixel; `None` outside.
    pub fn pixel(&self, x: usize, y: usize) -> Option<Rgb> {
        let at = (y * self.width + x) * 3;
        let is_inside = x < self.width && y < self.height;
        is_inside.then(|| [self.bytes[at], self.bytes[at + 1], self.bytes[at + 2]])
    }

    /// Puts `other` on it with its top left at `x`, `y`; what does not fit is left out.
    pub fn put(&mut self, other: &Self, x: usize, y: usize) {
        let width = other.width.min(self.width.saturating_sub(x));
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let (from, to) = (row * other.width * 3, ((y + row) * self.width + x) * 3);
            self.bytes[to..to + width * 3].copy_from_slice(&other.bytes[from..from + width * 3]);
        }
    }

    /// Fills a box; what does not fit is left out.
    pub fn fill(&mut self, x: usize, y: usize, width: usize, height: usize, color: Rgb) {
        let right = (x + width).min(self.width);
        for row in y..(y + height).min(self.height) {
            for column in x..right {
                let at = (row * self.width + column) * 3;
                self.bytes[at..at + 3].copy_from_slice(&color);
            }
        }
    }

    /// Writes `text` in capitals of `scale` pixels for each dot, with its top left at `x`, `y`. Characters without a
    /// shape are left blank.
    pub fn write(&mut self, text: &str, x: usize, y: usize, scale: usize, color: Rgb) {
        for (at, letter) in text.chars().enumerate() {
            let left = x + at * (LETTER_WIDTH + 1) * scale;
            for (row, dots) in rows_of(letter).into_iter().enumerate().take(LETTER_HEIGHT) {
                for column in (0..LETTER_WIDTH).filter(|column| dots >> (LETTER_WIDTH - 1 - column) & 1 == 1)
                {
                    self.fill(left + column * scale, y + row * scale, scale, scale, color);
                }
            }
        }
    }
}
