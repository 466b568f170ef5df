//! Uploads that begin while the queue is nearly full: most of them are refused before they cost anything. What is decided
//! here saves work; whether a job is admitted is decided by the store.

use std::collections::VecDeque;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::settings::JobsSettings;
use super::store::{JobStore, StoreError, Tenant};

/// For how long the length of the queue is taken as it was, unless it is known to have changed: under a flood of requests,
/// asking for it is much of the work.
const RECENT: Duration = Duration::from_millis(10);
/// For how long an upload that is partly there holds a place in the queue before it is a job: one that trickles in keeps
/// nobody else out.
const PLACE_LASTS: Duration = Duration::from_secs(1);

/// Those who come, and what is known about the queue for them.
pub(super) struct Arrivals {
    store: Arc<dyn JobStore>,
    settings: Arc<JobsSettings>,
    known: Mutex<ArrivalCounts>,
}

impl fmt::Debug for Arrivals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Arrivals").field("known", &self.known).finish_non_exhaustive()
    }
}

#[derive(Debug, Default)]
struct ArrivalCounts {
    /// How many jobs waited, and when that was.
    queued: Option<(Instant, usize)>,
    /// When places were taken by uploads that are not jobs yet, the earliest first, and whom they are charged to.
    places: VecDeque<(Instant, Tenant)>,
}

/// The place of an upload that is not a job yet, until it is dropped.
#[derive(Debug)]
pub(super) struct QueuePlace {
    arrivals: Arc<Arrivals>,
    taken_at: Instant,
    tenant: Tenant,
}

impl Drop for QueuePlace {
    fn drop(&mut self) {
        let mut known = self.arrivals.known();
        if let Some(own) = known.places.iter().position(|(at, by)| *at == self.taken_at && *by == self.tenant)
        {
            known.places.remove(own);
        }
    }
}

impl Arrivals {
    pub(super) fn new(store: Arc<dyn JobStore>, settings: Arc<JobsSettings>) -> Arc<Self> {
        Arc::new(Self { store, settings, known: Mutex::default() })
    }

    /// The queue is not as it was.
    pub(super) fn forget(&self) {
        self.known().queued = None;
    }

    fn known(&self) -> MutexGuard<'_, ArrivalCounts> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ArrivalCounts {
    /// Places that count at `now`.
    fn taken(&mut self, now: Instant) -> usize {
        while self.places.front().is_some_and(|&(at, _)| now.duration_since(at) > PLACE_LASTS) {
            self.places.pop_front();
        }
        self.places.len()
    }

    /// Those of one tenant.
    fn taken_by(&self, tenant: &Tenant) -> usize {
        self.places.iter().filter(|(_, by)| by == tenant).count()
    }
}

impl Arrivals {
    /// Refuses when the queue has no room for another upload of this tenant.
    pub(super) async fn check(&self, tenant: &Tenant) -> Result<(), StoreError> {
        self.with_room(tenant, |_, _| ()).await
    }

    /// A place in the queue for an upload of which the first block is there; refuses when there is none.
    pub(super) async fn take_place(self: &Arc<Self>, tenant: &Tenant) -> Result<QueuePlace, StoreError> {
        self.with_room(tenant, |known, now| {
            known.places.push_back((now, tenant.clone()));
            QueuePlace { arrivals: Arc::clone(self), taken_at: now, tenant: tenant.clone() }
        })
        .await
    }

    /// Does what is to be done when there is room in the queue.
    async fn with_room<T>(
        &self,
        tenant: &Tenant,
        then: impl FnOnce(&mut ArrivalCounts, Instant) -> T,
    ) -> Result<T, StoreError> {
        let recent = self.known().queued.filter(|(at, _)| at.elapsed() < RECENT);
        let (at, queued) = match recent {
            Some(recent) => recent,
            None => {
                let counts = self.store.counts().await?;
                (Instant::now(), counts.queued)
            }
        };
        let own = if tenant.is_nobody() || queued >= self.settings.queue_max {
            0
        } else {
            self.store.holding(tenant.clone()).await?.queued as usize
        };
        let now = Instant::now();
        let mut known = self.known();
        known.queued = Some((at, queued));
        let taken = queued + known.taken(now);
        if taken >= self.settings.queue_max {
            return Err(StoreError::QueueFull { queued });
        }
        let own = own + known.taken_by(tenant);
        let limit = self.settings.queue_share(self.settings.queue_max - taken);
        if !tenant.is_nobody() && own >= limit {
            return Err(StoreError::ShareFull { queued: own, limit });
        }
        Ok(then(&mut known, now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_counts_for_a_while_only() {
        let begun = Instant::now();
        let (first, second) = (Tenant::nobody(), Tenant::named("key:shop"));
        let places = [(begun, first.clone()), (begun + PLACE_LASTS, second.clone())].into();
        let mut known = ArrivalCounts { queued: None, places };
        assert_eq!(known.taken(begun + PLACE_LASTS), 2);
        assert_eq!((known.taken_by(&first), known.taken_by(&second)), (1, 1));
        assert_eq!(known.taken(begun + PLACE_LASTS * 3 / 2), 1);
        assert_eq!((known.taken_by(&first), known.taken_by(&second)), (0, 1));
        assert_eq!(known.taken(begun + PLACE_LASTS * 3), 0);
    }
}
