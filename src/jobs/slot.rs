//! A slot: owns one job at a time, from claim to finish.

use std::fs::File;
use std::io::Read;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use tokio::task::JoinError;
use tokio_util::task::AbortOnDropHandle;

use super::clock::StageClock;
use super::heartbeat::beat;
use super::live::Live;
use super::service::Service;
use super::settle::{Conclusion, settle};
use super::spool::Written;
use super::store::{BlobRef, ClaimRequest, Ending, JobRow, Lane, ResultRef};
use super::upload::disk_problem;
use crate::budget::Budget;
use crate::par;
use crate::pipeline::{self, Answer, Failure, Outcome};
use crate::wire::{self, JobState, Problem, ProblemCode, Progress};

/// The function that runs a job's bytes: [`pipeline::run`], or another one in tests.
pub type Engine = Arc<
    dyn Fn(pipeline::Operation, &[u8], &pipeline::Options, &Budget) -> Result<Answer, Failure> + Send + Sync,
>;

/// Pause before a store that did not answer is asked again.
pub(super) const STORE_PAUSE: Duration = Duration::from_secs(1);

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
        let request = ClaimRequest {
            worker: service.worker.clone(),
            lease: service.settings.lease,
            prefer: Lane::Interactive,
        };
        match service.store.claim(request).await {
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
    let clock = StageClock::start(row.operation);
    let live = service.live.begin(row.claim(), clock.clone());
    let heart = beat(Arc::clone(service), row.claim(), row.cancel_at, Arc::clone(&live));
    let heart = AbortOnDropHandle::new(tokio::spawn(heart));
    service.tell_load().await;
    let ended = attempt(service, &row, &live, clock.clone()).await;
    service.note_run_time(&clock);
    let conclusion = conclude(service, &row, &live, &clock, ended).await;
    settle(service, &row, &live, conclusion).await;
    drop(heart);
    service.tell_load().await;
}

/// Runs the engine on the blocking pool and ends it when its time is over.
async fn attempt(service: &Arc<Service>, row: &JobRow, live: &Live, clock: StageClock) -> Ended {
    let local = |blob: &BlobRef| service.spool.path(&blob.key);
    let (path, material_path) = match (local(&row.input), row.material.as_ref().map(local).transpose()) {
        (Ok(path), Ok(material_path)) => (path, material_path),
        (Err(error), _) | (_, Err(error)) => return Ended::InputLost(error),
    };
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
async fn conclude(
    service: &Service,
    row: &JobRow,
    live: &Live,
    clock: &StageClock,
    ended: Ended,
) -> Conclusion {
    let kept = match ended {
        Ended::Answered(answer) => keep_files(service, row, *answer, clock.timing_ms()).await,
        Ended::Failed(failure) => Err(Problem::from(&failure)),
        Ended::InputLost(error) => Err(disk_problem(&error)),
        Ended::Crashed(error) => {
            tracing::error!(job = %row.id, %error, "the engine crashed");
            Err(Problem::new(ProblemCode::EngineCrashed, "the engine failed on this mesh"))
        }
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
        ProblemCode::Cancelled => end(JobState::Cancelled, problem),
        // The run is lost with its executor, not ended by what it was given.
        ProblemCode::EngineCrashed | ProblemCode::WorkerLost => Conclusion::Lose(Box::new(problem)),
        _ => end(JobState::Failed, problem),
    }
}

async fn keep_files(
    service: &Service,
    row: &JobRow,
    answer: Answer,
    timing: wire::TimingMs,
) -> Result<(Ending, Vec<Written>), Problem> {
    let Answer { report, output, levels } = answer;
    let problem =
        report.refusal.as_ref().map(Problem::from).filter(|_| report.outcome == Some(Outcome::Refused));
    let outcome = report.outcome.map(wire::Outcome::from);
    let text = serde_json::to_vec(&wire::Report::new(&report, timing))
        .map_err(|error| Problem::new(ProblemCode::Internal, error.to_string()))?;
    // Should one file fail, those before it go with this list.
    let mut written = Vec::new();
    let has_result = output.is_some();
    let mut results = Vec::new();
    for (number, mesh) in output.into_iter().chain(levels).enumerate() {
        let blob = match mesh.bytes {
            Some(bytes) => service.write(row.claim(), format!("mesh-{number}"), bytes, &mut written).await?,
            None => row.input.clone(),
        };
        results.push(ResultRef { blob, encoding: mesh.encoding.into() });
    }
    let report = service.write(row.claim(), "report.json".to_owned(), text, &mut written).await?;
    let levels = results.split_off(usize::from(has_result).min(results.len()));
    let state = if problem.is_some() { JobState::Failed } else { JobState::Succeeded };
    let ending = Ending {
        timing_ms: Some(timing),
        progress: Progress { stage: None, fraction: 1.0 },
        outcome,
        report: Some(report),
        result: results.pop(),
        levels,
        ..Ending::without_files(state, problem)
    };
    Ok((ending, written))
}
