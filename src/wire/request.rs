//! The request that makes a job, as JSON.

use serde::Deserialize as _;
use serde_json::Value;
use utoipa::openapi::schema::{ObjectBuilder, Schema};
use utoipa::openapi::{Ref, RefOr};
use utoipa::{PartialSchema, ToSchema};

use super::labels::{Labels, about_labels, labels_from_json, labels_schema};
use super::option_schema::options_object;
use super::options::{Options, nearest};
use super::problem::Problem;
use super::problem_code::ProblemCode;
use super::webhook::WebhookRequest;
use super::words::Operation;

/// What to do, with options: `{"operation":"repair","units":"mm"}`. Options may also stand in a member `params`.
#[derive(Debug, Clone, PartialEq)]
pub struct JobRequest {
    /// What to do; `None`: another part of the request says it.
    pub operation: Option<Operation>,
    /// What to write on the job; `None`: another part of the request may say it.
    pub labels: Option<Labels>,
    /// How.
    pub options: Options,
    /// Whom to tell of the end.
    pub webhook: Option<WebhookRequest>,
}

impl JobRequest {
    /// Reads the request of `/v1/jobs`.
    ///
    /// # Errors
    /// A problem with code `invalid-parameter` or `unknown-parameter`.
    pub fn from_json(text: &[u8]) -> Result<Self, Problem> {
        read(text)
    }

    /// Reads the `params` of a path that names the operation itself; `operation` may be repeated there, not changed.
    ///
    /// # Errors
    /// As [`from_json`](Self::from_json).
    pub fn params_from_json(text: &[u8], operation: Operation) -> Result<Options, Problem> {
        let request = read(text)?;
        match request.operation {
            Some(named) if named != operation => Err(about_operation(
                &format!("the path means `{operation}`, `operation` says `{named}`"),
                None,
            )),
            _ if request.labels.is_some() => Err(Problem {
                parameter: Some("labels".to_owned()),
                ..Problem::new(ProblemCode::UnknownParameter, "`labels` belong to `/v1/jobs`")
            }),
            _ if request.webhook.is_some() => Err(Problem {
                parameter: Some("webhook".to_owned()),
                ..Problem::new(ProblemCode::UnknownParameter, "a `webhook` belongs to `/v1/jobs`")
            }),
            _ => Ok(request.options),
        }
    }

    /// The labels of a query, as JSON text.
    ///
    /// # Errors
    /// `invalid-parameter`.
    pub fn labels_of_query(text: &str) -> Result<Labels, Problem> {
        labels_from_json(&serde_json::from_str(text).map_err(|_| about_labels())?)
    }
}

fn read(text: &[u8]) -> Result<JobRequest, Problem> {
    let members = object(text)?;
    let mut operation = None;
    let mut labels = None;
    let mut options = Options::default();
    let mut webhook = None;
    for (name, value) in &members {
        match (name.as_str(), value) {
            ("operation", value) => operation = Some(read_operation(value)?),
            ("webhook", value) => webhook = Some(read_webhook(value)?),
            ("labels", value) => labels = Some(labels_from_json(value)?),
            ("params", Value::Object(inner)) => {
                for (name, value) in inner {
                    options.set_json(name, value)?;
                }
            }
            ("params", _) => {
                return Err(Problem {
                    parameter: Some("params".to_owned()),
                    ..Problem::new(ProblemCode::InvalidParameter, "`params` must be an object")
                });
            }
            _ => options.set_json(name, value)?,
        }
    }
    Ok(JobRequest { operation, labels, options, webhook })
}

fn read_webhook(value: &Value) -> Result<WebhookRequest, Problem> {
    // The error itself may repeat a value, which may be a secret.
    let detail = "`webhook` is an object with `url` and perhaps `secret`, both texts";
    WebhookRequest::deserialize(value).map_err(|_| Problem {
        parameter: Some("webhook".to_owned()),
        ..Problem::new(ProblemCode::InvalidParameter, detail)
    })
}

