//! Stage events stamped with times: progress while a run lasts, milliseconds for each pass when it is over.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::watch;

use crate::budget::{Observer, ProgressEvent};
use crate::pipeline;
use crate::wire::{Operation, Progress, Stage, TimingMs};

/// Most events of one run that are kept for those who follow it; no operation makes so many.
const EVENTS_MAX: usize = 512;

/// Hears the stages of one run. Clones share what they heard.
#[derive(Debug, Clone)]
pub struct StageClock {
    started: Instant,
    /// About how many passes the operation makes.
    passes: f64,
    heard: Arc<Mutex<Heard>>,
    /// Counts the events.
    changes: Arc<watch::Sender<usize>>,
}

/// A pass has begun or ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StageEvent {
    pub(super) stage: Stage,
    pub(super) has_ended: bool,
    /// How far the run is, from 0 to 1.
    pub(super) fraction: f64,
}

/// How far a run is that makes as many passes as is usual. Those beyond them share what is left.
const USUAL_PASSES_TO: f64 = 0.8;
/// Share of what is left that each pass beyond the usual ones takes.
const PASS_BEYOND: f64 = 0.1;
/// Fewest work units that a pass is taken to have before it is half done.
const WORK_HALF_MIN: u64 = 1 << 16;

#[derive(Debug, Default)]
struct Heard {
    /// Passes that have begun and not ended; the innermost last.
    open: Vec<(Stage, Instant)>,
    /// The pass that began last.
    last: Option<Stage>,
    ended: u32,
    /// How far the run was when the last pass ended, and the work that it had used.
    base: f64,
    work_at_base: u64,
    work: u64,
    timing: TimingMs,
    events: Vec<StageEvent>,
}

impl StageClock {
    /// A clock for a run of `operation` that begins now.
    pub fn start(operation: Operation) -> Self {
        let passes = pipeline::Operation::from(operation).facts().passes;
        Self { started: Instant::now(), passes, heard: Arc::default(), changes: Arc::default() }
    }

    /// The ear to give to [`Budget::observed_by`](crate::budget::Budget::observed_by).
    pub fn observer(&self) -> Observer {
        let clock = self.clone();
        Box::new(move |event| {
            let mut heard = clock.heard.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some((stage, has_ended)) = heard.hear(event, Instant::now(), clock.passes)
                && heard.events.len() < EVENTS_MAX
            {
                let fraction = heard.fraction(clock.passes);
                heard.events.push(StageEvent { stage, has_ended, fraction });
                clock.changes.send_replace(heard.events.len());
            }
        })
    }

    /// How far the run is and what it does, or did last. Never less than before, and below 1 as long as nobody says that it
    /// is over.
    pub fn progress(&self) -> Progress {
        let heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        let stage = heard.open.last().map(|&(stage, _)| stage).or(heard.last);
        Progress { stage, fraction: heard.fraction(self.passes) }
    }

    /// The events after the first `after`.
    pub(super) fn events(&self, after: usize) -> Vec<StageEvent> {
        let heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        heard.events.get(after..).unwrap_or_default().to_vec()
    }

    /// Changes when there is another event.
    pub(super) fn changes(&self) -> watch::Receiver<usize> {
        self.changes.subscribe()
    }

    /// Time of each pass that has ended, and of the run so far.
    pub fn timing_ms(&self) -> TimingMs {
        let timing = self.heard.lock().unwrap_or_else(PoisonError::into_inner).timing;
        TimingMs { total: milliseconds(self.started.elapsed()), ..timing }
    }
}

impl Heard {
    /// How far the run is: from the end of the last pass towards the end of the next one, by the work between.
    fn fraction(&self, passes: f64) -> f64 {
        let done = self.work.saturating_sub(self.work_at_base) as f64;
        // As much work as all before is half of a pass: nobody knows how much there is, but it always comes closer.
        let half = self.work_at_base.max(WORK_HALF_MIN) as f64;
        self.base + (self.next_base(passes) - self.base) * done / (done + half)
    }

