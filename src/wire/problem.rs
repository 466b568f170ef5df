//! Everything that can go wrong, as RFC 9457 problems with stable codes.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::words::words;
use crate::analysis::DefectCode;
use crate::budget::Stopped;
use crate::formats::{Place, ReadError, ReadErrorKind};
use crate::pipeline::{ELEMENTS_MAX, Failure, PlanMismatch, Refusal};
use crate::wire;

words! {
    /// Stable code of a problem. `/v1/errors` explains each.
    ProblemCode {
        /// A parameter has a value that is not allowed.
        InvalidParameter = "invalid-parameter",
        /// The body ends early or is cut into parts wrongly.
        BodyIncomplete = "body-incomplete",
        /// There is no such parameter, or this operation does not take it.
        UnknownParameter = "unknown-parameter",
        /// No valid key.
        Unauthenticated = "unauthenticated",
        /// Not allowed for this caller.
        Forbidden = "forbidden",
        /// There is no such thing.
        NotFound = "not-found",
        /// It was there and is kept no longer.
        Expired = "expired",
        /// The path does not take this method.
        MethodNotAllowed = "method-not-allowed",
        /// None of the accepted media types can be given.
        NotAcceptable = "not-acceptable",
        /// The file has no such bytes.
        RangeNotSatisfiable = "range-not-satisfiable",
        /// What is there is not what the request is about.
        PreconditionFailed = "precondition-failed",
        /// The request's head is over the limit.
        HeadTooLarge = "head-too-large",
        /// The body's media type is not read here.
        UnsupportedMediaType = "unsupported-media-type",
        /// The body did not come in time.
        UploadTimeout = "upload-timeout",
        /// The job is still queued or running.
        JobNotFinished = "job-not-finished",
        /// The plan is not for this mesh.
        PlanMismatch = "plan-mismatch",
        /// The key belongs to another request.
        IdempotencyKeyReused = "idempotency-key-reused",
        /// The body is over the limit.
        BodyTooLarge = "body-too-large",
        /// The mesh is over a limit.
        MeshTooLarge = "mesh-too-large",
        /// The file breaks the rules of its format.
        MeshUnparseable = "mesh-unparseable",
        /// There is no mesh in the file.
        MeshEmpty = "mesh-empty",
        /// A coordinate is NaN or infinite.
        MeshNonFinite = "mesh-non-finite",
        /// The file ends too early.
        MeshTruncated = "mesh-truncated",
        /// The archive breaks a safety rule.
        ArchiveUnsafe = "archive-unsafe",
        /// No result meets what was required.
        NotRepairable = "not-repairable",
        /// The mesh takes more work than a file of its size may.
        OverBudget = "over-budget",
        /// The webhook is not one that the server calls.
        WebhookRefused = "webhook-refused",
        /// Too many requests.
        RateLimited = "rate-limited",
        /// The queue has no room.
        QueueFull = "queue-full",
        /// The job's time is over.
        EngineTimeout = "engine-timeout",
        /// The job needs more memory than it may have.
        EngineOutOfMemory = "engine-out-of-memory",
        /// The engine failed on this job.
        EngineCrashed = "engine-crashed",
        /// The process that ran the job went away.
        WorkerLost = "worker-lost",
        /// The job was cancelled.
        Cancelled = "cancelled",
        /// The server is shutting down.
        Draining = "draining",
        /// The job store does not answer.
        StoreUnavailable = "store-unavailable",
        /// There is no room for more data.
        StorageFull = "storage-full",
        /// A fault of the server.
        Internal = "internal",
    }
}

