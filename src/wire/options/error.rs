//! Options that cannot be taken.

use std::borrow::Cow;
use std::fmt;

use super::nearest::nearest;
use super::table::OptionSpec;
use crate::wire::plan_fault::PlanFault;
use crate::wire::problem::Problem;
use crate::wire::problem_code::ProblemCode;
use crate::wire::shortened::shortened;
use crate::wire::words::Operation;

/// An option that cannot be taken.
#[derive(Debug, Clone, PartialEq)]
pub enum OptionError {
    /// There is no such option.
    Unknown {
        /// The name that was given.
        name: String,
        /// The nearest name there is.
        suggestion: Option<&'static str>,
    },
    /// The value is not one of the option's.
    Invalid {
        /// The option.
        spec: &'static OptionSpec,
        /// The value that was given.
        value: String,
    },
    /// The value is no plan.
    NoPlan {
        /// The option.
        spec: &'static OptionSpec,
        /// What is wrong with it.
        fault: PlanFault,
    },
    /// The operation does not take it.
    NotTaken {
        /// The option.
        spec: &'static OptionSpec,
        /// The operation.
        operation: Operation,
    },
    /// It does not go with another one that is given.
    Excluded {
        /// The option.
        spec: &'static OptionSpec,
        /// The other one.
        by: &'static str,
    },
    /// It is about a picture of pixels, and a mesh is asked for in its place.
    OfPixels {
        /// The option.
        spec: &'static OptionSpec,
    },
    /// It has no meaning without something else.
    Lacking {
        /// The option.
        spec: &'static OptionSpec,
        /// What it needs.
        needs: &'static str,
    },
    /// It is given twice with different values.
    Contradictory {
        /// The option.
        spec: &'static OptionSpec,
    },
}

impl fmt::Display for OptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { name, suggestion: Some(near) } => {
                write!(f, "unknown option `{name}`; did you mean `{near}`?")
            }
            Self::Unknown { name, suggestion: None } => write!(f, "unknown option `{name}`"),
            Self::Invalid { spec, value } => {
                write!(f, "`{}` cannot be `{}`; expected {}", spec.name, shortened(value), spec.expected())?;
                match nearest(value, spec.words().iter().copied()) {
                    Some(near) => write!(f, "; did you mean `{near}`?"),
                    None => Ok(()),
                }
            }
            Self::NoPlan { fault, .. } => f.write_str(&fault.told),
            Self::NotTaken { spec, operation } => {
                let takers: Vec<_> = spec.operations.iter().map(|taker| taker.word()).collect();
                write!(f, "`{operation}` takes no `{}`; it is an option of {}", spec.name, takers.join(", "))
            }
            Self::Excluded { spec, by } => write!(f, "`{}` does not go with `{by}`", spec.name),
            Self::OfPixels { spec } => write!(
                f,
                "`{}` is about pictures of pixels, and a GLB has none; leave it out, or ask for a PNG",
                spec.name
            ),
            Self::Lacking { spec, needs } => write!(f, "this `{}` needs {needs}", spec.name),
            Self::Contradictory { spec } => write!(f, "`{}` is given twice with different values", spec.name),
        }
    }
}

impl std::error::Error for OptionError {}

impl From<&OptionError> for Problem {
    fn from(error: &OptionError) -> Self {
        let of = |code, parameter: &str| Self {
            parameter: Some(parameter.to_owned()),
            ..Self::new(code, error.to_string())
        };
        match error {
            OptionError::Unknown { name, suggestion } => {
                Self { suggestion: suggestion.map(Into::into), ..of(ProblemCode::UnknownParameter, name) }
            }
            OptionError::Invalid { spec, value } => Self {
                expected: Some(spec.expected()),
                suggestion: nearest(value, spec.words().iter().copied()).map(Into::into),
                ..of(ProblemCode::InvalidParameter, spec.name).with_allowed(spec.words().iter().copied())
            },
            OptionError::NoPlan { spec, fault } => Self {
                expected: Some(spec.expected()),
                suggestion: fault.suggestion.clone().map(Cow::Owned),
                allowed: fault.allowed.iter().cloned().map(Cow::Owned).collect(),
                ..of(ProblemCode::InvalidParameter, spec.name)
            },
            OptionError::NotTaken { spec, .. } => of(ProblemCode::UnknownParameter, spec.name),
            OptionError::Contradictory { spec }
            | OptionError::Excluded { spec, .. }
            | OptionError::OfPixels { spec }
            | OptionError::Lacking { spec, .. } => of(ProblemCode::InvalidParameter, spec.name),
        }
    }
}

impl From<OptionError> for Problem {
    fn from(error: OptionError) -> Self {
        Self::from(&error)
    }
}
