//! The types of settings: from text, with a word on what is expected.

use std::net::{IpAddr, SocketAddr};
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;
use std::time::Duration;

/// A type of setting.
pub(super) trait SettingValue: Sized {
    /// What it takes, to end the sentence "expected …".
    const EXPECTED: &'static str;

    /// Reads the text; `None` when it is something else.
    fn parse(text: &str) -> Option<Self>;
}

/// A number of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bytes(
    /// The number.
    pub u64,
);

/// How log lines look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LogFormat {
    /// For people.
    Text,
    /// For machines: one JSON object a line.
    Json,
}

/// What a server does among several.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ServerRole {
    /// Takes requests and runs jobs.
    #[default]
    All,
    /// Takes requests.
    Api,
    /// Runs jobs.
    Worker,
}

impl ServerRole {
    /// The word of the setting.
    pub fn word(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Api => "api",
            Self::Worker => "worker",
        }
    }
}

/// Where a job runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IsolationChoice {
    /// In a process of its own.
    Process,
    /// In a thread of the server.
    Thread,
}

/// How much of the sandbox there must be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SandboxChoice {
    /// What the kernel has.
    Auto,
    /// All of it, or the server does not start.
    Require,
    /// None.
    Off,
}

impl SettingValue for SocketAddr {
    const EXPECTED: &'static str = "an IP address and a port, such as 127.0.0.1:8080";

