//! Runs of jobs, each in a process of its own, or in a thread of the server.

use std::fs::File;
use std::io::Read;
use std::sync::Arc;

use super::child::{Processes, Sandbox, TrialError};
use super::clock::StageClock;
use super::disk::on_disk;
use super::live::Live;
use super::problems::{disk_problem, engine_crashed};
use super::product::{Content, RunProduct};
use super::settings::{Isolation, JobsSettings};
use super::spool::Spool;
use super::store::{BlobRef, JobRow};
use crate::budget::{Budget, Stopped};
use crate::par;
use crate::pipeline::{self, Answer, Failure};
use crate::wire::{Problem, ProblemCode};

/// The function that runs a job's bytes: [`pipeline::run`], or another one in tests.
pub type Engine = Arc<
    dyn Fn(pipeline::Operation, Vec<u8>, &pipeline::Options, &Budget) -> Result<Answer, Failure>
        + Send
        + Sync,
>;

/// Runs jobs.
pub(super) struct Executor {
    runner: Runner,
    spool: Arc<Spool>,
    settings: Arc<JobsSettings>,
}

enum Runner {
    Process(Arc<Processes>),
    Thread(Engine),
}

impl Executor {
    /// What runs jobs as the settings ask, after a trial; with an engine of its own, in threads.
    pub(super) async fn new(
        settings: &Arc<JobsSettings>,
        spool: &Arc<Spool>,
        engine: Option<Engine>,
    ) -> Result<Self, TrialError> {
        let runner = match engine {
            Some(engine) => Runner::Thread(engine),
            None => Runner::of(settings).await?,
        };
        Ok(Self { runner, spool: Arc::clone(spool), settings: Arc::clone(settings) })
    }

    /// No more jobs come.
    pub(super) fn close(&self) {
        if let Runner::Process(processes) = &self.runner {
            processes.close();
        }
    }

    /// Runs the job, which may charge so many bytes, and ends it when its time is over.
    pub(super) async fn run(
        &self,
        row: &JobRow,
        live: &Arc<Live>,
        clock: &StageClock,
        bytes_max: u64,
    ) -> Result<RunProduct<Content>, Problem> {
        match &self.runner {
            Runner::Process(processes) => self.in_process(processes, row, live, clock, bytes_max).await,
            Runner::Thread(engine) => self.in_thread(engine, row, live, clock, bytes_max).await,
        }
    }

    async fn in_process(
        &self,
        processes: &Arc<Processes>,
        row: &JobRow,
        live: &Arc<Live>,
        clock: &StageClock,
        bytes_max: u64,
    ) -> Result<RunProduct<Content>, Problem> {
        let (processes, spool, settings) =
            (Arc::clone(processes), Arc::clone(&self.spool), Arc::clone(&self.settings));
        let (row, live, clock) = (row.clone(), Arc::clone(live), clock.clone());
        let watching = tokio::task::spawn_blocking(move || {
            let made = processes.run(&row, bytes_max, &spool, &live, &settings, &clock)?;
            made.take_over(row.claim(), &spool)
        });
        watching.await.unwrap_or_else(|error| {
            tracing::error!(%error, "the watch over a job's process failed");
            Err(Problem::new(ProblemCode::WorkerLost, "the process that ran the job was lost"))
        })
    }

    async fn in_thread(
        &self,
        engine: &Engine,
        row: &JobRow,
        live: &Live,
        clock: &StageClock,
        bytes_max: u64,
    ) -> Result<RunProduct<Content>, Problem> {
        let settings = &self.settings;
        let (spool, input, material) = (Arc::clone(&self.spool), row.input.clone(), row.material.clone());
        let (path, material_path) = on_disk(move || {
            let local = |blob: &BlobRef| spool.path(&blob.key);
            Ok((local(&input)?, material.as_ref().map(local).transpose()?))
        })
        .await?;
        let (bytes, operation) = (row.input.bytes, row.operation.into());
        let mut options = row.options.to_engine(settings.read_limits);
        options.file_sizes.clone_from(&row.input.files);
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
                engine(operation, content, &options, &budget).map_err(|failure| Problem::from(&failure))
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
            Err(engine_crashed())
        })?;
        RunProduct::of(answer, clock.timing_ms())?.try_map(|bytes| Ok(Content::Bytes(bytes)))
    }
}

impl Runner {
    /// What the settings ask for, after a trial.
    async fn of(settings: &Arc<JobsSettings>) -> Result<Self, TrialError> {
        match settings.isolation {
            Isolation::Process => {
                let settings = Arc::clone(settings);
                let prepared = tokio::task::spawn_blocking(move || Processes::prepare(&settings)).await;
                let processes = prepared.map_err(|error| TrialError::NoAnswer(error.to_string()))??;
                Ok(Self::Process(Arc::new(processes)))
            }
            Isolation::Thread if settings.sandbox == Sandbox::Require => Err(TrialError::NoProcess),
            Isolation::Thread => Ok(Self::Thread(Arc::new(pipeline::run))),
        }
    }
}
