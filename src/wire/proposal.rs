//! What `/v1/plan` proposes, and what a repair did.

use serde::Serialize;
use utoipa::ToSchema;

use super::certificate::hex;
use super::plan::PlanStep;
use super::words::{DefectCode, Remedy};
use crate::pipeline;

/// What may be done about each defect of a file, and what was.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Plan {
    /// SHA-256 of the file, in hexadecimal.
    pub input_sha256: String,
    /// For each kind of defect that was found.
    pub findings: Vec<Proposal>,
    /// The steps that made the result; null: none was made. Given back, exactly these run.
    #[schema(required)]
    pub steps: Option<Vec<PlanStep>>,
}

/// What is proposed for the defects of one kind.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Proposal {
    /// The kind.
    pub code: DefectCode,
    /// How many.
    pub count: u64,
    /// What is to be done about all that `elements` do not name.
    pub remedy: Remedy,
    /// What there is to choose from.
    pub choices: Vec<Remedy>,
    /// How sure it is that the maker of the file would want this, from 0 to 1.
    pub confidence: f64,
    /// Why.
    pub reason: &'static str,
    /// One for each witness of the defect, where elements can be chosen one by one.
    pub elements: Vec<ElementProposal>,
}

/// What is proposed for one element.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct ElementProposal {
    /// Place among the witnesses of the defect, from 0.
    pub number: u32,
    /// What is to be done.
    pub remedy: Remedy,
    /// How sure that is, from 0 to 1.
    pub confidence: f64,
}

impl From<&pipeline::Plan> for Plan {
    fn from(inner: &pipeline::Plan) -> Self {
        Self {
            input_sha256: hex(&inner.input_sha256),
            findings: inner.findings.iter().map(Proposal::from).collect(),
            steps: inner.steps.as_ref().map(|steps| steps.iter().map(PlanStep::from).collect()),
        }
    }
}

impl From<&pipeline::Proposal> for Proposal {
    fn from(inner: &pipeline::Proposal) -> Self {
        let element = |element: &pipeline::ElementProposal| ElementProposal {
            number: element.number,
            remedy: element.remedy.into(),
            confidence: element.confidence,
        };
        Self {
            code: inner.code.into(),
            count: inner.count,
            remedy: inner.remedy.into(),
            choices: inner.choices.iter().copied().map(Remedy::from).collect(),
            confidence: inner.confidence,
            reason: inner.reason,
            elements: inner.elements.iter().map(element).collect(),
        }
    }
}
