//! Part of a result (`Range`, RFC 9110 section 14).

use std::ops::RangeInclusive;

/// What of a file of a known length is asked for.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum HttpRange {
    /// All of it.
    Whole,
    /// The bytes at these positions.
    Bytes(RangeInclusive<u64>),
    /// Bytes that the file does not have.
    Beyond,
}

impl HttpRange {
    /// Reads a `Range` header for a file of `len` bytes. Another unit, several ranges and malformed ones are answered
    /// with the whole file, which the standard allows.
    pub(super) fn parse(header: Option<&str>, len: u64) -> Self {
        let Some(spec) = header.and_then(|value| value.trim().strip_prefix("bytes=")) else {
            return Self::Whole;
        };
        let Some((first, last)) = spec.split_once('-') else { return Self::Whole };
        let (first, last) = (first.trim(), last.trim());
        match (number(first), number(last)) {
            (Some(first), Some(last)) if first <= last => Self::within(first, last, len),
            (Some(first), None) if last.is_empty() => Self::within(first, u64::MAX, len),
            (None, Some(0)) if first.is_empty() => Self::Beyond,
            (None, Some(suffix)) if first.is_empty() => {
                Self::within(len.saturating_sub(suffix), u64::MAX, len)
            }
            _ => Self::Whole,
        }
    }

    fn within(first: u64, last: u64, len: u64) -> Self {
        if first < len { Self::Bytes(first..=last.min(len - 1)) } else { Self::Beyond }
    }
}

/// A number of digits; one too large for any file is as good as the largest.
fn number(text: &str) -> Option<u64> {
    super::prefer::seconds_of(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(header: &str) -> HttpRange {
        HttpRange::parse(Some(header), 100)
    }

    #[test]
    fn a_range_is_cut_at_the_end_of_the_file() {
        assert_eq!(part("bytes=0-9"), HttpRange::Bytes(0..=9));
        assert_eq!(part("bytes=90-"), HttpRange::Bytes(90..=99));
        assert_eq!(part("bytes=90-99999999999999999999999"), HttpRange::Bytes(90..=99));
        assert_eq!(part("bytes=-5"), HttpRange::Bytes(95..=99));
        assert_eq!(part("bytes=-500"), HttpRange::Bytes(0..=99));
    }

    #[test]
    fn a_range_after_the_end_is_beyond() {
        assert_eq!(part("bytes=100-"), HttpRange::Beyond);
        assert_eq!(part("bytes=100-200"), HttpRange::Beyond);
        assert_eq!(part("bytes=-0"), HttpRange::Beyond);
        assert_eq!(HttpRange::parse(Some("bytes=0-"), 0), HttpRange::Beyond);
        assert_eq!(HttpRange::parse(Some("bytes=-1"), 0), HttpRange::Beyond);
    }

    #[test]
    fn what_is_not_one_range_of_bytes_is_the_whole_file() {
        for header in [
            "lines=1-2",
            "bytes=5-2",
            "bytes=1-2,4-5",
            "bytes=x-y",
            "bytes=5-x",
            "bytes=100-x",
            "bytes=-",
            "bytes",
        ] {
            assert_eq!(part(header), HttpRange::Whole, "{header}");
        }
        assert_eq!(HttpRange::parse(None, 100), HttpRange::Whole);
    }
}
