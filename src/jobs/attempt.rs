//! One run of a job: in a process of its own, or in a thread of the server.

use std::fs::File;
use std::io::Read;
use std::sync::Arc;

use super::child::{Processes, Sandbox, TrialError};
use super::clock::StageClock;
use super::live::Live;
use super::product::{Content, Product};
use super::service::Service;
use super::settings::JobsSettings;
use super::store::{BlobRef, JobRow};
use super::upload::disk_problem;
use crate::budget::{Budget, Stopped};
use crate::par;
use crate::pipeline::{self, Answer, Failure};
use crate::wire::{Problem, ProblemCode};

/// The function that runs a job's bytes: [`pipeline::run`], or another one in tests.
pub type Engine = Arc<
    dyn Fn(pipeline::Operation, &[u8], &pipeline::Options, &Budget) -> Result<Answer, Failure> + Send + Sync,
>;

/// Where a job runs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Isolation {
    /// In a process of its own: the same binary, whose `main` calls [`run_job`](super::run_job).
    Process,
    /// In a thread of the server, which ends with it when it runs out of memory or overflows its stack.
    #[default]
    Thread,
}

/// What runs jobs.
#[derive(Clone)]
pub(super) enum Executor {
    Process(Arc<Processes>),
    Thread(Engine),
}

impl Executor {
    /// No more jobs come.
    pub(super) fn close(&self) {
        if let Self::Process(processes) = self {
            processes.close();
        }
    }

    /// What the settings ask for, after a trial.
    pub(super) async fn of(settings: &JobsSettings) -> Result<Self, TrialError> {
        match settings.isolation {
            Isolation::Process => {
                let settings = settings.clone();
                let prepared = tokio::task::spawn_blocking(move || Processes::prepare(&settings)).await;
                let processes = prepared.map_err(|error| TrialError::NoAnswer(error.to_string()))??;
                Ok(Self::Process(Arc::new(processes)))
            }
            Isolation::Thread if settings.sandbox == Sandbox::Require => Err(TrialError::NoProcess),
            Isolation::Thread => Ok(Self::Thread(Arc::new(pipeline::run))),
        }
    }
}

/// Runs the job, which may charge so many bytes, and ends it when its time is over.
pub(super) async fn attempt(
    service: &Arc<Service>,
    row: &JobRow,
    live: &Arc<Live>,
    clock: &StageClock,
    bytes_max: u64,
) -> Result<Product<Content>, Problem> {
    match &service.executor {
        Executor::Process(processes) => in_process(service, processes, row, live, clock, bytes_max).await,
        Executor::Thread(engine) => in_thread(service, engine, row, live, clock, bytes_max).await,
    }
}

async fn in_process(
    service: &Arc<Service>,
    processes: &Arc<Processes>,
    row: &JobRow,
    live: &Arc<Live>,
    clock: &StageClock,
    bytes_max: u64,
) -> Result<Product<Content>, Problem> {
    let (service, processes) = (Arc::clone(service), Arc::clone(processes));
    let (row, live, clock) = (row.clone(), Arc::clone(live), clock.clone());
    let watching = tokio::task::spawn_blocking(move || {
        let made = processes.run(&row, bytes_max, &service.spool, &live, &service.settings, &clock)?;
        made.take_over(row.claim(), &service.spool)
    });
    watching.await.unwrap_or_else(|error| {
        tracing::error!(%error, "the watch over a job's process failed");
        Err(Problem::new(ProblemCode::WorkerLost, "the process that ran the job was lost"))
    })
}

async fn in_thread(
    service: &Service,
    engine: &Engine,
    row: &JobRow,
    live: &Live,
    clock: &StageClock,
    bytes_max: u64,
) -> Result<Product<Content>, Problem> {
    let local = |blob: &BlobRef| service.spool.path(&blob.key).map_err(|error| disk_problem(&error));
    let (path, material_path) = (local(&row.input)?, row.material.as_ref().map(local).transpose()?);
    let (bytes, operation) = (row.input.bytes, row.operation.into());
    let mut options = row.options.to_engine(service.settings.read_limits);
    let settings = &service.settings;
    let budget =
        Budget::new(live.stop.clone(), settings.engine_work_max, bytes_max).observed_by(clock.observer());
    let (engine, threads) = (Arc::clone(engine), settings.engine_threads);
    let mut task = tokio::task::spawn_blocking(move || {
        par::with_threads(threads, move || {
            let stopped = |stopped: Stopped| Problem::from(&stopped);
            let (mut content, _charge) = budget.vec(bytes as usize).map_err(stopped)?;
            File::open(&path)
                .and_then(|mut file| file.read_to_end(&mut content))
                .map_err(|error| disk_problem(&error))?;
            options.material =
                material_path.map(std::fs::read).transpose().map_err(|error| disk_problem(&error))?;
            engine(operation, &content, &options, &budget).map_err(|failure| Problem::from(&failure))
        })
    });
    let joined = tokio::select! {
        joined = &mut task => joined,
        () = tokio::time::sleep(settings.deadline_max) => {
            live.stop.pass_deadline();
            task.await
        }
    };
    let answer = joined.unwrap_or_else(|error| {
        tracing::error!(job = %row.id, %error, "the engine crashed");
        Err(Problem::new(ProblemCode::EngineCrashed, "the engine failed on this mesh"))
    })?;
    Product::of(answer, clock.timing_ms())?.try_map(|bytes| Ok(Content::Bytes(bytes)))
}
