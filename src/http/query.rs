//! Query parameters: names and values, none of them unknown.

use axum::extract::Query;
use axum::http::Uri;

use super::prefer;
use crate::wire::{Operation, Options, Problem, ProblemCode};

/// Names and values of the query.
fn pairs(uri: &Uri) -> Result<Vec<(String, String)>, Problem> {
    Query::try_from_uri(uri).map(|Query(pairs)| pairs).map_err(|error| {
        Problem::new(ProblemCode::InvalidParameter, format!("the query cannot be read: {error}"))
    })
}

/// The options in the query.
pub(super) fn options(uri: &Uri) -> Result<Options, Problem> {
    Options::from_pairs(pairs(uri)?).map_err(|error| Problem::from(&error))
}

/// The options in the query, and the operation that it names.
pub(super) fn options_and_operation(uri: &Uri) -> Result<(Options, Option<Operation>), Problem> {
    let (operations, rest): (Vec<_>, Vec<_>) =
        pairs(uri)?.into_iter().partition(|(name, _)| name == "operation");
    let options = Options::from_pairs(rest).map_err(|error| Problem::from(&error))?;
    let mut operation = None;
    for (_, word) in operations {
        let named = Operation::from_word(&word).ok_or_else(|| about_operation(&word))?;
        if operation.is_some_and(|other| other != named) {
            return Err(invalid("operation", "`operation` is given twice with different values"));
        }
        operation = Some(named);
    }
    Ok((options, operation))
}

/// The seconds of `?wait=`, the only parameter.
pub(super) fn wait(uri: &Uri) -> Result<Option<u64>, Problem> {
    let mut seconds = None;
    for (name, value) in pairs(uri)? {
        if name != "wait" {
            return Err(unknown(&name, &["wait"]));
        }
        let given = prefer::seconds_of(&value);
        if given.is_none() || (seconds.is_some() && seconds != given) {
            return Err(invalid("wait", "`wait` is one whole number of seconds"));
        }
        seconds = given;
    }
    Ok(seconds)
}

/// The number of `?level=`, the only parameter; 1 without it.
pub(super) fn level(uri: &Uri) -> Result<usize, Problem> {
    let mut level = None;
    for (name, value) in pairs(uri)? {
        if name != "level" {
            return Err(unknown(&name, &["level"]));
        }
        // More than can be counted is more than there are.
        let is_number = !value.is_empty() && value.bytes().all(|b| b.is_ascii_digit());
        let given = is_number.then(|| value.parse().unwrap_or(usize::MAX)).filter(|&level| level > 0);
        if given.is_none() || (level.is_some() && level != given) {
            return Err(invalid("level", "`level` is one whole number from 1"));
        }
        level = given;
    }
    Ok(level.unwrap_or(1))
}

/// Refuses any parameter, for paths that take none.
pub(super) fn none(uri: &Uri) -> Result<(), Problem> {
    match pairs(uri)?.first() {
        Some((name, _)) => Err(unknown(name, &[])),
        None => Ok(()),
    }
}

fn unknown(name: &str, known: &[&'static str]) -> Problem {
    let detail = match known {
        [] => format!("unknown parameter `{name}`; this path takes none"),
        names => format!("unknown parameter `{name}`; this path takes `{}`", names.join("`, `")),
    };
    Problem {
        parameter: Some(name.to_owned()),
        suggestion: known.first().map(|&name| name.into()),
        ..Problem::new(ProblemCode::UnknownParameter, detail)
    }
}

fn invalid(name: &str, detail: &str) -> Problem {
    Problem { parameter: Some(name.to_owned()), ..Problem::new(ProblemCode::InvalidParameter, detail) }
}

fn about_operation(word: &str) -> Problem {
    let expected = Operation::WORDS.join(", ");
    invalid("operation", &format!("`operation` cannot be `{word}`; expected {expected}"))
        .with_allowed(Operation::WORDS.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uri(query: &str) -> Uri {
        format!("/x?{query}").parse().unwrap()
    }

    #[test]
    fn options_and_the_operation_come_from_one_query() {
        let (found, operation) =
            options_and_operation(&uri("operation=repair&samples=3&input=%7B%22job%22:%227%22%7D")).unwrap();
        assert_eq!((operation, found.samples), (Some(Operation::Repair), Some(3)));
        assert_eq!(found.input.unwrap().job, "7");
        let code = |query| options_and_operation(&uri(query)).unwrap_err().code;
        assert_eq!(code("operation=repiar"), ProblemCode::InvalidParameter);
        assert_eq!(code("operation=repair&operation=verify"), ProblemCode::InvalidParameter);
        assert_eq!(options(&uri("operation=repair")).unwrap_err().code, ProblemCode::UnknownParameter);
    }

    #[test]
    fn wait_is_a_number_of_seconds() {
        assert_eq!(wait(&uri("")).unwrap(), None);
        assert_eq!(wait(&uri("wait=7&wait=7")).unwrap(), Some(7));
        for query in ["wait=", "wait=-1", "wait=1.5", "wait=soon", "wait=1&wait=2"] {
            assert_eq!(wait(&uri(query)).unwrap_err().code, ProblemCode::InvalidParameter, "{query}");
        }
        let problem = wait(&uri("wiat=7")).unwrap_err();
        assert_eq!(
            (problem.code, problem.suggestion.as_deref()),
            (ProblemCode::UnknownParameter, Some("wait"))
        );
    }

    #[test]
    fn a_path_without_parameters_takes_none() {
        assert!(none(&"/x".parse().unwrap()).is_ok());
        assert_eq!(none(&uri("a=1")).unwrap_err().code, ProblemCode::UnknownParameter);
    }
}
