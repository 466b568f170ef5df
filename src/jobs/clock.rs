//! Stage events stamped with times: progress while a run lasts, milliseconds for each pass when it is over.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::budget::{Event, Observer};
use crate::wire::{Operation, Progress, Stage, TimingMs};

/// Hears the stages of one run. Clones share what they heard.
#[derive(Debug, Clone)]
pub struct StageClock {
    started: Instant,
    /// About how many passes the operation makes.
    passes: f64,
    heard: Arc<Mutex<Heard>>,
}

#[derive(Debug, Default)]
struct Heard {
    /// Passes that have begun and not ended; the innermost last.
    open: Vec<(Stage, Instant)>,
    ended: u32,
    timing: TimingMs,
}

impl StageClock {
    /// A clock for a run of `operation` that begins now.
    pub fn start(operation: Operation) -> Self {
        // Read, certify and analyze the input; two lists of steps; write, certify and analyze the output.
        let passes = match operation {
            Operation::Verify => 2.0,
            Operation::Analyze | Operation::Plan => 3.0,
            Operation::Convert => 5.0,
            Operation::CutStitch => 7.0,
            Operation::Repair => 8.0,
            Operation::Simplify => 9.0,
        };
        Self { started: Instant::now(), passes, heard: Arc::default() }
    }

    /// The ear to give to [`Budget::observed_by`](crate::budget::Budget::observed_by).
    pub fn observer(&self) -> Observer {
        let heard = Arc::clone(&self.heard);
        Box::new(move |event| {
            heard.lock().unwrap_or_else(PoisonError::into_inner).hear(event, Instant::now());
        })
    }

    /// How far the run is. Below 1 as long as nobody says that it is over.
    pub fn progress(&self) -> Progress {
        let heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        let stage = heard.open.last().map(|&(stage, _)| stage);
        Progress { stage, fraction: (f64::from(heard.ended) / self.passes).min(0.95) }
    }

    /// Time of each pass that has ended, and of the run so far.
    pub fn timing_ms(&self) -> TimingMs {
        let timing = self.heard.lock().unwrap_or_else(PoisonError::into_inner).timing;
        TimingMs { total: milliseconds(self.started.elapsed()), ..timing }
    }
}

impl Heard {
    fn hear(&mut self, event: Event, now: Instant) {
        match event {
            Event::Enter(stage) => self.open.push((stage.into(), now)),
            Event::Leave(stage) => {
                let Some(position) = self.open.iter().rposition(|&(open, _)| open == stage.into()) else {
                    return;
                };
                let (stage, since) = self.open.remove(position);
                let time = milliseconds(now.duration_since(since));
                *self.timing.of_mut(stage).get_or_insert(0.0) += time;
                self.ended += 1;
            }
        }
    }
}

/// Milliseconds to the microsecond.
fn milliseconds(time: Duration) -> f64 {
    time.as_micros() as f64 / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{self, Budget};

    #[test]
    fn passes_are_timed_and_counted_as_progress() {
        let clock = StageClock::start(Operation::Repair);
        assert_eq!(clock.progress(), Progress { stage: None, fraction: 0.0 });
        let budget = Budget::unlimited().observed_by(clock.observer());
        budget.stage(budget::Stage::Read, || {
            assert_eq!(clock.progress().stage, Some(Stage::Read));
        });
        budget.stage(budget::Stage::Certify, || {});
        budget.stage(budget::Stage::Certify, || {});
        let timing = clock.timing_ms();
        assert!(timing.read.is_some() && timing.certify.is_some());
        assert_eq!(timing.repair, None, "a pass that did not run has no time");
        assert_eq!(clock.progress(), Progress { stage: None, fraction: 3.0 / 8.0 });
    }
}
