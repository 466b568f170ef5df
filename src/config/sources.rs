//! Where values come from, and which of them wins.

use super::addresses::has_password;
use super::error::{ConfigError, did_you_mean};
use super::origin::Origin;
use super::settings::{Config, ResolvedSetting, SETTINGS};
use std::fmt;
use std::path::{Path, PathBuf};

/// Variables that name no setting but are ours.
const CONFIG_VARIABLE: &str = "MESHMEND_CONFIG";
/// What Kubernetes injects for a service called `meshmend`.
const INJECTED: [&str; 2] = ["MESHMEND_SERVICE_", "MESHMEND_PORT"];

/// A configuration with the origin of each value.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The values.
    pub config: Config,
    /// The same as text, in the order of [`SETTINGS`].
    pub entries: Vec<ResolvedSetting>,
    /// What is odd but no error.
    pub warnings: Vec<String>,
}

impl Loaded {
    /// Where the value of the setting `name` is from.
    fn origin(&self, name: &str) -> Origin {
        let entry = self.entries.iter().find(|entry| entry.setting.name == name);
        entry.map_or(Origin::Default, |entry| entry.origin.clone())
    }

    /// True when the setting `name` was given, not left at its default.
    pub fn is_given(&self, name: &str) -> bool {
        self.origin(name) != Origin::Default
    }

    /// The error that the machine does not give what the setting `name` asks for.
    pub fn refused(&self, name: &'static str, reason: &dyn fmt::Display) -> ConfigError {
        ConfigError::Refused { name, origin: self.origin(name), reason: reason.to_string() }
    }
}

/// What a process was given.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// Flags: names of settings and values.
    pub flags: Vec<(String, String)>,
    /// Environment variables, all of them.
    pub environment: Vec<(String, String)>,
    /// The flag `--config`.
    pub file: Option<PathBuf>,
}

impl Sources {
    /// The environment of this process, with these flags.
    pub fn of_process(flags: Vec<(String, String)>, file: Option<PathBuf>) -> Self {
        // What is not Unicode is no value of ours.
        let environment =
            std::env::vars_os().filter_map(|(k, v)| Some((k.into_string().ok()?, v.into_string().ok()?)));
        Self { flags, environment: environment.collect(), file }
    }

    /// Reads the file, lays the sources over each other and checks every value by itself.
    ///
    /// # Errors
    /// A file that cannot be read, a key or flag that does not exist, a value that its setting does not take.
    pub fn load(&self) -> Result<Loaded, ConfigError> {
        let mut entries: Vec<ResolvedSetting> = SETTINGS
            .iter()
            .map(|setting| ResolvedSetting {
                setting,
                value: setting.default.to_owned(),
                origin: Origin::Default,
            })
            .collect();
        let mut put = |name: &str, value: String, origin: Origin| match entries
            .iter_mut()
            .find(|e| e.setting.name == name)
        {
            Some(entry) => {
                (entry.value, entry.origin) = (value, origin);
                Ok(())
            }
            None => Err(ConfigError::Unknown { name: name.to_owned(), origin, suggestion: nearest(name) }),
        };
        if let Some(path) = self.path() {
            for (name, value) in read_file(&path)? {
                put(&name, value, Origin::File(path.clone()))?;
            }
        }
        let mut warnings = Vec::new();
        for (variable, value) in &self.environment {
            match name_of(variable) {
                Some(name) if SETTINGS.iter().any(|s| s.name == name) => {
                    put(&name, value.clone(), Origin::Environment(variable.clone()))?;
                }
                Some(name) => {
                    let near = nearest(&name).map(|near| format!("MESHMEND_{}", near.to_ascii_uppercase()));
                    warnings.push(format!("there is no setting {variable}{}", did_you_mean(near.as_deref())));
                }
                None => {}
            }
        }
        for (name, value) in &self.flags {
            put(name, value.clone(), Origin::Flag(name.replace('_', "-")))?;
        }
        // Before anything is told of the values.
        if let Some(entry) = entries.iter().find(|entry| has_password(entry)) {
            let name = entry.setting.name;
            let file = if name == "database_url" { "database_password_file" } else { "blobs_key_file" };
            return Err(ConfigError::Password { name, origin: entry.origin.clone(), file });
        }
        Ok(Loaded { config: Config::from_entries(&entries)?, entries, warnings })
    }

