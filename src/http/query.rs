//! Query parameters: names and values, none of them unknown.

use axum::extract::Query;
use axum::http::Uri;

use super::agreed::{agreed, agreed_member};
use super::prefer;
use crate::jobs::JobId;
use crate::wire::{
    JobRequest, JobState, LABELS_MAX, Operation, Options, Problem, ProblemCode, label_from_text,
};

/// Names and values of the query.
fn pairs(uri: &Uri) -> Result<Vec<(String, String)>, Problem> {
    Query::try_from_uri(uri).map(|Query(pairs)| pairs).map_err(|error| {
        Problem::new(ProblemCode::InvalidParameter, format!("the query cannot be read: {error}"))
    })
}

/// The options in the query, all of which `operation` takes.
pub(super) fn options(uri: &Uri, operation: Operation) -> Result<Options, Problem> {
    let options = Options::from_pairs(pairs(uri)?)?;
    options.check_taken_by(operation)?;
    Ok(options)
}

/// The job that the query asks for.
pub(super) fn job_request(uri: &Uri) -> Result<JobRequest, Problem> {
    let (own, rest): (Vec<_>, Vec<_>) =
        pairs(uri)?.into_iter().partition(|(name, _)| matches!(name.as_str(), "operation" | "labels"));
    let options = Options::from_pairs(rest).map_err(|error| Problem::from(&error))?;
    let (mut operation, mut labels) = (None, None);
    for (name, value) in own {
        if name == "labels" {
            labels = agreed_member("labels", labels, Some(JobRequest::labels_of_query(&value)?))?;
        } else {
            let named = Operation::from_word(&value).ok_or_else(|| about_operation(&value))?;
            operation = agreed(operation, Some(named))?;
        }
    }
    Ok(JobRequest { operation, labels, options, webhook: None })
}

/// Which page of the list of jobs.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Page {
    /// The last job of the page before.
    pub(super) cursor: Option<JobId>,
    /// Most jobs.
    pub(super) limit: Option<usize>,
    /// State of the jobs.
    pub(super) state: Option<JobState>,
    /// Labels that they all have.
    pub(super) labels: Vec<(String, String)>,
}

/// The page that the query asks for, of at most `limit_max` jobs.
pub(super) fn page(uri: &Uri, limit_max: usize) -> Result<Page, Problem> {
    let mut page = Page::default();
    for (name, value) in pairs(uri)? {
        let taken = match name.as_str() {
            "cursor" => {
                put(&mut page.cursor, value.parse().ok().filter(|id: &JobId| id.to_string() == value))
            }
            "limit" => put(&mut page.limit, whole(&value).filter(|limit| (1..=limit_max).contains(limit))),
            "state" => put(&mut page.state, JobState::from_word(&value)),
            "label" => label_from_text(&value)
                .filter(|_| page.labels.len() < LABELS_MAX)
                .map(|label| page.labels.push(label)),
            _ => return Err(unknown(&name, &["cursor", "limit", "state", "label"])),
        };
        if taken.is_none() {
            let expected = match name.as_str() {
                "cursor" => "the `next` of an earlier page, once".to_owned(),
                "limit" => format!("a whole number from 1 to {limit_max}, once"),
                "state" => format!("one of {}, once", JobState::WORDS.join(", ")),
                _ => format!("NAME:VALUE, at most {LABELS_MAX} times"),
            };
            let problem = invalid(&name, &format!("`{name}` cannot be `{value}`; expected {expected}"));
            let states = if name == "state" { JobState::WORDS } else { &[] };
            return Err(problem.with_allowed(states.iter().copied()));
        }
    }
    Ok(page)
}

/// Takes a value that there is and that no other one stands against.
fn put<T: PartialEq>(place: &mut Option<T>, value: Option<T>) -> Option<()> {
    let value = value.filter(|value| place.as_ref().is_none_or(|other| other == value))?;
    *place = Some(value);
    Some(())
}

/// A number written in digits only.
fn whole(text: &str) -> Option<usize> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
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

