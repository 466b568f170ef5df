//! A job as the service shows it.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::labels::Labels;
use super::problem::Problem;
use super::report::TimingMs;
use super::words::{Fidelity, Operation, Outcome, PictureFormat, Stage, words};

words! {
    /// Where a job stands.
    JobState {
        /// Accepted, waiting for a slot.
        Queued = "queued",
        /// In a slot.
        Running = "running",
        /// Done; report and result are there.
        Succeeded = "succeeded",
        /// Done without what was asked; `problem` says why.
        Failed = "failed",
        /// Ended by the caller.
        Cancelled = "cancelled",
        /// Its report and result are gone.
        Expired = "expired",
    }
}

impl JobState {
    /// The job will not change any more, except that it expires.
    pub fn is_final(self) -> bool {
        !matches!(self, Self::Queued | Self::Running)
    }
}

/// How far a running job is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Progress {
    /// The pass it is in, or was in last; null before the first one.
    #[schema(required)]
    pub stage: Option<Stage>,
    /// How far it is, from 0 to 1: it grows with every pass and with the work of each, and never gets less.
    pub fraction: f64,
}

/// Where to go from a job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Links {
    /// The job.
    #[serde(rename = "self")]
    pub this: String,
    /// Its report; null while there is none.
    #[schema(required)]
    pub report: Option<String>,
    /// Its mesh; null while there is none.
    #[schema(required)]
    pub result: Option<String>,
    /// Its picture, a PNG, or a GLB where `picture_format` asked for that; null while there is none.
    #[schema(required)]
    pub thumbnail: Option<String>,
}

impl Links {
    /// The links of the job `id`.
    pub fn new(id: &str, has_report: bool, has_result: bool, picture: Option<PictureFormat>) -> Self {
        let this = format!("/v1/jobs/{id}");
        let report = has_report.then(|| format!("{this}/report"));
        let result = has_result.then(|| format!("{this}/result"));
        let thumbnail = picture.map(|format| match format {
            PictureFormat::Png => format!("{this}/thumbnail.png"),
            PictureFormat::Glb => format!("{this}/thumbnail.glb"),
        });
        Self { this, report, result, thumbnail }
    }
}

/// A job.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Job {
    /// Its id, a UUID.
    pub id: String,
    /// Where it stands.
    pub state: JobState,
    /// What it does.
    pub operation: Operation,
    /// When it was accepted.
    #[schema(value_type = String, format = DateTime)]
    pub created_at: Timestamp,
    /// When it came into a slot; null before that.
    #[schema(value_type = Option<String>, format = DateTime, required)]
    pub started_at: Option<Timestamp>,
    /// When it ended; null before that.
    #[schema(value_type = Option<String>, format = DateTime, required)]
    pub finished_at: Option<Timestamp>,
    /// When its report and result will go, at the latest; null before it ends.
    #[schema(value_type = Option<String>, format = DateTime, required)]
    pub expires_at: Option<Timestamp>,
    /// How far it is.
    pub progress: Progress,
    /// What became of the file; null unless the job succeeded or was refused.
    #[schema(required)]
    pub outcome: Option<Outcome>,
    /// How true the result is to the file; null without a result.
    #[schema(required)]
    pub fidelity: Option<Fidelity>,
    /// Why it failed; null unless it did.
    #[schema(required)]
    pub problem: Option<Problem>,
    /// Time of each pass; null before it ends.
    #[schema(required)]
    pub timing_ms: Option<TimingMs>,
    /// How many of its runs were lost with the process that made them.
    pub attempts: u32,
    /// What the caller has written on it, by name.
    #[schema(value_type = BTreeMap<String, String>)]
    pub labels: Labels,
    /// The result is that of an earlier job with the same bytes, options and engine.
    pub cached: bool,
    /// Where to go from here.
    pub links: Links,
}

/// One page of the list of jobs.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct JobList {
    /// Jobs, the latest first.
    pub jobs: Vec<Job>,
    /// `cursor` of the next page; null: this is the last one.
    #[schema(required)]
    pub next: Option<String>,
}
