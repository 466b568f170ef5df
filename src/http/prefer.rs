//! How long the client is ready to wait for its job (`Prefer`, RFC 7240).

use std::time::Duration;

use axum::http::{HeaderMap, HeaderValue};

/// Wait when the client does not say.
pub(super) const WAIT_DEFAULT: Duration = Duration::from_secs(60);
/// Longest wait; a longer one is shortened to it.
pub(super) const WAIT_MAX: Duration = Duration::from_secs(300);

/// A wait, and what to tell the client about its wish.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Wait {
    /// How long to wait for the job before answering 202.
    pub(super) duration: Duration,
    /// Value of `Preference-Applied`.
    pub(super) applied: Option<String>,
}

impl Wait {
    /// Reads `Prefer`. A preference that is unknown or malformed is ignored, as RFC 7240 asks; of two the first counts.
    pub(super) fn from_headers(headers: &HeaderMap) -> Self {
        let mut seconds = None;
        let mut is_async = false;
        for preference in preferences(headers) {
            let (name, value) = preference.split_once('=').unwrap_or((preference, ""));
            match name.trim().to_ascii_lowercase().as_str() {
                "respond-async" => is_async = true,
                "wait" if seconds.is_none() => seconds = seconds_of(value.trim().trim_matches('"')),
                _ => {}
            }
        }
        Self::new(seconds, is_async)
    }

    /// A wait of `seconds` as a query parameter asks for it.
    pub(super) fn of_seconds(seconds: Option<u64>) -> Self {
        match seconds {
            Some(seconds) => Self::new(Some(seconds), false),
            None => Self { duration: Duration::ZERO, applied: None },
        }
    }

    fn new(seconds: Option<u64>, is_async: bool) -> Self {
        let granted = seconds.map(|s| s.min(WAIT_MAX.as_secs()));
        let duration = match (granted, is_async) {
            (Some(granted), _) => Duration::from_secs(granted),
            (None, true) => Duration::ZERO,
            (None, false) => WAIT_DEFAULT,
        };
        let applied = [is_async.then(|| "respond-async".to_owned()), granted.map(|s| format!("wait={s}"))];
        let applied = applied.into_iter().flatten().collect::<Vec<_>>().join(", ");
        Self { duration, applied: (!applied.is_empty()).then_some(applied) }
    }

    /// The header value that tells what was applied.
    pub(super) fn applied_header(&self) -> Option<HeaderValue> {
        self.applied.as_deref().and_then(|text| HeaderValue::from_str(text).ok())
    }
}

fn preferences(headers: &HeaderMap) -> impl Iterator<Item = &str> {
    headers
        .get_all("prefer")
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|line| line.split(','))
        // What follows a semicolon are parameters of the preference; none are known here.
        .map(|preference| preference.split(';').next().unwrap_or_default().trim())
}

/// Whole seconds; a number too large for any clock is as good as the largest.
pub(super) fn seconds_of(text: &str) -> Option<u64> {
    let is_number = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    is_number.then(|| text.parse().unwrap_or(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait(prefer: &[&'static str]) -> (u64, Option<String>) {
        let mut headers = HeaderMap::new();
        for line in prefer {
            headers.append("prefer", HeaderValue::from_static(line));
        }
        let wait = Wait::from_headers(&headers);
        (wait.duration.as_secs(), wait.applied)
    }

    #[test]
    fn without_a_preference_a_minute_is_waited() {
        assert_eq!(wait(&[]), (60, None));
        assert_eq!(wait(&["handling=lenient"]), (60, None));
    }

    #[test]
    fn a_stated_wait_is_granted_and_told() {
        assert_eq!(wait(&["wait=7"]), (7, Some("wait=7".into())));
        assert_eq!(wait(&["foo; bar, Wait = \"8\" ; x=1"]), (8, Some("wait=8".into())));
    }

    #[test]
    fn a_wait_over_the_limit_is_shortened_and_told() {
        assert_eq!(wait(&["wait=301"]), (300, Some("wait=300".into())));
        assert_eq!(wait(&["wait=99999999999999999999999"]), (300, Some("wait=300".into())));
    }

    #[test]
    fn respond_async_does_not_wait_unless_it_says_how_long() {
        assert_eq!(wait(&["respond-async"]), (0, Some("respond-async".into())));
        assert_eq!(wait(&["respond-async", "wait=5"]), (5, Some("respond-async, wait=5".into())));
    }

    #[test]
    fn a_malformed_wait_is_ignored() {
        assert_eq!(wait(&["wait=soon"]), (60, None));
        assert_eq!(wait(&["wait=-1"]), (60, None));
        assert_eq!(wait(&["wait"]), (60, None));
    }
}