    fn parse(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

impl SettingValue for Option<SocketAddr> {
    const EXPECTED: &'static str = "an IP address and a port, such as 127.0.0.1:8081, or off";

    fn parse(text: &str) -> Option<Self> {
        if text == "off" { Some(None) } else { text.parse().ok().map(Some) }
    }
}

impl SettingValue for PathBuf {
    const EXPECTED: &'static str = "a path";

    fn parse(text: &str) -> Option<Self> {
        (!text.is_empty()).then(|| text.into())
    }
}

impl SettingValue for Option<PathBuf> {
    const EXPECTED: &'static str = "a path, or nothing";

    fn parse(text: &str) -> Option<Self> {
        Some(PathBuf::parse(text))
    }
}

impl SettingValue for bool {
    const EXPECTED: &'static str = "true or false";

    fn parse(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

impl SettingValue for String {
    const EXPECTED: &'static str = "a text";

    fn parse(text: &str) -> Option<Self> {
        Some(text.to_owned())
    }
}

impl SettingValue for u64 {
    const EXPECTED: &'static str = "a whole number";

    fn parse(text: &str) -> Option<Self> {
        digits(text)
    }
}

impl SettingValue for u32 {
    const EXPECTED: &'static str = "a whole number up to 4294967295";

    fn parse(text: &str) -> Option<Self> {
        digits(text)?.try_into().ok()
    }
}

impl SettingValue for usize {
    const EXPECTED: &'static str = "a whole number";

    fn parse(text: &str) -> Option<Self> {
        digits(text)?.try_into().ok()
    }
}

impl SettingValue for NonZeroUsize {
    const EXPECTED: &'static str = "a whole number from 1 on";

    fn parse(text: &str) -> Option<Self> {
        Self::new(usize::parse(text)?)
    }
}

impl SettingValue for NonZeroU32 {
    const EXPECTED: &'static str = "a whole number from 1 to 4294967295";

    fn parse(text: &str) -> Option<Self> {
        Self::new(u32::parse(text)?)
    }
}

impl SettingValue for Option<NonZeroUsize> {
    const EXPECTED: &'static str = "a whole number from 1 on, or auto";

    fn parse(text: &str) -> Option<Self> {
        if text == "auto" { Some(None) } else { NonZeroUsize::parse(text).map(Some) }
    }
}

impl SettingValue for Vec<String> {
    const EXPECTED: &'static str = "a list with commas";

    fn parse(text: &str) -> Option<Self> {
        Some(text.split(',').map(str::trim).filter(|item| !item.is_empty()).map(str::to_owned).collect())
    }
}

impl SettingValue for Vec<IpAddr> {
    const EXPECTED: &'static str = "a list of IP addresses with commas";

    fn parse(text: &str) -> Option<Self> {
        <Vec<String> as SettingValue>::parse(text)?.iter().map(|item| item.parse().ok()).collect()
    }
}

impl SettingValue for Bytes {
    const EXPECTED: &'static str = "a number of bytes, such as 512MiB (units: B, KiB, MiB, GiB, TiB)";

    fn parse(text: &str) -> Option<Self> {
        let (number, unit) = number_and_unit(text)?;
        let shift = match unit {
            "" | "B" => 0,
            "KiB" => 10,
            "MiB" => 20,
            "GiB" => 30,
            "TiB" => 40,
            _ => return None,
        };
        number.checked_mul(1 << shift).map(Self)
    }
}

impl SettingValue for Option<Bytes> {
    const EXPECTED: &'static str = "a number of bytes, such as 16GiB (units: B, KiB, MiB, GiB, TiB), or auto";

    fn parse(text: &str) -> Option<Self> {
        if text == "auto" { Some(None) } else { Bytes::parse(text).map(Some) }
    }
}

impl SettingValue for Duration {
    const EXPECTED: &'static str =
        "a time from 1 ms to 1000 d, such as 24h (units: ms, s, min, h, d; none: seconds)";

    fn parse(text: &str) -> Option<Self> {
        let (number, unit) = number_and_unit(text)?;
        let millis = match unit {
            "ms" => 1,
            "" | "s" => 1000,
            "min" => 60_000,
            "h" => 3_600_000,
            "d" => 86_400_000,
            _ => return None,
        };
        // A bound, so that adding it to any clock cannot overflow.
        let total = number.checked_mul(millis).filter(|total| (1..=1000 * 86_400_000).contains(total))?;
        Some(Self::from_millis(total))
    }
}

impl SettingValue for Option<Duration> {
    const EXPECTED: &'static str =
        "a time from 1 ms to 1000 d, such as 15min (units: ms, s, min, h, d; none: seconds), or off";

    fn parse(text: &str) -> Option<Self> {
        if text == "off" { Some(None) } else { Duration::parse(text).map(Some) }
    }
}

impl SettingValue for ServerRole {
    const EXPECTED: &'static str = "all, api or worker";

    fn parse(text: &str) -> Option<Self> {
        [Self::All, Self::Api, Self::Worker].into_iter().find(|role| role.word() == text)
    }
}

impl SettingValue for IsolationChoice {
    const EXPECTED: &'static str = "process or thread";

    fn parse(text: &str) -> Option<Self> {
        match text {
            "process" => Some(Self::Process),
            "thread" => Some(Self::Thread),
            _ => None,
        }
    }
}

impl SettingValue for SandboxChoice {
    const EXPECTED: &'static str = "auto, require or off";

    fn parse(text: &str) -> Option<Self> {
        match text {
            "auto" => Some(Self::Auto),
            "require" => Some(Self::Require),
            "off" => Some(Self::Off),
            _ => None,
        }
    }
}

impl SettingValue for LogFormat {
    const EXPECTED: &'static str = "text or json";

    fn parse(text: &str) -> Option<Self> {
        match text {
            "text" => Some(Self::Text),
            "json" => Some(Self::Json),
            _ => None,
        }
    }
}

/// A number in digits only (`_` may group them).
fn digits(text: &str) -> Option<u64> {
    let is_number = text.starts_with(|c: char| c.is_ascii_digit())
        && text.bytes().all(|b| b.is_ascii_digit() || b == b'_');
    is_number.then(|| text.replace('_', "").parse().ok()).flatten()
}

fn number_and_unit(text: &str) -> Option<(u64, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '_').unwrap_or(text.len());
    Some((digits(&text[..end])?, text[end..].trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_binary_units() {
        assert_eq!(Bytes::parse("512MiB"), Some(Bytes(512 << 20)));
        assert_eq!(Bytes::parse("1_000 B"), Some(Bytes(1000)));
        for text in ["", "MiB", "1MB", "-1", "1.5GiB", "99999999999TiB"] {
            assert_eq!(Bytes::parse(text), None, "{text}");
        }
    }

    #[test]
    fn times_have_units_and_seconds_when_they_have_none() {
        assert_eq!(Duration::parse("24h"), Some(Duration::from_secs(86_400)));
        assert_eq!(Duration::parse("250 ms"), Some(Duration::from_millis(250)));
        assert_eq!(Duration::parse("90"), Some(Duration::from_secs(90)));
        for text in ["", "0", "h", "1001d", "1m", "-5s", "18446744073709551615d"] {
            assert_eq!(Duration::parse(text), None, "{text}");
        }
    }

    #[test]
    fn counts_that_must_not_be_zero_are_not() {
        assert_eq!(NonZeroUsize::parse("0"), None);
        assert_eq!(<Option<NonZeroUsize> as SettingValue>::parse("auto"), Some(None));
        assert_eq!(<Option<NonZeroUsize> as SettingValue>::parse("many"), None);
    }

    #[test]
    fn lists_are_split_at_commas() {
        assert_eq!(
            <Vec<String> as SettingValue>::parse(" a, b,,"),
            Some(vec!["a".to_owned(), "b".to_owned()])
        );
        assert_eq!(<Vec<IpAddr> as SettingValue>::parse("10.0.0.1,x"), None);
    }
}
