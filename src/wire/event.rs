//! What happens to a job, as the stream of its events tells it.

use jiff::Timestamp;
use serde::Serialize;
use utoipa::ToSchema;

use super::job::JobState;
use super::words::{Stage, words};

words! {
    /// What a pass does.
    Phase {
        /// It begins.
        Begin = "begin",
        /// It ends.
        End = "end",
    }
}

/// Data of an event `state`: the job has come into another state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, ToSchema)]
pub struct StateEvent {
    /// The state.
    pub state: JobState,
    /// When.
    #[schema(value_type = String, format = DateTime)]
    pub at: Timestamp,
}

/// Data of an event `stage`: a pass of the job's run begins or ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, ToSchema)]
pub struct StageEvent {
    /// The pass.
    pub stage: Stage,
    /// What it does.
    pub phase: Phase,
    /// How far the run is, from 0 to 1: it grows with every pass and with the work of each.
    pub fraction: f64,
}
