//! From a configuration to a running service.

use std::fmt::Display;
use std::io::IsTerminal as _;
use std::num::NonZero;
use std::time::Duration;

use tracing_subscriber::EnvFilter;

use super::access::{Access, Neighbours};
use super::keys::ApiKeys;
use super::server::Server;
use super::settings::HttpSettings;
use super::shutdown::Shutdown;
use crate::config::{ConfigError, IsolationChoice, Loaded, LogFormat, SandboxChoice};
use crate::formats::ReadLimits;
use crate::jobs::{Isolation, Jobs, JobsSettings, Sandbox, StartError, TrialError};

/// Time for jobs that a second signal gave up: the process is not to wait for them.
const LEFTOVERS: Duration = Duration::from_secs(1);

/// Shortest lease: a busy machine may keep a heartbeat waiting for a good part of a second.
const LEASE_MIN: Duration = Duration::from_secs(1);

/// Serves until a signal ends it.
///
/// # Errors
/// A [`ConfigError`] for what the configuration asks and the machine refuses: keys, folders, addresses, the log filter.
pub fn start(loaded: &Loaded) -> anyhow::Result<()> {
    log_as(loaded)?;
    for warning in &loaded.warnings {
        tracing::warn!("{warning}");
    }
    let http = http_settings(loaded)?;
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    let served = runtime.block_on(async {
        let shutdown = Shutdown::on_signals()?;
        let refused = |name: &'static str, why: &dyn Display| loaded.refused(name, why);
        let jobs = Jobs::start(jobs_settings(loaded)?).await.map_err(|e| refused(setting_of(&e), &e))?;
        let server = Server::bind(http, jobs).await.map_err(|e| refused("listen", &e))?;
        tell(&server)?;
        server.run(shutdown).await;
        Ok(())
    });
    runtime.shutdown_timeout(LEFTOVERS);
    served
}

/// The setting that stands in the way of a start.
fn setting_of(error: &StartError) -> &'static str {
    match error {
        StartError::DataDir { .. } | StartError::DataDirInUse { .. } | StartError::Store { .. } => "data_dir",
        StartError::Isolation(TrialError::NoProcess | TrialError::Incomplete(_)) => "sandbox",
        StartError::Isolation(TrialError::Folder(_) | TrialError::NoAnswer(_)) => "isolation",
    }
}

/// Says where the service is and how to try it.
fn tell(server: &Server) -> std::io::Result<()> {
    let address = server.address()?;
    let host = if address.ip().is_unspecified() {
        format!("localhost:{}", address.port())
    } else {
        address.to_string()
    };
    tracing::info!("listening on http://{address}");
    if let Some(admin) = server.admin_address()? {
        tracing::info!("health and metrics on http://{admin}");
    }
    tracing::info!("try: curl --data-binary @part.stl http://{host}/v1/repair --output repaired.stl");
    Ok(())
}

/// Log lines go to standard error, as the configuration says.
fn log_as(loaded: &Loaded) -> Result<(), ConfigError> {
    let filter = EnvFilter::try_new(&loaded.config.log).map_err(|e| loaded.refused("log", &e))?;
    let lines = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr);
    // A log of this process that is set already stays.
    let _ = match loaded.config.log_format {
        LogFormat::Text => lines.with_ansi(std::io::stderr().is_terminal()).try_init(),
        LogFormat::Json => lines.json().try_init(),
    };
    Ok(())
}

fn http_settings(loaded: &Loaded) -> Result<HttpSettings, ConfigError> {
    let config = &loaded.config;
    Ok(HttpSettings {
        listen: config.listen,
        admin_listen: config.admin_listen,
        access: access(loaded)?,
        connections_max: config.connections_max.get(),
        header_timeout: config.header_timeout,
        upload_timeout: config.upload_timeout,
        upload_total_timeout: config.upload_total_timeout,
        write_timeout: config.write_timeout,
    })
}

fn access(loaded: &Loaded) -> Result<Access, ConfigError> {
    let config = &loaded.config;
    if config.is_anonymous()? {
        let (allowed_hosts, trusted_proxies) = (config.allowed_hosts.clone(), config.trusted_proxies.clone());
        return Ok(Access::Anonymous(Neighbours { allowed_hosts, trusted_proxies }));
    }
    let path = config.api_keys_file.as_deref().unwrap_or_else(|| std::path::Path::new(""));
    let text = std::fs::read_to_string(path).map_err(|e| loaded.refused("api_keys_file", &e))?;
    ApiKeys::parse(&text).map(Access::Keys).map_err(|e| loaded.refused("api_keys_file", &e))
}

fn jobs_settings(loaded: &Loaded) -> Result<JobsSettings, ConfigError> {
    let config = &loaded.config;
    if config.lease < LEASE_MIN {
        return Err(loaded.refused("lease", &format!("it must be {LEASE_MIN:?} or more")));
    }
    let defaults = JobsSettings::new(&config.data_dir);
    Ok(JobsSettings {
        slots: config.slots.map_or(defaults.slots, NonZero::get),
        queue_max: config.queue_max.get(),
        jobs_max: config.jobs_max.get(),
        upload_bytes_max: config.upload_bytes_max.0,
        data_bytes_max: config.data_bytes_max.0,
        result_ttl: config.result_ttl,
        deadline_max: config.deadline_max,
        engine_bytes_max: config.engine_bytes_max.0,
        engine_work_max: config.engine_work_max,
        engine_threads: config.engine_threads,
        read_limits: ReadLimits {
            triangles_max: config.triangles_max,
            vertices_max: config.vertices_max,
            polygon_corners_max: config.polygon_corners_max,
        },
        drain_grace: config.drain_grace,
        isolation: match config.isolation {
            IsolationChoice::Process => Isolation::Process,
            IsolationChoice::Thread => Isolation::Thread,
        },
        sandbox: match config.sandbox {
            SandboxChoice::Auto => Sandbox::Auto,
            SandboxChoice::Require => Sandbox::Require,
            SandboxChoice::Off => Sandbox::Off,
        },
        disk_free_bytes_min: config.disk_free_bytes_min.0,
        lease: config.lease,
        attempts_max: config.attempts_max.get(),
        ..defaults
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Sources;

    fn loaded(flags: &[(&str, &str)]) -> Loaded {
        let flags = flags.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect();
        Sources { flags, ..Sources::default() }.load().unwrap()
    }

    #[test]
    fn the_defaults_of_the_configuration_are_those_of_the_settings() {
        let loaded = loaded(&[("data_dir", "d")]);
        // The binary of the service is one that runs jobs.
        let want = JobsSettings { isolation: Isolation::Process, ..JobsSettings::new("d") };
        assert_eq!(format!("{:?}", jobs_settings(&loaded).unwrap()), format!("{want:?}"));
        let want = HttpSettings { admin_listen: loaded.config.admin_listen, ..HttpSettings::default() };
        assert_eq!(format!("{:?}", http_settings(&loaded).unwrap()), format!("{want:?}"));
    }

    #[test]
    fn a_key_file_that_is_missing_or_lets_nobody_in_is_refused_by_name() {
        let empty = tempfile::NamedTempFile::new().unwrap();
        for path in ["/nowhere/keys", empty.path().to_str().unwrap()] {
            let error = access(&loaded(&[("api_keys_file", path)])).unwrap_err().to_string();
            assert!(error.starts_with("`api_keys_file` (flag --api-keys-file)"), "{error}");
        }
    }

    #[test]
    fn a_log_filter_that_says_nothing_usable_is_refused() {
        assert!(log_as(&loaded(&[("log", "=loud=")])).is_err());
    }
}
