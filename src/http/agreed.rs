//! What several parts of one request say about the same thing.

use crate::wire::{Operation, Problem, ProblemCode};

/// The operation that two parts of a request name: one of them, or both the same.
pub(super) fn agreed(a: Option<Operation>, b: Option<Operation>) -> Result<Option<Operation>, Problem> {
    match (a, b) {
        (Some(a), Some(b)) if a != b => {
            Err(about_operation("`operation` is given twice with different values"))
        }
        _ => Ok(a.or(b)),
    }
}

/// What two parts of a request say about `name`: that of one of them, or of both the same.
pub(super) fn agreed_member<T: PartialEq>(
    name: &str,
    a: Option<T>,
    b: Option<T>,
) -> Result<Option<T>, Problem> {
    match (a, b) {
        (Some(a), Some(b)) if a != b => Err(Problem {
            parameter: Some(name.to_owned()),
            ..Problem::new(
                ProblemCode::InvalidParameter,
                format!("`{name}` is given twice with different values"),
            )
        }),
        (a, b) => Ok(a.or(b)),
    }
}

/// A problem with the operation that a request names.
pub(super) fn about_operation(detail: &str) -> Problem {
    Problem {
        parameter: Some("operation".to_owned()),
        ..Problem::new(ProblemCode::InvalidParameter, detail).with_allowed(Operation::WORDS.iter().copied())
    }
}
