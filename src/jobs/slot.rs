//! A slot: owns one job at a time, from claim to finish.

use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use super::attempt::attempt;
use super::clock::StageClock;
use super::drain::draining;
use super::live::Live;
use super::product::{Content, Made, Product};
use super::service::{Service, now};
use super::store::{BlobRef, Finish, JobRow, ResultRef, StoreError};
use crate::wire::{JobState, Problem, ProblemCode, Progress};

/// Pause before a store that did not answer is asked again.
const STORE_PAUSE: Duration = Duration::from_secs(1);

/// Runs jobs until the service drains.
pub(super) async fn serve(service: Arc<Service>) {
    while !service.draining.is_cancelled() {
        // Listening begins before the look into the queue, so that no job is missed in between.
        let mut work = pin!(service.work.notified());
        work.as_mut().enable();
        match service.store.claim(now()).await {
            Ok(Some(row)) => run(&service, row).await,
            Ok(None) => {
                tokio::select! {
                    () = work => {}
                    () = service.draining.cancelled() => {}
                }
            }
            Err(error) => {
                tracing::error!(%error, "no job could be claimed");
                tokio::time::sleep(STORE_PAUSE).await;
            }
        }
    }
}

async fn run(service: &Arc<Service>, row: JobRow) {
    // Deleted since it was claimed.
    let Some(live) = service.live.get(row.id) else { return };
    let clock = StageClock::start(row.operation);
    // A job is claimed once in this process, so the place is empty.
    let _ = live.clock.set(clock.clone());
    service.tell_load().await;
    let ended = attempt(service, &row, &live, &clock).await;
    service.note_run_time(&clock);
    let finish = conclude(service, &row, &live, &clock, ended).await;
    let (id, operation) = (row.id, row.operation);
    tracing::info!(
        job = %id, %operation, state = %finish.state, ms = clock.timing_ms().total,
        problem = finish.problem.as_ref().map(|problem| problem.detail.as_str()), "job ended"
    );
    commit(service, &row, finish).await;
    service.live.end(id);
    service.tell_load().await;
}

/// Turns the end of a run into what is kept of it; files are kept here.
async fn conclude(
    service: &Service,
    row: &JobRow,
    live: &Live,
    clock: &StageClock,
    ended: Result<Product<Content>, Problem>,
) -> Finish {
    let kept = match ended {
        Ok(product) => keep_files(service, row, product).await,
        Err(problem) => Err(problem),
    };
    kept.unwrap_or_else(|problem| {
        let (state, problem) = match problem.code {
            ProblemCode::Cancelled if live.is_drained.get().is_some() => (JobState::Failed, draining()),
            ProblemCode::Cancelled => (JobState::Cancelled, problem),
            _ => (JobState::Failed, problem),
        };
        Finish {
            timing_ms: Some(clock.timing_ms()),
            progress: clock.progress(),
            ..service.finish(row, state, Some(problem))
        }
    })
}

async fn keep_files(service: &Service, row: &JobRow, product: Product<Content>) -> Result<Finish, Problem> {
    let Product { outcome, problem, timing_ms, report, result, levels } = product;
    let mut kept = Vec::with_capacity(1 + levels.len());
    let has_result = result.is_some();
    for Made { content, encoding } in result.into_iter().chain(levels) {
        let blob = match content {
            Some(content) => service.keep(content).await,
            None => Ok(row.input.clone()),
        };
        match blob {
            Ok(blob) => kept.push(ResultRef { blob, encoding }),
            Err(problem) => {
                service.remove_own(row, kept.iter().map(|result| &result.blob));
                return Err(problem);
            }
        }
    }
    let report = match service.keep(report).await {
        Ok(report) => report,
        Err(problem) => {
            service.remove_own(row, kept.iter().map(|result| &result.blob));
            return Err(problem);
        }
    };
    let levels = kept.split_off(usize::from(has_result).min(kept.len()));
    let state = if problem.is_some() { JobState::Failed } else { JobState::Succeeded };
    Ok(Finish {
        timing_ms: Some(timing_ms),
        progress: Progress { stage: None, fraction: 1.0 },
        outcome,
        report: Some(report),
        result: kept.pop(),
        levels,
        ..service.finish(row, state, problem)
    })
}

/// Makes the end known, unless the job was deleted meanwhile: then its files go.
async fn commit(service: &Service, row: &JobRow, finish: Finish) {
    let written: Vec<BlobRef> =
        finish.report.iter().chain(finish.results().map(|result| &result.blob)).cloned().collect();
    loop {
        match service.store.finish(row.id, row.epoch, finish.clone()).await {
            Ok(()) => return super::meters::finished(row.operation, &finish),
            Err(StoreError::Unavailable(error)) => {
                tracing::error!(job = %row.id, error, "the end of a job could not be stored");
                tokio::time::sleep(STORE_PAUSE).await;
            }
            Err(_) => return service.remove_own(row, written.iter()),
        }
    }
}