fn object(text: &[u8]) -> Result<serde_json::Map<String, Value>, Problem> {
    match serde_json::from_slice(text) {
        Ok(Value::Object(members)) => Ok(members),
        Ok(_) => Err(Problem::new(ProblemCode::InvalidParameter, "expected a JSON object")),
        Err(error) => Err(Problem {
            line: Some(error.line() as u64),
            expected: Some("a JSON object".to_owned()),
            ..Problem::new(ProblemCode::InvalidParameter, format!("the JSON cannot be read: {error}"))
        }),
    }
}

fn read_operation(value: &Value) -> Result<Operation, Problem> {
    let word = value.as_str().unwrap_or_default();
    Operation::from_word(word).ok_or_else(|| {
        let suggestion = nearest(word, Operation::WORDS.iter().copied());
        about_operation(&format!("`operation` cannot be {value}"), suggestion)
    })
}

fn about_operation(detail: &str, suggestion: Option<&'static str>) -> Problem {
    Problem {
        parameter: Some("operation".to_owned()),
        suggestion: suggestion.map(Into::into),
        ..Problem::new(ProblemCode::InvalidParameter, detail).with_allowed(Operation::WORDS.iter().copied())
    }
}

impl JobRequest {
    /// The schema of a request, which comes beside a mesh.
    pub fn object() -> ObjectBuilder {
        options_object(None)
            .description(Some("What to do, with options, which may also stand together in `params`."))
            .property("operation", Ref::from_schema_name(Operation::name()))
            .property("webhook", WebhookRequest::schema())
            .property("labels", labels_schema())
            .property("params", Ref::from_schema_name(Options::name()))
    }
}

impl PartialSchema for JobRequest {
    fn schema() -> RefOr<Schema> {
        RefOr::T(Schema::Object(Self::object().build()))
    }
}

impl ToSchema for JobRequest {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{InputRef, Units};

    #[test]
    fn options_stand_beside_the_operation_or_in_params() {
        let flat =
            JobRequest::from_json(br#"{"operation":"repair","units":"cm","input":{"job":"7"}}"#).unwrap();
        let nested =
            JobRequest::from_json(br#"{"params":{"units":"cm"},"operation":"repair","input":{"job":"7"}}"#);
        assert_eq!(flat, nested.unwrap());
        assert_eq!(flat.options.units, Some(Units::Centimetre));
        assert_eq!(flat.options.input, Some(InputRef::Job("7".into())));
    }

    #[test]
    fn an_unknown_operation_is_refused() {
        for text in [&br#"{"operation":"repiar"}"#[..], br#"{"operation":7}"#] {
            let problem = JobRequest::from_json(text).unwrap_err();
            assert_eq!(problem.code, ProblemCode::InvalidParameter);
            assert_eq!(problem.parameter.as_deref(), Some("operation"));
        }
        let problem = JobRequest::from_json(br#"{"operation":"repiar"}"#).unwrap_err();
        assert_eq!(problem.suggestion.as_deref(), Some("repair"));
    }

    #[test]
    fn params_may_repeat_the_operation_of_the_path_but_not_change_it() {
        assert!(JobRequest::params_from_json(br#"{"operation":"repair"}"#, Operation::Repair).is_ok());
        assert!(JobRequest::params_from_json(br#"{}"#, Operation::Repair).is_ok());
        assert!(JobRequest::params_from_json(br#"{"operation":"verify"}"#, Operation::Repair).is_err());
        assert!(JobRequest::params_from_json(br#"{"labels":{}}"#, Operation::Repair).is_err());
    }

    #[test]
    fn labels_stand_beside_the_operation() {
        let request = JobRequest::from_json(br#"{"operation":"repair","labels":{"order":"17"}}"#).unwrap();
        assert_eq!(request.labels.unwrap()["order"], "17");
        assert!(JobRequest::from_json(br#"{"labels":["order"]}"#).is_err());
        assert!(JobRequest::from_json(br#"{"params":{"labels":{}}}"#).is_err());
    }

    #[test]
    fn broken_json_is_told_with_its_line() {
        let problem = JobRequest::from_json(b"{\n\"operation\":}").unwrap_err();
        assert_eq!(problem.line, Some(2));
        assert!(JobRequest::from_json(b"[]").is_err());
    }
}
