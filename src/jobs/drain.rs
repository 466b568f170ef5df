//! The end of the server: nothing new, a grace for what runs, then the stop flag.

use std::time::Duration;

use super::service::Jobs;
use crate::wire::{JobState, Problem, ProblemCode};

/// Time that stopped jobs get to return when the server ends. The engine needs 50 ms; more means that it hangs.
const STOP_PATIENCE: Duration = Duration::from_secs(5);

impl Jobs {
    /// The service takes no more jobs.
    pub fn is_draining(&self) -> bool {
        self.0.draining.is_cancelled()
    }

    /// Takes no more jobs, ends queued ones with `draining`, gives running ones `drain_grace` and ends the rest.
    /// Returns when all have ended, or a few seconds after the last one was told to.
    pub async fn drain(&self) {
        let service = &self.0;
        service.draining.cancel();
        for (id, _) in service.live.all() {
            if let Ok(row) = service.store.get(id).await {
                service.end_queued(&row, JobState::Failed, draining()).await;
            }
        }
        if tokio::time::timeout(service.settings.drain_grace, service.slots.wait()).await.is_ok() {
            return;
        }
        for (_, live) in service.live.all() {
            // Told twice, the first word stays.
            let _ = live.is_drained.set(());
            live.stop.cancel();
        }
        if tokio::time::timeout(STOP_PATIENCE, service.slots.wait()).await.is_err() {
            tracing::error!("a job did not end when told to");
        }
    }
}

/// The problem of a job that the server's end cuts off.
pub(super) fn draining() -> Problem {
    Problem::new(ProblemCode::Draining, "the server is shutting down")
}
