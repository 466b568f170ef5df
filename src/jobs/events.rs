//! What happens to a job, one event after the other: changes of its state from the store, passes of its run from this
//! process.
//!
//! An event's id is the number of the state change it belongs to and its place after it. Changes of the state are kept
//! with the job, so who comes back later, also to another process, hears every change since exactly once; passes are
//! heard of the run that goes on.

use std::collections::VecDeque;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;
use tokio::sync::watch;

use super::clock::StageClock;
use super::handle::Jobs;
use super::problems::store_problem;
use super::service::Service;
use super::store::JobId;
use crate::wire::{JobState, Problem, Stage};

/// Longest time after which the store is asked again, for changes that another process made.
const LOOK_EVERY: Duration = Duration::from_secs(2);

/// Place of an event among those of its job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct EventId {
    /// Number of the latest change of the state, from 1.
    pub change: u64,
    /// Number of the event of a pass after it, from 1; 0: the change itself.
    pub pass: usize,
}

impl fmt::Display for EventId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.change, self.pass)
    }
}

/// A text that is no id of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("an event's id is a number, or two with a dot between them")]
pub struct NoEventId;

impl FromStr for EventId {
    type Err = NoEventId;

    fn from_str(text: &str) -> Result<Self, NoEventId> {
        // Nine digits are more than a job has events.
        let is_number =
            |text: &str| (1..=9).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
        // A change by itself is named by its number alone, too.
        let (change, pass) = text.split_once('.').unwrap_or((text, "0"));
        if !is_number(change) || !is_number(pass) {
            return Err(NoEventId);
        }
        Ok(Self {
            change: change.parse().map_err(|_| NoEventId)?,
            pass: pass.parse().map_err(|_| NoEventId)?,
        })
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Happened {
    /// The job has come into this state.
    State {
        /// The state.
        state: JobState,
        /// When.
        at: Timestamp,
    },
    /// A pass of its run has begun or ended.
    Pass {
        /// The pass.
        stage: Stage,
        /// It has ended.
        has_ended: bool,
        /// Share of the passes that are done, from 0 to 1.
        fraction: f64,
    },
}

/// An event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JobEvent {
    /// Its place.
    pub id: EventId,
    /// What it tells.
    pub what: Happened,
}

/// The events of a job from some place on.
#[derive(Debug)]
pub struct JobEventStream {
    service: Arc<Service>,
    job: JobId,
    last: EventId,
    /// The claim that the last change began, and what is heard of its run.
    claim: Option<u32>,
    run: Option<StageClock>,
    pending: VecDeque<JobEvent>,
    has_ended: bool,
}

impl Jobs {
    /// The events of a job after the one with the id `last`. `None`: the job has ended and `last` told that.
    ///
    /// # Errors
    /// `not-found`, `store-unavailable`.
    pub async fn events(&self, job: JobId, last: EventId) -> Result<Option<JobEventStream>, Problem> {
        let row = self.0.row(job).await?;
        let mut events = JobEventStream {
            service: Arc::clone(&self.0),
            job,
            last,
            claim: None,
            run: None,
            pending: VecDeque::new(),
            has_ended: false,
        };
        events.look().await?;
        let is_over = row.state.is_final() && events.pending.is_empty();
        Ok((!is_over).then_some(events))
    }
}

impl JobEventStream {
    /// The next event; `None` after the one that tells the end of the job, when the job is gone, and when the server ends.
    pub async fn next(&mut self) -> Option<JobEvent> {
        loop {
            if let Some(event) = self.pending.pop_front() {
                self.has_ended |= matches!(event.what, Happened::State { state, .. } if state.is_final());
                return Some(event);
            }
            if self.has_ended || self.service.stopping.is_cancelled() {
                return None;
            }
            // Subscribed before the look, so that nothing is missed in between.
            let live = self.service.live.watch(self.job);
            let mut changes = live.job.changes.subscribe();
            let mut passes = live.clock.as_ref().map(StageClock::changes);
            let row = self.service.row(self.job).await;
            if row.as_ref().map_or(true, |row| row.state.is_final()) {
                self.service.live.end(self.job);
            }
            self.look().await.ok()?;
            if !self.pending.is_empty() {
                continue;
            }
            row.ok()?;
            tokio::select! {
                _ = changes.changed() => {}
                () = changed(&mut passes) => {}
                () = live.job.ended.cancelled() => {}
                () = self.service.stopping.cancelled() => {}
                () = tokio::time::sleep(LOOK_EVERY) => {}
            }
        }
    }

    /// Gathers what has happened since the last event.
    async fn look(&mut self) -> Result<(), Problem> {
        // With the last change itself, which says what goes on since.
        let from = self.last.change.saturating_sub(1);
        let changes = self.service.store.changes(self.job, from).await;
        for change in changes.map_err(|error| store_problem(&error))? {
            if change.number > self.last.change {
                // What the run did before comes before the change that ended it.
                self.gather_passes();
                self.run = None;
                self.last = EventId { change: change.number, pass: 0 };
                let what = Happened::State { state: change.state, at: change.at };
                self.pending.push_back(JobEvent { id: self.last, what });
            }
            self.claim = (change.state == JobState::Running).then_some(change.epoch);
        }
        if self.run.is_none() && self.claim.is_some() {
            let live = self.service.live.get(self.job).filter(|live| Some(live.epoch) == self.claim);
            self.run = live.and_then(|live| live.clock.clone());
        }
        self.gather_passes();
        Ok(())
    }

    fn gather_passes(&mut self) {
        let events = self.run.as_ref().map(|run| run.events(self.last.pass));
        for event in events.into_iter().flatten() {
            self.last.pass += 1;
            let what =
                Happened::Pass { stage: event.stage, has_ended: event.has_ended, fraction: event.fraction };
            self.pending.push_back(JobEvent { id: self.last, what });
        }
    }
}

async fn changed(passes: &mut Option<watch::Receiver<usize>>) {
    match passes {
        // The sender lives as long as the run's entry, which is held.
        Some(passes) => drop(passes.changed().await),
        None => std::future::pending().await,
    }
}
