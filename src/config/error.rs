//! Why a configuration cannot be used.

use super::origin::Origin;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Why a configuration cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ConfigError {
    /// The configuration file cannot be read.
    #[error("the configuration file {} cannot be read: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// The configuration file is no TOML.
    #[error("the configuration file {} is not valid TOML: {reason}", path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// What is wrong, with its line.
        reason: String,
    },
    /// There is no such setting.
    #[error("{origin}: there is no setting `{name}`{}", did_you_mean(*suggestion))]
    Unknown {
        /// The name that was given.
        name: String,
        /// Where.
        origin: Origin,
        /// The nearest name there is.
        suggestion: Option<&'static str>,
    },
    /// The setting does not take this value.
    #[error("`{name}` ({origin}) cannot be `{value}`; expected {expected}")]
    Invalid {
        /// The setting.
        name: &'static str,
        /// Where the value is from.
        origin: Origin,
        /// The value that was given.
        value: String,
        /// What it takes.
        expected: &'static str,
    },
    /// The value has a password in it, which is not repeated here.
    #[error(
        "`{name}` ({origin}) has a password in it, which everybody would read who sees the settings: put it into a file \
         and name that in `{file}`"
    )]
    Password {
        /// The setting.
        name: &'static str,
        /// Where its value is from.
        origin: Origin,
        /// The setting that names the file.
        file: &'static str,
    },
    /// The machine does not give what the setting asks for.
    #[error("`{name}` ({origin}): {reason}")]
    Refused {
        /// The setting.
        name: &'static str,
        /// Where its value is from.
        origin: Origin,
        /// What is in the way.
        reason: String,
    },
    /// Others can reach the address, and nobody decided who may use it.
    #[error(
        "the address {listen} is not loopback, so others can reach the service: set MESHMEND_API_KEYS_FILE to a file \
         of keys, or MESHMEND_ALLOW_ANONYMOUS=true to let everybody use it"
    )]
    OpenWithoutKeys {
        /// The address of the API.
        listen: SocketAddr,
    },
    /// Keys are given, and everybody is let in without.
    #[error("`api_keys_file` and `allow_anonymous` contradict each other: set one of them")]
    KeysAndAnonymous,
}

/// `; did you mean …?`, or nothing.
pub(super) fn did_you_mean(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}
