//! Every setting: its name, type, default and meaning.

#![allow(rustdoc::bare_urls, reason = "the sentences are those of the help, which are no links")]

use super::error::ConfigError;
use super::origin::Origin;
use super::values::{Bytes, IsolationChoice, LogFormat, SandboxChoice, ServerRole, SettingValue};
use std::net::{IpAddr, SocketAddr};
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;
use std::time::Duration;

/// One row of the table of settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setting {
    /// Name, as in TOML.
    pub name: &'static str,
    /// What it is for.
    pub about: &'static str,
    /// The value when nothing is given.
    pub default: &'static str,
    /// What values it takes.
    pub expected: &'static str,
}

impl Setting {
    /// The environment variable.
    pub fn variable(&self) -> String {
        format!("MESHMEND_{}", self.name.to_ascii_uppercase())
    }

    /// The flag, without the leading hyphens.
    pub fn flag(&self) -> String {
        self.name.replace('_', "-")
    }
}

/// A setting with its value as text and where that is from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResolvedSetting {
    /// The setting.
    pub setting: &'static Setting,
    /// The value as it was given.
    pub value: String,
    /// Where.
    pub origin: Origin,
}

/// Makes the struct, the table and the conversion from one list.
macro_rules! settings {
    ($($(#[doc = $about:literal])+ $name:ident: $type:ty = $default:literal,)*) => {
        /// The configuration, every value valid by itself.
        #[derive(Debug, Clone)]
        pub struct Config {
            $($(#[doc = $about])+ pub $name: $type,)*
        }

        /// Every setting.
        pub const SETTINGS: &[Setting] = &[$(Setting {
            name: stringify!($name),
            about: concat!($($about),+).trim_ascii_start(),
            default: $default,
            expected: <$type as SettingValue>::EXPECTED,
        },)*];

        impl Config {
            /// The values of `entries`, which are in the order of [`SETTINGS`].
            pub(super) fn from_entries(entries: &[ResolvedSetting]) -> Result<Self, ConfigError> {
                let mut entries = entries.iter();
                Ok(Self { $($name: value(entries.next(), stringify!($name))?,)* })
            }
        }
    };
}

fn value<T: SettingValue>(entry: Option<&ResolvedSetting>, name: &'static str) -> Result<T, ConfigError> {
    let entry = entry.filter(|e| e.setting.name == name).expect("one entry for each setting, in order");
    T::parse(entry.value.trim()).ok_or_else(|| ConfigError::Invalid {
        name,
        origin: entry.origin.clone(),
        value: entry.value.clone(),
        expected: T::EXPECTED,
    })
}

settings! {
    /// What this server does among several that share their stores: all, only take requests (api), or only run jobs (worker).
    role: ServerRole = "all",
    /// Where the API listens.
    listen: SocketAddr = "127.0.0.1:8080",
    /// Where health and metrics listen; off: nowhere.
    admin_listen: Option<SocketAddr> = "127.0.0.1:8081",
    /// Folder for uploads and results; one server owns it.
    data_dir: PathBuf = "meshmend-data",
    /// PostgreSQL database for jobs that several servers share, such as postgresql://meshmend@db.example/meshmend; with blobs_url. Empty: a file in data_dir.
    database_url: String = "",
    /// File of its password, if it asks for one.
    database_password_file: Option<PathBuf> = "",
    /// Most connections of this server to it.
    database_connections_max: NonZeroUsize = "16",
    /// S3 bucket for uploads and results that several servers share, such as s3://meshes/shop; with database_url. Empty: a folder in data_dir.
    blobs_url: String = "",
    /// S3 server, such as https://s3.example; empty: Amazon's.
    blobs_endpoint: String = "",
    /// Region of the bucket.
    blobs_region: String = "us-east-1",
    /// File of the key to the bucket, its id and its secret, one a line. Default: what the machine has been given.
    blobs_key_file: Option<PathBuf> = "",
    /// S3 server as clients reach it by presigned URLs, when that is another address. Default: blobs_endpoint.
    blobs_public_endpoint: String = "",
    /// Time for which a presigned URL of the bucket is valid, by which clients send and fetch meshes without this server in between; off: none are given.
    presigned_ttl: Option<Duration> = "off",
    /// Most bytes of copies of its files in data_dir, but for those in use.
    blobs_copies_bytes_max: Bytes = "5GiB",

    /// File of API keys, one a line: a key, or NAME:SHA-256 of a key in hexadecimal, perhaps with :read or :submit behind it.
    api_keys_file: Option<PathBuf> = "",
    /// Lets everybody who reaches the service use it, also from other machines.
    allow_anonymous: bool = "false",
    /// Host names, besides loopback, that requests to a service without keys may name, and whose pages may send them; `*`: any.
    allowed_hosts: Vec<String> = "",
    /// Addresses of proxies whose forwarding headers are believed.
    trusted_proxies: Vec<IpAddr> = "",
    /// Origins whose pages may use the service and read its answers.
    cors_origins: Vec<String> = "",
    /// Requests that one key, or one address without keys, may make in a minute; 0: any number.
    rate_per_minute: u32 = "1_200",
    /// Requests that one key, or one address without keys, may make at one time.
    rate_burst: u32 = "240",

    /// Jobs that run at one time; auto: half the cores and one more.
    slots: Option<NonZeroUsize> = "auto",
    /// Jobs beside those that run at one time, for small meshes that somebody waits for.
    interactive_slots: usize = "2",
    /// Most slots of each of both kinds that one key, or one address without keys, has at one time, on all servers together;
    /// auto: all but one of each server.
    owner_slots_max: Option<NonZeroUsize> = "auto",
    /// Largest upload that may use an interactive slot.
    interactive_bytes_max: Bytes = "4MiB",
    /// Time that a job may take in an interactive slot for each begun MiB of its upload; then it goes on in an ordinary slot.
    interactive_deadline: Duration = "10s",
    /// Most memory that all running jobs may take together, as estimated from their uploads; auto: three quarters of the machine's.
    memory_bytes_max: Option<Bytes> = "auto",
    /// Most queued jobs.
    queue_max: NonZeroUsize = "128",
    /// Most queued jobs of one key, or of one address without keys; auto: no more than there are free places.
    owner_queue_max: Option<NonZeroUsize> = "auto",
    /// Most jobs kept, whatever their state; the oldest finished ones go first.
    jobs_max: NonZeroUsize = "20_000",
    /// Most jobs kept of one key, or of one address without keys; auto: all, but at the limit those over its share go first.
    owner_jobs_max: Option<NonZeroUsize> = "auto",
    /// Time for which a finished job is kept.
    result_ttl: Duration = "24h",
    /// Most bytes of uploads and results on disk; the oldest finished jobs go first.
    data_bytes_max: Bytes = "20GiB",
    /// Most bytes of uploads and results of one key, or of one address without keys; auto: all, but at the limit those over its share go first.
    owner_data_bytes_max: Option<Bytes> = "auto",
    /// Bytes of the disk that stay free.
    disk_free_bytes_min: Bytes = "256MiB",
    /// Time after which a job is queued again whose server has stopped reporting.
    lease: Duration = "30s",
    /// Lost runs after which a job fails.
    attempts_max: NonZeroU32 = "3",
    /// Time that running jobs get when the server shuts down.
    drain_grace: Duration = "25s",

    /// Largest upload.
    upload_bytes_max: Bytes = "512MiB",
    /// Most uploads in pieces (/v1/uploads) that no job has taken yet; one key, or one address without keys, has half of them at most.
    uploads_max: NonZeroUsize = "1_000",
    /// Time for which an upload in pieces is kept after its last bytes came.
    upload_ttl: Duration = "24h",
    /// Most triangles of a mesh after polygons are split.
    triangles_max: u32 = "100_000_000",
    /// Most vertices of a mesh.
    vertices_max: u32 = "300_000_000",
    /// Most corners of one polygon.
    polygon_corners_max: u32 = "65_536",
    /// Longest run of one job. The command line has no deadline unless this is set.
    deadline_max: Duration = "10min",
    /// Most memory that one job may charge.
    engine_bytes_max: Bytes = "4GiB",
    /// Most work units of one job.
    engine_work_max: u64 = "9_007_199_254_740_991",
    /// Engine threads of one job; 0: one for each core, which jobs share that run in threads of the server.
    engine_threads: usize = "0",
    /// Where a job runs: in a process of its own, whose end is the end of one job, or in a thread of the server.
    isolation: IsolationChoice = "process",
    /// What a job's process gives up by landlock and seccomp: what the kernel has (auto), all or no start (require), off.
    sandbox: SandboxChoice = "auto",

    /// Most open connections of each listener; more wait in the system's backlog.
    connections_max: NonZeroUsize = "4096",
    /// Most open connections of one address, but for those of trusted_proxies; auto: half of all.
    address_connections_max: Option<NonZeroUsize> = "auto",
    /// Time for a request's head, and for which a connection may be idle.
    header_timeout: Duration = "15s",
    /// Longest pause between two pieces of an upload.
    upload_timeout: Duration = "30s",
    /// Fewest bytes that an upload brings in a second, on average after its first upload_timeout; 0: any number.
    upload_rate_min: Bytes = "1KiB",
    /// Longest time for a whole upload.
    upload_total_timeout: Duration = "1h",
    /// Time for which a client may take no byte of an answer.
    write_timeout: Duration = "60s",

    /// Whether jobs may name a URL that is called when they end.
    webhooks: bool = "false",
    /// File of the key that seals the secrets of jobs in the store, made when there is none. Default: store.key in data_dir.
    store_key_file: Option<PathBuf> = "",
    /// File of secrets that calls are signed with where the job brings none, one a line: whsec_ and base64.
    webhook_secret_file: Option<PathBuf> = "",
    /// Hosts with port that may be called although they are not public, also over http.
    webhook_private_hosts: Vec<String> = "",
    /// Time for one call.
    webhook_timeout: Duration = "10s",
    /// Most calls for one event.
    webhook_attempts_max: NonZeroU32 = "8",
    /// Pause after the first call that fails; the next ones are longer, up to 6 h.
    webhook_pause: Duration = "5s",

    /// Which log lines are written, as in RUST_LOG: error, warn, info, debug, or by module.
    log: String = "info",
    /// How log lines look.
    log_format: LogFormat = "text",
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_setting_has_a_name_that_kubernetes_injects() {
        for setting in SETTINGS {
            let variable = setting.variable();
            assert!(
                !variable.starts_with("MESHMEND_SERVICE_") && !variable.starts_with("MESHMEND_PORT"),
                "{variable}"
            );
        }
    }

    #[test]
    fn settings_are_named_once_and_explained_in_a_sentence() {
        for (i, setting) in SETTINGS.iter().enumerate() {
            assert!(SETTINGS[..i].iter().all(|other| other.name != setting.name), "{}", setting.name);
            assert!(setting.about.ends_with('.'), "{}", setting.about);
        }
    }
}
