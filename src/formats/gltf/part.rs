//! Values of a glTF document together with where they stand, as JSON pointers (RFC 6901).

use crate::formats::{Place, ReadError};
use serde_json::Value;

/// A value and its place.
#[derive(Debug, Clone)]
pub(super) struct LocatedValue<'a> {
    pub(super) value: &'a Value,
    pub(super) pointer: String,
}

/// The values of an array and its place.
#[derive(Debug, Clone)]
pub(super) struct List<'a> {
    values: &'a [Value],
    pointer: String,
}

impl<'a> LocatedValue<'a> {
    /// The whole document.
    pub(super) fn root(value: &'a Value) -> Self {
        Self { value, pointer: String::new() }
    }

    /// The member `key`, unless it is absent or null.
    pub(super) fn get(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key).filter(|value| !value.is_null())?;
        Some(Self { value, pointer: format!("{}/{key}", self.pointer) })
    }

    /// The member `key`.
    pub(super) fn need(&self, key: &str) -> Result<Self, ReadError> {
        self.get(key).ok_or_else(|| self.wrong_with("nothing", &format!("the member `{key}`")))
    }

    /// The array `key`; empty when it is absent.
    pub(super) fn list(&self, key: &str) -> Result<List<'a>, ReadError> {
        let Some(part) = self.get(key) else {
            return Ok(List { values: &[], pointer: format!("{}/{key}", self.pointer) });
        };
        match part.value {
            Value::Array(values) => Ok(List { values, pointer: part.pointer }),
            _ => Err(part.wrong("an array")),
        }
    }

    /// The whole number `key`, if it is there.
    pub(super) fn count(&self, key: &str) -> Result<Option<u64>, ReadError> {
        self.get(key).map(|part| part.as_count()).transpose()
    }

    /// The index `key` into `list`, if it is there.
    pub(super) fn index(&self, key: &str, list: &List<'_>) -> Result<Option<usize>, ReadError> {
        self.get(key).map(|part| part.as_index(list)).transpose()
    }

    /// The value as an index into `list`.
    pub(super) fn as_index(&self, list: &List<'_>) -> Result<usize, ReadError> {
        let index = self.as_count()?;
        match usize::try_from(index) {
            Ok(index) if index < list.len() => Ok(index),
            _ => Err(self.wrong(&format!("an index into {} of {} items", list.pointer, list.len()))),
        }
    }

    fn as_count(&self) -> Result<u64, ReadError> {
        // JSON does not tell 5 from 5.0. Beyond 2^53 a double is no whole number for sure.
        let whole = |x: f64| (x >= 0.0 && x.fract() == 0.0 && x < 9e15).then_some(x as u64);
        let count = self.value.as_u64().or_else(|| self.value.as_f64().and_then(whole));
        count.ok_or_else(|| self.wrong("a whole number of 0 or more"))
    }

    /// The `N` numbers `key`, if they are there.
    pub(super) fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, ReadError> {
        let Some(part) = self.get(key) else { return Ok(None) };
        let values = part.value.as_array().map(|values| values.iter().map(Value::as_f64));
        let numbers: Option<Vec<f64>> = values.and_then(Iterator::collect);
        match numbers.map(<[f64; N]>::try_from) {
            Some(Ok(numbers)) => Ok(Some(numbers)),
            _ => Err(part.wrong(&format!("an array of {N} numbers"))),
        }
    }

    /// The text `key`, if it is there.
    pub(super) fn text(&self, key: &str) -> Option<&'a str> {
        self.value.get(key)?.as_str()
    }

    /// This value is not what should stand there.
    #[cold]
    pub(super) fn wrong(&self, expected: &str) -> ReadError {
        let found = match self.value {
            Value::Array(values) => format!("an array of {}", values.len()),
            Value::Object(_) => "an object".to_owned(),
            Value::String(text) if text.len() > 40 => "a long text".to_owned(),
            other => other.to_string(),
        };
        self.wrong_with(&found, expected)
    }

    /// At this value there is something that should not be there.
    #[cold]
    pub(super) fn wrong_with(&self, found: &str, expected: &str) -> ReadError {
        let at = if self.pointer.is_empty() { "the top" } else { &self.pointer };
        ReadError::unparseable(Place::Whole, format!("{found} at {at}"), expected)
    }
}

impl<'a> List<'a> {
    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    /// Item `i`, which must be there.
    pub(super) fn item(&self, i: usize) -> LocatedValue<'a> {
        LocatedValue { value: &self.values[i], pointer: format!("{}/{i}", self.pointer) }
    }

    pub(super) fn items(&self) -> impl Iterator<Item = LocatedValue<'a>> {
        (0..self.len()).map(|i| self.item(i))
    }
}
