//! `config show` and `config check`, and commands that need a configuration.

use super::exit::{Exit, print, say};
use crate::config::{ConfigError, Loaded, Sources};
use std::fmt::Write as _;

/// Runs `body` with the configuration; its error is a message on standard error.
pub(super) fn with_loaded(sources: &Sources, body: impl FnOnce(&Loaded) -> anyhow::Result<()>) -> Exit {
    let loaded = match sources.load() {
        Ok(loaded) => loaded,
        Err(error) => {
            say(&error.to_string());
            return Exit::Usage;
        }
    };
    match body(&loaded) {
        Ok(()) => Exit::Done,
        Err(error) => {
            say(&format!("{error:#}"));
            let is_configuration = error.is::<ConfigError>();
            if is_configuration { Exit::Usage } else { Exit::Internal }
        }
    }
}

/// Prints every setting with its value and origin.
pub(super) fn show(sources: &Sources) -> Exit {
    match sources.load() {
        Ok(loaded) => {
            warn(&loaded.warnings);
            print(&table(&loaded));
            Exit::Done
        }
        Err(error) => {
            say(&error.to_string());
            Exit::Usage
        }
    }
}

fn table(loaded: &Loaded) -> String {
    let width =
        |of: fn(&crate::config::ResolvedSetting) -> usize| loaded.entries.iter().map(of).max().unwrap_or(0);
    let (name_width, value_width) = (width(|e| e.setting.name.len()), width(|e| e.value.chars().count()));
    let mut text = String::new();
    for entry in &loaded.entries {
        let _ = writeln!(
            text,
            "{:name_width$}  {:value_width$}  {}",
            entry.setting.name, entry.value, entry.origin
        );
    }
    text
}

/// Says whether the service could start with this configuration.
pub(super) fn check(
    sources: &Sources,
    is_strict: bool,
    check: fn(&Loaded) -> Result<(), ConfigError>,
) -> Exit {
    let loaded = sources.load().and_then(|loaded| check(&loaded).map(|()| loaded));
    match loaded {
        Ok(loaded) => {
            warn(&loaded.warnings);
            if is_strict && !loaded.warnings.is_empty() { Exit::Usage } else { Exit::Done }
        }
        Err(error) => {
            say(&error.to_string());
            Exit::Usage
        }
    }
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        say(&format!("warning: {warning}"));
    }
}
