//! What a run may use: a stop flag, counted work and charged bytes, and the stage events that an observer may stamp.
//!
//! Work units and charged bytes are deterministic counts (never a clock), so a limit on them may decide a result.
//! The stop flag only ends a run; it never changes an output.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// Items a loop may handle between two calls of [`Budget::check`] or [`Budget::spend`].
pub const CHECK_EVERY: usize = 4096;

/// Why a run ended before its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Stopped {
    /// The caller cancelled the run.
    #[error("cancelled")]
    Cancelled,
    /// The caller's deadline passed.
    #[error("deadline passed")]
    Deadline,
    /// The run needed more work units than it was given.
    #[error("work limit of {limit} units reached")]
    Work {
        /// The limit, in work units.
        limit: u64,
    },
    /// The run needed more memory than it was given, or the machine had no more.
    #[error("memory limit of {limit} bytes reached ({wanted} wanted)")]
    Memory {
        /// The limit, in bytes.
        limit: u64,
        /// The total that was asked for, in bytes.
        wanted: u64,
    },
}

/// An error that may be the end of a budget.
pub trait AsStopped {
    /// That end, if it is one.
    fn as_stopped(&self) -> Option<Stopped>;
}

impl AsStopped for Stopped {
    fn as_stopped(&self) -> Option<Stopped> {
        Some(*self)
    }
}

/// A pass of the engine, as progress and timing name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Bytes to soup.
    Read,
    /// Report of the mesh as it is.
    Analyze,
    /// Repair steps.
    Repair,
    /// Fewer triangles.
    Simplify,
    /// Mesh to bytes.
    Write,
    /// The exact check of bytes.
    Certify,
    /// How far the result is from the input.
    Measure,
    /// A picture.
    Draw,
}

impl Stage {
    /// Every stage, in the order of a full run.
    pub const ALL: [Self; 8] = [
        Self::Read,
        Self::Analyze,
        Self::Repair,
        Self::Simplify,
        Self::Write,
        Self::Certify,
        Self::Measure,
        Self::Draw,
    ];

    /// The stage's name in reports and metrics.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Analyze => "analyze",
            Self::Repair => "repair",
            Self::Simplify => "simplify",
            Self::Write => "write",
            Self::Certify => "certify",
            Self::Measure => "measure",
            Self::Draw => "draw",
        }
    }
}

/// What an observer hears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProgressEvent {
    /// A stage begins.
    Enter(Stage),
    /// The stage ends (also when it failed).
    Leave(Stage),
    /// So many work units are used by now; told now and then, in any order.
    Work(u64),
}

/// Hears events and may stamp them with times. Stages are told from the thread that runs the engine, work from any.
pub type Observer = Box<dyn Fn(ProgressEvent) + Send + Sync>;

/// Work units of which the observer is told first: a millisecond or so.
const WORK_TOLD_FIRST: u64 = 1 << 12;

const RUN: u8 = 0;
const CANCELLED: u8 = 1;
const DEADLINE: u8 = 2;

/// Ends a run from another thread. Clones share the flag.
#[derive(Debug, Clone, Default)]
pub struct StopFlag(Arc<AtomicU8>);

impl StopFlag {
    /// Asks the run to end as cancelled. The first reason given stays.
    pub fn cancel(&self) {
        self.raise(CANCELLED);
    }

    /// Asks the run to end because its deadline passed. The first reason given stays.
    pub fn pass_deadline(&self) {
        self.raise(DEADLINE);
    }

    fn raise(&self, reason: u8) {
        // Ok or Err both leave a reason in place.
        let _ = self.0.compare_exchange(RUN, reason, Ordering::Relaxed, Ordering::Relaxed);
    }

    /// The reason to end, if one was given.
    pub fn raised(&self) -> Option<Stopped> {
        match self.0.load(Ordering::Relaxed) {
            RUN => None,
            CANCELLED => Some(Stopped::Cancelled),
            _ => Some(Stopped::Deadline),
        }
    }
}

/// The limits of one run and what it has used. Shared by reference between the engine's threads.
///
/// ```
/// use meshmend::budget::{Budget, StopFlag, Stopped};
///
/// let stop = StopFlag::default();
/// // At most a million units of work and a gibibyte.
/// let budget = Budget::new(stop.clone(), 1_000_000, 1 << 30);
/// assert_eq!(budget.spend(400_000), Ok(()));
/// assert_eq!(budget.spend(600_001), Err(Stopped::Work { limit: 1_000_000 }));
/// // Another thread may end the run.
/// stop.cancel();
/// assert_eq!(budget.check(), Err(Stopped::Cancelled));
/// ```
pub struct Budget {
    stop: StopFlag,
    work: AtomicU64,
    work_max: u64,
    /// The limit of the innermost share in force. The caller's own limit makes no share smaller: it ends the run.
    share_limit: AtomicU64,
    /// Work units at which the observer is told of them next.
    work_told_at: AtomicU64,
    bytes: AtomicU64,
    bytes_peak: AtomicU64,
    bytes_max: u64,
    observer: Option<Observer>,
}

