//! The configuration: flags over `MESHMEND_*` environment over a TOML file over defaults, each value with its origin.
//!
//! One table ([`SETTINGS`]) names every setting; the same name is the TOML key, in capitals behind `MESHMEND_` the
//! environment variable, and with hyphens the flag.

mod addresses;
mod error;
mod origin;
mod settings;
mod sources;
mod values;

pub use error::ConfigError;
pub use origin::Origin;
pub use settings::{Config, ResolvedSetting, SETTINGS, Setting};
pub use sources::{Loaded, Sources};
pub use values::{Bytes, IsolationChoice, LogFormat, SandboxChoice, ServerRole};

impl Config {
    /// Whether the API may be used without a key.
    ///
    /// # Errors
    /// An address that others can reach without a decision about keys; keys together with anonymous access.
    pub fn is_anonymous(&self) -> Result<bool, ConfigError> {
        match (&self.api_keys_file, self.allow_anonymous) {
            (Some(_), true) => Err(ConfigError::KeysAndAnonymous),
            (Some(_), false) => Ok(false),
            (None, false) if self.role != ServerRole::Worker && !self.listen.ip().is_loopback() => {
                Err(ConfigError::OpenWithoutKeys { listen: self.listen })
            }
            (None, _) => Ok(true),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(pairs: &[(&str, &str)]) -> Config {
        let flags = pairs.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect();
        Sources { flags, ..Sources::default() }.load().unwrap().config
    }

    #[test]
    fn loopback_needs_no_key() {
        assert_eq!(config(&[]).is_anonymous(), Ok(true));
        assert_eq!(config(&[("listen", "[::1]:1")]).is_anonymous(), Ok(true));
    }

    #[test]
    fn an_open_address_needs_keys_or_the_word_that_none_are_wanted() {
        let open = ("listen", "0.0.0.0:8080");
        let error = config(&[open]).is_anonymous().unwrap_err().to_string();
        assert!(
            error.contains("MESHMEND_API_KEYS_FILE") && error.contains("MESHMEND_ALLOW_ANONYMOUS=true"),
            "{error}"
        );
        assert_eq!(config(&[open, ("allow_anonymous", "true")]).is_anonymous(), Ok(true));
        assert_eq!(config(&[open, ("api_keys_file", "keys")]).is_anonymous(), Ok(false));
        assert_eq!(config(&[open, ("role", "worker")]).is_anonymous(), Ok(true), "it listens to nobody");
    }

    #[test]
    fn keys_and_anonymous_access_contradict_each_other() {
        let both = config(&[("api_keys_file", "keys"), ("allow_anonymous", "true")]);
        assert_eq!(both.is_anonymous(), Err(ConfigError::KeysAndAnonymous));
    }
}
