//! Whole numbers of JSON, which some programs write with a fraction of zero.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// The number, if it is whole and in range.
pub(super) fn whole_number(number: f64) -> Option<u32> {
    let is_whole = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
    is_whole.then_some(number as u32)
}

/// Reads a whole number.
pub(super) fn whole<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    whole_number(f64::deserialize(from)?).ok_or_else(|| D::Error::custom("not a whole number"))
}