impl fmt::Debug for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Budget")
            .field("work", &self.work)
            .field("work_max", &self.work_max)
            .field("bytes", &self.bytes)
            .field("bytes_max", &self.bytes_max)
            .finish_non_exhaustive()
    }
}

impl Default for Budget {
    fn default() -> Self {
        Self::unlimited()
    }
}

impl Budget {
    /// No limit and no observer.
    pub fn unlimited() -> Self {
        Self::new(StopFlag::default(), u64::MAX, u64::MAX)
    }

    /// Limits in work units and bytes; `stop` ends the run from outside.
    pub fn new(stop: StopFlag, work_max: u64, bytes_max: u64) -> Self {
        Self {
            stop,
            work: AtomicU64::new(0),
            work_max,
            share_limit: AtomicU64::new(u64::MAX),
            work_told_at: AtomicU64::new(WORK_TOLD_FIRST),
            bytes: AtomicU64::new(0),
            bytes_peak: AtomicU64::new(0),
            bytes_max,
            observer: None,
        }
    }

    /// The same budget with `observer` told of every stage.
    #[must_use]
    pub fn observed_by(mut self, observer: Observer) -> Self {
        self.observer = Some(observer);
        self
    }

    /// Fails when the run must end. Cheap: call it at least every [`CHECK_EVERY`] items.
    pub fn check(&self) -> Result<(), Stopped> {
        match self.stop.raised() {
            None => Ok(()),
            Some(reason) => Err(reason),
        }
    }

    /// Counts `units` of work, then [checks](Self::check).
    pub fn spend(&self, units: u64) -> Result<(), Stopped> {
        let used = self.work.fetch_add(units, Ordering::Relaxed).saturating_add(units);
        if used > self.work_max {
            return Err(Stopped::Work { limit: self.work_max });
        }
        let limit = self.share_limit.load(Ordering::Relaxed);
        if used > limit {
            return Err(Stopped::Work { limit });
        }
        if used >= self.work_told_at.load(Ordering::Relaxed) {
            self.tell_work(used);
        }
        self.check()
    }

    /// Runs `body`, which may use up to `units` of work; `None` when it needs more, and so many are counted then. Shares may lie
    /// within each other, but not side by side in several threads. Whether one is enough depends on the sum of what is spent
    /// in it, so it is the same with any number of threads as long as all of them end before an error is passed on.
    ///
    /// # Errors
    /// Those of `body`, and the end of what the share is a part of.
    pub fn within<T, E: From<Stopped> + AsStopped>(
        &self,
        units: u64,
        body: impl FnOnce() -> Result<T, E>,
    ) -> Result<Option<T>, E> {
        let outer = self.share_limit.load(Ordering::Relaxed);
        let limit = self.work_used().saturating_add(units);
        if limit >= outer {
            return body().map(Some);
        }
        self.share_limit.store(limit, Ordering::Relaxed);
        let result = body();
        self.share_limit.store(outer, Ordering::Relaxed);
        match result {
            Err(error) if limit != self.work_max && error.as_stopped() == Some(Stopped::Work { limit }) => {
                // What other threads spent beyond it depends on their number.
                self.work.store(limit, Ordering::Relaxed);
                self.check()?;
                Ok(None)
            }
            result => result.map(Some),
        }
    }

    /// As [`within`](Self::within), with one `part`th of what is left.
    ///
    /// # Errors
    /// Those of `body`, and the end of what the share is a part of.
    pub fn within_part<T, E: From<Stopped> + AsStopped>(
        &self,
        part: u64,
        body: impl FnOnce() -> Result<T, E>,
    ) -> Result<Option<T>, E> {
        self.within(self.work_left() / part.max(1), body)
    }

    /// As [`within`](Self::within), with all that is left but one `part`th of it.
    ///
    /// # Errors
    /// Those of `body`, and the end of what the share is a part of.
    pub fn within_all_but<T, E: From<Stopped> + AsStopped>(
        &self,
        part: u64,
        body: impl FnOnce() -> Result<T, E>,
    ) -> Result<Option<T>, E> {
        let left = self.work_left();
        self.within(left - left / part.max(1), body)
    }

    /// Tells the observer of the work, and the next time when there is a 32nd more: a few hundred times in the longest run.
    fn tell_work(&self, used: u64) {
        let before = self.work_told_at.fetch_max(used.saturating_add(1 + used / 32), Ordering::Relaxed);
        // One of the threads that came here at once.
        if before <= used {
            self.tell(ProgressEvent::Work(used));
        }
    }

