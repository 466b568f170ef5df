//! The last step of a run: what came of it is made known, by the claim it ran under.

use std::sync::Arc;
use std::time::Duration;

use super::live::Live;
use super::meters;
use super::service::Service;
use super::spool::Written;
use super::store::{AfterLoss, Ending, JobRow, StoreError, StoreFuture};
use super::trace::TraceParent;
use crate::wire::{Outcome, Problem};

/// Pause before a store that did not answer is asked again.
pub(super) const STORE_PAUSE: Duration = Duration::from_secs(1);

/// What is to become of a job after a run.
pub(super) enum Conclusion {
    /// It has ended; the files are its own.
    End(Box<Ending>, Vec<Written>),
    /// The server ends: it is queued again.
    Release,
    /// It is larger than was thought, in time or in memory: it is queued again among the large ones.
    Demote {
        /// In memory.
        is_outgrown: bool,
    },
    /// Its executor is lost: it is queued again, or ends when that was once too often.
    Lose(Box<Problem>),
    /// Nothing: the run was in vain.
    Void,
}

/// Makes the conclusion known. Files that nobody is to know of go.
pub(super) async fn settle(service: &Service, row: &JobRow, live: &Arc<Live>, conclusion: Conclusion) {
    let (id, claim) = (row.id, row.claim());
    let after = match conclusion {
        Conclusion::End(ending, written) => {
            match persist(row, || service.store.finish(claim, Ending::clone(&ending))).await {
                Ok(()) => {
                    written.into_iter().for_each(Written::named);
                    note(row, &ending);
                    meters::finished(row.operation, &ending);
                    Some(AfterLoss::Ended)
                }
                Err(Void { was_silent }) => {
                    if was_silent {
                        // The end that was not answered may have been stored, and name them; otherwise they are found as
                        // orphans.
                        written.into_iter().for_each(Written::named);
                    }
                    None
                }
            }
        }
        Conclusion::Demote { is_outgrown } => {
            tracing::info!(job = %id, is_outgrown, "a job is larger than was thought");
            persist(row, || service.store.demote(claim, is_outgrown)).await.ok()
        }
        Conclusion::Release => persist(row, || service.store.release(claim)).await.ok(),
        Conclusion::Lose(problem) => {
            meters::lost(row.operation, 1);
            let attempts_max = service.settings.attempts_max;
            persist(row, || service.store.lose(claim, Problem::clone(&problem), attempts_max)).await.ok()
        }
        Conclusion::Void => None,
    };
    match after {
        Some(AfterLoss::Ended) => service.live.end(id),
        Some(AfterLoss::Queued) => {
            tracing::info!(job = %id, epoch = claim.epoch, "job queued again");
            service.live.requeue(id);
            service.work.notify_waiters();
        }
        None => service.live.forget(id, live),
    }
}

/// One line for a job. It names no file and repeats nothing of its content, which a problem's detail may.
fn note(row: &JobRow, ending: &Ending) {
    let waited = row.started_at.map(|at| at.duration_since(row.created_at).as_secs_f64() * 1e3);
    tracing::info!(
        job = %row.id,
        owner = row.owner,
        operation = %row.operation,
        state = %ending.state,
        outcome = ending.outcome.map(Outcome::word),
        problem = ending.problem.as_ref().map(|problem| problem.code.word()),
        queued_ms = waited,
        ms = ending.timing_ms.map(|timing| timing.total),
        bytes_in = row.input.bytes,
        bytes_out = ending.result.as_ref().map(|result| result.blob.bytes),
        epoch = row.epoch,
        trace = row.trace.as_ref().map(TraceParent::trace_id),
        "job ended"
    );
}

/// The claim is void.
struct Void {
    /// The store was asked before and did not answer: perhaps it did what it was asked, which ended the claim.
    was_silent: bool,
}

/// Asks the store until it answers.
async fn persist<'s, T>(row: &JobRow, ask: impl Fn() -> StoreFuture<'s, T>) -> Result<T, Void> {
    let mut was_silent = false;
    loop {
        match ask().await {
            Ok(answer) => return Ok(answer),
            Err(error @ (StoreError::Unavailable(_) | StoreError::Full(_))) => {
                was_silent |= matches!(error, StoreError::Unavailable(_));
                tracing::error!(job = %row.id, %error, "the end of a run could not be stored");
                tokio::time::sleep(STORE_PAUSE).await;
            }
            Err(error) => {
                tracing::warn!(job = %row.id, epoch = row.epoch, %error, "a run was in vain");
                return Err(Void { was_silent });
            }
        }
    }
}
