//! From a configuration to a running service.

use std::fmt::Display;
use std::io::IsTerminal as _;
use std::num::{NonZero, NonZeroU32};
use std::time::Duration;

use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use tracing_subscriber::{EnvFilter, Layer as _};

use super::access::{Access, TrustedPeers};
use super::keys::ApiKeys;
use super::rate::RateSettings;
use super::server::Server;
use super::settings::HttpSettings;
use super::shared_stores::{presigned_ttl, shared_stores};
use super::shutdown::Shutdown;
use super::{cors, descriptors};
use crate::config::{ConfigError, IsolationChoice, Loaded, LogFormat, SandboxChoice, ServerRole};
use crate::formats::ReadLimits;
use crate::jobs::{
    Isolation, Jobs, JobsSettings, LostStore, PrivateHosts, RetryPlan, Sandbox, StartError, StoresError,
    TrialError, WebhookSecret, WebhookSettings,
};

/// Time for jobs that a second signal gave up: the process is not to wait for them.
const LEFTOVERS: Duration = Duration::from_secs(1);

/// Shortest lease: a busy machine may keep a heartbeat waiting for a good part of a second.
const LEASE_MIN: Duration = Duration::from_secs(1);

/// Serves until a signal ends it. `lost_store`: what to do when the store of the stored files is gone.
///
/// # Errors
/// A [`ConfigError`] for what the configuration asks and the machine refuses: keys, folders, addresses, the log filter.
pub fn start(loaded: &Loaded, lost_store: LostStore) -> anyhow::Result<()> {
    // What this process writes is for its own user alone.
    rustix::process::umask(rustix::fs::Mode::RWXG | rustix::fs::Mode::RWXO);
    log_as(loaded)?;
    for warning in &loaded.warnings {
        tracing::warn!("{warning}");
    }
    let http = fitting(http_settings(loaded)?);
    // Before jobs are taken over, so that the runs that were lost are counted.
    let _ = super::metrics::recorder();
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    let served = runtime.block_on(async {
        let shutdown = Shutdown::on_signals()?;
        let refused = |name: &'static str, why: &dyn Display| loaded.refused(name, why);
        let settings = JobsSettings { lost_store, ..jobs_settings(loaded)? };
        let jobs = Jobs::start(settings).await.map_err(|e| refused(setting_of(&e), &e))?;
        let server = Server::bind(http, jobs).await.map_err(|e| refused("listen", &e))?;
        tell(&server)?;
        server.run(shutdown).await;
        Ok(())
    });
    runtime.shutdown_timeout(LEFTOVERS);
    #[cfg(feature = "otel")]
    super::otel::flush();
    served
}

/// Looks at all that [`start`] takes from the configuration, without opening stores or addresses.
///
/// # Errors
/// The setting with which the service would not start.
pub fn check(loaded: &Loaded) -> Result<(), ConfigError> {
    log_filter(loaded)?;
    http_settings(loaded)?;
    jobs_settings(loaded)?;
    Ok(())
}

/// The setting that a service which cannot start is about.
fn setting_of(error: &StartError) -> &'static str {
    match error {
        StartError::Stores(StoresError::Database { .. }) => "database_url",
        StartError::Stores(StoresError::Bucket { .. }) => "blobs_url",
        StartError::Stores(_) | StartError::TakeOver { .. } => "data_dir",
        StartError::Isolation(TrialError::NoProcess | TrialError::Incomplete(_)) => "sandbox",
        StartError::Isolation(TrialError::Folder(_) | TrialError::NoAnswer(_)) => "isolation",
        StartError::Webhooks { .. } => "webhooks",
    }
}

/// The same with no more connections than the system has descriptors for.
fn fitting(http: HttpSettings) -> HttpSettings {
    let connections_max = descriptors::make_room(http.connections_max);
    if connections_max < http.connections_max {
        tracing::warn!(
            "the limit on open files allows {connections_max} of {} connections: raise it (ulimit -n)",
            http.connections_max
        );
    }
    HttpSettings { connections_max, ..http }
}

