//! How fast jobs go through the slots, by which callers who are refused are told when to come again.

use std::sync::atomic::{AtomicU64, Ordering};

use super::settings::JobsSettings;

/// Mean time of a run before there was one, in milliseconds.
const FIRST_MEAN_MS: u64 = 1000;

/// The pace of the latest runs.
#[derive(Debug)]
pub(super) struct Pace {
    slots: u64,
    deadline_max_s: u64,
    /// Mean time of a run, in milliseconds, the latest ones counting most.
    mean_run_ms: AtomicU64,
}

impl Pace {
    pub(super) fn of(settings: &JobsSettings) -> Self {
        Self {
            slots: settings.slots.max(1) as u64,
            deadline_max_s: settings.deadline_max.as_secs().max(1),
            mean_run_ms: AtomicU64::new(FIRST_MEAN_MS),
        }
    }

    /// Time until a slot takes the next job from the queue, as far as the latest runs tell.
    pub(super) fn retry_after_s(&self) -> u64 {
        let between_claims_ms = self.mean_run_ms.load(Ordering::Relaxed) / self.slots;
        between_claims_ms.div_ceil(1000).clamp(1, self.deadline_max_s)
    }

    /// Counts a run into the mean, with a weight of one eighth.
    pub(super) fn note_run(&self, ms: u64) {
        let mean = |old: u64| Some((old * 7 + ms) / 8);
        // The update never refuses.
        let _ = self.mean_run_ms.fetch_update(Ordering::Relaxed, Ordering::Relaxed, mean);
    }
}
