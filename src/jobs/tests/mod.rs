//! The rules of a job's life, each on the smallest case that shows it, with engines made for the purpose.

mod blobs;
mod keeping;
mod losing;
mod neighbours;
mod restarting;
mod running;
mod sharing;
mod stores;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::Duration;

use tokio::io::AsyncReadExt as _;

use super::*;
use crate::budget::Budget;
use crate::formats::{Place, ReadError, ReadErrorKind};
use crate::pipeline::{Answer, Failure, Operation as Asked};
use crate::wire::{InputRef, Job, JobState, Operation, Options, Outcome, Problem, ProblemCode, sample};

/// Longest wait for something that must happen.
const PATIENCE: Duration = Duration::from_secs(20);

/// A service in a directory of its own.
#[derive(Debug)]
struct House {
    jobs: Jobs,
    dir: tempfile::TempDir,
}

impl std::ops::Deref for House {
    type Target = Jobs;

    fn deref(&self) -> &Jobs {
        &self.jobs
    }
}

async fn house(
    change: impl FnOnce(&mut JobsSettings),
    engine: impl Fn(&[u8], &Budget) -> Result<Answer, Failure> + Send + Sync + 'static,
) -> House {
    let dir = tempfile::tempdir().unwrap();
    let mut settings = JobsSettings { slots: 1, queue_max: 4, ..JobsSettings::new(dir.path()) };
    change(&mut settings);
    let engine: Engine = Arc::new(move |_: Asked, bytes, _, budget| engine(&bytes, budget));
    let jobs = Jobs::start_with(settings, engine).await.unwrap();
    House { jobs, dir }
}

/// The bytes of a mesh.
async fn content(mut stored: StoredFile) -> Vec<u8> {
    let mut bytes = Vec::new();
    stored.file.read_to_end(&mut bytes).await.unwrap();
    bytes
}

impl House {
    async fn send(&self, bytes: &[u8]) -> Result<Uploaded, Problem> {
        let mut upload = self.upload(Some(bytes.len() as u64)).await?;
        upload.write(bytes).await?;
        upload.finish().await
    }

    async fn order_with(
        &self,
        bytes: &[u8],
        options: Options,
        after: Option<Duration>,
    ) -> Result<Job, Problem> {
        let upload = Some(self.send(bytes).await?);
        let file_name = Some("C:\\parts\\part one.stl".to_owned());
        let asked = Submission::new(Operation::Repair, options);
        self.submit(Submission { upload, file_name, cancel_after: after, ..asked }).await
    }

    async fn order(&self, bytes: &[u8]) -> Result<Job, Problem> {
        self.order_with(bytes, Options::default(), None).await
    }

    async fn end_of(&self, job: &Job) -> Job {
        let ended = self.wait(id(job), PATIENCE).await.unwrap();
        assert!(ended.state.is_final(), "{ended:?}");
        ended
    }

    async fn run(&self, bytes: &[u8]) -> Job {
        let job = self.order(bytes).await.unwrap();
        self.end_of(&job).await
    }

    async fn until(&self, what: &str, holds: impl Fn(Load) -> bool) {
        for _ in 0..PATIENCE.as_millis() / 5 {
            if holds(self.load().await) {
                return;
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        panic!("{what} never held");
    }

    fn spool_files(&self) -> usize {
        files_under(&self.settings().data_dir.join("spool"))
    }
}

fn files_under(dir: &std::path::Path) -> usize {
    let entries = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| if path.is_dir() { files_under(&path) } else { 1 }).sum()
}

fn id(job: &Job) -> JobId {
    job.id.parse().unwrap()
}

fn code(job: &Job) -> Option<ProblemCode> {
    job.problem.as_ref().map(|problem| problem.code)
}

fn mend(_: &[u8], _: &Budget) -> Result<Answer, Failure> {
    Ok(sample::repaired())
}

/// Works until it is stopped.
fn work_forever(_: &[u8], budget: &Budget) -> Result<Answer, Failure> {
    loop {
        budget.check()?;
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// An engine that works until it is told to end, or until it is stopped.
fn work_until_told(told: mpsc::Receiver<()>) -> impl Fn(&[u8], &Budget) -> Result<Answer, Failure> {
    let told = Mutex::new(told);
    move |_, budget| loop {
        budget.check()?;
        if told.lock().unwrap().recv_timeout(Duration::from_millis(1)).is_ok() {
            return Ok(sample::repaired());
        }
    }
}

fn bytes_under(dir: &std::path::Path) -> u64 {
    let entries = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| if path.is_dir() { bytes_under(&path) } else { path.metadata().unwrap().len() }).sum()
}