/// Says where the service is and how to try it.
fn tell(server: &Server) -> std::io::Result<()> {
    let address = server.address()?;
    match address {
        Some(address) => tracing::info!("listening on http://{address}"),
        None => tracing::info!("running jobs that other servers take in"),
    }
    if let Some(admin) = server.admin_address()? {
        if !admin.ip().is_loopback() {
            tracing::warn!(
                "health and metrics are on an address that others may reach: keep {admin} from the public"
            );
        }
        tracing::info!("health and metrics on http://{admin}");
    }
    if let Some(address) = address {
        let host = if address.ip().is_unspecified() {
            format!("localhost:{}", address.port())
        } else {
            address.to_string()
        };
        tracing::info!(
            "try: curl --fail-with-body --data-binary @part.stl http://{host}/v1/repair --output repaired.stl"
        );
    }
    Ok(())
}

fn log_filter(loaded: &Loaded) -> Result<EnvFilter, ConfigError> {
    EnvFilter::try_new(&loaded.config.log).map_err(|e| loaded.refused("log", &e))
}

/// Log lines go to standard error, as the configuration says.
fn log_as(loaded: &Loaded) -> Result<(), ConfigError> {
    let filter = log_filter(loaded)?;
    let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr);
    let lines = match loaded.config.log_format {
        LogFormat::Text => lines.with_ansi(std::io::stderr().is_terminal()).boxed(),
        LogFormat::Json => lines.json().boxed(),
    };
    let layers = tracing_subscriber::registry().with(lines.with_filter(filter));
    #[cfg(feature = "otel")]
    let layers = layers.with(super::otel::layer());
    // A log of this process that is set already stays.
    let _ = layers.try_init();
    Ok(())
}

fn http_settings(loaded: &Loaded) -> Result<HttpSettings, ConfigError> {
    let config = &loaded.config;
    Ok(HttpSettings {
        listen: (config.role != ServerRole::Worker).then_some(config.listen),
        admin_listen: config.admin_listen,
        access: access(loaded)?,
        cors_origins: cors_origins(loaded)?,
        rate: rate(loaded)?,
        connections_max: config.connections_max.get(),
        address_connections_max: config.address_connections_max.map(NonZero::get),
        trusted_proxies: config.trusted_proxies.clone(),
        header_timeout: config.header_timeout,
        upload_timeout: config.upload_timeout,
        upload_rate_min: config.upload_rate_min.0,
        upload_total_timeout: config.upload_total_timeout,
        write_timeout: config.write_timeout,
    })
}

fn access(loaded: &Loaded) -> Result<Access, ConfigError> {
    let config = &loaded.config;
    if config.role == ServerRole::Worker || config.is_anonymous()? {
        return Ok(Access::Anonymous(TrustedPeers {
            allowed_hosts: config.allowed_hosts.clone(),
            allowed_origins: cors_origins(loaded)?,
            trusted_proxies: config.trusted_proxies.clone(),
        }));
    }
    let path = config.api_keys_file.as_deref().unwrap_or_else(|| std::path::Path::new(""));
    let text = std::fs::read_to_string(path).map_err(|e| loaded.refused("api_keys_file", &e))?;
    ApiKeys::parse(&text).map(Access::Keys).map_err(|e| loaded.refused("api_keys_file", &e))
}

fn cors_origins(loaded: &Loaded) -> Result<Vec<String>, ConfigError> {
    cors::origins(&loaded.config.cors_origins).map_err(|item| {
        loaded.refused("cors_origins", &format!("`{item}` is no origin, such as https://shop.example"))
    })
}

fn rate(loaded: &Loaded) -> Result<Option<RateSettings>, ConfigError> {
    let Some(per_minute) = NonZeroU32::new(loaded.config.rate_per_minute) else { return Ok(None) };
    let burst = NonZeroU32::new(loaded.config.rate_burst).ok_or_else(|| {
        loaded.refused("rate_burst", &"0 lets no request in; `rate_per_minute` 0 sets no limit")
    })?;
    Ok(Some(RateSettings { per_minute, burst }))
}

