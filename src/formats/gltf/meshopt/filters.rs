//! What elements of vertices stand for, where a filter has made them shorter before.
//!
//! Sums, products, quotients and roots of float32 in the order of the text, so that the numbers are the same on all
//! machines. Where the text leaves a value open, it is some value.

use super::BYTES_OF_WORK;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::formats::ReadError;
use crate::formats::gltf::part::LocatedValue;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Filter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Filter {
    /// The filter that `part` names, for elements of `stride` bytes.
    pub(super) fn of(
        part: &LocatedValue<'_>,
        is_for_attributes: bool,
        stride: u64,
    ) -> Result<Self, ReadError> {
        let filter = match part.value.as_str() {
            Some("NONE") => return Ok(Self::None),
            Some("OCTAHEDRAL") => Self::Octahedral,
            Some("QUATERNION") => Self::Quaternion,
            Some("EXPONENTIAL") => Self::Exponential,
            Some("COLOR") => Self::Color,
            _ => return Err(part.wrong("NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR")),
        };
        let is_for_stride = match filter {
            Self::Octahedral | Self::Color => matches!(stride, 4 | 8),
            Self::Quaternion => stride == 8,
            Self::None | Self::Exponential => true,
        };
        if is_for_attributes && is_for_stride {
            return Ok(filter);
        }
        Err(part.wrong("NONE for TRIANGLES and INDICES, and elements of 4 or 8 bytes for most filters"))
    }
}

/// Undoes `filter` in `elements` of `stride` bytes.
pub(super) fn apply(
    filter: Filter,
    stride: usize,
    elements: &mut [u8],
    budget: &Budget,
) -> Result<(), Stopped> {
    if filter == Filter::None {
        return Ok(());
    }
    for part in elements.chunks_mut(8 * CHECK_EVERY) {
        budget.spend((part.len() / BYTES_OF_WORK) as u64)?;
        match (filter, stride) {
            (Filter::None, _) => {}
            (Filter::Octahedral, 4) => each_of_bytes(part, |[x, y, one, rest]| {
                let unit = octahedral([x, y, one].map(|c| f32::from(c as i8)));
                let [x, y, z] = unit.map(|c| (c * 127.0).round() as i8 as u8);
                [x, y, z, rest]
            }),
            (Filter::Octahedral, _) => each_of_shorts(part, |[x, y, one, rest]| {
                let unit = octahedral([x, y, one].map(|c| f32::from(c as i16)));
                let [x, y, z] = unit.map(|c| (c * 32767.0).round() as i16 as u16);
                [x, y, z, rest]
            }),
            (Filter::Quaternion, _) => each_of_shorts(part, |v| quaternion(v.map(|c| c as i16))),
            (Filter::Exponential, _) => {
                part.as_chunks_mut().0.iter_mut().for_each(|word| *word = exponential(*word).to_le_bytes());
            }
            (Filter::Color, 4) => each_of_bytes(part, |[y, co, cg, a]| {
                let shares = color(y.into(), i32::from(co as i8), i32::from(cg as i8), a.into(), 255.0);
                shares.map(|share| share as u8)
            }),
            (Filter::Color, _) => each_of_shorts(part, |[y, co, cg, a]| {
                let shares = color(y.into(), i32::from(co as i16), i32::from(cg as i16), a.into(), 65535.0);
                shares.map(|share| share as u16)
            }),
        }
    }
    Ok(())
}

fn each_of_bytes(elements: &mut [u8], new: impl Fn([u8; 4]) -> [u8; 4]) {
    elements.as_chunks_mut().0.iter_mut().for_each(|element| *element = new(*element));
}

fn each_of_shorts(elements: &mut [u8], new: impl Fn([u16; 4]) -> [u16; 4]) {
    each_of_eight(elements, |b| {
        let shorts = new([0, 2, 4, 6].map(|i| u16::from_le_bytes([b[i], b[i + 1]])));
        let [x, y, z, w] = shorts.map(u16::to_le_bytes);
        [x[0], x[1], y[0], y[1], z[0], z[1], w[0], w[1]]
    });
}

