//! What goes on beside a run: its claim is renewed, and the caller's deadline is watched.

use std::future::pending;
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;

use super::live::Live;
use super::service::Service;
use super::store::{ClaimRef, JobId, StoreError};
use super::wall;
use crate::budget::Stopped;
use crate::wire::{JobState, Problem};

/// Renews the claim at a third of its lease until the run is over; stops the run when it is in vain, cancelled, or when
/// the caller's time for it is over.
pub(super) async fn beat(
    service: Arc<Service>,
    claim: ClaimRef,
    cancel_at: Option<Timestamp>,
    live: Arc<Live>,
) {
    let deadline = async {
        match cancel_at {
            Some(at) => tokio::time::sleep(time_until(at)).await,
            None => pending().await,
        }
        live.stop.pass_deadline();
    };
    let renewals = async {
        loop {
            tokio::time::sleep(service.settings.lease / 3).await;
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
pub(super) async fn end_overdue(service: Arc<Service>, id: JobId, at: Timestamp) {
    let live = service.live.watch(id);
    let Some(row) = service.row(id).await.ok().filter(|row| !row.state.is_final()) else {
        return service.live.end(id);
    };
    if tokio::time::timeout(time_until(at), live.job.ended.cancelled()).await.is_err() {
        service.end_queued(&row, JobState::Failed, Problem::from(&Stopped::Deadline)).await;
    }
}

fn time_until(at: Timestamp) -> Duration {
    Duration::try_from(at.duration_since(wall::now())).unwrap_or(Duration::ZERO)
}