fn webhooks(loaded: &Loaded) -> Result<Option<WebhookSettings>, ConfigError> {
    let config = &loaded.config;
    if !config.webhooks || config.role == ServerRole::Worker {
        return Ok(None);
    }
    let refused = |why: &dyn Display| loaded.refused("webhook_secret_file", why);
    let secrets = match &config.webhook_secret_file {
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(|e| refused(&e))?;
            WebhookSecret::parse_file(&text).map_err(|e| refused(&e))?
        }
        None => Vec::new(),
    };
    let private_hosts = PrivateHosts::parse(&config.webhook_private_hosts).map_err(|item| {
        let why = format!("`{item}` is no host with a port, such as orders.internal:9000");
        loaded.refused("webhook_private_hosts", &why)
    })?;
    let retry =
        RetryPlan { attempts_max: config.webhook_attempts_max.get(), first_pause: config.webhook_pause };
    Ok(Some(WebhookSettings { secrets, private_hosts, timeout: config.webhook_timeout, retry }))
}

fn jobs_settings(loaded: &Loaded) -> Result<JobsSettings, ConfigError> {
    let config = &loaded.config;
    if config.lease < LEASE_MIN {
        return Err(loaded.refused("lease", &format!("it must be {LEASE_MIN:?} or more")));
    }
    let defaults = JobsSettings::new(&config.data_dir);
    Ok(JobsSettings {
        slots: match config.role {
            ServerRole::Api => 0,
            ServerRole::All | ServerRole::Worker => config.slots.map_or(defaults.slots, NonZero::get),
        },
        queue_max: config.queue_max.get(),
        jobs_max: config.jobs_max.get(),
        upload_bytes_max: config.upload_bytes_max.0,
        uploads_max: config.uploads_max.get(),
        upload_ttl: config.upload_ttl,
        presigned_ttl: presigned_ttl(loaded)?,
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
        interactive_slots: config.interactive_slots,
        interactive_bytes_max: config.interactive_bytes_max.0,
        interactive_deadline: config.interactive_deadline,
        owner_queue_max: config.owner_queue_max.map(NonZero::get),
        owner_slots_max: config.owner_slots_max.map(NonZero::get),
        owner_jobs_max: config.owner_jobs_max.map(NonZero::get),
        owner_data_bytes_max: config.owner_data_bytes_max.map(|bytes| bytes.0),
        shared: shared_stores(loaded)?,
        store_key_file: config.store_key_file.clone(),
        memory_bytes_max: config.memory_bytes_max.map_or(defaults.memory_bytes_max, |bytes| bytes.0),
        webhooks: webhooks(loaded)?,
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
    fn a_lease_that_a_busy_machine_could_not_keep_is_refused() {
        let error = jobs_settings(&loaded(&[("data_dir", "d"), ("lease", "999ms")])).unwrap_err().to_string();
        assert!(error.starts_with("`lease` (flag --lease)"), "{error}");
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
    fn what_the_service_would_not_start_with_is_refused_when_the_configuration_is_checked() {
        assert_eq!(check(&loaded(&[])), Ok(()));
        for (setting, value) in [
            ("role", "worker"),
            ("database_url", "postgresql://a@localhost/b"),
            ("api_keys_file", "/nowhere/keys"),
            ("log", "=loud="),
            ("lease", "1ms"),
            ("rate_burst", "0"),
        ] {
            let error = check(&loaded(&[(setting, value)])).unwrap_err().to_string();
            assert!(error.starts_with(&format!("`{setting}`")), "{error}");
        }
    }

    #[test]
    fn a_log_filter_that_says_nothing_usable_is_refused() {
        assert!(log_as(&loaded(&[("log", "=loud=")])).is_err());
    }
}