/// Which mesh of a job is asked for.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct AskedResult {
    /// The number of its target, from 1.
    pub(super) level: usize,
    /// By a URL of the bucket.
    pub(super) redirect: bool,
}

/// The mesh that `?level=` and `?redirect=` ask for: without them the first one, from here.
pub(super) fn result(uri: &Uri) -> Result<AskedResult, Problem> {
    let (mut level, mut redirect) = (None, None);
    for (name, value) in pairs(uri)? {
        if name == "redirect" {
            if put(&mut redirect, value.parse().ok()).is_none() {
                return Err(invalid("redirect", "`redirect` is one of true and false")
                    .with_allowed(["true", "false"]));
            }
            continue;
        }
        if name != "level" {
            return Err(unknown(&name, &["level", "redirect"]));
        }
        // More than can be counted is more than there are.
        let is_number = !value.is_empty() && value.bytes().all(|b| b.is_ascii_digit());
        let given = is_number.then(|| value.parse().unwrap_or(usize::MAX)).filter(|&level| level > 0);
        if given.is_none() || (level.is_some() && level != given) {
            return Err(invalid("level", "`level` is one whole number from 1"));
        }
        level = given;
    }
    Ok(AskedResult { level: level.unwrap_or(1), redirect: redirect.unwrap_or_default() })
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
    use crate::wire::InputRef;

    fn uri(query: &str) -> Uri {
        format!("/x?{query}").parse().unwrap()
    }

    #[test]
    fn options_and_the_operation_come_from_one_query() {
        let found = job_request(&uri(
            "operation=repair&samples=3&input=%7B%22job%22:%227%22%7D&labels=%7B%22a%22:%22b%22%7D",
        ))
        .unwrap();
        assert_eq!((found.operation, found.options.samples), (Some(Operation::Repair), Some(3)));
        let input = found.options.input.unwrap();
        assert_eq!((input, &*found.labels.unwrap()["a"]), (InputRef::Job("7".to_owned()), "b"));
        let code = |query| job_request(&uri(query)).unwrap_err().code;
        assert_eq!(code("labels=a"), ProblemCode::InvalidParameter);
        assert_eq!(code("labels=%7B%7D&labels=%7B%22a%22:%22b%22%7D"), ProblemCode::InvalidParameter);
        assert_eq!(code("operation=repiar"), ProblemCode::InvalidParameter);
        assert_eq!(code("operation=repair&operation=verify"), ProblemCode::InvalidParameter);
        assert_eq!(
            options(&uri("operation=repair"), Operation::Repair).unwrap_err().code,
            ProblemCode::UnknownParameter
        );
        let walls = |operation| options(&uri("wall_mm=1"), operation).map_err(|problem| problem.code);
        assert_eq!(walls(Operation::Repair).unwrap().wall_mm, Some(1.0));
        assert_eq!(walls(Operation::Verify).unwrap_err(), ProblemCode::UnknownParameter);
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

    #[test]
    fn a_page_is_asked_for_by_cursor_limit_state_and_labels() {
        let page = |text: &str| super::page(&uri(text), 200);
        let id = "0192f0c1-2345-7abc-8def-0123456789ab";
        let asked = page(&format!("cursor={id}&limit=7&state=failed&label=order:17&label=a:b")).unwrap();
        assert_eq!(asked.cursor.unwrap().to_string(), id);
        assert_eq!((asked.limit, asked.state), (Some(7), Some(JobState::Failed)));
        assert_eq!(asked.labels, [("order".into(), "17".into()), ("a".into(), "b".into())]);
        for wrong in
            ["cursor=7", "limit=0", "limit=201", "limit=+1", "state=done", "label=x", "limit=1&limit=2"]
        {
            assert_eq!(page(wrong).unwrap_err().code, ProblemCode::InvalidParameter, "{wrong}");
        }
        assert_eq!(page("offset=3").unwrap_err().code, ProblemCode::UnknownParameter);
        assert_eq!(page("").unwrap(), Page::default());
    }
}
