//! The service with an engine that sleeps, for campaigns that measure all that is around an engine: a mesh that begins with
//! `sleep 250` keeps its process for 250 ms and is then refused as unreadable; any other one is worked on as ever.

use meshmend::budget::{Budget, Stage};
use meshmend::formats::{Place, ReadError, ReadErrorKind};
use meshmend::pipeline::{self, Answer, Failure, Operation, Options};
use meshmend::{cli, http, jobs};
use std::process::ExitCode;
use std::time::Duration;

fn main() -> ExitCode {
    if std::env::args().nth(1).as_deref() == Some(jobs::RUN_JOB) {
        return jobs::run_job(run);
    }
    let service = cli::ServiceHooks {
        serve: http::start,
        check: http::check,
        healthcheck: http::healthcheck,
        migrate: http::migrate,
    };
    cli::run(std::env::args_os(), service)
}

fn run(operation: Operation, bytes: Vec<u8>, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let sleep =
        || std::str::from_utf8(bytes.strip_prefix(b"sleep ")?).ok()?.split_whitespace().next()?.parse().ok();
    let Some(ms) = sleep() else { return pipeline::run(operation, bytes, options, budget) };
    budget.stage(Stage::Repair, || {
        std::thread::sleep(Duration::from_millis(ms));
        let kind = ReadErrorKind::Unparseable { found: "a sleeper".to_owned() };
        Err(Failure::Unreadable(ReadError { kind, place: Place::Whole, expected: "a mesh".to_owned() }))
    })
}
