//! All children of one server: where they work and what holds them.

use std::io::ErrorKind;
use std::num::NonZero;
use std::time::{Duration, Instant};

use super::death::Death;
use super::limits::ProcessLimits;
use super::memory_kills;
use super::sandbox::Protections;
use super::starter::Starter;
use super::task::{ChildSetup, Task};
use super::trial::{TrialError, try_out};
use super::watch::{Answered, watch};
use super::workspace::{MadeFile, Workspaces};
use crate::jobs::clock::StageClock;
use crate::jobs::live::Live;
use crate::jobs::meters;
use crate::jobs::problems::disk_problem;
use crate::jobs::product::RunProduct;
use crate::jobs::settings::JobsSettings;
use crate::jobs::spool::Spool;
use crate::jobs::store::{BlobRef, JobRow};
use crate::wire::Problem;

/// Most children that a job is given to, when each ends before it takes the job.
const GIVEN_MAX: u32 = 3;

/// Gives jobs to children, one to each.
#[derive(Debug)]
pub(in crate::jobs) struct Processes {
    starter: Starter,
    setting: ChildSetup,
}

impl Processes {
    /// Finds out by a trial whether children do their job here, and says what holds them.
    pub(in crate::jobs) fn prepare(settings: &JobsSettings) -> Result<Self, TrialError> {
        // What was before this server is none of its jobs.
        memory_kills::are_more();
        let workspaces = Workspaces::open(&settings.data_dir)?;
        let setting = setting(settings);
        let protections = try_out(&workspaces, &setting)?;
        tell(protections, &setting.limits);
        Ok(Self { starter: Starter::open(setting.clone(), workspaces)?, setting })
    }

    /// Ends the child that waits for a task. None waits from then on.
    pub(in crate::jobs) fn close(&self) {
        self.starter.close();
    }

    /// Runs a job, which may charge so many bytes, in a child. Blocks.
    pub(in crate::jobs) fn run(
        &self,
        row: &JobRow,
        bytes_max: u64,
        spool: &Spool,
        live: &Live,
        settings: &JobsSettings,
        clock: &StageClock,
    ) -> Result<RunProduct<MadeFile>, Problem> {
        let task = Task {
            operation: row.operation,
            options: row.options.clone(),
            input_bytes: row.input.bytes,
            file_sizes: row.input.files.clone(),
            has_material: row.material.is_some(),
            triangles_max: settings.read_limits.triangles_max,
            vertices_max: settings.read_limits.vertices_max,
            polygon_corners_max: settings.read_limits.polygon_corners_max,
            engine_work_max: settings.engine_work_max,
            engine_bytes_max: bytes_max,
        };
        let begun = Instant::now();
        let give = || {
            let patience = settings.deadline_max.saturating_sub(begun.elapsed());
            self.give(row, &task, spool, live, patience, clock)
        };
        let mut answered = give()?;
        for _ in 1..GIVEN_MAX {
            // It was ended while it waited, whatever its task: that is nothing about the job.
            let Err(death @ Death::Waiting(_)) = &answered else { break };
            tracing::warn!(job = %row.id, ?death, "a process ended before it took its job: another one gets it");
            meters::child_ended(death.kind());
            answered = give()?;
        }
        match answered {
            Ok(answered) => {
                if let Some(place) = answered.panicked_at {
                    tracing::error!(job = %row.id, place, "the engine panicked");
                    meters::child_ended("panicked");
                } else {
                    meters::child_ended("answered");
                }
                answered.outcome
            }
            Err(death) => {
                meters::child_ended(death.kind());
                let problem = death.problem(clock.progress().stage, &self.setting.limits, bytes_max);
                match &death {
                    Death::Stopped(_) => {}
                    Death::NotStarted(error) => {
                        tracing::error!(job = %row.id, %error, "no process could be started for a job");
                    }
                    _ => tracing::error!(job = %row.id, kind = death.kind(), "{}", problem.detail),
                }
                Err(problem)
            }
        }
    }

    /// Gives a job to one child and hears it to its end.
    fn give(
        &self,
        row: &JobRow,
        task: &Task,
        spool: &Spool,
        live: &Live,
        patience: Duration,
        clock: &StageClock,
    ) -> Result<Result<Answered, Death>, Problem> {
        let running = match self.starter.child() {
            Ok(running) => running,
            // Its folder needs the disk.
            Err(error) if matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded) => {
                return Err(disk_problem(&error));
            }
            Err(error) => return Ok(Err(Death::NotStarted(error))),
        };
        let local = |blob: &BlobRef| spool.path(&blob.key).map_err(|error| disk_problem(&error));
        let material = row.material.as_ref().map(local).transpose()?;
        let given = running.workspace.give(&local(&row.input)?, material.as_deref());
        given.map_err(|error| disk_problem(&error))?;
        Ok(watch(running, task, &live.stop, patience, &clock.observer()))
    }
}

fn setting(settings: &JobsSettings) -> ChildSetup {
    let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    let threads = match settings.engine_threads {
        // Asked here: a child in its sandbox does not see how many cores its group of processes may use.
        0 => cores(),
        threads => threads,
    };
    ChildSetup {
        parent: std::process::id() as i32,
        threads,
        limits: ProcessLimits::new(
            settings.engine_bytes_max,
            settings.data_bytes_max,
            settings.deadline_max,
            threads,
        ),
        sandbox: settings.sandbox,
    }
}

fn tell(protections: Protections, limits: &ProcessLimits) {
    let ProcessLimits { memory_bytes, cpu_s, file_bytes } = limits;
    tracing::info!(
        "jobs run in processes of their own: {protections}, memory {memory_bytes} B, CPU {cpu_s} s, files {file_bytes} B"
    );
}
