//! What the job service tells the metrics recorder.

use metrics::{counter, gauge, histogram};

use super::store::{Finish, JobCounts};
use crate::wire::{Operation, Stage};

/// Jobs that wait and run, bytes on disk.
pub(super) fn load(counts: JobCounts, data_bytes: u64) {
    gauge!("meshmend_jobs_queued").set(counts.queued as f64);
    gauge!("meshmend_jobs_running").set(counts.running as f64);
    gauge!("meshmend_jobs_kept").set(counts.all as f64);
    gauge!("meshmend_data_bytes").set(data_bytes as f64);
}

/// A job that was answered from an earlier one.
pub(super) fn cached(operation: Operation) {
    counter!("meshmend_jobs_cached_total", "operation" => operation.word()).increment(1);
}

/// The process of a job has ended, in this way.
pub(super) fn child_ended(kind: &'static str) {
    counter!("meshmend_child_exits_total", "kind" => kind).increment(1);
}

/// A job that has ended.
pub(super) fn finished(operation: Operation, finish: &Finish) {
    let outcome = finish.outcome.map_or("none", |outcome| outcome.word());
    let problem = finish.problem.as_ref().map_or("none", |problem| problem.code.word());
    counter!(
        "meshmend_jobs_finished_total",
        "operation" => operation.word(),
        "state" => finish.state.word(),
        "outcome" => outcome,
        "problem" => problem,
    )
    .increment(1);
    let Some(timing) = finish.timing_ms else { return };
    for &stage in Stage::ALL {
        if let Some(ms) = timing.of(stage) {
            histogram!("meshmend_stage_seconds", "stage" => stage.word()).record(ms / 1000.0);
        }
    }
}
