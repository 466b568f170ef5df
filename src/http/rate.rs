//! How many requests one caller may make: a bucket for each, told in `RateLimit` headers (IETF draft
//! `ratelimit-headers`, version 10).

use std::num::NonZeroU32;
use std::time::Duration;

use axum::http::{HeaderMap, HeaderName, HeaderValue};
use governor::clock::{Clock as _, DefaultClock};
use governor::middleware::StateInformationMiddleware;
use governor::state::keyed::DefaultKeyedStateStore;
use governor::{Quota, RateLimiter};

use crate::jobs::Tenant;
use crate::wire::{Problem, ProblemCode};

const LIMIT: HeaderName = HeaderName::from_static("ratelimit");
const POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");

/// What the operator allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RateSettings {
    /// Requests of one caller in a minute.
    pub per_minute: NonZeroU32,
    /// Requests of one caller at one time.
    pub burst: NonZeroU32,
}

impl Default for RateSettings {
    /// Twenty a second, and for a moment as many as a page or a script that begins may send.
    fn default() -> Self {
        let number = |number| NonZeroU32::new(number).unwrap_or(NonZeroU32::MIN);
        Self { per_minute: number(1200), burst: number(240) }
    }
}

/// The buckets of all callers.
#[derive(Debug)]
pub(super) struct Rates {
    limiter: RateLimiter<Tenant, DefaultKeyedStateStore<Tenant>, DefaultClock, StateInformationMiddleware>,
    settings: RateSettings,
}

/// How full a caller's bucket is after a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Standing {
    settings: RateSettings,
    remaining: u32,
    /// Until the bucket is full again, or, when it is empty, until it is not.
    reset: Duration,
}

impl Rates {
    pub(super) fn new(settings: RateSettings) -> Self {
        let quota = Quota::per_minute(settings.per_minute).allow_burst(settings.burst);
        let limiter = RateLimiter::keyed(quota).with_middleware::<StateInformationMiddleware>();
        Self { limiter, settings }
    }

    /// Counts a request. Its standing, and the refusal if there were too many.
    pub(super) fn count(&self, tenant: &Tenant) -> (Standing, Option<Problem>) {
        let settings = self.settings;
        match self.limiter.check_key(tenant) {
            Ok(state) => {
                let remaining = state.remaining_burst_capacity();
                let used = settings.burst.get().saturating_sub(remaining);
                let reset = state.quota().replenish_interval().saturating_mul(used);
                (Standing { settings, remaining, reset }, None)
            }
            Err(early) => {
                let reset = early.wait_time_from(DefaultClock::default().now());
                let standing = Standing { settings, remaining: 0, reset };
                (standing, Some(standing.refusal()))
            }
        }
    }

    /// Forgets callers whose buckets are full.
    pub(super) fn forget_idle(&self) {
        self.limiter.retain_recent();
        self.limiter.shrink_to_fit();
    }
}

impl Standing {
    fn refusal(self) -> Problem {
        let per_minute = u64::from(self.settings.per_minute.get());
        let detail = format!("more than {per_minute} requests a minute");
        Problem {
            retry_after_s: Some(self.reset_s().max(1)),
            ..Problem::new(ProblemCode::RateLimited, detail).with_limit("rate_per_minute", per_minute, None)
        }
    }

    fn reset_s(self) -> u64 {
        self.reset.as_millis().div_ceil(1000).try_into().unwrap_or(u64::MAX)
    }

    /// Tells the caller.
    pub(super) fn tell(self, headers: &mut HeaderMap) {
        let RateSettings { per_minute, burst } = self.settings;
        let policy = format!("\"burst\";q={burst}, \"minute\";q={per_minute};w=60");
        let limit = format!("\"burst\";r={};t={}", self.remaining, self.reset_s());
        for (name, value) in [(POLICY, policy), (LIMIT, limit)] {
            if let Ok(value) = HeaderValue::from_str(&value) {
                headers.insert(name, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rates(per_minute: u32, burst: u32) -> Rates {
        let number = |n| NonZeroU32::new(n).unwrap();
        Rates::new(RateSettings { per_minute: number(per_minute), burst: number(burst) })
    }

    fn owner(name: &str) -> Tenant {
        Tenant::named(name)
    }

    #[test]
    fn a_caller_who_uses_up_the_burst_is_told_when_to_come_again_and_others_are_not_touched() {
        let rates = rates(1, 2);
        assert_eq!(rates.count(&owner("shop")).1, None);
        assert_eq!(rates.count(&owner("shop")).1, None);
        let (_, refusal) = rates.count(&owner("shop"));
        let refusal = refusal.unwrap();
        assert_eq!(
            (refusal.code, refusal.limit_name.as_deref()),
            (ProblemCode::RateLimited, Some("rate_per_minute"))
        );
        assert!((1..=60).contains(&refusal.retry_after_s.unwrap()), "{refusal:?}");
        assert_eq!(rates.count(&owner("farm")).1, None);
    }

    #[test]
    fn the_headers_say_what_is_allowed_and_what_is_left() {
        let mut headers = HeaderMap::new();
        rates(60, 5).count(&owner("shop")).0.tell(&mut headers);
        assert_eq!(headers[POLICY], "\"burst\";q=5, \"minute\";q=60;w=60");
        assert_eq!(headers[LIMIT], "\"burst\";r=4;t=1");
    }

    #[test]
    fn callers_whose_bucket_is_full_are_forgotten() {
        let rates = rates(60_000, 1);
        for n in 0..100 {
            rates.count(&owner(&n.to_string()));
        }
        std::thread::sleep(Duration::from_millis(20));
        rates.forget_idle();
        assert!(rates.limiter.is_empty());
    }
}