fn each_of_eight(elements: &mut [u8], new: impl Fn([u8; 8]) -> [u8; 8]) {
    elements.as_chunks_mut().0.iter_mut().for_each(|element| *element = new(*element));
}

/// The unit vector at `x`, `y` of an octahedron that is laid out as a square from -`one` to `one`.
fn octahedral([x, y, one]: [f32; 3]) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // What is below lies in the corners of the square.
    let below = z.min(0.0);
    let (x, y) = (x - below.abs().copysign(x), y - below.abs().copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

/// The unit quaternion of the three components that are not the greatest, and of the scale with the number of that one.
fn quaternion(stored: [i16; 4]) -> [u16; 4] {
    let one = f32::from(stored[3] | 3);
    let range = 1.0 / 2f32.sqrt();
    let [x, y, z] = [stored[0], stored[1], stored[2]].map(|c| f32::from(c) / one * range);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut unit = [0; 4];
    for (i, c) in [w, x, y, z].into_iter().enumerate() {
        unit[(usize::from(stored[3] as u16 & 3) + i) % 4] = (c * 32767.0).round() as i16 as u16;
    }
    unit
}

/// The number of a mantissa of 24 bits and an exponent of 8.
fn exponential(word: [u8; 4]) -> f32 {
    let stored = i32::from_le_bytes(word);
    let (exponent, mantissa) = (stored >> 24, stored << 8 >> 8);
    let power = f64::from_bits(((1023 + i64::from(exponent)) as u64) << 52);
    (f64::from(mantissa) * power) as f32
}

/// Red, green, blue and alpha, up to `most`, of luma, chrominance and an alpha that begins with a bit for the scale.
fn color(y: i32, co: i32, cg: i32, a: i32, most: f32) -> [f32; 4] {
    // All ones up to that bit: 0 for 0, which no colour has.
    let scale = (1i32 << (32 - a.leading_zeros())) - 1;
    let alpha = a & scale >> 1;
    let share = |c: i32| (c as f32 * (most / scale as f32)).round();
    [y + co - cg, y + cg, y - co - cg, alpha << 1 | alpha & 1].map(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_exponent_is_exact() {
        let of =
            |exponent: i32, mantissa: i32| exponential((exponent << 24 | mantissa & 0xff_ffff).to_le_bytes());
        assert_eq!(of(0, 1), 1.0);
        assert_eq!(of(-2, -3), -0.75);
        assert_eq!(of(100, (1 << 23) - 1), ((1 << 23) - 1) as f32 * 2f32.powi(100));
        assert_eq!(of(-100, -(1 << 23)), -(2f32.powi(-77)));
        assert_eq!(of(-128, 1), f32::from_bits(1 << 21), "2^-128 has no full mantissa");
        assert_eq!((of(127, 2), of(-128, 0)), (f32::INFINITY, 0.0));
    }

    #[test]
    fn the_sides_of_the_octahedron_are_unit_vectors() {
        assert_eq!(octahedral([0.0, 0.0, 7.0]), [0.0, 0.0, 1.0]);
        assert_eq!(octahedral([7.0, 0.0, 7.0]), [1.0, 0.0, 0.0]);
        assert_eq!(octahedral([-7.0, -7.0, 7.0]), [0.0, 0.0, -1.0]);
        assert_eq!(quaternion([0, 0, 0, 0x7ffe]), [0, 0, 32767, 0]);
    }

    #[test]
    fn white_grey_and_what_is_no_colour() {
        // Luma of eight bits, and alpha of seven with a bit above it.
        assert_eq!(color(255, 0, 0, 255, 255.0), [255.0; 4]);
        assert_eq!(color(3, 0, 0, 0b111, 255.0), [109.0, 109.0, 109.0, 255.0]);
        assert_eq!(color(0, 0, 0, 0, 255.0).map(|share| share as u8), [0; 4]);
    }
}
