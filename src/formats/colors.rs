//! Colours of a list of elements: collected while some may have none, and written in one layout for all.

use crate::mesh::Color;

/// Notes the colour of element `i`, the next one. The list stays empty until the first colour.
#[inline]
pub(super) fn note_color(colors: &mut Vec<Option<Color>>, i: usize, color: Option<Color>) {
    if color.is_some() || !colors.is_empty() {
        colors.resize(i, None);
        colors.push(color);
    }
}

/// What every element of a list gets when it is written. Elements without a colour become opaque white.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ColorLayout {
    /// Channels are bytes, because all colours are; otherwise floats.
    pub(super) is_bytes: bool,
    /// There is an alpha channel, because some colour has one.
    pub(super) has_alpha: bool,
}

impl ColorLayout {
    /// The layout for `colors`; nothing if no element has red, green and blue.
    pub(super) fn of(colors: &[Option<Color>]) -> Option<Self> {
        let mut has_any = false;
        let mut layout = Self { is_bytes: true, has_alpha: false };
        for color in colors.iter().flatten() {
            match color {
                Color::Bytes(_, alpha) => layout.has_alpha |= alpha.is_some(),
                Color::Floats(_, alpha) => {
                    layout.is_bytes = false;
                    layout.has_alpha |= alpha.is_some();
                }
                Color::Index(_) => continue,
            }
            has_any = true;
        }
        has_any.then_some(layout)
    }

    /// Number of channels.
    pub(super) fn channels(self) -> usize {
        if self.has_alpha { 4 } else { 3 }
    }
}

/// Red, green, blue and alpha, 0 to 255. Floats are rounded to the nearest byte.
pub(super) fn as_bytes(color: Option<Color>) -> [u8; 4] {
    match color {
        Some(Color::Bytes([r, g, b], a)) => [r, g, b, a.unwrap_or(255)],
        _ => as_floats(color).map(|c| (c * 255.0).round() as u8),
    }
}

/// Red, green, blue and alpha, 0 to 1.
pub(super) fn as_floats(color: Option<Color>) -> [f32; 4] {
    match color {
        Some(Color::Floats([r, g, b], a)) => [r, g, b, a.unwrap_or(1.0)],
        Some(Color::Bytes([r, g, b], a)) => [r, g, b, a.unwrap_or(255)].map(|c| f32::from(c) / 255.0),
        Some(Color::Index(_)) | None => [1.0; 4],
    }
}
