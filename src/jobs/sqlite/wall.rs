//! The time of day, as far as it can be believed. A clock that jumps is said, and followed only when it stays where it is: a
//! glitch of years must neither date jobs nor expire results.

use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use jiff::Timestamp;

/// Further than that no clock is set in ordinary use. Summer time is no jump, since times here have no zone.
const JUMP: Duration = Duration::from_secs(60 * 60);
/// For how long a clock that has jumped must go on from there.
const STAYS: Duration = Duration::from_secs(10 * 60);

/// The time of day in milliseconds since 1970.
pub(super) fn now_ms() -> i64 {
    static CLOCK: OnceLock<(Instant, Mutex<Believed>)> = OnceLock::new();
    let told_ms = Timestamp::now().as_millisecond();
    let (start, believed) = CLOCK.get_or_init(|| (Instant::now(), Mutex::new(Believed::from(told_ms))));
    let mut believed = believed.lock().unwrap_or_else(PoisonError::into_inner);
    believed.hear(told_ms, millis(start.elapsed()))
}

/// Time since this process first asked, in milliseconds. It goes on evenly, however the time of day is set.
pub(super) fn even_ms() -> i64 {
    static START: OnceLock<Instant> = OnceLock::new();
    millis(START.get_or_init(Instant::now).elapsed())
}

fn millis(time: Duration) -> i64 {
    i64::try_from(time.as_millis()).unwrap_or(i64::MAX)
}

/// What is thought of a clock.
#[derive(Debug)]
struct Believed {
    /// The time of day at the start.
    start_ms: i64,
    /// The latest one given: within a jump's width none is given that is earlier.
    latest_ms: i64,
    /// Since when, after the start, the clock tells another time.
    doubted_since_ms: Option<i64>,
}

impl From<i64> for Believed {
    fn from(told_ms: i64) -> Self {
        Self { start_ms: told_ms, latest_ms: told_ms, doubted_since_ms: None }
    }
}

impl Believed {
    /// The time to go by when the clock tells `told_ms`, so long after the start.
    fn hear(&mut self, told_ms: i64, elapsed_ms: i64) -> i64 {
        let expected_ms = self.start_ms.saturating_add(elapsed_ms);
        let ahead_ms = told_ms.saturating_sub(expected_ms);
        if ahead_ms.unsigned_abs() <= millis(JUMP).unsigned_abs() {
            if self.doubted_since_ms.take().is_some() {
                tracing::warn!("the system's clock is back where it was expected");
            }
            self.follow(told_ms, elapsed_ms);
            self.latest_ms = self.latest_ms.max(told_ms);
            return self.latest_ms;
        }
        match self.doubted_since_ms {
            None => {
                tracing::warn!(
                    seconds = ahead_ms / 1000,
                    "the system's clock has jumped; its time is not taken yet"
                );
                self.doubted_since_ms = Some(elapsed_ms);
            }
            Some(since_ms) if elapsed_ms - since_ms >= millis(STAYS) => {
                tracing::warn!(
                    seconds = ahead_ms / 1000,
                    "the system's clock stays where it jumped to; its time is taken"
                );
                self.doubted_since_ms = None;
                self.follow(told_ms, elapsed_ms);
                self.latest_ms = told_ms;
                return told_ms;
            }
            Some(_) => {}
        }
        self.latest_ms = self.latest_ms.max(expected_ms);
        self.latest_ms
    }

    /// From here on the time goes on from what the clock tells.
    fn follow(&mut self, told_ms: i64, elapsed_ms: i64) {
        self.start_ms = told_ms.saturating_sub(elapsed_ms);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR_MS: i64 = 3_600_000;

    #[test]
    fn small_corrections_are_followed_and_the_time_never_goes_back_for_them() {
        let mut clock = Believed::from(1_000_000);
        assert_eq!(clock.hear(1_000_500, 500), 1_000_500);
        assert_eq!(clock.hear(1_000_000, 600), 1_000_500, "set back by 600 ms");
        assert_eq!(clock.hear(1_000_600, 1200), 1_000_600);
        assert_eq!(clock.hear(1_000_700 + HOUR_MS, 1300), 1_000_700 + HOUR_MS, "set forward by an hour");
    }

    #[test]
    fn a_glitch_leaves_no_trace() {
        let mut clock = Believed::from(0);
        let centuries = 200 * 365 * 24 * HOUR_MS;
        assert_eq!(clock.hear(centuries + 1000, 1000), 1000);
        assert_eq!(clock.hear(centuries + 2000, 2000), 2000);
        assert_eq!(clock.hear(3000, 3000), 3000);
        assert_eq!(clock.hear(-centuries, 4000), 4000);
        assert_eq!(clock.hear(5000, 5000), 5000);
    }

    #[test]
    fn a_clock_that_stays_where_it_jumped_to_is_followed() {
        let stays = millis(STAYS);
        for jump in [2 * HOUR_MS, -2 * HOUR_MS] {
            let mut clock = Believed::from(0);
            assert_eq!(clock.hear(jump + 1000, 1000), 1000);
            assert_eq!(clock.hear(jump + stays, stays), stays);
            assert_eq!(clock.hear(jump + 1000 + stays, 1000 + stays), jump + 1000 + stays);
            assert_eq!(clock.hear(jump + 2000 + stays, 2000 + stays), jump + 2000 + stays);
        }
    }
}
