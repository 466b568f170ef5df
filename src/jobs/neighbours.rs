//! What other servers do with the same rows: jobs that they take in, end or give back.

use std::sync::Arc;
use std::time::Duration;

use super::service::Service;
use super::store::StoreError;

/// Time between two looks. All who wait here wait for the same look, which costs two short questions however many they are.
const LOOK_EVERY: Duration = Duration::from_millis(250);

/// Looks for what others have done until the service stops.
pub(super) async fn look_forever(service: Arc<Service>) {
    loop {
        tokio::select! {
            () = service.stopping.cancelled() => return,
            () = tokio::time::sleep(LOOK_EVERY) => {}
        }
        if let Err(error) = service.look_at_neighbours().await {
            tracing::debug!(%error, "what other servers do is not known");
        }
    }
}

impl Service {
    /// Tells those who wait for a job that another server has ended, and the slots when jobs wait.
    pub(super) async fn look_at_neighbours(&self) -> Result<(), StoreError> {
        let waited_for: Vec<_> = self.live.all().into_iter().map(|(id, _)| id).collect();
        if !waited_for.is_empty() {
            for id in self.store.ended(waited_for).await? {
                self.live.end(id);
            }
        }
        if !self.draining.is_cancelled() && self.store.counts().await?.queued > 0 {
            self.work.notify_waiters();
        }
        Ok(())
    }
}
