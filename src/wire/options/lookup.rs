//! An option by its name, and the name that a wrong one was probably meant to be.

use super::SPECS;
use super::error::OptionError;
use super::nearest::nearest;
use super::table::OptionSpec;

pub(super) fn spec_of(name: &str) -> Result<&'static OptionSpec, OptionError> {
    let names = || SPECS.iter().map(|spec| spec.name);
    SPECS
        .iter()
        .find(|spec| spec.name == name)
        .ok_or_else(|| OptionError::Unknown { name: name.to_owned(), suggestion: nearest(name, names()) })
}
