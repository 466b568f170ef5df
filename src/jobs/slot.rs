//! A slot: owns one job at a time, from claim to finish.

use std::pin::pin;
use std::sync::Arc;

use tokio_util::task::AbortOnDropHandle;
use tracing::{Instrument as _, Span};

use super::clock::StageClock;
use super::heartbeat::beat;
use super::live::Live;
use super::product::{Content, MadeMesh, RunProduct};
use super::service::Service;
use super::settle::{Conclusion, STORE_PAUSE, settle};
use super::spool::Written;
use super::store::{ClaimRequest, Ending, JobRow, Lane, ResultRef};
use crate::wire::{JobState, Problem, ProblemCode, Progress};

/// Which jobs a slot takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SlotKind {
    /// Any.
    General,
    /// Small ones that somebody waits for.
    Interactive,
}

impl SlotKind {
    /// The lane that it looks at first. Where small jobs have slots of their own, the others look at large ones first,
    /// so that neither kind waits for ever behind the other.
    fn lane(self, has_interactive: bool) -> Lane {
        match self {
            Self::General if has_interactive => Lane::Bulk,
            Self::General | Self::Interactive => Lane::Interactive,
        }
    }
}

/// Runs jobs until the service drains.
pub(super) async fn serve(service: Arc<Service>, kind: SlotKind) {
    while !service.draining.is_cancelled() {
        // Listening begins before the look into the queue, so that no job is missed in between.
        let mut work = pin!(service.work.notified());
        work.as_mut().enable();
        let request = ClaimRequest {
            worker: service.worker.clone(),
            lease: service.settings.lease,
            prefer: kind.lane(service.settings.interactive_slots > 0),
            is_only: kind == SlotKind::Interactive,
            share: service.settings.slots_share(match kind {
                SlotKind::General => service.settings.slots,
                SlotKind::Interactive => service.settings.interactive_slots,
            }),
            // A server knows its own slots, not those of all; a number that somebody has set is for all together.
            is_share_of_worker: service.settings.owner_slots_max.is_none(),
        };
        match service.store.claim(request).await {
            Ok(Some(row)) => {
                let span = run_span(&row);
                run(&service, row, kind).instrument(span).await;
            }
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

/// The span of a run. With the feature `otel` it continues the trace of the job's request.
fn run_span(row: &JobRow) -> Span {
    let span = tracing::info_span!("job", id = %row.id, operation = row.operation.word());
    #[cfg(feature = "otel")]
    if let Some(parent) = &row.trace {
        use opentelemetry::propagation::TextMapPropagator as _;
        use tracing_opentelemetry::OpenTelemetrySpanExt as _;

        let carrier = std::collections::HashMap::from([("traceparent".to_owned(), parent.to_string())]);
        let parent = opentelemetry_sdk::propagation::TraceContextPropagator::new().extract(&carrier);
        // It fails when the span has begun already, which it has not.
        let _ = span.set_parent(parent);
    }
    span
}

async fn run(service: &Arc<Service>, row: JobRow, kind: SlotKind) {
    let clock = StageClock::start(row.operation);
    let live = service.live.begin(row.claim(), clock.clone());
    let heart = beat(Arc::clone(service), row.claim(), row.time_left, Arc::clone(&live));
    let heart = AbortOnDropHandle::new(tokio::spawn(heart));
    service.note_load();
    let room = service.capacity.room_for(&row, &live, &service.spool).await;
    let bytes_max = room.as_ref().map_or(service.settings.engine_bytes_max, |room| room.bytes);
    let ended = match service.check_upload(&row).await {
        Ok(()) => {
            in_time(service, &row, kind, &live, service.executor.run(&row, &live, &clock, bytes_max)).await
        }
        Err(problem) => Err(problem),
    };
    service.pace.note_run(clock.timing_ms().total as u64);
    let conclusion = match &ended {
        Err(problem) if is_too_small(service, problem, bytes_max) => Conclusion::Demote { is_outgrown: true },
        _ => conclude(service, &row, &live, &clock, ended).await,
    };
    settle(service, &row, &live, conclusion).await;
    drop(room);
    drop(heart);
    service.note_load();
}

/// The run, which is ended when it takes longer than its slot is for.
async fn in_time<T>(
    service: &Service,
    row: &JobRow,
    kind: SlotKind,
    live: &Live,
    run: impl Future<Output = T>,
) -> T {
    tokio::pin!(run);
    if kind == SlotKind::Interactive {
        let patience = service.settings.interactive_patience(row.input.bytes);
        match tokio::time::timeout(patience, &mut run).await {
            Ok(ended) => return ended,
            Err(_) => live.outgrow(),
        }
    }
    run.await
}

/// Whether a run ended because it was given less memory than a job may have.
fn is_too_small(service: &Service, problem: &Problem, bytes_max: u64) -> bool {
    problem.code == ProblemCode::EngineOutOfMemory && bytes_max < service.settings.engine_bytes_max
}

/// Turns the end of a run into what is kept of it; files are written here.
async fn conclude(
    service: &Service,
    row: &JobRow,
    live: &Live,
    clock: &StageClock,
    ended: Result<RunProduct<Content>, Problem>,
) -> Conclusion {
    let kept = match ended {
        Ok(product) => keep_files(service, row, product).await,
        Err(problem) => Err(problem),
    };
    let problem = match kept {
        Ok((ending, written)) => return Conclusion::End(Box::new(ending), written),
        Err(problem) => problem,
    };
    let end = |state, problem| {
        let partly = Ending {
            timing_ms: Some(clock.timing_ms()),
            progress: clock.progress(),
            ..Ending::without_files(state, Some(problem))
        };
        Conclusion::End(Box::new(partly), Vec::new())
    };
    match problem.code {
        ProblemCode::Cancelled if live.is_cancelled() => end(JobState::Cancelled, problem),
        ProblemCode::Cancelled if live.is_void.get().is_some() => Conclusion::Void,
        ProblemCode::Cancelled if live.is_drained.get().is_some() => Conclusion::Release,
        ProblemCode::Cancelled if live.is_outgrown.get().is_some() => {
            Conclusion::Demote { is_outgrown: false }
        }
        ProblemCode::Cancelled => end(JobState::Cancelled, problem),
        // The run is lost with its executor, or for want of its files, not ended by what it was given.
        ProblemCode::EngineCrashed | ProblemCode::WorkerLost | ProblemCode::StoreUnavailable => {
            Conclusion::Lose(Box::new(problem))
        }
        _ => end(JobState::Failed, problem),
    }
}

async fn keep_files(
    service: &Service,
    row: &JobRow,
    product: RunProduct<Content>,
) -> Result<(Ending, Vec<Written>), Problem> {
    let RunProduct { outcome, fidelity, problem, timing_ms, report, result, levels, picture } = product;
    // Should one file fail, those before it go with this list.
    let mut written = Vec::new();
    let has_result = result.is_some();
    let mut results = Vec::new();
    for (number, MadeMesh { content, encoding }) in result.into_iter().chain(levels).enumerate() {
        let blob = match content {
            Some(content) => service.keep(row, format!("mesh-{number}"), content, &mut written).await?,
            None => row.input.clone(),
        };
        results.push(ResultRef { blob, encoding });
    }
    let report = service.keep(row, "report.json".to_owned(), report, &mut written).await?;
    let picture = match picture {
        Some(content) => Some(service.keep(row, "thumbnail.png".to_owned(), content, &mut written).await?),
        None => None,
    };
    let levels = results.split_off(usize::from(has_result).min(results.len()));
    let state = if problem.is_some() { JobState::Failed } else { JobState::Succeeded };
    let ending = Ending {
        timing_ms: Some(timing_ms),
        progress: Progress { stage: None, fraction: 1.0 },
        outcome,
        fidelity,
        report: Some(report),
        result: results.pop(),
        levels,
        picture,
        ..Ending::without_files(state, problem)
    };
    Ok((ending, written))
}
