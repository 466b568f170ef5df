//! The child: one job, from the task on standard input to files in a folder.

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use rustix::process::{Signal, getppid, set_parent_process_death_signal};

use super::answer::Files;
use super::task::{FileMade, Message, Task};
use crate::budget::{Budget, Event, StopFlag};
use crate::jobs::clock::StageClock;
use crate::jobs::product::Product;
use crate::jobs::upload::disk_problem;
use crate::par;
use crate::pipeline::{self, Answer, Failure};
use crate::wire::{Problem, ProblemCode};

/// The command that makes a process a child. For servers only: a person has no use for it.
pub const RUN_JOB: &str = "run-job";

/// The function that runs a job's bytes.
type Engine =
    dyn Fn(pipeline::Operation, &[u8], &pipeline::Options, &Budget) -> Result<Answer, Failure> + Sync;

/// Runs the job that standard input describes with `engine`, and ends with the server. To be called first in `main` when
/// the first argument is [`RUN_JOB`], before any thread is started.
pub fn run_job(
    engine: impl Fn(pipeline::Operation, &[u8], &pipeline::Options, &Budget) -> Result<Answer, Failure>
    + Sync
    + 'static,
) -> ExitCode {
    match obey(&engine) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(io::stderr(), "{}: {RUN_JOB}: {error}", env!("CARGO_PKG_NAME"));
            ExitCode::FAILURE
        }
    }
}

fn obey(engine: &Engine) -> io::Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL))?;
    let task: Task = serde_json::from_reader(io::stdin().lock())?;
    if getppid().map(|pid| pid.as_raw_nonzero().get()) != Some(task.parent) {
        return Err(io::Error::other("the server has gone"));
    }
    task.limits.enter()?;
    let inputs = Inputs::open(&task);
    let files = Files::new(&task)?;
    say(&Message::Confined(task.sandbox.enter(&task.output)?))?;
    let outcome = inputs.and_then(|inputs| {
        let crashed = |_| Err(Problem::new(ProblemCode::EngineCrashed, "the engine failed on this mesh"));
        catch_unwind(AssertUnwindSafe(|| run(&task, inputs, &files, engine))).unwrap_or_else(crashed)
    });
    say(&match outcome {
        Ok(product) => Message::Made(Box::new(product)),
        Err(problem) => Message::Failed(Box::new(problem)),
    })
}

/// The files to read, opened before the process gives up the right to.
struct Inputs {
    mesh: File,
    material: Option<File>,
}

impl Inputs {
    fn open(task: &Task) -> Result<Self, Problem> {
        let open = |path| File::open(path).map_err(|error| disk_problem(&error));
        Ok(Self { mesh: open(&task.input)?, material: task.material.as_ref().map(open).transpose()? })
    }
}

fn run(
    task: &Task,
    mut inputs: Inputs,
    files: &Files,
    engine: &Engine,
) -> Result<Product<FileMade>, Problem> {
    let clock = StageClock::start(task.operation);
    let stamp = clock.observer();
    let budget = Budget::new(StopFlag::default(), task.engine_work_max, task.engine_bytes_max).observed_by(
        Box::new(move |event| {
            stamp(event);
            // A server that does not listen ends this process anyway.
            let _ = say(&match event {
                Event::Enter(stage) => Message::Enter(stage.into()),
                Event::Leave(stage) => Message::Leave(stage.into()),
            });
        }),
    );
    let mut options = task.options.to_engine(task.read_limits());
    let answer = par::with_threads(task.threads, || {
        let stopped = |stopped| Problem::from(&Failure::Stopped(stopped));
        let (mut content, _charge) = budget.vec(task.input_bytes as usize).map_err(stopped)?;
        inputs.mesh.read_to_end(&mut content).map_err(|error| disk_problem(&error))?;
        if let Some(mut file) = inputs.material {
            let mut material = Vec::new();
            file.read_to_end(&mut material).map_err(|error| disk_problem(&error))?;
            options.material = Some(material);
        }
        engine(task.operation.into(), &content, &options, &budget).map_err(|failure| Problem::from(&failure))
    })?;
    files.write(Product::of(answer, clock.timing_ms())?)
}

/// A line to the server.
fn say(message: &Message) -> io::Result<()> {
    let mut line = serde_json::to_vec(message)?;
    line.push(b'\n');
    let mut output = io::stdout().lock();
    output.write_all(&line)?;
    output.flush()
}
