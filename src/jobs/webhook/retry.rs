//! When a delivery is tried again.

use std::time::Duration;

/// Longest pause between two attempts.
const PAUSE_MAX: Duration = Duration::from_secs(6 * 60 * 60);
/// Each pause is that many times the one before.
const GROWTH: u32 = 4;

/// How often, and how long to wait in between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RetryPlan {
    /// Attempts in all.
    pub attempts_max: u32,
    /// Pause after the first attempt.
    pub first_pause: Duration,
}

/// What an attempt led to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Next {
    /// It was taken.
    Delivered,
    /// It is tried again after this pause.
    Retry(Duration),
    /// It is given up.
    GiveUp,
}

impl RetryPlan {
    /// What to do after `attempts` attempts, the last of which was answered with `status` (`None`: not at all) and
    /// perhaps with a wish when to come again. `jitter` is a random number from 0 to 1.
    pub(super) fn after(
        &self,
        attempts: u32,
        status: Option<u16>,
        retry_after: Option<Duration>,
        jitter: f64,
    ) -> Next {
        match status {
            Some(200..=299) => Next::Delivered,
            // Gone: the endpoint asks not to be called again.
            Some(410) => Next::GiveUp,
            _ if attempts >= self.attempts_max => Next::GiveUp,
            _ => {
                let steps = attempts.saturating_sub(1).min(16);
                let full = self.first_pause.saturating_mul(GROWTH.saturating_pow(steps)).min(PAUSE_MAX);
                // From half to the whole, so that what failed together does not come back together.
                let pause = full.mul_f64(0.5 + jitter.clamp(0.0, 1.0) / 2.0);
                Next::Retry(pause.max(retry_after.unwrap_or_default().min(PAUSE_MAX)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAN: RetryPlan = RetryPlan { attempts_max: 5, first_pause: Duration::from_secs(8) };

    fn pause(attempts: u32, jitter: f64) -> u64 {
        match PLAN.after(attempts, Some(500), None, jitter) {
            Next::Retry(pause) => pause.as_secs(),
            next => panic!("{next:?}"),
        }
    }

    #[test]
    fn pauses_grow_and_are_spread_over_half_of_their_length() {
        assert_eq!([pause(1, 0.0), pause(1, 1.0)], [4, 8]);
        assert_eq!([pause(2, 0.0), pause(2, 1.0)], [16, 32]);
        assert_eq!([pause(3, 0.5), pause(4, 1.0)], [96, 512]);
    }

    #[test]
    fn a_pause_is_never_longer_than_six_hours() {
        let plan = RetryPlan { attempts_max: 99, first_pause: Duration::from_secs(60) };
        assert_eq!(plan.after(90, None, Some(Duration::MAX), 1.0), Next::Retry(PAUSE_MAX));
    }

    #[test]
    fn the_last_attempt_and_an_endpoint_that_is_gone_end_it() {
        assert_eq!(PLAN.after(5, Some(503), None, 0.0), Next::GiveUp);
        assert_eq!(PLAN.after(1, Some(410), None, 0.0), Next::GiveUp);
        assert_eq!(PLAN.after(5, Some(204), None, 0.0), Next::Delivered);
    }

    #[test]
    fn an_endpoint_that_asks_for_more_time_gets_it() {
        let asked = Duration::from_secs(600);
        assert_eq!(PLAN.after(1, Some(429), Some(asked), 0.0), Next::Retry(asked));
        assert_eq!(PLAN.after(1, Some(302), None, 1.0), Next::Retry(Duration::from_secs(8)));
    }
}
