//! Elements of vertices: differences of each byte to that of the element before it, in groups of 16 (mode `ATTRIBUTES`).

use super::BYTES_OF_WORK;
use super::data::Data;
use crate::budget::Budget;
use crate::formats::ReadError;

const VERSION_0: u8 = 0xa0;
const VERSION_1: u8 = 0xa1;
const GROUP: usize = 16;
const BLOCK_MAX: usize = 256;

/// Bits of a difference for each of the two bits that a group has in the header: in version 0, and for the first two
/// controls of version 1.
const BITS_0: [u8; 4] = [0, 2, 4, 8];
const BITS_1: [[u8; 4]; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

/// How the differences of four bytes are stored.
#[derive(Debug, Clone, Copy)]
enum Delta {
    Bytes,
    Shorts,
    /// Exclusive or of 32 bits, rotated to the left by so many.
    Xor(u32),
}

/// Elements of a block.
fn block_elements(stride: usize) -> usize {
    ((8192 / stride) & !(GROUP - 1)).min(BLOCK_MAX)
}

/// Bytes of the baseline and of what says how differences are stored, and of both with what they are padded by.
fn tail_bytes(version: u8, stride: usize) -> (usize, usize) {
    match version {
        VERSION_1 => (stride + stride / 4, (stride + stride / 4).max(24)),
        _ => (stride, stride.max(32)),
    }
}

/// Bytes that a stream of `count` elements has at least: in version 0 a header for each byte of a block, in version 1 a
/// control, which may say that all is as before.
pub(super) fn stream_bytes_min(stream: &[u8], count: u64, stride: u64) -> u64 {
    let version = stream.first().copied().unwrap_or(VERSION_1);
    let block = block_elements(stride as usize) as u64;
    let of_block = |elements: u64| match version {
        VERSION_0 => stride * elements.div_ceil(4 * GROUP as u64),
        _ => stride / 4,
    };
    let (whole, rest) = (count / block, count % block);
    let of_rest = if rest == 0 { 0 } else { of_block(rest) };
    let of_blocks = whole.saturating_mul(of_block(block)).saturating_add(of_rest);
    of_blocks.saturating_add(1 + tail_bytes(version, stride as usize).1 as u64)
}

/// Decodes elements of `stride` bytes, a multiple of 4 up to 256, into `elements`.
pub(super) fn decode(
    mut data: Data<'_>,
    stride: usize,
    elements: &mut [u8],
    budget: &Budget,
) -> Result<(), ReadError> {
    let version = data.byte()?;
    if !matches!(version, VERSION_0 | VERSION_1) {
        return Err(data.wrong_before(&format!("{version:#04x}"), "0xa0 or 0xa1, the header of attributes"));
    }
    let (tail_len, padded) = tail_bytes(version, stride);
    let tail = data.tail(padded)?;
    let (baseline, modes) = tail[padded - tail_len..].split_at(stride);
    let mut deltas = [Delta::Bytes; 64];
    for (i, (delta, &mode)) in deltas.iter_mut().zip(modes).enumerate() {
        *delta = match (mode & 15, mode >> 4) {
            (0, 0) => Delta::Bytes,
            (1, 0) => Delta::Shorts,
            (2, rotation) => Delta::Xor(u32::from(rotation)),
            _ => {
                let byte = padded - modes.len() + i;
                let expected = "a mode of a channel: 0x00, 0x01 or 0x02 to 0xf2";
                return Err(data.wrong_in_tail(byte, &format!("{mode:#04x}"), expected));
            }
        };
    }
    let mut last = [[0; 4]; 64];
    last.as_flattened_mut()[..stride].copy_from_slice(baseline);
    let mut lanes = [[0; BLOCK_MAX]; 4];
    for block in elements.chunks_mut(block_elements(stride) * stride) {
        budget.spend((block.len() / BYTES_OF_WORK) as u64)?;
        let count = block.len() / stride;
        let controls = if version == VERSION_1 { Some(data.take(stride / 4)?) } else { None };
        for channel in 0..stride / 4 {
            for (k, lane) in lanes.iter_mut().enumerate() {
                match controls.map(|controls| controls[channel] >> (2 * k) & 3) {
                    None => groups_into(lane, &mut data, &BITS_0, count)?,
                    Some(2) => lane.fill(0),
                    Some(3) => lane[..count].copy_from_slice(data.take(count)?),
                    Some(control) => groups_into(lane, &mut data, &BITS_1[usize::from(control)], count)?,
                }
            }
            let at = 4 * channel;
            let of_channel = block.chunks_exact_mut(stride).map(|element| &mut element[at..at + 4]);
            add_up(of_channel, &lanes, deltas[channel], &mut last[channel]);
        }
    }
    data.finish()
}

/// Decodes one byte of each of `count` elements.
fn groups_into(
    lane: &mut [u8; BLOCK_MAX],
    data: &mut Data<'_>,
    bits_of: &[u8; 4],
    count: usize,
) -> Result<(), ReadError> {
    let groups = count.div_ceil(GROUP);
    let header = data.take(groups.div_ceil(4))?;
    for (g, group) in lane.as_chunks_mut::<GROUP>().0.iter_mut().take(groups).enumerate() {
        match bits_of[usize::from(header[g / 4] >> (2 * (g % 4)) & 3)] {
            0 => group.fill(0),
            1 => group_into::<1>(group, data)?,
            2 => group_into::<2>(group, data)?,
            4 => group_into::<4>(group, data)?,
            _ => group.copy_from_slice(data.take(GROUP)?),
        }
    }
    Ok(())
}

/// Decodes a group of `BITS` bits each, where all ones stand for a byte that follows the group.
#[inline]
fn group_into<const BITS: usize>(group: &mut [u8; GROUP], data: &mut Data<'_>) -> Result<(), ReadError> {
    let packed = data.take(2 * BITS)?;
    let ones = (1 << BITS) - 1;
    for (i, value) in group.iter_mut().enumerate() {
        let bit = i * BITS % 8;
        // Single bits begin with the least one of a byte, others with the greatest.
        let shift = if BITS == 1 { bit } else { 8 - BITS - bit };
        let code = packed[i * BITS / 8] >> shift & ones;
        *value = if code == ones { data.byte()? } else { code };
    }
    Ok(())
}

/// Gives four bytes of each element what `last` and the differences up to it make.
#[inline]
fn add_up<'e>(
    elements: impl Iterator<Item = &'e mut [u8]>,
    lanes: &[[u8; BLOCK_MAX]; 4],
    delta: Delta,
    last: &mut [u8; 4],
) {
    let word = |i: usize| [lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]];
    match delta {
        Delta::Bytes => {
            for (i, element) in elements.enumerate() {
                for (last, coded) in last.iter_mut().zip(word(i)) {
                    *last = last.wrapping_add(coded >> 1 ^ (coded & 1).wrapping_neg());
                }
                element.copy_from_slice(last);
            }
        }
        Delta::Shorts => {
            for (i, element) in elements.enumerate() {
                let coded = word(i);
                for (last, coded) in last.as_chunks_mut::<2>().0.iter_mut().zip(coded.as_chunks::<2>().0) {
                    let coded = u16::from_le_bytes(*coded);
                    let difference = coded >> 1 ^ (coded & 1).wrapping_neg();
                    *last = u16::from_le_bytes(*last).wrapping_add(difference).to_le_bytes();
                }
                element.copy_from_slice(last);
            }
        }
        Delta::Xor(rotation) => {
            let mut bits = u32::from_le_bytes(*last);
            for (i, element) in elements.enumerate() {
                bits ^= u32::from_le_bytes(word(i)).rotate_right(rotation);
                element.copy_from_slice(&bits.to_le_bytes());
            }
            *last = bits.to_le_bytes();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_group_of_the_text_is_decoded() {
        let bytes = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut data = Data::of(&bytes, "");
        let mut group = [0; GROUP];
        group_into::<4>(&mut group, &mut data).unwrap();
        data.finish().unwrap();
        let differences = group.map(|coded| (coded >> 1 ^ (coded & 1).wrapping_neg()) as i8);
        assert_eq!(differences, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
        let mut short = Data::of(&bytes[..9], "");
        assert!(group_into::<4>(&mut group, &mut short).is_err());
    }

    #[test]
    fn blocks_are_as_large_as_the_text_says() {
        assert_eq!([4, 12, 32, 36, 64, 256].map(block_elements), [256, 256, 256, 224, 128, 32]);
    }
}
