//! Why a run ends without a report.

use super::operation::Operation;
use super::remedies::PlanMismatch;
use crate::budget::Stopped;
use crate::formats::{ReadError, ReadErrorKind};

/// A run without a report.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The input could not be read.
    #[error("{0}")]
    Unreadable(ReadError),
    /// The run was stopped.
    #[error("{0}")]
    Stopped(#[from] Stopped),
    /// What was asked takes more work than a file of this size may.
    #[error("the mesh takes more than the {units} units of work that a file of its size may take")]
    OverBudget {
        /// The bound, in units of work.
        units: u64,
    },
    /// The plan is not for this file.
    #[error("the plan is not for this file")]
    PlanMismatch(PlanMismatch),
    /// Something is wrong with one of several files.
    #[error("mesh {number}: {failure}")]
    InMesh {
        /// Its place among the files, from 1.
        number: usize,
        /// What.
        failure: Box<Failure>,
    },
    /// More or fewer files than the operation takes.
    #[error("{} takes {}, not {count}", .operation.name(), .operation.meshes_taken())]
    MeshCount {
        /// What was asked.
        operation: Operation,
        /// Number of files.
        count: usize,
    },
    /// An option does not go with this file.
    #[error("{reason}")]
    NotApplicable {
        /// Name of the option.
        option: &'static str,
        /// Why, in a sentence.
        reason: String,
    },
    /// A hole was chosen that the file does not have.
    #[error("the file has no hole {number}: it has {holes}, numbered from 0")]
    NoSuchHole {
        /// The number.
        number: u32,
        /// How many there are.
        holes: u64,
    },
}

impl Failure {
    /// The same about the file of this number, from 1, among several; that the run was stopped or takes too much is about none.
    pub(super) fn in_mesh(self, number: usize) -> Self {
        match self {
            Self::Stopped(_) | Self::OverBudget { .. } => self,
            failure => Self::InMesh { number, failure: Box::new(failure) },
        }
    }
}

impl From<PlanMismatch> for Failure {
    fn from(mismatch: PlanMismatch) -> Self {
        Self::PlanMismatch(mismatch)
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        match error.kind {
            ReadErrorKind::Stopped(stopped) => Self::Stopped(stopped),
            _ => Self::Unreadable(error),
        }
    }
}
