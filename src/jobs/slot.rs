//! A slot: owns one job at a time, from claim to finish.

use std::fs::File;
use std::io::Read;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use tokio::task::JoinError;

use super::clock::StageClock;
use super::drain::draining;
use super::live::Live;
use super::service::{Service, now};
use super::store::{BlobRef, Finish, JobRow, ResultRef, StoreError};
use super::upload::disk_problem;
use crate::budget::{Budget, Stopped};
use crate::par;
use crate::pipeline::{self, Answer, Failure, Outcome};
use crate::wire::{self, JobState, Problem, ProblemCode, Progress};

/// The function that runs a job's bytes: [`pipeline::run`], or another one in tests.
pub type Engine = Arc<
    dyn Fn(pipeline::Operation, &[u8], &pipeline::Options, &Budget) -> Result<Answer, Failure> + Send + Sync,
>;

/// Pause before a store that did not answer is asked again.
const STORE_PAUSE: Duration = Duration::from_secs(1);

/// How a run ended.
enum Ended {
    Answered(Box<Answer>),
    Failed(Failure),
    InputLost(std::io::Error),
    Crashed(JoinError),
}

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
    let ended = attempt(service, &row, &live, clock.clone()).await;
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

/// Runs the engine on the blocking pool and ends it when its time is over.
async fn attempt(service: &Arc<Service>, row: &JobRow, live: &Live, clock: StageClock) -> Ended {
    let path = service.spool.path(&row.input.key);
    let material_path = row.material.as_ref().map(|material| service.spool.path(&material.key));
    let (bytes, operation) = (row.input.bytes, row.operation.into());
    let mut options = row.options.to_engine(service.settings.read_limits);
    let settings = &service.settings;
    let budget = Budget::new(live.stop.clone(), settings.engine_work_max, settings.engine_bytes_max)
        .observed_by(clock.observer());
    let (engine, threads) = (Arc::clone(&service.engine), settings.engine_threads);
    let mut task = tokio::task::spawn_blocking(move || {
        let run = move || {
            let (mut content, _charge) = match budget.vec(bytes as usize) {
                Ok(room) => room,
                Err(stopped) => return Ended::Failed(stopped.into()),
            };
            if let Err(error) = File::open(&path).and_then(|mut file| file.read_to_end(&mut content)) {
                return Ended::InputLost(error);
            }
            match material_path.map(std::fs::read).transpose() {
                Ok(material) => options.material = material,
                Err(error) => return Ended::InputLost(error),
            }
            match engine(operation, &content, &options, &budget) {
                Ok(answer) => Ended::Answered(Box::new(answer)),
                Err(failure) => Ended::Failed(failure),
            }
        };
        par::with_threads(threads, run)
    });
    let joined = tokio::select! {
        joined = &mut task => joined,
        () = tokio::time::sleep(settings.deadline_max) => {
            live.stop.pass_deadline();
            task.await
        }
    };
    joined.unwrap_or_else(Ended::Crashed)
}

/// Turns the end of a run into what is kept of it; files are written here.
async fn conclude(service: &Service, row: &JobRow, live: &Live, clock: &StageClock, ended: Ended) -> Finish {
    let timing = clock.timing_ms();
    let partly = |state, problem: Problem| Finish {
        timing_ms: Some(timing),
        progress: clock.progress(),
        ..service.finish(row, state, Some(problem))
    };
    match ended {
        Ended::Answered(answer) => match keep_files(service, row, *answer, timing).await {
            Ok(finish) => finish,
            Err(problem) => partly(JobState::Failed, problem),
        },
        Ended::Failed(Failure::Stopped(Stopped::Cancelled)) if live.is_drained.get().is_some() => {
            partly(JobState::Failed, draining())
        }
        Ended::Failed(failure) => {
            let is_cancelled = failure == Failure::Stopped(Stopped::Cancelled);
            let state = if is_cancelled { JobState::Cancelled } else { JobState::Failed };
            partly(state, Problem::from(&failure))
        }
        Ended::InputLost(error) => partly(JobState::Failed, disk_problem(&error)),
        Ended::Crashed(error) => {
            tracing::error!(job = %row.id, %error, "the engine crashed");
            partly(
                JobState::Failed,
                Problem::new(ProblemCode::EngineCrashed, "the engine failed on this mesh"),
            )
        }
    }
}

async fn keep_files(
    service: &Service,
    row: &JobRow,
    answer: Answer,
    timing: wire::TimingMs,
) -> Result<Finish, Problem> {
    let Answer { report, output, levels } = answer;
    let problem =
        report.refusal.as_ref().map(Problem::from).filter(|_| report.outcome == Some(Outcome::Refused));
    let outcome = report.outcome.map(wire::Outcome::from);
    let text = serde_json::to_vec(&wire::Report::new(&report, timing))
        .map_err(|error| Problem::new(ProblemCode::Internal, error.to_string()))?;
    let result = match output {
        Some(output) => {
            let blob = match output.bytes {
                Some(bytes) => service.write(bytes).await?,
                None => row.input.clone(),
            };
            Some(ResultRef { blob, encoding: output.encoding.into() })
        }
        None => None,
    };
    let mut kept = Vec::with_capacity(levels.len());
    for level in levels {
        let written = match level.bytes {
            Some(bytes) => service.write(bytes).await,
            None => Ok(row.input.clone()),
        };
        match written {
            Ok(blob) => kept.push(ResultRef { blob, encoding: level.encoding.into() }),
            Err(problem) => {
                service.remove_own(row, result.iter().chain(&kept).map(|result| &result.blob));
                return Err(problem);
            }
        }
    }
    let report = match service.write(text).await {
        Ok(report) => report,
        Err(problem) => {
            service.remove_own(row, result.iter().chain(&kept).map(|result| &result.blob));
            return Err(problem);
        }
    };
    let state = if problem.is_some() { JobState::Failed } else { JobState::Succeeded };
    Ok(Finish {
        timing_ms: Some(timing),
        progress: Progress { stage: None, fraction: 1.0 },
        outcome,
        report: Some(report),
        result,
        levels: kept,
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
