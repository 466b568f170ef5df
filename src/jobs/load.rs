//! How busy the service is, and the metrics that say so.

use std::sync::Arc;
use std::time::Duration;

use super::handle::Jobs;
use super::meters;
use super::service::Service;
use super::store::JobCounts;

/// Shortest time between two looks at the load.
const PAUSE: Duration = Duration::from_millis(100);

/// How busy the service is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Load {
    /// Jobs that wait.
    pub queued: usize,
    /// Jobs that run.
    pub running: usize,
    /// Bytes on disk.
    pub data_bytes: u64,
}

impl Jobs {
    /// How busy the service is; nothing queued and nothing running when the store does not answer.
    pub async fn load(&self) -> Load {
        let service = &self.0;
        let counts = service.tell_load().await.unwrap_or_default();
        Load { queued: counts.queued, running: counts.running, data_bytes: service.spool.bytes() }
    }
}

impl Service {
    /// Tells the metrics recorder how busy the service is; `None`: the store does not answer.
    async fn tell_load(&self) -> Option<JobCounts> {
        let counts = self.store.counts().await.ok()?;
        meters::load(counts, self.spool.bytes());
        Some(counts)
    }
}

/// Tells the load whenever it has changed, beside those who change it: they have no use for it.
pub(super) async fn tell_forever(service: Arc<Service>) {
    let tell = async {
        loop {
            service.load_changed.notified().await;
            service.tell_load().await;
            tokio::time::sleep(PAUSE).await;
        }
    };
    tokio::select! {
        () = tell => {}
        () = service.draining.cancelled() => {}
    }
}
