//! The end of the server: nothing new, a grace for what runs; what waits or outlasts the grace stays for the next start.

use std::time::Duration;

use super::handle::Jobs;
use super::problems::draining;
use crate::wire::Problem;

/// Time that stopped jobs get to return when the server ends. The engine needs 50 ms; more means that it hangs.
const STOP_PATIENCE: Duration = Duration::from_secs(5);

/// The same when the server is to end at once.
const ABANDON_PATIENCE: Duration = Duration::from_secs(1);

impl Jobs {
    /// The service takes no more jobs.
    pub fn is_draining(&self) -> bool {
        self.0.draining.is_cancelled()
    }

    /// Returns when the service is to take no more jobs: what a request that is under way is then answered with.
    pub async fn closed(&self) -> Problem {
        self.0.draining.cancelled().await;
        draining()
    }

    /// Takes no more jobs, gives running ones `drain_grace`, stops the rest and queues them again. Queued jobs stay
    /// queued for the next start. Returns when no job runs, or a few seconds after the last one was told to stop.
    pub async fn drain(&self) {
        let service = &self.0;
        service.draining.cancel();
        if tokio::time::timeout(service.settings.drain_grace, service.slots.wait()).await.is_err() {
            for (_, live) in service.live.all() {
                live.drain();
            }
            if tokio::time::timeout(STOP_PATIENCE, service.slots.wait()).await.is_err() {
                tracing::error!("a job did not end when told to");
            }
        }
        service.executor.close();
        service.stopping.cancel();
    }

    /// As [`drain`](Self::drain) without a grace, for a server that is told to end at once.
    pub async fn abandon(&self) {
        let service = &self.0;
        service.draining.cancel();
        for (_, live) in service.live.all() {
            live.drain();
        }
        if tokio::time::timeout(ABANDON_PATIENCE, service.slots.wait()).await.is_err() {
            tracing::warn!("jobs that run are queued again by the next start");
        }
        service.executor.close();
        service.stopping.cancel();
    }
}
