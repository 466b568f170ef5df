//! Options out of names and values.

use serde_json::{Map, Value};

use super::lookup::spec_of;
use super::table::{OptionKind, OptionSpec};
use super::{OptionError, Options};
use crate::wire::plan_fault::PlanFault;

impl Options {
    /// Options from names and values, as in a query.
    ///
    /// # Errors
    /// The first one that cannot be taken.
    pub fn from_pairs<N: AsRef<str>, V: AsRef<str>>(
        pairs: impl IntoIterator<Item = (N, V)>,
    ) -> Result<Self, OptionError> {
        let mut options = Self::default();
        for (name, value) in pairs {
            options.set(name.as_ref(), value.as_ref())?;
        }
        Ok(options)
    }

    /// Options from the members of a JSON object.
    ///
    /// # Errors
    /// The first one that cannot be taken.
    pub fn from_json(members: &Map<String, Value>) -> Result<Self, OptionError> {
        let mut options = Self::default();
        for (name, value) in members {
            options.set_json(name, value)?;
        }
        Ok(options)
    }

    /// Takes one option. The same value twice is no contradiction.
    ///
    /// # Errors
    /// There is no such option, it does not take this value, or it has another value already.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), OptionError> {
        let spec = spec_of(name)?;
        let is_in_range = match spec.kind {
            OptionKind::Integer { min, max } => {
                parse_digits(value).is_some_and(|number| (min..=max).contains(&number))
            }
            OptionKind::Number { min, max } => {
                parse_number(value).is_some_and(|number| (min..=max).contains(&number))
            }
            _ => true,
        };
        let taken = if is_in_range { self.take(name, value) } else { ValueOutcome::Invalid };
        taken.into_result(spec, value)
    }

    /// Takes one option whose value is JSON of the option's own type.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn set_json(&mut self, name: &str, value: &Value) -> Result<(), OptionError> {
        let spec = spec_of(name)?;
        let text = match (spec.kind, value) {
            (OptionKind::Word { .. } | OptionKind::Holes, Value::String(word)) => word.clone(),
            (OptionKind::Integer { .. }, Value::Number(number)) => {
                number.to_string().trim_end_matches(".0").to_owned()
            }
            (OptionKind::Number { .. }, Value::Number(number)) => number.to_string(),
            (OptionKind::Flag, Value::Bool(flag)) => flag.to_string(),
            (OptionKind::Input | OptionKind::Plan, Value::Object(_))
            | (
                OptionKind::Targets
                | OptionKind::Edges
                | OptionKind::Holes
                | OptionKind::Edits
                | OptionKind::Ranges,
                Value::Array(_),
            ) => value.to_string(),
            _ => return Err(OptionError::Invalid { spec, value: value.to_string() }),
        };
        self.set(name, &text)
    }
}

/// What became of a value.
pub(super) enum ValueOutcome {
    Yes,
    Invalid,
    Contradictory,
}

impl ValueOutcome {
    pub(super) fn into_result(self, spec: &'static OptionSpec, value: &str) -> Result<(), OptionError> {
        match self {
            Self::Yes => Ok(()),
            Self::Invalid => {
                let fault = if spec.kind == OptionKind::Plan { PlanFault::of(value) } else { None };
                Err(match fault {
                    Some(fault) => OptionError::NoPlan { spec, fault },
                    None => OptionError::Invalid { spec, value: value.to_owned() },
                })
            }
            Self::Contradictory => Err(OptionError::Contradictory { spec }),
        }
    }
}

pub(super) fn put<T: PartialEq>(place: &mut Option<T>, value: Option<T>) -> ValueOutcome {
    match (&place, &value) {
        (_, None) => return ValueOutcome::Invalid,
        (Some(old), Some(new)) if old != new => return ValueOutcome::Contradictory,
        _ => *place = value,
    }
    ValueOutcome::Yes
}

pub(super) fn put_if_given<T: PartialEq>(place: &mut Option<T>, value: Option<T>) -> ValueOutcome {
    if value.is_none() { ValueOutcome::Yes } else { put(place, value) }
}

/// A plain decimal number: no sign, no blank, no words such as `inf`.
pub(super) fn parse_number(text: &str) -> Option<f64> {
    let is_plain = text.starts_with(|c: char| c.is_ascii_digit()) && !text.contains(' ');
    text.parse().ok().filter(|number: &f64| is_plain && number.is_finite())
}

/// A number written in digits only: no sign, no blank.
pub(super) fn parse_digits(text: &str) -> Option<u64> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}
