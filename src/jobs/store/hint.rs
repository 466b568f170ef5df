//! What one process tells the others of a change that it has made to rows they share.

use tokio::sync::{broadcast, watch};

use super::id::JobId;

/// A change, told after it was made. It says where to look, and no more: what has become of the job is in its row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Hint {
    /// A job waits for a slot.
    Work,
    /// The state of this job has changed, or its run is to stop.
    Job(JobId),
    /// Hints may have been missed: everything is to be looked at.
    Missed,
}

/// The hints of other processes, from the time that these were asked for. Any of them may be missed, so who follows them
/// also looks from time to time, and often while none are [heard](Self::are_heard).
#[derive(Debug)]
pub struct Hints {
    told: broadcast::Receiver<Hint>,
    are_heard: watch::Receiver<bool>,
}

impl Hints {
    pub(in crate::jobs) fn new(told: broadcast::Receiver<Hint>, are_heard: watch::Receiver<bool>) -> Self {
        Self { told, are_heard }
    }

    /// Whether hints come at all now.
    pub fn are_heard(&self) -> bool {
        *self.are_heard.borrow()
    }

    /// The next one; it does not return when no more can come.
    pub async fn next(&mut self) -> Hint {
        match self.told.recv().await {
            Ok(hint) => hint,
            Err(broadcast::error::RecvError::Lagged(_)) => Hint::Missed,
            Err(broadcast::error::RecvError::Closed) => std::future::pending().await,
        }
    }

    /// The next one, if there is one already.
    pub fn next_if_any(&mut self) -> Option<Hint> {
        match self.told.try_recv() {
            Ok(hint) => Some(hint),
            Err(broadcast::error::TryRecvError::Lagged(_)) => Some(Hint::Missed),
            Err(broadcast::error::TryRecvError::Empty | broadcast::error::TryRecvError::Closed) => None,
        }
    }
}