impl ProblemCode {
    /// HTTP status, title, and what it means and what to do.
    fn facts(self) -> (u16, &'static str, &'static str) {
        match self {
            Self::InvalidParameter => (
                400,
                "Invalid parameter",
                "`parameter` has a value that is not allowed; `allowed` or `detail` says which are.",
            ),
            Self::UnknownParameter => (
                400,
                "Unknown parameter",
                "There is no `parameter` of this name here; `suggestion` is the nearest one there is, `detail` says who takes it.",
            ),
            Self::BodyIncomplete => (
                400,
                "Body incomplete",
                "The body ended early, or its parts are not divided as its `Content-Type` says.",
            ),
            Self::Unauthenticated => {
                (401, "Unauthenticated", "Send a valid key as `Authorization: Bearer KEY`.")
            }
            Self::Forbidden => (403, "Forbidden", "The server does not answer this caller, host or origin."),
            Self::NotFound => {
                (404, "Not found", "There is no such path, job or file. A deleted job is not found either.")
            }
            Self::Expired => {
                (410, "Expired", "The job's report and result are kept no longer. Send the mesh again.")
            }
            Self::MethodNotAllowed => {
                (405, "Method not allowed", "The path exists; `Allow` lists its methods.")
            }
            Self::NotAcceptable => {
                (406, "Not acceptable", "None of the media types in `Accept` can be given here.")
            }
            Self::RangeNotSatisfiable => (
                416,
                "Range not satisfiable",
                "The file has no bytes in `Range`; `Content-Range` says how long it is.",
            ),
            Self::PreconditionFailed => (
                412,
                "Precondition failed",
                "The job or file has changed: its `ETag` is none of those in `If-Match`. Ask for it again.",
            ),
            Self::HeadTooLarge => {
                (431, "Head too large", "Path, query and header fields are over `limit` bytes.")
            }
            Self::UnsupportedMediaType => (
                415,
                "Unsupported media type",
                "The body's `Content-Type` is not read here; `/v1/formats` lists those of meshes.",
            ),
            Self::UploadTimeout => {
                (408, "Upload timeout", "The body paused for longer than the limit. Send it again.")
            }
            Self::JobNotFinished => {
                (409, "Job not finished", "The job is queued or running. Wait with `?wait=` and ask again.")
            }
            Self::PlanMismatch => (
                409,
                "Plan mismatch",
                "The plan was made for another file, or names a defect, element or remedy that this mesh does not have. \
                 Ask `/v1/plan` for a plan of this mesh.",
            ),
            Self::IdempotencyKeyReused => (
                422,
                "Idempotency key reused",
                "The key was used with another request. Use a new key for each request.",
            ),
            Self::BodyTooLarge => (413, "Body too large", "The upload is over `limit` bytes."),
            Self::MeshTooLarge => {
                (413, "Mesh too large", "A count of the mesh, or the work it takes, is over the named limit.")
            }
            Self::MeshUnparseable => (
                422,
                "Mesh unparseable",
                "The file breaks the rules of its format at `line` or `byte`, where `expected` should stand.",
            ),
            Self::MeshEmpty => (422, "Mesh empty", "The file has no bytes, or no element of a mesh."),
            Self::MeshNonFinite => {
                (422, "Mesh non-finite", "A coordinate is NaN or infinite and cannot be written.")
            }
            Self::MeshTruncated => {
                (422, "Mesh truncated", "The file ends before what it announces. Export it again.")
            }
            Self::ArchiveUnsafe => {
                (422, "Archive unsafe", "The archive breaks a limit on entries, size or ratio.")
            }
            Self::NotRepairable => (
                422,
                "Not repairable",
                "No result meets `require`; `report` names the first violation that remains.",
            ),
            Self::OverBudget => (
                422,
                "Over budget",
                "No answer was found in the work that a file of this size may take: parts of the mesh are so many in one place, or \
                 so far apart in scale, that a decision is too dear. `limit` is the bound in units of work.",
            ),
            Self::WebhookRefused => (
                422,
                "Webhook refused",
                "The server sends no webhooks, or not to this URL, or the secret is missing or malformed; `detail` says \
                 which.",
            ),
            Self::RateLimited => {
                (429, "Rate limited", "Too many requests. Wait as long as `Retry-After` says.")
            }
            Self::QueueFull => {
                (429, "Queue full", "As many jobs wait as may. Wait as long as `Retry-After` says.")
            }
            Self::EngineTimeout => (
                504,
                "Engine timeout",
                "The job did not end within its time, given by the caller or the server.",
            ),
            Self::EngineOutOfMemory => {
                (413, "Engine out of memory", "The job needs more memory than `limit` bytes.")
            }
            Self::EngineCrashed => (
                500,
                "Engine crashed",
                "A fault of the engine on this mesh. The server goes on; please report it.",
            ),
            Self::WorkerLost => {
                (503, "Worker lost", "The process that ran the job went away. Send the job again.")
            }
            Self::Cancelled => (409, "Cancelled", "The job was cancelled and has no result."),
            Self::Draining => {
                (503, "Draining", "The server is shutting down. Send the job again, here or elsewhere.")
            }
            Self::StoreUnavailable => (503, "Store unavailable", "The job store does not answer. Try again."),
            Self::StorageFull => (507, "Storage full", "There is no room for more data. Try again later."),
            Self::Internal => (500, "Internal error", "A fault of the server; its log names the request id."),
        }
    }

