//! Everything that can go wrong, as RFC 9457 problems with stable codes.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::problem_code::ProblemCode;
use crate::analysis::DefectCode;
use crate::budget::Stopped;
use crate::formats::{Place, ReadError, ReadErrorKind};
use crate::pipeline::{ELEMENTS_MAX, Failure, PlanMismatch, Refusal, Remedy, Units, remedies_of};
use crate::wire;

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
                let word = |remedy: Remedy| wire::Remedy::from(remedy).word();
                let known: Vec<&str> = remedies_of(defect).iter().map(|&remedy| word(remedy)).collect();
                let (remedy, defect) = (word(remedy), code(defect));
                format!("`{remedy}` is no remedy of `{defect}`; these are: {}", known.join(", "))
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

impl Problem {
    /// Why there is no result; `units`: that of the result.
    pub fn of_refusal(refusal: &Refusal, units: Units) -> Self {
        let code = match refusal {
            Refusal::NotRepresentable { reason } if is_non_finite(reason) => ProblemCode::MeshNonFinite,
            Refusal::OverBudget { .. } => ProblemCode::OverBudget,
            _ => ProblemCode::NotRepairable,
        };
        let limit = if let &Refusal::OverBudget { units } = refusal { Some(units) } else { None };
        Self { limit, ..Self::new(code, super::verdict::Reason::of(refusal, units).message) }
    }
}

fn is_non_finite(error: &crate::formats::WriteError) -> bool {
    matches!(error, crate::formats::WriteError::NotRepresentable { value, .. } if !value.is_finite())
}

#[cfg(test)]
mod tests;