    /// The configuration file, if one is named.
    fn path(&self) -> Option<PathBuf> {
        let of_environment = || self.environment.iter().find(|(name, _)| name == CONFIG_VARIABLE);
        self.file
            .clone()
            .or_else(|| of_environment().map(|(_, path)| path.into()))
            .filter(|p| !p.as_os_str().is_empty())
    }
}

/// The setting that a variable would be of; `None` for variables that are not meant for us.
fn name_of(variable: &str) -> Option<String> {
    let name = variable.strip_prefix("MESHMEND_")?;
    let is_foreign =
        variable == CONFIG_VARIABLE || INJECTED.iter().any(|prefix| variable.starts_with(prefix));
    (!is_foreign).then(|| name.to_ascii_lowercase())
}

fn read_file(path: &Path) -> Result<Vec<(String, String)>, ConfigError> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| ConfigError::File { path: path.to_owned(), reason: e.to_string() })?;
    let table: toml::Table =
        text.parse().map_err(|e| ConfigError::Toml { path: path.to_owned(), reason: placed(&text, &e) })?;
    Ok(table.into_iter().map(|(name, value)| (name, text_of(&value))).collect())
}

/// What is wrong and in which line, without the line itself: a secret may stand there.
fn placed(text: &str, error: &toml::de::Error) -> String {
    match error.span().and_then(|span| text.get(..span.start)) {
        Some(before) => format!("line {}: {}", before.split('\n').count(), error.message()),
        None => error.message().to_owned(),
    }
}