    /// HTTP status.
    pub fn status(self) -> u16 {
        self.facts().0
    }

    /// A few words for people.
    pub fn title(self) -> &'static str {
        self.facts().1
    }

    /// What it means and what to do.
    pub fn explanation(self) -> &'static str {
        self.facts().2
    }

    /// Reference that tells problems of this code from others.
    pub fn type_uri(self) -> String {
        format!("/v1/errors#{}", self.word())
    }
}

/// One row of `/v1/errors`.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct ErrorInfo {
    /// Stable code.
    pub code: ProblemCode,
    /// Value of `type` in problems.
    #[serde(rename = "type")]
    pub type_uri: String,
    /// HTTP status.
    pub status: u16,
    /// A few words for people.
    pub title: &'static str,
    /// What it means and what to do.
    pub explanation: &'static str,
}

/// Every problem there is: the answer of `/v1/errors`.
pub fn errors() -> Vec<ErrorInfo> {
    let row = |&code: &ProblemCode| ErrorInfo {
        code,
        type_uri: code.type_uri(),
        status: code.status(),
        title: code.title(),
        explanation: code.explanation(),
    };
    ProblemCode::ALL.iter().map(row).collect()
}

/// A problem (RFC 9457), sent as `application/problem+json`. Members that do not apply are absent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Problem {
    /// Reference that tells problems of one code from others.
    #[serde(rename = "type")]
    pub type_uri: String,
    /// A few words for people.
    pub title: Cow<'static, str>,
    /// HTTP status.
    pub status: u16,
    /// Stable code.
    pub code: ProblemCode,
    /// What happened, in a sentence.
    pub detail: String,
    /// Reference to the job or request it happened to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<String>,
    /// Name of the limit that was met, as `/v1/limits` calls it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit_name: Option<Cow<'static, str>>,
    /// The limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<u64>,
    /// The value that is over the limit, as far as it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub actual: Option<u64>,
    /// Line of the file, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
    /// Byte of the file, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub byte: Option<u64>,
    /// What should have stood there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected: Option<String>,
    /// The parameter at fault.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameter: Option<String>,
    /// The values it may have.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub allowed: Vec<Cow<'static, str>>,
    /// The nearest name or value there is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub suggestion: Option<Cow<'static, str>>,
    /// Seconds after which to try again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub retry_after_s: Option<u64>,
    /// The report of a refused repair.
    #[schema(value_type = Option<super::report::Report>)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub report: Option<serde_json::Value>,
}

impl Problem {
    /// A problem of this code; `detail` is a sentence about this case.
    pub fn new(code: ProblemCode, detail: impl Into<String>) -> Self {
        Self {
            type_uri: code.type_uri(),
            title: code.title().into(),
            status: code.status(),
            code,
            detail: detail.into(),
            instance: None,
            limit_name: None,
            limit: None,
            actual: None,
            line: None,
            byte: None,
            expected: None,
            parameter: None,
            allowed: Vec::new(),
            suggestion: None,
            retry_after_s: None,
            report: None,
        }
    }

    /// The same problem with the limit that was met.
    #[must_use]
    pub fn with_limit(self, name: &'static str, limit: u64, actual: Option<u64>) -> Self {
        Self { limit_name: Some(name.into()), limit: Some(limit), actual, ..self }
    }

    /// The same problem with the values that would have been taken.
    #[must_use]
    pub fn with_allowed(self, allowed: impl IntoIterator<Item = &'static str>) -> Self {
        Self { allowed: allowed.into_iter().map(Cow::Borrowed).collect(), ..self }
    }

    /// The same problem with the job or request it happened to.
    #[must_use]
    pub fn with_instance(self, instance: impl Into<String>) -> Self {
        Self { instance: Some(instance.into()), ..self }
    }

    fn at(self, place: Place) -> Self {
        match place {
            Place::Whole => self,
            Place::Line(line) => Self { line: Some(line), ..self },
            Place::Byte(byte) => Self { byte: Some(byte), ..self },
        }
    }
}

