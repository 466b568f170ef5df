//! What other servers do with the same rows: jobs that they take in, end, give back or are asked to stop.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::Duration;

use super::service::Service;
use super::store::{Hint, Hints, JobId, StoreError};

/// Time between two looks while other servers are not heard. All who wait here wait for the same look, which costs two short
/// questions however many they are.
const LOOK_EVERY_DEAF: Duration = Duration::from_millis(250);

/// Follows what others do until the service stops: as they tell it, and by a look from time to time.
pub(super) async fn follow_forever(service: Arc<Service>) {
    let mut hints = service.store.hints();
    loop {
        let are_heard = hints.as_ref().is_some_and(Hints::are_heard);
        let pause = service.settings.look_every;
        let pause = if are_heard { pause } else { pause.min(LOOK_EVERY_DEAF) };
        let hint = tokio::select! {
            () = service.stopping.cancelled() => return,
            () = tokio::time::sleep(pause) => Hint::Missed,
            hint = next(&mut hints) => hint,
        };
        // Those that came with it are one look.
        let more = std::iter::from_fn(|| hints.as_mut().and_then(Hints::next_if_any));
        let told: HashSet<Hint> = std::iter::once(hint).chain(more).collect();
        let looked = if told.contains(&Hint::Missed) {
            service.look_at_neighbours().await
        } else {
            service.follow(&told).await
        };
        if let Err(error) = looked {
            tracing::debug!(%error, "what other servers do is not known");
        }
    }
}

async fn next(hints: &mut Option<Hints>) -> Hint {
    match hints {
        Some(hints) => hints.next().await,
        None => std::future::pending().await,
    }
}

impl Service {
    /// Tells those who wait for a job that another server has ended, and the slots when jobs wait.
    pub(super) async fn look_at_neighbours(&self) -> Result<(), StoreError> {
        self.end_those_that_have(self.live.all().into_iter().map(|(id, _)| id).collect()).await?;
        if !self.draining.is_cancelled() && self.store.counts().await?.queued > 0 {
            self.work.notify_waiters();
        }
        Ok(())
    }

    /// The same for what others have told.
    async fn follow(&self, told: &HashSet<Hint>) -> Result<(), StoreError> {
        if told.contains(&Hint::Work) {
            self.work.notify_waiters();
        }
        let of_job = |hint: &Hint| {
            if let Hint::Job(id) = hint { self.live.get(*id).map(|live| (*id, live)) } else { None }
        };
        let known: Vec<_> = told.iter().filter_map(of_job).collect();
        self.end_those_that_have(known.iter().map(|(id, _)| *id).collect()).await?;
        for (_, live) in known {
            live.hear();
        }
        Ok(())
    }

    async fn end_those_that_have(&self, waited_for: Vec<JobId>) -> Result<(), StoreError> {
        if !waited_for.is_empty() {
            for id in self.store.ended(waited_for).await? {
                self.live.end(id);
            }
        }
        Ok(())
    }
}
