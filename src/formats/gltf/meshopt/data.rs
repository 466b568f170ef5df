//! The bytes of a stream, one after the other.

use crate::formats::{Place, ReadError};

/// What is left of a stream between its header and its tail.
pub(super) struct Data<'s> {
    bytes: &'s [u8],
    at: usize,
    /// Where the tail begins.
    end: usize,
    /// Where the stream is described.
    pointer: &'s str,
}

impl<'s> Data<'s> {
    pub(super) fn of(bytes: &'s [u8], pointer: &'s str) -> Self {
        Self { bytes, at: 0, end: bytes.len(), pointer }
    }

    /// Takes the last `len` bytes away.
    pub(super) fn tail(&mut self, len: usize) -> Result<&'s [u8], ReadError> {
        match self.end.checked_sub(len).filter(|&end| end >= self.at) {
            Some(end) => {
                let tail = &self.bytes[end..self.end];
                self.end = end;
                Ok(tail)
            }
            None => Err(self.truncated()),
        }
    }

    #[inline]
    pub(super) fn take(&mut self, len: usize) -> Result<&'s [u8], ReadError> {
        if len > self.end - self.at {
            return Err(self.truncated());
        }
        let taken = &self.bytes[self.at..self.at + len];
        self.at += len;
        Ok(taken)
    }

    #[inline]
    pub(super) fn byte(&mut self) -> Result<u8, ReadError> {
        if self.at >= self.end {
            return Err(self.truncated());
        }
        self.at += 1;
        Ok(self.bytes[self.at - 1])
    }

    /// A number of 32 bits in 1 to 5 bytes (unsigned LEB128).
    #[inline]
    pub(super) fn varint(&mut self) -> Result<u32, ReadError> {
        let mut value = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            // What is beyond 32 bits is left out, as the text says.
            value |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(self.wrong_before("a number of more than 5 bytes", "a number whose last byte is below 0x80"))
    }

    /// Checks that nothing is left before the tail.
    pub(super) fn finish(&self) -> Result<(), ReadError> {
        match self.end - self.at {
            0 => Ok(()),
            left => Err(self.wrong(self.at, &format!("{left} bytes more"), "the tail of the stream")),
        }
    }

    /// The byte that was taken last is not what should stand there.
    #[cold]
    pub(super) fn wrong_before(&self, found: &str, expected: &str) -> ReadError {
        self.wrong(self.at.saturating_sub(1), found, expected)
    }

    /// A byte of the tail, counted from its begin, is not what should stand there.
    #[cold]
    pub(super) fn wrong_in_tail(&self, byte: usize, found: &str, expected: &str) -> ReadError {
        self.wrong(self.end + byte, found, expected)
    }

    #[cold]
    fn wrong(&self, at: usize, found: &str, expected: &str) -> ReadError {
        let found = format!("{found} at byte {at} of the stream of {}", self.pointer);
        ReadError::unparseable(Place::Whole, found, expected)
    }

    #[cold]
    fn truncated(&self) -> ReadError {
        self.wrong(self.end, "the end of the data", "more, as the number of elements says")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_begin_with_their_lowest_bits() {
        let of = |bytes: &[u8]| Data::of(bytes, "").varint();
        assert_eq!(of(&[0x7f]), Ok(0x7f));
        assert_eq!(of(&[0x81, 0x04]), Ok(0x201));
        // The text has 0x1fd005 for it, which is the other way round than its rule and its example before.
        assert_eq!(of(&[0xff, 0xa0, 0x05]), Ok(0x1_507f));
        assert_eq!(of(&[0xff, 0xff, 0xff, 0xff, 0x7f]), Ok(u32::MAX), "what is beyond 32 bits is left out");
        assert!(of(&[0x80; 4]).unwrap_err().to_string().contains("the end of the data at byte 4"));
        assert!(of(&[0x80; 6]).unwrap_err().to_string().contains("more than 5 bytes at byte 4"));
    }
}
