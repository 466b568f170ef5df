//! Indices: triangles beside the edges and vertices before them (mode `TRIANGLES`), and sequences of any kind (mode
//! `INDICES`).

use super::BYTES_OF_WORK;
use super::data::Data;
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::ReadError;

const TRIANGLES: u8 = 0xe1;
const SEQUENCE: u8 = 0xd1;
/// Bytes of the table at the end of triangles.
const TABLE_BYTES: usize = 16;
/// Bytes of the padding at the end of a sequence.
const PADDING_BYTES: usize = 4;

/// Bytes that a stream of `count` indices of triangles has at least: a code for each triangle.
pub(super) fn triangles_bytes_min(count: u64) -> u64 {
    1 + count / 3 + TABLE_BYTES as u64
}

/// Bytes that a stream of `count` indices has at least: one for each.
pub(super) fn sequence_bytes_min(count: u64) -> u64 {
    count.saturating_add(1 + PADDING_BYTES as u64)
}

/// The last sixteen of what was put in.
struct Latest<T> {
    items: [T; 16],
    count: usize,
}

impl<T: Copy> Latest<T> {
    fn of(any: T) -> Self {
        Self { items: [any; 16], count: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.count % 16] = item;
        self.count += 1;
    }

    /// The item before which `back` others were put in last, if there is one.
    #[inline]
    fn get(&self, back: usize, data: &Data<'_>) -> Result<T, ReadError> {
        if back < self.count {
            return Ok(self.items[(self.count - 1 - back) % 16]);
        }
        let expected = "an edge or a vertex that came before";
        Err(data.wrong_before(&format!("a triangle at what was {} before it", back + 1), expected))
    }
}

/// What is known of the triangles so far.
struct TriangleDecoder<'s> {
    data: Data<'s>,
    edges: Latest<[u32; 2]>,
    vertices: Latest<u32>,
    /// The vertex that no triangle had yet.
    next: u32,
    /// The last index that was stored as a number.
    last: u32,
}

/// Appends `count` indices of triangles, three each, in `stride` bytes.
pub(super) fn triangles_into(
    elements: &mut Vec<u8>,
    mut data: Data<'_>,
    count: u64,
    stride: usize,
    budget: &Budget,
) -> Result<(), ReadError> {
    check_header(&mut data, TRIANGLES, "0xe1, the header of triangles")?;
    let table = data.tail(TABLE_BYTES)?;
    let is_entry = |i: usize, byte: u8| byte & 15 != 15 && byte >> 4 != 15 && (i < 14 || byte == 0);
    if let Some(at) = (0..TABLE_BYTES).find(|&i| !is_entry(i, table[i])) {
        let expected = "a table without the digit f, whose last two bytes are 0";
        return Err(data.wrong_in_tail(at, &format!("{:#04x}", table[at]), expected));
    }
    let codes = data.take((count / 3) as usize)?;
    let mut state =
        TriangleDecoder { data, edges: Latest::of([0; 2]), vertices: Latest::of(0), next: 0, last: 0 };
    for part in codes.chunks(CHECK_EVERY) {
        budget.spend((3 * stride * part.len() / BYTES_OF_WORK) as u64)?;
        for &code in part {
            let [a, b, c] = state.triangle(code, table)?;
            for index in [a, b, c] {
                put(elements, index, stride);
            }
        }
    }
    state.data.finish()
}

impl TriangleDecoder<'_> {
    #[inline]
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], ReadError> {
        let (edge, vertex) = (usize::from(code >> 4), code & 15);
        if edge < 15 {
            let [a, b] = self.edges.get(edge, &self.data)?;
            let c = match vertex {
                0 => self.fresh(),
                1..13 => self.vertices.get(usize::from(vertex), &self.data)?,
                13 => self.stepped(u32::MAX),
                14 => self.stepped(1),
                _ => self.stored()?,
            };
            if !(1..13).contains(&vertex) {
                self.vertices.push(c);
            }
            self.edges.push([c, b]);
            self.edges.push([a, c]);
            return Ok([a, b, c]);
        }
        let others = if vertex < 14 { table[usize::from(vertex)] } else { self.data.byte()? };
        if vertex >= 14 && others == 0 {
            self.next = 0;
        }
        let (second, third) = (others >> 4, others & 15);
        let a = if vertex == 15 { self.stored()? } else { self.fresh() };
        let b = self.corner(second)?;
        let c = self.corner(third)?;
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        self.vertices.push(a);
        for (corner, digit) in [(b, second), (c, third)] {
            if matches!(digit, 0 | 15) {
                self.vertices.push(corner);
            }
        }
        Ok([a, b, c])
    }

    fn corner(&mut self, digit: u8) -> Result<u32, ReadError> {
        match digit {
            0 => Ok(self.fresh()),
            15 => self.stored(),
            _ => self.vertices.get(usize::from(digit) - 1, &self.data),
        }
    }

    fn fresh(&mut self) -> u32 {
        let fresh = self.next;
        self.next = fresh.wrapping_add(1);
        fresh
    }

    fn stepped(&mut self, step: u32) -> u32 {
        self.last = self.last.wrapping_add(step);
        self.last
    }

    fn stored(&mut self) -> Result<u32, ReadError> {
        let coded = self.data.varint()?;
        Ok(self.stepped(coded >> 1 ^ (coded & 1).wrapping_neg()))
    }
}

/// Appends `count` indices in `stride` bytes, each stored as the difference to one of two before it.
pub(super) fn sequence_into(
    elements: &mut Vec<u8>,
    mut data: Data<'_>,
    count: u64,
    stride: usize,
    budget: &Budget,
) -> Result<(), ReadError> {
    check_header(&mut data, SEQUENCE, "0xd1, the header of indices")?;
    data.tail(PADDING_BYTES)?;
    let mut last = [0u32; 2];
    for i in 0..count as usize {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.spend((stride * CHECK_EVERY / BYTES_OF_WORK) as u64)?;
        }
        let coded = data.varint()?;
        let (last, coded) = (&mut last[(coded & 1) as usize], coded >> 1);
        *last = last.wrapping_add(coded >> 1 ^ (coded & 1).wrapping_neg());
        put(elements, *last, stride);
    }
    data.finish()
}

fn check_header(data: &mut Data<'_>, header: u8, expected: &str) -> Result<(), ReadError> {
    let found = data.byte()?;
    if found == header { Ok(()) } else { Err(data.wrong_before(&format!("{found:#04x}"), expected)) }
}

/// Appends the lowest `stride` bytes, 2 or 4, of an index.
#[inline]
fn put(elements: &mut Vec<u8>, index: u32, stride: usize) {
    match stride {
        2 => elements.extend_from_slice(&(index as u16).to_le_bytes()),
        _ => elements.extend_from_slice(&index.to_le_bytes()),
    }
}