    /// Charges `bytes` until the returned guard is dropped.
    pub fn charge(&self, bytes: u64) -> Result<Charge<'_>, Stopped> {
        self.check()?;
        let wanted = self.bytes.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
        let charge = Charge { budget: self, bytes };
        if wanted > self.bytes_max {
            return Err(Stopped::Memory { limit: self.bytes_max, wanted });
        }
        self.bytes_peak.fetch_max(wanted, Ordering::Relaxed);
        Ok(charge)
    }

    /// A vector with room for `len` items, charged; fails instead of aborting when there is no memory.
    pub fn vec<T>(&self, len: usize) -> Result<(Vec<T>, Charge<'_>), Stopped> {
        let bytes = (len as u64).saturating_mul(size_of::<T>() as u64);
        let charge = self.charge(bytes)?;
        let mut items = Vec::new();
        if items.try_reserve_exact(len).is_err() {
            return Err(Stopped::Memory { limit: self.bytes_max, wanted: bytes });
        }
        Ok((items, charge))
    }

    /// Makes room for `additional` more items and charges the growth; fails instead of aborting when there is no
    /// memory.
    pub fn reserve<T>(&self, items: &mut Vec<T>, additional: usize) -> Result<Charge<'_>, Stopped> {
        let before = items.capacity();
        if items.try_reserve(additional).is_err() {
            let wanted = (before.saturating_add(additional) as u64).saturating_mul(size_of::<T>() as u64);
            return Err(Stopped::Memory { limit: self.bytes_max, wanted });
        }
        self.charge(((items.capacity() - before) * size_of::<T>()) as u64)
    }

    /// Runs `body` as `stage`: the observer hears when it begins and ends.
    pub fn stage<T>(&self, stage: Stage, body: impl FnOnce() -> T) -> T {
        self.tell(ProgressEvent::Enter(stage));
        let result = body();
        self.tell(ProgressEvent::Leave(stage));
        result
    }

    fn tell(&self, event: ProgressEvent) {
        if let Some(observer) = &self.observer {
            observer(event);
        }
    }

    /// Work units that are left of the share in force; the caller's limit does not count.
    pub fn work_left(&self) -> u64 {
        self.share_limit.load(Ordering::Relaxed).saturating_sub(self.work_used())
    }

    /// Work units used so far.
    pub fn work_used(&self) -> u64 {
        self.work.load(Ordering::Relaxed)
    }

    /// The largest number of bytes charged at one time so far.
    pub fn bytes_peak(&self) -> u64 {
        self.bytes_peak.load(Ordering::Relaxed)
    }
}

/// Bytes charged to a [`Budget`]; given back on drop.
#[derive(Debug)]
#[must_use = "the bytes are given back when the charge is dropped"]
pub struct Charge<'b> {
    budget: &'b Budget,
    bytes: u64,
}

impl Drop for Charge<'_> {
    fn drop(&mut self) {
        self.budget.bytes.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_reason_to_stop_stays() {
        let stop = StopFlag::default();
        let budget = Budget::new(stop.clone(), 10, 100);
        assert_eq!(budget.check(), Ok(()));
        stop.pass_deadline();
        stop.cancel();
        assert_eq!(budget.check(), Err(Stopped::Deadline));
    }

    #[test]
    fn work_past_the_limit_is_refused() {
        let budget = Budget::new(StopFlag::default(), 10, 100);
        assert_eq!(budget.spend(10), Ok(()));
        assert_eq!(budget.spend(1), Err(Stopped::Work { limit: 10 }));
    }

    #[test]
    fn a_share_of_the_work_ends_without_ending_the_run() {
        let budget = Budget::new(StopFlag::default(), 100, 100);
        let budget = &budget;
        let needs = |units: u64| {
            move || {
                (0..units).try_for_each(|_| budget.spend(1))?;
                Ok::<_, Stopped>(units)
            }
        };
        assert_eq!(budget.within(10, needs(10)), Ok(Some(10)));
        assert_eq!(budget.within(10, needs(11)), Ok(None));
        assert_eq!(budget.work_used(), 20, "what is over a share is not counted");
        // The inner share ends the outer one too where that has no more.
        let nested = budget.within(5, || budget.within(50, needs(6)));
        assert_eq!((nested, budget.work_used()), (Ok(None), 25));
        let nested = budget.within(50, || Ok::<_, Stopped>((budget.within(5, needs(6))?, needs(3)()?)));
        assert_eq!(nested, Ok(Some((None, 3))));
        assert_eq!(budget.within(1000, needs(1000)), Err(Stopped::Work { limit: 100 }));
    }

    #[test]
    fn charged_bytes_are_given_back_and_their_peak_is_kept() {
        let budget = Budget::new(StopFlag::default(), 10, 100);
        {
            let (items, _charge) = budget.vec::<u64>(10).unwrap();
            assert!(items.capacity() >= 10);
            assert_eq!(budget.charge(21).unwrap_err(), Stopped::Memory { limit: 100, wanted: 101 });
        }
        {
            let mut items = vec![0u8; 10];
            let _charge = budget.reserve(&mut items, 50).unwrap();
            assert!(budget.reserve(&mut items, 500).is_err());
        }
        assert!(budget.charge(100).is_ok());
        assert_eq!(budget.bytes_peak(), 100);
    }
}