impl From<&Failure> for Problem {
    fn from(failure: &Failure) -> Self {
        match failure {
            Failure::Unreadable(error) => Self::from(error),
            Failure::Stopped(stopped) => Self::from(stopped),
            &Failure::OverBudget { units } => {
                Self { limit: Some(units), ..Self::new(ProblemCode::OverBudget, failure.to_string()) }
            }
            Failure::PlanMismatch(mismatch) => Self::from(mismatch),
            Failure::InMesh { failure: inner, .. } => Self {
                parameter: Some("mesh".to_owned()),
                detail: failure.to_string(),
                ..Self::from(&**inner)
            },
            Failure::MeshCount { .. } => Self {
                parameter: Some("mesh".to_owned()),
                ..Self::new(ProblemCode::InvalidParameter, failure.to_string())
            },
            Failure::NotApplicable { option, reason } => Self {
                parameter: Some((*option).to_owned()),
                ..Self::new(ProblemCode::InvalidParameter, reason.clone())
            },
            &Failure::NoSuchHole { holes, .. } => Self {
                parameter: Some("holes".to_owned()),
                expected: Some(match holes {
                    0 => "no hole: the file has none".to_owned(),
                    _ => format!("numbers from 0 to {}", holes.min(ELEMENTS_MAX as u64) - 1),
                }),
                ..Self::new(ProblemCode::InvalidParameter, failure.to_string())
            },
        }
    }
}

impl wire::Operation {
    /// That it takes so many meshes.
    ///
    /// # Errors
    /// `invalid-parameter`.
    pub fn check_mesh_count(self, count: usize) -> Result<(), Problem> {
        let operation = crate::pipeline::Operation::from(self);
        match operation.meshes().contains(&count) {
            true => Ok(()),
            false => Err(Problem::from(&Failure::MeshCount { operation, count })),
        }
    }
}

impl From<&PlanMismatch> for Problem {
    fn from(mismatch: &PlanMismatch) -> Self {
        let code = |code: DefectCode| wire::DefectCode::from(code).word();
        let detail = match *mismatch {
            PlanMismatch::OtherFile => "the plan was made for a file with other bytes".to_owned(),
            PlanMismatch::NoSuchDefect(defect) => format!("the mesh has no defect `{}`", code(defect)),
            PlanMismatch::NoSuchElement(defect, number) => {
                format!("`{}` has no element {number} to be chosen", code(defect))
            }
            PlanMismatch::NotFirst(step) => format!("the step `{step}` can only be the first"),
            PlanMismatch::NoSuchRemedy(defect, remedy) => {
                format!("`{}` is no remedy of `{}`", wire::Remedy::from(remedy).word(), code(defect))
            }
        };
        Self { parameter: Some("plan".to_owned()), ..Self::new(ProblemCode::PlanMismatch, detail) }
    }
}

impl From<&ReadError> for Problem {
    fn from(error: &ReadError) -> Self {
        let of = |code| Self::new(code, error.to_string());
        let problem = match &error.kind {
            ReadErrorKind::Empty => of(ProblemCode::MeshEmpty),
            ReadErrorKind::UnknownFormat
            | ReadErrorKind::Foreign { .. }
            | ReadErrorKind::Unparseable { .. } => of(ProblemCode::MeshUnparseable),
            ReadErrorKind::Truncated => of(ProblemCode::MeshTruncated),
            ReadErrorKind::TooLarge { limit_name, limit, actual, .. } => {
                of(ProblemCode::MeshTooLarge).with_limit(limit_name, *limit, Some(*actual))
            }
            ReadErrorKind::Stopped(stopped) => Self::from(stopped),
        };
        let expected = Some(error.expected.clone()).filter(|text| !text.is_empty());
        Self { expected, ..problem.at(error.place) }
    }
}

impl From<&Stopped> for Problem {
    fn from(stopped: &Stopped) -> Self {
        let of = |code| Self::new(code, stopped.to_string());
        match *stopped {
            Stopped::Cancelled => of(ProblemCode::Cancelled),
            Stopped::Deadline => of(ProblemCode::EngineTimeout),
            Stopped::Work { limit } => {
                of(ProblemCode::MeshTooLarge).with_limit("engine_work_max", limit, None)
            }
            Stopped::Memory { limit, wanted } => {
                of(ProblemCode::EngineOutOfMemory).with_limit("engine_bytes_max", limit, Some(wanted))
            }
        }
    }
}

