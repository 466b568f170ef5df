//! The child: confined first, then one job, from the task on standard input to files in a folder.

use std::ffi::CStr;
use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use rustix::process::{Signal, getppid, set_parent_process_death_signal};

use super::answer::Files;
use super::task::{ChildMessage, ChildSetup, FileMade, Task};
use super::workspace::Rooms;
use crate::budget::{Budget, ProgressEvent, StopFlag};
use crate::jobs::clock::StageClock;
use crate::jobs::problems::{engine_crashed, workspace_problem};
use crate::jobs::product::RunProduct;
use crate::par;
use crate::pipeline::{self, Answer, Failure};
use crate::wire::Problem;

/// The command that makes a process a child: its arguments are a folder and a `ChildSetup` as JSON. For servers only: a
/// person has no use for it.
pub const RUN_JOB: &str = "run-job";
/// How a process is called, as `ps` and `top` show it, while it waits for a task.
const WAITING: &CStr = c"meshmend-waits";
/// The same while it runs a job.
const WORKING: &CStr = c"meshmend-job";

/// Time between two words about the work within a stage: each of them wakes the server.
const WORK_TOLD_EVERY: Duration = Duration::from_millis(10);

/// The function that runs a job's bytes.
type EngineFunction =
    dyn Fn(pipeline::Operation, Vec<u8>, &pipeline::Options, &Budget) -> Result<Answer, Failure> + Sync;

/// Runs the job that standard input describes with `engine`, and ends with the server. To be called first in `main` when
/// the first argument is [`RUN_JOB`], before any thread is started: all are to be confined.
pub fn run_job(
    engine: impl Fn(pipeline::Operation, Vec<u8>, &pipeline::Options, &Budget) -> Result<Answer, Failure>
    + Sync
    + 'static,
) -> ExitCode {
    match wait_and_obey(&engine) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(io::stderr(), "{}: {RUN_JOB}: {error}", env!("CARGO_PKG_NAME"));
            ExitCode::FAILURE
        }
    }
}

fn wait_and_obey(engine: &EngineFunction) -> io::Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL))?;
    let (Some(folder), Some(setting)) = (std::env::args_os().nth(2), std::env::args().nth(3)) else {
        return Err(io::Error::other("only a server runs this"));
    };
    let setting: ChildSetup = serde_json::from_str(&setting)?;
    if getppid().map(|pid| pid.as_raw_nonzero().get()) != Some(setting.parent) {
        return Err(io::Error::other("the server has gone"));
    }
    setting.limits.enter()?;
    let rooms = Rooms::of(folder.into());
    let protections = setting.sandbox.enter(&rooms)?;
    let files = Files { rooms, bytes_max: setting.limits.file_bytes };
    // Threads take their time to start: they wait for the task too.
    let threads = par::Threads::start(setting.threads);
    // Whatever it is called, it works.
    let _ = rustix::thread::set_name(WAITING);
    say(&ChildMessage::Confined(protections))?;
    let task = serde_json::from_reader(io::stdin().lock())?;
    let _ = rustix::thread::set_name(WORKING);
    say(&ChildMessage::Taken)?;
    threads.run(|| obey(&task, &files, engine))
}

fn obey(task: &Task, files: &Files, engine: &EngineFunction) -> io::Result<()> {
    let outcome = catch_unwind(AssertUnwindSafe(|| run(task, files, engine)));
    let outcome = outcome.unwrap_or_else(|_| Err(engine_crashed()));
    say(&match outcome {
        Ok(product) => ChildMessage::Made(Box::new(product)),
        Err(problem) => ChildMessage::Failed(Box::new(problem)),
    })
}

fn run(task: &Task, files: &Files, engine: &EngineFunction) -> Result<RunProduct<FileMade>, Problem> {
    let clock = StageClock::start(task.operation);
    let stamp = clock.observer();
    let work_told = Mutex::new(Instant::now());
    let budget = Budget::new(StopFlag::default(), task.engine_work_max, task.engine_bytes_max).observed_by(
        Box::new(move |event| {
            stamp(event);
            if let ProgressEvent::Work(_) = event {
                let mut told = work_told.lock().unwrap_or_else(PoisonError::into_inner);
                if told.elapsed() < WORK_TOLD_EVERY {
                    return;
                }
                *told = Instant::now();
            }
            // A server that does not listen ends this process anyway.
            let _ = say(&match event {
                ProgressEvent::Enter(stage) => ChildMessage::Enter(stage.into()),
                ProgressEvent::Leave(stage) => ChildMessage::Leave(stage.into()),
                ProgressEvent::Work(units) => ChildMessage::Work(units),
            });
        }),
    );
    let mut options = task.options.to_engine(task.read_limits());
    options.file_sizes.clone_from(&task.file_sizes);
    let stopped = |stopped| Problem::from(&Failure::Stopped(stopped));
    let (mut content, _charge) = budget.vec(task.input_bytes as usize).map_err(stopped)?;
    File::open(files.rooms.mesh())
        .and_then(|mut mesh| mesh.read_to_end(&mut content))
        .map_err(|error| workspace_problem(&error))?;
    let material = task.has_material.then(|| std::fs::read(files.rooms.material()));
    options.material = material.transpose().map_err(|error| workspace_problem(&error))?;
    let answer = engine(task.operation.into(), content, &options, &budget)
        .map_err(|failure| Problem::from(&failure))?;
    files.write(RunProduct::of(answer, clock.timing_ms())?)
}

/// A line to the server.
fn say(message: &ChildMessage) -> io::Result<()> {
    let mut line = serde_json::to_vec(message)?;
    line.push(b'\n');
    let mut output = io::stdout().lock();
    output.write_all(&line)?;
    output.flush()
}
