//! All children of one server: where they work and what holds them.

use std::io;
use std::num::NonZero;
use std::sync::Arc;

use super::death::Death;
use super::limits::Limits;
use super::sandbox::Protections;
use super::starter::Starter;
use super::task::Task;
use super::trial::{TrialError, try_out};
use super::watch::watch;
use super::workspace::Workspaces;
use crate::jobs::clock::StageClock;
use crate::jobs::live::Live;
use crate::jobs::meters;
use crate::jobs::product::{MadeFile, Product};
use crate::jobs::settings::JobsSettings;
use crate::jobs::spool::Spool;
use crate::jobs::store::{BlobRef, JobRow};
use crate::jobs::upload::disk_problem;
use crate::wire::{Operation, Options, Problem};

/// Gives jobs to children, one to each.
#[derive(Debug)]
pub(in crate::jobs) struct Processes {
    starter: Starter,
    workspaces: Workspaces,
    /// A task for nothing, with what all tasks have in common.
    pattern: Task,
}

impl Processes {
    /// Finds out by a trial whether children do their job here, and says what holds them.
    pub(in crate::jobs) fn prepare(settings: &JobsSettings) -> Result<Self, TrialError> {
        let workspaces = Workspaces::open(&settings.data_dir)?;
        let starter = Starter::open()?;
        let pattern = pattern(settings);
        let protections = try_out(&starter, &workspaces, pattern.clone())?;
        tell(protections, &pattern.limits);
        Ok(Self { starter, workspaces, pattern })
    }

    /// Runs a job in a child. Blocks.
    pub(in crate::jobs) fn run(
        &self,
        row: &JobRow,
        spool: &Spool,
        live: &Live,
        settings: &JobsSettings,
        clock: &StageClock,
    ) -> Result<Product<MadeFile>, Problem> {
        let local = |blob: &BlobRef| spool.path(&blob.key);
        let prepare = || {
            io::Result::Ok((
                self.workspaces.make()?,
                local(&row.input)?,
                row.material.as_ref().map(local).transpose()?,
            ))
        };
        let (workspace, input, material) = prepare().map_err(|error| disk_problem(&error))?;
        let workspace = Arc::new(workspace);
        let task = Task {
            operation: row.operation,
            options: row.options.clone(),
            input,
            input_bytes: row.input.bytes,
            material,
            output: workspace.path().to_owned(),
            ..self.pattern.clone()
        };
        let hear = clock.observer();
        match watch(&self.starter, &task, &workspace, &live.stop, settings.deadline_max, &hear) {
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
                let problem = death.problem(clock.progress().stage, &task.limits, task.engine_bytes_max);
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
}

fn pattern(settings: &JobsSettings) -> Task {
    let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    let threads = match settings.engine_threads {
        // Asked here: a child in its sandbox does not see how many cores its group of processes may use.
        0 => cores(),
        threads => threads,
    };
    Task {
        parent: std::process::id() as i32,
        operation: Operation::Verify,
        options: Options::default(),
        input: "".into(),
        input_bytes: 0,
        material: None,
        output: "".into(),
        threads,
        triangles_max: settings.read_limits.triangles_max,
        vertices_max: settings.read_limits.vertices_max,
        polygon_corners_max: settings.read_limits.polygon_corners_max,
        engine_work_max: settings.engine_work_max,
        engine_bytes_max: settings.engine_bytes_max,
        limits: Limits::new(
            settings.engine_bytes_max,
            settings.data_bytes_max,
            settings.deadline_max,
            threads,
        ),
        sandbox: settings.sandbox,
    }
}

fn tell(protections: Protections, limits: &Limits) {
    let Limits { memory_bytes, cpu_s, file_bytes } = limits;
    tracing::info!(
        "jobs run in processes of their own: {protections}, memory {memory_bytes} B, CPU {cpu_s} s, files {file_bytes} B"
    );
}