impl From<&Refusal> for Problem {
    fn from(refusal: &Refusal) -> Self {
        let code = match refusal {
            Refusal::NotRepresentable { reason } if is_non_finite(reason) => ProblemCode::MeshNonFinite,
            Refusal::OverBudget { .. } => ProblemCode::OverBudget,
            _ => ProblemCode::NotRepairable,
        };
        let limit = if let &Refusal::OverBudget { units } = refusal { Some(units) } else { None };
        Self { limit, ..Self::new(code, super::verdict::Reason::from(refusal).message) }
    }
}

fn is_non_finite(error: &crate::formats::WriteError) -> bool {
    matches!(error, crate::formats::WriteError::NotRepresentable { value, .. } if !value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::WriteError;

    fn read_error(kind: ReadErrorKind, place: Place) -> ReadError {
        ReadError { kind, place, expected: "a number".to_owned() }
    }

    #[test]
    fn a_broken_file_is_told_with_its_place_and_what_was_expected() {
        let error = read_error(ReadErrorKind::Unparseable { found: "x".into() }, Place::Line(12));
        let problem = serde_json::to_value(Problem::from(&error)).unwrap();
        assert_eq!(problem["code"], "mesh-unparseable");
        assert_eq!(problem["status"], 422);
        assert_eq!(problem["type"], "/v1/errors#mesh-unparseable");
        assert_eq!((&problem["line"], &problem["expected"]), (&12.into(), &"a number".into()));
        assert!(problem.get("byte").is_none(), "members that do not apply are absent");
        let problem = Problem::from(&read_error(ReadErrorKind::Truncated, Place::Byte(84)));
        assert_eq!((problem.code, problem.byte), (ProblemCode::MeshTruncated, Some(84)));
    }

    #[test]
    fn a_limit_is_named_with_the_value_over_it() {
        let kind =
            ReadErrorKind::TooLarge { what: "triangles", limit_name: "triangles_max", limit: 5, actual: 9 };
        let problem = Problem::from(&Failure::Unreadable(read_error(kind, Place::Whole)));
        assert_eq!(problem.code, ProblemCode::MeshTooLarge);
        assert_eq!(
            (problem.limit_name.as_deref(), problem.limit, problem.actual),
            (Some("triangles_max"), Some(5), Some(9))
        );
        let problem = Problem::from(&Stopped::Memory { limit: 1, wanted: 2 });
        assert_eq!(problem.code, ProblemCode::EngineOutOfMemory);
        assert_eq!((problem.limit, problem.actual), (Some(1), Some(2)));
    }

    #[test]
    fn each_way_to_stop_has_its_code() {
        assert_eq!(Problem::from(&Stopped::Cancelled).code, ProblemCode::Cancelled);
        assert_eq!(Problem::from(&Stopped::Deadline).code, ProblemCode::EngineTimeout);
        assert_eq!(Problem::from(&Stopped::Work { limit: 1 }).limit_name.as_deref(), Some("engine_work_max"));
    }

    #[test]
    fn a_coordinate_that_is_not_finite_has_a_code_of_its_own() {
        let refusal = |value| Refusal::NotRepresentable {
            reason: WriteError::NotRepresentable { vertex: 3, value, encoding: "stl-binary" },
        };
        assert_eq!(Problem::from(&refusal(f64::NAN)).code, ProblemCode::MeshNonFinite);
        assert_eq!(Problem::from(&refusal(1e300)).code, ProblemCode::NotRepairable);
    }

    #[test]
    fn a_problem_is_read_back_as_it_was_written() {
        let plain = Problem::new(ProblemCode::Cancelled, "the job was cancelled");
        let full = Problem {
            line: Some(3),
            byte: Some(u64::MAX),
            expected: Some("a number".into()),
            parameter: Some("units".into()),
            suggestion: Some("mm".into()),
            retry_after_s: Some(7),
            report: Some(serde_json::json!({"verdict": {"volume": 0.1 + 0.2}})),
            ..plain
                .clone()
                .with_limit("queue_max", 5, Some(6))
                .with_allowed(["mm", "cm"])
                .with_instance("/v1/jobs/x")
        };
        for problem in [plain, full] {
            let text = serde_json::to_string(&problem).unwrap();
            assert_eq!(serde_json::from_str::<Problem>(&text).unwrap(), problem);
        }
    }

    #[test]
    fn every_code_is_explained_and_is_an_error() {
        for row in errors() {
            assert!((400..600).contains(&row.status), "{}", row.code);
            assert!(row.title.len() > 5 && row.explanation.len() > 20, "{}", row.code);
        }
    }
}
