//! Jobs whose executor is lost, and all that an earlier service left in the stores.

use std::sync::Arc;

use super::heartbeat::end_overdue;
use super::meters;
use super::problems::store_problem;
use super::service::Service;
use super::store::{AfterLoss, Leases, StoreError};
use crate::wire::{Problem, ProblemCode};

impl Service {
    /// What an earlier service of this name left: its runs are lost, its files are named by rows or go.
    pub(super) async fn take_over(self: &Arc<Self>) -> Result<(), Problem> {
        for leases in [Leases::OfWorker(self.worker.clone()), Leases::Expired] {
            self.recover(leases).await.map_err(|error| store_problem(&error))?;
        }
        self.collect_orphans().await?;
        self.seal_old_secrets().await?;
        for (id, left) in self.store.deadlines().await.map_err(|error| store_problem(&error))? {
            tokio::spawn(end_overdue(Arc::clone(self), id, left));
        }
        Ok(())
    }

    /// Secrets that an older program stored as they are.
    async fn seal_old_secrets(&self) -> Result<(), Problem> {
        let Some(vault) = self.vault.clone() else { return Ok(()) };
        let seal = Box::new(move |secret: &str| vault.seal_if_plain(secret).ok().flatten());
        let sealed = self.store.seal_secrets(seal).await.map_err(|error| store_problem(&error))?;
        if sealed > 0 {
            tracing::info!(sealed, "webhook secrets in the store are sealed now");
        }
        Ok(())
    }

    /// Queues jobs again whose executor is lost, or ends them when that was once too often.
    pub(super) async fn recover(&self, leases: Leases) -> Result<(), StoreError> {
        let problem = Problem::new(ProblemCode::WorkerLost, "the process that ran the job went away");
        for (id, after) in self.store.recover(leases, problem, self.settings.attempts_max).await? {
            tracing::warn!(job = %id, ?after, "the executor of a job is lost");
            let row = self.store.get(id).await;
            if let Some(live) = self.live.get(id) {
                live.make_void();
            }
            if let Ok(row) = row {
                meters::lost(row.operation, 1);
                if let Some(ending) = &row.ending {
                    meters::finished(row.operation, ending);
                }
            }
            match after {
                AfterLoss::Queued => self.live.requeue(id),
                AfterLoss::Ended => self.live.end(id),
            }
        }
        self.work.notify_waiters();
        Ok(())
    }
}
