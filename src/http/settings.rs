//! What the operator may set about HTTP.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::Duration;

use super::access::{Access, TrustedPeers};
use super::rate::RateSettings;

/// Addresses, access and limits of the HTTP side. The names are those of the configuration.
#[derive(Debug, Clone)]
pub struct HttpSettings {
    /// Where the API listens; `None`: nowhere, the server only runs jobs.
    pub listen: Option<SocketAddr>,
    /// Where health and metrics listen; `None`: nowhere.
    pub admin_listen: Option<SocketAddr>,
    /// Who may use the API.
    pub access: Access,
    /// Origins whose pages may read answers. Default: none.
    pub cors_origins: Vec<String>,
    /// How many requests one caller may make; `None`: any number. Default: 1,200 in a minute, 240 at one time.
    pub rate: Option<RateSettings>,
    /// Most open connections of each listener; more wait in the system's backlog. Default 4,096.
    pub connections_max: usize,
    /// Most of them that one address may have, of an IPv6 address its first half. Default: half of them.
    pub address_connections_max: Option<usize>,
    /// Addresses of proxies: behind each of them are many clients, whose addresses they tell.
    pub trusted_proxies: Vec<IpAddr>,
    /// Time for a request's head, and for which a connection may be idle. Default 15 s.
    pub header_timeout: Duration,
    /// Longest pause between two pieces of an upload. Default 30 s.
    pub upload_timeout: Duration,
    /// Fewest bytes a second of an upload, on average after its first `upload_timeout`. Default 1 KiB.
    pub upload_rate_min: u64,
    /// Longest time for a whole upload. Default 1 h.
    pub upload_total_timeout: Duration,
    /// Time for which a client may take no byte of an answer. Default 60 s.
    pub write_timeout: Duration,
}

impl Default for HttpSettings {
    /// Loopback only, anonymous, no admin listener.
    fn default() -> Self {
        Self {
            listen: Some((Ipv4Addr::LOCALHOST, 8080).into()),
            admin_listen: None,
            access: Access::Anonymous(TrustedPeers::default()),
            cors_origins: Vec::new(),
            rate: Some(RateSettings::default()),
            connections_max: 4096,
            address_connections_max: None,
            trusted_proxies: Vec::new(),
            header_timeout: Duration::from_secs(15),
            upload_timeout: Duration::from_secs(30),
            upload_rate_min: 1 << 10,
            upload_total_timeout: Duration::from_secs(60 * 60),
            write_timeout: Duration::from_secs(60),
        }
    }
}

impl HttpSettings {
    /// Most open connections of one address.
    pub(super) fn connections_share(&self) -> usize {
        self.address_connections_max.unwrap_or(self.connections_max.div_ceil(2)).min(self.connections_max)
    }
}