    /// How far the run is when the next pass has ended.
    fn next_base(&self, passes: f64) -> f64 {
        let usual_left = passes - f64::from(self.ended);
        if usual_left >= 1.0 {
            self.base + (USUAL_PASSES_TO - self.base) / usual_left
        } else {
            self.base + (1.0 - self.base) * PASS_BEYOND
        }
    }

    /// The pass, and whether it has ended; `None`: it is about work, or a pass has ended that had not begun.
    fn hear(&mut self, event: ProgressEvent, now: Instant, passes: f64) -> Option<(Stage, bool)> {
        match event {
            ProgressEvent::Work(units) => {
                self.work = self.work.max(units);
                None
            }
            ProgressEvent::Enter(stage) => {
                self.open.push((stage.into(), now));
                self.last = Some(stage.into());
                Some((stage.into(), false))
            }
            ProgressEvent::Leave(stage) => {
                let position = self.open.iter().rposition(|&(open, _)| open == stage.into())?;
                let (stage, since) = self.open.remove(position);
                let time = milliseconds(now.duration_since(since));
                let sum = self.timing.of_mut(stage).get_or_insert(0.0);
                *sum = to_the_microsecond(*sum + time);
                self.base = self.next_base(passes);
                self.work_at_base = self.work;
                self.ended += 1;
                Some((stage, true))
            }
        }
    }
}

/// Milliseconds to the microsecond.
fn milliseconds(time: Duration) -> f64 {
    time.as_micros() as f64 / 1000.0
}

/// Milliseconds with three decimals at most: a sum of such has more, by its rounding.
fn to_the_microsecond(milliseconds: f64) -> f64 {
    (milliseconds * 1000.0).round() / 1000.0
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
        let event = |stage, has_ended, ended: f64| StageEvent { stage, has_ended, fraction: ended / 10.0 };
        assert_eq!(
            clock.events(0)[..3],
            [
                event(Stage::Read, false, 0.0),
                event(Stage::Read, true, 1.0),
                event(Stage::Certify, false, 1.0)
            ]
        );
        assert_eq!((clock.events(4).len(), clock.events(9).len()), (2, 0));
        let timing = clock.timing_ms();
        assert!(timing.read.is_some() && timing.certify.is_some());
        assert_eq!(timing.repair, None, "a pass that did not run has no time");
        let progress = clock.progress();
        assert_eq!(progress.stage, Some(Stage::Certify), "what was done last");
        assert!((progress.fraction - 0.3).abs() < 1e-12, "{}", progress.fraction);
    }

    #[test]
    fn a_pass_that_runs_often_has_a_time_of_three_decimals() {
        let mut heard = Heard::default();
        let begun = Instant::now();
        for _ in 0..10 {
            heard.hear(ProgressEvent::Enter(budget::Stage::Certify), begun, 5.0);
            heard.hear(ProgressEvent::Leave(budget::Stage::Certify), begun + Duration::from_micros(21), 5.0);
        }
        assert_eq!(serde_json::to_value(heard.timing).unwrap()["certify"].to_string(), "0.21");
    }

    #[test]
    fn a_long_repair_moves_with_every_pass_and_with_the_work_of_each_and_never_back() {
        let clock = StageClock::start(Operation::Repair);
        let hear = clock.observer();
        let (mut work, mut last) = (0, 0.0);
        let mut farther = || {
            let fraction = clock.progress().fraction;
            assert!(last < fraction && fraction < 1.0, "{last} {fraction}");
            last = fraction;
        };
        for pass in 0..100 {
            let stage = [budget::Stage::Repair, budget::Stage::Certify][pass % 2];
            hear(ProgressEvent::Enter(stage));
            for _ in 0..10 {
                work += 1 << 20;
                hear(ProgressEvent::Work(work));
                farther();
            }
            // Threads may tell it late.
            hear(ProgressEvent::Work(work / 2));
            hear(ProgressEvent::Leave(stage));
            farther();
        }
        assert!(last > 0.99);
    }
}
