//! What the type of an option takes.

use super::parse::{parse_digits, parse_number};
use super::table::OptionKind;
use crate::wire::edges::edges_from_json;
use crate::wire::holes::Holes;
use crate::wire::input_ref::InputRef;
use crate::wire::modeller::{EditSpec, RangeSpec, edits_from_json, ranges_from_json};
use crate::wire::plan::PlanRequest;
use crate::wire::target::{TargetSpec, targets_from_json};
use crate::wire::words::Word;

/// The type of an option's value.
pub(super) trait OptionValue: Sized + PartialEq {
    /// Values of an option of this type whose row says nothing else.
    const KIND: OptionKind;

    /// The value, as a query or a flag writes it.
    fn from_text(text: &str) -> Option<Self>;
}

impl<W: Word + PartialEq> OptionValue for W {
    const KIND: OptionKind = OptionKind::Word { name: W::NAME, words: W::ALL_WORDS, abouts: W::ALL_ABOUTS };

    fn from_text(text: &str) -> Option<Self> {
        W::of_word(text)
    }
}

/// A length in millimetres, unless the row says something else; beyond the largest the squares of float64 end.
impl OptionValue for f64 {
    const KIND: OptionKind = OptionKind::Number { min: 0.0, max: 1e30 };

    fn from_text(text: &str) -> Option<Self> {
        parse_number(text)
    }
}

impl OptionValue for u32 {
    const KIND: OptionKind = OptionKind::Integer { min: 0, max: u32::MAX as u64 };

    fn from_text(text: &str) -> Option<Self> {
        parse_digits(text)?.try_into().ok()
    }
}

impl OptionValue for u64 {
    const KIND: OptionKind = OptionKind::Integer { min: 0, max: u64::MAX };

    fn from_text(text: &str) -> Option<Self> {
        parse_digits(text)
    }
}

impl OptionValue for bool {
    const KIND: OptionKind = OptionKind::Flag;

    fn from_text(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

impl OptionValue for Vec<TargetSpec> {
    const KIND: OptionKind = OptionKind::Targets;

    fn from_text(text: &str) -> Option<Self> {
        targets_from_json(text)
    }
}

impl OptionValue for Vec<[u32; 2]> {
    const KIND: OptionKind = OptionKind::Edges;

    fn from_text(text: &str) -> Option<Self> {
        edges_from_json(text)
    }
}

impl OptionValue for Holes {
    const KIND: OptionKind = OptionKind::Holes;

    fn from_text(text: &str) -> Option<Self> {
        Self::from_text(text)
    }
}

impl OptionValue for Vec<EditSpec> {
    const KIND: OptionKind = OptionKind::Edits;

    fn from_text(text: &str) -> Option<Self> {
        edits_from_json(text)
    }
}

impl OptionValue for Vec<RangeSpec> {
    const KIND: OptionKind = OptionKind::Ranges;

    fn from_text(text: &str) -> Option<Self> {
        ranges_from_json(text)
    }
}

impl OptionValue for PlanRequest {
    const KIND: OptionKind = OptionKind::Plan;

    fn from_text(text: &str) -> Option<Self> {
        Self::from_json(text)
    }
}

impl OptionValue for InputRef {
    const KIND: OptionKind = OptionKind::Input;

    fn from_text(text: &str) -> Option<Self> {
        serde_json::from_str(text).ok()
    }
}