/// A TOML value as the text that a flag would have.
fn text_of(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        toml::Value::Array(items) => items.iter().map(text_of).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

/// The setting that `name` was probably meant to be. Below a Jaro similarity of 0.7, the threshold of common
/// command-line parsers, suggestions are noise.
fn nearest(name: &str) -> Option<&'static str> {
    let name = name.to_ascii_lowercase().replace('-', "_");
    SETTINGS
        .iter()
        .map(|setting| (strsim::jaro(&name, setting.name), setting.name))
        .filter(|&(similarity, _)| similarity > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
        list.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect()
    }

    fn file(text: &str) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    fn queue_max(loaded: &Loaded) -> (usize, String) {
        let entry = loaded.entries.iter().find(|e| e.setting.name == "queue_max").unwrap();
        (loaded.config.queue_max.get(), entry.origin.to_string())
    }

    #[test]
    fn defaults_are_valid_and_known_as_such() {
        let loaded = Sources::default().load().unwrap();
        assert_eq!(queue_max(&loaded), (128, "default".to_owned()));
        assert!(!loaded.is_given("queue_max") && loaded.warnings.is_empty());
        assert_eq!(loaded.entries.len(), SETTINGS.len());
    }

    #[test]
    fn flags_win_over_environment_over_file_over_default() {
        let file = file("queue_max = 2\nallowed_hosts = [\"a\", \"b\"]\nallow_anonymous = true\n");
        let mut sources = Sources { file: Some(file.path().to_owned()), ..Sources::default() };
        let loaded = sources.load().unwrap();
        assert_eq!(queue_max(&loaded), (2, format!("file {}", file.path().display())));
        assert_eq!(loaded.config.allowed_hosts, ["a", "b"]);
        assert!(loaded.config.allow_anonymous);
        sources.environment = pairs(&[("MESHMEND_QUEUE_MAX", "3")]);
        assert_eq!(queue_max(&sources.load().unwrap()), (3, "environment MESHMEND_QUEUE_MAX".to_owned()));
        sources.flags = pairs(&[("queue_max", "4")]);
        assert_eq!(queue_max(&sources.load().unwrap()), (4, "flag --queue-max".to_owned()));
    }

    #[test]
    fn the_environment_may_name_the_file() {
        let file = file("queue_max = 5");
        let environment = pairs(&[("MESHMEND_CONFIG", file.path().to_str().unwrap())]);
        let loaded = Sources { environment, ..Sources::default() }.load().unwrap();
        assert_eq!(loaded.config.queue_max.get(), 5);
        assert!(loaded.warnings.is_empty());
    }

    #[test]
    fn an_unknown_key_of_the_file_is_an_error_with_the_nearest_setting() {
        let file = file("queue-mx = 2");
        let error = Sources { file: Some(file.path().to_owned()), ..Sources::default() }.load().unwrap_err();
        assert!(matches!(error, ConfigError::Unknown { suggestion: Some("queue_max"), .. }), "{error}");
        assert!(error.to_string().contains("did you mean `queue_max`?"), "{error}");
    }

    #[test]
    fn an_unknown_variable_is_a_warning_unless_kubernetes_injects_it() {
        let environment = pairs(&[
            ("MESHMEND_QUEUE_MAXX", "2"),
            ("MESHMEND_SERVICE_HOST", "10.0.0.1"),
            ("MESHMEND_PORT", "tcp://10.0.0.1:80"),
            ("MESHMEND_PORT_80_TCP_ADDR", "10.0.0.1"),
            ("HOME", "/"),
        ]);
        let loaded = Sources { environment, ..Sources::default() }.load().unwrap();
        assert_eq!(
            loaded.warnings,
            ["there is no setting MESHMEND_QUEUE_MAXX; did you mean `MESHMEND_QUEUE_MAX`?"]
        );
        assert_eq!(queue_max(&loaded).0, 128);
    }

    #[test]
    fn a_wrong_value_is_told_with_its_origin_and_what_is_expected() {
        let environment = pairs(&[("MESHMEND_LISTEN", "localhost")]);
        let error = Sources { environment, ..Sources::default() }.load().unwrap_err();
        assert_eq!(
            error.to_string(),
            "`listen` (environment MESHMEND_LISTEN) cannot be `localhost`; expected an IP address and a port, such as \
             127.0.0.1:8080"
        );
    }

    #[test]
    fn an_address_with_a_password_is_refused_and_the_password_is_told_nowhere() {
        let of_flag = Sources {
            flags: pairs(&[("database_url", "postgresql://a:hidden@localhost/b")]),
            ..Sources::default()
        };
        let error = of_flag.load().unwrap_err().to_string();
        assert!(error.starts_with("`database_url` (flag --database-url) has a password"), "{error}");
        assert!(error.contains("`database_password_file`") && !error.contains("hidden"), "{error}");
        for (text, told) in [
            ("blobs_endpoint = \"https://id:hidden@s3.example\"", "blobs_key_file"),
            ("queue_max = 2\ndatabase_url = \"postgresql://a:hidden@localhost/b", "line 2"),
        ] {
            let file = file(text);
            let error =
                Sources { file: Some(file.path().to_owned()), ..Sources::default() }.load().unwrap_err();
            let error = error.to_string();
            assert!(error.contains(told) && !error.contains("hidden"), "{error}");
        }
    }

    #[test]
    fn a_file_that_is_missing_or_no_toml_is_an_error() {
        let missing = Sources { file: Some("/nowhere/meshmend.toml".into()), ..Sources::default() };
        assert!(matches!(missing.load(), Err(ConfigError::File { .. })));
        let broken = file("listen = ");
        let error =
            Sources { file: Some(broken.path().to_owned()), ..Sources::default() }.load().unwrap_err();
        assert!(error.to_string().contains("line 1"), "{error}");
    }
}
