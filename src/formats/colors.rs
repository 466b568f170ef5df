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
                // As bytes, which every program reads.
                Color::Linear(_, alpha) => layout.has_alpha |= alpha.is_some(),
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

/// Red, green, blue and alpha of sRGB, 0 to 1.
pub(super) fn as_floats(color: Option<Color>) -> [f32; 4] {
    match color {
        Some(Color::Floats([r, g, b], a)) => [r, g, b, a.unwrap_or(1.0)],
        Some(Color::Bytes([r, g, b], a)) => [r, g, b, a.unwrap_or(255)].map(|c| f32::from(c) / 255.0),
        Some(Color::Linear([r, g, b], a)) => {
            let [r, g, b] = [r, g, b].map(srgb_of_linear);
            [r, g, b, a.unwrap_or(1.0)]
        }
        Some(Color::Index(_)) | None => [1.0; 4],
    }
}

/// Red, green, blue and alpha in proportion to light, 0 to 1.
pub(super) fn as_linear(color: Option<Color>) -> [f32; 4] {
    let [r, g, b, a] = match color {
        Some(Color::Linear([r, g, b], a)) => [r, g, b, a.unwrap_or(1.0)],
        _ => {
            let [r, g, b, a] = as_floats(color);
            let [r, g, b] = [r, g, b].map(linear_of_srgb);
            [r, g, b, a]
        }
    };
    [r, g, b, a].map(|channel| if channel.is_nan() { 1.0 } else { channel.clamp(0.0, 1.0) })
}

/// A channel by the transfer function of IEC 61966-2-1.
fn srgb_of_linear(channel: f32) -> f32 {
    let c = f64::from(channel);
    (if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 }) as f32
}

/// A channel by the inverse of that function.
fn linear_of_srgb(channel: f32) -> f32 {
    let c = f64::from(channel);
    (if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_of_srgb_comes_back_from_linear_light() {
        for byte in 0..=255 {
            let [r, _, _, a] = as_linear(Some(Color::Bytes([byte, 0, 255], Some(byte))));
            let back = as_bytes(Some(Color::Linear([r, 0.0, 1.0], Some(a))));
            assert_eq!(back, [byte, 0, 255, byte]);
        }
        let half = as_linear(Some(Color::Floats([0.5; 3], None)))[0];
        assert!((half - 0.214_041).abs() < 1e-6, "{half}");
    }
}
