//! What the job service tells the metrics recorder.

use metrics::{counter, describe_counter, describe_gauge, describe_histogram, gauge, histogram};

use super::soundness::Unsound;
use super::store::{Ending, JobCounts, NextTry, TryOutcome};
use crate::wire::{Operation, Problem, Stage};

/// Says what each series is, and begins those at 0 whose first event is worth an alert: an increase is seen only from a value that
/// was there before.
pub fn describe() {
    describe_gauge!("meshmend_jobs_queued", "Jobs that wait for a slot.");
    describe_gauge!("meshmend_queued_bytes", "Bytes of the uploads of jobs that wait for a slot.");
    describe_gauge!("meshmend_jobs_running", "Jobs in a slot.");
    describe_gauge!("meshmend_jobs_kept", "Jobs in any state.");
    describe_gauge!("meshmend_queue_oldest_seconds", "Age of the job that waits for longest; 0: none waits.");
    describe_gauge!("meshmend_data_bytes", "Bytes of uploads and results on disk.");
    describe_counter!(
        "meshmend_jobs_finished_total",
        "Jobs that have ended, by operation, state, outcome and problem."
    );
    describe_counter!("meshmend_jobs_cached_total", "Jobs that were answered from an earlier one.");
    describe_counter!("meshmend_jobs_refused_total", "Uploads and jobs that were not taken, by problem.");
    describe_counter!(
        "meshmend_runs_lost_total",
        "Runs whose executor was lost: its lease is over, or it crashed."
    );
    describe_counter!("meshmend_webhook_tries_total", "Calls of webhooks, by answer and what is next.");
    describe_counter!("meshmend_files_unsound_total", "Stored files that were found lost or damaged.");
    describe_counter!("meshmend_child_exits_total", "Processes of jobs that have ended, by how they did.");
    describe_histogram!(
        "meshmend_stage_seconds",
        "Time of each pass of the jobs that have ended, in seconds."
    );
    for operation in Operation::ALL {
        counter!("meshmend_runs_lost_total", "operation" => operation.word()).absolute(0);
    }
    for kind in UNSOUND {
        counter!("meshmend_files_unsound_total", "kind" => kind).absolute(0);
    }
}

/// How a stored file can be one that nobody can be given.
const UNSOUND: [&str; 3] = ["lost", "damaged", "unreadable"];

/// Jobs that wait and run, bytes on disk.
pub(super) fn load(counts: JobCounts, data_bytes: u64) {
    gauge!("meshmend_jobs_queued").set(counts.queued as f64);
    gauge!("meshmend_queued_bytes").set(counts.queued_bytes as f64);
    gauge!("meshmend_jobs_running").set(counts.running as f64);
    gauge!("meshmend_jobs_kept").set(counts.all as f64);
    let waited = counts.longest_queued.unwrap_or_default();
    gauge!("meshmend_queue_oldest_seconds").set(waited.as_secs_f64());
    gauge!("meshmend_data_bytes").set(data_bytes as f64);
}

/// A job that was not taken.
pub(super) fn refused(problem: &Problem) {
    counter!("meshmend_jobs_refused_total", "problem" => problem.code.word()).increment(1);
}

/// A stored file that nobody can be given.
pub(super) fn unsound(unsound: &Unsound) {
    let [lost, damaged, unreadable] = UNSOUND;
    let kind = match unsound {
        Unsound::Lost => lost,
        Unsound::Damaged => damaged,
        Unsound::Disk(_) => unreadable,
    };
    counter!("meshmend_files_unsound_total", "kind" => kind).increment(1);
}

/// A try to deliver a webhook.
pub(super) fn delivery_tried(outcome: &TryOutcome, next: NextTry) {
    let answer = match outcome {
        TryOutcome::Answered(status) => format!("{}xx", status / 100),
        TryOutcome::Failed(_) => "none".to_owned(),
    };
    let then = match next {
        NextTry::Delivered => "delivered",
        NextTry::After(_) => "retry",
        NextTry::GiveUp => "failed",
    };
    counter!("meshmend_webhook_tries_total", "answer" => answer, "then" => then).increment(1);
}

/// A job that was answered from an earlier one.
pub(super) fn cached(operation: Operation) {
    counter!("meshmend_jobs_cached_total", "operation" => operation.word()).increment(1);
}

/// The process of a job has ended, in this way.
pub(super) fn child_ended(kind: &'static str) {
    counter!("meshmend_child_exits_total", "kind" => kind).increment(1);
}

/// Runs whose executor is lost.
pub(super) fn lost(operation: Operation, runs: u64) {
    counter!("meshmend_runs_lost_total", "operation" => operation.word()).increment(runs);
}

/// A job that has ended.
pub(super) fn finished(operation: Operation, ending: &Ending) {
    let outcome = ending.outcome.map_or("none", |outcome| outcome.word());
    let problem = ending.problem.as_ref().map_or("none", |problem| problem.code.word());
    counter!(
        "meshmend_jobs_finished_total",
        "operation" => operation.word(),
        "state" => ending.state.word(),
        "outcome" => outcome,
        "problem" => problem,
    )
    .increment(1);
    let Some(timing) = ending.timing_ms else { return };
    for &stage in Stage::ALL {
        if let Some(ms) = timing.of(stage) {
            histogram!("meshmend_stage_seconds", "stage" => stage.word()).record(ms / 1000.0);
        }
    }
}
