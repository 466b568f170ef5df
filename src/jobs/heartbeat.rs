//! What goes on beside a run: its claim is renewed, and the caller's deadline is watched.

use std::future::pending;
use std::sync::Arc;
use std::time::Duration;

use super::live::Live;
use super::meters;
use super::service::Service;
use super::store::{ClaimRef, Ending, JobId, JobRow, StoreError};
use crate::budget::Stopped;
use crate::wire::{JobState, Problem};

/// Renews the claim at a third of its lease, and when another server has done something with the job, until the run is over;
/// stops the run when it is in vain, cancelled, or when the caller's time for it is over.
pub(super) async fn beat(
    service: Arc<Service>,
    claim: ClaimRef,
    time_left: Option<Duration>,
    live: Arc<Live>,
) {
    let deadline = async {
        match time_left {
            Some(left) => tokio::time::sleep(left).await,
            None => pending().await,
        }
        live.stop.pass_deadline();
    };
    let renewals = async {
        loop {
            tokio::select! {
                () = tokio::time::sleep(service.settings.lease / 3) => {}
                () = live.heard.notified() => {}
            }
            match service.store.renew(claim, service.settings.lease).await {
                Ok(false) => {}
                Ok(true) => live.cancel(),
                Err(StoreError::ClaimVoid) => {
                    tracing::warn!(job = %claim.id, epoch = claim.epoch, "the claim of a run is void");
                    return live.make_void();
                }
                // The claim may outlast this; if not, the end of the run is refused.
                Err(error) => tracing::warn!(job = %claim.id, %error, "a claim could not be renewed"),
            }
        }
    };
    tokio::join!(deadline, renewals);
}

/// Ends a queued job when the caller's time for it is over; a running one is ended beside its run.
pub(super) async fn end_overdue(service: Arc<Service>, id: JobId, time_left: Duration) {
    let is_over = tokio::time::sleep(time_left);
    let live = service.live.watch(id);
    let Some(row) = service.row(id).await.ok().filter(|row| !row.state.is_final()) else {
        return service.live.end(id);
    };
    tokio::select! {
        () = live.job.ended.cancelled() => {}
        () = is_over => service.end_queued(&row, JobState::Failed, Problem::from(&Stopped::Deadline)).await,
    }
}

impl Service {
    /// Ends the job if it is still queued.
    async fn end_queued(&self, row: &JobRow, state: JobState, problem: Problem) {
        let ending = Ending::without_files(state, Some(problem));
        match self.store.end_queued(row.id, ending.clone()).await {
            Ok(true) => {
                self.live.end(row.id);
                meters::finished(row.operation, &ending);
            }
            Ok(false) => {}
            Err(error) => tracing::warn!(job = %row.id, %error, "a queued job could not be ended"),
        }
        self.note_load();
    }
}
